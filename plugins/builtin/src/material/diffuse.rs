//! Lambert's cosine law.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample};
use luxel_sdk::sampling::cosine_hemisphere;
use luxel_sdk::scattering::same_side;

/// A matt surface: chalk, plaster, paper. It looks equally bright from everywhere, and both of its
/// sides reflect.
///
/// ```scene
/// let red = material diffuse { reflectance = rgb.linear_srgb(0.63, 0.06, 0.05) }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Diffuse {
    /// Fraction of light reflected.
    #[param(default = 0.5, role = reflectance, textured)]
    pub(crate) reflectance: Spectrum,
}

impl Material for Diffuse {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        if same_side(wo, wi) {
            let pdf = wi.z.abs() * FRAC_1_PI;
            return Eval { f: self.reflectance * pdf, pdf };
        }
        Eval::ZERO
    }

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

    fn needs(&self) -> Needs {
        Needs::LIGHT
    }
}

#[cfg(test)]
mod tests {
    use super::super::check::{Side, check_all, scatters_as_it_claims};
    use super::*;

    #[test]
    fn a_matt_surface_scatters_as_it_claims_on_both_sides() {
        let white = Diffuse { reflectance: Spectrum::ONE };
        check_all(&white);
        scatters_as_it_claims(&white, Side::Inside);
    }
}
