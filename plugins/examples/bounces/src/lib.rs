//! An integrator, as a plugin: light by how often it was scattered.

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Arrival, Ask, Host, Job, PathIntegrator, Samples, Wants, mis};

/// Shows the light that was scattered at least `first` and at most `last` times: 1 to 1 is direct
/// light, from 2 on indirect light. Pictures of ranges that follow each other add up to that of
/// `path`.
///
/// ```scene
/// integrator bounces { first = 2 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct Bounces {
    /// Fewest scattering events of light that shows; 0 shows lights themselves.
    #[param(default = 0, min = 0, max = 1024)]
    first: u32,
    /// Most of them.
    #[param(default = 1024, min = 0, max = 1024)]
    last: u32,
}

/// Throughput, density of the last direction, and scattering events so far.
#[derive(Clone, Copy, Default)]
pub struct Path(Spectrum, f32, u32);

impl PathIntegrator for Bounces {
    type State = Path;

    fn wants(&self) -> Wants {
        Wants::EMISSION.with(Wants::DIRECT).with(Wants::SCATTER)
    }

    fn start(&self, job: &Job, ask: &mut Ask<'_>) -> Path {
        ask.trace(job.ray);
        Path(Spectrum::ONE, f32::INFINITY, 0)
    }

    fn arrive(
        &self,
        Path(beta, pdf, depth): &mut Path,
        at: &Arrival,
        samples: &mut Samples<'_>,
        _host: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        if *depth >= self.first {
            ask.add(*beta * at.le * mis(*pdf, at.le_pdf));
            ask.add_glow(*beta, at);
        }
        if *depth >= self.last {
            return;
        }
        *depth += 1;
        if let Some(direct) = at.direct.as_ref().filter(|_| *depth >= self.first) {
            ask.add_if_visible(direct.ray, *beta * direct.f_le * mis(direct.pdf, direct.f_pdf));
        }
        let Some(scatter) = at.scatter.as_ref() else { return };
        let chance = scatter.weight.max_element().clamp(0.05, 1.0);
        *beta *= scatter.weight / chance;
        *pdf = scatter.pdf;
        if samples.next_1d() < chance {
            ask.trace(at.ray(scatter.wi));
        }
    }
}

luxel_sdk::plugin! { integrator "bounces" => Bounces; }
