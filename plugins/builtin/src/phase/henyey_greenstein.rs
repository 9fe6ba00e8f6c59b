//! Forward or backward scattering by one number.

use std::f32::consts::TAU;

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Phase, Sample};
use luxel_sdk::num::Frame;
use luxel_sdk::sampling::SPHERE_PDF;

/// Haze, milk, skin: scatters mostly ahead for `g` above 0, mostly back below (Henyey & Greenstein
/// 1941).
///
/// ```scene
/// let fog = medium homogeneous {
///   sigma_t = 1 / (12 m), albedo = 0.98, phase = phase henyey_greenstein { g = 0.65 }
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct HenyeyGreenstein {
    /// Mean cosine of the angle by which light is turned. 0 is isotropic.
    #[param(default = 0.0, min = -0.999, max = 0.999, textured)]
    g: f32,
}

impl HenyeyGreenstein {
    /// The phase function where 1 − cos of the angle to the middle of the lobe is `versine` in
    /// [0, 2]: nothing cancels for lobes as narrow as you like. PBR4 §11.3.1.
    fn value(self, versine: f32) -> f32 {
        let g = self.g.abs();
        let base = (1.0 - g) * (1.0 - g) + 2.0 * g * versine;
        SPHERE_PDF * (1.0 - g) * (1.0 + g) / (base * base.sqrt())
    }

    /// The middle of the lobe: ahead, or back for `g` below 0.
    fn middle(self, wo: Vec3) -> Vec3 {
        if self.g < 0.0 { wo } else { -wo }
    }
}

impl Phase for HenyeyGreenstein {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        // 1 − cos is |wi − middle|²/2.
        let pdf = self.value(0.5 * (wi - self.middle(wo)).length_squared());
        if pdf.is_finite() { Eval { f: Spectrum::splat(pdf), pdf } } else { Eval::ZERO }
    }

    /// Inverts the distribution of cosines to the lobe's middle for 1 − cos, without the division
    /// by `g`, here its magnitude: (1 − g)²(1 − u)(2 + g + gξ)/(1 + gξ)² with ξ = 2u − 1.
    fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<Sample> {
        let g = self.g.abs();
        let turned = 1.0 + g * (2.0 * u[0] - 1.0);
        let versine = (1.0 - g) * (1.0 - g) * (1.0 - u[0]) * (1.0 + g + turned) / (turned * turned);
        let versine = versine.clamp(0.0, 2.0);
        let sin_theta = (versine * (2.0 - versine)).sqrt();
        let (sin, cos) = (TAU * u[1]).sin_cos();
        let around = Frame::from_z(self.middle(wo));
        let wi = around.to_world(Vec3::new(sin_theta * cos, sin_theta * sin, 1.0 - versine));
        let wi = wi.normalize();
        let pdf = self.value(versine);
        let sample = Sample { weight: Spectrum::ONE, wi, pdf, eta: 1.0, lobe: Lobe::NONE };
        (wi.is_finite() && pdf > 0.0).then_some(sample)
    }
}

#[cfg(test)]
mod tests {
    use luxel_sdk::sampling::Rng;

    use super::*;

    #[test]
    fn values_are_what_the_truth_says() {
        // Truth phase.hg: g = .7 at 0, 90 and 180 degrees; a dozen f32 roundings.
        let haze = HenyeyGreenstein { g: 0.7 };
        for (wi, expected) in [
            (Vec3::NEG_Z, 1.5031300180901208),
            (Vec3::X, 0.02231417883943917),
            (Vec3::Z, 0.008260637184700452),
        ] {
            let got = f64::from(haze.eval(Vec3::Z, wi).pdf);
            assert!((got / expected - 1.0).abs() < 1e-6, "{got} {expected}");
        }
    }

    #[test]
    fn the_mean_cosine_is_g_and_samples_carry_their_density() {
        for g in [-0.999, -0.6, -1e-7, 0.0, 1e-4, 0.3, 0.9, 0.999] {
            let phase = HenyeyGreenstein { g };
            let wo = Vec3::new(0.48, -0.6, 0.64);
            let mut rng = Rng::new(8);
            let n = 20_000;
            let mut mean = 0.0;
            for _ in 0..n {
                let sample = phase.sample(wo, rng.pair()).unwrap();
                let eval = phase.eval(wo, sample.wi);
                // 1 − cos of f32 directions is good to 6e-8·|wo + wi| + 1e-14 beside (1 − g)².
                assert!((eval.pdf / sample.pdf - 1.0).abs() < 2e-3, "{g} {eval:?} {sample:?}");
                mean += f64::from(-wo.dot(sample.wi)) / f64::from(n);
            }
            // The cosine's variance is at most (1 − g²); five standard errors, and rounding of g.
            let g = f64::from(g);
            let error = 5.0 * ((1.0 - g * g) / f64::from(n)).sqrt();
            assert!((mean - g).abs() < error + 1e-6, "{g} {mean}");
        }
    }

    #[test]
    fn the_narrowest_lobes_integrate_to_one() {
        for g in [-0.999, 0.5, 0.999] {
            let phase = HenyeyGreenstein { g };
            // Substituting 1 − cos = 2s⁴ crowds the midpoint rule at the peak.
            let n = 2000u16;
            let sum: f64 = (0..n)
                .map(|i| {
                    let s = (f64::from(i) + 0.5) / f64::from(n);
                    #[expect(clippy::cast_possible_truncation, reason = "test input")]
                    let x = (2.0 * s.powi(4)) as f32;
                    f64::from(phase.value(x)) * f64::from(TAU) * 8.0 * s.powi(3) / f64::from(n)
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-5, "{g} {sum}");
        }
    }
}
