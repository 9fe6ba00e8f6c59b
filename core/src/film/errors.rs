//! How wrong the pixels of a picture may be.

use glam::UVec2;
use luxel_sdk::color::RgbSpace;

use super::{Film, Pixel, Tile};

/// Share of the picture's mean that a darker pixel's error is compared with: what is darker is seen as
/// dark, and no number of samples makes black right to a per cent.
const DARK: f64 = 0.1;
/// Pixels that tell about a picture.
const ENOUGH: usize = 1 << 16;

/// Standard error of pixels' luminance, relative to it or to a tenth of the picture's mean where that
/// is more.
///
/// Errors of the channels are taken as fully correlated, which they nearly are: an upper estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// Root of the mean square.
    pub rms: f64,
    /// Half of the pixels have less.
    pub median: f64,
    /// All but a twentieth have less.
    pub p95: f64,
    /// The largest.
    pub worst: f64,
    /// Where that is.
    pub worst_at: UVec2,
    /// Pixels above `limit`.
    pub above: u64,
    /// Tiles of which the root mean square is above it.
    pub tiles_above: u64,
}

impl Errors {
    /// Over the pixels that have two samples; nothing if none has. `limit` is what those
    /// above are counted by.
    pub fn of_film(film: &Film, limit: f64) -> Option<Self> {
        Self::of_every(1, film, limit)
    }

    /// The same of some of its pixels: for those who ask often.
    pub fn about(film: &Film) -> Option<Self> {
        // An odd step does not run down columns.
        Self::of_every((film.window.area() / ENOUGH) | 1, film, f64::INFINITY)
    }

    fn of_every(step: usize, film: &Film, limit: f64) -> Option<Self> {
        let scale = Scale::of(film);
        let pixels = film.pixels().step_by(step);
        let found = pixels.filter_map(|(at, pixel)| Some((scale.error(pixel)?, at)));
        let mut sorted: Vec<(f64, UVec2)> = found.collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let last = sorted.len().checked_sub(1)?;
        let squares: f64 = sorted.iter().map(|(error, _)| error * error).sum();
        let (worst, worst_at) = sorted[last];
        // A tile of which nothing is known is not good.
        let is_above = |tile: &Tile| {
            scale.of_tile(tile).is_none_or(|error| error > limit) && limit.is_finite()
        };
        Some(Self {
            rms: (squares / sorted.len() as f64).sqrt(),
            median: sorted[last / 2].0,
            p95: sorted[last - last / 20].0,
            worst,
            worst_at,
            above: sorted.iter().filter(|(error, _)| *error > limit).count() as u64,
            tiles_above: film.tiles().iter().filter(|tile| is_above(tile)).count() as u64,
        })
    }
}

/// What errors of a picture are compared with.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scale {
    weights: glam::DVec3,
    /// The least luminance.
    dark: f64,
}

impl Scale {
    pub(crate) fn of(film: &Film) -> Self {
        let weights = RgbSpace::LinearSrgb.luminance_weights();
        Self { weights, dark: DARK * weights.dot(film.mean().0) }
    }

    /// Nothing below two samples, and where the error is beyond numbers. A picture that is black all
    /// over is black without error, as far as one can tell.
    pub(super) fn error(&self, pixel: &Pixel) -> Option<f64> {
        let error = self.weights.dot(pixel.standard_error());
        let value = self.weights.dot(pixel.mean).max(self.dark);
        let relative = if error > 0.0 { error / value } else { 0.0 };
        (pixel.n >= 2 && relative.is_finite()).then_some(relative)
    }

    /// Root mean square over a tile; nothing where none of its pixels is known.
    pub(crate) fn of_tile(&self, tile: &Tile) -> Option<f64> {
        let known = tile.pixels().filter_map(|pixel| self.error(pixel));
        let (squares, n) = known.fold((0.0, 0.0), |(sum, n), error| (sum + error * error, n + 1.0));
        (n > 0.0).then(|| (squares / n).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::film::Rect;

    /// Two samples of each of 100 pixels: the mean of pixel i is 1, its standard error i / 100.
    fn film() -> Film {
        let mut film = Film::new(UVec2::splat(10), Rect::new(UVec2::ZERO, UVec2::splat(10)));
        for (i, pixel) in (0_u8..).zip(film.tiles_mut()[0].pixels_mut()) {
            for sign in [-1.0, 1.0] {
                pixel.push(DVec3::splat(1.0 + sign * f64::from(i) / 100.0));
            }
        }
        film
    }

    #[test]
    fn a_picture_without_two_samples_has_no_known_error() {
        let film = Film::new(UVec2::splat(4), Rect::new(UVec2::ZERO, UVec2::splat(4)));
        assert_eq!(Errors::of_film(&film, 0.0), None);
    }

    #[test]
    fn shares_the_worst_and_those_above_are_told() {
        let errors = Errors::of_film(&film(), 0.905).unwrap();
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        near(errors.median, 0.49);
        near(errors.p95, 0.95);
        near(errors.worst, 0.99);
        // The mean of i² for i below 100 is 99 · 199 / 6.
        near(errors.rms, (99.0 * 199.0 / 6.0_f64).sqrt() / 100.0);
        assert_eq!((errors.worst_at, errors.above, errors.tiles_above), (UVec2::splat(9), 9, 0));
    }

    #[test]
    fn dark_pixels_are_compared_with_a_tenth_of_the_picture() {
        let mut film = film();
        let dark = film.tiles_mut()[0].pixel_mut(0);
        *dark = Pixel::NONE;
        for x in [0.0, 0.02] {
            dark.push(DVec3::splat(x));
        }
        // Mean .01 and standard error .01 in a picture of mean .9901.
        let scale = Scale::of(&film);
        let error = scale.error(film.pixel(UVec2::ZERO)).unwrap();
        assert!((error - 0.01 / 0.09901).abs() < 1e-12, "{error}");
    }
}
