//! The table "Measured" of the README: each row is written where it stands.

use std::path::Path;
use std::process::Command;

use super::peers::{Found, minus};
use super::{Form, told};
use crate::{Plan, boundary, document, parse, peer, ply, rays, reload};

const MB_PER_MIB: f64 = 1.048_576;

/// What stands in the first column, and what tells the cells behind it, of some or all columns.
struct Row<T> {
    label: &'static str,
    cells: fn(&T, Form) -> Result<Vec<String>, String>,
}

/// What Luxel alone can measure, beside others where they are found.
const ALONE: [Row<Plan>; 7] = [
    Row {
        label: "start to a written 64 × 64 picture, whole process",
        cells: |plan, form| {
            let start = peer::start(&plan.luxel, form.pick(peer::STARTS, 1))?;
            Ok(vec![format!("{:.0} ms", start.ms.median())])
        },
    },
    Row {
        label: "peak memory, Cornell 512²",
        cells: |plan, _| {
            let peak = peer::cornell_box(&plan.luxel)?.megabytes.unwrap_or(f64::NAN);
            Ok(vec![format!("{:.0} MB", peak * MB_PER_MIB)])
        },
    },
    Row {
        label: "2.1 M triangles, binary PLY: read and built",
        cells: |plan, form| {
            let amount = form.pick(ply::WHOLE, ply::Amount { side: 64, rounds: 1 });
            let loaded = ply::measure(&plan.luxel, plan.python.as_deref(), amount)?.into_iter();
            let cell = |it: ply::Loaded| (it.seconds, it.memory * MB_PER_MIB);
            Ok(loaded.map(cell).map(|(s, mb)| format!("{s:.2} s, {mb:.0} MB")).collect())
        },
    },
    Row {
        label: "scene text: objects · `#[…]` tables, a core",
        cells: |_, form| {
            let times = form.pick(parse::ROUNDS, 1);
            let [objects, table] =
                [parse::OBJECTS, parse::TABLE].map(|case| parse::ours(&case, times));
            Ok(vec![format!("{:.0} · {:.0} MB/s", objects.median(), table.median())])
        },
    },
    Row {
        label: "every built-in from a dynamic library, to the same bits: Cornell box · glass and metal",
        cells: |plan, form| {
            let amount = form.pick(boundary::WHOLE, boundary::Amount { size: 64, rounds: 1 });
            let both = boundary::pictures(&plan.luxel, amount)?;
            let ratios: Vec<String> =
                both.iter().map(|both| format!("{:.2} ×", both.ratio())).collect();
            Ok(vec![format!("{} the time", ratios.join(" · "))])
        },
    },
    Row {
        label: "a rebuilt plugin library, from its file to the new 64 × 64 picture",
        cells: |plan, form| {
            let reloads = reload::measure(&plan.luxel, form.pick(reload::RELOADS, 3))?;
            Ok(vec![format!("{:.0} ms", reloads.ms.median())])
        },
    },
    Row {
        label: "rays through 7 M triangles, side by side and without a leak, to Embree 4.4 (which leaks)",
        cells: |plan, form| {
            let steps = form.pick(rays::FINE, [60, 15]);
            let found = rays::side_by_side(plan.embree.as_deref(), plan.python.as_deref(), steps);
            Ok(found.map(|[least, most]| format!("{least:.2} – {most:.2} ×")).into_iter().collect())
        },
    },
];

/// What is measured beside Mitsuba; and when, which is written where all was measured.
const BESIDE: [Row<Found>; 7] = [
    Row {
        label: "Cornell box, mean of the picture, G: difference",
        cells: |found, _| whole(found, "cornell_rgb"),
    },
    Row { label: "the same by wavelength, Y", cells: |found, _| whole(found, "cornell_spectral") },
    Row {
        label: "paths per CPU-second, Cornell 512², 16 spp",
        cells: |found, _| {
            let rates = found.of_programs("cornell_rgb", "rate")?;
            Ok(rates.map(|rate| format!("{rate:.2} M")).to_vec())
        },
    },
    Row {
        label: "1 / (relMSE · second) on two cores, whole · render alone, Cornell 512²",
        cells: |found, _| found.efficiencies("cornell_rgb"),
    },
    Row {
        label: "the same, 2.1 M triangles under a sky",
        cells: |found, _| found.efficiencies("waves"),
    },
    Row {
        label: "the same, glass and metal spheres 512²",
        cells: |found, _| found.efficiencies("glass_metal"),
    },
    Row {
        label: "measured on",
        cells: |_, _| Ok(vec![told(Command::new("date").args(["-u", "+%F"]))?.trim().to_owned()]),
    },
];

