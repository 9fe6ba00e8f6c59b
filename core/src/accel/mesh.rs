//! The triangles of one mesh, ready to trace.

use glam::Vec3;
use rayon::prelude::*;

use super::build::{Tree, Triangles};
use super::error::BuildError;
use super::node::{Block, Bounds, Child, Node};
use super::partition::PART;
use super::ray::{Direction, Shear, Slabs, cull};
use super::stack::Room;
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
    /// 1 / `unit`, exactly.
    per_unit: f32,
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
    /// Ray parameter in lengths of the scaled direction, 0 < t <= `t_max`.
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
            per_unit: 1.0 / unit,
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

    /// The nearest hit with 0 < t <= `t_max`, of equally near triangles the one that comes first;
    /// and how many nodes and triangle blocks were looked at.
    ///
    /// `o` is in the frame of the points and `t` is along the scaled direction; `t_max` may be
    /// infinite. A ray that leaves the triangle `skip` does not meet it: a straight ray cannot, but
    /// rounding would let it where the triangle is a sliver. An origin that is not finite and a
    /// `t_max` of NaN hit nothing.
    #[inline(always)]
    pub fn intersect(
        &self,
        o: Vec3,
        direction: &Direction,
        t_max: f32,
        skip: Option<u32>,
    ) -> (Option<MeshHit>, u32) {
        self.trace::<false>(o, direction, t_max, skip)
    }

    /// True if anything is hit with 0 < t <= `t_max`; the same answer as that of `intersect`, sooner.
    #[inline(always)]
    pub fn occluded(&self, o: Vec3, direction: &Direction, t_max: f32, skip: Option<u32>) -> bool {
        self.trace::<true>(o, direction, t_max, skip).0.is_some()
    }

    #[inline(always)]
    fn trace<const ANY: bool>(
        &self,
        o: Vec3,
        direction: &Direction,
        t_max: f32,
        skip: Option<u32>,
    ) -> (Option<MeshHit>, u32) {
        let Some(root) = self.root else { return (None, 0) };
        let o = o * self.unit;
        if t_max.is_nan() || !o.is_finite() {
            return (None, 0);
        }
        // An infinite limit would let a ray "enter" the boxes that it misses at infinity.
        let limit = (t_max * self.unit).min(f32::MAX);
        let mut best = Nearest { t: limit, id: u32::MAX, b1: 0.0, b2: 0.0 };
        let shear = Shear::new(direction, o, skip.unwrap_or(u32::MAX));
        let steps = if root.is_leaf() {
            self.leaf::<ANY>(root, &shear, &mut best).1
        } else {
            let slabs = Slabs::new(o, direction.d, self.reach);
            self.walk::<ANY>(root, &shear, &slabs, &mut best)
        };
        let hit = (best.id != u32::MAX).then(|| MeshHit {
            t: (best.t * self.per_unit).min(t_max),
            triangle: best.id,
            b1: best.b1,
            b2: best.b2,
        });
        (hit, steps)
    }

    /// Whether a leaf has a hit, which `best` takes, and how many blocks were looked at.
    #[inline(always)]
    fn leaf<const ANY: bool>(&self, leaf: Child, ray: &Shear, best: &mut Nearest) -> (bool, u32) {
        let mut steps = 0;
        for block in &self.blocks[leaf.blocks()] {
            steps += 1;
            if block.intersect::<ANY>(ray, best) && ANY {
                best.id = 0;
                return (true, steps);
            }
        }
        (false, steps)
    }

    /// Visits nodes near to far by octant; how many nodes and blocks they were.
    #[inline(always)]
    fn walk<const ANY: bool>(
        &self,
        root: Child,
        shear: &Shear,
        slabs: &Slabs,
        best: &mut Nearest,
    ) -> u32 {
        let mut room = Room::<(Child, f32)>::new();
        let mut stack = room.stack(self.stack);
        let mut current = root;
        let mut steps = 0;
        loop {
            if current.is_leaf() {
                let (found, n) = self.leaf::<ANY>(current, shear, best);
                steps += n;
                if found && ANY {
                    return steps;
                }
            } else {
                let node = &self.nodes[current.index()];
                steps += 1;
                let (entered, t) = slabs.enter(node, best.t);
                // Writes all four, keeps those that are entered; the nearest comes last.
                let t = t.to_array();
                for slot in node.order.far_to_near(slabs.octant) {
                    stack.push_if(entered >> slot & 1 == 1, (node.children[slot], t[slot]));
                }
            }
            loop {
                let Some((child, t)) = stack.pop() else { return steps };
                if t <= cull(best.t) {
                    current = child;
                    break;
                }
            }
        }
    }
}

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
