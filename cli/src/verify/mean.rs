//! Means of pixels with their standard errors.

use glam::DVec3;
use luxel_core::film::{Film, Rect};
use luxel_core::scene::Area;
use luxel_sdk::color::RgbSpace;

/// A mean per channel, and its standard error.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mean {
    pub(super) value: DVec3,
    pub(super) error: DVec3,
}

/// The mean of some pixels, all of which were measured.
pub(super) fn mean(film: &Film, of: Area) -> Mean {
    match of {
        Area::Whole => {
            let (value, error) = film.mean();
            Mean { value, error }
        }
        Area::Region(rect) => mean_of(film, rect),
    }
}

/// The same of a rectangle inside the film's window.
pub(super) fn mean_of(film: &Film, rect: Rect) -> Mean {
    let (mut sum, mut variance) = (DVec3::ZERO, DVec3::ZERO);
    for pixel in rect.points().map(|at| film.pixel(at)) {
        let error = pixel.standard_error();
        sum += pixel.mean;
        variance += error * error;
    }
    let n = rect.area() as f64;
    let error = DVec3::new(variance.x.sqrt(), variance.y.sqrt(), variance.z.sqrt());
    Mean { value: sum / n, error: error / n }
}

/// Of standard errors an upper bound: the channels are taken as fully correlated.
pub(super) fn luminance(rgb: DVec3) -> f64 {
    rgb.dot(RgbSpace::default().luminance_weights())
}
