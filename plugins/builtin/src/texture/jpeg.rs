//! JPEG pictures, decoded while they are wanted.

use std::sync::atomic::{AtomicBool, Ordering};

use ::image::{DynamicImage, GrayImage, RgbImage};
use luxel_sdk::params::{BuildContext, apart};
use zune_jpeg::JpegDecoder;
use zune_jpeg::zune_core::colorspace::ColorSpace;
use zune_jpeg::zune_core::options::DecoderOptions;

use crate::stop::Stoppable;

/// Pixels from which on a picture is decoded apart: the last step of a progressive one, from its
/// coefficients to pixels, cannot be stopped.
const LARGE: u64 = 1 << 19;

/// The pixels of a sound picture of at most `side` pixels on a side and `room` bytes; `None` where
/// something is wrong with it, or it is not wanted any more.
///
/// The decoder is the one that `image` uses, with the same outcome, but reads its bytes as it comes to
/// them and so can be stopped at any of them. Being strict it ends there, where it would else make what
/// it can of a damaged file.
pub(super) fn sound(
    bytes: &[u8],
    (side, room): (u32, u64),
    context: &dyn BuildContext,
) -> Option<DynamicImage> {
    let side = usize::try_from(side).ok()?;
    let options = DecoderOptions::default().set_strict_mode(true);
    let options = options.set_max_width(side).set_max_height(side);
    let is_over = || context.cancelled();
    let mut decoder = JpegDecoder::new_with_options(Stoppable::new(bytes, &is_over), options);
    decoder.decode_headers().ok()?;
    let (width, height) = decoder.dimensions()?;
    let (space, channels) = match decoder.input_colorspace()? {
        ColorSpace::Luma => (ColorSpace::Luma, 1),
        _ => (ColorSpace::RGB, 3),
    };
    let n_pixels = (width as u64).saturating_mul(height as u64);
    if n_pixels.saturating_mul(channels) > room {
        return None;
    }
    let options = options.jpeg_set_out_colorspace(space);
    let pixels = if n_pixels < LARGE {
        decode(bytes, options, &is_over)?
    } else {
        let bytes = bytes.to_vec();
        let work = move |is_over: &AtomicBool| {
            decode(&bytes, options, &|| is_over.load(Ordering::Relaxed))
        };
        apart(&|| !is_over(), work).ok()??
    };
    let (width, height) = (u32::try_from(width).ok()?, u32::try_from(height).ok()?);
    match space {
        ColorSpace::Luma => GrayImage::from_raw(width, height, pixels).map(Into::into),
        _ => RgbImage::from_raw(width, height, pixels).map(Into::into),
    }
}

fn decode(bytes: &[u8], options: DecoderOptions, is_over: &dyn Fn() -> bool) -> Option<Vec<u8>> {
    JpegDecoder::new_with_options(Stoppable::new(bytes, is_over), options).decode().ok()
}

#[cfg(test)]
mod tests {
    use ::image::ImageFormat;
    use luxel_sdk::sampling::Rng;

    use super::*;
    use crate::stop::testing::{Patience, ends_wherever};
    use crate::texture::testing;

    const MOST: (u32, u64) = (1 << 16, 1 << 30);

    fn encoded(picture: &DynamicImage) -> Vec<u8> {
        testing::encoded(picture.clone(), ImageFormat::Jpeg)
    }

    fn noise(side: u32) -> RgbImage {
        let mut rng = Rng::new(5);
        RgbImage::from_fn(side, side, |_, _| {
            let [r, g, b, _] = rng.u32().to_le_bytes();
            [r, g, b].into()
        })
    }

    #[test]
    fn the_pixels_are_those_of_the_usual_decoder_to_the_bit() {
        let colours = DynamicImage::ImageRgb8(noise(77));
        let grey = DynamicImage::ImageLuma8(colours.to_luma8());
        let large = noise(800).into();
        assert!(u64::from(800_u32 * 800) > LARGE);
        for jpeg in [encoded(&colours), encoded(&grey), encoded(&large)] {
            let usual = ::image::load_from_memory(&jpeg).unwrap();
            assert_eq!(sound(&jpeg, MOST, &Patience::endless()), Some(usual));
        }
    }

    #[test]
    fn what_is_damaged_or_too_large_is_left_to_others() {
        let jpeg = encoded(&noise(32).into());
        let endless = Patience::endless();
        assert_eq!(sound(&jpeg[..jpeg.len() / 2], MOST, &endless), None);
        assert_eq!(sound(&jpeg, (31, 1 << 30), &endless), None);
        assert_eq!(sound(&jpeg, (32, 32 * 32 * 3 - 1), &endless), None);
        assert!(sound(&jpeg, (32, 32 * 32 * 3), &endless).is_some());
    }

    #[test]
    fn decoding_ends_wherever_it_is_not_wanted_any_more() {
        let jpeg = encoded(&noise(256).into());
        let looks = ends_wherever(|patience| sound(&jpeg, MOST, patience).ok_or(()));
        // A look for every few bytes: each stands for a few pixels.
        assert!(looks >= jpeg.len() / 64, "{looks} looks while {} bytes are read", jpeg.len());
    }
}
