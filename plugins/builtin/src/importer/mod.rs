//! The built-in plugins of kind importer.

mod gltf;
mod obj;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] =
    &[Class::importer::<gltf::Gltf<'_>>("gltf"), Class::importer::<obj::Obj<'_>>("obj")];
