use std::mem::MaybeUninit;

use glam::{Vec3, Vec4};
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
    (f.0.cmpge(Vec4::ZERO) & f.0.cmplt(Vec4::INFINITY)).all()
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
        let mut out = MaybeUninit::uninit();
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let status = unsafe { (self.table().eval)(self.0.at(), &wo, &wi, &mut out) };
        if !self.0.is_ok(status) {
            return Eval::ZERO;
        }
        // SAFETY: the library has written a result.
        let Eval { f, pdf } = *unsafe { out.assume_init_ref() };
        if is_light(f) && (0.0..f32::INFINITY).contains(&pdf) {
            return Eval { f, pdf };
        }
        self.0.wrong("gave an eval that is negative or not finite");
        Eval::ZERO
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        if self.0.is_poisoned() {
            return None;
        }
        let mut out = MaybeUninit::uninit();
        // SAFETY: as above.
        let status = unsafe { (self.table().sample)(self.0.at(), &wo, &u, &mut out) };
        if !self.0.is_ok(status) {
            return None;
        }
        // SAFETY: as above.
        let Sample { weight, wi, pdf, eta, lobe } = *unsafe { out.assume_init_ref() };
        let sample = Sample { weight, wi, pdf, eta, lobe };
        if is_sample(&sample) {
            return Some(sample);
        }
        self.0.wrong("gave a sample that is negative, not finite or not of unit length");
        None
    }
}

/// Whether a sample may be used: what a library gives is not taken on trust.
#[inline(always)]
pub(super) fn is_sample(sample: &Sample) -> bool {
    let delta = sample.lobe.has(Lobe::DELTA);
    is_light(sample.weight)
        && sample.wi.is_normalized()
        && (delta || sample.pdf > 0.0)
        && sample.pdf < f32::INFINITY
        && sample.eta > 0.0
        && sample.eta < f32::INFINITY
}
