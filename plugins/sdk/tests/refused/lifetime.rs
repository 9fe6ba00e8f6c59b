use luxel_sdk::{Params, params::Text};

/// Keeps what is lent.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Kept {
    /// A name.
    #[param(required)]
    //~ the host lends this for less than 'static: give the struct a lifetime
    name: Text<'static>,
}

/// Does not say how long.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Unsaid {
    /// A name.
    #[param(required)]
    //~ E0261
    name: Text<'a>,
}

fn main() {}
