//! Axis-aligned boxes in f64, never too small.

use glam::{DAffine3, DVec3};

use super::error::gamma64;

/// An axis-aligned box: all points between `min` and `max`, faces included, metres.
///
/// Empty when any `min` exceeds its `max`. Infinite faces are legal (an unbounded shape).
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Bounds3 {
    /// Lower corner.
    pub min: DVec3,
    /// Upper corner.
    pub max: DVec3,
}

impl Bounds3 {
    /// The box of nothing; the neutral element of [`Bounds3::union`].
    pub const EMPTY: Self =
        Self { min: DVec3::splat(f64::INFINITY), max: DVec3::splat(f64::NEG_INFINITY) };

    /// The box of everything.
    pub const ALL: Self =
        Self { min: DVec3::splat(f64::NEG_INFINITY), max: DVec3::splat(f64::INFINITY) };

    /// The smallest box around `points`; empty for none. NaN coordinates are passed over.
    pub fn of_points(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| b.union(Self { min: p, max: p }))
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self { min: map2(self.min, other.min, f64::min), max: map2(self.max, other.max, f64::max) }
    }

    /// Whether the box holds no point; so does a box with a NaN face.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The middle; meaningless for an empty or infinite box. Does not overflow.
    pub fn centre(&self) -> DVec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// From the lower to the upper corner, metres.
    pub fn diagonal(&self) -> DVec3 {
        self.max - self.min
    }

    /// Surface area, m²; 0 for an empty box.
    pub fn area(&self) -> f64 {
        if self.is_empty() {
            return 0.0;
        }
        let e = self.diagonal();
        2.0 * (e.x * e.y + e.y * e.z + e.z * e.x)
    }

    /// Whether `p` lies inside or on a face.
    pub fn contains(&self, p: DVec3) -> bool {
        self.min.cmple(p).all() && p.cmple(self.max).all()
    }

    /// A box around the image of every point of this one, rounded outwards.
    ///
    /// Empty stays empty; an infinite extent makes the axes that it reaches infinite.
    #[must_use]
    pub fn transform(&self, m: &DAffine3) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let rows = m.matrix3.transpose();
        let (x0, x1) = self.image(rows.x_axis, m.translation.x);
        let (y0, y1) = self.image(rows.y_axis, m.translation.y);
        let (z0, z1) = self.image(rows.z_axis, m.translation.z);
        Self { min: DVec3::new(x0, y0, z0), max: DVec3::new(x1, y1, z1) }
    }

    /// The range of `row`·p + `shift` over the box, which is that over its eight corners.
    fn image(&self, row: DVec3, shift: f64) -> (f64, f64) {
        let a = map2(row, self.min, product);
        let b = map2(row, self.max, product);
        let (low, high) = (map2(a, b, f64::min), map2(a, b, f64::max));
        // One product and three sums; the second γ covers the rounding of the bound itself.
        let size = map2(a.abs(), b.abs(), f64::max).element_sum() + shift.abs();
        let err = gamma64(8) * size;
        if !err.is_finite() {
            return (f64::NEG_INFINITY, f64::INFINITY);
        }
        if err == 0.0 && size == 0.0 {
            return (0.0, 0.0);
        }
        let low = (low.element_sum() + shift - err).next_down();
        (low, (high.element_sum() + shift + err).next_up())
    }

    /// Parameters between which the ray `o` + t / `inv_d`, 0 ≤ t ≤ `t_max`, is inside the box.
    ///
    /// `inv_d` is 1/d componentwise, with ±infinity for ±0. Never misses a box that the exact ray
    /// touches, a ray within a face included. `None` if it misses, if the box is empty, or if the
    /// ray holds a NaN.
    ///
    /// # Source
    /// PBR4 §6.1.2 and §6.8.2; Ize 2013, "Robust BVH Ray Traversal": the far distance grows by
    /// 1 + 2γ(3), and no fused multiply-add.
    pub fn intersect_ray(&self, o: DVec3, inv_d: DVec3, t_max: f64) -> Option<(f64, f64)> {
        let (mut near, mut far) = (0.0f64, t_max);
        for axis in 0..3 {
            let (origin, inv) = (o[axis], inv_d[axis]);
            let (enter, leave) = if inv.is_sign_negative() {
                (self.max[axis], self.min[axis])
            } else {
                (self.min[axis], self.max[axis])
            };
            let t0 = (enter - origin) * inv;
            let t1 = (leave - origin) * inv * (1.0 + 2.0 * gamma64(3));
            if t0.is_nan() || t1.is_nan() {
                // 0 · ∞: the ray runs within a face, and this axis does not bound it.
                let within = inv.is_infinite() && self.min[axis] <= origin;
                if within && origin <= self.max[axis] {
                    continue;
                }
                return None;
            }
            near = near.max(t0);
            far = far.min(t1);
        }
        (near <= far && near < f64::INFINITY).then_some((near, far))
    }
}

