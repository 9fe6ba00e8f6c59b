//! A rectangle of pixels.

use glam::UVec2;

/// Pixels from `min` on, `size` of them in each direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rect {
    /// Upper left pixel.
    pub min: UVec2,
    /// Width and height.
    pub size: UVec2,
}

impl Rect {
    /// `size` pixels from `min` on.
    pub fn new(min: UVec2, size: UVec2) -> Self {
        Self { min, size }
    }

    /// The pixels of both; empty where they do not meet.
    #[must_use]
    pub fn intersection(self, other: Self) -> Self {
        let min = self.min.max(other.min);
        let end = |r: Self| r.min.saturating_add(r.size);
        Self { min, size: end(self).min(end(other)).saturating_sub(min) }
    }

    /// How many pixels.
    pub fn area(self) -> usize {
        self.size.x as usize * self.size.y as usize
    }

    /// Every pixel, row by row.
    pub fn points(self) -> impl Iterator<Item = UVec2> {
        let Self { min, size } = self;
        (0..size.y).flat_map(move |y| (0..size.x).map(move |x| min + UVec2::new(x, y)))
    }
}
