//! A light, to be made your own.

use std::f32::consts::PI;

use glam::DVec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Light, LightForm, LightQuery, LightSample};
use luxel_sdk::params::{Emission, Quantity};

/// A point that shines alike in all directions.
///
/// ```scene
/// light template_name { position = (0, 2, 0) m, spectrum = blackbody(2700 K), power = 800 lm }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct TemplateName {
    /// Where it is.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    position: DVec3,
    /// Colour of the light; its amount is given apart, as `intensity`, `power` or `scale`.
    #[param(emission(intensity, power, scale))]
    emission: Emission,
}

impl TemplateName {
    /// Radiant intensity, W/sr.
    fn intensity(&self) -> Spectrum {
        match self.emission.quantity {
            Quantity::Power => self.emission.spectrum / (4.0 * PI),
            _ => self.emission.spectrum,
        }
    }
}

impl Light for TemplateName {
    fn form(&self) -> LightForm {
        LightForm::Point
    }

    /// The irradiance at a point that faces the light; none where it would overflow.
    fn sample(&self, query: &LightQuery) -> Option<LightSample> {
        let to = self.position - query.p;
        let distance = to.length();
        let wi = to / distance;
        let le = self.intensity() * (distance * distance).recip() as f32;
        let lit = le.is_finite() && wi.is_finite() && !le.is_black();
        lit.then_some(LightSample { le, wi, distance, pdf: 1.0, delta: true })
    }

    fn power(&self, _area: f64, _scene_radius: f64) -> f32 {
        4.0 * PI * self.intensity().mean()
    }
}

luxel_sdk::plugin! { light "template_name" => TemplateName; }
