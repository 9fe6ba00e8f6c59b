//! Whether two pictures are the same, up to their noise.
//!
//! Each channel of each tile of 8 × 8 pixels is tested (Welch's z, of so many samples that it is
//! normal), each at such a level that all together err once in a hundred (Šidák 1967).

use glam::UVec2;
use luxel_core::film::{Film, Rect};
use luxel_core::scene::Area;

use super::mean::{luminance, mean, mean_of};
use super::row::{Measured, Row, Verdict};
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
}

impl Pair {
    /// How many standard errors the two are apart, beside rounding.
    fn z(&self) -> f64 {
        let [own, other] = self.means;
        let off = (own - other).abs() - ROUNDING * other.abs();
        // Without noise nothing but rounding may differ; a mean that is no number always does.
        match off {
            _ if off.is_nan() => f64::INFINITY,
            _ if off <= 0.0 => 0.0,
            _ => off / self.error,
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
    let worst = pairs.iter().copied().max_by(|a, b| a.z().total_cmp(&b.z()));
    if let Some(worst) = worst.filter(|worst| worst.z() > limit(pairs.len())) {
        return Ok(different((id, case), &worst));
    }
    let [own, others] = [film, other].map(|film| mean(film, Area::Whole));
    let (value, expected) = (luminance(own.value), luminance(others.value));
    let error = luminance(own.error).hypot(luminance(others.error));
    let tolerance = ROUNDING * expected.abs();
    Ok(Row::new((id, case), expected, Measured { value, error }, tolerance))
}

fn different((id, case): (&str, &str), worst: &Pair) -> Row {
    let Pair { tile, channel, means: [value, expected], error } = *worst;
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
    [0, 1, 2].map(|channel| Pair {
        tile,
        channel,
        means: [own.value[channel], others.value[channel]],
        error: own.error[channel].hypot(others.error[channel]),
    })
}

/// What the largest of so many `|z|` exceeds with the probability `ALPHA` if nothing differs.
fn limit(n: usize) -> f64 {
    // 1 − (1 − α)^(1/n), without cancelling.
    let share = -((-ALPHA).ln_1p() / n.max(1) as f64).exp_m1();
    let (mut low, mut high) = (2.0, 40.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if two_sided(middle) > share {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// Probability that a normal variable is further from 0 than `z` ≥ 2: the continued fraction of
/// Mills' ratio, good to 1e-9 there.
fn two_sided(z: f64) -> f64 {
    let fraction = (1..60).rev().fold(z, |rest, i| z + f64::from(i) / rest);
    2.0 * (-0.5 * z * z).exp() / (std::f64::consts::TAU.sqrt() * fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_those_of_the_tables() {
        // The normal variable is beyond 2.5758 with 1 %, beyond 4.4172 with 1e-5.
        assert!((limit(1) - 2.575_829).abs() < 1e-6);
        let n = 1005;
        let share = 1.0 - 0.99_f64.powf(1.0 / f64::from(1005_u16));
        assert!((two_sided(limit(n)) / share - 1.0).abs() < 1e-6);
        assert!((two_sided(4.417_173_4) - 1e-5).abs() < 1e-11);
    }

    #[test]
    fn what_is_not_random_may_differ_by_rounding_and_a_number_that_is_none_by_nothing() {
        let z = |own, other, error| {
            let tile = Rect::new(UVec2::ZERO, UVec2::splat(TILE));
            Pair { tile, channel: 0, means: [own, other], error }.z()
        };
        assert!(
            z(1.0, 1.0, 0.0) <= 0.0 && z(1.0 + 9e-6, 1.0, 0.0) <= 0.0 && z(0.0, 0.0, 0.0) <= 0.0
        );
        assert!(z(1.0 + 2e-5, 1.0, 0.0).is_infinite());
        assert!((z(1.3, 1.0, 0.1) - 3.0).abs() < 1e-3 && (z(0.7, 1.0, 0.1) - 3.0).abs() < 1e-3);
        assert!(z(f64::NAN, 1.0, 0.1).is_infinite());
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
