//! Two distances blended into one.

use glam::DVec3;
use luxel_sdk::kind::{Shape, ShapeRef};
use luxel_sdk::num::{Bounds3, Ray};

use super::super::implicit::{Field, Look, Way, bend, box_distance, differences};
use super::Op;

/// The distance of a solid whose parts flow into each other.
///
/// The smooth minimum of a and b is min(a, b) − h² k / 4 with h = max(0, 1 − |a − b| / k). Where
/// a < b and h > 0, its derivatives are 1 − h / 2 by a and h / 2 by b, and the other way round: never
/// negative, together 1. So its gradient is a mean of those of a and b, and where these change by no
/// more than the way, so does it. It is less than the minimum by k / 4 at most. The smooth maximum
/// is −smin(−a, −b), and cutting b away is the maximum of a and −b.
///
/// Where either part is as far as k, the other one alone is the surface: with a > 0 and b ≥ k,
/// smin(a, b) ≥ smin(0⁺, k) > 0, and it vanishes with a. So a line is followed from crossing to
/// crossing of the parts themselves, however near to them it runs, and marches by |f| only where both
/// are nearer than k and neither is negative.
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
fn checked(part: &(ShapeRef<'_>, Bounds3), p: DVec3) -> f64 {
    distance_of(part, p).expect("only parts that know their distance are blended")
}

/// What is known of both parts along a line.
#[derive(Default)]
pub(super) struct Known {
    /// Where each is crossed next.
    crossings: [Option<f64>; 2],
}

impl Blend<'_> {
    /// The signs with which the parts go into the smooth minimum: what is below in it is inside of a
    /// union and outside of the other two.
    fn signs(&self) -> [f64; 2] {
        match self.op {
            Op::Union => [1.0, 1.0],
            Op::Intersection => [-1.0, -1.0],
            Op::Difference => [-1.0, 1.0],
        }
    }

    fn joined(&self, [a, b]: [f64; 2]) -> f64 {
        smooth_min(a, b, self.k).0
    }

    fn part(&self, i: usize) -> &(ShapeRef<'_>, Bounds3) {
        if i == 0 { &self.a } else { &self.b }
    }

    /// For how many metres ahead a part, `apart` metres away now, is farther than k: by its distance,
    /// or as long as the line is not in its grown box.
    fn beyond(&self, i: usize, apart: f64, way: &Way, s: f64) -> f64 {
        let room = apart - self.k - way.error;
        if self.signs()[i] < 0.0 {
            return room;
        }
        let bounds = &self.part(i).1;
        let grown = DVec3::splat(self.k + way.error);
        let zone = Bounds3 { min: bounds.min - grown, max: bounds.max + grown };
        let enter = zone.intersect_ray(way.at(s), way.d.recip(), f64::INFINITY);
        enter.map_or(f64::INFINITY, |(enter, _)| room.max(enter - way.error))
    }

    /// Where a part is crossed next; `None` if that is nearer than its distance says that it can be.
    fn crossing(
        &self,
        (i, apart): (usize, f64),
        way: &Way,
        s: f64,
        known: &mut Known,
    ) -> Option<f64> {
        let t = known.crossings[i].filter(|t| *t > s).unwrap_or_else(|| {
            let hit = self.part(i).0.intersect(&Ray::new(way.at(s), way.d));
            hit.map_or(f64::INFINITY, |hit| s + hit.t)
        });
        known.crossings[i] = Some(t);
        (t - s >= apart.abs() - 2.0 * way.error).then_some(t)
    }

    /// For how many metres the smooth minimum keeps its sign, and whether it is known to vanish then:
    /// of what both parts say, of which the lesser one is `near`. `None` if nothing is known but f.
    fn ahead(&self, apart: [f64; 2], way: &Way, s: f64, known: &mut Known) -> Option<(f64, bool)> {
        let near = usize::from(apart[1] < apart[0]);
        let far = 1 - near;
        // Only a part whose side is told for certain is crossed where it says.
        if !(apart[near].abs() > way.error) {
            return None;
        }
        if apart[near] > 0.0 {
            let (f, room) = (self.joined(apart), self.beyond(far, apart[far], way, s));
            if f <= 0.0 || room <= f {
                return None;
            }
            let t = self.crossing((near, apart[near]), way, s, known)?;
            let met = t.is_finite() && t - s <= room;
            return Some(if met { (t - s, true) } else { (room, false) });
        }
        // Below in one is below in both.
        let t = self.crossing((near, apart[near]), way, s, known).filter(|t| t.is_finite())?;
        let other = self.signs()[far] * checked(self.part(far), way.at(t));
        Some((t - s, other >= self.k))
    }
}

impl Field for Blend<'_> {
    type Known = Known;

    fn value(&self, p: DVec3) -> f64 {
        self.of(checked(&self.a, p), checked(&self.b, p))
    }

    fn look(&self, way: &Way, s: f64, known: &mut Known) -> Look {
        let p = way.at(s);
        let (a, b) = (checked(&self.a, p), checked(&self.b, p));
        let value = self.of(a, b);
        let [of_a, of_b] = self.signs();
        let (free, met) =
            self.ahead([of_a * a, of_b * b], way, s, known).unwrap_or((value.abs(), false));
        Look { value, free, met }
    }

    /// Of each part by itself: differences do not see across the edge between them.
    fn gradient(&self, p: DVec3, step: f64) -> DVec3 {
        let (of_a, of_b) = self.weights(checked(&self.a, p), checked(&self.b, p));
        let part = |weight: f64, part| {
            if weight.abs() > 0.0 {
                differences(|q| checked(part, q), p, step) * weight
            } else {
                DVec3::ZERO
            }
        };
        part(of_a, &self.a) + part(of_b, &self.b)
    }

    /// By the chain rule: in the blend the weights turn by 1 / 2k of the difference of both.
    fn bend(&self, p: DVec3, d: DVec3, size: f64, error: f64) -> Option<DVec3> {
        let (a, b) = (checked(&self.a, p), checked(&self.b, p));
        let (of_a, of_b) = self.weights(a, b);
        let part = |weight: f64, part| {
            if weight.abs() > 0.0 {
                Some(bend(|q| checked(part, q), p, d, (size, error))? * weight)
            } else {
                Some(DVec3::ZERO)
            }
        };
        let own = part(of_a, &self.a)? + part(of_b, &self.b)?;
        let [sign_a, sign_b] = self.signs();
        if !((sign_a * a - sign_b * b).abs() < self.k) {
            return Some(own);
        }
        let step = size * (error / size).cbrt();
        let slope = |part| differences(|q| checked(part, q), p, step);
        let apart = slope(&self.a) * sign_a - slope(&self.b) * sign_b;
        let side = if self.op == Op::Union { 1.0 } else { -1.0 };
        Some(own - apart * (side * apart.dot(d) / (2.0 * self.k)))
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
