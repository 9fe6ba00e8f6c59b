use luxel_sdk::Params;

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
    #[param(derived)]
    table: [f32; 64],
}

fn main() {}
