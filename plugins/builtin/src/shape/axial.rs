//! Frames of shapes about an axis: both tangents and the axis, right-handed.

use std::f64::consts::TAU;

use glam::DVec3;

/// A right-handed frame whose last vector is along `axis`, which has a direction.
pub(super) fn frame(axis: DVec3) -> [DVec3; 3] {
    let z = (axis / axis.abs().max_element()).normalize();
    let (x, y) = z.any_orthonormal_pair();
    [x, y, z]
}

/// Components of `v` along the vectors of the frame.
pub(super) fn local([x, y, z]: &[DVec3; 3], v: DVec3) -> DVec3 {
    DVec3::new(v.dot(*x), v.dot(*y), v.dot(*z))
}

/// The vector whose components along the frame are those of `v`.
pub(super) fn place([x, y, z]: &[DVec3; 3], v: DVec3) -> DVec3 {
    *x * v.x + *y * v.y + *z * v.z
}

/// Half the box around the unit disk across `z`.
pub(super) fn across(z: DVec3) -> DVec3 {
    (DVec3::ONE - z * z).max(DVec3::ZERO).map(f64::sqrt)
}

/// The angle within half a turn of 0 that points the same way, radians.
pub(super) fn within_half_a_turn(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// `turn` radians in (−π, π] as a texture coordinate in [0, 1].
pub(super) fn turn_of(angle: f64) -> f64 {
    let turn = angle / TAU;
    if turn < 0.0 { turn + 1.0 } else { turn }
}

/// Length of the ray's direction; `None` where a ray is not finite or leads nowhere.
pub(super) fn length_of(ray: &luxel_sdk::num::Ray) -> Option<f64> {
    let length = ray.d.length();
    (length > 0.0 && length.is_finite() && ray.o.is_finite()).then_some(length)
}
