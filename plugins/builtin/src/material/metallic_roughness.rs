//! The material of glTF 2.0, made to keep energy.
//!
//! Specular part: GGX with Schlick's Fresnel (glTF 2.0, appendix B). The specification's diffuse
//! part reflects more light than arrives at grazing angles; in its place stands that of Ashikhmin &
//! Shirley 2000, eq. 5, which is reciprocal and leaves out what the coat reflects.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample};
use luxel_sdk::params::Maybe;
use luxel_sdk::sampling::cosine_hemisphere;
use luxel_sdk::scattering::{Ggx, SMOOTH_ALPHA, same_side};

use super::conductor::upright;

/// Reflectance of an index of 1.5 at normal incidence.
const F0: f32 = 0.04;

/// Plastic, paint, wood, metal: what glTF files describe. From 0 to 1, `metallic` goes from a coloured
/// body under a clear coat to bare metal of the same colour.
///
/// ```scene
/// let paint = material metallic_roughness {
///   base_color = rgb.linear_srgb(0.1, 0.2, 0.6), metallic = 0, roughness = 0.4
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct MetallicRoughness {
    /// Colour of the body, or of the metal's reflections.
    #[param(default = 1.0, role = reflectance, textured)]
    base_color: Spectrum,
    /// 0 for paint and plastic, 1 for metal.
    #[param(default = 1.0, min = 0, max = 1, textured)]
    metallic: f32,
    /// Perceived roughness: the square root of the GGX alpha.
    #[param(default = 1.0, min = 0, max = 1, textured)]
    roughness: f32,
    /// Opacity: where it is below 1, light passes straight through.
    #[param(default = 1.0, min = 0, max = 1, textured)]
    alpha: f32,
    /// Where given, `alpha` from here on is opaque and below nothing.
    #[param(optional, min = 0, max = 1)]
    alpha_cutoff: Maybe<f32>,
}

/// (1 − x)⁵, for x in [0, 1].
fn fifth(x: f32) -> f32 {
    let y = (1.0 - x).clamp(0.0, 1.0);
    let y2 = y * y;
    y2 * y2 * y
}

impl MetallicRoughness {
    fn facets(&self) -> Ggx {
        Ggx::anisotropic((self.roughness * self.roughness).max(SMOOTH_ALPHA), 0.0)
    }

    fn opacity(&self) -> f32 {
        match self.alpha_cutoff.get() {
            Some(cutoff) if self.alpha < cutoff => 0.0,
            Some(_) => 1.0,
            None => self.alpha,
        }
    }

    /// Schlick 1994.
    fn specular(&self, cos: f32) -> Spectrum {
        let f0 = self.base_color * self.metallic + F0 * (1.0 - self.metallic);
        f0 + (1.0 - f0) * fifth(cos)
    }

    /// f of the body.
    fn body(&self, cos_o: f32, cos_i: f32) -> Spectrum {
        let seen = (1.0 - fifth(0.5 * cos_o)) * (1.0 - fifth(0.5 * cos_i));
        let share = (1.0 - self.metallic) * (1.0 - F0) * seen * 28.0 / (23.0 * PI);
        self.base_color * share
    }

    /// Chance to sample the specular part: about its share of what is reflected. Never so small
    /// that the highlights of a dark coat are hardly found.
    fn chance(&self, cos_o: f32) -> f32 {
        let specular = self.specular(cos_o).max_element();
        let body = (1.0 - self.metallic) * self.base_color.max_element();
        let share = specular / (specular + body);
        if body > 0.0 { share.clamp(0.1, 0.9) } else { 1.0 }
    }

    /// Value and density without opacity; both directions above.
    fn eval_up(&self, wo: Vec3, wi: Vec3) -> Eval {
        let facets = self.facets();
        let wm = (wo + wi).normalize();
        let coat = self.specular(wo.dot(wm));
        let scale = 0.25 * facets.d(wm) * facets.g2_over_cos_o(wo, wi);
        let f = coat * scale + self.body(wo.z, wi.z) * wi.z;
        let chance = self.chance(wo.z);
        let pdf = 0.25 * facets.visible_over_cos(wo, wm) * chance;
        Eval { f, pdf: pdf + (1.0 - chance) * wi.z * FRAC_1_PI }
    }

