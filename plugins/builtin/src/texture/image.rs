//! A picture laid over a surface.

use glam::Vec2;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Output, Texture, TexturePoint};
use luxel_sdk::params::{Build, BuildContext, Fault, File, Shared};
use luxel_sdk::{Choice, Params};

use super::decode::{Pixels, Wrap, decode};

/// How the numbers of a picture encode light.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Space {
    /// sRGB for pictures of whole numbers, linear for floats.
    Auto,
    /// The sRGB transfer curve.
    Srgb,
    /// Linear, sRGB primaries.
    LinearSrgb,
    /// Plain numbers: roughness, masks.
    Raw,
}

/// How places between pixels look.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Filtering {
    /// A blend of four pixels.
    Bilinear,
    /// The next pixel.
    Nearest,
}

/// What of a pixel counts.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Channel {
    /// Its colour.
    Rgb,
    /// Red.
    R,
    /// Green.
    G,
    /// Blue.
    B,
    /// Opacity, never decoded; 1 without such a channel.
    A,
    /// CIE luminance.
    Luminance,
}

/// A picture laid over a surface by its uv coordinates. (0, 0) is the lower left corner, v runs up.
///
/// ```scene
/// let soil = texture image { file = "assets/soil.exr", scale = (4, 4), wrap = "mirror" }
/// ```
///
/// Reads PNG and JPEG, HDR and EXR. Infinite values count as 65504, those that are not numbers as 0.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Image<'a> {
    /// The picture.
    #[param(required)]
    file: File<'a>,
    /// How its numbers encode light.
    #[param(choice, default = Space::Auto)]
    space: Space,
    /// What of a pixel counts: its colour, or one number.
    #[param(choice, default = Channel::Rgb)]
    channel: Channel,
    /// How places between pixels look.
    #[param(choice, default = Filtering::Bilinear)]
    filter: Filtering,
    /// What lies beyond the edges.
    #[param(choice, default = Wrap::Repeat)]
    wrap: Wrap,
    /// How often the picture fits into a unit of uv.
    #[param(default = [1.0, 1.0])]
    scale: Vec2,
    /// Added to the scaled uv.
    #[param(default = [0.0, 0.0])]
    offset: Vec2,
    #[param(shared)]
    pixels: Shared<'a, Pixels>,
}

impl Build<Pixels> for Image<'_> {
    fn build(&self, context: &dyn BuildContext) -> Result<Pixels, Vec<Fault>> {
        let path = self.file.path.get();
        let fault = |message: String| vec![Fault::file("file", message)];
        let bytes = context.read(path).map_err(fault)?;
        let mut pixels =
            decode(&bytes, context).map_err(|message| fault(format!("{path}: {message}")))?;
        let srgb = match self.space {
            Space::Auto => pixels.is_integer(),
            Space::Srgb => true,
            Space::LinearSrgb | Space::Raw => false,
        };
        pixels.decode_srgb(srgb, context).map_err(fault)?;
        let odd = pixels.replace(|_| true, context).map_err(fault)?;
        if odd > 0 {
            context.warn(&format!("{odd} values of the picture are not finite"));
        }
        context.holds(pixels.bytes());
        Ok(pixels)
    }
}

impl Image<'_> {
    fn number(&self, column: usize, row: usize) -> f32 {
        let pixels = &self.pixels;
        match self.channel {
            Channel::R => pixels.rgb(column, row).x,
            Channel::G => pixels.rgb(column, row).y,
            Channel::B => pixels.rgb(column, row).z,
            Channel::A => pixels.alpha(column, row),
            Channel::Rgb | Channel::Luminance => pixels.luminance(column, row),
        }
    }
}

