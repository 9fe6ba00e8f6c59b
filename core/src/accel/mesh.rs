//! The triangles of one mesh, ready to trace.

use glam::Vec3;
use rayon::prelude::*;

use super::build::{Tree, Triangles};
use super::error::BuildError;
use super::node::{Block, Bounds, Child, Node};
use super::partition::PART;
use super::ray::{MeshRay, cull};
use super::triangle::Nearest;

/// A mesh's triangles in a four-wide tree, in f32 about the mesh's own centre.
///
/// Watertight: where two triangles share the same two points, no ray passes between them. There is
/// no smallest distance and no epsilon; a caller that leaves a surface offsets its origin by the
/// error bound of the hit. The tree is scaled by a power of two, so meshes of any size have the
/// same relative accuracy.
#[derive(Debug)]
pub struct MeshBvh {
    nodes: Vec<Node>,
    blocks: Vec<Block>,
    root: Option<Child>,
    /// Entries that the traversal stack can need.
    stack: usize,
    /// Power of two from the caller's frame to the tree's.
    unit: f32,
    /// Largest |coordinate| in the tree's frame.
    reach: f32,
    bounds: Option<(Vec3, Vec3)>,
    dropped: usize,
}

/// Where a ray meets a triangle.
///
/// The point is `(1 − b1 − b2)·p0 + b1·p1 + b2·p2`, better known than `o + t·d`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshHit {
    /// Ray parameter in units of the direction's length, 0 < t <= `t_max`.
    pub t: f32,
    /// Position in the array of triangles that the tree was built from.
    pub triangle: u32,
    /// Barycentric weight of the triangle's second point, in [0, 1] to rounding.
    pub b1: f32,
    /// Barycentric weight of its third point.
    pub b2: f32,
}

impl MeshBvh {
    /// Builds the tree over these triangles. Triangles without area are left out, see
    /// [`MeshBvh::dropped`]; no triangles at all is a mesh that nothing hits. Equal input gives an
    /// equal tree, whatever the number of threads.
    ///
    /// `points` are about the mesh's own centre, in any length unit; they are read, not kept.
    ///
    /// # Errors
    /// A point that is not finite (used or not), an index past the points, or more than 2²⁹
    /// triangles.
    pub fn build(points: &[Vec3], indices: &[[u32; 3]]) -> Result<Self, BuildError> {
        check(points, indices)?;
        let largest = points.iter().fold(Vec3::ZERO, |m, p| m.max(p.abs())).max_element();
        let unit = 1.0 / power_of_two_below(largest);
        let triangles = Triangles { points, indices, unit };
        let prims = triangles.prims();
        let dropped = indices.len() - prims.len();
        let Tree { nodes, blocks, root } = triangles.tree(prims);
        let size = root.map_or(Bounds { min: Vec3::ZERO, max: Vec3::ZERO }, |root| root.bounds);
        // A node takes itself off the stack and puts at most four on it.
        let stack = root.map_or(0, |root| 3 * root.depth + 4);
        debug_assert!(stack <= 256, "builders bound the depth");
        Ok(Self {
            nodes,
            blocks,
            root: root.map(|root| root.child),
            stack,
            unit,
            reach: size.min.abs().max(size.max.abs()).max_element(),
            bounds: root.map(|_| (size.min / unit, size.max / unit)),
            dropped,
        })
    }

    /// How many triangles were left out because they have no area.
    pub fn dropped(&self) -> usize {
        self.dropped
    }

