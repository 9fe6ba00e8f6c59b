use std::mem::MaybeUninit;

use luxel_sdk::abi::TextureTable;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Output, Texture, TexturePoint};

use super::Head;

/// A library's texture.
#[repr(transparent)]
pub(super) struct RemoteTexture(Head);

// SAFETY: the SDK demands of textures that they are `Send + Sync`.
unsafe impl Send for RemoteTexture {}
// SAFETY: as above.
unsafe impl Sync for RemoteTexture {}

/// What the lanes mean, by its number.
pub(super) fn output(head: &Head, found: Option<u32>) -> Output {
    match found {
        Some(0) | None => Output::Value,
        Some(1) => Output::Rgb,
        Some(_) => {
            head.wrong("gave an output that is none");
            Output::Value
        }
    }
}

impl RemoteTexture {
    #[inline(always)]
    fn table(&self) -> &'static TextureTable {
        // SAFETY: the view was made for textures.
        unsafe { self.0.table() }
    }
}

impl Texture for RemoteTexture {
    #[inline(always)]
    fn eval(&self, at: &TexturePoint) -> Spectrum {
        if self.0.is_poisoned() {
            return Spectrum::ZERO;
        }
        let mut out = MaybeUninit::uninit();
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let status = unsafe { (self.table().eval)(self.0.at(), at, &mut out) };
        if !self.0.is_ok(status) {
            return Spectrum::ZERO;
        }
        // SAFETY: the library has written a result.
        let value = unsafe { out.assume_init() };
        if value.is_finite() {
            return value;
        }
        self.0.wrong("gave a value that is not finite");
        Spectrum::ZERO
    }

    fn output(&self) -> Output {
        // SAFETY: as above.
        match self.0.found(unsafe { self.table().output(self.0.at()) }) {
            Some(2) => Output::Corners,
            found => output(&self.0, found),
        }
    }
}
