//! Cutting primitives from the top, by binned surface area, until obvhs can cluster each part.
//!
//! Parts bound the memory and the depth of a build, give rayon its tasks, and are small enough that
//! clustering stays in cache. Source: Wald 2007, "On fast Construction of SAH-based BVHs".

use glam::{Vec3A, Vec4};
use obvhs::Boundable;
use obvhs::aabb::Aabb;

use super::node::Bounds;
use super::passes::{fold, median, partition};
use super::watch::Watch;

/// Primitives that one clustering takes; larger parts are cut, and cut in parallel.
///
/// Fans and nested shapes cluster one pair at a time, in PART² time per part. On 200 000 triangles
/// of that kind 8192 took 3.6 s and 2048 1.0 s; on ordinary meshes both build and trace alike.
pub(super) const PART: usize = 2048;

/// Cuts by area this deep, then by count, which bounds the depth at 12 + log₂ n.
const AREA_DEPTH: usize = 12;

/// A power of two.
const BINS: usize = 16;

/// The last bin.
const LAST: f32 = 15.0;

/// A primitive as a builder sees it; coordinates are finite and at most 2 in size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Prim {
    /// The least corner, and the number in the bits of a float that is neither subnormal nor NaN.
    low: Vec4,
    high: Vec4,
}

/// Beside a number below 2²⁹ it makes a normal float.
const NORMAL: u32 = 1 << 30;

impl Prim {
    /// A primitive and its number, below 2²⁹.
    pub(super) fn new(bounds: Bounds, index: u32) -> Self {
        let low = bounds.min.extend(f32::from_bits(NORMAL | index));
        Self { low, high: bounds.max.extend(1.0) }
    }

    pub(super) fn index(&self) -> u32 {
        self.low.w.to_bits() & !NORMAL
    }

    pub(super) fn bounds(&self) -> Bounds {
        Bounds { min: Vec3A::from_vec4(self.low), max: Vec3A::from_vec4(self.high) }
    }

    /// Whether its box holds anything.
    pub(super) fn is_real(&self) -> bool {
        self.low.x <= self.high.x
    }

    /// Twice the centre of the box.
    pub(super) fn centre(&self) -> Vec3A {
        Vec3A::from_vec4(self.low + self.high)
    }

    /// The same along one axis.
    pub(super) fn centre_along(&self, axis: usize) -> f32 {
        self.low.as_ref()[axis & 3] + self.high.as_ref()[axis & 3]
    }
}

impl Boundable for Prim {
    fn aabb(&self) -> Aabb {
        let Bounds { min, max } = self.bounds();
        Aabb::new(min, max)
    }
}

/// The upper tree; parts lie in the array in the order in which they are met here.
pub(super) enum Part {
    /// So many primitives.
    Leaf(usize),
    Split(Box<[Part; 2]>),
}

impl Part {
    /// Reorders the primitives so that each part is contiguous. Parts are of any size once the watch
    /// is cancelled.
    pub(super) fn cut(prims: &mut [Prim], watch: &Watch) -> Self {
        let centres = if prims.len() > PART { centres(prims, watch) } else { Bounds::EMPTY };
        Self::cut_at(prims, centres, 0, watch)
    }

