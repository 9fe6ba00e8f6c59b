//! A texture that a plugin asks where it likes, rather than one that the host writes into a field.

use std::sync::{Arc, Mutex, PoisonError};

use luxel_sdk::color::{Palette, Spectrum};
use luxel_sdk::kind::{Output, Texture, TexturePoint};

use super::{Object, Scratch, Site};

/// A texture that was built in `rgb` mode, with what it takes to resolve its parameters at each point.
pub(super) struct Asked {
    texture: Arc<Object>,
    /// Lent to one caller at a time; not used where nothing varies.
    scratch: Mutex<Scratch>,
}

impl Asked {
    /// A texture.
    pub(super) fn new(texture: Arc<Object>) -> Self {
        Self { texture, scratch: Mutex::default() }
    }
}

impl Texture for Asked {
    fn eval(&self, at: &TexturePoint) -> Spectrum {
        if self.texture.is_constant() {
            return self.texture.fixed().texture().eval(at);
        }
        let mut scratch = self.scratch.lock().unwrap_or_else(PoisonError::into_inner);
        scratch.reset();
        let palette = Palette::rgb();
        let site = Site { p: at.p, uv: at.uv, palette: &palette, color: None };
        self.texture.resolve(&site, &scratch).texture().eval(at)
    }

    fn output(&self) -> Output {
        self.texture.fixed().texture().output()
    }
}
