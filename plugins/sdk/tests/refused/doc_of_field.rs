use luxel_sdk::Params;

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    #[param(default = 0.5)]
    //~ needs a doc comment: it becomes the manual
    roughness: f32,
}

fn main() {}
