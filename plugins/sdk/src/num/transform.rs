//! Placements: affine maps in f64 that keep their inverse.

use glam::{DAffine3, DMat3, DVec3};

use super::error::gamma64;
use super::ray::Ray;

/// How far from orthogonal a matrix may be and still count as a rotation and uniform scale: a
/// product of 16 rotations whose entries each carry four roundings.
const ORTHOGONAL: f64 = gamma64(64);

/// An invertible affine map from a local frame (an object's) to a world frame, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    forward: DAffine3,
    /// Inverse of the linear part only: points go back as M⁻¹(p − t), which keeps the digits of a
    /// local position however far away the object stands.
    inverse3: DMat3,
    det: f64,
}

impl Transform {
    /// The map that changes nothing.
    pub const IDENTITY: Self =
        Self { forward: DAffine3::IDENTITY, inverse3: DMat3::IDENTITY, det: 1.0 };

    /// Wraps `forward`; `None` if it is singular or not finite.
    ///
    /// Singular means that the determinant is within its own rounding error of zero, or that the
    /// inverse overflows. Flat but honest scales such as (1, 1, 1e-20) are fine.
    pub fn new(forward: DAffine3) -> Option<Self> {
        if !forward.is_finite() {
            return None;
        }
        // Scaled by a power of two, exactly, so that small and large units do not underflow.
        let m = forward.matrix3;
        let largest = m.to_cols_array().into_iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        let unit = f64::from_bits(largest.to_bits() & f64::INFINITY.to_bits());
        if unit == 0.0 {
            return None;
        }
        let scaled = m * unit.recip();
        let det = scaled.determinant();
        if det.abs() <= gamma64(6) * permanent(scaled) {
            return None;
        }
        let inverse3 = scaled.inverse() * unit.recip();
        let det = det * unit * unit * unit;
        inverse3.is_finite().then_some(Self { forward, inverse3, det })
    }

    /// Moves by `t` metres; `None` if not finite.
    pub fn translate(t: DVec3) -> Option<Self> {
        Self::new(DAffine3::from_translation(t))
    }

    /// Turns by `angle` radians about `axis` (any length above zero), right-handed.
    ///
    /// `None` if the axis is zero or anything is not finite.
    pub fn rotate(axis: DVec3, angle: f64) -> Option<Self> {
        let axis = (axis / axis.abs().max_element()).try_normalize()?;
        Self::new(DAffine3::from_axis_angle(axis, angle))
    }

    /// Stretches by `s` along the axes; negative mirrors. `None` if a factor is 0 or not finite.
    pub fn scale(s: DVec3) -> Option<Self> {
        Self::new(DAffine3::from_scale(s))
    }

    /// First `inner`, then this one. `None` if the product is numerically singular.
    pub fn compose(&self, inner: &Self) -> Option<Self> {
        Self::new(self.forward * inner.forward)
    }

    /// The map back; `None` if its translation overflows.
    pub fn inverse(&self) -> Option<Self> {
        let translation = -(self.inverse3 * self.forward.translation);
        let forward = DAffine3 { matrix3: self.inverse3, translation };
        let inverse3 = self.forward.matrix3;
        forward.is_finite().then_some(Self { forward, inverse3, det: self.det.recip() })
    }

    /// The affine map itself.
    pub fn affine(&self) -> &DAffine3 {
        &self.forward
    }

    /// A local point in the world.
    pub fn point(&self, p: DVec3) -> DVec3 {
        self.forward.transform_point3(p)
    }

    /// A local point and its error bound, in the world, the rounding of the map included.
    ///
    /// # Source
    /// PBR4 §6.8.6, "Error Propagation through Transformations".
    pub fn point_with_error(&self, p: DVec3, p_err: DVec3) -> (DVec3, DVec3) {
        let m = self.forward.matrix3.abs();
        let rounding = m * p.abs() + self.forward.translation.abs();
        // One product and three sums, on each path to a component.
        (self.point(p), (1.0 + gamma64(4)) * (m * p_err) + gamma64(4) * rounding)
    }

