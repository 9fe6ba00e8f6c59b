use luxel_sdk::{Params, params::Text};

/// For each number.
#[derive(Params, Clone, Copy)]
#[repr(C)]
//~ parameters have one layout: at most one lifetime and nothing else here
struct Surface<T> {
    /// How rough.
    #[param(default = 0.5)]
    roughness: T,
}

/// For each length.
#[derive(Params, Clone, Copy)]
#[repr(C)]
//~ parameters have one layout: at most one lifetime and nothing else here
struct Sized<const N: usize> {
    #[param(derived)]
    roughness: [f32; N],
}

/// For two lifetimes.
#[derive(Params, Clone, Copy)]
#[repr(C)]
//~ parameters have one layout: at most one lifetime and nothing else here
struct Two<'a, 'b> {
    /// A name.
    #[param(required)]
    name: Text<'a>,
    /// Another.
    #[param(required)]
    other: Text<'b>,
}

fn main() {}
