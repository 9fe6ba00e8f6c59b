//! The built-in plugins of kind light.

mod area;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[Class::light::<area::Area>("area")];
