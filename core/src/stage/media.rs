//! What a ray is inside of, and which of several shapes that overlap counts.

use glam::DVec3;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::Surface;
use luxel_sdk::num::{Ray, offset_origin, sphere_roots};

use super::{Leaving, Moment, Placement, SceneHit, Skin, Stage};
use crate::accel::Processor;
use crate::object::{Scratch, Site};

/// The closed shapes that a ray is inside of, as placements.
///
/// A ray that is inside of more than eight at once forgets the one it entered first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MediumStack {
    entered: [u32; Self::DEPTH],
    len: u8,
}

impl MediumStack {
    const DEPTH: usize = 8;

    /// Enters a placement.
    pub fn enter(&mut self, placement: u32) {
        if self.len as usize == Self::DEPTH {
            self.entered.copy_within(1.., 0);
            self.len -= 1;
        }
        self.entered[self.len as usize] = placement;
        self.len += 1;
    }

    /// Leaves a placement; nothing happens if it was never entered.
    pub fn leave(&mut self, placement: u32) {
        if let Some(at) = self.placements().iter().rposition(|inside| *inside == placement) {
            self.entered.copy_within(at + 1..self.len as usize, at);
            self.len -= 1;
        }
    }

    /// Whether it is inside no shape.
    pub fn is_outside(&self) -> bool {
        self.len == 0
    }

    /// What it is inside of, in the order of entering.
    pub fn placements(&self) -> &[u32] {
        &self.entered[..self.len as usize]
    }
}

/// What happens to a ray where it meets a surface.
#[derive(Debug)]
pub struct Crossing {
    /// The surface; it is as uncertain as everything that lies at one place with it.
    pub surface: Surface,
    /// What the ray is inside of beyond.
    pub beyond: MediumStack,
    /// What it meets; `None` where it passes.
    pub met: Option<SceneHit>,
}

/// Faces of refracting shapes within so many times the error of a point lie at one place: either
/// may be that much beside where it is.
const COINCIDENT: f64 = 2.0;

/// Surfaces that the ray is followed through which finds what a point is inside of: rounding may
/// hold it at one.
const MOST_CROSSINGS: usize = 1 << 20;

impl Stage {
    /// Of the shapes that a ray is in, the one that counts, among those that `take` lets count.
    fn ruler(&self, media: &MediumStack, take: impl Fn(&Placement) -> bool) -> Option<u32> {
        let of = |place: u32| &self.placements[place as usize];
        let inside = media.placements().iter().copied().filter(|place| take(of(*place)));
        inside.max_by_key(|place| of(*place).rank)
    }

    /// The medium that a ray is in at its origin, and how far along the ray it may reach: what fills
    /// the outside ends at `reach`.
    pub fn medium_along(&self, media: &MediumStack, ray: &Ray) -> Option<(u32, f64)> {
        if let Some(ruler) = self.ruler(media, |_| true) {
            return Some((self.placements[ruler as usize].interior?, ray.t_max));
        }
        let medium = self.outside?;
        let (_, exit) = sphere_roots(ray.o - self.sphere.0, ray.d, self.reach)?;
        (exit > 0.0).then(|| (medium, ray.t_max.min(exit)))
    }

    /// Changes what a ray is in as it passes a surface along `d`.
    pub fn cross(&self, media: &mut MediumStack, placement: u32, d: DVec3, ng: DVec3) {
        if !self.placements[placement as usize].closed {
            return;
        }
        if d.dot(ng) < 0.0 {
            media.enter(placement);
        } else {
            media.leave(placement);
        }
    }

    /// Whether a placement is one of refracting shapes that may lie within each other.
    #[inline(always)]
    fn is_filled(&self, placement: u32) -> bool {
        let place = &self.placements[placement as usize];
        self.needed.nested && place.closed && place.bends
    }

    /// Index of refraction of what lies against a surface of `placement` from outside, where a ray
    /// meets it, on either side of which it is inside of so much.
    pub fn index_around(
        &self,
        sides: (&MediumStack, &MediumStack),
        placement: u32,
        site: &Site<'_>,
        scratch: &mut Scratch,
    ) -> Spectrum {
        let is_inside = |media: &MediumStack| media.placements().contains(&placement);
        let outside = if is_inside(sides.0) && !is_inside(sides.1) { sides.1 } else { sides.0 };
        let ruler = self.ruler(outside, |it| it.bends);
        let Some(Skin::Material(material)) = ruler.map(|it| self.placements[it as usize].skin)
        else {
            return Spectrum::ONE;
        };
        scratch.reset();
        self.materials[material as usize].index(site, scratch).unwrap_or(Spectrum::ONE)
    }
}

