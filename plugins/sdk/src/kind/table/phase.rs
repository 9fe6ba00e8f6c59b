use std::marker::PhantomData;

use glam::Vec3;

use super::table;
use crate::kind::{Eval, Phase, Sample};
use crate::wire::expect;

table! {
    /// How a medium scatters light. Directions are unit vectors in world space, away from the point.
    Phase => PhaseTable "luxel_phase_table" {
        /// The phase function, sr⁻¹, and the density of `sample`.
        fn eval(phase, wo: &Vec3, wi: &Vec3) -> Eval { Some(phase.eval(*wo, *wi)) }
        /// A direction.
        fn sample(phase, wo: &Vec3, u: &[f32; 2]) -> Sample { phase.sample(*wo, *u) }
    }
}

/// A phase function, resolved at the same point.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct PhaseRef<'a> {
    pub(crate) table: &'a PhaseTable,
    pub(crate) at: *const u8,
    lent: PhantomData<&'a ()>,
}

// SAFETY: phase functions are `Send + Sync`, and the handle borrows one.
unsafe impl Send for PhaseRef<'_> {}
// SAFETY: as above.
unsafe impl Sync for PhaseRef<'_> {}

impl<'a> PhaseRef<'a> {
    /// Lends a phase function.
    pub const fn new<P: Phase>(phase: &'a P) -> Self {
        let at = std::ptr::from_ref(phase).cast();
        Self { table: PhaseTable::of::<P>(), at, lent: PhantomData }
    }

    /// The same handle, for a caller that knows how long the phase function is lent.
    pub(super) const fn for_as_long_as_it_lives(self) -> PhaseRef<'static> {
        // SAFETY: the address of a table that a class made is always static.
        let table = unsafe { &*std::ptr::from_ref(self.table) };
        PhaseRef { table, at: self.at, lent: PhantomData }
    }

    /// Lends the parameters at an address.
    ///
    /// # Safety
    /// They are those of a class with this table, and lent for `'a`.
    pub const unsafe fn from_raw(table: &'a PhaseTable, at: *const u8) -> Self {
        Self { table, at, lent: PhantomData }
    }
}

impl Phase for PhaseRef<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        // SAFETY: the handle lends what the table was made for.
        expect(unsafe { self.table.eval(self.at, &wo, &wi) }).unwrap_or(Eval::ZERO)
    }

    fn sample(&self, wo: Vec3, u: [f32; 2]) -> Option<Sample> {
        // SAFETY: as above.
        expect(unsafe { self.table.sample(self.at, &wo, &u) })
    }
}
