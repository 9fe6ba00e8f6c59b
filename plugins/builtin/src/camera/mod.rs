//! The built-in plugins of kind camera.

mod perspective;
mod view;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] =
    &[Class::camera::<perspective::Perspective>("perspective")];
