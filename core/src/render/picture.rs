//! What the host does for an integrator that owns the whole picture.

use std::cell::{OnceCell, RefCell};
use std::time::Instant;

use glam::DVec3;
use luxel_sdk::kind::{
    Arrival, ArrivalKind, Output, PathsRef, PictureIntegrator, PictureJob, Raster, Wants,
};
use luxel_sdk::num::Ray;
use luxel_sdk::sampling::hash_combine;
use rayon::prelude::*;

use super::goal::Plan;
use super::lattice::Lattice;
use super::light::{Bundle, Splat};
use super::tile::Worker;
use super::watched::Watched;
use super::{FROM_CAMERA, Look, Reached, Stop};
use crate::accel::{Processor, Work};
use crate::film::{Film, Rect};
use crate::stage::{Asked, Emitters, First, Rooms, Skin, Stage};

/// Light paths that one thread follows at a time.
const BUNDLE: u32 = 1024;
/// Such bundles whose splats wait to be added in order.
const GROUP: u32 = 256;
/// Rays that one thread traces at a time.
const RAYS: usize = 256;

/// Lets an integrator make the picture.
pub(super) fn render(
    owner: &dyn PictureIntegrator,
    stage: &Stage,
    (plan, seed): (Plan, u32),
    (film, look): (&mut Film, &mut Look<'_>),
    (stop, end): (Stop<'_>, Option<Instant>),
) {
    let most = Wants(owner.wants().0 & (FROM_CAMERA.0 | Wants::SIGHT.0));
    let (window, output) = (film.window, owner.output());
    let (done, sum) = (film.most_samples(), vec![DVec3::ZERO; window.area()]);
    let is_good = plan.is_met(film, done);
    let pass = Pass { done, calls: 0, broken: false, is_good, sum };
    owner.render(&PictureHost {
        stage,
        seed,
        plan,
        stop,
        end,
        most,
        output,
        window,
        film: RefCell::new(film),
        look: RefCell::new(look),
        emitters: OnceCell::new(),
        pass: RefCell::new(pass),
    });
}

struct PictureHost<'a> {
    stage: &'a Stage,
    seed: u32,
    plan: Plan,
    stop: Stop<'a>,
    /// When the time is over.
    end: Option<Instant>,
    /// What is prepared for paths.
    most: Wants,
    output: Output,
    window: Rect,
    film: RefCell<&'a mut Film>,
    look: RefCell<&'a mut Look<'a>>,
    emitters: OnceCell<Emitters>,
    pass: RefCell<Pass>,
}

/// One sample of every pixel in the making.
struct Pass {
    /// Passes that were finished, those of a film that is gone on with among them.
    done: u32,
    /// Runs of light paths in this pass so far: each has numbers of its own.
    calls: u32,
    /// Whether something of it is missing.
    broken: bool,
    /// Whether the picture is as good as it is to be.
    is_good: bool,
    /// Of every pixel of the window, row by row.
    sum: Vec<DVec3>,
}

impl Pass {
    /// What tells the next run of light paths from all others of the picture.
    fn next_run(&mut self) -> u32 {
        self.calls = self.calls.wrapping_add(1);
        hash_combine(self.done, self.calls)
    }

    fn add(&mut self, splats: &[Splat], scale: f64, width: u32, window: Rect) {
        for Splat { pixel, rgb } in splats {
            let (x, y) = (pixel % width, pixel / width);
            let (x, y) = (x.wrapping_sub(window.min.x), y.wrapping_sub(window.min.y));
            if x < window.size.x && y < window.size.y {
                self.sum[y as usize * window.size.x as usize + x as usize] += *rgb * scale;
            }
        }
    }
}

impl PictureHost<'_> {
    /// Whether the pass can still count.
    fn goes_on(&self) -> bool {
        let pass = self.pass.borrow();
        !pass.broken && pass.done < self.plan.most() && !pass.is_good && !self.stop().is_asked()
    }

    /// When to end: until each pixel has a sample no time is over.
    fn stop(&self) -> Stop<'_> {
        let end = self.end.filter(|_| self.pass.borrow().done > 0);
        Stop { end, ..self.stop }
    }

    fn row(&self) -> usize {
        self.window.size.x as usize
    }
}

