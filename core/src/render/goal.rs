//! How many samples each tile gets: a fixed number, or as many as an error or a time asks for.
//!
//! Tiles are asked in rounds, between which every tile has the samples that it was to have; what they
//! are asked depends on the film alone, so that a film goes on to the same bits wherever it was left.

use std::time::Duration;

use crate::film::{Confidence, Film, Scale};

/// How good a picture is to be, or how long it may take.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Goal {
    /// Relative standard error that each tile is to reach (root mean square over its pixels, as
    /// `film::Errors`), above 0.
    pub error: Option<f64>,
    /// Instead of the standard error it is then the half width of an interval that holds the truth with
    /// this probability.
    pub confidence: Option<Confidence>,
    /// Time that a render may take. What is measured then depends on the machine; without `error` the
    /// samples go where they lower the picture's mean squared error most.
    pub time: Option<Duration>,
}

impl Goal {
    /// Whether there is one beside a number of samples.
    pub fn is_some(&self) -> bool {
        self.error.is_some() || self.time.is_some()
    }
}

/// Fewest samples that tell how many are needed.
pub(super) const LEAST: u32 = 64;
/// Most samples of a pixel if nobody says otherwise.
pub(super) const MOST: u32 = 1 << 20;
/// A tile that needs no more goes on while a neighbour that does has so many times its samples: what
/// the neighbour sees seldom it may not have seen at all.
const LAG: u32 = 4;
/// Samples between two looks at a picture whose tiles cannot be asked one by one.
const CHECKED: u32 = 16;

/// Says what is next.
pub(super) struct Plan {
    goal: Goal,
    /// Samples of a pixel in the end, or at most.
    most: u32,
}

impl Plan {
    pub(super) fn new(goal: Goal, most: u32) -> Self {
        Self { goal, most }
    }

    /// Gives every tile that needs more samples its next number of them. Returns how many samples may
    /// be missing beyond those; nothing if no tile needs more.
    pub(super) fn aim(&self, film: &mut Film) -> Option<u64> {
        let first = if self.goal.is_some() { LEAST.min(self.most) } else { self.most };
        let mut missing = 0;
        for tile in film.tiles_mut() {
            // What a film that is gone on with was about to have stands.
            let begun = if self.goal.is_some() { tile.aim.min(self.most) } else { 0 };
            tile.aim = begun.max(first);
            missing += tile.missing();
        }
        if missing > 0 || !self.goal.is_some() {
            return (missing > 0).then_some(0);
        }
        let aims = match self.goal.error {
            Some(error) => for_error(film, (error, self.goal.confidence), self.most),
            None => for_time(film, self.most),
        };
        let mut beyond = None;
        for (tile, aim) in film.tiles_mut().iter_mut().zip(aims) {
            if aim.next > tile.next {
                tile.aim = aim.next;
                let after = u64::from(aim.last.saturating_sub(aim.next));
                *beyond.get_or_insert(0) += after * tile.area() as u64;
            }
        }
        beyond
    }

    /// Samples of a pixel in the end, or at most.
    pub(super) fn most(&self) -> u32 {
        self.most
    }

    /// Whether a picture whose pixels have `n` samples each is as good as it is to be.
    pub(super) fn is_met(&self, film: &Film, n: u32) -> bool {
        let Some(error) = self.goal.error.filter(|_| n >= LEAST && n.is_multiple_of(CHECKED))
        else {
            return false;
        };
        let scale = Scale::of(film);
        let reach = |tile| scale.reach(tile, self.goal.confidence);
        film.tiles().iter().all(|tile| reach(tile).is_none_or(|found| found <= error))
    }
}

/// Samples that a tile is to have next, and about how many in the end.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Aim {
    next: u32,
    last: u32,
}

