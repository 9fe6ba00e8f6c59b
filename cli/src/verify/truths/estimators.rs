//! Truths about what scatters: how far single samples of a known integral are from it.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec2, Vec3};
use luxel_core::object::{Scratch, Site};
use luxel_core::stage::LightSource;
use luxel_sdk::color::Palette;
use luxel_sdk::kind::LightQuery;
use luxel_sdk::num::Moments;
use luxel_sdk::sampling::{Rng, cosine_hemisphere, cosine_hemisphere_pdf};

use super::bench::Bench;
use crate::exit::Failure;
use crate::verify::row::{Measured, Row};

const ID: &str = "stat.uniform_hemi";

/// Samples: of the variance's standard error this leaves a third of a per cent.
const N: u32 = 1 << 16;

/// Under a sky of radiance 1, E = π. A sample of an even sky is 2π·cos θ and as likely anywhere between
/// 0 and 2π: its variance is π²/3. One by the cosine is π always.
pub(super) fn rows(bench: &Bench<'_>) -> Result<Vec<Row>, Failure> {
    let mut rng = Rng::new(40);
    let by_cosine = |u| {
        let wi: Vec3 = cosine_hemisphere(u);
        f64::from(wi.z / cosine_hemisphere_pdf(wi.z))
    };
    let cosine = (0..N).fold(Moments::default(), |mut all, _| {
        all.push(by_cosine(rng.pair()));
        all
    });
    let sky = sky(bench, &mut rng)?;
    let tolerance = 1e-6;
    let mean = Measured { value: sky.mean, error: sky.standard_error() };
    // The fourth central moment of an even distribution of width w is w⁴/80, its variance w²/12.
    let spread = TAU * TAU * ((1.0 / 80.0 - 1.0 / 144.0) / f64::from(N)).sqrt();
    let variance = Measured { value: sky.variance(), error: spread };
    Ok(vec![
        Row::new((ID, "even, mean"), PI, mean, tolerance),
        Row::new((ID, "even, variance"), PI * PI / 3.0, variance, tolerance),
        Row::exact(ID, "by the cosine, mean", (PI, cosine.mean), (tolerance, 0.0)),
        Row::exact(ID, "by the cosine, variance", (0.0, cosine.variance()), (0.0, tolerance)),
    ])
}

/// Samples of what a light from one half of all directions lays on a surface that faces it.
fn sky(bench: &Bench<'_>, rng: &mut Rng) -> Result<Moments, Failure> {
    let stage = bench.of_text(
        "scene 1
        camera perspective {
            look = look_at(from = (0, 0, 0) m, to = (0, 0, -1) m, up = (0, 1, 0)), fov = 60 deg
        }
        film rgb { resolution = (1, 1) }
        light directional {
            direction = (0, -1, 0), angular_size = 180 deg, spectrum = rgb.linear_srgb(1, 1, 1), scale = pi
        }",
    )?;
    let (scratch, palette) = (Scratch::default(), Palette::rgb());
    let site = Site { p: DVec3::ZERO, uv: Vec2::ZERO, palette: &palette, color: None };
    let LightSource::Free { object, .. } = &stage.lights.sources[0] else {
        return Ok(Moments::default());
    };
    let light = object.resolve(&site, &scratch).light();
    let mut all = Moments::default();
    for _ in 0..N {
        let found = light.sample(&LightQuery { p: DVec3::ZERO, u: rng.pair() });
        all.push(found.map_or(0.0, |s| f64::from(s.le.lane(0) / s.pdf) * s.wi.y));
    }
    Ok(all)
}
