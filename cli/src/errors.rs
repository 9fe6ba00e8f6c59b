//! How wrong the pixels of a picture may be.

use luxel_core::film::Film;
use luxel_sdk::color::RgbSpace;

/// Pixels that tell about a picture.
const ENOUGH: usize = 1 << 16;

/// Relative standard error of pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Errors {
    /// Half of the pixels have less.
    pub(crate) median: f64,
    /// All but a twentieth have less.
    pub(crate) p95: f64,
}

impl Errors {
    /// Relative standard error of luminance, over the pixels that have two samples and are not black.
    /// Errors of the channels are taken as fully correlated, which they nearly are: an upper bound.
    pub(crate) fn of_film(film: &Film) -> Option<Self> {
        Self::of_every(1, film)
    }

    /// The same of some of its pixels: for those who ask often.
    pub(crate) fn about(film: &Film) -> Option<Self> {
        // An odd step does not run down columns.
        Self::of_every((film.window.area() / ENOUGH) | 1, film)
    }

    fn of_every(step: usize, film: &Film) -> Option<Self> {
        let weights = RgbSpace::LinearSrgb.luminance_weights();
        let relative = film.pixels().step_by(step).filter_map(|(_, pixel)| {
            let (mean, error) = (weights.dot(pixel.mean), weights.dot(pixel.standard_error()));
            // A pixel that saw nothing but black is black without error, as far as one can tell.
            let relative = if error > 0.0 { error / mean } else { 0.0 };
            (pixel.n >= 2 && relative.is_finite()).then_some(relative)
        });
        let mut sorted: Vec<f64> = relative.collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let last = sorted.len().checked_sub(1)?;
        Some(Self { median: sorted[last / 2], p95: sorted[last - last / 20] })
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;
    use luxel_core::film::Rect;

    use super::*;

    #[test]
    fn a_picture_without_two_samples_has_no_known_error() {
        let film = Film::new(UVec2::splat(4), Rect::new(UVec2::ZERO, UVec2::splat(4)));
        assert_eq!(Errors::of_film(&film), None);
    }
}
