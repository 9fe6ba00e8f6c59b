use luxel_sdk::Params;

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface<'a> {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
    #[param(derived)]
    name: &'a str,
}

fn main() {}
