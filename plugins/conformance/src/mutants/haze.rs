//! Lobes and coloured fog with a fault.

use std::f32::consts::TAU;

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, FreeFlight, Lobe, Medium, Phase, PhaseRef, Sample, Samples};
use luxel_sdk::num::{Frame, Ray};
use luxel_sdk::params::Maybe;
use luxel_sdk::sampling::SPHERE_PDF;

use super::Mutant;

/// The phase function of Henyey & Greenstein, `cos` to the way ahead.
fn lobe(g: f32, cos: f32) -> f32 {
    let base = 1.0 + g * g - 2.0 * g * cos;
    SPHERE_PDF * (1.0 - g * g) / (base * base.sqrt())
}

/// Inverts the distribution of cosines.
fn cosine(g: f32, u: f32) -> f32 {
    if g.abs() < 1e-3 {
        return 2.0 * u - 1.0;
    }
    let part = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
    ((1.0 + g * g - part * part) / (2.0 * g)).clamp(-1.0, 1.0)
}

/// A lobe evaluated with one `g` and sampled with another.
macro_rules! haze {
    ($name:ident, $eval:expr, $sample:expr) => {
        /// Haze with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Mean cosine of the angle by which light is turned.
            #[param(default = 0.3, min = -0.95, max = 0.95, textured)]
            g: f32,
        }

        impl Phase for $name {
            fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
                let change: fn(f32) -> f32 = $eval;
                let pdf = lobe(change(self.g), -wo.dot(wi));
                Eval { f: Spectrum::splat(pdf), pdf }
            }

            fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<Sample> {
                let change: fn(f32) -> f32 = $sample;
                let cos = cosine(change(self.g), u[0]);
                let r = ((1.0 - cos) * (1.0 + cos)).sqrt();
                let (y, x) = (TAU * u[1]).sin_cos();
                let wi = Frame::from_z(-wo).to_world(Vec3::new(r * x, r * y, cos)).normalize();
                let pdf = self.eval(wo, wi).pdf;
                Some(Sample { weight: Spectrum::ONE, wi, pdf, eta: 1.0, lobe: Lobe::NONE })
            }
        }
    };
}

haze!(SoundHaze, |g| g, |g| g);
haze!(Backwards, |g| -g, |g| g);
haze!(BluntLobe, |g| g, |g| g.clamp(-0.9, 0.9));
haze!(NearlyEven, |g| g, |g| if g.abs() < 0.1 { 0.0 } else { g });

/// Coloured fog that chooses among the first few lanes, and what passes for a product of 0 and
/// infinity.
macro_rules! fog {
    ($name:ident, $lanes:expr, $vacuum:expr) => {
        /// Fog with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name<'a> {
            /// Extinction.
            #[param(default = 1.0, unit = "1/m", role = coefficient)]
            sigma_t: Spectrum,
            /// Share of extinction that is scattering.
            #[param(default = 0.5, role = reflectance)]
            albedo: Spectrum,
            /// Where scattered light goes.
            #[param(optional)]
            phase: PhaseRef<'a>,
        }

        impl Medium for $name<'_> {
            fn sample(&self, ray: &Ray, samples: &mut Samples<'_>) -> FreeFlight {
                let [choice, u] = samples.next_2d();
                #[expect(clippy::cast_possible_truncation, reason = "in [0, 4)")]
                #[expect(clippy::cast_sign_loss, reason = "in [0, 4)")]
                let lane = (choice * $lanes) as usize & 3;
                let t = -(1.0 - f64::from(u)).ln() / f64::from(self.sigma_t.lane(lane));
                if !(t < ray.t_max) {
                    let passed = passed(self.sigma_t, ray.t_max, $vacuum);
                    return FreeFlight { t: Maybe::default(), weight: passed / passed.mean() };
                }
                let left = passed(self.sigma_t, t, $vacuum);
                let weight = self.sigma_t * self.albedo * left / (self.sigma_t * left).mean();
                FreeFlight { t: Maybe::some(t), weight }
            }

            fn transmittance(&self, ray: &Ray, _samples: &mut Samples<'_>) -> Spectrum {
                passed(self.sigma_t, ray.t_max, $vacuum)
            }

            fn phase(&self) -> PhaseRef<'_> {
                self.phase
            }
        }
    };
}

/// What passes through a length; `vacuum` where there is nothing, without end.
#[expect(clippy::cast_possible_truncation, reason = "rounds; a fraction")]
fn passed(sigma: Spectrum, t: f64, vacuum: f32) -> Spectrum {
    let lane = |sigma: f32| {
        let depth = f64::from(sigma) * t;
        if depth.is_nan() { vacuum } else { (-depth).exp() as f32 }
    };
    Spectrum::from_array(sigma.to_array().map(lane))
}

fog!(SoundFog, 4.0, 1.0);
fog!(ThreeLanes, 3.0, 1.0);
fog!(DarkVacuum, 4.0, f32::NAN);

/// The same without a fault.
#[cfg(test)]
pub(super) const SOUND: &[Class] =
    &[Class::phase::<SoundHaze>("sound_haze"), Class::medium::<SoundFog<'static>>("sound_fog")];

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant { class: Class::phase::<Backwards>("backwards"), fault: "eval turns g about" },
    Mutant { class: Class::phase::<BluntLobe>("blunt_lobe"), fault: "samples g of at most 0.9" },
    Mutant {
        class: Class::medium::<ThreeLanes<'static>>("three_lanes"),
        fault: "the fourth lane is never chosen",
    },
    Mutant { class: Class::phase::<NearlyEven>("nearly_even"), fault: "samples |g| < 0.1 as 0" },
    Mutant {
        class: Class::medium::<DarkVacuum<'static>>("dark_vacuum"),
        fault: "NaN where nothing is, without end",
    },
];
