use luxel_sdk::{Params, params::Text};

/// Keeps what is lent.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Kept {
    /// A name.
    #[param(required)]
    name: Text<'static>,
}

/// Does not say how long.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Unsaid {
    /// A name.
    #[param(required)]
    name: Text<'a>,
}

fn main() {}
