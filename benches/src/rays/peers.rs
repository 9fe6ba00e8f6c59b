//! Who traces the rays: this project, and obvhs's own traversal of its own trees.

use glam::Vec3A;
use luxel_core::accel::{
    Begun, Direction, Flock, MeshBvh, MeshHit, MeshWalk, Precision, Processor, Query, Room, Work,
};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::cwbvh::CwBvh;
use obvhs::ray::{Ray, RayHit};
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;

use super::knot::Soup;
use super::shots::{Landing, Shot};

/// A tree over one mesh, and how it meets rays.
pub(crate) trait Tracer {
    /// The nearest hit of each shot.
    fn nearest(&self, shots: &[Shot], found: &mut [Landing]);

    /// Whether each shot hits anything: a distance of 0 for yes.
    fn any(&self, shots: &[Shot], found: &mut [Landing]);

    /// Bytes that the tree holds.
    fn bytes(&self) -> usize;
}

/// One ray after another, with the instructions of a processor.
pub(crate) struct Single {
    pub(crate) tree: MeshBvh,
    pub(crate) processor: Processor,
    pub(crate) precision: Precision,
}

impl Tracer for Single {
    fn nearest(&self, shots: &[Shot], found: &mut [Landing]) {
        self.processor.run(Nearest { tree: &self.tree, precision: self.precision, shots, found });
    }

    fn any(&self, shots: &[Shot], found: &mut [Landing]) {
        self.processor.run(Any { tree: &self.tree, precision: self.precision, shots, found });
    }

    fn bytes(&self) -> usize {
        self.tree.bytes()
    }
}

struct Nearest<'a> {
    tree: &'a MeshBvh,
    precision: Precision,
    shots: &'a [Shot],
    found: &'a mut [Landing],
}

impl Work for Nearest<'_> {
    #[inline(always)]
    fn run(self, processor: Processor) {
        for (shot, found) in self.shots.iter().zip(self.found) {
            *found = Landing::NOWHERE;
            let Some(direction) = Direction::new(shot.d.as_dvec3()) else { continue };
            let hit = self.tree.intersect(processor, &query(shot, &direction, self.precision)).0;
            if let Some(hit) = hit {
                *found = landing(&hit, &direction);
            }
        }
    }
}

struct Any<'a> {
    tree: &'a MeshBvh,
    precision: Precision,
    shots: &'a [Shot],
    found: &'a mut [Landing],
}

impl Work for Any<'_> {
    #[inline(always)]
    fn run(self, processor: Processor) {
        for (shot, found) in self.shots.iter().zip(self.found) {
            let Some(direction) = Direction::new(shot.d.as_dvec3()) else { continue };
            let query = query(shot, &direction, self.precision);
            *found = answer(self.tree.occluded(processor, &query));
        }
    }
}

/// Rays side by side, with the instructions of a processor.
pub(crate) struct SideBySide {
    pub(crate) tree: MeshBvh,
    pub(crate) processor: Processor,
}

impl Tracer for SideBySide {
    fn nearest(&self, shots: &[Shot], found: &mut [Landing]) {
        self.processor.run(InFlock::<false> { tree: &self.tree, shots, found });
    }

    fn any(&self, shots: &[Shot], found: &mut [Landing]) {
        self.processor.run(InFlock::<true> { tree: &self.tree, shots, found });
    }

    fn bytes(&self) -> usize {
        self.tree.bytes()
    }
}

struct InFlock<'a, const ANY: bool> {
    tree: &'a MeshBvh,
    shots: &'a [Shot],
    found: &'a mut [Landing],
}

impl<'a, const ANY: bool> InFlock<'a, ANY> {
    /// The next shot that is not done with at once.
    #[inline(always)]
    fn begin(&mut self, next: &mut usize) -> Option<(usize, Direction, MeshWalk<'a>)> {
        while let Some(shot) = self.shots.get(*next) {
            let number = *next;
            *next += 1;
            self.found[number] = Landing::NOWHERE;
            let Some(direction) = Direction::new(shot.d.as_dvec3()) else { continue };
            match self.tree.begin::<ANY>(&query(shot, &direction, Precision::Standard)) {
                Begun::Walk(walk) => return Some((number, direction, walk)),
                Begun::Over(..) => {}
            }
        }
        None
    }
}

