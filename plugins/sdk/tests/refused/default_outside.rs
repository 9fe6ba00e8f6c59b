use glam::Vec3;
use luxel_sdk::{Params, color::Spectrum};

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface {
    /// Above.
    #[param(default = 1.5, min = 0, max = 1)]
    roughness: f32,
    /// Below what its role allows.
    #[param(default = -0.5, role = reflectance)]
    reflectance: Spectrum,
    /// Not a number.
    #[param(default = f64::NAN)]
    scale: f64,
    /// In one component.
    #[param(default = [0.0, 0.0, -1.0], min = 0, unit = "m")]
    size: Vec3,
    /// Below the type.
    #[param(default = -1)]
    depth: u32,
    /// Between whole numbers.
    #[param(default = 0.5)]
    count: u32,
    /// In a range that is empty.
    #[param(required, min = 1, max = 0)]
    width: f32,
}

fn main() {}
