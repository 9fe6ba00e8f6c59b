//! A sky and a lamp.

use std::f32::consts::PI;

use glam::{DVec3, Vec2};
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Escaped, Light, LightForm, LightQuery, LightSample};
use luxel_sdk::params::{Emission, Quantity, ShapeSlot};
use luxel_sdk::sampling::{SPHERE_PDF, uniform_sphere};

/// The same light from everywhere.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Sky {
    /// Its radiance.
    #[param(emission(radiance, scale))]
    pub(crate) emission: Emission,
}

impl Light for Sky {
    fn form(&self) -> LightForm {
        LightForm::Infinite
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

/// A shape that shines to one side.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Lamp {
    /// What shines.
    #[param(required)]
    pub(crate) shape: ShapeSlot,
    /// Its light.
    #[param(emission(radiance, power, scale))]
    pub(crate) emission: Emission,
    /// Whether it shines to its inside instead of its outside.
    #[param(default = false)]
    pub(crate) inside: bool,
}

impl Lamp {
    #[expect(clippy::cast_possible_truncation, reason = "rounds; radiance is f32")]
    fn radiance(&self, area: f64) -> Spectrum {
        match self.emission.quantity {
            Quantity::Power if !(area > 0.0) => Spectrum::ZERO,
            Quantity::Power => self.emission.spectrum / (PI * area as f32),
            _ => self.emission.spectrum,
        }
    }
}

impl Light for Lamp {
    fn form(&self) -> LightForm {
        LightForm::Surface
    }

    fn le(&self, cos_o: f32, _uv: Vec2, area: f64) -> Spectrum {
        let facing = if self.inside { -cos_o } else { cos_o };
        if facing > 0.0 { self.radiance(area) } else { Spectrum::ZERO }
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounds; only guides sampling")]
    fn power(&self, area: f64, _scene_radius: f64) -> f32 {
        self.radiance(area).mean() * PI * area as f32
    }
}
