//! The PNG: eight bits per channel, exposed and shown as the film says.

use std::io::{self, Write};

use glam::{DVec3, UVec2};
use image::codecs::png::PngEncoder;
use image::{ExtendedColorType, ImageEncoder, ImageError};
use luxel_core::film::{Film, Pixel};
use luxel_core::stage;

use super::display;

/// Writes the film's window.
///
/// # Errors
/// The writer's.
pub(super) fn write(to: impl Write, film: &Film, settings: &stage::Film) -> io::Result<()> {
    let scale = display::scale(settings.exposure);
    let shown = |pixel: &Pixel| display::show(pixel.mean * scale, settings.display);
    write_signal(to, film.window.size, film.pixels().map(|(_, pixel)| shown(pixel)))
}

/// Writes what a screen is to show, row by row, in [0, 1].
///
/// # Errors
/// The writer's.
#[expect(clippy::cast_possible_truncation, reason = "the signal lies in [0, 1]")]
#[expect(clippy::cast_sign_loss, reason = "the signal lies in [0, 1]")]
pub(crate) fn write_signal(
    to: impl Write,
    size: UVec2,
    signal: impl Iterator<Item = DVec3>,
) -> io::Result<()> {
    // Half a step up, then cut: rounds to the nearest; what is not a number becomes black.
    let bytes: Vec<u8> =
        signal.flat_map(|shown| shown.to_array().map(|x| (x * 255.0 + 0.5) as u8)).collect();
    PngEncoder::new(to).write_image(&bytes, size.x, size.y, ExtendedColorType::Rgb8).map_err(
        |error| match error {
            ImageError::IoError(error) => error,
            other => io::Error::other(other),
        },
    )
}

#[cfg(test)]
mod tests {
    use luxel_core::film::Rect;

    use super::*;

    #[test]
    fn a_png_is_read_back_with_the_windows_size() {
        let film = Film::new(UVec2::splat(16), Rect::new(UVec2::new(2, 1), UVec2::new(5, 3)));
        let mut file = vec![];
        write(&mut file, &film, &stage::Film::default()).unwrap();
        let read = image::load_from_memory(&file).unwrap().to_rgb8();
        assert_eq!(read.dimensions(), (5, 3));
        assert!(read.pixels().all(|pixel| pixel.0 == [0; 3]));
    }
}
