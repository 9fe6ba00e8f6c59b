//! A disk as a part of the sphere around a viewer: a spherical ellipse.
//!
//! Guillén, Ureña, King, Fajardo, Georgiev, López-Moreno and Jarabo 2017, "Area-Preserving
//! Parameterizations for Spherical Ellipses": the cone of a disk has two planes of symmetry, and about
//! its axis the heights of a sector are uniform. They invert an elliptic integral for the sector; here
//! it is drawn by a polygon through the integrand, whose density is then known as well.

use std::f64::consts::FRAC_PI_2;

use glam::{DVec2, DVec3};

/// Least distance from the plane, in radii: nearer to it, angles say little about the place.
const LOWEST: f64 = 1e-4;

/// Corners of the polygon in a quarter of the turn, less one.
const PIECES: usize = 8;

/// What a viewer sees of a disk.
pub(super) struct SphericalEllipse {
    /// Across, towards the disk's middle, and along the axis of the cone.
    frame: [DVec3; 3],
    /// Tangents of the half angles across and towards the middle.
    half: DVec2,
    /// Solid angle by turn at each corner of the polygon, sr.
    corners: [f64; PIECES + 1],
    /// Of the polygon, all around, sr.
    solid_angle: f64,
}

impl SphericalEllipse {
    /// The disk of this radius about `centre`, as seen from the origin. `None` from too near to its
    /// plane.
    pub(super) fn new(centre: DVec3, normal: DVec3, radius: f64) -> Option<Self> {
        let height = normal.dot(centre);
        let down = normal * height.signum();
        let height = height.abs();
        if !(height >= LOWEST * radius) {
            return None;
        }
        let aside = centre - down * height;
        let far = aside.length();
        // Directly below every way is as good.
        let towards = aside.try_normalize().unwrap_or(down.any_orthonormal_vector());
        let (near, end) = ((far - radius).atan2(height), (far + radius).atan2(height));
        let (sin, cos) = (0.5 * (near + end)).sin_cos();
        let foot = height * sin / cos;
        let chord = ((radius - (foot - far)) * (radius + (foot - far))).max(0.0).sqrt();
        let half = DVec2::new(chord * cos / height, (0.5 * (end - near)).tan());
        let frame = [towards.cross(down), towards * cos - down * sin, down * cos + towards * sin];
        let mut found = Self { frame, half, corners: [0.0; PIECES + 1], solid_angle: 0.0 };
        let step = FRAC_PI_2 / PIECES as f64;
        found.corners = std::array::from_fn(|i| found.by_turn(i as f64 * step));
        let pairs = found.corners.windows(2).map(|ends| 0.5 * (ends[0] + ends[1]));
        found.solid_angle = 4.0 * step * pairs.sum::<f64>();
        let usable = found.solid_angle > 0.0 && found.solid_angle.is_finite();
        usable.then_some(found)
    }

    /// Square of the tangent of the angle from the axis to the rim, at the turn ψ of which the rim is at
    /// (A cos ψ, B sin ψ).
    fn rim(&self, turn: f64) -> f64 {
        let (sin, cos) = turn.sin_cos();
        (self.half * DVec2::new(cos, sin)).length_squared()
    }

    /// Solid angle of a sector by its turn: (1 − cos θ) dφ/dψ, where the rim is at θ and tan φ =
    /// B/A tan ψ, so that dφ/dψ = A·B / tan² θ.
    fn by_turn(&self, turn: f64) -> f64 {
        let tan2 = 1.0 + self.rim(turn);
        self.half.x * self.half.y / (tan2 * (1.0 + tan2.sqrt().recip()))
    }

