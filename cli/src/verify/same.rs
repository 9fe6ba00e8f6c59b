//! Whether two pictures are the same, up to their noise.
//!
//! Each channel of each tile of 8 × 8 pixels is tested (Welch's t), each at such a level that all
//! together err once in a hundred (Šidák 1967).

use glam::{DVec3, UVec2};
use luxel_core::film::{Film, Rect, degrees_of_freedom};
use luxel_core::scene::Area;

use super::mean::{luminance, mean, mean_of};
use super::row::{Measured, Row, Verdict};
use crate::compare::{share_of_error, two_sided};
use crate::exit::{Exit, Failure};

/// Side of a tile, pixels.
const TILE: u32 = 8;

/// Probability with which equal pictures are called different.
const ALPHA: f64 = 0.01;

/// Share of a mean that rounding may take in single precision.
const ROUNDING: f64 = 1e-5;

/// A channel of a tile, in both pictures.
#[derive(Clone, Copy, Debug)]
struct Pair {
    tile: Rect,
    channel: usize,
    means: [f64; 2],
    /// Of their difference.
    error: f64,
    /// Welch and Satterthwaite's degrees of freedom of that.
    dof: f64,
}

impl Pair {
    /// How likely chance alone sets the two so far apart, beside rounding.
    fn p(&self) -> f64 {
        let [own, other] = self.means;
        let off = (own - other).abs() - ROUNDING * other.abs();
        // Without noise nothing but rounding may differ; a mean that is no number always does.
        match off {
            _ if off.is_nan() => 0.0,
            _ if off <= 0.0 => 1.0,
            _ => two_sided(off / self.error, self.dof),
        }
    }
}

/// The test of the first picture against the second: where they differ, told by the tile that differs
/// most, else by the luminance of the whole.
///
/// # Errors
/// Pictures of different sizes.
pub(super) fn test((id, case): (&str, &str), film: &Film, other: &Film) -> Result<Row, Failure> {
    if film.window != other.window {
        let sizes = [film, other].map(|film| format!("{} x {}", film.size.x, film.size.y));
        let message = format!("{id}: the pictures have different sizes: {}", sizes.join(", "));
        return Err(Failure::new(Exit::Input, message));
    }
    let pairs = tiles(film.window).flat_map(|tile| pairs(film, other, tile)).collect::<Vec<_>>();
    let limit = share_of_error(ALPHA, pairs.len() as f64);
    let tested = pairs.iter().map(|pair| (pair, pair.p()));
    let worst = tested.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, p)| *p < limit);
    if let Some((worst, _)) = worst {
        return Ok(different((id, case), worst));
    }
    let [own, others] = [film, other].map(|film| mean(film, Area::Whole));
    let (value, expected) = (luminance(own.value), luminance(others.value));
    let error = luminance(own.error).hypot(luminance(others.error));
    let tolerance = ROUNDING * expected.abs();
    Ok(Row::new((id, case), expected, Measured { value, error }, tolerance))
}

fn different((id, case): (&str, &str), worst: &Pair) -> Row {
    let Pair { tile, channel, means: [value, expected], error, .. } = *worst;
    let case = format!("{case}, {} {}", Area::Region(tile), ["R", "G", "B"][channel]);
    let row = Row::new((id, &case), expected, Measured { value, error }, ROUNDING * expected.abs());
    Row { verdict: Verdict::Wrong, ..row }
}

/// The tiles of a window.
fn tiles(window: Rect) -> impl Iterator<Item = Rect> {
    let count = (window.size + (TILE - 1)) / TILE;
    let tile = move |at| Rect::new(window.min + at * TILE, UVec2::splat(TILE));
    Rect::new(UVec2::ZERO, count)
        .points()
        .collect::<Vec<_>>()
        .into_iter()
        .map(move |at| tile(at).intersection(window))
}

fn pairs(film: &Film, other: &Film, tile: Rect) -> [Pair; 3] {
    let [own, others] = [film, other].map(|film| mean_of(film, tile));
    let squares = squares(film, tile) + squares(other, tile);
    [0, 1, 2].map(|channel| {
        let error = own.error[channel].hypot(others.error[channel]);
        let dof = error.powi(4) / squares[channel];
        let means = [own.value[channel], others.value[channel]];
        Pair { tile, channel, means, error, dof }
    })
}

/// Squares of the variances that pixels bring to their mean, over their degrees of freedom.
fn squares(film: &Film, tile: Rect) -> DVec3 {
    let n = tile.area() as f64;
    let pixels = tile.points().map(|at| film.pixel(at));
    let square = |error: DVec3, dof: f64| (error / n).powf(4.0) / dof;
    pixels.map(|pixel| square(pixel.standard_error(), degrees_of_freedom(pixel.n))).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_random_may_differ_by_rounding_and_a_number_that_is_none_by_nothing() {
        let p = |own, other, error| {
            let tile = Rect::new(UVec2::ZERO, UVec2::splat(TILE));
            Pair { tile, channel: 0, means: [own, other], error, dof: 30.0 }.p()
        };
        for equal in [p(1.0, 1.0, 0.0), p(1.0 + 9e-6, 1.0, 0.0), p(0.0, 0.0, 0.0)] {
            assert!(equal >= 1.0, "{equal}");
        }
        for different in [p(1.0 + 2e-5, 1.0, 0.0), p(f64::NAN, 1.0, 0.1)] {
            assert!(different <= 0.0, "{different}");
        }
        // Student's t with 30 degrees of freedom is beyond 2.7500 once in a hundred.
        assert!((p(1.275, 1.0, 0.1) - 0.01).abs() < 1e-5, "{}", p(1.275, 1.0, 0.1));
    }

    #[test]
    fn tiles_cover_a_window_once() {
        let window = Rect::new(UVec2::new(3, 5), UVec2::new(20, 9));
        let all: Vec<UVec2> =
            tiles(window).flat_map(|tile| tile.points().collect::<Vec<_>>()).collect();
        assert_eq!(all.len(), window.area());
        assert!(window.points().all(|at| all.contains(&at)));
    }
}
