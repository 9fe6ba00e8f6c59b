use luxel_sdk::Params;

#[derive(Params, Clone, Copy)]
#[repr(C)]
//~ needs a doc comment: it is the manual page
struct Undocumented {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
}

fn main() {}
