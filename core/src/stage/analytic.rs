//! Shapes that intersect themselves, those of many parts with a tree over the parts.

use std::sync::Arc;

use luxel_sdk::kind::Hit;
use luxel_sdk::num::Ray;

use crate::accel::{Processor, Room, TopBvh, Watch};
use crate::object::Object;

/// A shape that intersects itself, in double precision.
#[derive(Debug)]
pub struct Analytic {
    object: Arc<Object>,
    /// Over the boxes of its parts, if it comes in several.
    parts: Option<TopBvh>,
}

/// Most parts that a tree holds.
const MOST: u32 = 1 << 24;

const _: () = assert!(MOST as usize <= TopBvh::MOST, "a tree numbers every part");

impl Analytic {
    /// Takes over a shape, and builds the tree over its parts. One of more than 2²⁴ parts is asked
    /// for all of them at once, and so is one of a single part.
    /// Followed by `watch`: `None` once that is cancelled.
    pub fn new(object: Arc<Object>, watch: &Watch) -> Option<Self> {
        let shape = object.fixed().shape();
        let n = shape.parts();
        let boxes = |n: u32| {
            let corners = |part: u32| {
                let bounds = shape.part_bounds(part);
                (bounds.min, bounds.max)
            };
            (0..n).map(corners).collect::<Vec<_>>()
        };
        let parts = if (2..=MOST).contains(&n) {
            Some(TopBvh::build_watched(&boxes(n), watch)?)
        } else {
            None
        };
        Some(Self { object, parts })
    }

    /// The shape itself.
    pub fn object(&self) -> &Arc<Object> {
        &self.object
    }

    /// The nearest hit of a ray in the shape's frame. Parts that are looked at count as steps.
    #[inline(always)]
    pub fn intersect(&self, ray: &Ray, processor: Processor, steps: &mut u32) -> Option<Hit> {
        match &self.parts {
            None => self.object.fixed().shape().intersect(ray),
            Some(parts) => self.nearest::<false>(parts, ray, processor, steps),
        }
    }

    /// Whether anything is hit.
    #[inline(always)]
    pub fn occluded(&self, ray: &Ray, processor: Processor) -> bool {
        match &self.parts {
            None => self.object.fixed().shape().intersect(ray).is_some(),
            Some(parts) => self.nearest::<true>(parts, ray, processor, &mut 0).is_some(),
        }
    }

    /// Parts whose boxes a ray enters, roughly near to far: each narrows how far the next may be. Apart
    /// from what meets other shapes, which its stack would slow down.
    #[inline(never)]
    fn nearest<const ANY: bool>(
        &self,
        parts: &TopBvh,
        ray: &Ray,
        processor: Processor,
        steps: &mut u32,
    ) -> Option<Hit> {
        let shape = self.object.fixed().shape();
        let mut room = Room::default();
        let mut stack = room.stack();
        let mut walk = parts.walk(ray.o, ray.d, ray.t_max);
        let (mut found, mut part_of) = (None, u32::MAX);
        let mut t_max = ray.t_max;
        while let Some((part, _)) = walk.next(processor, &mut stack) {
            *steps += 1;
            let Some(hit) = shape.intersect_part(part, &Ray { t_max, ..*ray }) else { continue };
            if ANY {
                return Some(hit);
            }
            // Of two parts at one place the first counts, in whatever order they are met.
            if hit.t < t_max || found.is_none() || part < part_of {
                (found, part_of, t_max) = (Some(hit), part, hit.t);
                walk.t_max = hit.t.min(walk.t_max);
            }
        }
        found
    }
}
