//! Colours of measured surfaces: a spectral render against the sum over the tables.
//!
//! The reflectances are those of the colour chart as measured by Ohta (1997), which the project
//! ships; what is expected is their own quadrature at 1 nm and not the published colours of another
//! measurement of the chart.

use glam::DVec3;
use luxel_sdk::color::{Curve, Observer, Outside, RgbSpace, illuminant};

use super::Row;
use super::scene::{film, spread};
use crate::disk::{root, text};

pub(super) const IDS: [&str; 1] = ["colour.checker.D65"];

const PATCHES: [&str; 7] =
    ["dark skin", "blue", "green", "red", "yellow", "white 9.5 (.05 D)", "neutral 5 (.70 D)"];

/// As for every chart: the tables' own steps.
const TOLERANCE: (f64, f64) = (2e-3, 2e-4);

pub(super) fn rows() -> Vec<Row> {
    PATCHES.iter().flat_map(|patch| patch_rows(patch)).collect()
}

fn patch_rows(patch: &str) -> Vec<Row> {
    let expected = expected(patch);
    let film = film("checker", &[("patch".to_owned(), format!("\"{patch}\""))], None);
    let to_xyz = RgbSpace::default().to_xyz();
    let row = |i: usize| {
        let values = film.pixels().map(|(_, pixel)| (to_xyz * pixel.mean)[i]);
        let (measured, error) = spread(values);
        let case = format!("{patch}, {}", ["X", "Y", "Z"][i]);
        Row { error, ..Row::exact(IDS[0], &case, (expected[i], measured), TOLERANCE) }
    };
    (0..3).map(row).collect()
}

/// Σ r·S·(x̄, ȳ, z̄) at 1 nm, S scaled to Y = 1.
fn expected(patch: &str) -> DVec3 {
    let table = text(&root().join("tests/truths/colour/colorchecker_n_ohta.csv"));
    let mut lines = table.lines();
    let column = lines.next().unwrap().split(',').position(|name| name == patch).unwrap();
    let points: Vec<(f64, f64)> = lines
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|x| x.parse().unwrap()).collect();
            (numbers[0], numbers[column])
        })
        .collect();
    let reflectance = Curve::from_points(&points, Outside::Constant).unwrap();
    let light = illuminant("D65").unwrap();
    let (mut sum, mut white) = (DVec3::ZERO, 0.0);
    for nm in 360_u16..=830 {
        let nm = f32::from(nm);
        let bar = Observer::Cie1931.xyz_bar(nm).as_dvec3();
        sum += bar * f64::from(reflectance.at(nm) * light.at(nm));
        white += bar.y * f64::from(light.at(nm));
    }
    sum / white
}
