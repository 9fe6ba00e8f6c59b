//! Many rays through the whole stage: one by one, or a few at a time in turns, so that while one waits
//! for memory the others go on. What they meet is the same.

use glam::DVec2;
use luxel_sdk::kind::Hit;
use luxel_sdk::num::Ray;

use crate::accel::{Begun, Direction, MeshHit, MeshWalk, Processor, Room, Stack, TopWalk};

use super::geometry::{Approach, Geometry, Landed, Mesh, Taken};
use super::trace::{Carried, Local};
use super::{Leaving, Moment, SceneHit, Skin, Stage};

/// Rays that take turns.
const TURNS: usize = 8;

/// Bytes of trees from which on rays wait for memory so much that taking turns pays. Below, one by one is
/// faster by what it costs to turn: 1.12 times with 4.6 MB, 0.91 times with 140 MB (docs/performance.md).
const CACHE_BYTES: usize = 1 << 23;

/// How many rays are traced: room for those that take turns, made once.
#[derive(Debug)]
pub struct Rooms(Vec<(Room<f64>, Room<f32>)>);

impl Rooms {
    /// As is sooner with a stage.
    pub fn of(stage: &Stage) -> Self {
        if stage.is_for_turns() { Self::in_turns() } else { Self::one_by_one() }
    }

    /// Rays take turns.
    pub fn in_turns() -> Self {
        Self((0..TURNS).map(|_| (Room::default(), Room::default())).collect())
    }

    /// Each ray is traced to its end before the next.
    pub fn one_by_one() -> Self {
        Self(vec![])
    }
}

/// A ray that leaves a primitive, if it starts on one, at a time in seconds.
pub type Asked<'a> = (&'a Ray, Option<Leaving>, f64);

impl Stage {
    /// Whether many rays are traced sooner in turns than one by one.
    pub fn is_for_turns(&self) -> bool {
        let bytes = |geometry: &Geometry| match geometry {
            Geometry::Analytic(_) => 0,
            Geometry::Mesh(mesh) => mesh.bytes(),
        };
        self.geometries.iter().map(|geometry| bytes(geometry)).sum::<usize>() > CACHE_BYTES
    }

    /// The nearest surface along each ray and how many nodes and primitives were looked at, given
    /// to `tell` with the ray's number, in any order.
    #[inline(always)]
    pub fn intersect_all<'a>(
        &self,
        processor: Processor,
        rays: impl Iterator<Item = Asked<'a>>,
        rooms: &mut Rooms,
        mut tell: impl FnMut(usize, Option<SceneHit>, u32),
    ) {
        if rooms.0.is_empty() {
            for (i, (ray, from, time)) in rays.enumerate() {
                let mut steps = 0;
                let hit = self.at(time).intersect(processor, ray, from, &mut steps);
                tell(i, hit, steps);
            }
            return;
        }
        self.take_turns::<false>(processor, rays, rooms, |flight| {
            tell(flight.number, flight.hit, flight.steps);
        });
    }

    /// Whether a surface that stops light lies along each ray, told as above.
    #[inline(always)]
    pub fn occluded_all<'a>(
        &self,
        processor: Processor,
        rays: impl Iterator<Item = Asked<'a>>,
        rooms: &mut Rooms,
        mut tell: impl FnMut(usize, bool),
    ) {
        if rooms.0.is_empty() {
            for (i, (ray, from, time)) in rays.enumerate() {
                tell(i, self.at(time).occluded(processor, ray, from));
            }
            return;
        }
        self.take_turns::<true>(processor, rays, rooms, |flight| {
            tell(flight.number, flight.hit.is_some());
        });
    }

    #[inline(always)]
    fn take_turns<'a, const ANY: bool>(
        &self,
        processor: Processor,
        rays: impl Iterator<Item = Asked<'a>>,
        rooms: &mut Rooms,
        mut land: impl FnMut(&Flight<'_>),
    ) {
        let mut rays = rays.enumerate();
        let mut flights = Vec::with_capacity(TURNS);
        for (top, mesh) in &mut rooms.0 {
            let Some(ray) = rays.next() else { break };
            flights.push((Flight::new(self, ray), top.stack(), mesh.stack()));
        }
        let mut turn = 0;
        while !flights.is_empty() {
            turn = if turn < flights.len() { turn } else { 0 };
            let (flight, top, mesh) = &mut flights[turn];
            if !flight.step::<ANY>(processor, (top, mesh)) {
                turn += 1;
                continue;
            }
            land(flight);
            match rays.next() {
                Some(ray) => {
                    top.clear();
                    mesh.clear();
                    *flight = Flight::new(self, ray);
                    turn += 1;
                }
                None => drop(flights.swap_remove(turn)),
            }
        }
    }
}

/// One ray on its way.
struct Flight<'s> {
    number: usize,
    ray: Ray,
    direction: Option<Direction>,
    from: Option<Leaving>,
    moment: Moment<'s>,
    walk: TopWalk<'s>,
    /// The mesh that it is in.
    within: Option<(Visit<'s>, MeshWalk<'s>)>,
    hit: Option<SceneHit>,
    steps: u32,
}

/// A ray in the frame of a mesh that it meets.
struct Visit<'s> {
    placement: u32,
    mesh: &'s Mesh,
    carried: Option<Carried>,
    t_enter: f64,
    taken: Taken,
}

