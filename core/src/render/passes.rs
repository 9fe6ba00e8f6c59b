//! Passes over a film: how many samples its tiles get between two looks at it.

use std::time::{Duration, Instant};

use super::goal::Plan;
use super::lattice::Lattice;
use super::{Look, Reached};
use crate::film::{Film, Tile};

/// Most samples of a pixel in one pass.
const PASS: u32 = 16;

/// The samples that a tile has after the next pass. Passes grow: a first picture comes soon, later ones
/// cost little to gather.
fn next(tile: &Tile, longest: u32) -> u32 {
    tile.aim.min(tile.next.saturating_add(tile.next.clamp(1, longest)))
}

/// One pass over the film.
#[derive(Clone, Copy)]
pub(super) struct Turn {
    /// Which pixels it is for.
    pub(super) lattice: Lattice,
    /// Most samples of each.
    longest: u32,
    /// What is reached after it.
    reached: Reached,
}

/// Longer than this no pass should take: between two the picture is seen. One that does is done in
/// slices, each some of the tiles: between two the picture is kept. Slices are longer where tiles are
/// slow: at the end of one, all threads wait for the last tile.
pub(super) const SLOW: Duration = Duration::from_secs(4);

/// The wait for the last tile of a slice is to be less than one part in so many.
const WAIT: u32 = 20;

/// When no further tile is begun in a slice.
#[derive(Clone, Copy)]
pub(super) struct Late {
    at: Option<Instant>,
    /// The tile that is begun in any case, so that each slice has one.
    first: usize,
}

impl Late {
    /// Whether the tile of that number is not begun any more.
    pub(super) fn is_over(self, tile: usize) -> bool {
        tile != self.first && self.at.is_some_and(|at| Instant::now() >= at)
    }
}

/// Slices of one pass, until every tile has its samples or `measure` says false: it gives tiles the samples
/// that they are to have in the end, until it is late. Whether the pass is done.
pub(super) fn slices(
    film: &mut Film,
    turn: Turn,
    mut slow: Duration,
    look: &mut Look<'_>,
    measure: &mut dyn FnMut(&mut Film, &[u32], Late) -> bool,
) -> bool {
    let ends: Vec<u32> = film.tiles().iter().map(|tile| next(tile, turn.longest)).collect();
    loop {
        let undone = film.tiles().iter().zip(&ends).position(|(tile, end)| tile.next < *end);
        let first = undone.unwrap_or(0);
        // Of coarser steps tiles do not know whether they had them.
        let start = Instant::now();
        let at = start.checked_add(slow).filter(|_| turn.lattice.step() == 1);
        if !measure(film, &ends, Late { at, first }) {
            return false;
        }
        let is_done = film.tiles().iter().zip(&ends).all(|(tile, end)| tile.next >= *end);
        let is_whole = is_done || turn.lattice.step() > 1;
        look(film, Reached { is_whole, ..turn.reached });
        if is_whole {
            return true;
        }
        if start.elapsed() > slow + slow / WAIT {
            slow = slow.saturating_mul(2);
        }
    }
}

/// Passes over a film until no tile needs more, or until one says false.
pub(super) fn passes(
    film: &mut Film,
    plan: &Plan,
    coarse: bool,
    pass: &mut dyn FnMut(&mut Film, Turn) -> bool,
) {
    let mut longest = PASS;
    while let Some(beyond) = plan.aim(film) {
        while film.tiles().iter().any(|tile| tile.missing() > 0) {
            let (is_first, start) = (film.samples() == 0, Instant::now());
            for lattice in Lattice::steps(coarse && is_first) {
                let reached = reached(film, (lattice, longest), beyond);
                if !pass(film, Turn { lattice, longest, reached }) {
                    return;
                }
            }
            // How samples are gathered changes no bit.
            longest = match start.elapsed() {
                took if took > SLOW => (longest / 2).max(1),
                took if took < SLOW / 4 => (longest * 2).min(PASS),
                _ => longest,
            };
        }
    }
}

