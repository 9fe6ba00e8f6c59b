use luxel_sdk::abi::{MediumTable, PhaseRef, SamplesRef};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{FreeFlight, Medium, Samples};
use luxel_sdk::num::Ray;
use luxel_sdk::params::Maybe;

use super::Head;
use super::material::is_light;

/// A library's medium.
#[repr(transparent)]
pub(super) struct RemoteMedium(Head);

// SAFETY: the SDK demands of media that they are `Send + Sync`.
unsafe impl Send for RemoteMedium {}
// SAFETY: as above.
unsafe impl Sync for RemoteMedium {}

impl RemoteMedium {
    fn table(&self) -> &'static MediumTable {
        // SAFETY: the view was made for media.
        unsafe { self.0.table() }
    }
}

const THROUGH: FreeFlight =
    FreeFlight { t: Maybe { given: false, value: 0.0 }, weight: Spectrum::ONE };

impl Medium for RemoteMedium {
    fn sample(&self, ray: &Ray, samples: &mut Samples<'_>) -> FreeFlight {
        if self.0.is_poisoned() {
            return THROUGH;
        }
        let table = self.table();
        let answer = SamplesRef::lend(samples, |samples| {
            // SAFETY: the struct behind the head is of the class that the table belongs to.
            unsafe { table.sample(self.0.at(), ray, samples) }
        });
        let flight = self.0.found(answer).unwrap_or(THROUGH);
        let inside = flight.t.as_ref().is_none_or(|t| *t >= 0.0 && *t <= ray.t_max);
        if inside && is_light(flight.weight) {
            return flight;
        }
        self.0.wrong("gave a flight that is negative, not finite or too long");
        THROUGH
    }

    fn transmittance(&self, ray: &Ray, samples: &mut Samples<'_>) -> Spectrum {
        if self.0.is_poisoned() {
            return Spectrum::ONE;
        }
        let table = self.table();
        let answer = SamplesRef::lend(samples, |samples| {
            // SAFETY: as above.
            unsafe { table.transmittance(self.0.at(), ray, samples) }
        });
        let left = self.0.found(answer).unwrap_or(Spectrum::ONE);
        if is_light(left) {
            return left;
        }
        self.0.wrong("gave a transmittance that is negative or not finite");
        Spectrum::ONE
    }

    fn phase(&self) -> PhaseRef<'_> {
        // SAFETY: as above.
        let found = self.0.found(unsafe { self.table().phase(self.0.at()) });
        found.unwrap_or(PhaseRef::new(&Nowhere))
    }
}

/// Scatters nothing: what a medium that has failed is left with.
struct Nowhere;

impl luxel_sdk::kind::Phase for Nowhere {
    fn eval(&self, _wo: glam::Vec3, _wi: glam::Vec3) -> luxel_sdk::kind::Eval {
        luxel_sdk::kind::Eval::ZERO
    }
    fn sample(&self, _wo: glam::Vec3, _u: [f32; 2]) -> Option<luxel_sdk::kind::Sample> {
        None
    }
}
