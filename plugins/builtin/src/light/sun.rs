//! The sun's disk.

use glam::DVec3;
use luxel_sdk::Params;
use luxel_sdk::kind::{Escaped, Light, LightForm, LightQuery, LightSample};
use luxel_sdk::params::{Emission, Fault};

use super::distant::{Patch, check_direction};

/// The sun: an even disk in the sky, half a degree wide, with the soft shadows that go with it.
///
/// ```scene
/// light sun { direction = (1, 2, 1), spectrum = illuminant("D65"), illuminance = 80 klx }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Sun {
    /// Where the sun stands, seen from the scene; of any length.
    #[param(default = [0.0, 1.0, 0.0])]
    direction: DVec3,
    /// Full angle of the disk: 0.533 degrees seen from the earth.
    #[param(
        default = 0.533 * std::f64::consts::PI / 180.0, unit = "rad",
        min = 1e-9, max = std::f64::consts::PI
    )]
    angular_size: f64,
    /// Colour of the light; its amount is given apart: the irradiance of a surface that faces the
    /// sun, or the radiance of the disk.
    #[param(emission(illuminance, radiance, scale))]
    emission: Emission,
}

impl Sun {
    fn patch(&self) -> Patch {
        Patch { to: self.direction.normalize_or(DVec3::Y), angle: self.angular_size }
    }
}

impl Light for Sun {
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
