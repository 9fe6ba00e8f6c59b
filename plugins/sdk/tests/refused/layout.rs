use luxel_sdk::Params;

/// Without repr.
#[derive(Params, Clone, Copy)]
struct Surface {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
}

/// With that of enums.
#[derive(Params, Clone, Copy)]
#[repr(C, packed)]
struct Packed {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
}

/// Not a struct.
#[derive(Params, Clone, Copy)]
#[repr(C)]
enum Either {
    A,
}

/// No names.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Tuple(
    /// How rough.
    #[param(default = 0.5)]
    f32,
);

fn main() {}
