//! A material, to be made your own.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample};
use luxel_sdk::sampling::cosine_hemisphere;
use luxel_sdk::scattering::same_side;

/// A matt surface, equally bright from everywhere.
///
/// ```scene
/// let paint = material template_name { reflectance = 0.7 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct TemplateName {
    /// Fraction of light reflected.
    #[param(default = 0.5, role = reflectance, textured)]
    reflectance: Spectrum,
}

impl Material for TemplateName {
    /// f·|cos| and the density of `sample`, per steradian. Both directions point away from the
    /// surface, whose normal is +z.
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        if same_side(wo, wi) {
            let pdf = wi.z.abs() * FRAC_1_PI;
            return Eval { f: self.reflectance * pdf, pdf };
        }
        Eval::ZERO
    }

    /// A direction to where light may come from, chosen with the density that `eval` states.
    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        let up = cosine_hemisphere([u[0], u[1]]);
        let wi = Vec3::new(up.x, up.y, up.z.copysign(wo.z));
        let possible = wo.z != 0.0 && up.z > 0.0 && !wo.z.is_nan();
        possible.then_some(Sample {
            weight: self.reflectance,
            wi,
            pdf: up.z * FRAC_1_PI,
            eta: 1.0,
            lobe: Lobe::NONE,
        })
    }

    /// Neither the third number nor the direction of dp/du is looked at.
    fn needs(&self) -> Needs {
        Needs::LIGHT
    }
}

luxel_sdk::plugin! { material "template_name" => TemplateName; }
