//! The triangles of a mesh as what a tree is built of.

use glam::{DVec3, Vec3, Vec3A};
use rayon::prelude::*;

use super::build::Timber;
use super::collapse::Costs;
use super::error::BuildError;
use super::node::{Block, Bounds, Child, LANES, Node, Shift, narrow};
use super::partition::Prim;
use super::passes::fold;
use super::processor::prefetch_value;
use super::watch::{STRIDE, Watch};

/// Strides of primitives that are made at once.
const FEW: usize = 16;

/// The triangles in the scaled frame of the tree.
#[derive(Clone, Copy)]
pub(super) struct Triangles<'a> {
    points: &'a [Vec3],
    indices: &'a [[u32; 3]],
    /// Power of two from the caller's frame to the tree's.
    pub(super) unit: f32,
    moves: Option<Moves<'a>>,
}

/// How many of each a mesh may have.
#[derive(Clone, Copy)]
struct Limits {
    triangles: usize,
    points: usize,
}

impl Limits {
    /// In the worst tree each triangle has a block of its own; and 32 bits tell places and the number
    /// of points apart.
    const OF_TREE: Self = Self { triangles: Child::BLOCK_LIMIT, points: u32::MAX as usize };
}

/// Where points move to, and the shares of the way between which they are met.
#[derive(Clone, Copy)]
struct Moves<'a> {
    last: &'a [Vec3],
    shares: [f32; 2],
}

impl<'a> Triangles<'a> {
    /// Checks the arrays.
    pub(super) fn new(
        points: &'a [Vec3],
        indices: &'a [[u32; 3]],
        watch: &Watch,
    ) -> Result<Self, BuildError> {
        Self::within(Limits::OF_TREE, points, indices, watch)
    }

    /// The same within other limits.
    fn within(
        limits: Limits,
        points: &'a [Vec3],
        indices: &'a [[u32; 3]],
        watch: &Watch,
    ) -> Result<Self, BuildError> {
        let (n_triangles, n_points) = (indices.len(), points.len());
        if n_triangles > limits.triangles {
            return Err(BuildError::TooManyTriangles { n_triangles, limit: limits.triangles });
        }
        if n_points > limits.points {
            return Err(BuildError::TooManyPoints { n_points, limit: limits.points });
        }
        let largest = reach(points, watch)?;
        let most = |all: u32, indices: &[[u32; 3]]| {
            indices.iter().fold(all, |all, t| all.max(t[0]).max(t[1]).max(t[2]))
        };
        if fold(indices, watch, || 0, most, u32::max) as usize >= n_points && !indices.is_empty() {
            let outside = |i: &u32| *i as usize >= n_points;
            let found = indices
                .iter()
                .enumerate()
                .find_map(|(triangle, t)| Some((triangle, t.iter().copied().find(outside)?)));
            if let Some((triangle, index)) = found {
                return Err(BuildError::IndexOutOfRange { triangle, index, n_points });
            }
        }
        // Then not all was looked at.
        if watch.is_cancelled() {
            return Err(BuildError::Cancelled);
        }
        let unit = 1.0 / power_of_two_below(largest);
        Ok(Self { points, indices, unit, moves: None })
    }

    /// The same, with points that move to as many others.
    pub(super) fn moving(
        self,
        last: &'a [Vec3],
        shares: [f32; 2],
        watch: &Watch,
    ) -> Result<Self, BuildError> {
        let unit = self.unit.min(1.0 / power_of_two_below(reach(last, watch)?));
        if watch.is_cancelled() {
            return Err(BuildError::Cancelled);
        }
        Ok(Self { unit, moves: Some(Moves { last, shares }), ..self })
    }

    /// By how much the triangles of a block move, if they do.
    pub(super) fn shift(&self, block: &Block) -> Option<Shift> {
        let moves = self.moves.as_ref()?;
        Some(block.shift(|id| self.last_corners(moves, id)))
    }

    /// The corners when all of the way is done.
    fn last_corners(&self, moves: &Moves<'_>, triangle: u32) -> [Vec3; 3] {
        self.indices[triangle as usize].map(|i| moves.last[i as usize] * self.unit)
    }

    fn corners(&self, triangle: u32) -> [Vec3; 3] {
        self.indices[triangle as usize].map(|i| self.points[i as usize] * self.unit)
    }

    /// The box of a triangle, wherever it moves to; empty if it never has an area: that of one whose
    /// corners move evenly is a square of the time, which is zero at three times or always.
    fn bounds(&self, triangle: u32) -> Bounds {
        let first = self.corners(triangle);
        let Some(moves) = &self.moves else { return standing_bounds(first) };
        let last = self.last_corners(moves, triangle);
        let [open, close] = moves.shares;
        let at = |share: f32| [0, 1, 2].map(|i| first[i] + (last[i] - first[i]) * share);
        let middle = 0.5 * open + 0.5 * close;
        if [open, middle, close]
            .into_iter()
            .all(|share| standing_bounds(at(share)) == Bounds::EMPTY)
        {
            return Bounds::EMPTY;
        }
        let corners = at(open).into_iter().chain(at(close));
        corners.fold(Bounds::EMPTY, |all, p| all.grow(p.into()))
    }

