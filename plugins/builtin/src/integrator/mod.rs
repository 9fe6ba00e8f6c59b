//! The built-in plugins of kind integrator.

mod path;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[Class::integrator::<path::PathTracer>("path")];
