//! Metals, smooth and rough.

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample, reflect};
use luxel_sdk::params::ComplexIor;
use luxel_sdk::scattering::{Ggx, SMOOTH_ALPHA, conductor_reflectance, same_side};

/// A metal. Its colour follows from its measured index of refraction; brushed metals have
/// `anisotropy`. Both sides reflect.
///
/// ```scene
/// let gold = material conductor { eta = metal("Au"), roughness = 0.1 }
/// ```
///
/// Light that bounces between the facets of a rough surface is left out: at roughness 1 up to half
/// of it.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Conductor {
    /// Index of refraction: `metal("Au")`, or a number or curve with its extinction `k`.
    #[param(required, role = complex_ior, textured)]
    pub(crate) eta: ComplexIor,
    /// GGX roughness alpha; below 1e-4 a perfect mirror.
    #[param(default = 0.0, min = 0, max = 1, textured)]
    pub(crate) roughness: f32,
    /// How much highlights are stretched: along dp/du for 1, along dp/dv for −1.
    #[param(default = 0.0, min = -1, max = 1, textured)]
    pub(crate) anisotropy: f32,
}

impl Conductor {
    fn is_smooth(&self) -> bool {
        self.roughness < SMOOTH_ALPHA
    }

    fn reflectance(&self, cos: f32) -> Spectrum {
        conductor_reflectance(cos, self.eta.eta, self.eta.k)
    }
}

impl Material for Conductor {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        if self.is_smooth() || !same_side(wo, wi) {
            return Eval::ZERO;
        }
        let facets = Ggx::anisotropic(self.roughness, self.anisotropy);
        let (wo, wi) = upright(wo, wi);
        let wm = (wo + wi).normalize();
        // f·cos = F·D·G₂/(4·cos_o).
        let reflected = self.reflectance(wo.dot(wm));
        let f = reflected * (0.25 * facets.d(wm) * facets.g2_over_cos_o(wo, wi));
        Eval { f, pdf: 0.25 * facets.visible_over_cos(wo, wm) }
    }

    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        if !(wo.z.abs() > 0.0) {
            return None;
        }
        if self.is_smooth() {
            return Some(Sample::delta(reflect(wo), self.reflectance(wo.z.abs())));
        }
        let facets = Ggx::anisotropic(self.roughness, self.anisotropy);
        let (up, _) = upright(wo, wo);
        let wm = facets.sample(up, [u[0], u[1]]);
        let cos = up.dot(wm);
        let wi = (2.0 * cos * wm - up).normalize();
        if !(cos > 0.0 && wi.z > 0.0) {
            return None;
        }
        let weight = self.reflectance(cos) * facets.shadowing(up, wi);
        let pdf = 0.25 * facets.visible_over_cos(up, wm);
        let wi = if wo.z < 0.0 { -wi } else { wi };
        Some(Sample { weight, wi, pdf, eta: 1.0, lobe: Lobe::NONE })
    }

    fn needs(&self) -> Needs {
        match (self.is_smooth(), self.anisotropy == 0.0) {
            (true, _) => Needs::NOTHING,
            (false, true) => Needs::LIGHT,
            (false, false) => Needs::LIGHT.with(Needs::TANGENT),
        }
    }
}

/// Both directions turned by half a turn about the origin where `wo` is below the surface, so that
/// `wo` is above.
pub(crate) fn upright(wo: Vec3, wi: Vec3) -> (Vec3, Vec3) {
    if wo.z < 0.0 { (-wo, -wi) } else { (wo, wi) }
}

#[cfg(test)]
mod tests {
    use super::super::check::{self, check_all};
    use super::*;

    fn metal(roughness: f32, anisotropy: f32) -> Conductor {
        let eta = ComplexIor { eta: Spectrum::splat(0.18), k: Spectrum::new(3.42, 1.0, 0.1, 9.0) };
        Conductor { eta, roughness, anisotropy }
    }

    #[test]
    fn rough_metals_scatter_as_they_claim() {
        for (roughness, anisotropy) in [(0.1, 0.0), (0.5, 0.8), (1.0, 0.0), (0.3, -1.0)] {
            check_all(&metal(roughness, anisotropy));
        }
    }

    #[test]
    fn metals_keep_their_energy_at_grazing_angles() {
        for roughness in [0.0, 1e-4, 0.01, 1.0] {
            check::stays_finite(&metal(roughness, 0.9));
        }
    }

    #[test]
    fn a_mirror_reflects_what_the_truth_says() {
        // Truth fresnel.conductor at 60 degrees; 30 f32 roundings.
        let wo = Vec3::new(0.75f32.sqrt(), 0.0, 0.5);
        let sample = metal(0.0, 0.0).sample(wo, [0.5; 3]).unwrap();
        assert!((sample.weight.lane(0) / 0.939_539_83 - 1.0).abs() < 2e-6);
        assert!(sample.lobe.has(Lobe::DELTA) && metal(0.0, 0.0).eval(wo, sample.wi) == Eval::ZERO);
    }
}
