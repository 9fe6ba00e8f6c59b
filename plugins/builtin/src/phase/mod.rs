//! The built-in plugins of kind phase.

pub(crate) mod isotropic;
mod henyey_greenstein;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[
    Class::phase::<isotropic::Isotropic>("isotropic"),
    Class::phase::<henyey_greenstein::HenyeyGreenstein>("henyey_greenstein"),
];
