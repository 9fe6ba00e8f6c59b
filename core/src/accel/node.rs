//! The wide tree in memory: nodes of eight boxes, blocks of four triangles, references between them.

use glam::{Vec3, Vec3A, Vec3Swizzles, Vec4};

use super::slabs::Boxes;

/// Children of a node.
pub(super) const WIDTH: usize = 8;

/// Triangles of a block.
pub(super) const LANES: usize = 4;

/// A node or a run of blocks: bit 31 tells a leaf; a leaf holds its first block and, in the low two
/// bits, how many blocks follow it; a node holds its position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Child(u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    /// Blocks that one leaf may hold.
    pub(super) const MAX_BLOCKS: usize = 4;
    /// How many blocks 29 bits number.
    pub(super) const BLOCK_LIMIT: usize = 1 << 29;

    /// What is no part of any tree: a leaf behind the last.
    pub(super) const OVER: Self = Self(u32::MAX);

    pub(super) fn node(index: usize) -> Self {
        debug_assert!(index < Self::LEAF as usize);
        Self(narrow(index))
    }

    /// `n` blocks, 1..=4, starting at `first`.
    pub(super) fn leaf(first: usize, n: usize) -> Self {
        debug_assert!((1..=Self::MAX_BLOCKS).contains(&n) && first < Self::BLOCK_LIMIT);
        Self(Self::LEAF | (narrow(first) << 2) | narrow(n - 1))
    }

    /// The reference as it stands in memory.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub(super) fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    #[inline(always)]
    pub(super) fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    /// The node's position; meaningless for a leaf.
    #[inline(always)]
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }

    /// The leaf's blocks; meaningless for a node.
    #[inline(always)]
    pub(super) fn blocks(self) -> std::ops::Range<usize> {
        let first = ((self.0 & !Self::LEAF) >> 2) as usize;
        first..first + (self.0 & 3) as usize + 1
    }

    /// The blocks of a leaf but for the first, and whether there are any.
    #[inline(always)]
    pub(super) fn behind_first(self) -> (Self, bool) {
        let others = self.0 & 3;
        // One block further on, one fewer behind it.
        (Self(self.0.wrapping_add((1 << 2) - 1)), others != 0)
    }

    /// The same reference after its array was appended to others of these lengths.
    pub(super) fn shifted(self, nodes: usize, blocks: usize) -> Self {
        if self.is_leaf() {
            let run = self.blocks();
            Self::leaf(run.start + blocks, run.len())
        } else {
            Self::node(self.index() + nodes)
        }
    }
}

/// Narrows an index that the size limits of a build keep below 2³².
pub(super) fn narrow(index: usize) -> u32 {
    u32::try_from(index).expect("build limits keep every index below 2^31")
}

/// An axis-aligned box; empty if `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    pub(super) min: Vec3A,
    pub(super) max: Vec3A,
}

impl Default for Bounds {
    fn default() -> Self {
        Self::EMPTY
    }
}

impl Bounds {
    pub(super) const EMPTY: Self = Self { min: Vec3A::INFINITY, max: Vec3A::NEG_INFINITY };

    pub(super) fn union(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    pub(super) fn grow(self, p: Vec3A) -> Self {
        Self { min: self.min.min(p), max: self.max.max(p) }
    }

    /// Half the surface; 0 for an empty box. Coordinates are at most 2, so nothing overflows.
    pub(super) fn half_area(self) -> f32 {
        let e = (self.max - self.min).max(Vec3A::ZERO);
        e.dot(e.yzx())
    }
}

/// In which order the children of a node lie along a ray, for each of the eight sign patterns of its
/// direction (bit a set if component a is negative): the slots by the centres of their boxes, three
/// bits each, the farthest lowest.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Order(pub(super) [u32; 8]);

impl Order {
    /// By the centres of the boxes of the first slots; empty ones lie anywhere.
    pub(super) fn of(centres: &[[f64; 3]]) -> Self {
        let mut orders = [0; 8];
        for octant in 0..4 {
            let mut keys = [0; WIDTH];
            for (key, c) in keys.iter_mut().zip(centres) {
                let sign = |axis: usize| if octant >> axis & 1 == 0 { c[axis] } else { -c[axis] };
                *key = ordered(sign(0) + sign(1) + sign(2));
            }
            for slot in 0..WIDTH {
                // Its place is how many are before it; of equal ones the earlier slots.
                let before = |i: usize| keys[i] < keys[slot] || keys[i] == keys[slot] && i < slot;
                let place: u32 = (0..WIDTH).map(|i| u32::from(before(i))).sum();
                orders[octant] |= narrow(slot) << (3 * (7 - place));
                // The opposite direction meets them the other way round.
                orders[7 - octant] |= narrow(slot) << (3 * place);
            }
        }
        Self(orders)
    }