    /// A direction above, for `wo` above.
    fn sample_up(&self, wo: Vec3, [u, v, choice]: [f32; 3]) -> Vec3 {
        if choice < self.chance(wo.z) {
            let wm = self.facets().sample(wo, [u, v]);
            return (2.0 * wo.dot(wm) * wm - wo).normalize();
        }
        cosine_hemisphere([u, v])
    }
}

impl Material for MetallicRoughness {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        if !same_side(wo, wi) {
            return Eval::ZERO;
        }
        let (wo, wi) = upright(wo, wi);
        let opacity = self.opacity();
        let Eval { f, pdf } = self.eval_up(wo, wi);
        Eval { f: f * opacity, pdf: pdf * opacity }
    }

    fn sample(&self, wo: Vec3, [u, v, choice]: [f32; 3]) -> Option<Sample> {
        if !(wo.z.abs() > 0.0) {
            return None;
        }
        let opacity = self.opacity();
        if choice >= opacity {
            let lobe = Lobe::DELTA.with(Lobe::TRANSMISSION);
            return Some(Sample { lobe, ..Sample::delta(-wo, Spectrum::ONE) });
        }
        let left = (choice / opacity).min(1.0f32.next_down());
        let (up, _) = upright(wo, wo);
        let wi = self.sample_up(up, [u, v, left]);
        if !(wi.z > 0.0) {
            return None;
        }
        let Eval { f, pdf } = self.eval_up(up, wi);
        let wi = if wo.z < 0.0 { -wi } else { wi };
        let sample = Sample { weight: f / pdf, wi, pdf: pdf * opacity, eta: 1.0, lobe: Lobe::NONE };
        (pdf > 0.0).then_some(sample)
    }

    fn needs(&self) -> Needs {
        if self.opacity() > 0.0 { Needs::LIGHT.with(Needs::CHOICE) } else { Needs::CHOICE }
    }
}

#[cfg(test)]
mod tests {
    use super::super::check::{check_all, stays_finite};
    use super::*;

    fn material(metallic: f32, roughness: f32, alpha: f32) -> MetallicRoughness {
        let base_color = Spectrum::ONE;
        MetallicRoughness { base_color, metallic, roughness, alpha, alpha_cutoff: Maybe::default() }
    }

    #[test]
    fn white_paint_and_white_metal_reflect_no_more_than_arrives() {
        for (metallic, roughness) in [(0.0, 0.35), (0.0, 1.0), (0.5, 0.6), (1.0, 0.4)] {
            check_all(&material(metallic, roughness, 1.0));
        }
        check_all(&material(0.3, 0.5, 0.4));
    }

    #[test]
    fn a_polished_coat_stays_finite() {
        for metallic in [0.0, 1.0] {
            stays_finite(&material(metallic, 0.0, 1.0));
            stays_finite(&material(metallic, 0.5, 0.0));
        }
    }

    #[test]
    fn light_passes_holes_unchanged() {
        let mut leaf = material(0.0, 0.5, 0.49);
        leaf.alpha_cutoff = Maybe { given: true, value: 0.5 };
        let wo = Vec3::new(0.6, 0.0, 0.8);
        let through = leaf.sample(wo, [0.5, 0.5, 0.0]).unwrap();
        assert_eq!((through.wi, through.weight.to_array()), (-wo, [1.0; 4]));
        assert!(
            !leaf.needs().has(Needs::LIGHT)
                && through.lobe.has(Lobe::DELTA.with(Lobe::TRANSMISSION))
        );
        leaf.alpha = 0.5;
        assert!(!leaf.sample(wo, [0.5, 0.5, 1.0f32.next_down()]).unwrap().lobe.has(Lobe::DELTA));
    }
}
