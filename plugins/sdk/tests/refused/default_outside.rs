use glam::Vec3;
use luxel_sdk::{Params, color::Spectrum};

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// Above.
    #[param(default = 1.5, min = 0, max = 1)]
    //~ the default of `roughness` is outside its range: 1.5, not 0 to 1
    roughness: f32,
    /// Below what its role allows.
    #[param(default = -0.5, role = reflectance)]
    //~ the default of `reflectance` is outside its range: -0.5, not that of the role `reflectance`
    reflectance: Spectrum,
    /// Not a number.
    #[param(default = f64::NAN)]
    //~ the default of `scale` is outside its range: f64::NAN, not what its type holds
    scale: f64,
    /// In one component.
    #[param(default = [0.0, 0.0, -1.0], min = 0, unit = "m")]
    //~ the default of `size` is outside its range: [0.0, 0.0, -1.0], not 0 to …
    size: Vec3,
    /// Below the type.
    #[param(default = -1)]
    //~ the default of `depth` is outside its range: -1, not what its type holds
    depth: u32,
    /// Between whole numbers.
    #[param(default = 0.5)]
    //~ the default of `count` is outside its range: 0.5, not what its type holds
    count: u32,
    /// In a range that is empty.
    #[param(required, min = 1, max = 0)]
    //~ the range of `width` is empty: 1 to 0
    width: f32,
}

fn main() {}
