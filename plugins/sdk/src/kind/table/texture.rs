use std::marker::PhantomData;

use glam::{DVec3, Vec2};

use super::table;
use crate::color::{RgbSpace, Spectrum, Wavelengths};
use crate::kind::{Output, Texture, TexturePoint};
use crate::wire::expect;

table! {
    /// A value that varies over a surface or through space.
    Texture => TextureTable "luxel_texture_table" {
        /// The value at a point.
        fn eval(texture, point: &TexturePoint) -> Spectrum { Some(texture.eval(point)) }
        /// What the lanes mean: 0 values as they are, 1 linear sRGB, 2 the same where the surface has no
        /// colours of its own.
        fn output(texture) -> u32 { Some(texture.output() as u32) }
    }
}

/// A texture that a scene may give, to be asked anywhere, also while the object is built. Its own
/// parameters are resolved where it is asked.
///
/// What varies over a surface is better a `textured` parameter: that costs no call.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct TextureRef<'a> {
    pub(crate) table: Option<&'a TextureTable>,
    pub(crate) at: *const u8,
    lent: PhantomData<&'a ()>,
}

// SAFETY: textures are `Send + Sync`, and the handle borrows one.
unsafe impl Send for TextureRef<'_> {}
// SAFETY: as above.
unsafe impl Sync for TextureRef<'_> {}

impl<'a> TextureRef<'a> {
    /// None was given.
    pub const NONE: Self = Self { table: None, at: std::ptr::null(), lent: PhantomData };

    /// Lends a texture.
    pub const fn new<T: Texture>(texture: &'a T) -> Self {
        let at = std::ptr::from_ref(texture).cast();
        Self { table: Some(TextureTable::of::<T>()), at, lent: PhantomData }
    }

    /// Whether there is one.
    pub const fn is_given(&self) -> bool {
        self.table.is_some()
    }

    /// A number: the first lane, or the luminance of a colour. `p` is in metres, in world space where
    /// the object is asked at a point, and in its own frame while it is built. Nothing where there is
    /// no texture, or it failed.
    pub fn number(&self, p: DVec3, uv: Vec2) -> Option<f32> {
        let table = self.table?;
        let point = TexturePoint { p, uv, lambda: Wavelengths::sample(0.5) };
        // SAFETY: the handle lends what the table was made for.
        let value = expect(unsafe { table.eval(self.at, &point) })?;
        // SAFETY: as above.
        let output = expect(unsafe { table.output(self.at) });
        if output.is_none_or(|output| output == Output::Value as u32) {
            return Some(value.lane(0));
        }
        // A weighted mean: of three equal numbers exactly that number.
        let (rgb, weights) = (value.rgb(), RgbSpace::LinearSrgb.luminance_weights().as_vec3());
        Some(rgb.y + weights.x * (rgb.x - rgb.y) + weights.z * (rgb.z - rgb.y))
    }
}
