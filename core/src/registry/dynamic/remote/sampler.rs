use std::mem::MaybeUninit;

use luxel_sdk::abi::{SamplerTable, Status};
use luxel_sdk::kind::{SampleAt, Sampler};

use super::Head;

/// A library's sampler.
#[repr(transparent)]
pub(super) struct RemoteSampler(Head);

// SAFETY: the SDK demands of samplers that they are `Send + Sync`.
unsafe impl Send for RemoteSampler {}
// SAFETY: as above.
unsafe impl Sync for RemoteSampler {}

#[inline(always)]
fn is_unit(u: f32) -> bool {
    (0.0..1.0).contains(&u)
}

impl RemoteSampler {
    #[inline(always)]
    fn table(&self) -> &'static SamplerTable {
        // SAFETY: the view was made for samplers.
        unsafe { self.0.table() }
    }

    /// Numbers, if they are some: what a library gives is not taken on trust.
    #[inline(always)]
    fn numbers<T: Copy + Default>(
        &self,
        ask: impl FnOnce(&mut MaybeUninit<T>) -> Status,
        fine: impl FnOnce(&T) -> bool,
    ) -> T {
        let mut out = MaybeUninit::uninit();
        if !self.0.is_ok(ask(&mut out)) {
            return T::default();
        }
        // SAFETY: the library has written a result.
        let found = *unsafe { out.assume_init_ref() };
        if fine(&found) {
            return found;
        }
        self.0.wrong("gave a number outside [0, 1)");
        T::default()
    }
}

impl Sampler for RemoteSampler {
    fn samples(&self) -> u32 {
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        self.0.found(unsafe { self.table().samples(self.0.at()) }).unwrap_or(1)
    }

    fn seed(&self) -> u32 {
        // SAFETY: as above.
        self.0.found(unsafe { self.table().seed(self.0.at()) }).unwrap_or(0)
    }

    #[inline(always)]
    fn get_1d(&self, which: SampleAt) -> f32 {
        // SAFETY: as above.
        let ask = |out: &mut _| unsafe { (self.table().get_1d)(self.0.at(), &which, out) };
        self.numbers(ask, |u| is_unit(*u))
    }

    #[inline(always)]
    fn get_2d(&self, which: SampleAt) -> [f32; 2] {
        // SAFETY: as above.
        let ask = |out: &mut _| unsafe { (self.table().get_2d)(self.0.at(), &which, out) };
        self.numbers(ask, |u| u.iter().all(|u| is_unit(*u)))
    }

    #[inline(always)]
    fn get_2d_pair(&self, which: SampleAt) -> [[f32; 2]; 2] {
        // SAFETY: as above.
        let ask = |out: &mut _| unsafe { (self.table().get_2d_pair)(self.0.at(), &which, out) };
        self.numbers(ask, |pair| pair.as_flattened().iter().all(|u| is_unit(*u)))
    }
}
