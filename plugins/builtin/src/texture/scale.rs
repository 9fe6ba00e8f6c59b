//! A product.

use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Texture, TexturePoint};

/// Two values multiplied: darkens a picture, tints it, or lays a mask over it.
///
/// ```scene
/// let soil  = texture image { file = "assets/soil.exr" }
/// let dark  = texture scale { value = soil, factor = 0.5 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Scale {
    /// What is scaled.
    #[param(default = 1.0, textured)]
    value: Spectrum,
    /// By how much.
    #[param(default = 1.0, textured)]
    factor: Spectrum,
}

impl Texture for Scale {
    fn eval(&self, _at: &TexturePoint) -> Spectrum {
        self.value * self.factor
    }
}
