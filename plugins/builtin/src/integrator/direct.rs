//! Light that is scattered once.

use luxel_sdk::Params;
use luxel_sdk::kind::{Arrival, Ask, Host, Job, PathIntegrator, Samples, Wants};

use super::path::{Path, PathTracer};

/// Lights, and what they light directly: quick, and what closed-form truths are about. What lies
/// behind glass or in a mirror shows no shading of its own.
///
/// ```scene
/// integrator direct {}
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Direct {
    /// Whether lights are looked for. Without, only scattered rays that meet one count.
    #[param(default = true)]
    light_sampling: bool,
}

impl Direct {
    fn path(self) -> PathTracer {
        let light_sampling = self.light_sampling;
        PathTracer {
            max_depth: 1,
            russian_roulette_from: u32::MAX,
            russian_roulette_below: 0.0,
            light_sampling,
        }
    }
}

impl PathIntegrator for Direct {
    type State = Path;

    fn wants(&self) -> Wants {
        PathIntegrator::wants(&self.path())
    }

    fn start(&self, job: &Job, ask: &mut Ask<'_>) -> Path {
        self.path().start(job, ask)
    }

    fn arrive(
        &self,
        path: &mut Path,
        at: &Arrival,
        samples: &mut Samples<'_>,
        host: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        self.path().arrive(path, at, samples, host, ask);
    }
}
