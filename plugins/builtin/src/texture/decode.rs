//! Picture files, kept as compactly as they are.

use std::error::Error;
use std::io;
use std::ops::{Add, Mul};

use ::image::{DynamicImage, ImageError, ImageFormat, ImageReader, Limits};
use glam::Vec3;
use luxel_sdk::Choice;
use luxel_sdk::color::{RgbSpace, srgb_decode};
use luxel_sdk::params::BuildContext;

use super::{exr, jpeg};
use crate::sniff;
use crate::stop::{STRIDE, Stoppable, go_on};

/// The largest side that is read, pixels.
const MAX_SIDE: u32 = 1 << 16;
/// Memory that a decoded picture may take: this much, and so much for each byte of its file.
/// Deflate packs at most 1032 bytes into one, and half floats double.
const MAX_BYTES: (u64, u64) = (64 << 20, 2100);
/// The most memory for one picture, bytes.
const MAX_ALLOC: u64 = 4 << 30;
/// The largest half float: what infinity in a picture counts as.
const LARGEST: f32 = 65504.0;

/// What lies beyond a picture's edges.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Wrap {
    /// The picture again.
    Repeat,
    /// Its outermost pixels.
    Clamp,
    /// The picture mirrored.
    Mirror,
}

impl Wrap {
    /// A coordinate brought into [0, 1]; 0 for one that is not finite.
    fn inside(self, x: f64) -> f64 {
        if !x.is_finite() {
            return 0.0;
        }
        match self {
            Self::Repeat => x - x.floor(),
            Self::Clamp => x.clamp(0.0, 1.0),
            Self::Mirror => 1.0 - (x.rem_euclid(2.0) - 1.0).abs(),
        }
    }

    /// The two of `n` pixels around a coordinate, and the share of the second.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within [0, n]")]
    fn pair(self, x: f64, n: usize) -> ([usize; 2], f32) {
        let at = self.inside(x) * n as f64 + 0.5;
        // Counted from one pixel before the first.
        let second = (at as usize).min(n);
        let share = (at - second as f64) as f32;
        let pair = match self {
            Self::Repeat => [(second + n - 1) % n, second % n],
            Self::Clamp | Self::Mirror => [second.saturating_sub(1), second.min(n - 1)],
        };
        (pair, share)
    }

    /// The pixel of `n` at a coordinate.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within [0, n]")]
    fn nearest(self, x: f64, n: usize) -> usize {
        ((self.inside(x) * n as f64) as usize).min(n - 1)
    }
}

enum Data {
    U8(Vec<u8>),
    U16(Vec<u16>),
    F32(Vec<f32>),
}

/// A decoded picture: rows from the top, channels interleaved as in the file.
pub(crate) struct Pixels {
    width: usize,
    height: usize,
    /// 1 grey, 2 with alpha, 3 RGB, 4 with alpha.
    channels: usize,
    data: Data,
    /// What the whole numbers of the colour channels stand for; empty for floats.
    values: Vec<f32>,
    /// Of red, green and blue in luminance.
    weights: Vec3,
}

/// Decodes PNG, JPEG, HDR or EXR.
///
/// # Errors
/// What the file is and what is wrong with it; the decoder's own words stand in brackets. That it is not
/// wanted any more.
pub(crate) fn decode(bytes: &[u8], context: &dyn BuildContext) -> Result<Pixels, String> {
    let format = ::image::guess_format(bytes).ok();
    let name = match format {
        Some(ImageFormat::Png) => "PNG",
        Some(ImageFormat::Jpeg) => "JPEG",
        Some(ImageFormat::Hdr) => "HDR",
        Some(ImageFormat::OpenExr) => "EXR",
        _ => {
            let found = sniff::what(bytes);
            return Err(format!("not a picture that can be read but {found}; {READABLE}"));
        }
    };
    if name == "JPEG" && !has_end(bytes) {
        return Err(format!("a JPEG picture that {CUT}"));
    }
    let is_over = || context.cancelled();
    let mut reader = ImageReader::new(Stoppable::new(bytes, &is_over));
    reader.set_format(format.expect("it has just been named"));
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    let room = (bytes.len() as u64).saturating_mul(MAX_BYTES.1).saturating_add(MAX_BYTES.0);
    limits.max_alloc = Some(room.min(MAX_ALLOC));
    reader.limits(limits);
    let most = (MAX_SIDE, room.min(MAX_ALLOC));
    let sound = match format {
        Some(ImageFormat::Jpeg) => jpeg::sound(bytes, most, context),
        Some(ImageFormat::OpenExr) => exr::sound(bytes, most, context),
        _ => None,
    };
    go_on(context)?;
    let picture = sound.map_or_else(|| reader.decode(), Ok);
    let picture = picture
        .map_err(|error| format!("{} {name} picture {}", article(name), wrong(bytes, &error)))?;
    Pixels::new(picture).ok_or_else(|| format!("{} {name} picture without pixels", article(name)))
}

