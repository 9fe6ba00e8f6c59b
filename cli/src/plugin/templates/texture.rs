//! A texture, to be made your own.

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Texture, TexturePoint};

/// Stripes across the surface coordinate u, each as wide as the gap after it.
///
/// ```scene
/// let stripes = texture template_name { a = 0.1, b = 0.8, count = 5 }
/// let cloth   = material diffuse { reflectance = stripes }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct TemplateName {
    /// Value of a stripe; may be a texture itself.
    #[param(default = 0.2, textured)]
    a: Spectrum,
    /// Value between two stripes.
    #[param(default = 0.8, textured)]
    b: Spectrum,
    /// Stripes in a unit of u.
    #[param(default = 8.0)]
    count: f32,
}

impl Texture for TemplateName {
    fn eval(&self, at: &TexturePoint) -> Spectrum {
        let place = f64::from(at.uv.x) * f64::from(self.count);
        if place.rem_euclid(1.0) < 0.5 { self.a } else { self.b }
    }
}

luxel_sdk::plugin! { texture "template_name" => TemplateName; }
