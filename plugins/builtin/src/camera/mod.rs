//! The built-in plugins of kind camera.

mod view;
mod perspective;
mod thin_lens;
mod orthographic;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[
    Class::camera::<perspective::Perspective>("perspective"),
    Class::camera::<thin_lens::ThinLens>("thin_lens"),
    Class::camera::<orthographic::Orthographic>("orthographic"),
];
