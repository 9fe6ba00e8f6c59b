//! EXR pictures, decoded to where they stay.

use ::exr::block::{self, UncompressedBlock};
use ::exr::image::read::image::{LayersReader as _, ReadLayers as _};
use ::exr::image::read::read;
use ::exr::meta::attribute::Text;
use ::exr::prelude::ReadChannels as _;
use ::image::{DynamicImage, Rgb32FImage, Rgba32FImage};
use luxel_sdk::params::BuildContext;

use super::unpack::unpack;
use crate::stop::Stoppable;

/// The pixels of a sound picture of at most `side` pixels on a side and `room` bytes, in one part that is
/// there as a whole; `None` where that is not so, or it is not wanted any more.
///
/// The decoder is the one that `image` uses, with the same outcome. That one copies all pixels at the end,
/// which takes twice the memory, and as much as a tenth of a second in which nobody asks.
pub(super) fn sound(
    bytes: &[u8],
    (side, room): (u32, u64),
    context: &dyn BuildContext,
) -> Option<DynamicImage> {
    let is_over = || context.cancelled();
    let file = block::read(Stoppable::new(bytes, &is_over), false).ok()?;
    let [header] = file.headers() else { return None };
    let (window, own) = (header.shared_attributes.display_window, &header.own_attributes);
    let is_whole = own.layer_position == window.position && header.layer_size == window.size;
    let has = |name| header.channels.find_index_of_channel(&Text::from(name)).is_some();
    if header.deep || !is_whole || !["R", "G", "B"].into_iter().all(has) {
        return None;
    }
    let channels = if has("A") { 4 } else { 3 };
    let (width, height) = (u32::try_from(window.size.0).ok()?, u32::try_from(window.size.1).ok()?);
    let n_bytes = u64::from(width) * u64::from(height) * 4 * channels as u64;
    if width.max(height) > side || n_bytes > room {
        return None;
    }
    let row = window.size.0 * channels;
    let layers = read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            move |size, _| vec![0.0; size.area() * channels],
            move |pixels: &mut Vec<f32>, at, (r, g, b, a): (f32, f32, f32, f32)| {
                let i = at.1 * row + at.0 * channels;
                pixels[i..i + channels].copy_from_slice(&[r, g, b, a][..channels]);
            },
        )
        .first_valid_layer();
    let mut picture = layers.create_layers_reader(file.headers()).ok()?;
    let is_seen = |meta: &_, tile, block| picture.filter_block(meta, tile, block);
    let chunks = file.filter_chunks(false, is_seen).ok()?;
    let plainly = |chunk, meta: &_| UncompressedBlock::decompress_chunk(chunk, meta, false);
    unpack(chunks, context, plainly, |meta, block| picture.read_block(&meta.headers, block).ok())?;
    let pixels = picture.into_layers().channel_data.pixels;
    match channels {
        3 => Rgb32FImage::from_raw(width, height, pixels).map(Into::into),
        _ => Rgba32FImage::from_raw(width, height, pixels).map(Into::into),
    }
}

#[cfg(test)]
mod tests {
    use ::image::ImageFormat;
    use luxel_sdk::sampling::Rng;

    use super::*;
    use crate::stop::testing::{Patience, ends_wherever, ends_within};
    use crate::texture::testing;

    const LARGE: (u32, u64) = (1 << 16, 1 << 30);

    fn encoded(picture: &DynamicImage) -> Vec<u8> {
        testing::encoded(picture.clone(), ImageFormat::OpenExr)
    }

    fn noise(width: u32, height: u32) -> Rgba32FImage {
        let mut rng = Rng::new(6);
        Rgba32FImage::from_fn(width, height, |_, _| {
            ::image::Rgba([(); 4].map(|()| 9.0 * rng.f32()))
        })
    }

    #[test]
    fn the_pixels_are_those_of_the_usual_decoder_to_the_bit() {
        let with_alpha = DynamicImage::ImageRgba32F(noise(77, 40));
        let without = DynamicImage::ImageRgb32F(with_alpha.to_rgb32f());
        for exr in [encoded(&with_alpha), encoded(&without)] {
            let usual = ::image::load_from_memory(&exr).unwrap();
            assert_eq!(sound(&exr, LARGE, &Patience::endless()), Some(usual));
        }
    }

    #[test]
    fn what_is_damaged_or_too_large_is_left_to_others() {
        let exr = encoded(&noise(32, 16).into());
        let endless = Patience::endless();
        assert_eq!(sound(&exr[..exr.len() / 2], LARGE, &endless), None);
        assert_eq!(sound(&exr, (31, 1 << 30), &endless), None);
        assert_eq!(sound(&exr, (32, 32 * 16 * 16 - 1), &endless), None);
        assert!(sound(&exr, (32, 32 * 16 * 16), &endless).is_some());
    }

    #[test]
    fn decoding_ends_wherever_it_is_not_wanted_any_more() {
        let exr = encoded(&noise(64, 512).into());
        // How often it looks while it waits for blocks is a matter of time; while it reads it is not.
        let sure = ends_wherever(|patience| {
            let is_over = || patience.cancelled();
            let file = block::read(Stoppable::new(&exr, &is_over), false)?;
            file.filter_chunks(false, |_, _, _| true)?.try_for_each(|chunk| chunk.map(drop))
        });
        assert!(sure >= 512 / 16, "{sure} looks");
        ends_within(sure, |patience| sound(&exr, LARGE, patience).ok_or(()));
    }
}
