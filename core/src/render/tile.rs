//! One worker: keeps many paths in flight, of a tile or from lights, and adds their samples in order.

use std::ops::Range;

use glam::{DVec3, UVec2};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Arrival, Erased, Host, Integrator, Job, Lane, Onward, Output, Requests, Round, SampleAt,
    Sampler, Samples, Shadow, Wants,
};
use luxel_sdk::num::Ray;
use luxel_sdk::sampling::hash_combine;

use super::arrival::Shader;
use super::develop::Develop;
use super::fly::Fly;
use super::jobs::Jobs;
use super::lattice::Lattice;
use super::light::Splat;
use super::path::Path;
use super::record::Recorder;
use super::{Stop, shadow};
use crate::accel::{Processor, Work};
use crate::cast;
use crate::film::{COARSEST, Holds, Rect, TILE, Tile};
use crate::object::Scratch;
use crate::stage::{Moment, Rooms, SceneHit, Stage};

/// Paths in flight per worker: the best of 8…4096 measured; their state stays in the cache.
const LANES: usize = 128;

/// What one thread needs; reused from tile to tile.
pub(super) struct Worker<'s> {
    pub(super) stage: &'s Stage,
    pub(super) processor: Processor,
    pub(super) seed: u32,
    pub(super) sampler: &'s dyn Sampler,
    pub(super) wants: Wants,
    states: Box<dyn Erased + 's>,
    /// What begins next.
    pub(super) job: Job,
    pub(super) lanes: Vec<Lane>,
    pub(super) paths: Vec<Path>,
    free: Vec<u32>,
    /// What the running round answers, and what it asks for.
    pub(super) now: Requests,
    next: Requests,
    /// What the rays of this round meet first, and in how many steps that was found.
    pub(super) hits: Vec<(Option<SceneHit>, u32)>,
    shadowed: Vec<bool>,
    /// Whether rays meet more on their way than surfaces that end them: media, open or nested ones.
    goes_through: bool,
    /// How the rays of a round are traced.
    rooms: Rooms,
    arrived: Vec<u32>,
    pub(super) results: Vec<DVec3>,
    /// The pixels of the running pass, by their numbers in the tile.
    chosen: Vec<u32>,
    /// Light for other pixels than the path's own.
    pub(super) splats: Vec<Splat>,
    pub(super) scratch: Scratch,
    /// For a medium's parameters while its phase function is asked.
    pub(super) medium_scratch: Scratch,
    to_rgb: Develop,
    /// What else than light is wanted of paths.
    record: Recorder,
}

impl<'s> Worker<'s> {
    /// Follows paths of an integrator, and prepares no more for them than `most`.
    pub(super) fn new(
        stage: &'s Stage,
        seed: u32,
        integrator: &'s dyn Integrator,
        most: Wants,
        output: Output,
    ) -> Self {
        let at = SampleAt { stream: 0, index: 0, dimension: 0 };
        let mut wants = Wants(integrator.wants().0 & most.0);
        if !stage.lights.is_sought() {
            wants.0 &= !Wants::DIRECT.0;
        }
        let lane =
            Lane { at: Arrival::default(), l: Spectrum::ZERO, glow: Spectrum::ZERO, numbers: at };
        Self {
            stage,
            processor: Processor::widest(),
            seed,
            sampler: stage.sampler.fixed().sampler(),
            wants,
            states: integrator.lanes(LANES),
            job: Job::of_camera(Ray::new(DVec3::ZERO, DVec3::Z)),
            lanes: vec![lane; LANES],
            paths: vec![Path::new(stage); LANES],
            free: vec![],
            now: Requests::default(),
            next: Requests::default(),
            hits: vec![],
            shadowed: vec![],
            goes_through: stage.features.media() || stage.features.is_open(),
            rooms: Rooms::of(stage),
            arrived: vec![],
            results: vec![],
            chosen: vec![],
            splats: vec![],
            scratch: Scratch::default(),
            medium_scratch: Scratch::default(),
            to_rgb: Develop::new(stage, output),
            record: Recorder::new(&Holds::default(), LANES),
        }
    }

    /// The same, which traces rays as is wanted.
    pub(super) fn tracing(self, rooms: Rooms) -> Self {
        Self { rooms, ..self }
    }

    /// The same, which records layers too.
    pub(super) fn recording(self, holds: &Holds) -> Self {
        Self { record: Recorder::new(holds, LANES), ..self }
    }