/// Variance falls as one over the number of samples or faster: a tile needs at most the square of what
/// its error is too large by. It at most doubles, and finds out again.
fn for_error(film: &Film, (target, confidence): (f64, Option<Confidence>), most: u32) -> Vec<Aim> {
    let scale = Scale::of(film);
    // More of what is not finite tells nothing more.
    let ratio = |tile| scale.reach(tile, confidence).unwrap_or(0.0) / target;
    let ratios: Vec<f64> = film.tiles().iter().map(ratio).collect();
    let counts: Vec<u32> = film.tiles().iter().map(|tile| tile.next).collect();
    let of_tile = |i: usize| {
        let n = counts[i];
        let last = f64::from(n) * ratios[i] * ratios[i];
        let lags = |j: usize| ratios[j] > 1.0 && counts[j] < most && counts[j] / LAG > n;
        if ratios[i] > 1.0 {
            let last = crate::cast::whole(last.ceil()).min(most);
            let next = last.clamp(n.saturating_add(n / 4), n.saturating_mul(2));
            Aim { next: in_blocks(next).min(most), last }
        } else if neighbours(i, film.columns(), counts.len()).any(lags) {
            let next = n.saturating_mul(2).min(most);
            Aim { next, last: next }
        } else {
            Aim { next: n, last: n }
        }
    };
    (0..counts.len()).map(of_tile).collect()
}

/// Twice the samples for the tiles where one more lowers the squared error nearly as much as anywhere:
/// doubled, a tile gains a quarter of what it gained before.
fn for_time(film: &Film, most: u32) -> Vec<Aim> {
    let scale = Scale::of(film);
    let counts: Vec<u32> = film.tiles().iter().map(|tile| tile.next).collect();
    let gain = |i: usize| {
        let error = scale.of_tile(&film.tiles()[i]).unwrap_or(0.0);
        if counts[i] < most { error * error / f64::from(counts[i].max(1)) } else { 0.0 }
    };
    let gains: Vec<f64> = (0..counts.len()).map(gain).collect();
    let limit = gains.iter().copied().fold(0.0, f64::max) / 4.0;
    let of_tile = |i: usize| {
        let n = counts[i];
        let lags = |j: usize| gains[j] >= limit && counts[j] / LAG > n;
        let needs = gains[i] >= limit || neighbours(i, film.columns(), counts.len()).any(lags);
        let next = if needs { n.saturating_mul(2).min(most) } else { n };
        Aim { next, last: next }
    };
    (0..counts.len()).map(of_tile).collect()
}

/// Up to whole blocks of the point sets that samples come from.
fn in_blocks(n: u32) -> u32 {
    let block = 1 << n.max(16).ilog2().saturating_sub(3);
    n.div_ceil(block).saturating_mul(block)
}

