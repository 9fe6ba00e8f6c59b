use std::marker::PhantomData;

use glam::Vec3;

use super::table;
use crate::kind::{Eval, Material, Needs, Sample};
use crate::wire::expect;

table! {
    /// How a surface scatters light. Directions are unit vectors in the local frame.
    Material => MaterialTable "luxel_material_table" {
        /// What it looks at, as flags: 1 light, 2 the third random number, 4 the tangent.
        fn needs(material) -> Needs { Some(material.needs()) }
        /// f·|cosine| and the density with which `sample` finds `wi`.
        fn eval(material, wo: &Vec3, wi: &Vec3) -> Eval { Some(material.eval(*wo, *wi)) }
        /// A direction; nothing where nothing is scattered.
        fn sample(material, wo: &Vec3, u: &[f32; 3]) -> Sample { material.sample(*wo, *u) }
    }
}

/// Another material, resolved at the same point.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct MaterialRef<'a> {
    pub(crate) table: &'a MaterialTable,
    pub(crate) at: *const u8,
    lent: PhantomData<&'a ()>,
}

// SAFETY: materials are `Send + Sync`, and the handle borrows one.
unsafe impl Send for MaterialRef<'_> {}
// SAFETY: as above.
unsafe impl Sync for MaterialRef<'_> {}

impl<'a> MaterialRef<'a> {
    /// Lends a material.
    pub const fn new<M: Material>(material: &'a M) -> Self {
        let at = std::ptr::from_ref(material).cast();
        Self { table: MaterialTable::of::<M>(), at, lent: PhantomData }
    }

    /// Lends the parameters at an address.
    ///
    /// # Safety
    /// They are those of a class with this table, and lent for `'a`.
    pub const unsafe fn from_raw(table: &'a MaterialTable, at: *const u8) -> Self {
        Self { table, at, lent: PhantomData }
    }
}

impl Material for MaterialRef<'_> {
    fn needs(&self) -> Needs {
        // SAFETY: the handle lends what the table was made for.
        expect(unsafe { self.table.needs(self.at) }).unwrap_or(Needs::ALL)
    }

    #[inline(always)]
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        // SAFETY: as above.
        expect(unsafe { self.table.eval(self.at, &wo, &wi) }).unwrap_or(Eval::ZERO)
    }

    #[inline(always)]
    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        // SAFETY: as above.
        expect(unsafe { self.table.sample(self.at, &wo, &u) })
    }
}
