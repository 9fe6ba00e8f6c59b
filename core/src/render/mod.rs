//! Passes over the picture's tiles, on several threads, with progress and cancellation.

mod arrival;
mod light;
mod path;
mod picture;
mod shadow;
mod tile;
mod watched;

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use glam::UVec2;
use luxel_sdk::kind::Wants;
use rayon::prelude::*;

use crate::film::{Film, Rect};
use crate::stage::Stage;

/// What is asked of a render beyond the scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Samples per pixel instead of the sampler's.
    pub spp: Option<u32>,
    /// Seed instead of the sampler's.
    pub seed: Option<u32>,
    /// The part of the picture that is rendered; all if absent.
    pub crop: Option<Rect>,
    /// Threads; as many as there are cores if absent.
    pub threads: Option<NonZeroUsize>,
    /// Whether rays of path integrators take turns, which changes no bit; as is sooner for the stage
    /// if absent.
    pub turns: Option<bool>,
}

impl Options {
    /// Samples per pixel for this stage.
    pub fn samples(&self, stage: &Stage) -> u32 {
        self.spp.unwrap_or_else(|| stage.sampler.fixed().sampler().samples())
    }

    /// The seed for this stage.
    pub fn seed(&self, stage: &Stage) -> u32 {
        self.seed.unwrap_or_else(|| stage.sampler.fixed().sampler().seed())
    }
}

/// How a render is watched and stopped from another thread.
#[derive(Debug, Default)]
pub struct Control {
    cancelled: AtomicBool,
    samples: AtomicU64,
}

impl Control {
    /// Asks for an end. What has been measured stays valid.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Whether an end was asked for.
    pub fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Samples that have been added to pixels so far.
    pub fn samples_done(&self) -> u64 {
        self.samples.load(Ordering::Relaxed)
    }
}

/// How far a render came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Every pixel has all its samples.
    Complete,
    /// Code of a library failed in an object of the scene; what was measured may be wrong.
    Failed,
    /// It was cancelled; pixels have different numbers of samples, some perhaps none.
    Cancelled,
}

/// Most samples of a pixel in one pass.
const PASS: u32 = 16;

/// What is prepared for paths from the camera.
const FROM_CAMERA: Wants =
    Wants::EMISSION.with(Wants::DIRECT).with(Wants::SCATTER).with(Wants::CURVATURE);

/// Renders the stage.
///
/// The same stage, samples and seed give the same bits for any number of threads and any crop.
///
/// # Panics
/// If the system gives no threads.
pub fn render(stage: &Stage, options: &Options, control: &Control) -> (Film, Outcome) {
    let size = stage.film.resolution;
    let window = options.crop.unwrap_or(Rect::new(UVec2::ZERO, size));
    let mut film = Film::new(size, window);
    let threads = options.threads.map_or(0, NonZeroUsize::get);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect("the system gives threads");
    // Before anything of the stage is asked: the sampler may fail at once.
    let failures = AtomicU64::new(stage.alarm().count());
    let stop = Stop { control, stage, failures: &failures };
    let (spp, seed) = (options.samples(stage), options.seed(stage));
    let turns = options.turns.unwrap_or_else(|| stage.is_for_turns());
    pool.install(|| {
        let integrator = stage.integrator.fixed().integrator();
        if let Some(owner) = integrator.as_picture() {
            return picture::render(owner, stage, (spp, seed), &mut film, stop);
        }
        let mut from = 0;
        while from < spp && !stop.is_asked() {
            // Passes grow: a first picture comes soon, later ones cost little to gather.
            let to = spp.min(from + from.clamp(1, PASS));
            film.tiles_mut().par_iter_mut().for_each_init(
                || {
                    let output = integrator.output();
                    let worker = tile::Worker::new(stage, seed, integrator, FROM_CAMERA, output);
                    worker.in_turns(turns)
                },
                |worker, tile| worker.pass(tile, from..to, stop),
            );
            from = to;
        }
    });
    let outcome = match (stop.is_failure(), control.is_cancelled()) {
        (true, _) => Outcome::Failed,
        (_, true) => Outcome::Cancelled,
        _ => Outcome::Complete,
    };
    (film, outcome)
}

/// Whether to go on: polled between rounds.
#[derive(Clone, Copy)]
struct Stop<'a> {
    control: &'a Control,
    stage: &'a Stage,
    /// How many objects had failed when it was looked whether one is the stage's own.
    failures: &'a AtomicU64,
}

impl Stop<'_> {
    fn is_failure(self) -> bool {
        let count = self.stage.alarm().count();
        if count == self.failures.load(Ordering::Relaxed) {
            return false;
        }
        // Objects of another stage may have failed: of one that was built meanwhile.
        let own = self.stage.has_failed();
        if !own {
            self.failures.store(count, Ordering::Relaxed);
        }
        own
    }

    fn is_asked(self) -> bool {
        self.control.is_cancelled() || self.is_failure()
    }
}

impl Control {
    fn add(&self, samples: u64) {
        self.samples.fetch_add(samples, Ordering::Relaxed);
    }
}
