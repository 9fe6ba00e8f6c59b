//! An integrator: direct light, one bounce.

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Arrival, Ask, Host, Job, PathIntegrator, SampleAt, Samples, Wants};
use luxel_sdk::num::Ray;

use super::Wrong;

/// Follows light.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Walk {
    /// What is wrong.
    #[param(default = Wrong::Nothing, choice)]
    wrong: Wrong,
}

impl PathIntegrator for Walk {
    type State = u32;

    fn wants(&self) -> Wants {
        self.wrong.at(Wrong::Other);
        Wants::EMISSION.with(Wants::SCATTER).with(Wants::DIRECT)
    }
    fn start(&self, job: &Job, ask: &mut Ask<'_>) -> u32 {
        self.wrong.at(Wrong::Prepare);
        ask.trace(job.ray);
        if self.wrong == Wrong::Second {
            ask.trace(job.ray);
        }
        if self.wrong == Wrong::SecondNan {
            ask.add(Spectrum::splat(f32::NAN));
        }
        0
    }
    fn arrive(
        &self,
        depth: &mut u32,
        at: &Arrival,
        samples: &mut Samples<'_>,
        _: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        self.wrong.at(Wrong::Eval);
        ask.add(at.le * self.wrong.number(1.0));
        if self.wrong == Wrong::Beyond {
            let at = SampleAt { dimension: u32::MAX - 1, ..samples.at() };
            *samples = Samples::new(samples.source(), at);
        }
        *depth += 1;
        if *depth > 2 {
            return;
        }
        let Some(scatter) = at.scatter.as_ref() else { return };
        let mut ray = at.ray(scatter.wi);
        match self.wrong {
            Wrong::SampleNan => ray.o.x = f64::NAN,
            Wrong::SampleLong => ray.d *= f64::INFINITY,
            Wrong::Zero => ray.d *= 0.0,
            Wrong::Greedy => {
                let shadow = Ray { t_max: 1.0, ..ray };
                (0..100_000).for_each(|_| ask.add_if_visible(shadow, Spectrum::ONE));
            }
            Wrong::Sample => {
                *depth = 0;
                ask.trace(ray);
            }
            Wrong::OtherNan => ask.add_if_visible(ray, Spectrum::splat(f32::NAN)),
            _ => {}
        }
        ask.trace(ray);
    }
}
