//! What the standard errors say of a difference: tests of the whole, of tiles, and of how p values
//! lie, and the smallest bias that they would have seen.
//!
//! Each of the three families may err with the same share of alpha, each test of a family with the
//! same share of that (Šidák 1967), so that two equal pictures are called different with a
//! probability of alpha at most.

use glam::UVec2;
use luxel_core::film::Rect;

use super::pair::{Pair, doubt};
use super::student::Quantiles;
use super::welch::{Sums, Tested};

/// Side of a tile, pixels.
pub(super) const TILE: u32 = 8;

/// Probability with which a bias of the stated size is found.
pub(super) const POWER: f64 = 0.95;

/// An 8 × 8 tile of the picture, as far as it lies in the window.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tile {
    pub(super) rect: Rect,
    pub(super) lanes: [Tested; 4],
}

/// The tests of two pictures.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    /// Pixels that say how wrong they may be, in both pictures.
    pub(super) measured: usize,
    pub(super) whole: [Tested; 4],
    pub(super) tiles: Vec<Tile>,
    /// Least p of the whole picture's tests, corrected for their number.
    pub(super) whole_p: f64,
    /// Least p of the tiles', with the tile and the lane where it is, corrected likewise.
    pub(super) least: Option<Least>,
    /// Whether small p values are too many.
    pub(super) histogram_p: f64,
    /// The smallest relative biases that would have been found with the stated power.
    pub(super) detectable: Detectable,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Least {
    pub(super) tile: Tile,
    pub(super) lane: usize,
    /// Corrected for the number of tests.
    pub(super) p: f64,
}

/// Relative biases of luminance; infinite where nothing would have been found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Detectable {
    pub(super) whole: f64,
    pub(super) median_tile: f64,
    pub(super) worst_tile: f64,
}

/// Families of tests.
const FAMILIES: f64 = 3.0;

/// What one of `n` tests may err if all together may `alpha`.
pub(crate) fn share(alpha: f64, n: f64) -> f64 {
    -((-alpha).ln_1p() / n.max(1.0)).exp_m1()
}

/// Probability that the least of `n` is as small as `p`; 1 of none.
fn corrected(p: f64, n: usize) -> f64 {
    if n == 0 { 1.0 } else { -(n as f64 * (-p).ln_1p()).exp_m1() }
}

/// What a family of tests may err.
pub(super) fn family(alpha: f64) -> f64 {
    share(alpha, FAMILIES)
}

/// Tests the pixels that say how wrong they may be.
pub(super) fn judge(pair: &Pair, alpha: f64) -> Judged {
    let (mut whole, mut tiles) = (Sums::default(), vec![]);
    for rect in cut(pair.window) {
        let mut sums = Sums::default();
        for pixel in rect.points().map(|at| pair.pixel(at)) {
            if doubt(&pixel).is_none() {
                sums.add(pixel);
                whole.add(pixel);
            }
        }
        if sums.n > 0.0 {
            tiles.push(Tile { rect, lanes: sums.tested() });
        }
    }
    let n_tests = tiles.iter().flat_map(|tile| tile.lanes).filter(|lane| lane.p.is_some()).count();
    let tested = whole.tested();
    let ps = tested.iter().filter_map(|lane| lane.p);
    let whole_p = corrected(ps.clone().fold(1.0, f64::min), ps.count());
    let ps: Vec<f64> = tiles.iter().filter_map(|tile| tile.lanes[0].p).collect();
    #[expect(clippy::cast_possible_truncation, reason = "a count of pixels")]
    #[expect(clippy::cast_sign_loss, reason = "a count of pixels")]
    Judged {
        measured: whole.n as usize,
        whole: tested,
        whole_p,
        least: least(&tiles).map(|least| Least { p: corrected(least.p, n_tests), ..least }),
        histogram_p: too_many_small(ps),
        detectable: detectable(&tested, &tiles, n_tests, alpha),
        tiles,
    }
}

impl Judged {
    /// How many tiles have their p of luminance in each tenth from 0 to 1: about as many in each, if
    /// the pictures are the same and their standard errors are right.
    pub(super) fn histogram(&self) -> [usize; 10] {
        tenths(self.tiles.iter().filter_map(|tile| tile.lanes[0].p))
    }
}

/// How many of some numbers from 0 to 1 lie in each tenth; those between two in the upper one.
fn tenths(ps: impl Iterator<Item = f64>) -> [usize; 10] {
    let mut tenths = [0; 10];
    for p in ps {
        let above = (1..10).filter(|tenth| p >= f64::from(*tenth) / 10.0).count();
        tenths[above] += 1;
    }
    tenths
}