    /// Adds the samples of a range to the pixels that a lattice names, of tiles side by side. A pass that
    /// is cancelled adds none.
    pub(super) fn pass(
        &mut self,
        tiles: &mut [Tile],
        range: Range<u32>,
        lattice: Lattice,
        stop: Stop<'_>,
    ) {
        let (n, end, rect) = (range.len(), range.end, strip(tiles));
        if n == 0 || !self.samples(rect, range, lattice, stop) {
            return;
        }
        if lattice.step() == COARSEST {
            tiles.iter_mut().for_each(Tile::begin_coarsely);
        }
        let n_pixels = self.chosen.len();
        for (i, pixel) in self.chosen.iter().enumerate() {
            let (x, y) = (pixel % rect.size.x, pixel / rect.size.x);
            let tile = &mut tiles[(x / TILE) as usize];
            let number = (y * tile.rect.size.x + x % TILE) as usize;
            if self.record.is_on() {
                self.record.add(tile, number, (i, n_pixels), &self.results);
            }
            let estimate = tile.pixel_mut(number);
            for sample in 0..n {
                estimate.push(self.results[sample * n_pixels + i]);
            }
        }
        if lattice.step() == 1 {
            for tile in tiles {
                tile.next = end;
            }
        }
        stop.control.add((n_pixels * n) as u64);
    }

    /// Finds the samples of a range in the pixels of a rectangle that a lattice names: `results`,
    /// sample by sample. False when cancelled.
    pub(super) fn samples(
        &mut self,
        rect: Rect,
        range: Range<u32>,
        lattice: Lattice,
        stop: Stop<'_>,
    ) -> bool {
        let mut pixels = std::mem::take(&mut self.chosen);
        pixels.clear();
        pixels.extend(lattice.of(rect));
        self.splats.clear();
        self.results.clear();
        self.results.resize(pixels.len() * range.len(), DVec3::ZERO);
        self.record.clear(pixels.len() * range.len());
        let (origin, width) = (rect.min, rect.size.x);
        let jobs = Jobs::Pixels { origin, width, pixels: &pixels, range };
        let done = !stop.is_asked() && self.run(&jobs, stop);
        self.chosen = pixels;
        done
    }

    /// Rounds until every job is done; false when cancelled. One thing at a time for all paths:
    /// neighbours in time do not wait for each other. What a round does is compiled for what the scene
    /// requires: where no line requires media, open surfaces or nested shapes, or a choice among lights,
    /// nothing in it asks for them.
    pub(super) fn run(&mut self, jobs: &Jobs<'_>, stop: Stop<'_>) -> bool {
        let mut started = 0;
        self.free.clear();
        self.free.extend((0..cast::index(LANES)).rev());
        self.next.clear();
        loop {
            self.refill(jobs, &mut started);
            if self.next.rays.is_empty() && self.next.shadows.is_empty() {
                return true;
            }
            stop.wait();
            if stop.is_asked() {
                return false;
            }
            std::mem::swap(&mut self.now, &mut self.next);
            self.next.clear();
            if self.goes_through {
                self.processor.run(Shadows::<true>(self));
                self.processor.run(Trace(self));
                self.processor.run(Fly(self));
            } else {
                self.processor.run(Shadows::<false>(self));
                self.processor.run(Trace(self));
                if self.stage.features.light_choice() {
                    self.processor.run(Shade::<true>(self));
                } else {
                    self.processor.run(Shade::<false>(self));
                }
            }
            self.arrivals();
            self.retire();
        }
    }

    /// Starts jobs in the lanes that are free.
    fn refill(&mut self, jobs: &Jobs<'_>, started: &mut usize) {
        while *started < jobs.len() {
            let Some(lane) = self.free.pop() else { return };
            let job = *started;
            *started += 1;
            let begun = match jobs {
                Jobs::Pixels { .. } => self.begin(jobs.at(job), job, lane as usize),
                Jobs::Lights(bundle) => self.begin_at_light(bundle, job, lane as usize),
            };
            if begun.is_none() {
                self.free.push(lane);
                continue;
            }
            let asked = self.next.rays.len() + self.next.shadows.len();
            let l = &mut self.lanes[lane as usize].l;
            self.states.start(lane, &self.job, l, &mut self.next);
            if asked == self.next.rays.len() + self.next.shadows.len() {
                self.finish(lane as usize);
            }
        }
    }

