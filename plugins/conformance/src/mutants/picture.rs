//! Integrators that own the picture, with a fault that only time or a second picture shows.

use std::thread::sleep;
use std::time::Duration;

use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::{
    Arrival, Ask, Host, Job, PathIntegrator, PathsRef, PictureIntegrator, PictureJob, Samples,
    Wants,
};
use luxel_sdk::sampling::{hash_combine, u32_to_unit};

use super::Mutant;
use crate::reference::{Walk, Way};

/// An integrator of picture size that follows these paths, and does this when it is to end.
macro_rules! picture {
    ($name:ident, $paths:expr, $end:expr) => {
        /// Makes the picture pass by pass.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {}

        impl PictureIntegrator for $name {
            fn wants(&self) -> Wants {
                PathIntegrator::wants(&Walk {})
            }

            fn render(&self, job: &dyn PictureJob) {
                let paths = $paths(job.seed());
                let end: fn() = $end;
                for _ in 0..job.samples() {
                    if job.is_cancelled() {
                        return end();
                    }
                    job.run_camera_paths(PathsRef::new(&paths));
                    job.finish_pass();
                }
            }
        }
    };
}

/// Says that its passes are independent, and follows other paths in the first of them.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Counts {}

impl PictureIntegrator for Counts {
    fn wants(&self) -> Wants {
        PathIntegrator::wants(&Walk {})
    }

    fn has_independent_passes(&self) -> bool {
        true
    }

    fn render(&self, job: &dyn PictureJob) {
        for pass in 0..job.samples() {
            match pass {
                0 => job.run_camera_paths(PathsRef::new(&Blotches { seed: job.seed() })),
                _ => job.run_camera_paths(PathsRef::new(&Walk {})),
            }
            job.finish_pass();
        }
    }
}

/// Longer than any end may take: the check allows a quarter of a second and four small pictures.
const LATE: Duration = Duration::from_secs(4);

#[cfg(test)]
picture!(Sound, |_| Walk {}, || {});
picture!(Blotchy, |seed| Blotches { seed }, || {});
picture!(Dawdles, |_| Walk {}, || sleep(LATE));

/// Paths that are too bright or too dark by the place that they see, for all of a picture: what is
/// drawn once does not fade, however many samples follow.
struct Blotches {
    seed: u32,
}

impl PathIntegrator for Blotches {
    type State = Way;

    fn wants(&self) -> Wants {
        PathIntegrator::wants(&Walk {})
    }

    fn start(&self, job: &Job, ask: &mut Ask<'_>) -> Way {
        let cell = (job.ray.d * 16.0).floor().as_ivec3().as_uvec3();
        let drawn = cell.to_array().into_iter().fold(self.seed, hash_combine);
        let mut way = Walk {}.start(job, ask);
        way.beta *= if u32_to_unit(drawn) < 0.5 { 0.5 } else { 1.5 };
        way
    }

    fn arrive(
        &self,
        way: &mut Way,
        at: &Arrival,
        samples: &mut Samples<'_>,
        host: &dyn Host,
        ask: &mut Ask<'_>,
    ) {
        Walk {}.arrive(way, at, samples, host, ask);
    }
}

/// The same without a fault.
#[cfg(test)]
pub(super) const SOUND: Class = Class::picture_integrator::<Sound>("sound_picture");

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant {
        class: Class::picture_integrator::<Blotchy>("blotchy"),
        fault: "draws once for all samples",
    },
    Mutant {
        class: Class::picture_integrator::<Counts>("counts"),
        fault: "has another first pass, and says that it has none",
    },
    Mutant {
        class: Class::picture_integrator::<Dawdles>("dawdles"),
        fault: "ends four seconds late",
    },
];
