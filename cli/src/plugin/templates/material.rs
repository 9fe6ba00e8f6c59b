//! A material, to be made your own.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Material, Needs, Sample};
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
    /// surface, whose normal outside is +z: z < 0 is inside.
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
        Sample::of(wi, self.eval(wo, wi))
    }

    /// What is looked at. Add `.with(Needs::CHOICE)` if `sample` uses `u[2]`, as to choose between two
    /// lobes, and `.with(Needs::TANGENT)` if turning both directions about z changes `eval`.
    fn needs(&self) -> Needs {
        Needs::LIGHT
    }
}

luxel_sdk::plugin! { material "template_name" => TemplateName; }
