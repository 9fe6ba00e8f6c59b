//! Rounding-error bounds, and ray origins moved by exactly as much as those bounds ask.
//!
//! PBR4 §6.8. The next representable float is the standard library's `next_up` / `next_down`.

use glam::DVec3;

/// Bound on the relative error of `n` chained f32 roundings: nε/(1 − nε), ε = 2⁻²⁴.
///
/// # Source
/// PBR4 §6.8.1, eq. 6.16; Higham, *Accuracy and Stability of Numerical Algorithms*, §3.1.
pub const fn gamma32(n: u16) -> f32 {
    let ne = n as f32 * (0.5 * f32::EPSILON);
    ne / (1.0 - ne)
}

/// Bound on the relative error of `n` chained f64 roundings: nε/(1 − nε), ε = 2⁻⁵³.
///
/// # Source
/// PBR4 §6.8.1, eq. 6.16.
pub const fn gamma64(n: u16) -> f64 {
    let ne = n as f64 * (0.5 * f64::EPSILON);
    ne / (1.0 - ne)
}

/// The point from which a ray in direction `d` leaves a surface without meeting it again.
///
/// `p` is the computed hit and lies within ±`p_err` (componentwise, metres, ≥ 0) of the surface
/// with unit geometric normal `ng`. The result is on the side of `ng` that `d` points to: the
/// positive side if `d` is tangential or NaN. All in one frame; NaN in, NaN out.
///
/// # Source
/// PBR4 §6.8.6: the plane is moved by |`ng`|·`p_err`, then every component rounds away from `p`: by
/// one to two units in the last place, which costs a product where stepping to the next float costs
/// branches.
#[inline(always)]
pub fn offset_origin(p: DVec3, p_err: DVec3, ng: DVec3, d: DVec3) -> DVec3 {
    let distance = ng.abs().dot(p_err);
    if distance <= 0.0 {
        return p;
    }
    let offset = if d.dot(ng) < 0.0 { ng * -distance } else { ng * distance };
    let moved = p + offset;
    moved + (moved.abs() * f64::EPSILON).copysign(offset)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::points::Points;

    #[test]
    fn gamma_exceeds_n_half_ulps_by_second_order_only() {
        for n in [1u16, 3, 7, 64] {
            let ne = f64::from(n) * 2f64.powi(-53);
            assert!(gamma64(n) >= ne && gamma64(n) <= ne * (1.0 + 2.0 * ne));
            assert!(gamma32(n) >= f32::from(n) * 2f32.powi(-24));
        }
    }

    #[test]
    fn offset_origin_clears_the_error_box_on_the_side_of_the_ray() {
        let mut rng = Points::new(1);
        for _ in 0..10_000 {
            let ng = rng.unit();
            let d = rng.unit();
            let p = DVec3::new(rng.f64(), rng.f64(), rng.f64()) * 1e6;
            let p_err = p * gamma64(5);
            let offset = offset_origin(p, p_err, ng, d) - p;
            let side = d.dot(ng).signum();
            // Three products and two sums, each rounded once, of the measured offset itself.
            let slack = 1.0 - gamma64(6);
            assert!(side * offset.dot(ng) >= slack * ng.abs().dot(p_err));
            // No farther than the bound, one ulp of rounding and one ulp of rounding away.
            let ulps = 2.0 * p.abs().dot(ng.abs()) * f64::EPSILON;
            assert!(side * offset.dot(ng) <= ng.abs().dot(p_err) + ulps);
        }
    }

    #[test]
    fn offset_origin_without_error_stays_put() {
        let p = DVec3::new(1.0, 2.0, 3.0);
        assert_eq!(offset_origin(p, DVec3::ZERO, DVec3::Y, DVec3::Y), p);
    }
}
