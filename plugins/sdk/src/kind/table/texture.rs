use super::table;
use crate::color::Spectrum;
use crate::kind::{Texture, TexturePoint};

table! {
    /// A value that varies over a surface or through space.
    Texture => TextureTable "luxel_texture_table" {
        /// The value at a point.
        fn eval(texture, point: &TexturePoint) -> Spectrum { Some(texture.eval(point)) }
        /// What the lanes mean: 0 values as they are, 1 linear sRGB.
        fn output(texture) -> u32 { Some(texture.output() as u32) }
    }
}
