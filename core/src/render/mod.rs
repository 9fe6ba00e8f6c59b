//! Passes over the picture's tiles, on several threads, with progress and cancellation.

mod arrival;
mod develop;
mod fly;
mod goal;
mod jobs;
mod lattice;
mod light;
mod passes;
mod path;
mod picture;
mod record;
mod shadow;
mod tile;
mod watched;

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use glam::UVec2;
use luxel_sdk::kind::{PictureIntegrator, Wants};
use rayon::prelude::*;

use self::goal::Plan;
use self::passes::{SLOW, Turn, passes, slices};
use crate::film::{COARSEST, Film, Holds, Rect};
use crate::registry::dynamic::remote;
use crate::stage::{Rooms, Stage};

pub use self::goal::Goal;

/// What is asked of a render beyond the scene.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Samples per pixel instead of the sampler's; with a goal, the most of them.
    pub spp: Option<u32>,
    /// How good the picture is to be, instead of a number of samples.
    pub goal: Goal,
    /// Seed instead of the sampler's.
    pub seed: Option<u32>,
    /// The part of the picture that is rendered; all if absent.
    pub crop: Option<Rect>,
    /// Threads; as many as there are cores if absent.
    pub threads: Option<NonZeroUsize>,
    /// Whether rays of path integrators go side by side, which changes no bit; as is sooner for the stage
    /// if absent.
    pub side_by_side: Option<bool>,
    /// Whether the first sample comes in steps, every eighth pixel of every eighth row first: for
    /// those who look on. Changes no bit.
    pub coarse: bool,
    /// Whether threads let others of the machine go first, as who draws the picture for those who look
    /// on: on Linux they are nicer, and until each pixel has a sample there is one of three or more less.
    /// Changes no bit.
    pub courteous: bool,
}

impl Options {
    /// Samples per pixel for this stage; with a goal, the most of them.
    pub fn samples(&self, stage: &Stage) -> u32 {
        let of_scene = || stage.sampler.fixed().sampler().samples();
        self.spp.unwrap_or_else(|| if self.goal.is_some() { goal::MOST } else { of_scene() })
    }

