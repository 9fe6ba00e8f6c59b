//! A rectangle as a part of the sphere around a viewer.
//!
//! Ureña, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical Rectangles".

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

/// Solid angles (sr) that are sampled as such. Below, where sums of angles round by more than 1e-11
/// of them, the rectangle is so small or so oblique that its area says as much; above, the viewer
/// all but touches it, and its angles say little about the place.
const RANGE: std::ops::RangeInclusive<f64> = 1e-4..=6.22;

/// Area over squared distance from which on solid angles are worth their arccosines: below, all points
/// of a rectangle that is faced look alike to within (1 + `NEAR` / 2)².
pub(super) const NEAR: f64 = 0.25;

/// What a viewer sees of a rectangle.
pub(super) struct SphericalRectangle {
    /// Corners about the viewer's foot in the plane.
    low: DVec2,
    high: DVec2,
    /// From the viewer to the plane.
    distance: f64,
    /// Cosines of the planes through the viewer and the edges along x, with the plane.
    cos: [f64; 2],
    /// The angle from which areas are counted.
    start: f64,
    /// sr.
    pub(super) solid_angle: f64,
}

impl SphericalRectangle {
    /// The rectangle between two corners given about the viewer's foot, seen from this far away:
    /// not negative. `None` where its solid angle is too small, too large or not a number.
    pub(super) fn new(low: DVec2, high: DVec2, distance: f64) -> Option<Self> {
        let corner = |x: f64, y: f64| DVec3::new(x, y, -distance);
        let corners = [
            corner(low.x, low.y),
            corner(high.x, low.y),
            corner(high.x, high.y),
            corner(low.x, high.y),
        ];
        let side = |i: usize| corners[i].cross(corners[(i + 1) % 4]).normalize();
        let sides = [side(0), side(1), side(2), side(3)];
        let angle = |i: usize| (-sides[i].dot(sides[(i + 1) % 4])).clamp(-1.0, 1.0).acos();
        let start = TAU - angle(2) - angle(3);
        let solid_angle = angle(0) + angle(1) - start;
        let cos = [sides[0].z, sides[2].z];
        let usable = RANGE.contains(&solid_angle) && distance > 0.0;
        usable.then_some(Self { low, high, distance, cos, start, solid_angle })
    }

    /// A point about the viewer's foot, uniform in solid angle; `u` uniform in [0, 1)².
    pub(super) fn sample(&self, [u, v]: [f64; 2]) -> DVec2 {
        let Self { low, high, distance, cos: [b0, b1], .. } = *self;
        // Across: the part of the rectangle on the left has u of its solid angle.
        let (sin, cos) = (u * self.solid_angle + self.start).sin_cos();
        let f = (cos * b0 - b1) / sin;
        let c = f.hypot(b0).recip().min(1.0).copysign(f);
        let x = (c * distance / ((1.0 - c) * (1.0 + c)).sqrt()).clamp(low.x, high.x);
        // Up: the height of the point on the sphere is uniform.
        let d2 = x * x + distance * distance;
        let height = |y: f64| y / (d2 + y * y).sqrt();
        let h = height(low.y) + v * (height(high.y) - height(low.y));
        let y = (h * d2.sqrt() / ((1.0 - h) * (1.0 + h)).sqrt()).clamp(low.y, high.y);
        DVec2::new(if x.is_nan() { low.x } else { x }, if y.is_nan() { high.y } else { y })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use luxel_sdk::num::Moments;
    use luxel_sdk::sampling::Rng;

    fn seen(low: (f64, f64), high: (f64, f64), distance: f64) -> SphericalRectangle {
        SphericalRectangle::new(low.into(), high.into(), distance).unwrap()
    }

    /// The solid angle of the rectangle between the foot and (x, y).
    fn quarter(x: f64, y: f64, z: f64) -> f64 {
        (x * y / (z * (x * x + y * y + z * z).sqrt())).atan()
    }

    #[test]
    fn the_solid_angle_is_that_of_four_rectangles_at_the_foot() {
        for (low, high, z) in [
            ((-1.0, -1.0), (1.0, 1.0), 1.0),
            ((0.5, 0.2), (2.0, 0.3), 3.0),
            ((-3.0, 1.0), (-2.0, 9.0), 0.5),
            ((-1.0, -2.0), (3.0, 1.0), 0.1),
        ] {
            let truth =
                quarter(high.0, high.1, z) - quarter(low.0, high.1, z) - quarter(high.0, low.1, z)
                    + quarter(low.0, low.1, z);
            let found = seen(low, high, z).solid_angle;
            assert!((found - truth).abs() <= 1e-14, "{found} {truth}");
        }
        // A face of the cube around the viewer is a sixth of everything.
        let face = seen((-1.0, -1.0), (1.0, 1.0), 1.0).solid_angle;
        assert!((face - 4.0 * TAU / 12.0).abs() <= 1e-14);
    }

    #[test]
    fn parts_of_the_square_become_parts_of_the_solid_angle() {
        let (low, high, z) = ((-1.0, -2.0), (3.0, 1.0), 0.4);
        let whole = seen(low, high, z);
        let mut rng = Rng::new(91);
        let mut inside = [Moments::default(); 3];
        let parts =
            [((-1.0, -2.0), (0.0, 0.0)), ((0.1, -0.2), (0.4, 0.2)), ((2.0, 0.0), (3.0, 1.0))];
        for _ in 0..100_000 {
            let p = whole.sample([rng.f64(), rng.f64()]);
            for (m, (low, high)) in inside.iter_mut().zip(parts) {
                let within = p.cmpge(low.into()).all() && p.cmple(high.into()).all();
                m.push(f64::from(u8::from(within)));
            }
        }
        for (m, (low, high)) in inside.iter().zip(parts) {
            let share = seen(low, high, z).solid_angle / whole.solid_angle;
            assert!((m.mean - share).abs() <= 5.0 * m.standard_error(), "{} {share}", m.mean);
        }
    }

    #[test]
    fn corners_stay_inside_and_what_cannot_be_told_is_left_to_the_area() {
        let s = seen((-1.0, 2.0), (3.0, 5.0), 0.01);
        for u in [0.0, 0.5, 1.0f64.next_down()] {
            for v in [0.0, 0.5, 1.0f64.next_down()] {
                let p = s.sample([u, v]);
                assert!(p.cmpge(s.low).all() && p.cmple(s.high).all(), "{p}");
            }
        }
        let new = |distance: f64| {
            SphericalRectangle::new(DVec2::splat(-1.0), DVec2::splat(1.0), distance).is_some()
        };
        assert!(new(1.0) && new(100.0) && new(0.1));
        assert!(!new(0.0) && !new(1e-9) && !new(1e4) && !new(f64::NAN) && !new(f64::INFINITY));
        assert!(SphericalRectangle::new(DVec2::ONE, DVec2::splat(2.0), 0.0).is_none());
    }
}
