//! The built-in plugins of kind texture.

mod checker;
mod decode;
mod exr;
mod image;
mod jpeg;
mod scale;
#[cfg(test)]
pub(crate) mod testing;
mod unpack;
mod vertex_color;

pub(crate) use decode::{Pixels, Wrap, decode};

use luxel_sdk::abi::Class;

/// All of them.
pub(crate) const CLASSES: &[Class] = &[
    Class::texture::<image::Image<'static>>("image"),
    Class::texture::<checker::Checker>("checker"),
    Class::texture::<scale::Scale>("scale"),
    Class::texture::<vertex_color::VertexColor>("vertex_color"),
];
