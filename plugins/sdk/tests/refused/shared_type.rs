use luxel_sdk::{Params, params::Shared};

/// A picture.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Picture<'a> {
    #[param(shared)]
    //~ a `shared` field is a Shared<'a, T>
    pixels: &'a [u8],
}

/// Two tables.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Pictures<'a> {
    #[param(shared)]
    front: Shared<'a, Vec<u8>>,
    #[param(shared)]
    //~ `front` is the shared table already: put both into one type
    back: Shared<'a, Vec<u8>>,
}

fn main() {}
