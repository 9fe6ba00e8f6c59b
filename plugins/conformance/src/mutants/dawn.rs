//! Skies at dawn with a fault.

use std::f32::consts::PI;

use glam::DVec3;
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Escaped, Light, LightForm, LightQuery, LightSample};
use luxel_sdk::params::Emission;
use luxel_sdk::sampling::{SPHERE_PDF, uniform_sphere};

use super::Mutant;

/// A sky that is brighter towards the east, as samples and as rays find it.
macro_rules! dawn {
    ($name:ident, $seen:expr, $lowest:expr) => {
        /// A sky at dawn with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Its light.
            #[param(emission(radiance, scale))]
            emission: Emission,
        }

        impl $name {
            #[expect(clippy::cast_possible_truncation, reason = "rounds; radiance is f32")]
            fn le(&self, d: DVec3) -> Spectrum {
                self.emission.spectrum * (1.0 + 0.5 * d.x) as f32
            }
        }

        impl Light for $name {
            fn form(&self) -> LightForm {
                LightForm::Infinite
            }

            fn sample(&self, query: &LightQuery) -> Option<LightSample> {
                let wi = uniform_sphere(query.u).as_dvec3().normalize();
                let (le, distance) = (self.le(wi), f64::INFINITY);
                let sample = LightSample { le, wi, distance, pdf: SPHERE_PDF, delta: false };
                (wi.y >= $lowest).then_some(sample)
            }

            fn escaped(&self, d: DVec3) -> Escaped {
                let seen: fn(DVec3) -> DVec3 = $seen;
                Escaped { le: self.le(seen(d)), pdf: SPHERE_PDF }
            }

            #[expect(clippy::cast_possible_truncation, reason = "rounds; only guides sampling")]
            fn power(&self, _area: f64, scene_radius: f64) -> f32 {
                let radius = scene_radius as f32;
                4.0 * PI * PI * radius * radius * self.emission.spectrum.mean()
            }
        }
    };
}

dawn!(Sound, |d| d, -2.0);
dawn!(MirroredDawn, |d| DVec3::new(-d.x, d.y, d.z), -2.0);
dawn!(NoNadir, |d| d, -0.9);

/// The same without a fault.
#[cfg(test)]
pub(super) const SOUND: Class = Class::light::<Sound>("sound_dawn");

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant {
        class: Class::light::<MirroredDawn>("mirrored_dawn"),
        fault: "rays see it mirrored in x",
    },
    Mutant {
        class: Class::light::<NoNadir>("no_nadir"),
        fault: "a cap of 5 % of the sphere is never sampled",
    },
];