/// The tiles about one, of so many in a row.
fn neighbours(i: usize, columns: usize, all: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (i % columns, i / columns);
    let about = |v: usize, end: usize| v.saturating_sub(1)..(v + 2).min(end);
    about(y, all / columns)
        .flat_map(move |row| about(x, columns).map(move |c| row * columns + c))
        .filter(move |j| *j != i)
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, UVec2};

    use super::*;
    use crate::film::Rect;

    /// A film of 3 × 3 tiles with `n` samples of 1 ± `spread` each, of which the spread of the tile in
    /// the middle is larger.
    fn film(n: u32, spread: f64, middle: f64) -> Film {
        let size = UVec2::splat(48);
        let mut film = Film::new(size, Rect::new(UVec2::ZERO, size));
        for (i, tile) in film.tiles_mut().iter_mut().enumerate() {
            let spread = if i == 4 { middle } else { spread };
            (tile.next, tile.aim) = (n, n);
            for pixel in tile.pixels_mut() {
                for sample in 0..n {
                    // Blocks of two and longer ones have no spread: the first 16 samples alone tell.
                    let sign = f64::from(sample.count_ones() % 2) * 2.0 - 1.0;
                    pixel.push(DVec3::splat(1.0 + sign * spread));
                }
            }
        }
        film
    }

    fn error(error: f64) -> Goal {
        Goal { error: Some(error), ..Goal::default() }
    }

    #[test]
    fn a_number_of_samples_is_given_once() {
        let plan = Plan::new(Goal::default(), 10);
        let mut film = film(0, 0.0, 0.0);
        assert_eq!(plan.aim(&mut film), Some(0));
        assert!(film.tiles().iter().all(|tile| tile.aim == 10));
        film.tiles_mut().iter_mut().for_each(|tile| tile.next = 10);
        assert_eq!(plan.aim(&mut film), None);
    }

    #[test]
    fn only_tiles_whose_error_is_too_large_get_more() {
        // Of 16 independent samples: sqrt(16/15)/4 = .26 of the spread.
        let mut found = film(16, 0.01, 1.0);
        found.tiles_mut().iter_mut().for_each(|tile| tile.next = LEAST);
        let plan = Plan::new(error(0.1), 1000);
        // Half as much again as would be right by 2.58² in the end.
        assert!(plan.aim(&mut found).is_some_and(|beyond| beyond > 0));
        let aims: Vec<u32> = found.tiles().iter().map(|tile| tile.aim).collect();
        assert_eq!(aims, [64, 64, 64, 64, 128, 64, 64, 64, 64]);
        assert_eq!(Plan::new(error(0.3), 1000).aim(&mut film(64, 0.01, 1.0)), None);
        // At most as many as may be.
        let mut found = film(64, 0.01, 9.0);
        assert_eq!(Plan::new(error(0.1), 64).aim(&mut found), None);
        assert!(Plan::new(error(0.1), 70).aim(&mut found).is_some());
        assert_eq!(found.tiles()[4].aim, 70);
    }

    #[test]
    fn an_interval_asks_for_more_than_its_standard_error() {
        // The first 16 of 64 samples have all of the spread: .26 / 4, and a half width of 2.08 times that.
        let asked = |confidence| {
            let goal = Goal { confidence, ..error(0.1) };
            let mut found = film(64, 0.01, 1.0);
            Plan::new(goal, MOST).aim(&mut found).map(|_| found.tiles()[4].aim)
        };
        assert_eq!((asked(None), asked(Confidence::new(0.5))), (None, None));
        assert!(asked(Some(Confidence::USUAL)).is_some_and(|aim| aim > 64));
    }

    #[test]
    fn tiles_do_not_lag_far_behind_a_neighbour_that_needs_more() {
        let mut found = film(64, 0.0, 9.0);
        found.tiles_mut()[4].next = 64 * LAG + LAG;
        Plan::new(error(0.01), MOST).aim(&mut found);
        assert!(found.tiles().iter().all(|tile| tile.aim >= 128));
    }

    #[test]
    fn time_goes_where_it_gains_most_and_none_lags_far_behind() {
        let goal = Goal { time: Some(Duration::from_secs(1)), ..Goal::default() };
        let aims = |found: &mut Film| {
            assert!(Plan::new(goal, MOST).aim(found).is_some());
            found.tiles().iter().map(|tile| tile.aim).collect::<Vec<_>>()
        };
        assert_eq!(aims(&mut film(64, 0.1, 1.0)), [64, 64, 64, 64, 128, 64, 64, 64, 64]);
        let mut uneven = film(64, 0.1, 9.0);
        (uneven.tiles_mut()[4].next, uneven.tiles_mut()[4].aim) = (64 * LAG + LAG, 64 * LAG + LAG);
        assert!(aims(&mut uneven).iter().all(|aim| *aim >= 128));
        // Where nothing gains all go on alike.
        assert_eq!(aims(&mut film(64, 0.0, 0.0)), [128; 9]);
    }

    #[test]
    fn tiles_of_which_nothing_is_known_end_nothing_and_are_not_asked_again() {
        let mut found = film(64, 0.0, 0.0);
        for pixel in found.tiles_mut()[4].pixels_mut() {
            *pixel = crate::film::Pixel::NONE;
            pixel.push(DVec3::NAN);
        }
        assert_eq!(Plan::new(error(0.1), MOST).aim(&mut found), None);
        let errors = crate::film::Errors::of_film(&found, 0.1).unwrap();
        assert_eq!((errors.tiles_above, errors.above), (1, 0));
    }

    #[test]
    fn what_was_begun_is_ended_before_anything_is_asked_again() {
        let mut found = film(64, 9.0, 9.0);
        found.tiles_mut()[3].aim = 96;
        assert_eq!(Plan::new(error(0.01), MOST).aim(&mut found), Some(0));
        let aims: Vec<u32> = found.tiles().iter().map(|tile| tile.aim).collect();
        assert_eq!(aims, [64, 64, 64, 96, 64, 64, 64, 64, 64]);
    }

    #[test]
    fn neighbours_stay_within_the_picture() {
        let found = |i| neighbours(i, 3, 9).collect::<Vec<_>>();
        assert_eq!(found(0), [1, 3, 4]);
        assert_eq!(found(4), [0, 1, 2, 3, 5, 6, 7, 8]);
        assert_eq!(found(8), [4, 5, 7]);
        assert_eq!([1, 63, 64, 100, 129].map(in_blocks), [2, 64, 64, 104, 144]);
    }
}
