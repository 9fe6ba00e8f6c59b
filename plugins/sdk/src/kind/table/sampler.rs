use std::marker::PhantomData;

use super::table;
use crate::kind::{SampleAt, Sampler, Samples};
use crate::wire::expect;

table! {
    /// Where random numbers come from: the same for the same arguments, in [0, 1).
    Sampler => SamplerTable "luxel_sampler_table" {
        /// Samples per pixel.
        fn samples(sampler) -> u32 { Some(sampler.samples()) }
        /// The seed.
        fn seed(sampler) -> u32 { Some(sampler.seed()) }
        /// One number.
        fn get_1d(sampler, which: &SampleAt) -> f32 { Some(sampler.get_1d(*which)) }
        /// Two numbers that are spread over the square together.
        fn get_2d(sampler, which: &SampleAt) -> [f32; 2] { Some(sampler.get_2d(*which)) }
        /// Two such pairs, the second two dimensions on.
        fn get_2d_pair(sampler, which: &SampleAt) -> [[f32; 2]; 2] {
            Some(sampler.get_2d_pair(*which))
        }
    }
}

/// A sampler, lent through the boundary.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct SamplerRef<'a> {
    pub(crate) table: &'a SamplerTable,
    pub(crate) at: *const u8,
    lent: PhantomData<&'a ()>,
}

// SAFETY: samplers are `Send + Sync`, and the handle borrows one.
unsafe impl Send for SamplerRef<'_> {}
// SAFETY: as above.
unsafe impl Sync for SamplerRef<'_> {}

impl<'a> SamplerRef<'a> {
    /// Lends a sampler.
    pub const fn new<S: Sampler>(sampler: &'a S) -> Self {
        let at = std::ptr::from_ref(sampler).cast();
        Self { table: SamplerTable::of::<S>(), at, lent: PhantomData }
    }
}

impl Sampler for SamplerRef<'_> {
    fn samples(&self) -> u32 {
        // SAFETY: the handle lends what the table was made for.
        expect(unsafe { self.table.samples(self.at) }).unwrap_or(1)
    }

    fn seed(&self) -> u32 {
        // SAFETY: as above.
        expect(unsafe { self.table.seed(self.at) }).unwrap_or(0)
    }

    fn get_1d(&self, which: SampleAt) -> f32 {
        // SAFETY: as above.
        expect(unsafe { self.table.get_1d(self.at, &which) }).unwrap_or(0.0)
    }

    fn get_2d(&self, which: SampleAt) -> [f32; 2] {
        // SAFETY: as above.
        expect(unsafe { self.table.get_2d(self.at, &which) }).unwrap_or([0.0; 2])
    }

    fn get_2d_pair(&self, which: SampleAt) -> [[f32; 2]; 2] {
        // SAFETY: as above.
        expect(unsafe { self.table.get_2d_pair(self.at, &which) }).unwrap_or([[0.0; 2]; 2])
    }
}

/// The numbers of one path, on their way through the boundary: `Samples`, as plain data.
#[repr(C)]
pub struct SamplesRef<'a> {
    /// Where they come from.
    pub source: SamplerRef<'a>,
    /// The next of them.
    pub next: SampleAt,
}

impl SamplesRef<'_> {
    /// Lends the numbers of a path to a call, and takes note of how many it took.
    pub fn lend<R>(samples: &mut Samples<'_>, call: impl FnOnce(&mut SamplesRef<'_>) -> R) -> R {
        let source = samples.source();
        let mut lent = SamplesRef { source: SamplerRef::new(&source), next: samples.at() };
        let result = call(&mut lent);
        *samples = Samples::new(source, lent.next);
        result
    }

    /// Uses numbers that were lent.
    pub(super) fn with<R>(&mut self, call: impl FnOnce(&mut Samples<'_>) -> R) -> R {
        let mut samples = Samples::new(&self.source, self.next);
        let result = call(&mut samples);
        self.next = samples.at();
        result
    }
}
