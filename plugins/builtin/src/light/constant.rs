//! A sky that is the same everywhere.

use std::f32::consts::PI;

use glam::DVec3;
use luxel_sdk::Params;
use luxel_sdk::kind::{Escaped, Light, LightForm, LightQuery, LightSample};
use luxel_sdk::params::Emission;
use luxel_sdk::sampling::{SPHERE_PDF, uniform_sphere};

/// Even light from everywhere: an overcast world, or the white furnace that tests materials. It is met by
/// what surfaces scatter, and looked for only in scenes with media.
///
/// ```scene
/// light constant { spectrum = illuminant("D65"), radiance = 1 W/m^2/sr }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Constant {
    /// Colour of the light; its amount is given apart.
    #[param(emission(radiance, scale))]
    emission: Emission,
}

impl Light for Constant {
    fn form(&self) -> LightForm {
        LightForm::Everywhere
    }

    fn sample(&self, query: &LightQuery) -> Option<LightSample> {
        let wi = uniform_sphere(query.u).as_dvec3().normalize();
        let (le, distance) = (self.emission.spectrum, f64::INFINITY);
        Some(LightSample { le, wi, distance, pdf: SPHERE_PDF, delta: false })
    }

    fn escaped(&self, _d: DVec3) -> Escaped {
        Escaped { le: self.emission.spectrum, pdf: SPHERE_PDF }
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounds; only guides sampling")]
    fn power(&self, _area: f64, scene_radius: f64) -> f32 {
        let radius = scene_radius as f32;
        4.0 * PI * PI * radius * radius * self.emission.spectrum.mean()
    }
}
