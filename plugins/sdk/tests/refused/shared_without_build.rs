use luxel_sdk::{Params, params::Shared};

/// A picture.
//~ nothing makes the shared table of `Picture<'a>`
//~ needs `impl Build<Vec<u8>>`
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Picture<'a> {
    #[param(shared)]
    pixels: Shared<'a, Vec<u8>>,
}

fn main() {}
