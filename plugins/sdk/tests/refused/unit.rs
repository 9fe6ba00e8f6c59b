use luxel_sdk::Params;

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// How wide.
    #[param(required, unit = "metre")]
    width: f32,
    /// How bright.
    #[param(required, unit = "W/m^2|lux")]
    bright: f32,
}

fn main() {}
