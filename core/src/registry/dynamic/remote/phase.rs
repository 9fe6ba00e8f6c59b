use glam::Vec3;
use luxel_sdk::abi::PhaseTable;
use luxel_sdk::kind::{Eval, Phase, Sample};

use super::Head;
use super::material::{is_light, is_sample};

/// A library's phase function.
#[repr(transparent)]
pub(super) struct RemotePhase(Head);

// SAFETY: the SDK demands of phase functions that they are `Send + Sync`.
unsafe impl Send for RemotePhase {}
// SAFETY: as above.
unsafe impl Sync for RemotePhase {}

impl RemotePhase {
    fn table(&self) -> &'static PhaseTable {
        // SAFETY: the view was made for phase functions.
        unsafe { self.0.table() }
    }
}

impl Phase for RemotePhase {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        if self.0.is_poisoned() {
            return Eval::ZERO;
        }
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let found = self.0.found(unsafe { self.table().eval(self.0.at(), &wo, &wi) });
        let eval = found.unwrap_or(Eval::ZERO);
        if is_light(eval.f) && eval.pdf >= 0.0 && eval.pdf.is_finite() {
            return eval;
        }
        self.0.wrong("gave an eval that is negative or not finite");
        Eval::ZERO
    }

    fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<Sample> {
        if self.0.is_poisoned() {
            return None;
        }
        // SAFETY: as above.
        let sample = self.0.found(unsafe { self.table().sample(self.0.at(), &wo, &u) })?;
        if is_sample(&sample) {
            return Some(sample);
        }
        self.0.wrong("gave a sample that is negative, not finite or not of unit length");
        None
    }
}
