//! Truths about all the light of a lamp, and about how large it is seen.

use glam::{DVec3, Vec2};
use luxel_core::object::{Scratch, Site};
use luxel_core::stage::{Geometry, LightSource};
use luxel_sdk::color::{Palette, Wavelengths};

use super::bench::Bench;
use crate::exit::Failure;
use crate::verify::row::Row;

/// Every row.
pub(super) fn rows(bench: &Bench<'_>) -> Result<Vec<Row>, Failure> {
    Ok(vec![flux(bench)?, solid_angle(bench)?])
}

/// The scene that holds something alone.
fn scene(of: &str) -> String {
    format!(
        "scene 1
        camera perspective {{
            look = look_at(from = (0, 0, 0) m, to = (0, 0, -1) m, up = (0, 1, 0)), fov = 60 deg
        }}
        film spectral {{ resolution = (1, 1) }}
        {of}"
    )
}

/// A lamp of 100 W/sr along its axis, which falls as the fourth power of the cosine: 2π·100/5.
fn flux(bench: &Bench<'_>) -> Result<Row, Failure> {
    let lamp = "light spot {
        look = look_at(from = (0, 0, 0) m, to = (0, 0, -1) m, up = (0, 1, 0))
        cone = 90 deg, exponent = 4, spectrum = spectrum.constant(1), intensity = 100 W/sr
    }";
    let stage = bench.of_text(&scene(lamp))?;
    let (palette, scratch) = (Palette::new(Wavelengths::sample(0.5)), Scratch::default());
    let site = Site { p: DVec3::ZERO, uv: Vec2::ZERO, palette: &palette, color: None };
    let measured = match &stage.lights.sources[..] {
        [LightSource::Free { object, .. }] => {
            f64::from(object.resolve(&site, &scratch).light().power(0.0, 1.0))
        }
        _ => f64::NAN,
    };
    Ok(Row::exact("cosn.flux", "flux", (125.66370614359172, measured), (1e-6, 0.0)))
}

/// Of a ball of radius 1 four away: 2π(1 − √(1 − 1/16)), which is one over the density per solid angle with
/// which points on it are chosen.
fn solid_angle(bench: &Bench<'_>) -> Result<Row, Failure> {
    let stage = bench.of_text(&scene("shape sphere { radius = 1 m }"))?;
    let from = DVec3::new(0.0, 0.0, 4.0);
    let measured = match &*stage.geometries[0] {
        Geometry::Analytic(found) => {
            let sample = found.object().fixed().shape().sample(Some(from), [0.3, 0.6]);
            sample.map_or(f64::NAN, |sample| {
                let to = sample.surface.p - from;
                let cos = -sample.surface.ng.dot(to.normalize());
                cos / (sample.pdf * to.length_squared())
            })
        }
        Geometry::Mesh(_) => f64::NAN,
    };
    let values = (0.19951729321916842, measured);
    Ok(Row::exact("visible.sphere", "solid angle", values, (1e-5, 0.0)))
}
