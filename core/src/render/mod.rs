//! Passes over the picture's tiles, on several threads, with progress and cancellation.

mod arrival;
mod lattice;
mod light;
mod path;
mod picture;
mod shadow;
mod tile;
mod watched;

use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use glam::UVec2;
use luxel_sdk::kind::Wants;
use rayon::prelude::*;

use self::lattice::Lattice;
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
    /// Whether the first sample comes in steps, every eighth pixel of every eighth row first: for
    /// those who look on. Changes no bit.
    pub coarse: bool,
    /// Whether threads let others of the machine go first, as who draws the picture for those who look
    /// on. On Linux alone; changes no bit.
    pub courteous: bool,
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
    superseded: AtomicBool,
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

    /// Asks for an end as soon as there is something to see: after the first of the coarse steps, if
    /// the picture begins with such. So pictures follow each other however fast they are asked for.
    pub fn supersede(&self) {
        self.superseded.store(true, Ordering::Relaxed);
    }

    /// Whether an end was asked for in this way.
    pub fn is_superseded(&self) -> bool {
        self.superseded.load(Ordering::Relaxed)
    }

    /// Samples that have been added to pixels so far.
    pub fn samples_done(&self) -> u64 {
        self.samples.load(Ordering::Relaxed)
    }
}

/// How far a picture has come, for those who look on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reached {
    /// Pixels from one that has a sample to the next; 1 once all have.
    pub step: u32,
    /// Samples of those pixels.
    pub samples: u32,
}

/// Sees a picture grow: told after each pass, while nothing is measured.
pub type Look<'a> = dyn FnMut(&Film, Reached) + Send + 'a;

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
    render_seen(stage, options, control, &mut |_, _| {})
}

/// The same, seen as it grows.
///
/// # Panics
/// As `render`.
pub fn render_seen(
    stage: &Stage,
    options: &Options,
    control: &Control,
    look: &mut Look<'_>,
) -> (Film, Outcome) {
    let size = stage.film.resolution;
    let window = options.crop.unwrap_or(Rect::new(UVec2::ZERO, size));
    let threads = options.threads.map_or(0, NonZeroUsize::get);
    let courteous = options.courteous;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .start_handler(move |_| give_way(courteous))
        .build()
        .expect("the system gives threads");
    let mut film = Film::new(size, window);
    // No count of failures is known: the stage may have failed before, when it was asked for a pixel.
    let failures = AtomicU64::new(u64::MAX);
    let stop = Stop { control, stage, failures: &failures, first: false };
    let (spp, seed) = (options.samples(stage), options.seed(stage));
    let turns = options.turns.unwrap_or_else(|| stage.is_for_turns());
    pool.install(|| {
        let integrator = stage.integrator.fixed().integrator();
        if let Some(owner) = integrator.as_picture() {
            return picture::render(owner, stage, (spp, seed), (&mut film, look), stop);
        }
        let worker = || {
            let output = integrator.output();
            tile::Worker::new(stage, seed, integrator, FROM_CAMERA, output).in_turns(turns)
        };
        for (samples, lattice) in passes(spp, options.coarse) {
            let stop = Stop { first: lattice.step() == lattice::COARSEST, ..stop };
            film.tiles_mut().par_iter_mut().for_each_init(worker, |worker, tile| {
                worker.pass(tile, samples.clone(), lattice, stop);
            });
            if stop.is_asked() {
                break;
            }
            look(&film, Reached { step: lattice.step(), samples: samples.end });
        }
    });
    let outcome = match (stop.is_failure(), stop.is_asked()) {
        (true, _) => Outcome::Failed,
        (_, true) => Outcome::Cancelled,
        _ => Outcome::Complete,
    };
    (film, outcome)
}

/// Lets other threads of the machine go first: a third of the share of those that do not.
#[cfg(target_os = "linux")]
fn give_way(courteous: bool) {
    if courteous {
        // A system that refuses has its reasons.
        let _ = rustix::process::nice(COURTESY);
    }
}

#[cfg(not(target_os = "linux"))]
fn give_way(_: bool) {}

/// Steps of niceness.
#[cfg(target_os = "linux")]
const COURTESY: i32 = 5;

/// The samples and the pixels of each pass. Passes grow: a first picture comes soon, later ones cost
/// little to gather.
fn passes(spp: u32, coarse: bool) -> impl Iterator<Item = (Range<u32>, Lattice)> {
    let steps = Lattice::steps(coarse).into_iter().filter(move |_| spp > 0);
    let first = steps.map(|lattice| (0..1, lattice));
    let after = move |done: &Range<u32>| {
        let next = done.end..spp.min(done.end.saturating_add(done.end.min(PASS)));
        (!next.is_empty()).then_some(next)
    };
    let later = std::iter::successors(after(&(0..1)), after).map(|samples| (samples, Lattice::All));
    first.chain(later)
}

/// Whether to go on: polled between rounds.
#[derive(Clone, Copy)]
struct Stop<'a> {
    control: &'a Control,
    stage: &'a Stage,
    /// How many objects had failed when it was looked whether one is the stage's own.
    failures: &'a AtomicU64,
    /// Whether there is nothing to be seen yet that soon will be.
    first: bool,
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
        let superseded = self.control.is_superseded() && !self.first;
        self.control.is_cancelled() || superseded || self.is_failure()
    }
}

impl Control {
    fn add(&self, samples: u64) {
        self.samples.fetch_add(samples, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn courteous_threads_are_nice_and_no_others() {
        let nice = |courteous: bool| {
            let asked = move || {
                give_way(courteous);
                rustix::process::getpriority_process(None).unwrap()
            };
            std::thread::spawn(asked).join().unwrap()
        };
        let [before, courteous, after] = [false, true, false].map(nice);
        assert_eq!((courteous, after), (19.min(before + COURTESY), before));
    }

    #[test]
    fn passes_are_each_sample_of_each_pixel_once() {
        for spp in [0, 1, 2, 3, 17, 100] {
            let all: Vec<_> = passes(spp, false).flat_map(|(samples, _)| samples).collect();
            assert_eq!(all, (0..spp).collect::<Vec<_>>());
            let coarse = passes(spp, true).filter(|(samples, _)| samples.start == 0);
            assert_eq!(coarse.count(), if spp == 0 { 0 } else { 4 });
        }
        assert!(
            passes(u32::MAX, false).all(|(samples, _)| samples.len() <= 16 || samples.end < 64)
        );
    }
}
