//! Cutting primitives from the top, by binned surface area, until obvhs can cluster each part.
//!
//! Parts bound the memory and the depth of a build, give rayon its tasks, and are small enough that
//! clustering stays in cache. Source: Wald 2007, "On fast Construction of SAH-based BVHs".

use glam::Vec3;
use obvhs::Boundable;
use obvhs::aabb::Aabb;

use super::node::Bounds;

/// Primitives that one clustering takes; larger parts are cut, and cut in parallel.
///
/// Fans and nested shapes cluster one pair at a time, in PART² time per part. On 200 000 triangles
/// of that kind 8192 took 3.6 s and 2048 1.0 s; on ordinary meshes both build and trace alike.
pub(super) const PART: usize = 2048;

/// Cuts by area this deep, then by count, which bounds the depth at 12 + log₂ n.
const AREA_DEPTH: usize = 12;

const BINS: usize = 16;

/// A primitive as a builder sees it; coordinates are finite and at most 2 in size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prim {
    pub(super) bounds: Bounds,
    pub(super) index: u32,
}

impl Prim {
    /// Twice the centre of the box.
    fn centre(&self) -> Vec3 {
        self.bounds.min + self.bounds.max
    }
}

impl Boundable for Prim {
    fn aabb(&self) -> Aabb {
        Aabb::new(self.bounds.min.into(), self.bounds.max.into())
    }
}

/// The upper tree; parts lie in the array in the order in which they are met here.
pub(super) enum Part {
    /// So many primitives.
    Leaf(usize),
    Split(Box<[Part; 2]>),
}

impl Part {
    /// Reorders the primitives so that each part is contiguous.
    pub(super) fn cut(prims: &mut [Prim]) -> Self {
        Self::cut_at(prims, 0)
    }

    fn cut_at(prims: &mut [Prim], depth: usize) -> Self {
        if prims.len() <= PART {
            return Self::Leaf(prims.len());
        }
        let (left, right) = halve(prims, depth);
        let (left, right) =
            rayon::join(|| Self::cut_at(left, depth + 1), || Self::cut_at(right, depth + 1));
        Self::Split(Box::new([left, right]))
    }

    /// The sizes of the parts, in order.
    pub(super) fn sizes(&self) -> Vec<usize> {
        match self {
            Self::Leaf(n) => vec![*n],
            Self::Split(halves) => halves.iter().flat_map(Self::sizes).collect(),
        }
    }
}

/// Reorders at least two primitives into two halves, neither empty.
pub(super) fn halve(prims: &mut [Prim], depth: usize) -> (&mut [Prim], &mut [Prim]) {
    let centres = prims.iter().fold(Bounds::EMPTY, |b, p| b.grow(p.centre()));
    let extent = centres.max - centres.min;
    let axis = extent.max_position();
    let scale = BINS as f32 / extent[axis];
    let bin = Binning { axis, origin: centres.min[axis], scale };
    // Without an extent, or with one that vanishes in the scale, no plane separates anything.
    let cut = if extent[axis] > 0.0 && scale.is_finite() && depth < AREA_DEPTH {
        bin.cheapest(prims).map(|plane| bin.sort(prims, plane))
    } else {
        None
    };
    let middle = match cut {
        Some(middle) if (1..prims.len()).contains(&middle) => middle,
        _ => {
            let middle = prims.len() / 2;
            prims.select_nth_unstable_by(middle, |a, b| {
                let key = |p: &Prim| p.centre()[axis];
                key(a).total_cmp(&key(b)).then(a.index.cmp(&b.index))
            });
            middle
        }
    };
    prims.split_at_mut(middle)
}

struct Binning {
    axis: usize,
    origin: f32,
    scale: f32,
}

impl Binning {
    fn of(&self, p: &Prim) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the bin below; the cast saturates at both ends"
        )]
        let bin = ((p.centre()[self.axis] - self.origin) * self.scale) as usize;
        bin.min(BINS - 1)
    }

    /// The first bin of the right half where count × area is least.
    fn cheapest(&self, prims: &[Prim]) -> Option<usize> {
        let mut bins = [(0usize, Bounds::EMPTY); BINS];
        for p in prims {
            let bin = &mut bins[self.of(p)];
            *bin = (bin.0 + 1, bin.1.union(p.bounds));
        }
        let cost = |(n, bounds): (usize, Bounds)| n as f32 * bounds.half_area();
        let join = |a: (usize, Bounds), b: (usize, Bounds)| (a.0 + b.0, a.1.union(b.1));
        let mut right = [0.0; BINS];
        let mut sum = (0, Bounds::EMPTY);
        for i in (1..BINS).rev() {
            sum = join(sum, bins[i]);
            right[i] = cost(sum);
        }
        let mut best = None;
        let mut least = f32::INFINITY;
        let mut sum = (0, Bounds::EMPTY);
        for i in 1..BINS {
            sum = join(sum, bins[i - 1]);
            let total = cost(sum) + right[i];
            if sum.0 > 0 && sum.0 < prims.len() && total < least {
                (best, least) = (Some(i), total);
            }
        }
        best
    }

    /// Moves what lies before the plane to the front; returns how many that are.
    fn sort(&self, prims: &mut [Prim], plane: usize) -> usize {
        let (mut first, mut end) = (0, prims.len());
        while first < end {
            if self.of(&prims[first]) < plane {
                first += 1;
            } else {
                end -= 1;
                prims.swap(first, end);
            }
        }
        first
    }
}
