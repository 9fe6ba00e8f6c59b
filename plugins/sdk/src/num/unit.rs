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

/// A vector that is of unit length but for the roundings of f32, to those of f64; any other as
/// [`unit_and_length`] makes it.
///
/// With |v|² = 1 + e, 1/|v| is 1 − e/2 + 3e²/8 but for 5e³/16, which is lost in the rounding: neither root nor
/// quotient is waited for.
#[inline(always)]
pub fn unit_again(v: DVec3) -> DVec3 {
    let e = v.length_squared() - 1.0;
    if e.abs() < 4e-6 { v * (1.0 + e * (0.375 * e - 0.5)) } else { unit_and_length(v).0 }
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
    fn what_was_unit_in_single_precision_is_so_in_double() {
        let mut rng = Points::new(5);
        for length in [1.0, 1.0 + 1e-7, 1.0 - 1e-6, 1.0 + 1.9e-6, 1.0 - 1.9e-6, 1.001, 0.5] {
            for _ in 0..1000 {
                let direction = rng.unit();
                let unit = unit_again(direction * length);
                assert!((unit.length() - 1.0).abs() <= gamma64(8), "{length} {unit}");
                assert!(unit.dot(direction) > 1.0 - gamma64(8));
            }
        }
    }

    #[test]
    fn what_has_no_direction_gives_nan() {
        for bad in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::X * 1e-200, DVec3::X * 1e200] {
            assert!(unit_and_length(bad).0.is_nan() && unit_again(bad).is_nan(), "{bad}");
        }
    }
}
