//! Which pixels a pass is for: the first samples may come in steps, a coarse picture before a fine one.

use crate::film::{COARSEST, Rect};

/// Pixels of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lattice {
    /// All of them.
    All,
    /// Those of every so many columns and rows.
    Every(u32),
    /// Those less the ones of twice the distance.
    Between(u32),
}

impl Lattice {
    /// The steps of the first sample: together, each pixel once.
    pub(super) fn steps(coarse: bool) -> Vec<Self> {
        if !coarse {
            return vec![Self::All];
        }
        let halves = std::iter::successors(Some(COARSEST / 2), |step| Some(step / 2));
        let finer = halves.take_while(|step| *step > 0).map(Self::Between);
        std::iter::once(Self::Every(COARSEST)).chain(finer).collect()
    }

    /// Pixels from one that has a sample to the next, once this pass is over.
    pub(super) fn step(self) -> u32 {
        match self {
            Self::All => 1,
            Self::Every(step) | Self::Between(step) => step,
        }
    }

    /// The numbers of the pixels in a tile, row by row.
    pub(super) fn of(self, tile: Rect) -> impl Iterator<Item = u32> {
        let width = tile.size.x;
        (0..tile.size.y).flat_map(move |y| (0..width).map(move |x| (x, y))).filter_map(
            move |(x, y)| {
                let on = |step: u32| x % step == 0 && y % step == 0;
                let chosen = match self {
                    Self::All => true,
                    Self::Every(step) => on(step),
                    Self::Between(step) => on(step) && !on(2 * step),
                };
                chosen.then_some(y * width + x)
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    #[test]
    fn steps_are_each_pixel_once() {
        for size in [UVec2::new(16, 16), UVec2::new(5, 13), UVec2::new(1, 1)] {
            let tile = Rect::new(UVec2::new(7, 3), size);
            for coarse in [false, true] {
                let steps = Lattice::steps(coarse);
                let mut all: Vec<u32> = steps.iter().flat_map(|step| step.of(tile)).collect();
                assert_eq!(steps[0].of(tile).next(), Some(0), "the corner comes first");
                all.sort_unstable();
                assert_eq!(all, (0..size.x * size.y).collect::<Vec<_>>());
            }
        }
        let distances: Vec<u32> = Lattice::steps(true).iter().map(|step| step.step()).collect();
        assert_eq!(distances, [8, 4, 2, 1]);
    }
}
