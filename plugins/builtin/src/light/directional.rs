//! Parallel light.

use glam::DVec3;
use luxel_sdk::Params;
use luxel_sdk::kind::{Escaped, Light, LightForm, LightQuery, LightSample};
use luxel_sdk::params::{Emission, Fault};

use super::distant::{Patch, check_direction};

/// Light from far away, all in one direction, or spread over a small round patch of sky.
///
/// ```scene
/// light directional {
///   direction = (1, -2, -1), spectrum = illuminant("D65"), illuminance = 10 klx
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Directional {
    /// Where the light travels to, of any length.
    #[param(default = [0.0, -1.0, 0.0])]
    direction: DVec3,
    /// Full angle of the patch it comes from; 0 gives hard shadows, and no camera sees it.
    #[param(default = 0.0, unit = "rad", min = 0, max = std::f64::consts::PI)]
    angular_size: f64,
    /// Colour of the light; its amount is given apart: the irradiance of a surface that faces it.
    #[param(emission(illuminance, scale))]
    emission: Emission,
}

impl Directional {
    fn patch(&self) -> Patch {
        Patch { to: (-self.direction).normalize_or(DVec3::Y), angle: self.angular_size }
    }
}

impl Light for Directional {
    fn check(&self) -> Result<(), Fault> {
        check_direction(self.direction)
    }

    fn form(&self) -> LightForm {
        LightForm::Infinite
    }

    fn sample(&self, query: &LightQuery) -> Option<LightSample> {
        Some(self.patch().sample(query, &self.emission))
    }

    fn escaped(&self, d: DVec3) -> Escaped {
        self.patch().escaped(d, &self.emission)
    }

    fn power(&self, _area: f64, scene_radius: f64) -> f32 {
        self.patch().power(&self.emission, scene_radius)
    }
}
