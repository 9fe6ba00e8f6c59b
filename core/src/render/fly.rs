//! Rays that may end in a medium, or pass open surfaces on their way.

use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Onward, Samples, Wants};
use luxel_sdk::num::{Ray, offset_origin};

use super::arrival::Shader;
use super::tile::Worker;
use crate::accel::{Processor, Work};
use crate::object::Site;
use crate::stage::{Leaving, SceneHit};

/// Whatever a scene may require.
type Whole<'a, 's> = Shader<'a, 's, true, true>;

/// Shades all paths of a round, from what their rays meet first, and traces those that go on from there.
pub(super) struct Fly<'a, 's>(pub(super) &'a mut Worker<'s>);

impl Work for Fly<'_, '_> {
    #[inline(always)]
    fn run(self, _: Processor) {
        self.0.fly();
    }
}

impl Worker<'_> {
    /// Shades the paths of this round, one after the other.
    #[inline(always)]
    fn fly(&mut self) {
        for i in 0..self.now.rays.len() {
            let Onward { ray, lane } = self.now.rays[i];
            let lane = lane as usize;
            let mut samples = Samples::new(self.sampler, self.lanes[lane].numbers);
            let glow = self.fly_one(ray, self.hits[i], lane, &mut samples);
            self.lanes[lane].at.glow = glow;
            self.lanes[lane].numbers = samples.at();
        }
    }

    /// Gives the light of the media on its way; `hit` is what the ray meets first, found in so many steps.
    #[inline(always)]
    fn fly_one(
        &mut self,
        mut ray: Ray,
        (mut hit, mut steps): (Option<SceneHit>, u32),
        lane: usize,
        samples: &mut Samples<'_>,
    ) -> Spectrum {
        let stage = self.stage.at(self.paths[lane].time);
        let mut media = self.paths[lane].media_along(&ray);
        let (mut flight, mut glow) = (Spectrum::ONE, Spectrum::ZERO);
        loop {
            let t_max = hit.map_or(ray.t_max, |hit| hit.hit.t);
            let path = &mut self.paths[lane];
            let arrival = &mut self.lanes[lane].at;
            let scratch = &mut self.scratch;
            let wants = self.wants;
            if let Some((medium, t_max)) = stage.medium_along(&media, &Ray { t_max, ..ray }) {
                self.medium_scratch.reset();
                let uv = glam::Vec2::ZERO;
                let at = Site { p: ray.o, uv, palette: &path.palette, color: None };
                let object = &stage.media[medium as usize];
                let medium = object.resolve(&at, &self.medium_scratch).medium();
                let ray = Ray { t_max, ..ray };
                if wants.has(Wants::EMISSION) {
                    glow += flight * medium.glow(&ray, samples);
                }
                let free = medium.sample(&ray, samples);
                flight *= free.weight;
                if let Some(t) = free.t.get() {
                    path.media = media;
                    let shader = Whole { stage, wants, path, samples, scratch, flight };
                    shader.medium((&ray, t, steps), &medium.phase(), arrival);
                    return glow;
                }
            }
            path.media = media;
            let shader = Whole { stage, wants, path, samples, scratch, flight };
            let Some(met) = hit else {
                shader.escaped(&ray, steps, arrival);
                return glow;
            };
            let crossing = stage.crossing(self.processor, &media, &ray, &met);
            if let Some(met) = crossing.met {
                shader.boundary((&ray, &met, steps), &crossing, arrival);
                return glow;
            }
            media = crossing.beyond;
            let surface = &crossing.surface;
            let o = offset_origin(surface.p, surface.p_err, surface.ng, ray.d);
            ray = Ray { o, t_max: ray.t_max - met.hit.t, ..ray };
            hit = stage.intersect(self.processor, &ray, Some(Leaving::from(&met)), &mut steps);
        }
    }
}
