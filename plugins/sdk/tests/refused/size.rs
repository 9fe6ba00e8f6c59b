use luxel_sdk::Params;

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
//~ parameters take at most 256 bytes: put large data into a `shared` table
struct Surface {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
    #[param(derived)]
    table: [f32; 64],
}

fn main() {}
