//! The truth about how far light goes in a body that absorbs nothing, lit evenly from all around: 4V/S
//! on average, however it scatters.
//!
//! # Source
//! Blanco and Fournier 2003.

use glam::{DVec3, Vec2};
use luxel_core::object::{Scratch, Site};
use luxel_sdk::color::Palette;
use luxel_sdk::kind::{Medium, Phase, SampleAt, Samples};
use luxel_sdk::num::{Moments, Ray};
use luxel_sdk::sampling::cosine_hemisphere;

use super::bench::Bench;
use crate::exit::Failure;
use crate::verify::row::{Measured, Row};

/// Walks of each case: a standard error of .4 % at the most.
const N: u32 = 1 << 16;

/// Of a ball of radius 1, 4R/3.
pub(super) fn rows(bench: &Bench<'_>) -> Result<Vec<Row>, Failure> {
    [0.01, 1.0, 5.0].iter().map(|sigma| row(*sigma, bench)).collect()
}

fn row(sigma: f64, bench: &Bench<'_>) -> Result<Row, Failure> {
    let text = format!(
        "scene 1
        camera perspective {{
            look = look_at(from = (0, 0, 0) m, to = (0, 0, -1) m, up = (0, 1, 0)), fov = 60 deg
        }}
        film rgb {{ resolution = (1, 1) }}
        sampler independent {{ seed = 41 }}
        medium homogeneous {{ sigma_s = {sigma} / (1 m) }}"
    );
    let stage = bench.of_text(&text)?;
    let (scratch, palette) = (Scratch::default(), Palette::rgb());
    let site = Site { p: DVec3::ZERO, uv: Vec2::ZERO, palette: &palette, color: None };
    let outside = stage.outside.expect("the scene has a medium") as usize;
    let medium = stage.media[outside].resolve(&site, &scratch).medium();
    let numbers = stage.sampler.fixed().sampler();
    let mut all = Moments::default();
    for index in 0..N {
        let at = SampleAt { stream: numbers.seed(), index, dimension: 0 };
        all.push(walk(medium, &mut Samples::new(numbers, at)));
    }
    let measured = Measured { value: all.mean, error: all.standard_error() };
    let case = format!("sigma_s {sigma}/m");
    Ok(Row::new(("media.mean_path", &case), 4.0 / 3.0, measured, 4.0 / 3.0 * 5e-4))
}

/// From where light enters a ball of radius 1 to where it leaves.
fn walk(medium: &dyn Medium, samples: &mut Samples<'_>) -> f64 {
    let (mut p, mut d) = (DVec3::NEG_Z, cosine_hemisphere(samples.next_2d()).as_dvec3());
    let mut length = 0.0;
    loop {
        let d_unit = d.normalize();
        let along = p.dot(d_unit);
        let wall = (along * along + 1.0 - p.length_squared()).max(0.0).sqrt() - along;
        let flight = medium.sample(&Ray { o: p, d: d_unit, t_max: wall }, samples);
        let Some(t) = flight.t.get() else { return length + wall };
        length += t;
        p += d_unit * t;
        // Nothing is absorbed, and so nothing is weighed.
        let turned = medium.phase().sample(-d_unit.as_vec3(), samples.next_2d());
        d = turned.map_or(d_unit, |found| found.wi.as_dvec3());
    }
}