    /// A local vector in the world; lengths change with the scale.
    pub fn vector(&self, v: DVec3) -> DVec3 {
        self.forward.transform_vector3(v)
    }

    /// A local normal in the world by the inverse transpose; not normalised.
    ///
    /// Under a mirroring map it still points out of the side that it pointed out of.
    pub fn normal(&self, n: DVec3) -> DVec3 {
        self.inverse3.transpose() * n
    }

    /// A world point in the local frame.
    pub fn inverse_point(&self, p: DVec3) -> DVec3 {
        self.inverse3 * (p - self.forward.translation)
    }

    /// A world vector in the local frame.
    pub fn inverse_vector(&self, v: DVec3) -> DVec3 {
        self.inverse3 * v
    }

    /// A world normal in the local frame; not normalised.
    pub fn inverse_normal(&self, n: DVec3) -> DVec3 {
        self.forward.matrix3.transpose() * n
    }

    /// A world ray in the local frame, not normalised: `t` means the same in both.
    pub fn inverse_ray(&self, ray: &Ray) -> Ray {
        Ray { o: self.inverse_point(ray.o), d: self.inverse_vector(ray.d), t_max: ray.t_max }
    }

    /// Whether the map keeps shapes: rotation, mirroring, translation and one scale for all axes.
    pub fn is_rigid_or_uniform(&self) -> bool {
        let m = self.forward.matrix3;
        let unit = self.det.abs().cbrt();
        let m = m * unit.recip();
        let gram = m.transpose() * m;
        (gram - DMat3::IDENTITY).to_cols_array().into_iter().all(|e| e.abs() <= ORTHOGONAL)
    }

    /// Whether the map mirrors: it turns right-handed frames into left-handed ones.
    pub fn swaps_handedness(&self) -> bool {
        self.det < 0.0
    }

    /// Factor by which the area of a flat patch with unit local normal `n` grows.
    pub fn area_scale(&self, n: DVec3) -> f64 {
        self.det.abs() * self.normal(n).length()
    }
}

