use glam::Vec3;
use luxel_sdk::abi::MaterialTable;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample};

use super::Head;

/// A library's material.
#[repr(transparent)]
pub(super) struct RemoteMaterial(Head);

// SAFETY: the SDK demands of materials that they are `Send + Sync`.
unsafe impl Send for RemoteMaterial {}
// SAFETY: as above.
unsafe impl Sync for RemoteMaterial {}

/// Finite and not negative in every lane.
#[inline(always)]
pub(super) fn is_light(f: Spectrum) -> bool {
    f.0.min_element() >= 0.0 && f.is_finite()
}

impl RemoteMaterial {
    #[inline(always)]
    fn table(&self) -> &'static MaterialTable {
        // SAFETY: the view was made for materials.
        unsafe { self.0.table() }
    }
}

impl Material for RemoteMaterial {
    #[inline(always)]
    fn needs(&self) -> Needs {
        if self.0.is_poisoned() {
            return Needs::NOTHING;
        }
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        self.0.found(unsafe { self.table().needs(self.0.at()) }).unwrap_or(Needs::ALL)
    }

    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        if self.0.is_poisoned() {
            return Eval::ZERO;
        }
        // SAFETY: as above.
        let found = self.0.found(unsafe { self.table().eval(self.0.at(), &wo, &wi) });
        let eval = found.unwrap_or(Eval::ZERO);
        if is_light(eval.f) && eval.pdf >= 0.0 && eval.pdf.is_finite() {
            return eval;
        }
        self.0.wrong("gave an eval that is negative or not finite");
        Eval::ZERO
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        if self.0.is_poisoned() {
            return None;
        }
        // SAFETY: as above.
        let sample = self.0.found(unsafe { self.table().sample(self.0.at(), &wo, &u) })?;
        if is_sample(&sample) {
            return Some(sample);
        }
        self.0.wrong("gave a sample that is negative or not finite");
        None
    }
}

/// Whether a sample may be used: what a library gives is not taken on trust.
#[inline(always)]
pub(super) fn is_sample(sample: &Sample) -> bool {
    let delta = sample.lobe.has(Lobe::DELTA);
    is_light(sample.weight)
        && sample.wi.is_finite()
        && (delta || sample.pdf > 0.0)
        && sample.pdf.is_finite()
        && sample.eta > 0.0
        && sample.eta.is_finite()
}