    /// Puts a job into a lane: the camera's ray; `None` where the camera sees nothing.
    fn begin(&mut self, (pixel, index): (UVec2, u32), job: usize, lane: usize) -> Option<()> {
        let stream = hash_combine(hash_combine(self.seed, pixel.x), pixel.y);
        let mut samples = Samples::new(self.sampler, SampleAt { stream, index, dimension: 0 });
        let [in_pixel, lens] = samples.next_2d_pair();
        let [dx, dy] = self.stage.filter.fixed().filter().sample(in_pixel);
        let u = samples.next_1d_if(self.stage.mode.is_spectral());
        let stage = moment(self.stage, &samples);
        let offset = glam::DVec2::new(f64::from(dx), f64::from(dy));
        let p = pixel.as_dvec2() + 0.5 + offset;
        let found = stage.camera_ray(p, lens)?;
        self.paths[lane].start(cast::index(job), &found, u, stage);
        let own = &mut self.lanes[lane];
        (own.l, own.glow, own.numbers) = (Spectrum::ZERO, Spectrum::ZERO, samples.at());
        self.job.ray = found.ray;
        self.record.start(lane, self.job.ray.o);
        Some(())
    }

    /// Light that depended on shadow rays, in asking order.
    #[inline(always)]
    fn shadows<const THROUGH: bool>(&mut self, processor: Processor) {
        self.shadowed.clear();
        self.shadowed.resize(self.now.shadows.len(), false);
        let (paths, shadowed) = (&self.paths, &mut self.shadowed);
        let of = |lane: u32| (paths[lane as usize].leaving(), paths[lane as usize].time);
        let rays = self.now.shadows.iter().map(|asked| (&asked.ray, of(asked.lane)));
        let rays = rays.map(|(ray, (from, time))| (ray, from, time));
        if THROUGH && self.stage.features.nested() {
            // What stops a ray depends on what it is in: `shadow::passes` sees.
        } else {
            let tell = |i: usize, is_hit| shadowed[i] = is_hit;
            self.stage.occluded_all(processor, rays, &mut self.rooms, tell);
        }
        for (request, shadowed) in self.now.shadows.iter().zip(&self.shadowed) {
            if *shadowed {
                continue;
            }
            let lane = &mut self.lanes[request.lane as usize];
            let path = &self.paths[request.lane as usize];
            let mut l = request.l;
            if THROUGH {
                let mut samples = Samples::new(self.sampler, lane.numbers);
                let scratch = &mut self.scratch;
                let stage = self.stage.at(path.time);
                l *= shadow::passes(processor, stage, &request.ray, path, &mut samples, scratch);
                lane.numbers = samples.at();
            }
            if request.pixel == Shadow::OWN {
                lane.l += l;
                if self.record.has_groups() {
                    self.record.found(self.stage, (request.lane, path), l);
                }
                continue;
            }
            let rgb = self.to_rgb.sample(l, &path.palette.wavelengths);
            self.splats.push(Splat { pixel: request.pixel, rgb });
        }
    }

    /// Asks what now, where the paths of this round have arrived.
    fn arrivals(&mut self) {
        let stage = self.stage;
        if self.record.is_on() {
            self.record();
        }
        self.arrived.clear();
        self.arrived.extend(self.now.rays.iter().map(|onward| onward.lane));
        let round = Round { host: &StageHost(stage), sampler: self.sampler };
        if self.record.has_groups() {
            self.record.before(&self.lanes, &self.arrived);
        }
        self.states.arrive_n(&mut self.lanes, &self.arrived, round, &mut self.next);
        if self.record.has_groups() {
            let paths = (&*self.paths, &*self.lanes);
            self.record.after(stage, paths, &self.arrived, &mut self.scratch);
        }
    }

    /// What the paths of this round met, for the film's layers.
    fn record(&mut self) {
        for Onward { lane, .. } in self.now.rays.iter() {
            let lane = *lane as usize;
            let of = (lane, &self.paths[lane]);
            self.record.arrived(of, &self.lanes[lane].at, self.stage, &self.to_rgb);
        }
    }

    /// Where the rays of this round meet the scene.
    #[inline(always)]
    fn trace(&mut self, processor: Processor) {
        self.hits.clear();
        let (paths, hits) = (&self.paths, &mut self.hits);
        let of = |lane: u32| (paths[lane as usize].leaving(), paths[lane as usize].time);
        let rays = self.now.rays.iter().map(|onward| (&onward.ray, of(onward.lane)));
        let rays = rays.map(|(ray, (from, time))| (ray, from, time));
        hits.resize(self.now.rays.len(), (None, 0));
        let tell = |i: usize, hit, steps| hits[i] = (hit, steps);
        self.stage.intersect_all(processor, rays, &mut self.rooms, tell);
    }

