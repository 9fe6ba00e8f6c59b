use luxel_sdk::Params;

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
    /// How rough, too.
    #[param(default = 0.5, name = "roughness")]
    //~ another parameter has the name of `alpha`
    alpha: f32,
}

fn main() {}
