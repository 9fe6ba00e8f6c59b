//! Rays through the whole stage.

use luxel_sdk::kind::Surface;
use luxel_sdk::num::{Ray, sphere_roots};

use crate::accel::{Direction, Step, Visit};

use super::placement::carried;
use super::{Leaving, MediumStack, SceneHit, Skin, Stage};

impl Stage {
    /// The nearest surface along a ray that leaves `from`. Counts nodes and primitives in `steps`.
    #[inline(always)]
    pub fn intersect(&self, ray: &Ray, from: Option<Leaving>, steps: &mut u32) -> Option<SceneHit> {
        let world = Direction::new(ray.d);
        let mut visitor = Nearest { stage: self, ray: *ray, world, from, steps, hit: None };
        self.top.walk(ray.o, ray.d, ray.t_max, &mut visitor);
        visitor.hit
    }

    /// Whether a surface that stops light lies along a ray that leaves `from`.
    #[inline(always)]
    pub fn occluded(&self, ray: &Ray, from: Option<Leaving>) -> bool {
        let world = Direction::new(ray.d);
        let mut visitor = Anything { stage: self, ray, world, from, found: false };
        self.top.walk(ray.o, ray.d, ray.t_max, &mut visitor);
        visitor.found
    }

    /// The point of a hit, in the world.
    #[inline(always)]
    pub fn surface(&self, ray: &Ray, hit: &SceneHit) -> Surface {
        let placement = &self.placements[hit.placement as usize];
        let geometry = &self.geometries[placement.geometry as usize];
        match &placement.transform {
            None => geometry.surface(ray, &hit.hit),
            Some(transform) => {
                let local = geometry.surface(&transform.inverse_ray(ray), &hit.hit);
                carried(transform, &local)
            }
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
        while let Some(hit) = self.intersect(&ray, from, &mut 0) {
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

/// Looks for the nearest surface along a ray, which it shortens.
struct Nearest<'a> {
    stage: &'a Stage,
    ray: Ray,
    /// The ray's direction, for placements without a transform.
    world: Option<Direction>,
    from: Option<Leaving>,
    steps: &'a mut u32,
    hit: Option<SceneHit>,
}

impl Visit for Nearest<'_> {
    #[inline(always)]
    fn enter(&mut self, index: u32, t_enter: f64, t_max: f64) -> Step {
        *self.steps += 1;
        self.ray.t_max = t_max;
        let placement = &self.stage.placements[index as usize];
        let geometry = &self.stage.geometries[placement.geometry as usize];
        let from = Leaving::face_on(self.from, index);
        let found = match &placement.transform {
            None => geometry.intersect(&self.ray, self.world.as_ref(), t_enter, from, self.steps),
            Some(transform) => {
                let ray = transform.inverse_ray(&self.ray);
                let direction = Direction::new(ray.d);
                geometry.intersect(&ray, direction.as_ref(), t_enter, from, self.steps)
            }
        };
        let Some(hit) = found else { return Step::Go(t_max) };
        self.hit = Some(SceneHit { placement: index, hit });
        Step::Go(hit.t)
    }
}

/// Looks for any surface that stops light along a ray.
struct Anything<'a> {
    stage: &'a Stage,
    ray: &'a Ray,
    world: Option<Direction>,
    from: Option<Leaving>,
    found: bool,
}

impl Visit for Anything<'_> {
    #[inline(always)]
    fn enter(&mut self, index: u32, t_enter: f64, t_max: f64) -> Step {
        let placement = &self.stage.placements[index as usize];
        let geometry = &self.stage.geometries[placement.geometry as usize];
        let from = Leaving::face_on(self.from, index);
        if placement.skin == Skin::Open {
            return Step::Go(t_max);
        }
        self.found = match &placement.transform {
            None => geometry.occluded(self.ray, self.world.as_ref(), t_enter, from),
            Some(transform) => {
                let ray = transform.inverse_ray(self.ray);
                geometry.occluded(&ray, Direction::new(ray.d).as_ref(), t_enter, from)
            }
        };
        if self.found { Step::Stop } else { Step::Go(t_max) }
    }
}
