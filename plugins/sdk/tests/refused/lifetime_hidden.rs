use luxel_sdk::{Params, params::Text};

type Name = Text<'static>;

/// Keeps what is lent, by an alias.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Kept {
    /// A name.
    #[param(required)]
    //~ the host lends `name` for less than 'static: give the struct a lifetime
    name: Name,
}

fn main() {}