fn map2(a: DVec3, b: DVec3, f: impl Fn(f64, f64) -> f64) -> DVec3 {
    DVec3::new(f(a.x, b.x), f(a.y, b.y), f(a.z, b.z))
}

/// a · b, where nothing of an infinite extent is nothing.
fn product(a: f64, b: f64) -> f64 {
    if a == 0.0 { 0.0 } else { a * b }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::points::Points;

    const UNIT: Bounds3 = Bounds3 { min: DVec3::ZERO, max: DVec3::ONE };

    fn hit(b: &Bounds3, o: DVec3, d: DVec3) -> Option<(f64, f64)> {
        b.intersect_ray(o, d.recip(), f64::INFINITY)
    }

    #[test]
    fn union_of_points_holds_them_and_nothing_more() {
        let points = [DVec3::new(1.0, -2.0, 3.0), DVec3::new(-1.0, 5.0, 0.0)];
        let b = Bounds3::of_points(points);
        assert_eq!((b.min, b.max), (DVec3::new(-1.0, -2.0, 0.0), DVec3::new(1.0, 5.0, 3.0)));
        assert_eq!(b.union(Bounds3::EMPTY), b);
        assert_eq!(
            (b.centre(), b.diagonal()),
            (DVec3::new(0.0, 1.5, 1.5), DVec3::new(2.0, 7.0, 3.0))
        );
        assert!(!b.is_empty() && Bounds3::of_points([]).is_empty());
        assert!(Bounds3::of_points([DVec3::NAN]).is_empty());
    }

    #[test]
    fn transformed_box_holds_every_transformed_point() {
        let mut rng = Points::new(5);
        for _ in 0..1000 {
            let axis = rng.unit();
            let m = DAffine3::from_axis_angle(axis, rng.f64() * 7.0)
                * DAffine3::from_scale_rotation_translation(
                    DVec3::new(1e-3, 1.0, -1e3),
                    glam::DQuat::IDENTITY,
                    DVec3::splat(1e7 * rng.f64()),
                );
            let b = UNIT.transform(&m);
            for i in 0..8u8 {
                let bit = |k: u8| f64::from((i >> k) & 1);
                assert!(b.contains(m.transform_point3(DVec3::new(bit(0), bit(1), bit(2)))));
            }
        }
    }

    #[test]
    fn transform_keeps_empty_and_infinite_boxes() {
        let m = DAffine3::from_rotation_z(0.5);
        assert!(Bounds3::EMPTY.transform(&m).is_empty());
        let all = Bounds3::ALL.transform(&m);
        assert!(all.contains(DVec3::splat(1e300)) && all.contains(DVec3::splat(-1e300)));
        let slab = Bounds3 { min: DVec3::new(-1.0, f64::NEG_INFINITY, 0.0), max: DVec3::ONE };
        let b = slab.transform(&DAffine3::IDENTITY);
        assert!(b.min.x <= -1.0 && b.min.x.is_finite() && b.min.y.is_infinite());
        let y = DVec3::new(1.0, f64::INFINITY, 1.0);
        let b = Bounds3 { min: -y, max: y }.transform(&DAffine3::IDENTITY);
        assert!(b.min.x.is_finite() && b.max.z.is_finite() && b.max.y.is_infinite());
    }

    #[test]
    fn ray_meets_box_between_its_faces() {
        let (t0, t1) = hit(&UNIT, DVec3::new(-1.0, 0.5, 0.5), DVec3::X).unwrap();
        let bound = 4.0 * gamma64(3);
        assert!((t0 - 1.0).abs() <= bound && t1 >= 2.0 && t1 - 2.0 <= 2.0 * bound);
        let inside = hit(&UNIT, DVec3::splat(0.5), -DVec3::Y).unwrap();
        assert!(inside.0 <= 0.0 && (inside.1 - 0.5).abs() <= bound);
        assert!(hit(&UNIT, DVec3::new(2.0, 0.5, 0.5), DVec3::X).is_none());
        assert!(UNIT.intersect_ray(DVec3::new(-1.0, 0.5, 0.5), DVec3::X.recip(), 0.9).is_none());
    }

    #[test]
    fn axis_parallel_rays_with_either_zero_touch_faces_and_never_see_past_them() {
        for zero in [0.0, -0.0] {
            let d = DVec3::new(1.0, zero, zero);
            for (y, expected) in [(0.0, true), (1.0, true), (-0.5, false), (1.5, false)] {
                assert_eq!(hit(&UNIT, DVec3::new(-1.0, y, 0.5), d).is_some(), expected, "{y}");
                assert_eq!(hit(&UNIT, DVec3::new(-1.0, 0.5, y), d).is_some(), expected, "{y}");
            }
        }
    }

    #[test]
    fn flat_and_infinite_boxes_are_met() {
        let flat = Bounds3 { min: DVec3::new(0.0, 0.0, 0.5), max: DVec3::new(1.0, 1.0, 0.5) };
        assert!(hit(&flat, DVec3::new(0.5, 0.5, -1.0), DVec3::Z).is_some());
        assert!(hit(&flat, DVec3::new(-1.0, 0.5, 0.5), DVec3::X).is_some());
        assert!(hit(&Bounds3::ALL, DVec3::splat(3.0), DVec3::X).is_some());
        let far = f64::INFINITY;
        let beam = Bounds3 { min: DVec3::new(-far, 0.0, 0.0), max: DVec3::new(far, 1.0, 1.0) };
        assert!(hit(&beam, DVec3::splat(0.5), DVec3::X).is_some());
        assert!(hit(&beam, DVec3::new(0.0, -0.5, 0.5), DVec3::X).is_none());
    }

    #[test]
    fn empty_boxes_and_nan_rays_miss() {
        let o = DVec3::splat(0.5);
        assert!(hit(&Bounds3::EMPTY, o, DVec3::X).is_none());
        assert!(hit(&Bounds3::EMPTY, o, DVec3::ONE).is_none());
        let inverted = Bounds3 { min: DVec3::new(0.0, 1.0, 0.0), max: DVec3::new(1.0, 0.0, 1.0) };
        assert!(hit(&inverted, DVec3::new(-1.0, 1.0, 0.5), DVec3::X).is_none());
        assert!(hit(&UNIT, DVec3::NAN, DVec3::X).is_none());
        assert!(hit(&UNIT, o, DVec3::NAN).is_none());
    }

    #[test]
    fn rays_through_an_exact_corner_are_never_lost() {
        let mut rng = Points::new(6);
        for _ in 0..10_000 {
            // Integers, so that o + d t is exact and only the box test rounds.
            let mut whole = || (rng.cube() * 1e6).floor();
            let (o, d, t) = (whole(), whole() + DVec3::splat(0.5), whole().x.abs() + 1.0);
            let corner = o + d * t;
            let b = Bounds3 { min: corner, max: corner };
            assert!(hit(&b, o, d).is_some(), "{corner} {o} {d}");
            assert!(hit(&b, o + DVec3::X, d).is_none());
        }
    }
}