    /// The slots for a direction of this octant, as they are stored.
    #[inline(always)]
    pub(super) fn bits(&self, octant: usize) -> u32 {
        self.0[octant & 7]
    }

    /// The slots from far to near, for a direction of this octant.
    #[inline(always)]
    pub(super) fn far_to_near(&self, octant: usize) -> [usize; WIDTH] {
        let bits = self.bits(octant) as usize;
        [0, 3, 6, 9, 12, 15, 18, 21].map(|shift| bits >> shift & 7)
    }
}

/// Maps numbers to integers of the same order; NaN lies at an end.
fn ordered(x: f64) -> i64 {
    let bits = x.to_bits().cast_signed();
    bits ^ ((bits >> 63) & i64::MAX)
}

/// Eight boxes around triangles.
pub(super) type Node = Boxes<f32>;

impl Node {
    /// A node over 1..=8 slots; those that are left over have empty boxes, which no ray enters.
    pub(super) fn of(slots: &[(Child, Bounds)]) -> Self {
        debug_assert!((1..=WIDTH).contains(&slots.len()));
        let mut planes = [[[f32::INFINITY; WIDTH], [f32::NEG_INFINITY; WIDTH]]; 3];
        let mut children = [Child(0); WIDTH];
        let mut centres = [[0.0; 3]; WIDTH];
        for (slot, (child, bounds)) in slots.iter().enumerate() {
            children[slot] = *child;
            for axis in 0..3 {
                (planes[axis][0][slot], planes[axis][1][slot]) =
                    (bounds.min[axis], bounds.max[axis]);
                centres[slot][axis] = f64::from(bounds.min[axis]) + f64::from(bounds.max[axis]);
            }
        }
        Self { planes, children, order: Order::of(&centres[..slots.len()]) }
    }
}

/// By how much the corners of a block move, from first to last.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shift([[Vec4; 3]; 3]);

/// Four triangles by coordinate, `points[vertex][axis]`; a lane without a triangle is all NaN,
/// which fails every comparison.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Block {
    pub(super) points: [[Vec4; 3]; 3],
    pub(super) ids: [u32; LANES],
}

impl Block {
    /// A block of 1..=4 triangles and their numbers.
    pub(super) fn of(triangles: impl Iterator<Item = (u32, [Vec3; 3])>) -> Self {
        let mut points = [[[f32::NAN; LANES]; 3]; 3];
        let mut ids = [u32::MAX; LANES];
        for (lane, (id, triangle)) in triangles.take(LANES).enumerate() {
            ids[lane] = id;
            for (vertex, p) in triangle.iter().enumerate() {
                for axis in 0..3 {
                    points[vertex][axis][lane] = p[axis];
                }
            }
        }
        Self { points: points.map(|vertex| vertex.map(Vec4::from_array)), ids }
    }

    /// By how much its triangles move, whose corners end there.
    pub(super) fn shift(&self, last: impl Fn(u32) -> [Vec3; 3]) -> Shift {
        let used = self.ids.into_iter().take_while(|id| *id != u32::MAX);
        let last = Self::of(used.map(|id| (id, last(id))));
        let axes = |v: usize| [0, 1, 2].map(|axis| last.points[v][axis] - self.points[v][axis]);
        Shift([0, 1, 2].map(axes))
    }

    /// The block when a share of the way is done. Each coordinate comes from one product and one sum:
    /// it changes only one way, and is the same in all triangles that have the corner.
    #[inline(always)]
    pub(super) fn at(&self, shift: &Shift, share: f32) -> Self {
        let axes = |v: usize| [0, 1, 2].map(|a| self.points[v][a] + shift.0[v][a] * share);
        Self { points: [0, 1, 2].map(axes), ids: self.ids }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_leaf_numbers_as_many_blocks_as_the_limit_and_not_one_more() {
        let last = Child::BLOCK_LIMIT - 1;
        for (first, n) in [(0, 1), (last, 1), (last - 3, 4)] {
            let leaf = Child::leaf(first, n);
            assert!(leaf.is_leaf());
            assert_eq!(leaf.blocks(), first..first + n);
            assert_ne!(leaf, Child::OVER);
            let (rest, is_more) = leaf.behind_first();
            assert_eq!(is_more, n > 1);
            assert!(!is_more || rest == Child::leaf(first + 1, n - 1));
        }
        // The number behind the last one would reach the bit that tells a leaf.
        assert_eq!(narrow(Child::BLOCK_LIMIT << 2), Child::LEAF);
    }
}