    /// Samples per pixel that are asked for before it is known how many more are needed.
    pub fn samples_at_first(&self, stage: &Stage) -> u32 {
        let most = self.samples(stage);
        if self.goal.is_some() { most.min(goal::LEAST) } else { most }
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
    /// Whether it may have to stand still, and until when.
    held: (AtomicBool, Mutex<Option<Instant>>),
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

    /// Has the render stand still until it is released, a tenth of a second at most; a picture that begins
    /// with coarse steps not before the first of them is to be seen. Whoever holds it has better use for
    /// the processors. Changes no bit, unless time is what the picture is to have.
    pub fn hold(&self) {
        *self.until() = Some(Instant::now() + LONGEST);
        self.held.0.store(true, Ordering::Relaxed);
    }

    /// Lets it go on.
    pub fn release(&self) {
        self.held.0.store(false, Ordering::Relaxed);
    }

    fn until(&self) -> MutexGuard<'_, Option<Instant>> {
        self.held.1.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_held(&self) -> bool {
        self.held.0.load(Ordering::Relaxed)
            && !self.is_cancelled()
            && !self.is_superseded()
            && self.until().is_some_and(|until| Instant::now() < until)
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
    /// Samples of those pixels; the most where they differ.
    pub samples: u32,
    /// Samples that are missing, as far as one can tell.
    pub left: u64,
    /// Whether all pixels of that step have them. If not, the pass goes on: what there is can be kept,
    /// and is not meant to be shown.
    pub is_whole: bool,
}

/// Sees a picture grow: told after each pass, and a few seconds after it was last told, while nothing is
/// measured.
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
    let mut film = empty_film(stage, window);
    let outcome = render_on(&mut film, stage, options, control, look);
    (film, outcome)
}

/// Whether an integrator owns the whole picture of the stage.
pub fn is_owned(stage: &Stage) -> bool {
    owner(stage).is_some()
}

/// What owns the whole picture.
fn owner(stage: &Stage) -> Option<&dyn PictureIntegrator> {
    stage.integrator.fixed().integrator().as_picture()
}

/// Whether a picture of the stage that was left unfinished can be gone on with: not where an
/// integrator owns the picture whose passes depend on what it has seen before.
pub fn can_go_on(stage: &Stage) -> bool {
    owner(stage).is_none_or(PictureIntegrator::has_independent_passes)
}

/// Whether a finished picture of the stage can be gone on with for more samples: not where the sampler
/// is a library's, which may give others when it is asked for more.
pub fn can_take_more(stage: &Stage) -> bool {
    can_go_on(stage) && remote(stage.sampler.class()).is_none()
}

/// What a pixel of the stage's picture takes.
pub fn bytes_of_pixel(stage: &Stage) -> usize {
    empty_film(stage, Rect::new(UVec2::ZERO, UVec2::ONE)).bytes()
}

/// A film for a part of the stage's picture, with room for what is recorded beside colour: nothing
/// where an integrator owns the picture.
pub fn empty_film(stage: &Stage, window: Rect) -> Film {
    let holds = || Holds { layers: stage.film.layers.clone(), groups: stage.lights.groups.clone() };
    let holds = if is_owned(stage) { Holds::default() } else { holds() };
    Film::holding(stage.film.resolution, window, holds)
}

/// Goes on with a film, whose window is what is measured. With the same stage, seed and goal the bits
/// in the end are those of a render that was never left; not after coarse steps of which some are
/// missing, which the film does not count as samples.
///
/// # Panics
/// As `render`; if a film is gone on with that `can_go_on` denies.
pub fn render_on(
    film: &mut Film,
    stage: &Stage,
    options: &Options,
    control: &Control,
    look: &mut Look<'_>,
) -> Outcome {
    let [first, all] = crews(options);
    let (pool, first) = (crew(all, options), (first < all).then(|| crew(first, options)));
    // No count of failures is known: the stage may have failed before, when it was asked for a pixel.
    let failures = AtomicU64::new(u64::MAX);
    let end = options.goal.time.and_then(|time| Instant::now().checked_add(time));
    let stop = Stop { control, stage, failures: &failures, first: false, end: None };
    let plan = Plan::new(options.goal, options.samples(stage));
    let seed = options.seed(stage);
    let rooms = || match options.side_by_side {
        None => Rooms::of(stage),
        Some(true) => Rooms::side_by_side(),
        Some(false) => Rooms::one_by_one(),
    };
    pool.install(|| {
        let integrator = stage.integrator.fixed().integrator();
        if let Some(owner) = owner(stage) {
            assert!(film.samples() == 0 || can_go_on(stage), "what it has seen is not known");
            return picture::render(owner, stage, (plan, seed), (film, look), (stop, end));
        }
        let holds = film.holds.clone();
        let worker = || {
            let output = integrator.output();
            tile::Worker::new(stage, seed, integrator, FROM_CAMERA, output)
                .tracing(rooms())
                .recording(&holds)
        };
        let mut pass = |film: &mut Film, turn: Turn| {
            slices(film, turn, SLOW, look, &mut |film, ends, late| {
                // Until each pixel has a sample no time is over.
                let end = end.filter(|_| film.tiles().iter().all(|tile| tile.next > 0));
                let stop = Stop { first: turn.lattice.step() == COARSEST, end, ..stop };
                let columns = film.columns();
                let tiles = film.tiles_mut();
                if turn.lattice.step() > 1 {
                    // Of one tile there are too few pixels to keep a worker busy.
                    let rows = tiles.chunks_mut(columns);
                    let strips: Vec<_> = rows.flat_map(|row| row.chunks_mut(STRIP)).collect();
                    strips.into_par_iter().for_each_init(worker, |worker, strip| {
                        worker.pass(strip, 0..1, turn.lattice, stop);
                    });
                } else {
                    let tiles = tiles.par_chunks_mut(1).zip(ends).enumerate();
                    tiles.for_each_init(worker, |worker, (i, (tile, end))| {
                        if !late.is_over(i) {
                            worker.pass(tile, tile[0].next..*end, turn.lattice, stop);
                        }
                    });
                }
                !stop.is_asked()
            })
        };
        passes(film, &plan, options.coarse, &mut |film, turn| match &first {
            Some(few) if film.samples() == 0 => few.install(|| pass(film, turn)),
            _ => pass(film, turn),
        });
    });
    match (stop.is_failure(), stop.is_asked()) {
        (true, _) => Outcome::Failed,
        (_, true) => Outcome::Cancelled,
        _ => Outcome::Complete,
    }
}

/// How many threads render until each pixel has a sample, and how many from then on: while there is little
/// to be seen, whoever draws it for those who look on has a core of its own, if there are three.
fn crews(options: &Options) -> [usize; 2] {
    let cores = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let all = options.threads.map_or_else(cores, NonZeroUsize::get);
    let spared = usize::from(options.courteous && all >= ENOUGH);
    [all - spared, all]
}

fn crew(threads: usize, options: &Options) -> rayon::ThreadPool {
    let courteous = options.courteous;
    let begun = move |_| {
        if courteous {
            give_way(Courtesy::Render);
        }
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).start_handler(begun);
    pool.build().expect("the system gives threads")
}

/// Of what the threads are that let others of the machine go first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Courtesy {
    /// They make a scene ready, for which somebody waits: before those that render, with two thirds of the
    /// share of those that do not give way.
    Ready,
    /// They render: with a third of that share.
    Render,
}

