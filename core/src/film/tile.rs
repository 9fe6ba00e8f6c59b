//! A tile of a film: its pixels take room once they have samples, and of a coarse first step only those
//! that it is for. Making room for a whole picture takes longer than its first step.

use super::{Pixel, Rect};

/// Pixels from one of the coarsest step to the next, in either direction.
pub(crate) const COARSEST: u32 = 8;

/// The pixels of one tile.
#[derive(Clone, Debug)]
pub(crate) struct Tile {
    pub(crate) rect: Rect,
    /// Row by row: none, those of the coarsest step, or all.
    pixels: Vec<Pixel>,
    /// Sums of what the layers hold, pixel by pixel.
    pub(crate) layers: Vec<f64>,
    /// Samples that each of its pixels has been given.
    pub(crate) next: u32,
    /// Samples that each is to have before it is asked again how many it needs.
    pub(crate) aim: u32,
}

impl Tile {
    /// No pixel of `rect` has a sample; so many numbers of each are held beside colour.
    pub(super) fn new(rect: Rect, n_channels: usize) -> Self {
        let layers = vec![0.0; rect.area() * n_channels];
        Self { rect, pixels: vec![], layers, next: 0, aim: 0 }
    }

    /// How many pixels it has.
    pub(crate) fn area(&self) -> usize {
        self.rect.area()
    }

    /// Samples that are missing, of all its pixels.
    pub(crate) fn missing(&self) -> u64 {
        u64::from(self.aim.saturating_sub(self.next)) * self.area() as u64
    }

    /// The pixel of that number.
    pub(crate) fn pixel(&self, number: usize) -> &Pixel {
        let place = if self.has_all() { Some(number) } else { self.coarse_place(number) };
        place.and_then(|place| self.pixels.get(place)).unwrap_or(&Pixel::NONE)
    }

    /// All pixels, row by row.
    pub(crate) fn pixels(&self) -> impl Iterator<Item = &Pixel> {
        (0..self.area()).map(|number| self.pixel(number))
    }

    /// The same, to be changed: there is room for all of them from now on.
    pub(crate) fn pixels_mut(&mut self) -> &mut [Pixel] {
        if !self.has_all() {
            self.pixels = self.pixels().copied().collect();
        }
        &mut self.pixels
    }

    /// Makes room for the pixels of the coarsest step, if there is none.
    pub(crate) fn begin_coarsely(&mut self) {
        if self.pixels.is_empty() {
            let n = self.rect.size.map(|side| side.div_ceil(COARSEST));
            self.pixels = vec![Pixel::NONE; n.x as usize * n.y as usize];
        }
    }

    /// The pixel of that number, to be changed: where there is no room for it, for all is made.
    pub(crate) fn pixel_mut(&mut self, number: usize) -> &mut Pixel {
        match self.coarse_place(number) {
            Some(place) if !self.has_all() && !self.pixels.is_empty() => &mut self.pixels[place],
            _ => &mut self.pixels_mut()[number],
        }
    }

    fn has_all(&self) -> bool {
        self.pixels.len() == self.area()
    }

    /// Where among those of the coarsest step a pixel stands, if it is of them.
    fn coarse_place(&self, number: usize) -> Option<usize> {
        let (side, width) = (COARSEST as usize, self.rect.size.x as usize);
        let (x, y) = (number % width, number / width);
        (x.is_multiple_of(side) && y.is_multiple_of(side))
            .then(|| y / side * width.div_ceil(side) + x / side)
    }
}

impl PartialEq for Tile {
    /// Whether all is the same, however much room it takes.
    fn eq(&self, other: &Self) -> bool {
        let of = |tile: &Self| (tile.rect, tile.next, tile.aim);
        of(self) == of(other) && self.layers == other.layers && self.pixels().eq(other.pixels())
    }
}

#[cfg(test)]
mod tests {
    use glam::{DVec3, UVec2};

    use super::*;

    #[test]
    fn room_comes_with_samples_and_changes_none() {
        for size in [UVec2::new(16, 16), UVec2::new(9, 3), UVec2::new(3, 9), UVec2::ONE] {
            let rect = Rect::new(UVec2::new(7, 3), size);
            let mut tile = Tile::new(rect, 0);
            assert!(tile.pixels().all(|pixel| *pixel == Pixel::NONE) && tile.pixels.is_empty());
            tile.begin_coarsely();
            let is_coarse = |i: usize| {
                let (x, y) = (i % size.x as usize, i / size.x as usize);
                x % 8 == 0 && y % 8 == 0
            };
            let coarse: Vec<usize> = (0..tile.area()).filter(|i| is_coarse(*i)).collect();
            for number in &coarse {
                tile.pixel_mut(*number).push(DVec3::splat(*number as f64));
            }
            assert_eq!(tile.pixels.len(), coarse.len());
            let before = tile.clone();
            assert_eq!(tile.pixels_mut().len(), size.element_product() as usize);
            assert_eq!(tile, before);
            for (number, pixel) in tile.pixels().enumerate() {
                let n = u32::from(is_coarse(number));
                assert_eq!((pixel.n, pixel.mean.x), (n, f64::from(n) * number as f64));
            }
            tile.pixel_mut(tile.area() - 1).push(DVec3::ONE);
            assert_ne!(tile, before);
        }
    }

    #[test]
    fn a_pixel_of_no_coarse_step_makes_room_for_all() {
        let mut tile = Tile::new(Rect::new(UVec2::ZERO, UVec2::splat(16)), 0);
        tile.pixel_mut(0).push(DVec3::ONE);
        tile.begin_coarsely();
        assert_eq!((tile.pixels.len(), tile.pixel(0).n), (256, 1));
    }
}
