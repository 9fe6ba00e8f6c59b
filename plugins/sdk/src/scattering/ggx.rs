//! The microfacet distribution of Trowbridge & Reitz (GGX), single scattering, anisotropic.
//!
//! Heitz 2014, "Understanding the Masking-Shadowing Function". All in the frame of the surface with
//! both `wo.z` and the facet's normal above 0; masking is folded into fractions that stay finite at
//! grazing angles: with s(w) = √(z² + αx²x² + αy²y²) = |z|·(1 + 2Λ(w)).

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};

use crate::sampling::visible_normal;

/// Roughness below which a surface counts as smooth: a half vector of f32 unit vectors has slopes
/// good to 6e-8, 6e-4 of this.
pub const SMOOTH_ALPHA: f32 = 1e-4;

/// A rough surface made of tiny mirrors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ggx {
    /// Roughness along x and y: the slope within which half of the facets of a profile lie. At least
    /// [`SMOOTH_ALPHA`] for results with meaning, at least 1e-9 for finite ones.
    pub alpha: Vec2,
}

impl Ggx {
    /// Roughness `alpha`, stretched along x for `anisotropy` in (0, 1] and along y in [−1, 0).
    ///
    /// # Source
    /// Burley 2012, "Physically Based Shading at Disney", §5.4: aspect = √(1 − 0.9·|anisotropy|).
    pub fn anisotropic(alpha: f32, anisotropy: f32) -> Self {
        let aspect = (1.0 - 0.9 * anisotropy.abs()).sqrt();
        let (long, short) = (alpha / aspect, alpha * aspect);
        let alpha = if anisotropy < 0.0 { Vec2::new(short, long) } else { Vec2::new(long, short) };
        Self { alpha }
    }

    /// A facet's normal as seen from `wo` with `wo.z` ≥ 0; `u` in [0, 1)².
    pub fn sample(&self, wo: Vec3, u: [f32; 2]) -> Vec3 {
        visible_normal(wo, self.alpha, u)
    }

    /// Density of facets' normals, sr⁻¹: ∫ d·cos = 1. Zero below the horizon.
    pub fn d(&self, wm: Vec3) -> f32 {
        if !(wm.z > 0.0) {
            return 0.0;
        }
        let slope = wm.truncate() / self.alpha;
        let stretch = slope.length_squared() + wm.z * wm.z;
        FRAC_1_PI / (self.alpha.x * self.alpha.y * stretch * stretch)
    }

    /// Density of a facet normal `wm` as seen from `wo`, over `wo`·`wm`, sr⁻¹. For reflection
    /// divide by 4, for refraction multiply by its Jacobian and `wo`·`wm`.
    pub fn visible_over_cos(&self, wo: Vec3, wm: Vec3) -> f32 {
        2.0 * self.d(wm) / (wo.z + self.stretch(wo))
    }

    /// Height-correlated G₂ over `wo.z`; the sides of both directions do not matter.
    pub fn g2_over_cos_o(&self, wo: Vec3, wi: Vec3) -> f32 {
        let (cos_o, cos_i) = (wo.z.abs(), wi.z.abs());
        let both = self.stretch(wo) * cos_i + self.stretch(wi) * cos_o;
        if both > 0.0 { 2.0 * cos_i / both } else { 0.0 }
    }

    /// G₂ / G₁(`wo`): the weight, but for Fresnel, of a direction sampled by a visible normal; in
    /// [0, 1] to rounding.
    pub fn shadowing(&self, wo: Vec3, wi: Vec3) -> f32 {
        0.5 * self.g2_over_cos_o(wo, wi) * (wo.z.abs() + self.stretch(wo))
    }

    fn stretch(self, w: Vec3) -> f32 {
        Vec3::new(w.x * self.alpha.x, w.y * self.alpha.y, w.z).length()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kind::reflect;
    use crate::sampling::{Rng, visible_normal_pdf};

    #[test]
    fn single_scattering_albedo_is_what_the_truth_says() {
        // Truth ggx.albedo.single, E(mu, alpha).
        for (mu, alpha, expected) in [
            (1.0, 0.1, 0.9883051252671996),
            (0.5, 0.1, 0.9692049973876341),
            (1.0, 0.5, 0.6878478194062149),
            (0.5, 0.5, 0.6982507048982627),
            (0.1, 0.5, 0.860105092112108),
            (1.0, 1.0, 0.3068532701074484),
            (0.5, 1.0, 0.45069384572882115),
            (0.1, 1.0, 0.7602104609714451),
        ] {
            let ggx = Ggx::anisotropic(alpha, 0.0);
            let wo = Vec3::new((1.0f32 - mu * mu).sqrt(), 0.0, mu);
            let n = 256;
            let mut sum = 0.0;
            for i in 0..n * n {
                // A regular grid: the error is of the order of its step, and much less in the mean.
                let u = [(i / n) as f32 + 0.5, (i % n) as f32 + 0.5].map(|x| x / n as f32);
                let wm = ggx.sample(wo, u);
                let wi = 2.0 * wo.dot(wm) * wm - wo;
                sum += if wi.z > 0.0 { f64::from(ggx.shadowing(wo, wi)) } else { 0.0 };
            }
            let got = sum / f64::from(n * n);
            assert!((got / expected - 1.0).abs() < 1e-3, "{mu} {alpha}: {got} {expected}");
        }
    }

    #[test]
    fn densities_agree_with_those_of_sampling() {
        let ggx = Ggx::anisotropic(0.3, -0.7);
        let mut rng = Rng::new(5);
        for _ in 0..200 {
            let wo = crate::sampling::uniform_hemisphere(rng.pair());
            let wm = ggx.sample(wo, rng.pair());
            let expected = visible_normal_pdf(wo, wm, ggx.alpha);
            let got = ggx.visible_over_cos(wo, wm) * wo.dot(wm).max(0.0);
            assert!((got - expected).abs() <= 16.0 * f32::EPSILON * expected);
        }
    }

    #[test]
    fn grazing_directions_stay_finite() {
        for alpha in [SMOOTH_ALPHA, 0.1, 1.0] {
            let ggx = Ggx::anisotropic(alpha, 0.0);
            for z in [1e-6f32, 1e-20, 0.0] {
                let wo = Vec3::new(-1.0, 0.0, z);
                let wi = reflect(wo);
                let (g, s) = (ggx.g2_over_cos_o(wo, wi), ggx.shadowing(wo, wi));
                assert!(g.is_finite() && (0.0..=1.0 + 4.0 * f32::EPSILON).contains(&s), "{g} {s}");
            }
        }
    }
}
