//! Unit vectors.

use glam::DVec3;

/// The vector at unit length, to three roundings, and its length.
///
/// Root and quotient are of the same number, so that neither waits for the other. A vector that is
/// zero or not finite, or whose squared length overflows or underflows, gives a vector of NaN.
#[inline(always)]
pub fn unit_and_length(v: DVec3) -> (DVec3, f64) {
    let squared = v.length_squared();
    let length = squared.sqrt();
    (v * (length * squared.recip()), length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::gamma64;
    use crate::num::points::Points;

    #[test]
    fn unit_vectors_have_length_one_and_keep_their_direction() {
        let mut rng = Points::new(4);
        for scale in [1e-60, 1e-3, 1.0, 1e70] {
            for _ in 0..1000 {
                let direction = rng.unit();
                let (unit, length) = unit_and_length(direction * scale);
                // The sum of squares has three roundings, the root, quotient and products four.
                assert!((unit.length() - 1.0).abs() <= gamma64(8), "{unit}");
                assert!((length / scale - 1.0).abs() <= gamma64(8));
                assert!(unit.dot(direction) > 1.0 - gamma64(8));
            }
        }
    }

    #[test]
    fn what_has_no_direction_gives_nan() {
        for bad in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::X * 1e-200, DVec3::X * 1e200] {
            assert!(unit_and_length(bad).0.is_nan(), "{bad}");
        }
    }
}
