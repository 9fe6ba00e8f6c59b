use luxel_sdk::{Params, params::Emission};

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// Unknown key.
    #[param(default = 0.5, minimum = 0)]
    key: f32,
    /// Unknown role.
    #[param(default = 0.5, role = refletance)]
    role: f32,
    /// Twice.
    #[param(default = 0.5, min = 0, min = 1)]
    twice: f32,
    /// No texture.
    #[param(default = 1, textured)]
    count: u32,
    /// Unknown amount.
    #[param(emission(radiance, brightness))]
    emission: Emission,
    /// No emission.
    #[param(emission(radiance))]
    number: f32,
    #[param(derived, min = 0)]
    derived: f32,
}

fn main() {}