    /// A direction; `u` uniform in [0, 1)².
    pub(super) fn sample(&self, [u, v]: [f64; 2]) -> DVec3 {
        // Quarters in turn, every other one backwards, so that neighbours stay neighbours.
        let quarter = (4.0 * u).clamp(0.0, 4.0f64.next_down());
        let (number, part) = (quarter.floor(), quarter.fract());
        let turn = if number % 2.0 < 1.0 {
            number * FRAC_PI_2 + self.turn_of(part)
        } else {
            (number + 1.0) * FRAC_PI_2 - self.turn_of(1.0 - part)
        };
        let (sin, cos) = turn.sin_cos();
        let out = self.half * DVec2::new(cos, sin);
        let rim = out.length_squared();
        // 1 − cos of the angle from the axis is uniform up to that of the rim.
        let secant = (1.0 + rim).sqrt();
        let height = v * rim / (secant * (1.0 + secant));
        let flat = out.normalize() * (height * (2.0 - height)).sqrt();
        let [x, y, z] = self.frame;
        x * flat.x + y * flat.y + z * (1.0 - height)
    }

    /// The turn in the first quarter up to which the polygon has this part of it.
    fn turn_of(&self, part: f64) -> f64 {
        let step = FRAC_PI_2 / PIECES as f64;
        let size = |i: usize| 0.5 * (self.corners[i] + self.corners[i + 1]);
        let mut rest = part * 0.25 * self.solid_angle / step;
        let mut piece = 0;
        while piece + 1 < PIECES && rest >= size(piece) {
            rest -= size(piece);
            piece += 1;
        }
        // Linear within a piece: the stable root of its integral.
        let (a, b) = (self.corners[piece], self.corners[piece + 1]);
        let along = 2.0 * rest / (a + (a * a + 2.0 * (b - a) * rest).max(0.0).sqrt());
        (piece as f64 + along.clamp(0.0, 1.0)) * step
    }

    /// The density with which a direction within the disk is found, sr⁻¹: all but the same for all.
    pub(super) fn density(&self, d: DVec3) -> f64 {
        let [x, y, _] = self.frame;
        let out = DVec2::new(d.dot(x), d.dot(y)).abs() / self.half;
        let turn = out.y.atan2(out.x);
        let place = turn / FRAC_PI_2 * PIECES as f64;
        let piece = (0..PIECES - 1).find(|i| place < (i + 1) as f64).unwrap_or(PIECES - 1);
        let (a, b) = (self.corners[piece], self.corners[piece + 1]);
        let drawn = a + (b - a) * (place - piece as f64).clamp(0.0, 1.0);
        drawn / (self.by_turn(turn) * self.solid_angle)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use glam::Vec3Swizzles as _;

    use super::*;

    #[test]
    fn a_disk_from_above_its_middle_fills_a_cone() {
        for (height, radius) in [(1.0, 1.0), (0.01, 2.0), (5.0, 0.1)] {
            let seen = SphericalEllipse::new(DVec3::Y * -height, DVec3::Y, radius).unwrap();
            let cone = TAU * (1.0 - height / f64::hypot(height, radius));
            assert!((seen.solid_angle / cone - 1.0).abs() < 1e-12, "{}", seen.solid_angle);
            let rim = seen.sample([0.3, 1.0]);
            assert!((rim.xz().length() / -rim.y - radius / height).abs() < 1e-9 * radius / height);
        }
        assert!(SphericalEllipse::new(DVec3::X, DVec3::Y, 1.0).is_none());
        assert!(SphericalEllipse::new(DVec3::NAN, DVec3::Y, 1.0).is_none());
    }

    #[test]
    fn the_corners_of_the_square_reach_the_rim_and_all_are_found_alike() {
        for centre in [DVec3::new(0.7, -0.4, 0.2), DVec3::new(-2.0, 0.3, 1.0)] {
            let seen = SphericalEllipse::new(centre, DVec3::Y, 0.9).unwrap();
            for i in 0..200 {
                let u = f64::from(i) / 200.0;
                let rim = seen.sample([u, 1.0]);
                let p = rim * (centre.y / rim.y) - centre;
                assert!((p.length() - 0.9).abs() < 1e-12, "{u}: {}", p.length());
                let density = seen.density(seen.sample([u, 0.5])) * seen.solid_angle;
                assert!((density - 1.0).abs() < 0.02, "{centre}: {density}");
            }
        }
    }
}
