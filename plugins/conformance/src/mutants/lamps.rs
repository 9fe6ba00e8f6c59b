//! Bulbs and panels with a fault.

use std::f32::consts::PI;

use glam::{DVec3, Vec2};
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Light, LightForm, LightQuery, LightSample};
use luxel_sdk::params::{Emission, Quantity, ShapeSlot};

use super::Mutant;

/// A bulb whose irradiance is a function of the squared distance.
macro_rules! bulb {
    ($name:ident, $square:expr) => {
        /// A bulb with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Where it is.
            #[param(default = [0.0, 0.0, 0.0], unit = "m")]
            position: DVec3,
            /// Its light.
            #[param(emission(intensity, power, scale))]
            emission: Emission,
        }

        impl $name {
            fn intensity(&self) -> Spectrum {
                let all = if self.emission.quantity == Quantity::Power { 4.0 * PI } else { 1.0 };
                self.emission.spectrum / all
            }
        }

        impl Light for $name {
            fn form(&self) -> LightForm {
                LightForm::Point
            }

            #[expect(clippy::cast_possible_truncation, reason = "rounds; irradiance is f32")]
            fn sample(&self, query: &LightQuery) -> Option<LightSample> {
                let square: fn(f64) -> f64 = $square;
                let to = self.position - query.p;
                let distance = to.length();
                let le = self.intensity() / square(distance * distance) as f32;
                let wi = to / distance;
                let lit = le.is_finite() && wi.is_finite() && !le.is_black();
                lit.then_some(LightSample { le, wi, distance, pdf: 1.0, delta: true })
            }

            fn power(&self, _area: f64, _scene_radius: f64) -> f32 {
                4.0 * PI * self.intensity().mean()
            }
        }
    };
}

bulb!(SoundBulb, |d2| d2);
// Against bright spots on the wall beside it.
bulb!(Softened, |d2| d2.max(0.25));

/// A panel that shines to both sides, of an area per unit of the shape's.
macro_rules! panel {
    ($name:ident, $sides:expr) => {
        /// A panel with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// What shines.
            #[param(required)]
            shape: ShapeSlot,
            /// Its light.
            #[param(emission(radiance, power, scale))]
            emission: Emission,
            /// Whether the back shines too.
            #[param(default = false)]
            two_sided: bool,
        }

        impl Light for $name {
            fn form(&self) -> LightForm {
                LightForm::Surface
            }

            #[expect(clippy::cast_possible_truncation, reason = "rounds; radiance is f32")]
            fn le(&self, cos_o: f32, _uv: Vec2, area: f64) -> Spectrum {
                let shines = cos_o > 0.0 || (self.two_sided && cos_o < 0.0);
                let sides = if self.two_sided { $sides } else { 1.0 };
                match self.emission.quantity {
                    Quantity::Power if !shines || area <= 0.0 => Spectrum::ZERO,
                    Quantity::Power => self.emission.spectrum / (PI * area as f32 * sides),
                    _ if shines => self.emission.spectrum,
                    _ => Spectrum::ZERO,
                }
            }

            #[expect(clippy::cast_possible_truncation, reason = "rounds; only guides sampling")]
            fn power(&self, area: f64, _scene_radius: f64) -> f32 {
                let sides = if self.two_sided { 2.0 } else { 1.0 };
                self.le(1.0, Vec2::ZERO, area).mean() * PI * area as f32 * sides
            }
        }
    };
}

panel!(SoundPanel, 2.0);
panel!(TwiceThePower, 1.0);

/// The same without a fault.
#[cfg(test)]
pub(super) const SOUND: &[Class] =
    &[Class::light::<SoundBulb>("sound_bulb"), Class::light::<SoundPanel>("sound_panel")];

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant { class: Class::light::<Softened>("softened"), fault: "dimmed nearer than 50 cm" },
    Mutant {
        class: Class::light::<TwiceThePower>("twice_the_power"),
        fault: "both sides share no power",
    },
];