/// The determinant with every sign positive: what the rounding error of the real one scales with.
fn permanent(m: DMat3) -> f64 {
    let (a, b, c) = (m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs());
    a.x * (b.y * c.z + b.z * c.y) + a.y * (b.x * c.z + b.z * c.x) + a.z * (b.x * c.y + b.y * c.x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Frame;
    use crate::num::points::Points;

    fn sheared() -> Transform {
        let m = DMat3::from_cols_array(&[2.0, 0.0, 0.5, -1.0, 3.0, 0.0, 0.25, 1.0, 0.5]);
        Transform::new(DAffine3::from_mat3_translation(m, DVec3::new(1.0, 2.0, 3.0))).unwrap()
    }

    #[test]
    fn singular_and_non_finite_maps_are_refused() {
        assert!(Transform::scale(DVec3::new(1.0, 0.0, 1.0)).is_none());
        assert!(Transform::translate(DVec3::new(f64::NAN, 0.0, 0.0)).is_none());
        assert!(Transform::scale(DVec3::splat(f64::INFINITY)).is_none());
        assert!(Transform::rotate(DVec3::ZERO, 1.0).is_none());
        // Rank two up to rounding.
        let flat = DMat3::from_cols_array(&[0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]);
        assert!(Transform::new(DAffine3::from_mat3(flat)).is_none());
    }

    #[test]
    fn extreme_scales_are_kept() {
        for s in [1e-150, 1e-9, 1e9, 1e150] {
            let t = Transform::scale(DVec3::splat(s)).unwrap();
            let back = t.inverse_point(t.point(DVec3::ONE));
            assert!((back - DVec3::ONE).length() <= 8.0 * f64::EPSILON);
        }
        assert!(Transform::scale(DVec3::new(1.0, 1.0, 1e-20)).is_some());
    }

    #[test]
    fn a_local_point_survives_a_far_placement() {
        let t = Transform::translate(DVec3::splat(1e8)).unwrap();
        let p = DVec3::new(0.5, 0.25, 0.125);
        // Exact here: the sums have no more than 53 bits.
        assert_eq!(t.inverse_point(t.point(p)), p);
        let t = t.compose(&Transform::rotate(DVec3::ONE, 0.7).unwrap()).unwrap();
        assert_eq!(t.inverse_point(DVec3::splat(1e8) + p), t.inverse_vector(p));
    }

    #[test]
    fn inverse_and_compose_undo_each_other() {
        let t = sheared();
        let id = t.inverse().unwrap().compose(&t).unwrap();
        for p in [DVec3::ZERO, DVec3::X, DVec3::new(-3.0, 2.0, 7.0)] {
            // Condition number below 32, values below 32, under ten roundings.
            assert!((id.point(p) - p).length() <= 1e4 * f64::EPSILON);
            assert!((t.inverse_point(t.point(p)) - p).length() <= 1e4 * f64::EPSILON);
            assert!((t.inverse_vector(t.vector(p)) - p).length() <= 1e4 * f64::EPSILON);
            assert!((t.inverse_normal(t.normal(p)) - p).length() <= 1e4 * f64::EPSILON);
        }
    }

    #[test]
    fn normals_stay_across_their_surface_and_area_scale_is_that_of_a_patch() {
        let mut rng = Points::new(7);
        let t = sheared();
        for _ in 0..1000 {
            let f = Frame::from_z(rng.unit().as_vec3());
            let (x, y) = (f.x.as_dvec3(), f.y.as_dvec3());
            let n = x.cross(y);
            let patch = t.vector(x).cross(t.vector(y));
            assert!(t.normal(n).normalize().dot(t.vector(x)).abs() <= 1e3 * f64::EPSILON);
            assert!((t.area_scale(n) / patch.length() - 1.0).abs() <= 1e3 * f64::EPSILON);
        }
    }

    #[test]
    fn flags_tell_rotations_from_stretches_and_mirrors() {
        let r = Transform::rotate(DVec3::new(1.0, 2.0, -0.5), 1.25).unwrap();
        let u = Transform::scale(DVec3::splat(-3e-9)).unwrap();
        let s = Transform::scale(DVec3::new(1.0, 1.0, 1.0 + 1e-12)).unwrap();
        let mut many = r.compose(&u).unwrap();
        for _ in 0..10 {
            many = many.compose(&r).unwrap();
        }
        assert!(r.is_rigid_or_uniform() && u.is_rigid_or_uniform() && many.is_rigid_or_uniform());
        assert!(!s.is_rigid_or_uniform() && !sheared().is_rigid_or_uniform());
        assert!(!r.swaps_handedness() && u.swaps_handedness() && many.swaps_handedness());
    }

    #[test]
    fn point_error_bounds_cover_an_offset_within_the_input_error() {
        let t = sheared();
        let (p, e) = (DVec3::new(3.0, -4.0, 5.0), DVec3::new(1e-9, 2e-9, 0.0));
        let (q, q_err) = t.point_with_error(p, e);
        let moved = t.point(p + DVec3::new(e.x, -e.y, 0.0));
        assert!((moved - q).abs().cmple(q_err).all());
        assert!(q_err.cmplt(DVec3::splat(1e-8)).all());
    }

    #[test]
    fn inverse_ray_keeps_the_parameter() {
        let t = sheared();
        let ray = Ray { o: DVec3::new(1.0, 0.0, 2.0), d: DVec3::new(0.0, 3.0, 1.0), t_max: 9.0 };
        let local = t.inverse_ray(&ray);
        assert!((t.point(local.at(2.5)) - ray.at(2.5)).length() <= 1e4 * f64::EPSILON);
        assert!(local.t_max.to_bits() == ray.t_max.to_bits());
    }
}
