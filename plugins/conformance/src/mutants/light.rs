//! Skies and lamps with a fault.

use std::f32::consts::PI;

use glam::{DVec3, Vec2};
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Escaped, Light, LightForm, LightQuery, LightSample};
use luxel_sdk::params::{Emission, Quantity, ShapeSlot};

use super::Mutant;
use crate::reference::{Lamp, Sky};

/// A sky whose samples and whose view by rays pass through two functions.
macro_rules! sky {
    ($name:ident, $sample:expr, $escaped:expr) => {
        /// A sky with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Its radiance.
            #[param(emission(radiance, scale))]
            emission: Emission,
        }

        impl Light for $name {
            fn form(&self) -> LightForm {
                LightForm::Infinite
            }

            fn sample(&self, query: &LightQuery) -> Option<LightSample> {
                let change: fn(LightSample) -> LightSample = $sample;
                Sky { emission: self.emission }.sample(query).map(change)
            }

            fn escaped(&self, d: DVec3) -> Escaped {
                let change: fn(Escaped) -> Escaped = $escaped;
                change(Sky { emission: self.emission }.escaped(d))
            }

            fn power(&self, area: f64, scene_radius: f64) -> f32 {
                Sky { emission: self.emission }.power(area, scene_radius)
            }
        }
    };
}

sky!(HalfSphere, |s| LightSample { pdf: 2.0 * s.pdf, ..s }, |e| Escaped { pdf: 2.0 * e.pdf, ..e });
sky!(TwoTruths, |s| LightSample { le: s.le * 1.1, ..s }, |e| e);

/// A lamp that forgets that light leaves in all directions.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Beam {
    /// What shines.
    #[param(required)]
    shape: ShapeSlot,
    /// Its light.
    #[param(emission(radiance, power, scale))]
    emission: Emission,
}

impl Beam {
    fn lamp(&self) -> Lamp {
        Lamp { shape: self.shape, emission: self.emission, inside: false }
    }
}

impl Light for Beam {
    fn form(&self) -> LightForm {
        LightForm::Surface
    }

    fn le(&self, cos_o: f32, uv: Vec2, area: f64) -> Spectrum {
        let le = self.lamp().le(cos_o, uv, area);
        if self.emission.quantity == Quantity::Power { le * PI } else { le }
    }

    fn power(&self, area: f64, scene_radius: f64) -> f32 {
        self.lamp().power(area, scene_radius)
    }
}

/// A lamp that nobody can give a shape.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Shapeless {
    /// Its light.
    #[param(emission(radiance, power, scale))]
    emission: Emission,
}

impl Shapeless {
    fn lamp(&self) -> Lamp {
        Lamp { shape: ShapeSlot::default(), emission: self.emission, inside: false }
    }
}

impl Light for Shapeless {
    fn form(&self) -> LightForm {
        LightForm::Surface
    }

    fn le(&self, cos_o: f32, uv: Vec2, area: f64) -> Spectrum {
        self.lamp().le(cos_o, uv, area)
    }

    fn power(&self, area: f64, scene_radius: f64) -> f32 {
        self.lamp().power(area, scene_radius)
    }
}

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant { class: Class::light::<HalfSphere>("half_sphere"), fault: "pdf of a half sphere" },
    Mutant { class: Class::light::<TwoTruths>("two_truths"), fault: "samples brighter than rays" },
    Mutant { class: Class::light::<Beam>("beam"), fault: "power over area without π" },
    Mutant { class: Class::light::<Shapeless>("shapeless"), fault: "shines from no shape" },
];