    /// The corners of the box around all triangles with an area, or `None` without any.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.bounds
    }

    /// Bytes that the tree holds.
    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.blocks.as_slice())
    }

    /// The nearest hit with 0 < t <= `t_max`; of equally near triangles the one that comes first.
    ///
    /// `o` and `d` are in the frame of the points and `d` has any length but zero; `t_max` may be
    /// infinite. A ray that is not finite (or a `t_max` of NaN), has no direction, or starts more than 2¹⁰⁰ mesh sizes
    /// away hits nothing.
    pub fn intersect(&self, o: Vec3, d: Vec3, t_max: f32) -> Option<MeshHit> {
        self.trace::<false, false>(o, d, t_max, NONE).0
    }

    /// True if anything is hit with 0 < t <= `t_max`; the same answer as
    /// `intersect(..).is_some()`, sooner.
    pub fn occluded(&self, o: Vec3, d: Vec3, t_max: f32) -> bool {
        self.trace::<true, false>(o, d, t_max, NONE).0.is_some()
    }

    /// [`MeshBvh::occluded`] for a ray that leaves the triangle `skip`, which a straight ray cannot
    /// meet again: rounding would let it, where the triangle is a sliver.
    pub fn occluded_from(&self, o: Vec3, d: Vec3, t_max: f32, skip: Option<u32>) -> bool {
        self.trace::<true, false>(o, d, t_max, skip.unwrap_or(NONE)).0.is_some()
    }

    /// [`MeshBvh::intersect`] for a ray that leaves the triangle `skip`, and how many nodes and
    /// triangle blocks it looked at.
    pub fn intersect_counted(
        &self,
        o: Vec3,
        d: Vec3,
        t_max: f32,
        skip: Option<u32>,
    ) -> (Option<MeshHit>, u32) {
        self.trace::<false, true>(o, d, t_max, skip.unwrap_or(NONE))
    }

    #[inline(always)]
    fn trace<const ANY: bool, const COUNT: bool>(
        &self,
        o: Vec3,
        d: Vec3,
        t_max: f32,
        skip: u32,
    ) -> (Option<MeshHit>, u32) {
        let Some(root) = self.root else { return (None, 0) };
        if t_max.is_nan() {
            return (None, 0);
        }
        let Some((ray, t_unit)) = self.prepare(o, d, skip) else { return (None, 0) };
        // An infinite limit would let a ray "enter" the boxes that it misses at infinity.
        let limit = (t_max / t_unit).min(f32::MAX);
        let mut best = Nearest { t: limit, id: u32::MAX, b1: 0.0, b2: 0.0 };
        // A stack is cleared for each ray, so small trees get small ones.
        let steps = match self.stack {
            0..=16 => self.walk::<ANY, COUNT, 16>(root, &ray, &mut best),
            17..=64 => self.walk::<ANY, COUNT, 64>(root, &ray, &mut best),
            _ => self.walk::<ANY, COUNT, 256>(root, &ray, &mut best),
        };
        let hit = (best.id != u32::MAX).then(|| MeshHit {
            t: (best.t * t_unit).min(t_max),
            triangle: best.id,
            b1: best.b1,
            b2: best.b2,
        });
        (hit, steps)
    }

    /// The ray in the tree's frame with a direction of moderate length, and the power of two by
    /// which a parameter of that ray is multiplied to be one of the caller's.
    #[inline(always)]
    fn prepare(&self, o: Vec3, d: Vec3, skip: u32) -> Option<(MeshRay, f32)> {
        let o = o * self.unit;
        let mut d = d * self.unit;
        let mut t_unit = 1.0;
        let mut largest = d.abs().max_element();
        // Within these bounds no product of the tests overflows or loses digits below.
        if !(f32::from_bits(0x3000_0000)..f32::from_bits(0x4f00_0000)).contains(&largest) {
            t_unit = 1.0 / power_of_two_below(largest);
            d *= t_unit;
            largest = d.abs().max_element();
        }
        let valid = o.is_finite() && d.is_finite() && largest > 0.0;
        valid.then(|| (MeshRay::new(o, d, self.reach).skipping(skip), t_unit))
    }

    /// Visits nodes near to far by octant; `LEN` is a power of two not below `self.stack`.
    fn walk<const ANY: bool, const COUNT: bool, const LEN: usize>(
        &self,
        root: Child,
        ray: &MeshRay,
        best: &mut Nearest,
    ) -> u32 {
        let (mut children, mut enters) = ([Child::default(); LEN], [0.0f32; LEN]);
        let mut top = 0;
        let mut current = root;
        let mut steps = 0;
        loop {
            if current.is_leaf() {
                for block in &self.blocks[current.blocks()] {
                    steps += u32::from(COUNT);
                    if block.intersect::<ANY>(ray, best) && ANY {
                        best.id = 0;
                        return steps;
                    }
                }
            } else {
                let node = &self.nodes[current.index()];
                steps += u32::from(COUNT);
                let (entered, t) = ray.enter(node, best.t);
                if entered != 0 {
                    // Writes all four, keeps those that are entered; the nearest comes last. The
                    // mask on the index changes nothing, as `self.stack` bounds it, but tells so.
                    let t = t.to_array();
                    for place in (0..4).rev() {
                        let slot = node.order.slot(ray.octant, place);
                        children[top & (LEN - 1)] = node.children[slot];
                        enters[top & (LEN - 1)] = t[slot];
                        top += entered as usize >> slot & 1;
                    }
                    top -= 1;
                    current = children[top & (LEN - 1)];
                    continue;
                }
            }
            loop {
                if top == 0 {
                    return steps;
                }
                top -= 1;
                if enters[top & (LEN - 1)] <= cull(best.t) {
                    current = children[top & (LEN - 1)];
                    break;
                }
            }
        }
    }
}

/// The number of no triangle.
const NONE: u32 = u32::MAX;

/// The power of two at or below `x`, within 2^±100; 1 for zero.
fn power_of_two_below(x: f32) -> f32 {
    let power = f32::from_bits(x.to_bits() & 0x7f80_0000);
    if x > 0.0 { power.clamp(f32::from_bits(27 << 23), f32::from_bits(227 << 23)) } else { 1.0 }
}

fn check(points: &[Vec3], indices: &[[u32; 3]]) -> Result<(), BuildError> {
    let limit = Child::BLOCK_LIMIT;
    if indices.len() >= limit {
        return Err(BuildError::TooManyTriangles { n_triangles: indices.len(), limit });
    }
    if let Some(point) = points.iter().position(|p| !p.is_finite()) {
        return Err(BuildError::NonFinitePoint { point });
    }
    let n_points = points.len();
    let outside = |t: &[u32; 3]| t.iter().any(|&i| i as usize >= n_points);
    let bad = if indices.len() > PART {
        indices.par_iter().position_first(outside)
    } else {
        indices.iter().position(outside)
    };
    bad.map_or(Ok(()), |triangle| {
        let index = indices[triangle].into_iter().find(|&i| i as usize >= n_points);
        let index = index.expect("this triangle was found by having one");
        Err(BuildError::IndexOutOfRange { triangle, index, n_points })
    })
}
