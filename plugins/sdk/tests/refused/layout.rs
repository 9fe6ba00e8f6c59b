use luxel_sdk::Params;

/// Without repr.
#[derive(Params, Clone, Copy)]
//~ needs #[repr(C)] alone: the host writes fields
struct Surface {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
}

/// With that of enums.
#[derive(Params, Clone, Copy)]
#[repr(C, packed)]
//~ needs #[repr(C)] alone: the host writes fields
struct Packed {
    /// How rough.
    #[param(default = 0.5)]
    roughness: f32,
}

/// Not a struct.
#[derive(Params, Clone, Copy)]
#[repr(C)]
//~ parameters are a struct, not an enum or a union
enum Either {
    A,
}

/// No names.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Tuple(
    /// How rough.
    #[param(default = 0.5)]
    //~ needs a name: scenes give parameters by name
    f32,
);

fn main() {}