impl Texture for Image<'_> {
    fn eval(&self, at: &TexturePoint) -> Spectrum {
        let pixels = &self.pixels;
        let place = at.uv.as_dvec2() * self.scale.as_dvec2() + self.offset.as_dvec2();
        let place = [place.x, 1.0 - place.y];
        let colour = |column, row| pixels.rgb(column, row);
        let number = |column, row| self.number(column, row);
        match (self.channel, self.filter) {
            (Channel::Rgb, Filtering::Bilinear) => {
                Spectrum::from_rgb(pixels.bilinear(place, [self.wrap; 2], colour))
            }
            (Channel::Rgb, Filtering::Nearest) => {
                Spectrum::from_rgb(pixels.nearest(place, self.wrap, colour))
            }
            (_, Filtering::Bilinear) => {
                Spectrum::splat(pixels.bilinear(place, [self.wrap; 2], number))
            }
            (_, Filtering::Nearest) => Spectrum::splat(pixels.nearest(place, self.wrap, number)),
        }
    }

    fn output(&self) -> Output {
        if self.channel == Channel::Rgb { Output::Rgb } else { Output::Value }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use glam::DVec3;
    use luxel_sdk::color::Wavelengths;
    use luxel_sdk::params::Text;

    use super::*;
    use crate::stop::testing::Patience;
    use crate::texture::testing::encoded;

    /// A file system with one file in it.
    struct One(Vec<u8>);

    impl BuildContext for One {
        fn read(&self, path: &str) -> Result<Arc<[u8]>, String> {
            if path == "a.png" { Ok(self.0.clone().into()) } else { Err("no such file".into()) }
        }
        fn read_beside(&self, _base: &str, path: &str) -> Result<Arc<[u8]>, String> {
            self.read(path)
        }
        fn warn(&self, _message: &str) {}
    }

    /// Black at the upper left, red beside it, half opaque grey below.
    fn files() -> One {
        let raw = vec![0, 0, 0, 255, 255, 0, 0, 255, 128, 128, 128, 128, 128, 128, 128, 128];
        let picture = image::RgbaImage::from_raw(2, 2, raw).unwrap();
        One(encoded(picture, image::ImageFormat::Png))
    }

    fn texture(pixels: &Pixels, space: Space, channel: Channel) -> Image<'_> {
        Image {
            file: File { path: Text::new("a.png") },
            space,
            channel,
            filter: Filtering::Nearest,
            wrap: Wrap::Repeat,
            scale: Vec2::ONE,
            offset: Vec2::ZERO,
            pixels: Shared::new(pixels),
        }
    }

    fn at(u: f32, v: f32) -> TexturePoint {
        let lambda = Wavelengths::sample(0.5);
        TexturePoint { p: DVec3::ZERO, uv: Vec2::new(u, v), lambda }
    }

    #[test]
    fn v_runs_up_and_colours_are_decoded_but_opacity_is_not() {
        let empty = decode(&files().0, &Patience::endless()).unwrap();
        let pixels = texture(&empty, Space::Auto, Channel::Rgb).build(&files()).unwrap();
        let colour = texture(&pixels, Space::Auto, Channel::Rgb);
        assert_eq!(colour.eval(&at(0.75, 0.75)).rgb(), glam::Vec3::X);
        assert_eq!(colour.output(), Output::Rgb);
        // sRGB 128 is linear .2158605.
        assert!((colour.eval(&at(0.25, 0.25)).lane(0) - 0.215_860_5).abs() < 1e-7);
        let alpha = texture(&pixels, Space::Auto, Channel::A);
        assert!((alpha.eval(&at(0.25, 0.25)).lane(0) - 128.0 / 255.0).abs() < 1e-7);
        assert_eq!(alpha.output(), Output::Value);
        let luminance = texture(&pixels, Space::Auto, Channel::Luminance);
        assert!((luminance.eval(&at(0.75, 0.75)).lane(0) - 0.212_639).abs() < 1e-5);
    }

    #[test]
    fn what_is_held_is_counted_as_it_is_decoded() {
        let picture = image::RgbImage::new(300, 200);
        let png = encoded(picture, image::ImageFormat::Png);
        assert!(png.len() < 10_000, "black packs well, but into {}", png.len());
        let pixels = decode(&png, &Patience::endless()).unwrap();
        let patience = Patience { bytes: png.into(), ..Patience::endless() };
        texture(&pixels, Space::Auto, Channel::Rgb).build(&patience).unwrap();
        // And what each of 256 values stands for.
        assert_eq!(patience.held.get(), 300 * 200 * 3 + 256 * size_of::<f32>());
    }

    #[test]
    fn raw_numbers_stay_and_missing_files_are_told() {
        let empty = decode(&files().0, &Patience::endless()).unwrap();
        let mut raw = texture(&empty, Space::Raw, Channel::G);
        let pixels = raw.build(&files()).unwrap();
        let value = texture(&pixels, Space::Raw, Channel::G).eval(&at(0.25, 0.25)).lane(0);
        assert!((value - 128.0 / 255.0).abs() < 1e-7);
        raw.file.path = Text::new("b.png");
        let faults = raw.build(&files()).err().unwrap();
        assert_eq!((faults[0].field, faults[0].code), ("file", "E0413"));
    }
}
