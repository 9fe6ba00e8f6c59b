//! Two distances blended into one.

use glam::DVec3;
use luxel_sdk::kind::{Shape, ShapeRef};
use luxel_sdk::num::Bounds3;

use super::super::implicit::{Field, box_distance, differences};
use super::Op;

/// The distance of a solid whose parts flow into each other.
///
/// The smooth minimum of a and b is min(a, b) − h² k / 4 with h = max(0, 1 − |a − b| / k). Where
/// a < b and h > 0, its derivatives are 1 − h / 2 by a and h / 2 by b, and the other way round: never
/// negative, together 1. So its gradient is a mean of those of a and b, and where these change by no
/// more than the way, so does it. It is less than the minimum by k / 4 at most. The smooth maximum
/// is −smin(−a, −b), and cutting b away is the maximum of a and −b.
///
/// # Source
/// Quilez, "Smooth minimum", the quadratic one.
pub(super) struct Blend<'s> {
    op: Op,
    a: (ShapeRef<'s>, Bounds3),
    b: (ShapeRef<'s>, Bounds3),
    k: f64,
}

impl<'s> Blend<'s> {
    pub(super) fn new(op: Op, a: ShapeRef<'s>, b: ShapeRef<'s>, k: f64) -> Self {
        Self { op, a: (a, a.bounds()), b: (b, b.bounds()), k }
    }

    /// Of the distances of both.
    pub(super) fn of(&self, a: f64, b: f64) -> f64 {
        match self.op {
            Op::Union => smooth_min(a, b, self.k).0,
            Op::Intersection => -smooth_min(-a, -b, self.k).0,
            Op::Difference => -smooth_min(-a, b, self.k).0,
        }
    }

    /// The distance, if both parts know theirs.
    pub(super) fn distance(&self, p: DVec3) -> Option<f64> {
        Some(self.of(distance_of(&self.a, p)?, distance_of(&self.b, p)?))
    }

    /// Its derivatives by both.
    fn weights(&self, a: f64, b: f64) -> (f64, f64) {
        match self.op {
            Op::Union => smooth_min(a, b, self.k).1,
            Op::Intersection => smooth_min(-a, -b, self.k).1,
            Op::Difference => {
                let (of_a, of_b) = smooth_min(-a, b, self.k).1;
                (of_a, -of_b)
            }
        }
    }
}

/// A part's own distance may be far less than the true one; its box says how far away it is at
/// least, which bounds how far the blend can swell.
fn distance_of((part, bounds): &(ShapeRef<'_>, Bounds3), p: DVec3) -> Option<f64> {
    Some(part.distance(p)?.max(box_distance(bounds, p)))
}

/// The same of a part that has been checked to know it.
fn known(part: &(ShapeRef<'_>, Bounds3), p: DVec3) -> f64 {
    distance_of(part, p).expect("only parts that know their distance are blended")
}

impl Field for Blend<'_> {
    fn value(&self, p: DVec3) -> f64 {
        self.of(known(&self.a, p), known(&self.b, p))
    }

    /// Of each part by itself: differences do not see across the edge between them.
    fn gradient(&self, p: DVec3, step: f64) -> DVec3 {
        let (of_a, of_b) = self.weights(known(&self.a, p), known(&self.b, p));
        let part = |weight: f64, part| {
            if weight.abs() > 0.0 {
                differences(|q| known(part, q), p, step) * weight
            } else {
                DVec3::ZERO
            }
        };
        part(of_a, &self.a) + part(of_b, &self.b)
    }
}

/// The smooth minimum, and its derivatives by both.
fn smooth_min(a: f64, b: f64, k: f64) -> (f64, (f64, f64)) {
    let least = a.min(b);
    let h = if k > 0.0 { (1.0 - (a - b).abs() / k).max(0.0) } else { 0.0 };
    let weights = if a <= b { (1.0 - 0.5 * h, 0.5 * h) } else { (0.5 * h, 1.0 - 0.5 * h) };
    (least - 0.25 * h * h * k, weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use luxel_sdk::sampling::Rng;

    #[test]
    fn the_blend_changes_by_no_more_than_its_parts_together() {
        let mut rng = Rng::new(5);
        for _ in 0..100_000 {
            let mut any = || 4.0 * rng.f64() - 2.0;
            let (a, b, k) = (any(), any(), any().abs());
            let (da, db) = (0.1 * any(), 0.1 * any());
            let change = smooth_min(a + da, b + db, k).0 - smooth_min(a, b, k).0;
            assert!(change.abs() <= da.abs().max(db.abs()) + 8.0 * f64::EPSILON);
            let below = a.min(b) - smooth_min(a, b, k).0;
            assert!((0.0..=0.25 * k).contains(&below));
            assert!((smooth_min(a, b, k).0 - smooth_min(b, a, k).0).abs() <= 0.0);
        }
    }
}
