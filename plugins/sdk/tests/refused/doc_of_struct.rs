use luxel_sdk::Params;

#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Undocumented {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
}

fn main() {}