impl<const ANY: bool> Work for InFlock<'_, ANY> {
    #[inline(always)]
    fn run(mut self, processor: Processor) {
        let mut rooms: Vec<Room<f32>> = (0..Flock::MOST).map(|_| Room::default()).collect();
        let (mut next, mut flock, mut flights) = (0, Flock::new(), vec![]);
        for room in &mut rooms {
            let Some((number, direction, walk)) = self.begin(&mut next) else { break };
            flights.push((number, direction));
            flock.add(walk, room.stack());
        }
        while flock.advance::<ANY>(processor, |_, _, _| {}) {
            while let Some((slot, walk)) = flock.landed() {
                let (number, direction) = &flights[slot];
                if let Some(hit) = walk.hit() {
                    self.found[*number] = if ANY { answer(true) } else { landing(&hit, direction) };
                }
                if let Some((number, direction, walk)) = self.begin(&mut next) {
                    flights[slot] = (number, direction);
                    flock.replace(slot, walk);
                }
            }
        }
    }
}

fn query<'a>(shot: &Shot, direction: &'a Direction, precision: Precision) -> Query<'a> {
    let t_max = f64::from(shot.t_max) * direction.scale();
    Query { o: shot.o.as_dvec3(), direction, t_max, skip: None, precision, share: 0.0 }
}

#[expect(clippy::cast_possible_truncation, reason = "rounded for the comparison")]
fn landing(hit: &MeshHit, direction: &Direction) -> Landing {
    Landing { t: (hit.t * direction.per_scale()) as f32, triangle: hit.triangle }
}

/// What `any` says of a shot.
pub(crate) fn answer(hit: bool) -> Landing {
    if hit { Landing { t: 0.0, triangle: 0 } } else { Landing::NOWHERE }
}

fn ray(shot: &Shot) -> Ray {
    Ray::new(Vec3A::from(shot.o), Vec3A::from(shot.d), 0.0, shot.t_max)
}

fn triangles(soup: &Soup) -> Vec<Triangle> {
    (0..soup.indices.len())
        .map(|i| {
            let [v0, v1, v2] = soup.corners(i).map(Vec3A::from);
            Triangle { v0, v1, v2 }
        })
        .collect()
}

/// A tree of obvhs and the triangles in its order.
pub(crate) struct Obvhs<T> {
    tree: T,
    leaves: Vec<RtTriangle>,
    order: Vec<u32>,
    node_bytes: usize,
}

impl Obvhs<Bvh2> {
    pub(crate) fn new(soup: &Soup) -> Self {
        let all = triangles(soup);
        let build = obvhs::bvh2::builder::build_bvh2_from_tris;
        let tree = build(&all, BvhBuildParams::medium_build(), &mut std::time::Duration::default());
        let order = tree.primitive_indices.clone();
        let leaves = order.iter().map(|i| RtTriangle::from(&all[*i as usize])).collect();
        let node_bytes = size_of_val(tree.nodes.as_slice());
        Self { tree, leaves, order, node_bytes }
    }
}

impl Obvhs<CwBvh> {
    pub(crate) fn new(soup: &Soup) -> Self {
        let all = triangles(soup);
        let build = obvhs::cwbvh::builder::build_cwbvh_from_tris;
        let tree = build(&all, BvhBuildParams::medium_build(), &mut std::time::Duration::default());
        let order = tree.primitive_indices.clone();
        let leaves = order.iter().map(|i| RtTriangle::from(&all[*i as usize])).collect();
        let node_bytes = size_of_val(tree.nodes.as_slice());
        Self { tree, leaves, order, node_bytes }
    }
}

macro_rules! traverse {
    ($tree:ty) => {
        impl Tracer for Obvhs<$tree> {
            fn nearest(&self, shots: &[Shot], found: &mut [Landing]) {
                for (shot, found) in shots.iter().zip(found) {
                    let mut hit = RayHit::none();
                    let test = |ray: &Ray, id: usize| self.leaves[id].intersect(ray);
                    let is_hit = self.tree.ray_traverse(ray(shot), &mut hit, test);
                    let triangle = || self.order[hit.primitive_id as usize];
                    *found = if is_hit {
                        Landing { t: hit.t, triangle: triangle() }
                    } else {
                        Landing::NOWHERE
                    };
                }
            }

            fn any(&self, shots: &[Shot], found: &mut [Landing]) {
                for (shot, found) in shots.iter().zip(found) {
                    let test = |ray: &Ray, id: usize| self.leaves[id].intersect(ray);
                    *found = answer(!self.tree.ray_traverse_miss(ray(shot), test));
                }
            }

            fn bytes(&self) -> usize {
                self.node_bytes
                    + size_of_val(self.leaves.as_slice())
                    + size_of_val(self.order.as_slice())
            }
        }
    };
}

traverse!(Bvh2);
traverse!(CwBvh);
