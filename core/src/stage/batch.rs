//! Many rays through the whole stage: one by one, or some at a time side by side, so that while one waits
//! for memory the others go on. What they meet is the same.

use glam::DVec2;
use luxel_sdk::kind::Hit;
use luxel_sdk::num::Ray;

use crate::accel::{
    Begun, Direction, Flock, MeshHit, MeshWalk, Processor, Room, Stack, TopWalk, prefetch_value,
};

use super::geometry::{Approach, Geometry, Landed, Mesh, Taken};
use super::trace::{Carried, Local};
use super::{Leaving, Moment, SceneHit, Skin, Stage};

/// Bytes of trees from which on rays are traced sooner side by side: one by one takes 1.04 times as long
/// with 4.6 MB, 1.56 times with 140 MB (docs/performance.md). Below, it costs more to keep many under way.
const CACHE_BYTES: usize = 1 << 22;

/// How many rays are traced: room for those that go side by side, made once.
#[derive(Debug)]
pub struct Rooms(Vec<(Room<f64>, Room<f32>)>);

impl Rooms {
    /// As is sooner with a stage.
    pub fn of(stage: &Stage) -> Self {
        if stage.is_for_flocks() { Self::side_by_side() } else { Self::one_by_one() }
    }

    /// Rays go side by side.
    pub fn side_by_side() -> Self {
        Self((0..Flock::MOST).map(|_| (Room::default(), Room::default())).collect())
    }

    /// Each ray is traced to its end before the next.
    pub fn one_by_one() -> Self {
        Self(vec![])
    }
}

/// A ray that leaves a primitive, if it starts on one, at a time in seconds.
pub type Asked<'a> = (&'a Ray, Option<Leaving>, f64);

