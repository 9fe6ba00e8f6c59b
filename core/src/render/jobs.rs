//! What a worker is to do.

use std::ops::Range;

use glam::UVec2;

use super::light::Bundle;
use crate::cast;

/// What a worker is to do.
pub(super) enum Jobs<'a> {
    /// The samples of one pass over pixels of a rectangle: sample by sample, each over all pixels.
    Pixels {
        /// Upper left pixel.
        origin: UVec2,
        width: u32,
        /// Row by row.
        pixels: &'a [u32],
        range: Range<u32>,
    },
    /// Paths from lights.
    Lights(Bundle<'a>),
}

impl Jobs<'_> {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Pixels { pixels, range, .. } => pixels.len() * range.len(),
            Self::Lights(bundle) => bundle.paths.len(),
        }
    }

    /// The pixel and the index of its sample.
    pub(super) fn at(&self, job: usize) -> (UVec2, u32) {
        let Self::Pixels { origin, width, pixels, range } = self else { return (UVec2::ZERO, 0) };
        let (sample, pixel) = (job / pixels.len(), pixels[job % pixels.len()]);
        let offset = UVec2::new(pixel % width, pixel / width);
        (*origin + offset, range.start + cast::index(sample))
    }
}
