//! Colours of measured surfaces: a spectral render against the sum over the tables.
//!
//! The reflectances are those of the colour chart as measured by Ohta (1997), which the project
//! ships. What is expected was worked out by another program from its own tables: docs/accuracy.md says how.

use luxel_sdk::color::RgbSpace;

use super::bench::Bench;
use super::scene::spread;
use crate::exit::Failure;
use crate::verify::row::Row;

/// Each truth with its lamp.
const LAMPS: [(&str, &str); 2] = [("colour.checker.D65", "D65"), ("colour.checker.A", "A")];

/// Each patch with its X, Y and Z under each lamp: those of Colour 0.4.7 (colour-science.org), Σ r·S·x̄ / Σ S·ȳ
/// at 1 nm from 360 to 830, straight lines between the values of its tables.
const PATCHES: [(&str, [[f64; 3]; 2]); 7] = [
    ("dark skin", [[0.1097240, 0.0970458, 0.0605721], [0.1478796, 0.1097961, 0.0199129]]),
    ("blue", [[0.0840578, 0.0623517, 0.2996492], [0.0586873, 0.0513325, 0.0940163]]),
    ("green", [[0.1450499, 0.2355732, 0.0952909], [0.1606013, 0.2149617, 0.0353920]]),
    ("red", [[0.2018826, 0.1183915, 0.0519951], [0.3215508, 0.1669234, 0.0168839]]),
    ("yellow", [[0.5604667, 0.5962667, 0.0957462], [0.7619461, 0.6484824, 0.0392515]]),
    ("white 9.5 (.05 D)", [[0.8413364, 0.8872341, 0.9539938], [0.9751635, 0.8875123, 0.3132752]]),
    ("neutral 5 (.70 D)", [[0.1931012, 0.2030523, 0.2215427], [0.2227475, 0.2030474, 0.0723938]]),
];

/// As for every chart: the tables' own steps.
const TOLERANCE: (f64, f64) = (2e-3, 2e-4);

/// Tests every patch under the lamps of the truths whose name begins so.
pub(super) fn test(only: &str, bench: &Bench<'_>, rows: &mut Vec<Row>) -> Result<(), Failure> {
    for (i, (id, lamp)) in LAMPS.into_iter().enumerate().filter(|(_, of)| of.0.starts_with(only)) {
        let all = PATCHES.map(|(patch, expected)| (patch, expected[i]));
        patches((id, lamp), &all, bench, rows)?;
    }
    Ok(())
}

fn patches(
    (id, lamp): (&str, &str),
    all: &[(&str, [f64; 3])],
    bench: &Bench<'_>,
    rows: &mut Vec<Row>,
) -> Result<(), Failure> {
    for (patch, expected) in all {
        let set = [("patch", *patch), ("lamp", lamp)];
        let set = set.map(|(name, value)| (name.to_owned(), format!("\"{value}\"")));
        let film = bench.film("checker", &set, None)?;
        let to_xyz = RgbSpace::default().to_xyz();
        rows.extend((0..3).map(|i| {
            let values = film.pixels().map(|(_, pixel)| (to_xyz * pixel.mean)[i]);
            let case = format!("{patch}, {}", ["X", "Y", "Z"][i]);
            let (rel, abs) = TOLERANCE;
            let tolerance = abs.max(rel * expected[i].abs());
            Row::new((id, &case), expected[i], spread(values), tolerance)
                .without(film.bad_samples())
        }));
    }
    Ok(())
}