const READABLE: &str = "PNG, JPEG, HDR (Radiance) and EXR are";
const CUT: &str = "ends too early: copy or export it again";

/// What the EXR decoder makes of a file's early end.
const EXR_CUT: &str = "missing bytes";

fn article(name: &str) -> &'static str {
    if name == "PNG" || name == "JPEG" { "a" } else { "an" }
}

/// What a decoder's complaint means, as the end of a sentence that begins with the picture.
fn wrong(bytes: &[u8], error: &ImageError) -> String {
    let detail = causes(error).last().map(ToString::to_string).unwrap_or_default();
    let detail = detail.trim_end_matches('.');
    match error {
        ImageError::Limits(_) => format!(
            "that claims more pixels than are read: at most {MAX_SIDE} on a side, and as many as its \
             {} bytes can stand for",
            bytes.len()
        ),
        ImageError::Unsupported(_) => {
            format!("of a kind that is not read ({detail}): save it as RGB, or as PNG")
        }
        _ if is_cut(bytes, error) || detail.contains(EXR_CUT) => format!("that {CUT}"),
        _ => format!("that is damaged ({detail}): copy or export it again"),
    }
}

/// An error, then what lies behind it.
fn causes(error: &ImageError) -> impl Iterator<Item = &(dyn Error + 'static)> {
    let first: &(dyn Error + 'static) = error;
    std::iter::successors(Some(first), |error| (**error).source())
}

fn is_cut(bytes: &[u8], error: &ImageError) -> bool {
    let is_end = |io: &io::Error| io.kind() == io::ErrorKind::UnexpectedEof;
    let early = match error {
        // Passes over itself where it names its source.
        ImageError::IoError(io) => is_end(io),
        _ => causes(error).any(|cause| cause.downcast_ref::<io::Error>().is_some_and(is_end)),
    };
    early || bytes.starts_with(b"\x89PNG") && !bytes.windows(4).rev().any(|word| word == b"IEND")
}

/// Whether a JPEG's last scan has an end: decoders fill up with grey what is missing.
fn has_end(bytes: &[u8]) -> bool {
    let mut pairs = bytes.windows(2).rev();
    // The last of either: in a picture that is whole it is among the last bytes.
    let last = pairs.find(|pair| *pair == [0xff, 0xd9] || *pair == [0xff, 0xda]);
    last == Some(&[0xff, 0xd9])
}

impl Pixels {
    fn new(picture: DynamicImage) -> Option<Self> {
        let (width, height) = (picture.width() as usize, picture.height() as usize);
        let channels = usize::from(picture.color().channel_count());
        let data = match picture {
            DynamicImage::ImageLuma8(p) => Data::U8(p.into_raw()),
            DynamicImage::ImageLumaA8(p) => Data::U8(p.into_raw()),
            DynamicImage::ImageRgb8(p) => Data::U8(p.into_raw()),
            DynamicImage::ImageRgba8(p) => Data::U8(p.into_raw()),
            DynamicImage::ImageLuma16(p) => Data::U16(p.into_raw()),
            DynamicImage::ImageLumaA16(p) => Data::U16(p.into_raw()),
            DynamicImage::ImageRgb16(p) => Data::U16(p.into_raw()),
            DynamicImage::ImageRgba16(p) => Data::U16(p.into_raw()),
            DynamicImage::ImageRgb32F(p) => Data::F32(p.into_raw()),
            DynamicImage::ImageRgba32F(p) => Data::F32(p.into_raw()),
            _ => return None,
        };
        let weights = RgbSpace::LinearSrgb.luminance_weights().as_vec3();
        let mut pixels = Self { width, height, channels, data, values: vec![], weights };
        pixels.values = pixels.table(false);
        (width > 0 && height > 0).then_some(pixels)
    }

    /// Columns, at least 1.
    pub(crate) fn width(&self) -> usize {
        self.width
    }

    /// Rows, at least 1.
    pub(crate) fn height(&self) -> usize {
        self.height
    }

    /// Bytes of memory that it takes.
    pub(crate) fn bytes(&self) -> usize {
        let values = size_of_val(&*self.values);
        values
            + match &self.data {
                Data::U8(numbers) => size_of_val(&**numbers),
                Data::U16(numbers) => size_of_val(&**numbers),
                Data::F32(numbers) => size_of_val(&**numbers),
            }
    }

    /// Whether the file holds whole numbers, which are sRGB by custom.
    pub(crate) fn is_integer(&self) -> bool {
        !matches!(self.data, Data::F32(_))
    }

    /// What whole numbers stand for, as sRGB signals or linear; nothing for floats.
    fn table(&self, srgb: bool) -> Vec<f32> {
        let n = match &self.data {
            Data::U8(_) => 1 << 8,
            Data::U16(_) => 1 << 16,
            Data::F32(_) => return vec![],
        };
        (0..n).map(|i| decoded(f64::from(i) / f64::from(n - 1), srgb)).collect()
    }

    /// States whether colours are sRGB signals or linear; floats are decoded once and for all.
    ///
    /// # Errors
    /// That the picture is not wanted any more.
    pub(crate) fn decode_srgb(
        &mut self,
        srgb: bool,
        context: &dyn BuildContext,
    ) -> Result<(), String> {
        self.values = self.table(srgb);
        let (Data::F32(values), true) = (&mut self.data, srgb) else { return Ok(()) };
        let n_colours = if self.channels == 4 { 3 } else { self.channels };
        for piece in values.chunks_mut(STRIDE * self.channels) {
            go_on(context)?;
            for pixel in piece.chunks_exact_mut(self.channels) {
                for v in &mut pixel[..n_colours] {
                    *v = decoded(f64::from(*v), true);
                }
            }
        }
        Ok(())
    }

    /// Replaces floats that are not finite, or that fail `legal`, by 0 or the largest half float;
    /// says how many.
    ///
    /// # Errors
    /// That the picture is not wanted any more.
    pub(crate) fn replace(
        &mut self,
        legal: impl Fn(f32) -> bool,
        context: &dyn BuildContext,
    ) -> Result<usize, String> {
        let Data::F32(values) = &mut self.data else { return Ok(0) };
        let mut n = 0;
        for piece in values.chunks_mut(STRIDE) {
            go_on(context)?;
            for v in piece.iter_mut().filter(|v| !(v.is_finite() && legal(**v))) {
                *v = if *v > 0.0 { LARGEST } else { 0.0 };
                n += 1;
            }
        }
        Ok(n)
    }

    fn colour(&self, i: usize) -> f32 {
        match &self.data {
            Data::U8(values) => self.values[usize::from(values[i])],
            Data::U16(values) => self.values[usize::from(values[i])],
            Data::F32(values) => values[i],
        }
    }

    /// Linear sRGB of a pixel; grey three times.
    pub(crate) fn rgb(&self, column: usize, row: usize) -> Vec3 {
        let i = (row * self.width + column) * self.channels;
        if self.channels < 3 {
            return Vec3::splat(self.colour(i));
        }
        Vec3::new(self.colour(i), self.colour(i + 1), self.colour(i + 2))
    }

    /// CIE luminance of a pixel.
    pub(crate) fn luminance(&self, column: usize, row: usize) -> f32 {
        self.rgb(column, row).dot(self.weights)
    }

    /// Opacity of a pixel: as it stands in the file, 1 without such a channel.
    pub(crate) fn alpha(&self, column: usize, row: usize) -> f32 {
        if self.channels % 2 == 1 {
            return 1.0;
        }
        let i = (row * self.width + column) * self.channels + self.channels - 1;
        match &self.data {
            Data::U8(values) => f32::from(values[i]) / 255.0,
            Data::U16(values) => f32::from(values[i]) / 65535.0,
            Data::F32(values) => values[i],
        }
    }

    /// A blend of the four pixels around a place: across and down the picture, [0, 1]² for all
    /// of it.
    pub(crate) fn bilinear<T>(
        &self,
        [u, v]: [f64; 2],
        wrap: [Wrap; 2],
        pixel: impl Fn(usize, usize) -> T,
    ) -> T
    where
        T: Add<Output = T> + Mul<f32, Output = T>,
    {
        let (columns, right) = wrap[0].pair(u, self.width);
        let (rows, down) = wrap[1].pair(v, self.height);
        let across = |row| pixel(columns[0], row) * (1.0 - right) + pixel(columns[1], row) * right;
        across(rows[0]) * (1.0 - down) + across(rows[1]) * down
    }

    /// The pixel at a place.
    pub(crate) fn nearest<T>(
        &self,
        [u, v]: [f64; 2],
        wrap: Wrap,
        pixel: impl Fn(usize, usize) -> T,
    ) -> T {
        pixel(wrap.nearest(u, self.width), wrap.nearest(v, self.height))
    }
}

/// A number of a picture as light, which it is already or, as an sRGB signal, stands for.
#[expect(clippy::cast_possible_truncation, reason = "rounds; pictures are of f32")]
fn decoded(x: f64, srgb: bool) -> f32 {
    if srgb { srgb_decode(x) as f32 } else { x as f32 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stop::testing::{Patience, ends_wherever};
    use crate::texture::testing;

    fn encoded(format: ImageFormat) -> Vec<u8> {
        let picture = ::image::Rgb32FImage::from_fn(17, 5, |x, y| {
            #[expect(clippy::cast_precision_loss, reason = "small")]
            ::image::Rgb([x as f32 / 16.0, y as f32 / 4.0, 0.5])
        });
        let picture = DynamicImage::ImageRgb32F(picture);
        let picture = match format {
            ImageFormat::Png => DynamicImage::ImageRgb16(picture.to_rgb16()),
            ImageFormat::Jpeg => DynamicImage::ImageRgb8(picture.to_rgb8()),
            _ => picture,
        };
        testing::encoded(picture, format)
    }

    const FORMATS: [ImageFormat; 4] =
        [ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Hdr, ImageFormat::OpenExr];

    #[test]
    fn every_format_gives_its_pixels_back() {
        // Half a step of each: 16 bits, JPEG's quantisation, a shared exponent, exact.
        for (format, error) in FORMATS.into_iter().zip([8e-6, 0.08, 0.01, 1e-7]) {
            let pixels = decode(&encoded(format), &Patience::endless()).unwrap();
            assert_eq!((pixels.width(), pixels.height()), (17, 5));
            let off = pixels.rgb(12, 3) - Vec3::new(0.75, 0.75, 0.5);
            assert!(off.abs().max_element() <= error, "{format:?} {off}");
            assert!((pixels.alpha(0, 0) - 1.0).abs() <= 0.0);
        }
    }

    #[test]
    fn damaged_files_are_refused_without_a_panic() {
        for format in FORMATS {
            let whole = encoded(format);
            for cut in (0..whole.len()).step_by(whole.len() / 40 + 1) {
                let read = decode(&whole[..cut], &Patience::endless());
                let told = read.err().unwrap_or_else(|| panic!("{format:?} {cut}"));
                assert!(told.contains("picture"), "{told}");
                let mut changed = whole.clone();
                changed[cut] ^= 0x55;
                drop(decode(&changed, &Patience::endless()));
            }
        }
    }

    #[test]
    fn what_is_wrong_with_a_picture_is_said_in_words() {
        for (format, name) in FORMATS.into_iter().zip(["a PNG", "a JPEG", "an HDR", "an EXR"]) {
            let whole = encoded(format);
            let cut = decode(&whole[..whole.len() * 3 / 4], &Patience::endless()).err().unwrap();
            assert!(cut.starts_with(&format!("{name} picture that ends too early")), "{cut}");
        }
        let mut damaged = encoded(ImageFormat::Png);
        damaged[20] ^= 0x55;
        let told = decode(&damaged, &Patience::endless()).err().unwrap();
        assert!(told.starts_with("a PNG picture that is damaged ("), "{told}");
        let told = |bytes: &[u8]| decode(bytes, &Patience::endless()).err().unwrap();
        assert!(told(b"v 0 0 0\n").contains("but text; PNG, JPEG"), "{}", told(b"v 0 0 0\n"));
        assert!(told(b"GIF89a..").contains("a GIF picture"), "{}", told(b"GIF89a.."));
    }

    #[test]
    fn a_small_file_cannot_claim_a_large_picture() {
        for size in [100_000, 60_000] {
            let header = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {size} +X {size}\n");
            let told = decode(header.as_bytes(), &Patience::endless()).err().unwrap();
            assert!(told.contains("more pixels than are read: at most 65536"), "{told}");
        }
    }

    #[test]
    fn pixels_blend_around_their_centres() {
        let pixels = decode(&encoded(ImageFormat::OpenExr), &Patience::endless()).unwrap();
        let red = |u: f64, wrap| pixels.bilinear([u, 0.5], [wrap; 2], |c, r| pixels.rgb(c, r).x);
        for wrap in [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror] {
            // Red runs from 0 at the centre of the first pixel to 1 at that of the last.
            assert!((red(0.5, wrap) - 0.5).abs() < 1e-6);
            assert!((red(3.0 / 17.0, wrap) - 2.5 / 16.0).abs() < 1e-6);
        }
        assert!((red(0.0, Wrap::Repeat) - 0.5).abs() < 1e-6);
        assert!(red(-3.0, Wrap::Clamp).abs() <= 0.0 && (red(1e9, Wrap::Clamp) - 1.0).abs() <= 0.0);
        assert!((red(1.25, Wrap::Mirror) - red(0.75, Wrap::Mirror)).abs() < 1e-6);
        for odd in [f64::NAN, f64::INFINITY, 1e300, -1e300] {
            assert!(red(odd, Wrap::Mirror).is_finite() && red(odd, Wrap::Repeat).is_finite());
        }
        assert!((pixels.nearest([0.999, 0.0], Wrap::Clamp, |c, _| c) == 16));
    }

    #[test]
    fn decoding_ends_soon_after_it_is_not_wanted_any_more() {
        let mut noise = 1u32;
        let mut byte = || {
            noise = noise.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            noise.to_be_bytes()[0]
        };
        let picture = ::image::RgbImage::from_fn(512, 512, |_, _| [byte(), byte(), byte()].into());
        let png = testing::encoded(picture, ImageFormat::Png);
        let whole = Patience::endless();
        decode(&png, &whole).unwrap();
        let looks = whole.looks.get();
        assert!(looks >= png.len() >> 12, "{looks} looks while {} bytes are read", png.len());
        for most in [0, 1, looks / 2] {
            let patience = Patience::of(most);
            assert!(decode(&png, &patience).is_err());
            assert!(patience.looks.get() <= most + 2, "went on after {most} looks");
        }
    }

    #[test]
    fn what_is_made_of_floats_ends_soon_after_it_is_not_wanted_any_more() {
        let side = 160;
        let picture = DynamicImage::ImageRgb32F(::image::Rgb32FImage::new(side, side));
        let n_floats = 3 * (side * side) as usize;
        let made = |patience: &Patience, work: fn(&mut Pixels, &Patience) -> Result<(), String>| {
            work(&mut Pixels::new(picture.clone()).unwrap(), patience)
        };
        let looks = ends_wherever(|it| made(it, |pixels, it| pixels.decode_srgb(true, it)));
        assert!(looks >= n_floats / (3 * STRIDE), "{looks} looks");
        let legal = |pixels: &mut Pixels, it: &Patience| pixels.replace(|_| true, it).map(drop);
        let looks = ends_wherever(|it| made(it, legal));
        assert!(looks >= n_floats / STRIDE, "{looks} looks");
    }
}