impl PictureJob for PictureHost<'_> {
    fn raster(&self) -> Raster {
        Raster { size: self.stage.film.resolution }
    }

    fn samples(&self) -> u32 {
        self.plan.most()
    }

    fn seed(&self) -> u32 {
        self.seed
    }

    fn is_cancelled(&self) -> bool {
        !self.goes_on()
    }

    fn trace_n(&self, rays: &[Ray], out: &mut [Arrival]) {
        trace_all(self.stage, rays, out);
    }

    fn occluded_n(&self, rays: &[Ray], out: &mut [bool]) {
        trace_all(self.stage, rays, out);
    }

    fn run_camera_paths(&self, paths: PathsRef<'_>) {
        if !self.goes_on() {
            return;
        }
        let paths = Watched(paths);
        let (stage, seed, stop, output) = (self.stage, self.seed, self.stop(), self.output);
        let (most, pass) = (Wants(self.most.0 & FROM_CAMERA.0), self.pass.borrow().done);
        let rects: Vec<Rect> = self.film.borrow().tiles().iter().map(|tile| tile.rect).collect();
        let found: Vec<Option<Vec<DVec3>>> = rects
            .par_iter()
            .map_init(
                || Worker::new(stage, seed, &paths, most, output),
                |worker, rect| {
                    let done = worker.samples(*rect, pass..pass + 1, Lattice::All, stop);
                    done.then(|| worker.results.clone())
                },
            )
            .collect();
        let mut pass = self.pass.borrow_mut();
        for (rect, found) in rects.iter().zip(found) {
            let Some(found) = found else {
                pass.broken = true;
                return;
            };
            for (at, rgb) in rect.points().zip(found) {
                let at = at - self.window.min;
                pass.sum[at.y as usize * self.row() + at.x as usize] += rgb;
            }
        }
    }

    fn run_light_paths(&self, n: u32, paths: PathsRef<'_>) {
        if !self.goes_on() || n == 0 {
            return;
        }
        let paths = Watched(paths);
        let (stage, seed, stop, output) = (self.stage, self.seed, self.stop(), self.output);
        let (most, run) = (self.most, self.pass.borrow_mut().next_run());
        let emitters = self.emitters.get_or_init(|| stage.opening().emitters());
        let n_bundles = n.div_ceil(BUNDLE);
        for group in (0..n_bundles).step_by(GROUP as usize) {
            let bundles = group..n_bundles.min(group.saturating_add(GROUP));
            let found: Vec<Option<Vec<Splat>>> = bundles
                .into_par_iter()
                .map_init(
                    || Worker::new(stage, seed, &paths, most, output),
                    |worker, i| {
                        let paths = i * BUNDLE..n.min((i * BUNDLE).saturating_add(BUNDLE));
                        worker.bundle(Bundle { emitters, run, paths }, stop)
                    },
                )
                .collect();
            let mut pass = self.pass.borrow_mut();
            for splats in found {
                let Some(splats) = splats else {
                    pass.broken = true;
                    return;
                };
                let width = stage.film.resolution.x;
                pass.add(&splats, 1.0 / f64::from(n), width, self.window);
            }
        }
    }

    fn finish_pass(&self) {
        if !self.goes_on() {
            return;
        }
        let mut pass = self.pass.borrow_mut();
        (pass.done, pass.calls) = (pass.done + 1, 0);
        for tile in self.film.borrow_mut().tiles_mut() {
            tile.next = pass.done;
            for (at, estimate) in tile.rect.points().zip(tile.pixels_mut()) {
                let at = at - self.window.min;
                estimate.push(pass.sum[at.y as usize * self.row() + at.x as usize]);
            }
        }
        pass.sum.fill(DVec3::ZERO);
        pass.is_good = self.plan.is_met(&self.film.borrow(), pass.done);
        let area = self.window.area() as u64;
        self.stop.control.add(area);
        let left = if pass.is_good { 0 } else { u64::from(self.plan.most() - pass.done) * area };
        let reached = Reached { step: 1, samples: pass.done, left, is_whole: true };
        (self.look.borrow_mut())(&self.film.borrow(), reached);
    }
}

