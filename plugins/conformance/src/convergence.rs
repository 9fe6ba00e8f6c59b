//! Integrators: the error falls with the root of the number of samples, and a render ends when it is
//! asked to.

use std::num::NonZeroUsize;
use std::time::{Duration, Instant};

use glam::UVec2;
use luxel_core::film::Film;
use luxel_core::render::{Control, Options, Outcome, render};
use luxel_core::stage::Stage;

use crate::integrator::{SIDE, TILE, open_scene, stage};
use crate::report::Judge;
use crate::subject::Subject;

/// Pictures of each number of samples, each with a seed of its own.
const PICTURES: u32 = 12;

/// Samples of a pixel, and four times as many: half the error.
const FEW: u32 = 8;
const MORE: u32 = 4 * FEW;

/// Variance of the logarithm of a variance estimated from so many pictures: the trigamma function of
/// half their degrees of freedom, ψ₁(11/2).
const LOG_VARIANCE: f64 = 0.199_342_397;

/// What a busy machine may take to wake a thread.
const WAKING: Duration = Duration::from_millis(250);

/// So many samples never come to an end by themselves.
const ENDLESS: u32 = u32::MAX;

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    let Some(set) = subject.sets.first() else { return };
    // That it cannot be built has been said.
    let Some(stage) = stage(subject.bench, &open_scene, subject.class.name, &set.given) else {
        return;
    };
    ends_when_asked(&stage, judge);
    let [few, more] = [FEW, MORE].map(|spp| {
        let films = (0..PICTURES).map(|i| picture(&stage, 100 + spp * PICTURES + i, spp));
        films.map(|film| tiles(&film)).collect::<Vec<_>>()
    });
    match slowness(&few, &more) {
        Some(z) => judge.statistic("error falls as N^-1/2", z, || {
            format!("{}: between {FEW} and {MORE} samples per pixel", set.label)
        }),
        None => judge.skip("error falls as N^-1/2", "there is no noise"),
    }
}

fn options(seed: u32, spp: u32) -> Options {
    Options {
        spp: Some(spp),
        seed: Some(seed),
        threads: NonZeroUsize::new(2),
        ..Options::default()
    }
}

fn picture(stage: &Stage, seed: u32, spp: u32) -> Film {
    render(stage, &options(seed, spp), &Control::default()).0
}

/// The sum of each tile's means.
fn tiles(film: &Film) -> Vec<f64> {
    let across = SIDE / TILE;
    let sum = |tile: u32| -> f64 {
        let corner = UVec2::new(tile % across, tile / across) * TILE;
        let inside = (0..TILE * TILE).map(|i| corner + UVec2::new(i % TILE, i / TILE));
        inside.map(|at| film.pixel(at).mean.y).sum()
    };
    (0..across * across).map(sum).collect()
}

/// How much too slowly the variance between pictures falls from the first to the second, which have
/// four times the samples; in standard deviations. `None` where nothing varies.
///
/// Of each tile the logarithm of the ratio: all tiles count alike, however noisy.
fn slowness(few: &[Vec<f64>], more: &[Vec<f64>]) -> Option<f64> {
    let n_tiles = few.first()?.len();
    let logs: Vec<f64> = (0..n_tiles)
        .filter_map(|tile| {
            let [a, b] = [few, more].map(|films| variance(films.iter().map(|film| film[tile])));
            let ratio = (4.0 * b / a).ln();
            ratio.is_finite().then_some(ratio)
        })
        .collect();
    let n = logs.len() as f64;
    let mean = logs.iter().sum::<f64>() / n;
    mean.is_finite().then(|| mean / (2.0 * LOG_VARIANCE / n).sqrt())
}

fn variance(values: impl Iterator<Item = f64>) -> f64 {
    let values: Vec<f64> = values.collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0)
}

/// A render without end, cancelled: it must return after the round in hand. A picture of one sample
/// is many rounds, and takes longer than any of them.
fn ends_when_asked(stage: &Stage, judge: &mut Judge) {
    let since = Instant::now();
    picture(stage, 7, 1);
    let limit = WAKING + 4 * since.elapsed();
    let control = Control::default();
    let (outcome, took) = std::thread::scope(|scope| {
        let rendering = scope.spawn(|| render(stage, &options(8, ENDLESS), &control).1);
        while control.samples_done() == 0 && !rendering.is_finished() {
            std::thread::sleep(Duration::from_millis(1));
        }
        let since = Instant::now();
        control.cancel();
        (rendering.join(), since.elapsed())
    });
    let ended = matches!(outcome, Ok(Outcome::Cancelled)) && took <= limit;
    judge.holds("a render ends when asked", ended, || {
        format!("{outcome:?} after {} ms, at most {}", took.as_millis(), limit.as_millis())
    });
}

#[cfg(test)]
mod tests {
    use luxel_sdk::sampling::Rng;

    use super::*;

    /// Pictures of 16 tiles whose noise has these standard deviations: sums of a dozen uniforms.
    fn pictures(seed: u64, sigma: impl Fn(usize) -> f64) -> Vec<Vec<f64>> {
        let mut rng = Rng::new(seed);
        let mut normal = || (0..12).map(|_| f64::from(rng.f32())).sum::<f64>() - 6.0;
        let mut picture = || (0..16).map(|tile| 1.0 + sigma(tile) * normal()).collect();
        (0..PICTURES).map(|_| picture()).collect()
    }

    #[test]
    fn an_error_that_halves_passes_and_one_that_stays_does_not() {
        let uneven = |scale: f64| move |tile: usize| scale * (1.0 + tile as f64 * tile as f64);
        for seed in 0..20 {
            let few = pictures(2 * seed, uneven(1.0));
            let halved = slowness(&few, &pictures(2 * seed + 1, uneven(0.5))).unwrap();
            // Three of a million would be beyond.
            assert!(halved < 5.0, "{halved}");
            let same = slowness(&few, &pictures(2 * seed + 1, uneven(1.0))).unwrap();
            assert!(same > 5.0, "{same}");
        }
        assert_eq!(slowness(&pictures(0, |_| 0.0), &pictures(1, |_| 0.0)), None);
    }
}
