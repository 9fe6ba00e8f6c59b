//! The table "Measured" of the README: each row is written where it stands.

use std::path::Path;
use std::process::Command;

use super::peers::{Found, minus};
use super::told;
use crate::{Plan, boundary, document, parse, peer, ply, rays, reload};

/// The document, below the project's folder.
pub(super) const DOCUMENT: &str = "README.md";

const MB_PER_MIB: f64 = 1.048_576;

/// What stands in the first column, and what tells the cells behind it, of some or all columns.
struct Row<T> {
    label: &'static str,
    cells: fn(&T) -> Result<Vec<String>, String>,
}

/// What Luxel alone can measure, beside others where they are found.
const ALONE: [Row<Plan>; 7] = [
    Row {
        label: "start to a written 64 × 64 picture, whole process",
        cells: |plan| Ok(vec![format!("{:.0} ms", peer::start(&plan.luxel)?.ms.median())]),
    },
    Row {
        label: "peak memory, Cornell 512²",
        cells: |plan| {
            let peak = peer::cornell_box(&plan.luxel)?.megabytes.unwrap_or(f64::NAN);
            Ok(vec![format!("{:.0} MB", peak * MB_PER_MIB)])
        },
    },
    Row {
        label: "2.1 M triangles, binary PLY: read and built",
        cells: |plan| {
            let loaded = ply::measure(&plan.luxel, plan.python.as_deref())?.into_iter();
            let cell = |it: ply::Loaded| (it.seconds, it.memory * MB_PER_MIB);
            Ok(loaded.map(cell).map(|(s, mb)| format!("{s:.2} s, {mb:.0} MB")).collect())
        },
    },
    Row {
        label: "scene text: objects · `#[…]` tables, a core",
        cells: |_| {
            let [objects, table] = [parse::OBJECTS, parse::TABLE].map(|case| parse::ours(&case));
            Ok(vec![format!("{:.0} · {:.0} MB/s", objects.median(), table.median())])
        },
    },
    Row {
        label: "every built-in from a dynamic library, to the same bits: Cornell box · glass and metal",
        cells: |plan| {
            let both = boundary::pictures(&plan.luxel)?;
            let ratios: Vec<String> =
                both.iter().map(|both| format!("{:.2} ×", both.ratio())).collect();
            Ok(vec![format!("{} the time", ratios.join(" · "))])
        },
    },
    Row {
        label: "a rebuilt plugin library, from its file to the new 64 × 64 picture",
        cells: |plan| Ok(vec![format!("{:.0} ms", reload::measure(&plan.luxel)?.ms.median())]),
    },
    Row {
        label: "rays through 7 M triangles, in turns and without a leak, to Embree 4.4 (which leaks)",
        cells: |plan| {
            let found = rays::in_turns(plan.embree.as_deref(), plan.python.as_deref());
            Ok(found.map(|[least, most]| format!("{least:.2} – {most:.2} ×")).into_iter().collect())
        },
    },
];

/// What is measured beside Mitsuba; and when, which is written where all was measured.
const BESIDE: [Row<Found>; 7] = [
    Row {
        label: "Cornell box, mean of the picture, G: difference",
        cells: |found| whole(found, "cornell_rgb"),
    },
    Row { label: "the same by wavelength, Y", cells: |found| whole(found, "cornell_spectral") },
    Row {
        label: "paths per CPU-second, Cornell 512², 16 spp",
        cells: |found| {
            let rates = found.of_programs("cornell_rgb", "rate")?;
            Ok(rates.map(|rate| format!("{rate:.2} M")).to_vec())
        },
    },
    Row {
        label: "1 / (relMSE · second) on two cores, Cornell 512²",
        cells: |found| found.efficiencies("cornell_rgb"),
    },
    Row {
        label: "the same, 2.1 M triangles under a sky",
        cells: |found| found.efficiencies("waves"),
    },
    Row {
        label: "the same, glass and metal spheres 512²",
        cells: |found| found.efficiencies("glass_metal"),
    },
    Row {
        label: "measured on",
        cells: |_| Ok(vec![told(Command::new("date").args(["-u", "+%F"]))?.trim().to_owned()]),
    },
];

/// The middle channel's difference over the whole picture.
fn whole(found: &Found, scene: &str) -> Result<Vec<String>, String> {
    let [difference, error] = found.difference(scene, "whole", 1)?.map(|share| share * 100.0);
    Ok(vec![minus(&format!("{difference:+.3} % ± {error:.3} %"))])
}

/// # Errors
/// What a program or the disk says.
pub(super) fn alone(plan: &Plan, root: &Path) -> Result<(), String> {
    ALONE.iter().try_for_each(|row| row.write(plan, root))
}

/// # Errors
/// What the disk says.
pub(super) fn beside(found: &Found, root: &Path) -> Result<(), String> {
    BESIDE.iter().try_for_each(|row| row.write(found, root))
}

impl<T> Row<T> {
    /// No cells leave the row as it is.
    fn write(&self, of: &T, root: &Path) -> Result<(), String> {
        let cells = (self.cells)(of)?;
        println!("{}: {}", self.label, cells.join(" | "));
        if cells.iter().any(|cell| cell.contains("NaN")) {
            return Err(format!("{}: not a number", self.label));
        }
        document::write_row(&root.join(DOCUMENT), self.label, &cells)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_that_is_written_stands_in_the_readme() {
        let text = include_str!("../../../README.md");
        let labels = ALONE.iter().map(|row| row.label).chain(BESIDE.iter().map(|row| row.label));
        for label in labels {
            let begin = format!("| {label} |");
            assert_eq!(text.lines().filter(|line| line.starts_with(&begin)).count(), 1, "{begin}");
        }
    }
}