type Stacks<'a, 'r> = (&'a mut Stack<'r, f64>, &'a mut Stack<'r, f32>);

impl<'s> Flight<'s> {
    #[inline(always)]
    fn new(stage: &'s Stage, (number, (ray, from, time)): (usize, Asked<'_>)) -> Self {
        let (direction, walk) = (Direction::new(ray.d), stage.top.walk(ray.o, ray.d, ray.t_max));
        let moment = stage.at(time);
        Self { number, ray: *ray, direction, from, moment, walk, within: None, hit: None, steps: 0 }
    }

    /// Goes on until it has to wait for memory; true when it is over.
    #[inline(always)]
    fn step<const ANY: bool>(&mut self, processor: Processor, (top, mesh): Stacks<'_, '_>) -> bool {
        if let Some((_, walk)) = &mut self.within {
            if !walk.step::<ANY>(processor, mesh) {
                walk.prefetch();
                return false;
            }
            mesh.clear();
            if self.leave::<ANY>(processor) && ANY {
                return true;
            }
        }
        while self.within.is_none() {
            let Some((index, t_enter)) = self.walk.next(processor, top) else { return true };
            if self.enter::<ANY>(processor, index, t_enter) && ANY {
                return true;
            }
        }
        false
    }

    /// Enters a placement; true if it is done with at once and was hit.
    #[inline(always)]
    fn enter<const ANY: bool>(&mut self, processor: Processor, index: u32, t_enter: f64) -> bool {
        self.steps += 1;
        let Moment { stage, time } = self.moment;
        let placement = &stage.placements[index as usize];
        if ANY && placement.skin == Skin::Open {
            return false;
        }
        let mut carried = None;
        let local = Local::of(placement, self.local(), time, &mut carried);
        let geometry = &*stage.geometries[placement.geometry as usize];
        let t_enter = local.entry(placement, geometry, t_enter);
        let mesh = match geometry {
            Geometry::Analytic(shape) => {
                let mut steps = 0;
                let hit = if ANY && shape.occluded(local.ray, processor) {
                    Some(Hit { t: 0.0, at: DVec2::ZERO, face: 0 })
                } else if ANY {
                    None
                } else {
                    shape.intersect(local.ray, processor, &mut steps)
                };
                self.steps += steps;
                return self.take(index, hit);
            }
            Geometry::Mesh(mesh) => mesh,
        };
        let Some(direction) = local.direction else { return false };
        let taken = mesh.take_up(direction, t_enter);
        let visit = Visit { placement: index, mesh, carried, t_enter, taken };
        let (ray, approach) = self.approach(&visit, processor);
        match mesh.begin::<ANY>(ray, &approach, taken) {
            Begun::Over(hit, steps) => {
                self.steps += steps;
                self.land::<ANY>(processor, &visit, hit)
            }
            Begun::Walk(walk) => {
                walk.prefetch();
                self.within = Some((visit, walk));
                false
            }
        }
    }

    /// Leaves the mesh that it was in; true if it was hit.
    #[inline(always)]
    fn leave<const ANY: bool>(&mut self, processor: Processor) -> bool {
        let Some((visit, walk)) = self.within.take() else { return false };
        self.steps += walk.steps;
        self.land::<ANY>(processor, &visit, walk.hit())
    }

    /// True if what the tree found is a hit. Of any triangle that is found it is not known whether
    /// others lie before it: one behind the ray's origin is asked about again.
    #[inline(always)]
    fn land<const ANY: bool>(
        &mut self,
        processor: Processor,
        visit: &Visit<'_>,
        hit: Option<MeshHit>,
    ) -> bool {
        let Some(found) = hit else { return false };
        let (ray, approach) = self.approach(visit, processor);
        let mesh = visit.mesh;
        let mut steps = 0;
        let landed = if ANY && approach.from.is_none() {
            Some(Hit { t: 0.0, at: DVec2::ZERO, face: found.triangle })
        } else if ANY {
            mesh.intersect(ray, approach, &mut steps)
        } else {
            match mesh.land(ray, &approach, visit.taken, hit) {
                Landed::At(hit) => Some(hit),
                Landed::Nowhere => None,
                Landed::Behind(..) => mesh.intersect(ray, approach, &mut steps),
            }
        };
        self.steps += steps;
        self.take(visit.placement, landed)
    }

    #[inline(always)]
    fn take(&mut self, placement: u32, hit: Option<Hit>) -> bool {
        let Some(hit) = hit else { return false };
        self.hit = SceneHit { placement, hit }.or_before(self.hit);
        (self.walk.t_max, self.ray.t_max) = (hit.t, hit.t);
        true
    }

    /// The ray in the world.
    #[inline(always)]
    fn local(&self) -> Local<'_> {
        Local { ray: &self.ray, direction: self.direction.as_ref() }
    }

    /// The ray in the frame of a mesh, and how it comes to it.
    #[inline(always)]
    fn approach<'a>(
        &'a self,
        visit: &'a Visit<'_>,
        processor: Processor,
    ) -> (&'a Ray, Approach<'a>) {
        let from = Leaving::face_on(self.from, visit.placement);
        let local = visit.carried.as_ref().map_or(self.local(), Local::from);
        (local.ray, self.moment.approach(processor, local, visit.t_enter, from))
    }
}
