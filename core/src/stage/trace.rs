//! Rays through the whole stage at a moment.

use glam::{DVec3, Vec3};
use luxel_sdk::kind::Surface;
use luxel_sdk::num::Ray;

use crate::accel::{Direction, Processor, Room};

use super::geometry::{Approach, enter};
use super::{Geometry, Leaving, Moment, Placement, SceneHit, Skin};

impl Moment<'_> {
    /// The nearest surface along a ray that leaves `from`, of equally near ones that of the placement
    /// that comes first. Counts nodes and primitives in `steps`.
    #[inline(always)]
    pub fn intersect(
        self,
        processor: Processor,
        ray: &Ray,
        from: Option<Leaving>,
        steps: &mut u32,
    ) -> Option<SceneHit> {
        let direction = Direction::new(ray.d);
        let mut room = Room::default();
        let mut stack = room.stack();
        let mut walk = self.top.walk(ray.o, ray.d, ray.t_max);
        let (mut ray, mut found) = (*ray, None);
        while let Some((index, t_enter)) = walk.next(processor, &mut stack) {
            *steps += 1;
            let placement = &self.placements[index as usize];
            let geometry = &self.geometries[placement.geometry as usize];
            let mut room = None;
            let world = Local { ray: &ray, direction: direction.as_ref() };
            let local = Local::of(placement, world, self.time, &mut room);
            let from = Leaving::face_on(from, index);
            let t_enter = local.entry(placement, geometry, t_enter);
            let approach = self.approach(processor, local, t_enter, from);
            if let Some(hit) = geometry.intersect(local.ray, approach, steps) {
                found = SceneHit { placement: index, hit }.or_before(found);
                (walk.t_max, ray.t_max) = (hit.t, hit.t);
            }
        }
        found
    }

    /// Whether a surface that stops light lies along a ray that leaves `from`.
    #[inline(always)]
    pub fn occluded(self, processor: Processor, ray: &Ray, from: Option<Leaving>) -> bool {
        let direction = Direction::new(ray.d);
        let world = Local { ray, direction: direction.as_ref() };
        let mut room = Room::default();
        let mut stack = room.stack();
        let mut walk = self.top.walk(ray.o, ray.d, ray.t_max);
        while let Some((index, t_enter)) = walk.next(processor, &mut stack) {
            let placement = &self.placements[index as usize];
            if placement.skin == Skin::Open {
                continue;
            }
            let geometry = &self.geometries[placement.geometry as usize];
            let mut room = None;
            let local = Local::of(placement, world, self.time, &mut room);
            let from = Leaving::face_on(from, index);
            let t_enter = local.entry(placement, geometry, t_enter);
            let approach = self.approach(processor, local, t_enter, from);
            if geometry.occluded(local.ray, approach) {
                return true;
            }
        }
        false
    }

    /// The nearest hit of every placement along a ray, in no order.
    pub(super) fn along(self, processor: Processor, ray: &Ray, mut see: impl FnMut(&SceneHit)) {
        let direction = Direction::new(ray.d);
        let world = Local { ray, direction: direction.as_ref() };
        let mut room = Room::default();
        let mut stack = room.stack();
        let mut walk = self.top.walk(ray.o, ray.d, ray.t_max);
        while let Some((placement, t_enter)) = walk.next(processor, &mut stack) {
            let place = &self.placements[placement as usize];
            let geometry = &self.geometries[place.geometry as usize];
            let mut room = None;
            let local = Local::of(place, world, self.time, &mut room);
            let t_enter = local.entry(place, geometry, t_enter);
            let approach = self.approach(processor, local, t_enter, None);
            if let Some(hit) = geometry.intersect(local.ray, approach, &mut 0) {
                see(&SceneHit { placement, hit });
            }
        }
    }

    /// How a ray comes to a placement that it enters at `t_enter`.
    #[inline(always)]
    pub(super) fn approach(
        self,
        processor: Processor,
        local: Local<'_>,
        t_enter: f64,
        from: Option<u32>,
    ) -> Approach<'_> {
        let (precision, direction) = (self.film.precision, local.direction);
        Approach { processor, precision, direction, t_enter, from, time: self.time }
    }

    /// The point of a hit, in the world.
    #[inline(always)]
    pub fn surface(self, ray: &Ray, hit: &SceneHit) -> Surface {
        let placement = &self.placements[hit.placement as usize];
        let geometry = &self.geometries[placement.geometry as usize];
        let (precision, time) = (self.film.precision, self.time);
        match placement.place.at(time, &mut None) {
            None => geometry.surface(ray, &hit.hit, precision, time),
            Some(transform) => {
                let local = transform.inverse_ray(ray);
                geometry.surface(&local, &hit.hit, precision, time).carried(transform)
            }
        }
    }

    /// From a point of a mesh to the smooth surface that its normals speak of, seen from one side;
    /// zero elsewhere.
    pub fn lift(self, hit: &SceneHit, outside: bool) -> DVec3 {
        let placement = &self.placements[hit.placement as usize];
        let Geometry::Mesh(mesh) = &*self.geometries[placement.geometry as usize] else {
            return DVec3::ZERO;
        };
        let lift = mesh.lift(hit.hit.face, hit.hit.at, outside, self.time);
        let mut room = None;
        placement.place.at(self.time, &mut room).map_or(lift, |transform| transform.vector(lift))
    }

    /// The colour that a surface has of itself at a hit, linear sRGB.
    #[inline(never)]
    pub fn color(self, hit: &SceneHit) -> Option<Vec3> {
        let placement = &self.placements[hit.placement as usize];
        match &*self.geometries[placement.geometry as usize] {
            Geometry::Mesh(mesh) => mesh.color(hit.hit.face, hit.hit.at),
            Geometry::Analytic(_) => None,
        }
    }
}

/// A ray in the frame of a placement.
#[derive(Clone, Copy)]
pub(super) struct Local<'a> {
    pub(super) ray: &'a Ray,
    pub(super) direction: Option<&'a Direction>,
}

/// A ray that was carried into another frame than the world's, and its direction made ready.
pub(super) type Carried = (Ray, Option<Direction>);

impl<'a> Local<'a> {
    /// Carries a ray of the world into `room`; where the frame is the world's it stays as it is.
    #[inline(always)]
    pub(super) fn of(
        placement: &Placement,
        world: Self,
        time: f64,
        room: &'a mut Option<Carried>,
    ) -> Self {
        let mut moved = None;
        let Some(transform) = placement.place.at(time, &mut moved) else { return world };
        let ray = transform.inverse_ray(world.ray);
        Self::from(&*room.insert((ray, Direction::new(ray.d))))
    }

    /// Where the ray enters the geometry of a placement whose box in the world it enters at `t_enter`:
    /// the box of what moves holds all of its way, and precision wants to begin nearby.
    #[inline(always)]
    pub(super) fn entry(self, placement: &Placement, geometry: &Geometry, t_enter: f64) -> f64 {
        if placement.place.is_moving() { self.own_entry(geometry, t_enter) } else { t_enter }
    }

    #[inline(never)]
    fn own_entry(self, geometry: &Geometry, t_enter: f64) -> f64 {
        enter(&geometry.bounds(), self.ray).map_or(t_enter, |near| t_enter.max(near))
    }
}

impl<'a> From<&'a Carried> for Local<'a> {
    #[inline(always)]
    fn from((ray, direction): &'a Carried) -> Self {
        Self { ray, direction: direction.as_ref() }
    }
}
