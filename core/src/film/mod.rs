//! Pixel estimates with their variance.
//!
//! One sample feeds one pixel, and the samples of a pixel are added in their order, so a picture
//! does not depend on tiles or threads.

mod errors;
mod interval;
mod layer;
mod pixel;
mod rect;
mod save;
mod tile;

use glam::{DVec3, UVec2};

pub use errors::Errors;
pub(crate) use errors::Scale;
pub use interval::{Above, Confidence, Intervals, half_width_95};
pub(crate) use layer::Of;
pub use layer::{Channel, Holds, Layer};
pub use pixel::{Pixel, degrees_of_freedom};
pub use rect::Rect;
pub use save::Unreadable;
pub(crate) use tile::{COARSEST, Tile};

/// A picture in the making: pixels in tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// The whole picture's size.
    pub size: UVec2,
    /// The part of it that is measured.
    pub window: Rect,
    /// What else it holds.
    pub holds: Holds,
    tiles: Vec<Tile>,
    columns: u32,
}

/// Side of a tile, pixels.
pub(crate) const TILE: u32 = 16;

impl Film {
    /// An empty film for the part `window` of a picture.
    pub fn new(size: UVec2, window: Rect) -> Self {
        Self::holding(size, window, Holds::default())
    }

    /// The same that holds more than colour.
    pub fn holding(size: UVec2, window: Rect, holds: Holds) -> Self {
        let n = holds.channels().len();
        let window = window.intersection(Rect::new(UVec2::ZERO, size));
        let (columns, rows) = (window.size.x.div_ceil(TILE), window.size.y.div_ceil(TILE));
        let tile = |i: u32| {
            let min = window.min + UVec2::new(i % columns, i / columns) * TILE;
            Tile::new(Rect::new(min, UVec2::splat(TILE)).intersection(window), n)
        };
        let tiles = (0..columns * rows).map(tile).collect();
        Self { size, window, holds, tiles, columns }
    }

    /// Samples that have been given to pixels, those that were not finite among them.
    pub fn samples(&self) -> u64 {
        self.tiles.iter().map(|tile| u64::from(tile.next) * tile.area() as u64).sum()
    }

    /// The most room that its pixels take.
    pub fn bytes(&self) -> usize {
        let of_pixel = size_of::<Pixel>() + size_of::<f64>() * self.holds.channels().len();
        self.window.area() * of_pixel
    }

    /// Forgets how many samples its tiles were about to have: what is asked has changed.
    pub fn ask_anew(&mut self) {
        self.tiles.iter_mut().for_each(|tile| tile.aim = tile.next);
    }

    /// The most samples that a pixel has been given.
    pub fn most_samples(&self) -> u32 {
        self.tiles.iter().map(|tile| tile.next).max().unwrap_or(0)
    }

    pub(crate) fn columns(&self) -> usize {
        self.columns as usize
    }

    pub(crate) fn tiles(&self) -> &[Tile] {
        &self.tiles
    }

    pub(crate) fn tiles_mut(&mut self) -> &mut [Tile] {
        &mut self.tiles
    }

    /// The pixel at absolute coordinates inside the window.
    ///
    /// # Panics
    /// Outside the window.
    pub fn pixel(&self, at: UVec2) -> &Pixel {
        let from = at - self.window.min;
        let tile = &self.tiles[(from.y / TILE * self.columns + from.x / TILE) as usize];
        let inside = at - tile.rect.min;
        tile.pixel((inside.y * tile.rect.size.x + inside.x) as usize)
    }

    /// What it holds beside colour: a channel with its value at each pixel, row by row.
    pub fn channels(&self) -> Vec<(Channel, Vec<f64>)> {
        let channels = self.holds.channels();
        let n = channels.len();
        let value = |i: usize, at: UVec2| {
            let from = at - self.window.min;
            let tile = &self.tiles[(from.y / TILE * self.columns + from.x / TILE) as usize];
            let inside = at - tile.rect.min;
            let pixel = (inside.y * tile.rect.size.x + inside.x) as usize;
            let sums = &tile.layers[pixel * n..][..n];
            layer::resolve(channels[i].of, sums[i], (f64::from(tile.pixel(pixel).n), sums[0]))
        };
        let one =
            |i: usize| (channels[i].clone(), self.window.points().map(|at| value(i, at)).collect());
        (0..n).map(one).collect()
    }

    /// Every pixel of the window, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = (UVec2, &Pixel)> {
        self.window.points().map(|at| (at, self.pixel(at)))
    }

    /// Samples that were not finite, and were left out.
    pub fn bad_samples(&self) -> u64 {
        self.tiles.iter().flat_map(Tile::pixels).map(|pixel| u64::from(pixel.bad)).sum()
    }

    /// Mean over the pixels that have samples, and its standard error, per channel; zero if none has.
    pub fn mean(&self) -> (DVec3, DVec3) {
        let (mut sum, mut variance, mut n) = (DVec3::ZERO, DVec3::ZERO, 0.0);
        for (_, pixel) in self.pixels().filter(|(_, pixel)| pixel.n > 0) {
            let error = pixel.standard_error();
            sum += pixel.mean;
            variance += error * error;
            n += 1.0;
        }
        let n = f64::max(n, 1.0);
        let root = DVec3::new(variance.x.sqrt(), variance.y.sqrt(), variance.z.sqrt());
        (sum / n, root / n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_without_samples_do_not_darken_the_mean() {
        let mut film = Film::new(UVec2::new(32, 16), Rect::new(UVec2::ZERO, UVec2::new(32, 16)));
        assert_eq!(film.mean().0, DVec3::ZERO);
        film.tiles_mut()[0].pixel_mut(3).push(DVec3::ONE);
        assert_eq!(film.mean().0, DVec3::ONE);
    }

    #[test]
    fn a_window_that_ends_inside_a_tile_finds_all_its_pixels() {
        let window = Rect::new(UVec2::new(5, 3), UVec2::new(40, 18));
        let mut film = Film::new(UVec2::new(64, 64), window);
        for tile in film.tiles_mut() {
            for (i, at) in tile.rect.points().enumerate() {
                tile.pixel_mut(i).push(at.as_dvec2().extend(0.0));
            }
        }
        assert_eq!(film.pixels().count(), 40 * 18);
        assert!(film.pixels().all(|(at, pixel)| pixel.mean.truncate() == at.as_dvec2()));
    }
}
