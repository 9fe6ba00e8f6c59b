//! Orthonormal frames for directions at a surface.

use glam::Vec3;

/// A right-handed orthonormal frame: three unit vectors, `z` usually the shading normal.
///
/// Made by [`Frame::from_z`] or [`Frame::from_z_and_tangent`]; whoever fills the fields by hand
/// promises that they are orthonormal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// First tangent, unit length.
    pub x: Vec3,
    /// Second tangent, unit length; `z` × `x`.
    pub y: Vec3,
    /// Normal, unit length.
    pub z: Vec3,
}

impl Frame {
    /// The frame of the coordinate axes.
    pub const IDENTITY: Self = Self { x: Vec3::X, y: Vec3::Y, z: Vec3::Z };

    /// Completes the unit vector `z` to a frame, without branches and without a pole.
    ///
    /// # Source
    /// Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3.
    pub fn from_z(z: Vec3) -> Self {
        let sign = 1.0f32.copysign(z.z);
        let a = -1.0 / (sign + z.z);
        let b = z.x * z.y * a;
        let x = Vec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x);
        let y = Vec3::new(b, sign + z.y * z.y * a, -z.y);
        Self { x, y, z }
    }

    /// The frame around the unit vector `z` whose `x` is the part of `tangent` across `z`.
    ///
    /// `tangent` has any length. Where it is zero, not finite or exactly parallel to `z`, the result
    /// is that of [`Frame::from_z`].
    pub fn from_z_and_tangent(z: Vec3, tangent: Vec3) -> Self {
        // Products of two f32 are exact in f64 and cannot overflow, so that each component of the
        // cross product is right to one rounding, however close to parallel.
        let (z64, t) = (z.as_dvec3(), tangent.as_dvec3());
        let across = z64.cross(t);
        let length = across.length();
        if !(length > 0.0 && length.is_finite()) {
            return Self::from_z(z);
        }
        let y = across / length;
        // As long as `z`: unit to the rounding of f32.
        let x = y.cross(z64);
        Self { x: x.as_vec3(), y: y.as_vec3(), z }
    }

    /// Components of `v` along the three axes: world to local.
    pub fn to_local(&self, v: Vec3) -> Vec3 {
        Vec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// The vector whose components along the three axes are `v`: local to world.
    pub fn to_world(&self, v: Vec3) -> Vec3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::points::Points;

    /// Roundings between an input unit vector and a dot product of two frame axes.
    const TOLERANCE: f32 = 8.0 * f32::EPSILON;

    fn check_orthonormal(f: Frame) {
        for (a, b, expected) in [
            (f.x, f.x, 1.0),
            (f.y, f.y, 1.0),
            (f.x, f.y, 0.0),
            (f.y, f.z, 0.0),
            (f.z, f.x, 0.0),
            (f.x.cross(f.y), f.z, 1.0),
        ] {
            assert!((a.dot(b) - expected).abs() <= TOLERANCE, "{f:?}: {} {expected}", a.dot(b));
        }
    }

    #[test]
    fn from_z_is_orthonormal_and_right_handed_everywhere() {
        let mut rng = Points::new(2);
        for _ in 0..10_000 {
            check_orthonormal(Frame::from_z(rng.unit().as_vec3()));
        }
        for z in [Vec3::Z, -Vec3::Z, Vec3::X, Vec3::new(0.0, 1.0, -0.0)] {
            check_orthonormal(Frame::from_z(z));
        }
        check_orthonormal(Frame::from_z(Vec3::new(1e-4, 0.0, -1.0).normalize()));
    }

    #[test]
    fn tangent_hint_is_followed_at_any_length_and_dropped_when_parallel() {
        let z = Vec3::new(1.0, 2.0, 3.0).normalize();
        for length in [1e-30f32, 1.0, 1e30] {
            let f = Frame::from_z_and_tangent(z, Vec3::X * length);
            check_orthonormal(f);
            assert!(f.x.x > 0.0 && f.y.dot(Vec3::X).abs() <= TOLERANCE);
        }
        for bad in [Vec3::ZERO, Vec3::NAN, Vec3::splat(f32::INFINITY)] {
            assert_eq!(Frame::from_z_and_tangent(z, bad), Frame::from_z(z));
        }
        assert_eq!(Frame::from_z_and_tangent(Vec3::Z, -Vec3::Z), Frame::from_z(Vec3::Z));
        assert_eq!(Frame::from_z_and_tangent(z, z * 4.0), Frame::from_z(z));
        let close = Frame::from_z_and_tangent(z, z + Vec3::X * 1e-6);
        check_orthonormal(close);
        assert!(close.x.x > 0.0);
    }

    #[test]
    fn to_world_undoes_to_local() {
        let mut rng = Points::new(3);
        for _ in 0..1000 {
            let f = Frame::from_z(rng.unit().as_vec3());
            let v = rng.unit().as_vec3();
            assert!((f.to_world(f.to_local(v)) - v).length() <= 2.0 * TOLERANCE);
        }
    }
}