    /// The triangles that have an area; those that are left when the watch is cancelled have none.
    pub(super) fn prims(&self, watch: &Watch) -> Vec<Prim> {
        let prim = |triangle: usize| {
            let index = narrow(triangle);
            Prim::new(self.bounds(index), index)
        };
        let n = self.indices.len();
        if n <= STRIDE {
            return (0..n).map(prim).filter(Prim::is_real).collect();
        }
        let none = Prim::new(Bounds::EMPTY, 0);
        let one = |triangle: usize| if watch.is_over() { none } else { prim(triangle) };
        let mut prims: Vec<Prim> = Vec::with_capacity(n);
        while prims.len() < n && !watch.is_cancelled() {
            let end = n.min(prims.len() + FEW * STRIDE);
            prims.par_extend((prims.len()..end).into_par_iter().map(one));
        }
        let flat = |n: usize, prims: &[Prim]| n + prims.iter().filter(|p| !p.is_real()).count();
        if fold(&prims, watch, || 0, flat, |a, b| a + b) > 0 {
            prims.retain(Prim::is_real);
        }
        prims
    }
}

impl Timber for Triangles<'_> {
    type Number = f32;
    type Block = Block;
    type Bounds = Bounds;

    const COSTS: Costs = Costs { node: 1.0, block: 0.6, max_leaf: 8 };

    fn leaf<'p>(
        &self,
        prims: impl ExactSizeIterator<Item = &'p Prim>,
        blocks: &mut Vec<Block>,
    ) -> (Child, Bounds) {
        let (first, n) = (blocks.len(), prims.len().div_ceil(LANES));
        let mut bounds = Bounds::EMPTY;
        let mut triangles = prims.map(|p| {
            bounds = bounds.union(p.bounds());
            (p.index(), self.corners(p.index()))
        });
        blocks.extend((0..n).map(|_| Block::of(&mut triangles)));
        (Child::leaf(first, n), bounds)
    }

    fn prefetch(&self, prims: &[Prim]) {
        for p in prims {
            for point in self.indices[p.index() as usize] {
                prefetch_value(&self.points[point as usize]);
            }
        }
    }

    fn node(slots: &[(Child, Bounds)]) -> (Node, Bounds) {
        let bounds = slots.iter().fold(Bounds::EMPTY, |b, slot| b.union(slot.1));
        (Node::of(slots), bounds)
    }
}

/// The box of a triangle, empty if it has no area.
fn standing_bounds([a, b, c]: [Vec3; 3]) -> Bounds {
    let ab = b.as_dvec3() - a.as_dvec3();
    let ac = c.as_dvec3() - a.as_dvec3();
    if ab.cross(ac) == DVec3::ZERO {
        return Bounds::EMPTY;
    }
    [a, b, c].into_iter().fold(Bounds::EMPTY, |all, p| all.grow(p.into()))
}

/// The largest |coordinate| of points.
///
/// # Errors
/// The first point that is not finite.
fn reach(points: &[Vec3], watch: &Watch) -> Result<f32, BuildError> {
    let reach = |(finite, all): (bool, Vec3A), points: &[Vec3]| {
        points.iter().fold((finite, all), |(finite, all), p| {
            let p = Vec3A::from(*p).abs();
            (finite & p.is_finite(), all.max(p))
        })
    };
    let both = |a: (bool, Vec3A), b: (bool, Vec3A)| (a.0 & b.0, a.1.max(b.1));
    let (finite, largest) = fold(points, watch, || (true, Vec3A::ZERO), reach, both);
    if finite {
        return Ok(largest.max_element());
    }
    let point = points.iter().position(|p| !p.is_finite());
    let point = point.expect("one was found not to be finite");
    Err(BuildError::NonFinitePoint { point })
}

/// The power of two at or below `x`, within 2^±100; 1 for zero.
fn power_of_two_below(x: f32) -> f32 {
    let power = f32::from_bits(x.to_bits() & 0x7f80_0000);
    if x > 0.0 { power.clamp(f32::from_bits(27 << 23), f32::from_bits(227 << 23)) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(limits: (usize, usize), points: &[Vec3], n: usize) -> Option<BuildError> {
        let limits = Limits { triangles: limits.0, points: limits.1 };
        Triangles::within(limits, points, &vec![[0, 1, 9]; n], &Watch::default()).err()
    }

    #[test]
    fn one_triangle_or_point_more_than_the_limit_is_told_before_any_is_looked_at() {
        // Neither the index past the points nor the point that is no number is reached.
        let points = [Vec3::ZERO, Vec3::X, Vec3::NAN];
        let many = told((3, 3), &points, 4);
        assert_eq!(many, Some(BuildError::TooManyTriangles { n_triangles: 4, limit: 3 }));
        assert_eq!(many.unwrap().to_string(), "4 triangles in one mesh, the limit is 3");
        let many = told((3, 2), &points, 3);
        assert_eq!(many, Some(BuildError::TooManyPoints { n_points: 3, limit: 2 }));
        assert_eq!(many.unwrap().to_string(), "3 points in one mesh, the limit is 2");
        assert_eq!(told((3, 3), &points, 3), Some(BuildError::NonFinitePoint { point: 2 }));
    }

    #[test]
    fn as_many_triangles_as_the_limit_are_taken() {
        let (points, watch) = ([Vec3::ZERO, Vec3::X, Vec3::Y], Watch::default());
        let limits = Limits { triangles: 3, points: 3 };
        let triangles = Triangles::within(limits, &points, &[[0, 1, 2]; 3], &watch).unwrap();
        assert_eq!(triangles.prims(&watch).len(), 3);
    }
}
