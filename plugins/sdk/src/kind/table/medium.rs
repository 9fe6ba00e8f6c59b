use super::{SamplesRef, table};
use crate::color::Spectrum;
use crate::kind::{FreeFlight, Medium, PhaseRef};
use crate::num::Ray;

table! {
    /// What fills space. Rays are in world space, of unit direction, and end at `t_max`.
    Medium => MediumTable "luxel_medium_table" {
        /// How far a ray flies before it is scattered.
        fn sample(medium, ray: &Ray, samples: &mut SamplesRef<'_>) -> FreeFlight {
            Some(samples.with(|samples| medium.sample(ray, samples)))
        }
        /// The fraction of light that passes.
        fn transmittance(medium, ray: &Ray, samples: &mut SamplesRef<'_>) -> Spectrum {
            Some(samples.with(|samples| medium.transmittance(ray, samples)))
        }
        /// How it scatters: a handle that is valid as long as the parameters.
        fn phase(medium) -> PhaseRef<'static> {
            Some(medium.phase().for_as_long_as_it_lives())
        }
        /// The light that it sends itself towards where the ray begins.
        fn glow(medium, ray: &Ray, samples: &mut SamplesRef<'_>) -> Spectrum {
            Some(samples.with(|samples| medium.glow(ray, samples)))
        }
    }
}