impl Moment<'_> {
    /// What happens to a ray inside of `media` where it meets a surface.
    #[inline]
    pub fn crossing(
        self,
        processor: Processor,
        media: &MediumStack,
        ray: &Ray,
        hit: &SceneHit,
    ) -> Crossing {
        let mut crossing = Crossing { surface: self.surface(ray, hit), beyond: *media, met: None };
        self.cross(&mut crossing.beyond, hit.placement, ray.d, crossing.surface.ng);
        if self.is_filled(hit.placement) {
            self.cross_filled(processor, media, (ray, hit), &mut crossing);
        } else if self.placements[hit.placement as usize].skin != Skin::Open {
            crossing.met = Some(*hit);
        }
        crossing
    }

    /// Where shapes may be nested, the ray passes whatever lies at one place at once, and meets a
    /// surface only if another shape counts beyond: that which counts more of the two.
    ///
    /// # Source
    /// Schmidt and Budge 2002, Simple Nested Dielectrics in Ray Traced Images; faces that coincide
    /// are ours.
    fn cross_filled(
        self,
        processor: Processor,
        media: &MediumStack,
        (ray, hit): (&Ray, &SceneHit),
        crossing: &mut Crossing,
    ) {
        // So that rays leave beyond all that lies here.
        crossing.surface.p_err *= COINCIDENT;
        let surface = &crossing.surface;
        let o = offset_origin(surface.p, surface.p_err, surface.ng, -ray.d);
        let end = offset_origin(surface.p, surface.p_err, surface.ng, ray.d);
        let before = (o - ray.o).dot(ray.d);
        let probe = Ray { o, d: ray.d, t_max: (end - o).dot(ray.d).max(0.0) };
        let mut here = [*hit; MediumStack::DEPTH];
        let mut n = 1;
        self.along(processor, &probe, |found| {
            if found.placement == hit.placement || !self.is_filled(found.placement) {
                return;
            }
            let ng = self.surface(&probe, found).ng;
            self.cross(&mut crossing.beyond, found.placement, ray.d, ng);
            if let Some(slot) = here.get_mut(n) {
                *slot = *found;
                slot.hit.t += before;
                n += 1;
            }
        });
        let bends = |it: &Placement| it.bends;
        let (here_counts, there) = (self.ruler(media, bends), self.ruler(&crossing.beyond, bends));
        if here_counts == there {
            return;
        }
        let rank = |ruler: Option<u32>| ruler.map(|it| self.placements[it as usize].rank);
        let owner = if rank(here_counts) > rank(there) { here_counts } else { there };
        crossing.met = here[..n].iter().find(|hit| Some(hit.placement) == owner).copied();
        if let Some(met) = crossing.met
            && met.placement != hit.placement
        {
            let p_err = crossing.surface.p_err;
            crossing.surface = self.surface(ray, &met);
            crossing.surface.p_err = crossing.surface.p_err.max(p_err);
        }
    }

    /// What a point is inside of: found by following a ray out of the scene and counting which
    /// closed shapes it leaves without having entered them.
    pub fn media_at(self, p: DVec3) -> MediumStack {
        let d = DVec3::new(0.267, 0.535, 0.802).normalize();
        let mut ray = Ray { o: p, d, t_max: f64::INFINITY };
        let mut entered: Vec<u32> = vec![];
        let mut left: Vec<u32> = vec![];
        let mut from = None;
        for _ in 0..MOST_CROSSINGS {
            let Some(hit) = self.intersect(Processor::ANY, &ray, from, &mut 0) else { break };
            from = Some(Leaving::from(&hit));
            let surface = self.surface(&ray, &hit);
            let wide = if self.is_filled(hit.placement) { COINCIDENT } else { 1.0 };
            let p_err = surface.p_err * wide;
            let back = offset_origin(surface.p, p_err, surface.ng, -d);
            ray.o = offset_origin(surface.p, p_err, surface.ng, d);
            let probe = Ray { o: back, d, t_max: (ray.o - back).dot(d).max(0.0) };
            let mut cross = |placement: u32, ng: DVec3| {
                let known = entered.iter().rposition(|inside| *inside == placement);
                match (d.dot(ng) < 0.0, known) {
                    (true, _) => entered.push(placement),
                    (false, Some(at)) => drop(entered.remove(at)),
                    (false, None) => left.push(placement),
                }
            };
            if self.placements[hit.placement as usize].closed {
                cross(hit.placement, surface.ng);
            }
            if self.is_filled(hit.placement) {
                self.along(Processor::ANY, &probe, |found| {
                    if found.placement != hit.placement && self.is_filled(found.placement) {
                        cross(found.placement, self.surface(&probe, found).ng);
                    }
                });
            }
        }
        let mut media = MediumStack::default();
        for placement in left.into_iter().rev() {
            media.enter(placement);
        }
        media
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn overlapping_shapes_leave_in_any_order() {
        let mut stack = MediumStack::default();
        stack.enter(1);
        stack.enter(2);
        stack.leave(1);
        assert_eq!(stack.placements(), [2]);
        stack.leave(2);
        stack.leave(2);
        assert!(stack.is_outside());
    }

    #[test]
    fn the_ninth_entry_forgets_the_first() {
        let mut stack = MediumStack::default();
        (0..9).for_each(|i| stack.enter(i));
        assert_eq!(stack.placements(), [1, 2, 3, 4, 5, 6, 7, 8]);
        (1..9).rev().for_each(|i| stack.leave(i));
        assert!(stack.is_outside());
    }
}
