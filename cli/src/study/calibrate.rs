//! The study's own measure, held against what is known exactly.
//!
//! Inside a closed room that shines evenly, of reflectance ρ, a path that ends by chance with probability
//! 1 − ρ has a variance of ρ / (1 − ρ)², and one that is cut off after d corners lacks ρ^(d+1) of the light.

use std::path::Path;

use serde_json::{Value, json};

use super::estimate::{Estimate, Number, Reference, SIGMAS};
use super::lab::{Lab, Shot};
use crate::exit::{Exit, Failure};
use crate::verify::{self, Run};

/// Samples of each pixel, and pictures: what variance is known to depends on the latter.
const SPP: u32 = 16;
const PICTURES: usize = 128;
/// What it must tell apart, as a share: a measure that cannot is none.
const RESOLUTION: f64 = 0.05;

/// Something known exactly, and what the study reads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    what: &'static str,
    expected: f64,
    read: Number,
}

impl Reading {
    fn is_right(&self) -> bool {
        let Self { expected, read, .. } = self;
        let noise = SIGMAS * read.error;
        (read.value - expected).abs() <= noise && read.error <= RESOLUTION * expected
    }

    pub(super) fn text(&self) -> String {
        let Self { what, expected, read: Number { value, error } } = self;
        format!("calibration: {what} reads {value:.4} ± {error:.4}, exactly {expected}")
    }

    pub(super) fn json(&self) -> Value {
        let Self { what, expected, read: Number { value, error } } = self;
        json!({ "what": what, "expected": expected, "read": value, "standard_error": error })
    }
}

/// Reads variance and bias of two scenes of this program.
///
/// # Errors
/// Ctrl-C; a reading that is wrong: then nothing that a study says can be trusted.
pub(super) fn readings(run: &Run, seed: u32) -> Result<[Reading; 2], Failure> {
    let roulette = furnace(run, seed, "rho=0.9", (10.0, "1000000"))?.variance;
    let per_sample = f64::from(SPP) * 10.0 * 10.0;
    let variance =
        Number { value: roulette.value * per_sample, error: roulette.error * per_sample };
    let bias = furnace(run, seed.wrapping_add(1 << 16), "rho=0.5", (2.0, "3"))?.bias2.root();
    let readings = [
        Reading { what: "variance of stat.rr_furnace", expected: 90.0, read: variance },
        Reading { what: "bias of furnace.closed.truncated", expected: 0.0625, read: bias },
    ];
    match readings.iter().find(|reading| !reading.is_right()) {
        Some(wrong) => Err(Failure::new(Exit::Ours, wrong.text())
            .help("with a plugin library in place of built-in classes? please report it")),
        None => Ok(readings),
    }
}

/// Pictures of the furnace, whose radiance without limit is `truth`.
fn furnace(
    run: &Run,
    seed: u32,
    rho: &str,
    (truth, depth): (f64, &str),
) -> Result<Estimate, Failure> {
    let depth = format!("depth={depth}");
    let set = [rho, &depth, "roulette=0", "noise=\"independent\""];
    let set = set.iter().filter_map(|given| given.split_once('='));
    let set: Vec<_> = set.map(|(name, value)| (name.to_owned(), value.to_owned())).collect();
    let stage = verify::own_scene("furnace_closed.scene", &set, run)?;
    let mut lab = Lab::new(run, Path::new("furnace_closed.scene"), seed);
    let shots = (0..PICTURES).map(|_| lab.shot(&stage, SPP)).collect::<Result<Vec<Shot>, _>>()?;
    let pictures: Vec<&[f32]> = shots.iter().map(|shot| &*shot.picture).collect();
    let reference = Reference::flat(truth, pictures[0].len()).expect("it shines");
    Ok(Estimate::of(&pictures, &reference))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reading_that_is_off_or_too_noisy_to_be_is_not_right() {
        let reading = |value, error| {
            Reading { what: "x", expected: 90.0, read: Number { value, error } }.is_right()
        };
        assert!(reading(91.0, 0.5) && !reading(93.0, 0.5) && !reading(90.0, 5.0));
        assert!(!reading(f64::NAN, 0.5) && !reading(90.0, f64::NAN));
    }
}
