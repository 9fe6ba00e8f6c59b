//! The built-in plugins of kind medium.

mod glowing;
mod homogeneous;

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[
    Class::medium::<homogeneous::Homogeneous<'static>>("homogeneous"),
    Class::medium::<glowing::Glowing<'static>>("glowing"),
];
