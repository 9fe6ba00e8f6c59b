//! Cubics in Bernstein form.
//!
//! PBR4 §6.7; Farin, *Curves and Surfaces for CAGD*, ch. 4 and 5: values by de Casteljau's averages,
//! which never leave the hull of the control points and so round relative to it alone.

use std::ops::{Add, Mul, Sub};

use glam::{DVec3, DVec4};

use crate::shape::root::rising_root;

/// What can be averaged.
pub(super) trait Vector:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
}
impl Vector for DVec3 {}
impl Vector for DVec4 {}

/// Four control points.
pub(super) type Cubic<V> = [V; 4];

/// Between two points; exactly either at the ends.
fn mix<V: Vector>(a: V, b: V, s: f64) -> V {
    a * (1.0 - s) + b * s
}

/// Value, first and second derivative at `s`; exactly the end points at 0 and 1.
pub(super) fn eval<V: Vector>([a, b, c, d]: &Cubic<V>, s: f64) -> (V, V, V) {
    let (ab, bc, cd) = (mix(*a, *b, s), mix(*b, *c, s), mix(*c, *d, s));
    let (low, high) = (mix(ab, bc, s), mix(bc, cd, s));
    (mix(low, high, s), (high - low) * 3.0, (cd - bc - (bc - ab)) * 6.0)
}

/// Both halves.
pub(super) fn halves<V: Vector>([a, b, c, d]: &Cubic<V>) -> (Cubic<V>, Cubic<V>) {
    let half = |a: V, b: V| (a + b) * 0.5;
    let (ab, bc, cd) = (half(*a, *b), half(*b, *c), half(*c, *d));
    let (low, high) = (half(ab, bc), half(bc, cd));
    let middle = half(low, high);
    ([*a, ab, low, middle], [middle, high, cd, *d])
}

/// The segments of a strand: Bézier points as they are, B-splines converted. Neighbours share their
/// end exactly, and what is equal stays equal.
///
/// # Source
/// Böhm 1980, "Inserting new knots into B-spline curves": J = (P₋ + 4P + P₊) / 6, and thirds between.
pub(super) fn segments<V: Vector>(points: &[V], is_bspline: bool) -> Vec<Cubic<V>> {
    if !is_bspline {
        let starts = (0..points.len().saturating_sub(3)).step_by(3);
        return starts.map(|i| [points[i], points[i + 1], points[i + 2], points[i + 3]]).collect();
    }
    let joint = |i: usize| {
        let p = points[i];
        p + ((points[i - 1] - p) + (points[i + 1] - p)) * (1.0 / 6.0)
    };
    let inner = |i: usize, j: usize| points[i] + (points[j] - points[i]) * (1.0 / 3.0);
    let starts = 1..points.len().saturating_sub(2);
    starts.map(|i| [joint(i), inner(i, i + 1), inner(i + 1, i), joint(i + 1)]).collect()
}

/// A range of numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub(super) low: f64,
    pub(super) high: f64,
}

impl Range {
    pub(super) fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    pub(super) fn times(self, other: Self) -> Self {
        let all = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        let low = all[0].min(all[1]).min(all[2].min(all[3]));
        Self { low, high: all[0].max(all[1]).max(all[2].max(all[3])) }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }

    pub(super) fn minus(self, other: Self) -> Self {
        Self { low: self.low - other.high, high: self.high - other.low }
    }

    pub(super) fn square(self) -> Self {
        let least = if self.has_zero() { 0.0 } else { self.low.abs().min(self.high.abs()) };
        let most = self.low.abs().max(self.high.abs());
        Self { low: least * least, high: most * most }
    }

    pub(super) fn has_zero(self) -> bool {
        self.low <= 0.0 && self.high >= 0.0
    }
}

/// The root of a function that is positive before it and negative after it, between `low` and
/// `high`. `f` gives value and slope.
pub(super) fn falling_root(low: f64, high: f64, mut f: impl FnMut(f64) -> (f64, f64)) -> f64 {
    rising_root((low, high), 0.5 * (low + high), |s, _| {
        let (value, slope) = f(s);
        Some((-value, -slope))
    })
}
