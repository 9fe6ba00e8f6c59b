//! Textures, a phase function and a medium with a fault.

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Eval, FreeFlight, Medium, Phase, PhaseRef, Sample, Samples, Texture, TexturePoint,
};
use luxel_sdk::num::Ray;

use super::Mutant;
use crate::reference::{Even, Fog, Gradient};

/// A gradient whose value passes through a function.
macro_rules! gradient {
    ($name:ident, $value:expr) => {
        /// A gradient with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// Where u is whole.
            #[param(default = 0.2, textured)]
            from: Spectrum,
            /// Just before the next whole number.
            #[param(default = 0.8, textured)]
            to: Spectrum,
        }

        impl Texture for $name {
            fn eval(&self, at: &TexturePoint) -> Spectrum {
                let change: fn(Spectrum, &TexturePoint) -> Spectrum = $value;
                change(Gradient { from: self.from, to: self.to }.eval(at), at)
            }
        }
    };
}

gradient!(NanBelowZero, |value, at| if at.uv.y < 0.0 { value * at.uv.y.sqrt() } else { value });
gradient!(Overshoot, |value, _| value * 1.05);

/// Scatters a little more than arrives.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Brighter {}

impl Phase for Brighter {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        let eval = Even {}.eval(wo, wi);
        Eval { f: eval.f * 1.03, ..eval }
    }

    fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<Sample> {
        let sample = Even {}.sample(wo, u)?;
        Some(Sample { weight: sample.weight * 1.03, ..sample })
    }
}

/// Fog that forgets to absorb.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Lossless<'a> {
    /// Inverse of the mean free path.
    #[param(default = 1.0, unit = "1/m", min = 0, max = 1e6)]
    density: f32,
    /// Share of extinction that is scattering.
    #[param(default = 0.5, role = reflectance)]
    albedo: Spectrum,
    /// Where scattered light goes.
    #[param(optional)]
    phase: PhaseRef<'a>,
}

impl<'a> Lossless<'a> {
    fn fog(&self) -> Fog<'a> {
        Fog { density: self.density, albedo: self.albedo, glow: 0.0, phase: self.phase }
    }
}

impl Medium for Lossless<'_> {
    fn sample(&self, ray: &Ray, samples: &mut Samples<'_>) -> FreeFlight {
        FreeFlight { weight: Spectrum::ONE, ..self.fog().sample(ray, samples) }
    }

    fn transmittance(&self, ray: &Ray, samples: &mut Samples<'_>) -> Spectrum {
        self.fog().transmittance(ray, samples)
    }

    fn phase(&self) -> PhaseRef<'_> {
        self.phase
    }
}

/// Fog that shines as if nothing of it were in the way.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct ShinesThroughItself<'a> {
    /// Absorption.
    #[param(default = 1.0, unit = "1/m", min = 0, max = 1e6)]
    density: f32,
    /// Where scattered light goes.
    #[param(optional)]
    phase: PhaseRef<'a>,
}

impl<'a> ShinesThroughItself<'a> {
    fn fog(&self) -> Fog<'a> {
        Fog { density: self.density, albedo: Spectrum::ZERO, glow: 1.0, phase: self.phase }
    }
}

impl Medium for ShinesThroughItself<'_> {
    fn sample(&self, ray: &Ray, samples: &mut Samples<'_>) -> FreeFlight {
        self.fog().sample(ray, samples)
    }

    fn transmittance(&self, ray: &Ray, samples: &mut Samples<'_>) -> Spectrum {
        self.fog().transmittance(ray, samples)
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounds; radiance is f32")]
    fn glow(&self, ray: &Ray, _samples: &mut Samples<'_>) -> Spectrum {
        Spectrum::splat((f64::from(self.density) * ray.t_max.min(1e6)) as f32)
    }

    fn phase(&self) -> PhaseRef<'_> {
        self.phase
    }
}

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant { class: Class::texture::<NanBelowZero>("nan_below_zero"), fault: "NaN for v < 0" },
    Mutant { class: Class::texture::<Overshoot>("overshoot"), fault: "5 % above its colours" },
    Mutant { class: Class::phase::<Brighter>("brighter"), fault: "integrates to 1.03" },
    Mutant { class: Class::medium::<Lossless<'static>>("lossless"), fault: "albedo is left out" },
    Mutant {
        class: Class::medium::<ShinesThroughItself<'static>>("shines_through_itself"),
        fault: "nothing of it hides its glow",
    },
];
