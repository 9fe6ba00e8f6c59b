//! Visible normals of the GGX microfacet distribution, anisotropic.

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};

/// A microfacet normal as seen from `wo`, for roughness `alpha` = (`alpha_x`, `alpha_y`), each ≥ 1e-9.
///
/// `wo` is unit length in the shading frame with z ≥ 0 (flip it for the lower side). The result is
/// unit length with z > 0 and `wo`·wm ≥ 0. Reflect `wo` about it to get `wi`. At the far end
/// of `u` (1e-6 of it) rounding may turn the normal away from `wo`; its density is 0 there: drop
/// the sample.
///
/// # Source
/// Dupuy & Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing 3. We keep
/// 1 − z of the cap instead of z: exact near the pole, where small roughness lives.
#[inline]
pub fn visible_normal(wo: Vec3, alpha: Vec2, u: [f32; 2]) -> Vec3 {
    // Stretch to the hemisphere of roughness 1.
    let wo_std = Vec3::new(wo.x * alpha.x, wo.y * alpha.y, wo.z).normalize();
    // Draw a direction of the cap z > −wo.z, which is the image of the facets under reflection.
    let x = u[0] * (1.0 + wo_std.z);
    let cap = super::sphere::polar(x, u[1]);
    // The half vector; its z as a product, which cannot cancel.
    let h = Vec3::new(
        (cap.x + wo_std.x) * alpha.x,
        (cap.y + wo_std.y) * alpha.y,
        (1.0 - u[0]) * (1.0 + wo_std.z),
    );
    h.normalize()
}

/// Density of [`visible_normal`] at the unit vector `wm`, per solid angle of normals, sr⁻¹.
///
/// Zero for `wm` below the horizon or facing away from `wo`. Divide by 4 |`wo`·`wm`| for the
/// density of a reflected direction.
///
/// # Source
/// Heitz 2018, eq. 3, G₁ and cos θ folded into one fraction, which stays finite at grazing.
#[inline]
pub fn visible_normal_pdf(wo: Vec3, wm: Vec3, alpha: Vec2) -> f32 {
    let cos = wo.dot(wm);
    if !(wm.z > 0.0 && cos > 0.0) {
        return 0.0;
    }
    let slope = wm.truncate() / alpha;
    let stretch = slope.length_squared() + wm.z * wm.z;
    let d = FRAC_1_PI / (alpha.x * alpha.y * stretch * stretch);
    let masking = wo.z + Vec3::new(wo.x * alpha.x, wo.y * alpha.y, wo.z).length();
    2.0 * d * cos / masking
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Moments;
    use crate::sampling::Rng;
    use crate::sampling::chi_square::check_directions;

    fn check(wo: Vec3, alpha: Vec2, seed: u64) {
        let wo = wo.normalize();
        check_directions(
            seed,
            |u| visible_normal(wo, alpha, u),
            |wm| visible_normal_pdf(wo, wm, alpha),
        );
    }

    #[test]
    fn visible_normals_follow_their_density() {
        check(Vec3::Z, Vec2::splat(0.5), 18);
        check(Vec3::new(1.0, 0.5, 1.0), Vec2::new(0.4, 0.9), 19);
        check(Vec3::new(0.0, -1.0, 0.3), Vec2::new(1.0, 0.5), 20);
        check(Vec3::new(1.0, 0.0, 1e-3), Vec2::splat(0.6), 21);
    }

    #[test]
    fn normals_are_unit_and_upward_at_every_extreme() {
        let top = 1.0f32.next_down();
        for wo in [Vec3::Z, Vec3::X, Vec3::new(0.6, 0.0, 0.8), Vec3::new(-1.0, 0.0, 1e-7)] {
            for a in [1e-9, 1e-5, 1e-3, 1.0] {
                for u in [[0.0, 0.0], [top, 0.0], [top, 0.5], [0.5, top], [0.3, 0.7]] {
                    let wm = visible_normal(wo, Vec2::splat(a), u);
                    assert!((wm.length() - 1.0).abs() <= 4.0 * f32::EPSILON && wm.z > 0.0);
                    // A facing error is a rounding of the half vector over its length, ≥ 1 − u.
                    let length = 1.0 - u[0];
                    assert!(wo.dot(wm) >= -4.0 * f32::EPSILON / length, "{wo} {a} {u:?} {wm}");
                    assert!(visible_normal_pdf(wo, wm, Vec2::splat(a)).is_finite());
                }
            }
        }
    }

    #[test]
    fn slopes_shrink_with_the_roughness_down_to_a_mirror() {
        // From above, tan² θ / α² = v / (1 − v) with v uniform, so θ < atan α half of the time.
        for a in [1e-5f32, 1e-2, 1.0] {
            let mut below = Moments::default();
            let mut rng = Rng::new(22);
            for _ in 0..20_000 {
                let wm = visible_normal(Vec3::Z, Vec2::splat(a), rng.pair());
                let slope = wm.truncate().length() / wm.z;
                below.push(if slope < a { 1.0 } else { 0.0 });
            }
            assert!((below.mean - 0.5).abs() <= 5.0 * below.standard_error());
        }
    }
}