/// Has the calling thread, and those that it starts, let others of the machine go first. On Linux alone.
#[cfg(target_os = "linux")]
pub fn give_way(courtesy: Courtesy) {
    let steps = match courtesy {
        Courtesy::Ready => 2,
        Courtesy::Render => 5,
    };
    // A system that refuses has its reasons.
    let _ = rustix::process::nice(steps);
}

/// Has the calling thread, and those that it starts, let others of the machine go first. On Linux alone.
#[cfg(not(target_os = "linux"))]
pub fn give_way(_: Courtesy) {}

/// With fewer threads than this one less would cost more than it gives.
const ENOUGH: usize = 3;

/// So long a render is held at most.
const LONGEST: Duration = Duration::from_millis(100);

/// Between two looks of a thread that is held.
const HELD: Duration = Duration::from_micros(200);

/// Tiles side by side whose pixels of a coarse step are measured together.
const STRIP: usize = 16;

/// Whether to go on: polled between rounds.
#[derive(Clone, Copy)]
struct Stop<'a> {
    control: &'a Control,
    stage: &'a Stage,
    /// How many objects had failed when it was looked whether one is the stage's own.
    failures: &'a AtomicU64,
    /// Whether there is nothing to be seen yet that soon will be.
    first: bool,
    /// When the time is over.
    end: Option<Instant>,
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

    /// Waits while the render is held.
    fn wait(self) {
        while self.control.is_held() && !self.first {
            std::thread::sleep(HELD);
        }
    }

    fn is_asked(self) -> bool {
        let superseded = self.control.is_superseded() && !self.first;
        self.control.is_cancelled() || superseded || self.is_late() || self.is_failure()
    }

    fn is_late(self) -> bool {
        self.end.is_some_and(|end| Instant::now() >= end)
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
    fn a_render_is_held_until_it_is_released_asked_to_end_or_held_for_long() {
        let held = || {
            let control = Control::default();
            assert!(!control.is_held());
            control.hold();
            control
        };
        assert!(held().is_held());
        for end in [Control::release, Control::supersede, Control::cancel] {
            let control = held();
            end(&control);
            assert!(!control.is_held());
        }
        let control = held();
        std::thread::sleep(LONGEST);
        assert!(!control.is_held());
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn threads_that_give_way_and_those_that_they_start_are_nice_and_no_others() {
        let own = || rustix::process::getpriority_process(None).unwrap();
        let nice = |courtesy: Option<Courtesy>| {
            let asked = move || {
                courtesy.into_iter().for_each(give_way);
                std::thread::spawn(own).join().unwrap()
            };
            std::thread::spawn(asked).join().unwrap()
        };
        let before = nice(None);
        assert_eq!(nice(Some(Courtesy::Ready)), 19.min(before + 2));
        assert_eq!(nice(Some(Courtesy::Render)), 19.min(before + 5));
        assert_eq!(nice(None), before);
        for (courteous, wanted) in [(false, before), (true, 19.min(before + 5))] {
            let crew = crew(2, &Options { courteous, ..Options::default() });
            assert_eq!(crew.broadcast(|_| own()), [wanted; 2]);
        }
    }

    #[test]
    fn one_core_of_three_is_spared_until_each_pixel_has_a_sample() {
        for (threads, alone, watched) in [
            (1, [1, 1], [1, 1]),
            (2, [2, 2], [2, 2]),
            (3, [3, 3], [2, 3]),
            (16, [16, 16], [15, 16]),
        ] {
            for (courteous, wanted) in [(false, alone), (true, watched)] {
                let threads = NonZeroUsize::new(threads);
                let options = Options { threads, courteous, ..Options::default() };
                assert_eq!(crews(&options), wanted);
            }
        }
        let cores = std::thread::available_parallelism().unwrap().get();
        assert_eq!(crews(&Options::default()), [cores; 2]);
    }
}
