use luxel_sdk::{Params, abi::Class};

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
}

//~ E0277
//~ Material`
const CLASS: Class = Class::material::<Surface>("surface");

fn main() {}
