//! Truths about where rays meet shapes.

use glam::DVec3;
use luxel_core::stage::Geometry;
use luxel_sdk::num::Ray;

use super::bench::Bench;
use crate::exit::Failure;
use crate::verify::row::Row;

/// Every row.
pub(super) fn rows(bench: &Bench<'_>) -> Result<Vec<Row>, Failure> {
    Ok([torus(bench)?, far(bench)?].concat())
}

/// Four times through a ring: the roots of its quartic, found one after another.
fn torus(bench: &Bench<'_>) -> Result<Vec<Row>, Failure> {
    let (o, d) = (DVec3::new(-5.0, 0.3, 0.1), DVec3::new(0.97, 0.02, -0.01));
    let expected = [2.608740637790732, 3.6525289070511198, 6.6365038049198875, 7.688587389562672];
    let shape = "torus { axis = (0, 0, 1), radius = 2 m, tube = 50 cm }";
    let from = [0.0, 3.0, 5.0, 7.0];
    let found = met(shape, (o, d), &from, bench)?;
    let cases = ["in", "out", "in again", "out again"];
    let row = |(case, values): (&str, (f64, f64))| {
        Row::exact("geom.torus_ray", case, values, (1e-5, 0.0))
    };
    Ok(cases.into_iter().zip(expected.into_iter().zip(found)).map(row).collect())
}

/// A ball far away that a ray just meets, one as large as a planet from a millimetre above it, and one
/// larger still from a metre.
fn far(bench: &Bench<'_>) -> Result<Vec<Row>, Failure> {
    let grazing = DVec3::new(1.0, 1e-4, 0.0).normalize();
    let cases = [
        (
            "far away",
            "sphere { radius = 1 m }",
            (DVec3::new(-1e4, 0.0, 0.0), grazing),
            [(0.0, 9999.999850000002), (9999.99995, 10000.000049999999)],
        ),
        (
            "close to a planet",
            "sphere { radius = 1e7 m }",
            (DVec3::new(0.0, 1e7 + 1e-3, 0.0), DVec3::NEG_Y),
            [(0.0, 0.0010000001639127731), (1.0, 20000000.001000002)],
        ),
        (
            "before a giant",
            "sphere { center = (0, 0, 1e8) m, radius = 99999999 m }",
            (DVec3::ZERO, DVec3::Z),
            [(0.0, 1.0), (2.0, 199999999.0)],
        ),
    ];
    let mut rows = vec![];
    for (case, shape, ray, expected) in cases {
        let found = met(shape, ray, &expected.map(|(from, _)| from), bench)?;
        for ((end, (_, expected)), found) in ["in", "out"].into_iter().zip(expected).zip(found) {
            let case = format!("{case}, {end}");
            rows.push(Row::exact("geom.sphere_far", &case, (expected, found), (1e-6, 0.0)));
        }
    }
    Ok(rows)
}

/// Where a ray next meets a shape from some places on it on; NaN where it meets nothing.
fn met(
    shape: &str,
    (o, d): (DVec3, DVec3),
    from: &[f64],
    bench: &Bench<'_>,
) -> Result<Vec<f64>, Failure> {
    let text = format!(
        "scene 1
        camera perspective {{
            look = look_at(from = (0, 0, 0) m, to = (0, 0, -1) m, up = (0, 1, 0)), fov = 60 deg
        }}
        film rgb {{ resolution = (1, 1) }}
        shape {shape}"
    );
    let stage = bench.of_text(&text)?;
    let Geometry::Analytic(found) = &*stage.geometries[0] else { return Ok(vec![]) };
    let shape = found.object().fixed().shape();
    let hit = |from: &f64| {
        let hit = shape.intersect(&Ray::new(o + d * *from, d));
        hit.map_or(f64::NAN, |hit| from + hit.t)
    };
    Ok(from.iter().map(hit).collect())
}