    fn cut_at(prims: &mut [Prim], centres: Bounds, depth: usize, watch: &Watch) -> Self {
        if prims.len() <= PART || watch.is_cancelled() {
            return Self::Leaf(prims.len());
        }
        let (middle, sides) = halve(prims, centres, depth, watch);
        let (left, right) = prims.split_at_mut(middle);
        let (left, right) = rayon::join(
            || Self::cut_at(left, sides[0], depth + 1, watch),
            || Self::cut_at(right, sides[1], depth + 1, watch),
        );
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

/// The box around all centres.
pub(super) fn centres(prims: &[Prim], watch: &Watch) -> Bounds {
    let grow = |all: Bounds, prims: &[Prim]| prims.iter().fold(all, |b, p| b.grow(p.centre()));
    fold(prims, watch, || Bounds::EMPTY, grow, Bounds::union)
}

/// Reorders at least two primitives, given the box around their centres, into two halves, neither
/// empty. How many the first has, and the centres' boxes of both.
pub(super) fn halve(
    prims: &mut [Prim],
    centres: Bounds,
    depth: usize,
    watch: &Watch,
) -> (usize, [Bounds; 2]) {
    let extent = centres.max - centres.min;
    let axis = extent.max_position();
    let scale = BINS as f32 / extent[axis];
    let binning = Binning { axis, origin: centres.min[axis], scale };
    // Without an extent, or with one that vanishes in the scale, no plane separates anything.
    if extent[axis] > 0.0 && scale.is_finite() && depth < AREA_DEPTH {
        let bins = binning.fill(prims, watch);
        if let Some(plane) = cheapest(&bins) {
            let middle = partition(prims, watch, |p| binning.of(p) < plane);
            if (1..prims.len()).contains(&middle) {
                let around = |bins: &[Bin]| {
                    bins.iter().fold(Bounds::EMPTY, |all, bin| all.union(bin.centres))
                };
                return (middle, [around(&bins[..plane]), around(&bins[plane..])]);
            }
        }
    }
    let middle = median(prims, axis, watch);
    let (left, right) = prims.split_at(middle);
    (middle, [self::centres(left, watch), self::centres(right, watch)])
}

/// Primitives whose centres lie between two planes.
#[derive(Clone, Copy)]
struct Bin {
    n: usize,
    bounds: Bounds,
    centres: Bounds,
}

impl Bin {
    const EMPTY: Self = Self { n: 0, bounds: Bounds::EMPTY, centres: Bounds::EMPTY };

    fn join(self, other: Self) -> Self {
        Self {
            n: self.n + other.n,
            bounds: self.bounds.union(other.bounds),
            centres: self.centres.union(other.centres),
        }
    }

    fn cost(&self) -> f32 {
        self.n as f32 * self.bounds.half_area()
    }
}

type Bins = [Bin; BINS];

struct Binning {
    axis: usize,
    origin: f32,
    scale: f32,
}

impl Binning {
    fn of(&self, p: &Prim) -> usize {
        let at = (p.centre_along(self.axis) - self.origin) * self.scale - 0.5;
        let at = if at > 0.0 { at } else { 0.0 };
        let at = if at < LAST { at } else { LAST };
        // Rounds to an integer, which then stands in the last bits: a cast would cost more.
        (at + 8_388_608.0).to_bits() as usize % BINS
    }

    fn fill(&self, prims: &[Prim], watch: &Watch) -> Bins {
        let join = |a: Bins, b: Bins| std::array::from_fn(|i| a[i].join(b[i]));
        let put = |bins: Bins, prims: &[Prim]| {
            // Neighbours often share a bin; with four sets none waits for another.
            let mut sides = [bins, [Bin::EMPTY; BINS], [Bin::EMPTY; BINS], [Bin::EMPTY; BINS]];
            for pair in prims.chunks(4) {
                for (p, bins) in pair.iter().zip(&mut sides) {
                    let bin = &mut bins[self.of(p)];
                    bin.n += 1;
                    bin.bounds = bin.bounds.union(p.bounds());
                    bin.centres = bin.centres.grow(p.centre());
                }
            }
            let [a, b, c, d] = sides;
            join(join(a, b), join(c, d))
        };
        fold(prims, watch, || [Bin::EMPTY; BINS], put, join)
    }
}

/// The first bin of the right half where count × area is least.
fn cheapest(bins: &Bins) -> Option<usize> {
    let mut right = [0.0; BINS];
    let mut sum = Bin::EMPTY;
    for i in (1..BINS).rev() {
        sum = sum.join(bins[i]);
        right[i] = sum.cost();
    }
    let all = sum.join(bins[0]).n;
    let mut best = None;
    let mut least = f32::INFINITY;
    let mut sum = Bin::EMPTY;
    for i in 1..BINS {
        sum = sum.join(bins[i - 1]);
        let total = sum.cost() + right[i];
        if sum.n > 0 && sum.n < all && total < least {
            (best, least) = (Some(i), total);
        }
    }
    best
}
