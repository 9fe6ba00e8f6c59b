//! Pixel estimates with their variance.
//!
//! One sample feeds one pixel, and the samples of a pixel are added in their order, so a picture
//! does not depend on tiles or threads.

mod rect;

use glam::{DVec3, UVec2};

pub use rect::Rect;

/// The estimate of one pixel: Welford's running mean and second moment, per channel, in f64.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pixel {
    /// Samples that count.
    pub n: u32,
    /// Samples that were not finite, and were left out.
    pub bad: u32,
    /// Mean of linear sRGB, in the radiance unit of `luxel_sdk::color`.
    pub mean: DVec3,
    m2: DVec3,
}

impl Pixel {
    /// Adds a sample; one that is not finite is counted and left out.
    pub fn push(&mut self, rgb: DVec3) {
        if !rgb.is_finite() {
            self.bad += 1;
            return;
        }
        self.n += 1;
        let delta = rgb - self.mean;
        self.mean += delta / f64::from(self.n);
        self.m2 += delta * (rgb - self.mean);
    }

    /// Variance of one sample, per channel; zero below two samples.
    pub fn variance(&self) -> DVec3 {
        if self.n < 2 { DVec3::ZERO } else { self.m2 / f64::from(self.n - 1) }
    }

    /// Standard error of the mean, per channel, taking the samples as independent; infinite below
    /// two samples. For Sobol samples it is an upper estimate.
    pub fn standard_error(&self) -> DVec3 {
        if self.n < 2 {
            return DVec3::INFINITY;
        }
        let variance = self.variance() / f64::from(self.n);
        DVec3::new(variance.x.sqrt(), variance.y.sqrt(), variance.z.sqrt())
    }
}

/// The pixels of one tile.
#[derive(Clone, Debug)]
pub(crate) struct Tile {
    pub(crate) rect: Rect,
    pub(crate) pixels: Vec<Pixel>,
}

/// A picture in the making: pixels in tiles.
#[derive(Clone, Debug)]
pub struct Film {
    /// The whole picture's size.
    pub size: UVec2,
    /// The part of it that is measured.
    pub window: Rect,
    tiles: Vec<Tile>,
    columns: u32,
}

/// Side of a tile, pixels.
pub(crate) const TILE: u32 = 16;

impl Film {
    /// An empty film for the part `window` of a picture.
    pub fn new(size: UVec2, window: Rect) -> Self {
        let window = window.intersection(Rect::new(UVec2::ZERO, size));
        let (columns, rows) = (window.size.x.div_ceil(TILE), window.size.y.div_ceil(TILE));
        let tile = |i: u32| {
            let min = window.min + UVec2::new(i % columns, i / columns) * TILE;
            let rect = Rect::new(min, UVec2::splat(TILE)).intersection(window);
            Tile { rect, pixels: vec![Pixel::default(); rect.area()] }
        };
        Self { size, window, tiles: (0..columns * rows).map(tile).collect(), columns }
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
        &tile.pixels[(inside.y * tile.rect.size.x + inside.x) as usize]
    }

    /// Every pixel of the window, row by row.
    pub fn pixels(&self) -> impl Iterator<Item = (UVec2, &Pixel)> {
        self.window.points().map(|at| (at, self.pixel(at)))
    }

    /// Samples that were not finite, and were left out.
    pub fn bad_samples(&self) -> u64 {
        self.tiles.iter().flat_map(|tile| &tile.pixels).map(|pixel| u64::from(pixel.bad)).sum()
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
    fn mean_and_variance_survive_a_large_offset() {
        let mut pixel = Pixel::default();
        for i in 0..1000 {
            pixel.push(DVec3::splat(1e9 + f64::from(i % 2)));
        }
        // Alternating 0 and 1: variance n/(n−1)/4; cancellation costs 1e9·2⁻⁵² of one.
        assert!((pixel.variance().x - 0.25 * 1000.0 / 999.0).abs() < 1e-6);
        assert!((pixel.mean.y - 1e9 - 0.5).abs() < 1e-6);
    }

    #[test]
    fn samples_that_are_not_finite_are_counted_and_left_out() {
        let mut pixel = Pixel::default();
        pixel.push(DVec3::new(1.0, f64::NAN, 0.0));
        pixel.push(DVec3::ONE);
        assert_eq!((pixel.n, pixel.bad, pixel.mean), (1, 1, DVec3::ONE));
    }

    #[test]
    fn pixels_without_samples_do_not_darken_the_mean() {
        let mut film = Film::new(UVec2::new(32, 16), Rect::new(UVec2::ZERO, UVec2::new(32, 16)));
        assert_eq!(film.mean().0, DVec3::ZERO);
        film.tiles_mut()[0].pixels[3].push(DVec3::ONE);
        assert_eq!(film.mean().0, DVec3::ONE);
    }

    #[test]
    fn a_window_that_ends_inside_a_tile_finds_all_its_pixels() {
        let window = Rect::new(UVec2::new(5, 3), UVec2::new(40, 18));
        let mut film = Film::new(UVec2::new(64, 64), window);
        for tile in film.tiles_mut() {
            for (i, at) in tile.rect.points().enumerate() {
                tile.pixels[i].push(at.as_dvec2().extend(0.0));
            }
        }
        assert_eq!(film.pixels().count(), 40 * 18);
        assert!(film.pixels().all(|(at, pixel)| pixel.mean.truncate() == at.as_dvec2()));
    }
}
