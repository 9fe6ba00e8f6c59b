//! A medium and a phase function.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, FreeFlight, Lobe, Medium, Phase, PhaseRef, Sample, Samples};
use luxel_sdk::num::Ray;
use luxel_sdk::params::Maybe;

use super::Wrong;

/// Thick fog.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Fog<'a> {
    /// What is wrong.
    #[param(default = Wrong::Nothing, choice)]
    wrong: Wrong,
    /// How it scatters.
    #[param(optional)]
    phase: PhaseRef<'a>,
}

/// What the fog brings along.
const OWN: &Haze = &Haze { wrong: Wrong::Eval };
const NOWHERE: &Haze = &Haze { wrong: Wrong::Nan };

impl Medium for Fog<'_> {
    fn sample(&self, ray: &Ray, samples: &mut Samples<'_>) -> FreeFlight {
        self.wrong.at(Wrong::Eval);
        let flies = f64::from(samples.next_1d()) * 4.0;
        let t = match self.wrong {
            Wrong::Beyond => ray.t_max * 2.0,
            Wrong::SampleNan => f64::NAN,
            Wrong::SampleZero => -1.0,
            _ => flies,
        };
        let lies = [Wrong::Beyond, Wrong::SampleNan, Wrong::SampleZero].contains(&self.wrong);
        let t = if lies || t <= ray.t_max { Maybe::some(t) } else { Maybe::default() };
        if self.wrong == Wrong::Greedy {
            let at = luxel_sdk::kind::SampleAt { dimension: u32::MAX - 1, ..samples.at() };
            *samples = Samples::new(samples.source(), at);
        }
        FreeFlight { t, weight: Spectrum::splat(self.wrong.number(1.0)) }
    }
    fn transmittance(&self, _: &Ray, _: &mut Samples<'_>) -> Spectrum {
        self.wrong.at(Wrong::Other);
        Spectrum::splat(if self.wrong == Wrong::OtherNan { f32::NAN } else { 0.5 })
    }
    fn glow(&self, _: &Ray, _: &mut Samples<'_>) -> Spectrum {
        self.wrong.at(Wrong::Sample);
        Spectrum::splat(match self.wrong {
            Wrong::SampleLong => f32::NAN,
            Wrong::Zero => -1.0,
            _ => 0.0,
        })
    }
    fn phase(&self) -> PhaseRef<'_> {
        self.wrong.at(Wrong::Second);
        match self.wrong {
            Wrong::Foreign => PhaseRef::new(OWN),
            Wrong::SecondNan => PhaseRef::new(NOWHERE),
            _ => self.phase,
        }
    }
}

/// Scatters alike in all directions.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Haze {
    /// What is wrong.
    #[param(default = Wrong::Nothing, choice)]
    wrong: Wrong,
}

impl Phase for Haze {
    fn eval(&self, _: Vec3, _: Vec3) -> Eval {
        self.wrong.at(Wrong::Eval);
        let pdf = 0.25 * FRAC_1_PI;
        Eval { f: Spectrum::splat(self.wrong.number(pdf)), pdf }
    }
    fn sample(&self, _: Vec3, u: [f32; 2]) -> Option<Sample> {
        self.wrong.at(Wrong::Sample);
        let wi = match self.wrong {
            Wrong::SampleNan => Vec3::NAN,
            Wrong::SampleLong => Vec3::X * 1e30,
            _ => luxel_sdk::sampling::uniform_sphere(u),
        };
        let pdf = if self.wrong == Wrong::SampleZero { 0.0 } else { 0.25 * FRAC_1_PI };
        Some(Sample { weight: Spectrum::ONE, wi, pdf, eta: 1.0, lobe: Lobe::NONE })
    }
}
