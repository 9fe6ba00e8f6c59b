use luxel_sdk::{Params, params::Emission};

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// Neither.
    #[param(min = 0)]
    neither: f32,
    /// Two of them.
    #[param(default = 0.5, required)]
    both: f32,
    /// All of them.
    #[param(required, optional, default = 0.5)]
    all: f32,
    /// An amount is the default.
    #[param(emission(radiance, scale), required, optional)]
    emission: Emission,
    /// No attribute at all.
    bare: f32,
}

fn main() {}
