//! Warps onto the sphere, the hemisphere and the cone about +z. Densities per solid angle, sr⁻¹.

use std::f32::consts::{FRAC_1_PI, TAU};

use glam::Vec3;

use super::disk::disk_concentric;

/// Density of [`uniform_sphere`], sr⁻¹.
pub const SPHERE_PDF: f32 = 0.25 * FRAC_1_PI;

/// Density of [`uniform_hemisphere`], sr⁻¹.
pub const HEMISPHERE_PDF: f32 = 0.5 * FRAC_1_PI;

/// A direction about +z with density cos θ / π.
///
/// On the equator (only for a coordinate of `u` equal to 0) the density is 0: drop the sample.
///
/// # Source
/// Malley's method, PBR4 §A.5.3; z = √((1 − r)(1 + r)).
#[inline]
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let (a, b) = (2.0 * u[0] - 1.0, 2.0 * u[1] - 1.0);
    let r = a.abs().max(b.abs());
    disk_concentric(u).extend(((1.0 - r) * (1.0 + r)).sqrt())
}

/// Density of [`cosine_hemisphere`] at a direction with cosine `cos` to +z; 0 below the horizon.
#[inline]
pub fn cosine_hemisphere_pdf(cos: f32) -> f32 {
    cos.max(0.0) * FRAC_1_PI
}

/// A uniform direction.
///
/// # Source
/// PBR4 §A.5.2, with sin θ = 2√(u(1 − u)).
#[inline]
pub fn uniform_sphere(u: [f32; 2]) -> Vec3 {
    polar(2.0 * u[0], u[1])
}

/// A uniform direction with z > 0.
#[inline]
pub fn uniform_hemisphere(u: [f32; 2]) -> Vec3 {
    polar(u[0], u[1])
}

/// A uniform direction within the cone about +z whose half angle has 1 − cos θ =
/// `one_minus_cos_max`, in (0, 2].
///
/// Given as 1 − cos θ, as a cosine in f32 cannot tell angles below 3e-4 rad from zero.
/// See [`one_minus_cos`].
#[inline]
pub fn uniform_cone(u: [f32; 2], one_minus_cos_max: f32) -> Vec3 {
    polar(u[0] * one_minus_cos_max, u[1])
}

/// Density of [`uniform_cone`] inside the cone; infinite for a cone of no width.
#[inline]
pub fn uniform_cone_pdf(one_minus_cos_max: f32) -> f32 {
    0.5 * FRAC_1_PI / one_minus_cos_max
}

/// 1 − cos `theta`, accurate for the smallest angles: 2 sin²(θ/2). Radians.
#[inline]
pub fn one_minus_cos(theta: f64) -> f64 {
    let s = (0.5 * theta).sin();
    2.0 * s * s
}

/// 1 − cos θ from sin² θ, for θ in [0, π/2]: sin² / (1 + cos). Above 1 counts as 1.
///
/// For the cone of a sphere seen from outside, sin² θ = (r / distance)².
#[inline]
pub fn one_minus_cos_from_sin2(sin2: f64) -> f64 {
    let sin2 = sin2.min(1.0);
    sin2 / (1.0 + (1.0 - sin2).sqrt())
}

/// The direction with 1 − cos θ = `x` and `turn` of a full turn about +z.
#[inline]
pub(super) fn polar(x: f32, turn: f32) -> Vec3 {
    let sin_theta = (x * (2.0 - x)).max(0.0).sqrt();
    let (sin, cos) = (TAU * turn).sin_cos();
    Vec3::new(sin_theta * cos, sin_theta * sin, 1.0 - x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Moments;
    use crate::sampling::Rng;
    use crate::sampling::chi_square::check_directions;

    #[test]
    fn sphere_samples_follow_their_density() {
        check_directions(13, uniform_sphere, |_| SPHERE_PDF);
    }

    #[test]
    fn hemisphere_samples_follow_their_density() {
        let pdf = |w: Vec3| if w.z > 0.0 { HEMISPHERE_PDF } else { 0.0 };
        check_directions(14, uniform_hemisphere, pdf);
    }

    #[test]
    fn cosine_samples_follow_their_density() {
        check_directions(15, cosine_hemisphere, |w| cosine_hemisphere_pdf(w.z));
    }

    #[test]
    fn cone_samples_follow_their_density() {
        // An edge at z = 0.25, which is an edge of the cells of the test as well.
        let pdf = |w: Vec3| if w.z > 0.25 { uniform_cone_pdf(0.75) } else { 0.0 };
        check_directions(16, |u| uniform_cone(u, 0.75), pdf);
    }

    #[test]
    #[expect(clippy::cast_possible_truncation, reason = "the warp takes f32")]
    fn cones_of_a_microradian_keep_their_shape() {
        let theta = 1e-6;
        let x_max = one_minus_cos(theta);
        assert!((x_max / (0.5 * theta * theta) - 1.0).abs() <= theta * theta);
        let mut rng = Rng::new(17);
        let mut m = Moments::default();
        for _ in 0..20_000 {
            let w = uniform_cone(rng.pair(), x_max as f32).as_dvec3();
            m.push((w.x * w.x + w.y * w.y) / (theta * theta));
        }
        // sin² is uniform in [0, θ²] to first order.
        assert!((m.mean - 0.5).abs() <= 5.0 * m.standard_error());
        assert!(uniform_cone_pdf(x_max as f32).is_finite());
    }

    #[test]
    fn both_forms_of_one_minus_cos_agree() {
        for theta in [1e-9f64, 1e-4, 0.1, 1.0, 1.5] {
            let (a, b) = (one_minus_cos(theta), one_minus_cos_from_sin2(theta.sin().powi(2)));
            // cos θ loses 1/cos² digits on the way through 1 − sin².
            let bound = 8.0 * f64::EPSILON / theta.cos().powi(2);
            assert!((a / b - 1.0).abs() <= bound, "{theta}: {a} {b}");
        }
        assert!((one_minus_cos_from_sin2(1.5) - 1.0).abs() <= f64::EPSILON);
    }

    #[test]
    fn directions_are_unit_at_the_corners_of_the_square() {
        let top = 1.0f32.next_down();
        let warps = [uniform_sphere, uniform_hemisphere, cosine_hemisphere];
        for u in [[0.0, 0.0], [top, 0.0], [0.0, top], [top, top], [0.5, 0.5]] {
            for warp in warps {
                assert!((warp(u).length() - 1.0).abs() <= 4.0 * f32::EPSILON, "{u:?}");
            }
        }
    }
}
