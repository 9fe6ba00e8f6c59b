//! All samples of the pixel count alike.

use luxel_sdk::Params;
use luxel_sdk::kind::Filter;

/// Every sample counts alike. With radius 0.5 a pixel is the mean over its own square, which is what
/// measurements want; edges look a little jagged.
///
/// ```scene
/// filter box { radius = 0.5 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct BoxFilter {
    /// Half the width of the square, pixels.
    #[param(default = 0.5, min = 0.01, max = 16)]
    radius: f32,
}

impl Filter for BoxFilter {
    fn radius(&self) -> f32 {
        self.radius
    }

    fn eval(&self, offset: [f32; 2]) -> f32 {
        let inside = offset.iter().all(|x| x.abs() <= self.radius);
        if inside { 0.25 / (self.radius * self.radius) } else { 0.0 }
    }

    fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        u.map(|u| (2.0 * u - 1.0) * self.radius)
    }
}
