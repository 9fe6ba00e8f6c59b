//! Any bytes as a mesh and rays: the tree over all triangles meets what trees over one each meet.
//!
//! The seeded form runs here; `tests/fuzz/run builder` lets a fuzzer choose the bytes.

use glam::{DVec3, Vec3};
use luxel_core::accel::{
    Begun, Direction, Flock, MeshBvh, MeshHit, Precision, Processor, Query, Room,
};

/// Numbers between which meshes have seams, cracks and no area.
const NUMBERS: [f32; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    1.000_000_1,
    -0.999_999_9,
    1e-6,
    -1e-6,
    1e6,
    -1e6,
    1e-38,
    1e12,
    -1e12,
    1e-45,
    1e18,
];

/// Reads numbers from bytes; from where they end all are 0.
struct Bytes<'a>(&'a [u8]);

impl Bytes<'_> {
    fn byte(&mut self) -> u8 {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        *first
    }

    /// One of the numbers above, a step between -4 and 4, or any bits at all.
    fn number(&mut self) -> f32 {
        match self.byte() {
            b if b < 64 => NUMBERS[usize::from(b % 16)],
            b if b < 250 => (f32::from(b) - 157.0) / 23.0,
            _ => f32::from_bits(u32::from_le_bytes([0; 4].map(|_: u8| self.byte())))
                .clamp(-1e18, 1e18),
        }
    }

    fn point(&mut self) -> Vec3 {
        Vec3::from_array([0; 3].map(|_| self.number()))
    }
}

/// Builds a mesh of these bytes and shoots rays at it; how many met something.
///
/// # Panics
/// If the tree answers other than its triangles do.
pub(crate) fn judge(bytes: &[u8]) -> usize {
    let mut bytes = Bytes(bytes);
    let n_points = 1 + bytes.byte() % 48;
    // Now and then an index is beyond the points, or a point is not finite.
    let beyond = u8::from(bytes.byte() < 8);
    let points: Vec<Vec3> = (0..n_points).map(|_| bytes.point()).collect();
    let corner = |byte: u8| u32::from(byte % (n_points + beyond));
    let n = bytes.byte();
    let indices: Vec<[u32; 3]> = (0..n).map(|_| [0; 3].map(|_| corner(bytes.byte()))).collect();
    let Ok(tree) = MeshBvh::build(&points, &indices) else { return 0 };
    // All points go with each, so that all trees scale alike.
    let singles: Vec<MeshBvh> = indices
        .iter()
        .map(|one| MeshBvh::build(&points, &[*one]).expect("part of what has been built"))
        .collect();
    assert_eq!(tree.dropped(), singles.iter().map(MeshBvh::dropped).sum::<usize>());
    let mut met = 0;
    for _ in 0..8 {
        let (o, d) = (bytes.point().as_dvec3(), bytes.point().as_dvec3());
        let Some(direction) = Direction::new(d) else { continue };
        if o.is_finite() {
            met += usize::from(shoot(&tree, &singles, o, &direction));
        }
    }
    met
}

fn shoot(tree: &MeshBvh, singles: &[MeshBvh], o: DVec3, direction: &Direction) -> bool {
    let mut met = false;
    for precision in Precision::ALL {
        let query = Query { o, direction, t_max: f64::INFINITY, skip: None, precision, share: 0.0 };
        for processor in Processor::all() {
            let (hit, steps) = tree.intersect(processor, &query);
            met |= hit.is_some();
            assert_eq!(hit.is_some(), tree.occluded(processor, &query));
            assert_eq!(hit.is_some(), in_flock::<true>(tree, processor, &query).0.is_some());
            assert_eq!((hit, steps), in_flock::<false>(tree, processor, &query));
            // Boxes that are not widened may miss what lies on their faces.
            if precision != Precision::Fast {
                let same = nearest(singles, processor, &query);
                let bits = |hit: Option<MeshHit>| hit.map(|hit| (hit.t.to_bits(), hit.triangle));
                assert_eq!(bits(hit), bits(same), "{precision:?} {processor:?} {o} {direction:?}");
            }
        }
    }
    met
}

/// What a ray meets as those that go side by side do, and in how many steps.
fn in_flock<const ANY: bool>(
    tree: &MeshBvh,
    processor: Processor,
    query: &Query<'_>,
) -> (Option<MeshHit>, u32) {
    let walk = match tree.begin::<ANY>(query) {
        Begun::Over(hit, steps) => return (hit, steps),
        Begun::Walk(walk) => walk,
    };
    let mut room = Room::default();
    let mut flock = Flock::new();
    flock.add(walk, room.stack());
    while flock.advance::<ANY>(processor, |_, _, _| {}) {}
    let (_, walk) = flock.landed().expect("its only walk is over");
    (walk.hit(), walk.steps)
}

/// The nearest hit of trees of one triangle each, of equally near ones the first.
fn nearest(singles: &[MeshBvh], processor: Processor, query: &Query<'_>) -> Option<MeshHit> {
    let mut best: Option<MeshHit> = None;
    for (triangle, single) in (0..).zip(singles) {
        let (hit, _) = single.intersect(processor, query);
        if let Some(hit) = hit
            && best.is_none_or(|best| hit.t < best.t)
        {
            best = Some(MeshHit { triangle, ..hit });
        }
    }
    best
}

#[test]
fn a_tree_meets_what_its_triangles_meet_whatever_they_are() {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        state.to_le_bytes()[7]
    };
    let met: usize = (0..2000).map(|_| judge(&[0; 1200].map(|_| next()))).sum();
    assert!(met > 2000, "{met} of 16,000 rays met a triangle");
}
