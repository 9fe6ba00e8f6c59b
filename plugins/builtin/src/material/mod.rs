//! The built-in plugins of kind material.

mod diffuse;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[Class::material::<diffuse::Diffuse>("diffuse")];
