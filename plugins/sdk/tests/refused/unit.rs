use luxel_sdk::Params;

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// How wide.
    #[param(required, unit = "metre")]
    //~ unknown unit `metre` of `width`; units are m, s, rad, W, … and products
    width: f32,
    /// How bright.
    #[param(required, unit = "W/m^2|lux")]
    //~ unknown unit `W/m^2|lux` of `bright`; units are m, s, rad, W, … and products
    bright: f32,
}

fn main() {}
