//! What lies along a ray, for those who ask about a picture rather than make it.

use glam::UVec2;
use luxel_sdk::kind::Surface;
use luxel_sdk::num::{Ray, offset_origin};

use super::{Leaving, Moment, Placement, SceneHit, Skin, Stage};
use crate::accel::Processor;

/// The first surface along a ray that stops it.
#[derive(Clone, Copy, Debug)]
pub struct First {
    /// Distance along the ray, in lengths of its direction.
    pub t: f64,
    /// Which placement, and where on it.
    pub hit: SceneHit,
    /// The point, in the world.
    pub surface: Surface,
}

impl Moment<'_> {
    /// The first surface that stops a ray, from `hit` on, the nearest of all: those that rays pass are
    /// passed. Counts nodes and primitives in `steps`.
    #[inline(always)]
    pub fn first(
        self,
        processor: Processor,
        ray: &Ray,
        mut hit: SceneHit,
        steps: &mut u32,
    ) -> Option<First> {
        let (mut leg, mut flown) = (*ray, 0.0);
        loop {
            let surface = self.surface(&leg, &hit);
            if self.placements[hit.placement as usize].skin != Skin::Open {
                return Some(First { t: flown + hit.hit.t, hit, surface });
            }
            let o = offset_origin(surface.p, surface.p_err, surface.ng, leg.d);
            flown += (o - leg.o).dot(leg.d);
            leg = Ray { o, t_max: ray.t_max - flown, ..leg };
            hit = self.intersect(processor, &leg, Some(Leaving::from(&hit)), steps)?;
        }
    }
}

impl Stage {
    /// What the middle of a pixel shows through the middle of the lens when the shutter opens, and in
    /// which placement; `None` where that is no surface.
    pub fn probe(&self, pixel: UVec2) -> Option<(First, &Placement)> {
        let moment = self.opening();
        let seen = moment.camera_ray(pixel.as_dvec2() + 0.5, [0.5; 2])?;
        let nearest = moment.intersect(Processor::ANY, &seen.ray, None, &mut 0)?;
        let first = moment.first(Processor::ANY, &seen.ray, nearest, &mut 0)?;
        Some((first, &self.placements[first.hit.placement as usize]))
    }
}