    /// Shades every path of this round where `trace` found that it ends.
    #[inline(always)]
    fn shade<const CHOICE: bool>(&mut self) {
        let wants = self.wants;
        for (Onward { ray, lane }, (hit, steps)) in self.now.rays.iter().zip(&self.hits) {
            let path = &mut self.paths[*lane as usize];
            let stage = self.stage.at(path.time);
            let Lane { at, numbers, .. } = &mut self.lanes[*lane as usize];
            let mut samples = Samples::new(self.sampler, *numbers);
            let (scratch, flight) = (&mut self.scratch, Spectrum::ONE);
            let shader: Shader<'_, '_, false, CHOICE> =
                Shader { stage, wants, path, samples: &mut samples, scratch, flight };
            match hit {
                Some(hit) => shader.surface(ray, hit, *steps, at),
                None => shader.escaped(ray, *steps, at),
            }
            *numbers = samples.at();
        }
    }

    /// Lanes that were answered and asked for nothing more are done.
    fn retire(&mut self) {
        let mut busy = [false; LANES];
        for onward in self.next.rays.iter() {
            busy[onward.lane as usize] = true;
        }
        for request in self.next.shadows.iter() {
            busy[request.lane as usize] = true;
        }
        let mut seen = [false; LANES];
        for i in 0..self.now.shadows.len() + self.now.rays.len() {
            let lane = match i.checked_sub(self.now.shadows.len()) {
                Some(i) => self.now.rays[i].lane,
                None => self.now.shadows[i].lane,
            } as usize;
            if !busy[lane] && !seen[lane] {
                seen[lane] = true;
                self.finish(lane);
            }
        }
    }

    /// A path has ended: its light becomes a sample, its lane is free.
    fn finish(&mut self, lane: usize) {
        let path = &self.paths[lane];
        let Lane { l, glow, .. } = self.lanes[lane];
        let l = (l + glow) * path.weight;
        if let Some(result) = self.results.get_mut(path.job as usize) {
            *result = self.to_rgb.sample(l, &path.palette.wavelengths);
            if self.record.has_groups() {
                self.record.finish((lane, path), &self.to_rgb);
            }
        }
        self.free.push(cast::index(lane));
    }
}

/// The pixels of tiles side by side.
fn strip(tiles: &[Tile]) -> Rect {
    let (first, last) = (tiles[0].rect, tiles[tiles.len() - 1].rect);
    Rect::new(first.min, last.min + last.size - first.min)
}

struct Shadows<'a, 's, const THROUGH: bool>(&'a mut Worker<'s>);
struct Trace<'a, 's>(&'a mut Worker<'s>);
struct Shade<'a, 's, const CHOICE: bool>(&'a mut Worker<'s>);

impl<const THROUGH: bool> Work for Shadows<'_, '_, THROUGH> {
    #[inline(always)]
    fn run(self, processor: Processor) {
        self.0.shadows::<THROUGH>(processor);
    }
}

impl Work for Trace<'_, '_> {
    #[inline(always)]
    fn run(self, processor: Processor) {
        self.0.trace(processor);
    }
}

impl<const CHOICE: bool> Work for Shade<'_, '_, CHOICE> {
    #[inline(always)]
    fn run(self, _: Processor) {
        self.0.shade::<CHOICE>();
    }
}

/// Tells the times of paths from their other numbers.
const TIME: u32 = 0x71_3e;

/// The moment that a path sees. Its number is of a stream of its own: the others are the same whether
/// something moves or not.
pub(super) fn moment<'s>(stage: &'s Stage, samples: &Samples<'_>) -> Moment<'s> {
    if !stage.features.motion() {
        return stage.opening();
    }
    let path = samples.at();
    let at = SampleAt { stream: hash_combine(path.stream, TIME), dimension: 0, ..path };
    stage.at(stage.time_of(samples.source().get_1d(at)))
}

/// What an integrator may ask the host while a path arrives.
pub(super) struct StageHost<'a>(pub(super) &'a Stage);

impl Host for StageHost<'_> {
    fn occluded(&self, ray: &Ray) -> bool {
        self.0.opening().occluded(Processor::ANY, ray, None)
    }

    fn scene_sphere(&self) -> (DVec3, f64) {
        self.0.sphere
    }
}