/// The tiles of the whole picture, as far as they lie in a window.
fn cut(window: Rect) -> impl Iterator<Item = Rect> {
    let (first, end) = (window.min / TILE, (window.min + window.size - 1) / TILE + 1);
    let tiles = Rect::new(first, end - first);
    tiles.points().map(move |at| Rect::new(at * TILE, UVec2::splat(TILE)).intersection(window))
}

fn least(tiles: &[Tile]) -> Option<Least> {
    let all = tiles.iter().flat_map(|tile| (0..4).map(move |lane| (tile, lane)));
    let tested = all.filter_map(|(tile, lane)| Some((tile, lane, tile.lanes[lane].p?)));
    let least = tested.min_by(|x, y| x.2.total_cmp(&y.2));
    least.map(|(tile, lane, p)| Least { tile: *tile, lane, p })
}

/// Probability that evenly spread p values lie as far below the line, as Kolmogorov and Smirnov
/// measure it. One-sided: too few small ones are no sign of a difference, but of standard errors that
/// are upper bounds, or of common noise.
///
/// # Source
/// Massart 1990: exp(−2nD²) is an upper bound for every n where it is at most 1/2.
fn too_many_small(mut ps: Vec<f64>) -> f64 {
    ps.sort_unstable_by(f64::total_cmp);
    let n = ps.len() as f64;
    let excess = |(i, p): (usize, &f64)| (i + 1) as f64 / n - p;
    let most = ps.iter().enumerate().map(excess).fold(0.0, f64::max);
    (-2.0 * n * most * most).exp()
}

/// A bias of so many standard errors exceeds the test's limit, but for one time in twenty.
fn detectable(whole: &[Tested; 4], tiles: &[Tile], n_tests: usize, alpha: f64) -> Detectable {
    let missed = Quantiles::new(1.0 - POWER);
    let relative = |limit: &Quantiles, lane: &Tested| {
        let bias = (limit.at(lane.dof) + missed.at(lane.dof)) * lane.se;
        let relative = bias / lane.reference;
        if relative >= 0.0 { relative } else { f64::INFINITY }
    };
    let limit = |n: f64| Quantiles::new(0.5 * share(family(alpha), n));
    let of_tile = limit(n_tests as f64);
    // Tiles without light have no relative bias.
    let lit = tiles.iter().map(|tile| &tile.lanes[0]).filter(|lane| lane.reference > 0.0);
    let mut all: Vec<f64> = lit.map(|lane| relative(&of_tile, lane)).collect();
    all.sort_unstable_by(f64::total_cmp);
    let at = |i: usize| all.get(i).copied().unwrap_or(f64::INFINITY);
    Detectable {
        whole: relative(&limit(4.0), &whole[0]),
        median_tile: at(all.len() / 2),
        worst_tile: at(all.len().saturating_sub(1)),
    }
}

#[cfg(test)]
mod tests {
    use luxel_sdk::sampling::Rng;

    use super::*;

    #[test]
    fn each_p_is_counted_in_its_tenth() {
        let ps = [0.0, 0.05, 0.1, 0.29, 0.3, 0.999, 1.0];
        assert_eq!(tenths(ps.into_iter()), [2, 1, 1, 1, 0, 0, 0, 0, 0, 2]);
    }

    #[test]
    fn tiles_are_those_of_the_whole_picture() {
        let window = Rect::new(UVec2::new(6, 8), UVec2::new(12, 3));
        let tiles: Vec<_> = cut(window).collect();
        let rect = |x, y, w, h| Rect::new(UVec2::new(x, y), UVec2::new(w, h));
        assert_eq!(tiles, [rect(6, 8, 2, 3), rect(8, 8, 8, 3), rect(16, 8, 2, 3)]);
    }

    #[test]
    fn shares_of_alpha_make_it_up_again() {
        let one = share(0.01, 4096.0);
        assert!((corrected(one, 4096) / 0.01 - 1.0).abs() < 1e-9);
        // Where nothing is random, nothing is tested.
        assert!(corrected(1.0, 0) >= 1.0 && corrected(1.0, 4) >= 1.0);
        assert!((1.0 - (1.0 - family(0.01)).powi(3) - 0.01).abs() < 1e-12);
    }

    #[test]
    fn even_p_values_pass_and_too_many_small_ones_do_not() {
        let mut rng = Rng::new(7);
        let even: Vec<f64> = (0..1000).map(|_| rng.f64()).collect();
        // Ten of a thousand runs would fall below 0.01.
        assert!(too_many_small(even.clone()) > 0.01);
        let small: Vec<f64> = even.iter().map(|p| p * p).collect();
        assert!(too_many_small(small) < 1e-6);
        let large: Vec<f64> = even.iter().map(|p| p.sqrt()).collect();
        assert!(too_many_small(large) > 0.5);
        assert!(too_many_small(vec![]) >= 1.0);
    }
}