/// What a pass comes to.
fn reached(film: &Film, (lattice, longest): (Lattice, u32), beyond: u64) -> Reached {
    let end = |tile: &Tile| next(tile, longest);
    let left = |tile: &Tile| u64::from(tile.aim.saturating_sub(end(tile))) * tile.area() as u64;
    Reached {
        step: lattice.step(),
        samples: film.tiles().iter().map(end).max().unwrap_or(0),
        left: beyond + film.tiles().iter().map(left).sum::<u64>(),
        is_whole: true,
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;
    use crate::film::Rect;
    use crate::render::Goal;

    #[test]
    fn a_slow_pass_is_seen_between_its_slices_and_ends_once() {
        // Six tiles, of which each slice does one, as no time is given.
        let size = UVec2::new(40, 20);
        let mut film = Film::new(size, Rect::new(UVec2::ZERO, size));
        let (plan, mut seen, mut done) = (Plan::new(Goal::default(), 3), vec![], vec![]);
        let mut look = |film: &Film, now: Reached| {
            let has_all = film.tiles().iter().all(|tile| tile.next == now.samples);
            assert_eq!(has_all, now.is_whole);
            seen.push(now.is_whole);
        };
        passes(&mut film, &plan, false, &mut |film, turn| {
            slices(film, turn, Duration::ZERO, &mut look, &mut |film, ends, late| {
                let tiles = film.tiles_mut().iter_mut().zip(ends).enumerate();
                for (i, (tile, end)) in tiles.filter(|(i, _)| !late.is_over(*i)) {
                    done.push((i, tile.next..*end));
                    tile.next = *end;
                }
                true
            })
        });
        let of = |range: &std::ops::Range<u32>| (0..6).map(|i| (i, range.clone())).collect();
        let all: Vec<Vec<_>> = [0..1, 1..2, 2..3].iter().map(of).collect();
        assert_eq!(done, all.concat());
        let pass = [false, false, false, false, false, true];
        assert_eq!(seen, [pass, pass, pass].concat());
    }

    #[test]
    fn a_pass_ends_between_slices_where_that_is_asked() {
        let size = UVec2::new(40, 20);
        let mut film = Film::new(size, Rect::new(UVec2::ZERO, size));
        let (plan, mut looks, mut slices_left) = (Plan::new(Goal::default(), 3), 0, 3);
        passes(&mut film, &plan, false, &mut |film, turn| {
            let mut look = |_: &Film, _: Reached| looks += 1;
            slices(film, turn, Duration::ZERO, &mut look, &mut |film, ends, late| {
                let tiles = film.tiles_mut().iter_mut().zip(ends).enumerate();
                for (_, (tile, end)) in tiles.filter(|(i, _)| !late.is_over(*i)) {
                    tile.next = *end;
                }
                slices_left -= 1;
                slices_left > 0
            })
        });
        assert_eq!((looks, slices_left), (2, 0));
        assert_eq!(film.tiles().iter().filter(|tile| tile.next > 0).count(), 3);
    }

    #[test]
    fn passes_are_each_sample_of_each_pixel_once() {
        for (spp, coarse) in [0, 1, 2, 3, 17, 100].into_iter().flat_map(|n| [(n, false), (n, true)])
        {
            let size = UVec2::new(20, 3);
            let mut film = Film::new(size, Rect::new(UVec2::ZERO, size));
            let (mut steps, mut longest) = (vec![], 0);
            let plan = Plan::new(Goal::default(), spp);
            passes(
                &mut film,
                &plan,
                coarse,
                &mut |film, Turn { lattice, longest: most, reached }| {
                    for tile in film.tiles_mut() {
                        let end = next(tile, most);
                        longest = longest.max(end - tile.next);
                        assert_eq!(end, reached.samples);
                        tile.next = if lattice.step() == 1 { end } else { 0 };
                    }
                    steps.push(lattice.step());
                    assert_eq!(reached.left, u64::from(spp - reached.samples) * 60);
                    true
                },
            );
            assert!(film.tiles().iter().all(|tile| tile.next == spp));
            assert!(longest <= 16);
            let coarser = steps.iter().filter(|step| **step > 1).count();
            assert_eq!(coarser, if coarse && spp > 0 { 3 } else { 0 });
        }
    }
}