impl Stage {
    /// Whether many rays are traced sooner side by side than one by one.
    pub fn is_for_flocks(&self) -> bool {
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
        self.side_by_side::<false>(processor, rays, rooms, |flight| {
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
        self.side_by_side::<true>(processor, rays, rooms, |flight| {
            tell(flight.number, flight.hit.is_some());
        });
    }

    #[inline(always)]
    fn side_by_side<'a, const ANY: bool>(
        &self,
        processor: Processor,
        rays: impl Iterator<Item = Asked<'a>>,
        rooms: &mut Rooms,
        land: impl FnMut(&Flight<'_>),
    ) {
        let mut queue = Queue { stage: self, processor, rays: rays.enumerate(), land };
        let mut flights = Vec::with_capacity(Flock::MOST);
        let mut flock = Flock::new();
        for (top, mesh) in &mut rooms.0 {
            let mut top = top.stack();
            let Some(mut flight) = queue.next() else { break };
            let Some(walk) = queue.go_on::<ANY>(&mut flight, &mut top) else { break };
            flights.push((flight, top));
            flock.add(walk, mesh.stack());
        }
        while flock.advance::<ANY>(processor, |slot, triangle, is_over| {
            flights[slot].0.ask(triangle, is_over);
        }) {
            while let Some((slot, walk)) = flock.landed() {
                let (flight, top) = &mut flights[slot];
                flight.leave::<ANY>(processor, walk);
                if let Some(walk) = queue.go_on::<ANY>(flight, top) {
                    flock.replace(slot, walk);
                }
            }
        }
    }
}

/// Rays that have not set out yet, and where is told of those that are over.
struct Queue<'s, I, L> {
    stage: &'s Stage,
    processor: Processor,
    rays: I,
    land: L,
}

impl<'s, 'a, I, L> Queue<'s, I, L>
where
    I: Iterator<Item = (usize, Asked<'a>)>,
    L: FnMut(&Flight<'_>),
{
    #[inline(always)]
    fn next(&mut self) -> Option<Flight<'s>> {
        let ray = self.rays.next()?;
        Some(Flight::new(self.stage, ray))
    }

    /// Goes on with a flight, and with the next ones in its place once it is over, until one sets out
    /// through the tree of a mesh; `None` when there are no more rays.
    #[inline(always)]
    fn go_on<const ANY: bool>(
        &mut self,
        flight: &mut Flight<'s>,
        top: &mut Stack<'_, f64>,
    ) -> Option<MeshWalk<'s>> {
        loop {
            if let Some(walk) = flight.go_on::<ANY>(self.processor, top) {
                return Some(walk);
            }
            (self.land)(flight);
            top.clear();
            *flight = self.next()?;
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
    within: Option<Visit<'s>>,
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

impl<'s> Flight<'s> {
    #[inline(always)]
    fn new(stage: &'s Stage, (number, (ray, from, time)): (usize, Asked<'_>)) -> Self {
        let (direction, walk) = (Direction::new(ray.d), stage.top.walk(ray.o, ray.d, ray.t_max));
        let moment = stage.at(time);
        Self { number, ray: *ray, direction, from, moment, walk, within: None, hit: None, steps: 0 }
    }

    /// Goes on until it sets out through the tree of a mesh; `None` when it is over.
    #[inline(always)]
    fn go_on<const ANY: bool>(
        &mut self,
        processor: Processor,
        top: &mut Stack<'_, f64>,
    ) -> Option<MeshWalk<'s>> {
        while !ANY || self.hit.is_none() {
            let (index, t_enter) = self.walk.next(processor, top)?;
            if let Some(walk) = self.enter::<ANY>(processor, index, t_enter) {
                return Some(walk);
            }
        }
        None
    }

    /// Enters a placement: its mesh's tree, or it is done with at once.
    #[inline(always)]
    fn enter<const ANY: bool>(
        &mut self,
        processor: Processor,
        index: u32,
        t_enter: f64,
    ) -> Option<MeshWalk<'s>> {
        self.steps += 1;
        let Moment { stage, time } = self.moment;
        let placement = &stage.placements[index as usize];
        if ANY && placement.skin == Skin::Open {
            return None;
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
                self.take(index, hit);
                return None;
            }
            Geometry::Mesh(mesh) => mesh,
        };
        let direction = local.direction?;
        let taken = mesh.take_up(direction, t_enter);
        let visit = Visit { placement: index, mesh, carried, t_enter, taken };
        let (ray, approach) = self.approach(&visit, processor);
        match mesh.begin::<ANY>(ray, &approach, taken) {
            Begun::Over(hit, steps) => {
                self.steps += steps;
                self.land::<ANY>(processor, &visit, hit);
                None
            }
            Begun::Walk(walk) => {
                self.within = Some(visit);
                Some(walk)
            }
        }
    }

    /// Asks for the memory of what will be wanted of a triangle that it meets: its corners' numbers, and
    /// once its walk is over what these number.
    #[inline(always)]
    fn ask(&self, triangle: u32, is_over: bool) {
        let Some(visit) = &self.within else { return };
        let triangles = visit.mesh.triangles();
        if !is_over {
            return prefetch_value(&triangles.indices[triangle as usize]);
        }
        for i in visit.mesh.indices(triangle) {
            prefetch_value(&triangles.points[i]);
            if let Some(normal) = triangles.normals.get(i) {
                prefetch_value(normal);
            }
        }
    }

    /// Leaves the mesh whose tree it has gone through.
    #[inline(always)]
    fn leave<const ANY: bool>(&mut self, processor: Processor, walk: &MeshWalk<'_>) {
        if let Some(visit) = self.within.take() {
            self.steps += walk.steps;
            self.land::<ANY>(processor, &visit, walk.hit());
        }
    }

    /// Takes what the tree found if it is a hit. Of any triangle that is found it is not known whether
    /// others lie before it: one behind the ray's origin is asked about again.
    #[inline(always)]
    fn land<const ANY: bool>(
        &mut self,
        processor: Processor,
        visit: &Visit<'_>,
        hit: Option<MeshHit>,
    ) {
        let Some(found) = hit else { return };
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
        self.take(visit.placement, landed);
    }

    #[inline(always)]
    fn take(&mut self, placement: u32, hit: Option<Hit>) {
        let Some(hit) = hit else { return };
        self.hit = SceneHit { placement, hit }.or_before(self.hit);
        (self.walk.t_max, self.ray.t_max) = (hit.t, hit.t);
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