/// Rays from anywhere when the shutter opens, which one thread traces, and what is found of each.
struct Batch<'a, 's, T> {
    stage: &'s Stage,
    rooms: &'a mut Rooms,
    rays: &'a [Ray],
    found: &'a mut [T],
}

/// Traces rays on all threads, as many as there are places for what is found.
fn trace_all<'s, T: Send>(stage: &'s Stage, rays: &[Ray], found: &mut [T])
where
    for<'a> Batch<'a, 's, T>: Work,
{
    let n = rays.len().min(found.len());
    let pieces = rays[..n].par_chunks(RAYS).zip(found[..n].par_chunks_mut(RAYS));
    pieces.for_each_init(
        || Rooms::of(stage),
        |rooms, (rays, found)| Processor::widest().run(Batch { stage, rooms, rays, found }),
    );
}

/// Where each arrives, as `Wants::POSITION` says.
impl Work for Batch<'_, '_, Arrival> {
    #[inline(always)]
    fn run(self, processor: Processor) {
        let Self { stage, rooms, rays, found } = self;
        let stage = stage.opening();
        stage.intersect_all(processor, asked(&stage, rays), rooms, |i, nearest, steps| {
            let (ray, at) = (&rays[i], &mut found[i]);
            let (t, wo, material) = (f64::INFINITY, -ray.d, u32::MAX);
            *at = Arrival { t, wo, material, steps, ..Arrival::default() };
            let Some(nearest) = nearest else { return };
            let Some(first) = stage.first(processor, ray, nearest, &mut at.steps) else { return };
            let First { t, hit, surface } = first;
            (at.kind, at.t) = (ArrivalKind::Surface, t);
            (at.p, at.p_err, at.uv) = (surface.p, surface.p_err, surface.uv.as_vec2());
            (at.ng, at.ns) = (surface.ng, surface.ns);
            if let Skin::Material(material) = stage.placements[hit.placement as usize].skin {
                at.material = material;
            }
        });
    }
}

/// Whether something stops each.
impl Work for Batch<'_, '_, bool> {
    #[inline(always)]
    fn run(self, processor: Processor) {
        let Self { stage, rooms, rays, found } = self;
        stage.occluded_all(processor, asked(stage, rays), rooms, |i, is_hit| found[i] = is_hit);
    }
}

fn asked<'a>(stage: &Stage, rays: &'a [Ray]) -> impl Iterator<Item = Asked<'a>> {
    let time = stage.film.time;
    rays.iter().map(move |ray| (ray, None, time))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn splats_outside_the_window_are_lost() {
        use glam::UVec2;
        let window = Rect::new(UVec2::new(1, 2), UVec2::new(2, 1));
        let sum = vec![DVec3::ZERO; window.area()];
        let mut pass = Pass { done: 0, calls: 0, broken: false, is_good: false, sum };
        let splats: Vec<_> = (0..20).map(|pixel| Splat { pixel, rgb: DVec3::ONE }).collect();
        pass.add(&splats, 0.5, 4, window);
        pass.add(&[Splat { pixel: u32::MAX - 1, rgb: DVec3::ONE }], 0.5, 4, window);
        // Of rows of four pixels, the second and third of the third.
        assert_eq!(pass.sum, [DVec3::splat(0.5); 2]);
        pass.add(&splats[9..10], 1.0, 4, window);
        assert_eq!(pass.sum, [DVec3::splat(1.5), DVec3::splat(0.5)]);
    }
}
