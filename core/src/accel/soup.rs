//! Meshes and random numbers for the tests of this room.

use std::collections::HashMap;
use std::ops::Range;

use glam::Vec3;

use super::{Begun, Direction, Flock, MeshBvh, MeshHit, Precision, Processor, Query, Room};

/// Points and triangles.
pub(super) type Arrays = (Vec<Vec3>, Vec<[u32; 3]>);

/// PCG32, O'Neill 2014.
pub(super) struct Rng(pub(super) u64);

impl Rng {
    /// Uniform in [0, 1).
    pub(super) fn next(&mut self) -> f32 {
        let s = self.0;
        self.0 = s.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        #[expect(clippy::cast_possible_truncation, reason = "32 of the 64 bits are the output")]
        let x = (((s >> 18) ^ s) >> 27) as u32;
        (x.rotate_right((s >> 59) as u32) >> 8) as f32 / 16_777_216.0
    }

    pub(super) fn below(&mut self, n: usize) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number below n, for small n"
        )]
        let i = (self.next() * n as f32) as usize;
        i.min(n - 1)
    }

    /// Uniform in [-1, 1)³.
    pub(super) fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * 2.0 - 1.0
    }
}

/// `n` unconnected triangles of about this size in [-1, 1]³.
pub(super) fn soup(n: u32, size: f32, rng: &mut Rng) -> Arrays {
    let mut points = Vec::new();
    for _ in 0..n {
        let centre = rng.point();
        points.extend([0; 3].map(|_| centre + size * rng.point()));
    }
    (points, (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// A closed mesh of 20·4^level triangles on the sphere of this radius.
pub(super) fn icosphere(level: u32, radius: f32) -> Arrays {
    let g = f32::midpoint(1.0, 5f32.sqrt());
    let mut points: Vec<Vec3> = Vec::new();
    for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        points.push(Vec3::new(a, b, 0.0));
    }
    for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        points.push(Vec3::new(0.0, a, b));
    }
    for (a, b) in [(-1.0, g), (1.0, g), (-1.0, -g), (1.0, -g)] {
        points.push(Vec3::new(b, 0.0, a));
    }
    let faces = "0b5 051 017 07a 0ab 159 5b4 ba2 a76 718 394 342 326 368 389 495 24b 62a 867 981";
    let corner = |c: char| c.to_digit(16).expect("the digits above are hexadecimal");
    let mut triangles: Vec<[u32; 3]> = faces
        .split(' ')
        .map(|f| f.chars().map(corner).collect::<Vec<_>>())
        .map(|f| [f[0], f[1], f[2]])
        .collect();
    for _ in 0..level {
        let mut middles = HashMap::new();
        let mut middle = |a: u32, b: u32| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                points.push(points[a as usize].normalize() + points[b as usize].normalize());
                u32::try_from(points.len() - 1).expect("few points")
            })
        };
        triangles = triangles
            .iter()
            .flat_map(|&[a, b, c]| {
                let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
                [[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]
            })
            .collect();
    }
    (points.iter().map(|p| p.normalize() * radius).collect(), triangles)
}

impl MeshBvh {
    /// The nearest hit along a direction of any length, its `t` in that length, and the steps taken:
    /// the same on every processor.
    pub(super) fn shoot(&self, o: Vec3, d: Vec3, t_max: f32) -> (Option<MeshHit>, u32) {
        self.shoot_with(Precision::Standard, o, d, t_max)
    }

    pub(super) fn shoot_with(
        &self,
        precision: Precision,
        o: Vec3,
        d: Vec3,
        t_max: f32,
    ) -> (Option<MeshHit>, u32) {
        let Some(direction) = Direction::new(d.as_dvec3()) else { return (None, 0) };
        let t_max = f64::from(t_max) * direction.scale();
        let (o, direction) = (o.as_dvec3(), &direction);
        let query = Query { o, direction, t_max, skip: None, precision, share: 0.0 };
        let (hit, steps) = self.intersect(Processor::ANY, &query);
        for processor in Processor::all() {
            let name = processor.name();
            assert_eq!(self.intersect(processor, &query), (hit, steps), "{name}");
            assert_eq!(self.occluded(processor, &query), hit.is_some(), "{name}");
            assert_eq!(self.flocked::<false>(processor, &[query]), [(hit, steps)], "{name}");
        }
        (hit.map(|hit| MeshHit { t: hit.t * direction.per_scale(), ..hit }), steps)
    }

    /// What rays side by side meet, in their order, and the steps taken.
    pub(super) fn flocked<const ANY: bool>(
        &self,
        processor: Processor,
        queries: &[Query<'_>],
    ) -> Vec<(Option<MeshHit>, u32)> {
        let mut found = vec![(None, 0); queries.len()];
        let mut rest = 0..queries.len();
        let begin = |rest: &mut Range<usize>, found: &mut [(Option<MeshHit>, u32)]| {
            rest.find_map(|ray| match self.begin::<ANY>(&queries[ray]) {
                Begun::Walk(walk) => Some((ray, walk)),
                Begun::Over(hit, steps) => {
                    found[ray] = (hit, steps);
                    None
                }
            })
        };
        let mut rooms: Vec<_> = queries.iter().take(Flock::MOST).map(|_| Room::default()).collect();
        let (mut flock, mut rays) = (Flock::new(), vec![]);
        for room in &mut rooms {
            let Some((ray, walk)) = begin(&mut rest, &mut found) else { break };
            rays.push(ray);
            flock.add(walk, room.stack());
        }
        while flock.advance::<ANY>(processor, |_, _, _| {}) {
            while let Some((slot, walk)) = flock.landed() {
                found[rays[slot]] = (walk.hit(), walk.steps);
                if let Some((ray, walk)) = begin(&mut rest, &mut found) {
                    rays[slot] = ray;
                    flock.replace(slot, walk);
                }
            }
        }
        found
    }

    pub(super) fn hit(&self, o: Vec3, d: Vec3, t_max: f32) -> Option<MeshHit> {
        self.shoot(o, d, t_max).0
    }

    pub(super) fn is_hit(&self, o: Vec3, d: Vec3, t_max: f32) -> bool {
        self.hit(o, d, t_max).is_some()
    }
}

/// One tree per triangle: a single leaf, so no box is ever tested.
pub(super) struct BruteForce(Vec<MeshBvh>);

impl BruteForce {
    pub(super) fn new((points, indices): &Arrays) -> Self {
        let one = |t: &[u32; 3]| MeshBvh::build(points, &[*t]).expect("a valid triangle");
        Self(indices.iter().map(one).collect())
    }

    /// The nearest hit, of equally near ones that of the lowest number.
    pub(super) fn intersect(&self, o: Vec3, d: Vec3, t_max: f32) -> Option<MeshHit> {
        let mut best: Option<MeshHit> = None;
        for (tree, triangle) in self.0.iter().zip(0..) {
            if let Some(hit) = tree.hit(o, d, t_max)
                && best.is_none_or(|b| hit.t < b.t)
            {
                best = Some(MeshHit { triangle, ..hit });
            }
        }
        best
    }
}
