//! A pixel filter, to be made your own.

use luxel_sdk::Params;
use luxel_sdk::kind::Filter;

/// A tent: falls evenly from the middle to nothing.
///
/// ```scene
/// filter template_name { radius = 1.5 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct TemplateName {
    /// Half its width, pixels.
    #[param(default = 1.0, min = 0.01, max = 16)]
    radius: f32,
}

impl Filter for TemplateName {
    fn radius(&self) -> f32 {
        self.radius
    }

    /// Nowhere negative; its integral is 1.
    fn eval(&self, offset: [f32; 2]) -> f32 {
        let side = |x: f32| ((1.0 - x.abs() / self.radius) / self.radius).max(0.0);
        side(offset[0]) * side(offset[1])
    }

    /// Offsets with the density that `eval` states.
    fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        u.map(|u| {
            let x = if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() };
            x * self.radius
        })
    }
}

luxel_sdk::plugin! { filter "template_name" => TemplateName; }
