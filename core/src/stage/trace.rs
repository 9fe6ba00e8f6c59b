//! Rays through the whole stage.

use glam::Vec3;
use luxel_sdk::kind::Surface;
use luxel_sdk::num::{Ray, sphere_roots};

use crate::accel::{Direction, Processor, Room};

use super::geometry::{Approach, Geometry};
use super::placement::carried;
use super::{Leaving, MediumStack, Placement, SceneHit, Skin, Stage};

impl Stage {
    /// The nearest surface along a ray that leaves `from`. Counts nodes and primitives in `steps`.
    #[inline(always)]
    pub fn intersect(
        &self,
        processor: Processor,
        ray: &Ray,
        from: Option<Leaving>,
        steps: &mut u32,
    ) -> Option<SceneHit> {
        let world = Direction::new(ray.d);
        let mut room = Room::default();
        let mut stack = room.stack();
        let mut walk = self.top.walk(ray.o, ray.d, ray.t_max);
        let mut found = None;
        while let Some((index, t_enter)) = walk.next(processor, &mut stack) {
            *steps += 1;
            let placement = &self.placements[index as usize];
            let geometry = &self.geometries[placement.geometry as usize];
            let local = Local::of(placement, &Ray { t_max: walk.t_max, ..*ray }, world);
            let from = Leaving::face_on(from, index);
            let approach = self.approach(processor, &local, t_enter, from);
            if let Some(hit) = geometry.intersect(&local.ray, approach, steps) {
                found = Some(SceneHit { placement: index, hit });
                walk.t_max = hit.t;
            }
        }
        found
    }

    /// Whether a surface that stops light lies along a ray that leaves `from`.
    #[inline(always)]
    pub fn occluded(&self, processor: Processor, ray: &Ray, from: Option<Leaving>) -> bool {
        let world = Direction::new(ray.d);
        let mut room = Room::default();
        let mut stack = room.stack();
        let mut walk = self.top.walk(ray.o, ray.d, ray.t_max);
        while let Some((index, t_enter)) = walk.next(processor, &mut stack) {
            let placement = &self.placements[index as usize];
            if placement.skin == Skin::Open {
                continue;
            }
            let geometry = &self.geometries[placement.geometry as usize];
            let local = Local::of(placement, ray, world);
            let from = Leaving::face_on(from, index);
            let approach = self.approach(processor, &local, t_enter, from);
            if geometry.occluded(&local.ray, approach) {
                return true;
            }
        }
        false
    }

    /// How a ray comes to a placement that it enters at `t_enter`.
    #[inline(always)]
    pub(super) fn approach<'a>(
        &self,
        processor: Processor,
        local: &'a Local,
        t_enter: f64,
        from: Option<u32>,
    ) -> Approach<'a> {
        let (precision, direction) = (self.film.precision, local.direction.as_ref());
        Approach { processor, precision, direction, t_enter, from }
    }

    /// The point of a hit, in the world.
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, hit: &SceneHit) -> Surface {
        let placement = &self.placements[hit.placement as usize];
        let geometry = &self.geometries[placement.geometry as usize];
        match &placement.transform {
            None => geometry.surface(ray, &hit.hit, self.film.precision),
            Some(transform) => {
                let local =
                    geometry.surface(&transform.inverse_ray(ray), &hit.hit, self.film.precision);
                carried(transform, &local)
            }
        }
    }

    /// The colour that a surface has of itself at a hit, linear sRGB.
    #[inline(never)]
    pub fn color(&self, hit: &SceneHit) -> Option<Vec3> {
        let placement = &self.placements[hit.placement as usize];
        match &*self.geometries[placement.geometry as usize] {
            Geometry::Mesh(mesh) => mesh.color(hit.hit.face, hit.hit.at),
            Geometry::Analytic(_) => None,
        }
    }

    /// The medium that a ray is in at its origin, and how far along the ray it may reach: what fills
    /// the outside ends at `reach`.
    pub fn medium_along(&self, media: &MediumStack, ray: &Ray) -> Option<(u32, f64)> {
        let medium = media.current(self.outside)?;
        if !media.is_outside() {
            return Some((medium, ray.t_max));
        }
        let (_, exit) = sphere_roots(ray.o - self.sphere.0, ray.d, self.reach)?;
        (exit > 0.0).then(|| (medium, ray.t_max.min(exit)))
    }

    /// Changes the media that a ray is in as it passes a surface along `d`.
    pub fn cross(&self, media: &mut MediumStack, placement: u32, d: glam::DVec3, ng: glam::DVec3) {
        let place = &self.placements[placement as usize];
        if !place.closed {
            return;
        }
        if d.dot(ng) < 0.0 {
            media.enter(placement, place.interior);
        } else {
            media.leave(placement);
        }
    }

    /// The media that a point is in: found by following a ray out of the scene and counting which
    /// closed shapes it leaves without having entered them.
    pub fn media_at(&self, p: glam::DVec3) -> MediumStack {
        let d = glam::DVec3::new(0.267, 0.535, 0.802).normalize();
        let mut ray = Ray { o: p, d, t_max: f64::INFINITY };
        let mut entered: Vec<u32> = vec![];
        let mut left: Vec<u32> = vec![];
        let mut from = None;
        while let Some(hit) = self.intersect(Processor::ANY, &ray, from, &mut 0) {
            from = Some(Leaving::from(&hit));
            let surface = self.surface(&ray, &hit);
            if self.placements[hit.placement as usize].closed {
                let known = entered.iter().rposition(|inside| *inside == hit.placement);
                match (d.dot(surface.ng) < 0.0, known) {
                    (true, _) => entered.push(hit.placement),
                    (false, Some(at)) => drop(entered.remove(at)),
                    (false, None) => left.push(hit.placement),
                }
            }
            ray.o = luxel_sdk::num::offset_origin(surface.p, surface.p_err, surface.ng, d);
            if entered.len() + left.len() > self.placements.len() {
                break;
            }
        }
        let mut media = MediumStack::default();
        for placement in left.into_iter().rev() {
            media.enter(placement, self.placements[placement as usize].interior);
        }
        media
    }
}

/// A ray in the frame of a placement.
pub(super) struct Local {
    pub(super) ray: Ray,
    pub(super) direction: Option<Direction>,
}

impl Local {
    /// Carries a ray of the world, whose direction is `world` made ready.
    #[inline(always)]
    pub(super) fn of(placement: &Placement, ray: &Ray, world: Option<Direction>) -> Self {
        match &placement.transform {
            None => Self { ray: *ray, direction: world },
            Some(transform) => {
                let ray = transform.inverse_ray(ray);
                Self { ray, direction: Direction::new(ray.d) }
            }
        }
    }
}
