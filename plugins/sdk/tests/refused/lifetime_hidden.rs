use luxel_sdk::{Params, params::Text};

type Name = Text<'static>;

/// Keeps what is lent, by an alias.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Kept {
    /// A name.
    #[param(required)]
    name: Name,
}

fn main() {}
