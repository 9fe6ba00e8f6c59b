//! Paths from lights: where they begin, and the light that they leave in pixels.

use std::ops::Range;

use glam::DVec3;
use luxel_sdk::color::{Palette, Spectrum, Wavelengths};
use luxel_sdk::kind::{Arrival, SampleAt, Samples, Sight, Wants};
use luxel_sdk::params::Maybe;
use luxel_sdk::sampling::hash_combine;

use super::Stop;
use super::arrival::sight;
use super::jobs::Jobs;
use super::tile::{Worker, moment};
use crate::cast::index;
use crate::stage::{EmissionNumbers, Emitted, Emitters};

/// Light for a pixel, by its place in the picture's rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Splat {
    pub(super) pixel: u32,
    /// Linear sRGB.
    pub(super) rgb: DVec3,
}

/// Some of the light paths of a pass.
pub(super) struct Bundle<'a> {
    pub(super) emitters: &'a Emitters,
    /// Tells its random numbers from those of other runs.
    pub(super) run: u32,
    /// Which of its paths.
    pub(super) paths: Range<u32>,
}

/// Tells light paths from the pixels of the same seed.
const LIGHT: u32 = 0x11_9877;

impl Worker<'_> {
    /// Follows paths from lights: what they splat, in their order; `None` when cancelled.
    pub(super) fn bundle(&mut self, bundle: Bundle<'_>, stop: Stop<'_>) -> Option<Vec<Splat>> {
        self.results.clear();
        self.splats.clear();
        let done = !stop.is_asked() && self.run(&Jobs::Lights(bundle), stop);
        done.then(|| std::mem::take(&mut self.splats))
    }

    /// Puts a path from a light into a lane; `None` where no light leaves.
    pub(super) fn begin_at_light(
        &mut self,
        bundle: &Bundle<'_>,
        job: usize,
        lane: usize,
    ) -> Option<()> {
        let stage = self.stage;
        // The paths of a run share one sequence, so that together they cover the lights evenly.
        let stream = hash_combine(hash_combine(self.seed, LIGHT), bundle.run);
        let at = SampleAt { stream, index: bundle.paths.start + index(job), dimension: 0 };
        let mut samples = Samples::new(self.sampler, at);
        let [point, direction] = samples.next_2d_pair();
        let [light, side] = samples.next_2d();
        let numbers = EmissionNumbers { light, side, point, direction };
        let u = samples.next_1d_if(stage.mode.is_spectral());
        if stage.mode.is_spectral() {
            self.paths[lane].palette = Palette::new(Wavelengths::sample(u));
        }
        let moment = moment(stage, &samples);
        self.paths[lane].time = moment.time;
        let palette = &self.paths[lane].palette;
        let found = moment.emit(bundle.emitters, palette, &numbers, &mut self.scratch)?;
        let sight = if self.wants.has(Wants::SIGHT) {
            self.lamp_seen(&found, samples.next_1d(), lane)
        } else {
            None
        };
        self.job.ray = found.ray;
        self.job.beta = found.beta;
        self.job.sight = Maybe::from(sight);
        self.paths[lane].start_at_light(index(job), &found);
        let own = &mut self.lanes[lane];
        (own.l, own.glow, own.numbers) = (Spectrum::ZERO, Spectrum::ZERO, samples.at());
        Some(())
    }

    /// Where the camera sees the point of a lamp that a path begins at.
    fn lamp_seen(&mut self, found: &Emitted, u: f32, lane: usize) -> Option<Sight> {
        let lamp = found.lamp.as_ref()?;
        let surface = &lamp.surface;
        let moment = self.stage.at(self.paths[lane].time);
        let seen = moment.eye?.sees(moment, surface.p, u)?;
        let palette = &self.paths[lane].palette;
        let le = moment.lamp_towards(lamp, seen.d, palette, &mut self.scratch);
        let (p, p_err, ng) = (surface.p, surface.p_err, surface.ng);
        sight(moment, &Arrival { p, p_err, ng, ..Arrival::default() }, &seen, le)
    }
}
