//! Colours of measured surfaces: a spectral render against the sum over the tables.
//!
//! The reflectances are those of the colour chart as measured by Ohta (1997), which the project
//! ships; what is expected is their own quadrature at 1 nm and not the published colours of another
//! measurement of the chart.

use glam::DVec3;
use luxel_sdk::color::{Curve, Observer, Outside, RgbSpace, illuminant};

use super::bench::Bench;
use super::scene::spread;
use super::texts::CHART;
use crate::exit::Failure;
use crate::verify::row::Row;

/// Each truth with its lamp.
const LAMPS: [(&str, &str); 2] = [("colour.checker.D65", "D65"), ("colour.checker.A", "A")];

const PATCHES: [&str; 7] =
    ["dark skin", "blue", "green", "red", "yellow", "white 9.5 (.05 D)", "neutral 5 (.70 D)"];

/// As for every chart: the tables' own steps.
const TOLERANCE: (f64, f64) = (2e-3, 2e-4);

/// Tests every patch under the lamps of the truths whose name begins so.
pub(super) fn test(only: &str, bench: &Bench<'_>, rows: &mut Vec<Row>) -> Result<(), Failure> {
    for (id, lamp) in LAMPS.into_iter().filter(|(id, _)| id.starts_with(only)) {
        patches((id, lamp), bench, rows)?;
    }
    Ok(())
}

fn patches(
    (id, lamp): (&str, &str),
    bench: &Bench<'_>,
    rows: &mut Vec<Row>,
) -> Result<(), Failure> {
    for patch in PATCHES {
        let expected = expected(patch, lamp);
        let set = [("patch", patch), ("lamp", lamp)];
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

/// Σ r·S·(x̄, ȳ, z̄) at 1 nm, S scaled to Y = 1.
fn expected(patch: &str, lamp: &str) -> DVec3 {
    const CHECKED: &str = "the chart of this program is whole";
    let mut lines = CHART.lines();
    let mut head = lines.next().expect(CHECKED).split(',');
    let column = head.position(|name| name == patch).expect(CHECKED);
    let points: Vec<(f64, f64)> = lines
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|x| x.parse().expect(CHECKED)).collect();
            (numbers[0], numbers[column])
        })
        .collect();
    let reflectance = Curve::from_points(&points, Outside::Constant).expect(CHECKED);
    let light = illuminant(lamp).expect("it is known");
    let (mut sum, mut white) = (DVec3::ZERO, 0.0);
    for nm in 360_u16..=830 {
        let nm = f32::from(nm);
        let bar = Observer::Cie1931.xyz_bar(nm).as_dvec3();
        sum += bar * f64::from(reflectance.at(nm) * light.at(nm));
        white += bar.y * f64::from(light.at(nm));
    }
    sum / white
}