/// The middle channel's difference over the whole picture.
fn whole(found: &Found, scene: &str) -> Result<Vec<String>, String> {
    let [difference, error] = found.difference(scene, "whole", 1)?.map(|share| share * 100.0);
    Ok(vec![minus(&format!("{difference:+.3} % ± {error:.3} %"))])
}

/// Writes what Luxel alone can measure into a table at that place.
///
/// # Errors
/// What a program or the disk says.
pub(super) fn alone(plan: &Plan, place: &Path, form: Form) -> Result<(), String> {
    ALONE.iter().try_for_each(|row| row.write(plan, place, form))
}

/// Writes what was found beside Mitsuba.
///
/// # Errors
/// What the disk says.
pub(super) fn beside(found: &Found, place: &Path) -> Result<(), String> {
    BESIDE.iter().try_for_each(|row| row.write(found, place, Form::Whole))
}

impl<T> Row<T> {
    fn write(&self, of: &T, place: &Path, form: Form) -> Result<(), String> {
        let cells = (self.cells)(of, form)?;
        let told = if cells.is_empty() { "stays as it is" } else { &cells.join(" | ") };
        println!("{}: {told}", self.label);
        document::write_row(place, self.label, &numbers(self.label, cells, form)?)
    }
}

/// The cells, if all are numbers. In short, a system that does not tell what is asked of it is no reason
/// to fail: no cells leave a row as it is.
fn numbers(label: &str, cells: Vec<String>, form: Form) -> Result<Vec<String>, String> {
    match form {
        _ if !cells.iter().any(|cell| cell.contains("NaN")) => Ok(cells),
        Form::Whole => Err(format!("{label}: not a number")),
        Form::Short => Ok(vec![]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::{read, write};

    const README: &str = include_str!("../../../README.md");

    /// The cells of a row behind its label.
    fn cells<'a>(text: &'a str, label: &str) -> Vec<&'a str> {
        let begin = format!("| {label} |");
        let rest = text.lines().find_map(|line| line.strip_prefix(&begin)).unwrap();
        rest.trim_end_matches('|').split('|').map(str::trim).collect()
    }

    #[test]
    fn what_is_found_beside_mitsuba_is_written_into_its_rows() {
        let place = write("readme-beside.md", README.as_bytes()).unwrap();
        beside(&Found::made_up(), &place).unwrap();
        let text = String::from_utf8(read(&place).unwrap()).unwrap();
        assert_eq!(cells(&text, BESIDE[0].label)[0], "−0.200 % ± 0.100 %");
        assert_eq!(cells(&text, BESIDE[2].label), ["1.50 M", "1.50 M", "1.50 M"]);
        for row in &BESIDE[3..6] {
            assert_eq!(cells(&text, row.label), ["250 · 250", "250", "250"], "{}", row.label);
        }
        for row in &ALONE {
            assert_eq!(cells(&text, row.label), cells(README, row.label));
        }
    }

    #[test]
    fn what_is_no_number_is_an_error_unless_it_is_only_tried() {
        let numbers = |cell: &str, form| numbers("a row", vec![cell.to_owned()], form);
        for form in [Form::Whole, Form::Short] {
            assert_eq!(numbers("1 MB", form), Ok(vec!["1 MB".to_owned()]));
        }
        assert_eq!(numbers("NaN MB", Form::Whole), Err("a row: not a number".to_owned()));
        assert_eq!(numbers("NaN MB", Form::Short), Ok(vec![]));
    }

    #[test]
    fn every_row_that_is_written_stands_in_the_readme() {
        let labels = ALONE.iter().map(|row| row.label).chain(BESIDE.iter().map(|row| row.label));
        for label in labels {
            let begin = format!("| {label} |");
            assert_eq!(
                README.lines().filter(|line| line.starts_with(&begin)).count(),
                1,
                "{begin}"
            );
        }
    }
}
