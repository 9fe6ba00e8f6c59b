use luxel_sdk::{Params, params::Shared};

/// A picture.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Picture<'a> {
    #[param(shared)]
    pixels: Shared<'a, Vec<u8>>,
}

fn main() {}
