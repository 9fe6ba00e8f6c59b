//! The pixels of a picture as they are written to its file: what a page, which is sent halves, is told of
//! one of them.

use glam::UVec2;
use luxel_core::film::{Film, Rect};

/// What a film holds by now of the pixels of a step, in the 32 bits that a file has.
#[derive(Debug)]
pub(crate) struct Exact {
    /// The whole picture's size.
    pub(super) size: UVec2,
    /// The part of it that was measured.
    pub(super) window: Rect,
    /// Pixels of the window from one of these to the next; each stands for a square of that side.
    pub(super) step: u32,
    /// Radiance, three for each pixel, row by row.
    pub(super) rgb: Vec<f32>,
    /// Standard error likewise.
    pub(super) se: Vec<f32>,
    /// Samples of each pixel.
    pub(super) n: Vec<u32>,
}

impl Exact {
    /// The pixels of a film's window in every `step`th column and row.
    #[expect(clippy::cast_possible_truncation, reason = "a file holds 32 bits")]
    pub(crate) fn of_film(film: &Film, step: u32) -> Self {
        let (mut rgb, mut se, mut n) = (vec![], vec![], vec![]);
        for at in Rect::new(UVec2::ZERO, Self::columns_and_rows(film.window, step)).points() {
            let pixel = film.pixel(film.window.min + at * step);
            rgb.extend(pixel.mean.to_array().map(|v| v as f32));
            se.extend(pixel.standard_error().to_array().map(|v| v as f32));
            n.push(pixel.n);
        }
        Self { size: film.size, window: film.window, step, rgb, se, n }
    }

    /// Columns and rows of the pixels.
    pub(super) fn pixels(&self) -> UVec2 {
        Self::columns_and_rows(self.window, self.step)
    }

    fn columns_and_rows(window: Rect, step: u32) -> UVec2 {
        (window.size + step - 1) / step
    }

    /// The values of a pixel of the whole picture; nothing outside the window.
    pub(crate) fn facts(&self, at: UVec2) -> Vec<(String, String)> {
        let inside = at.cmpge(self.window.min) & at.cmplt(self.window.min + self.window.size);
        if !inside.all() {
            return vec![];
        }
        let (at, columns) = ((at - self.window.min) / self.step, self.pixels().x);
        told(at.y as usize * columns as usize + at.x as usize, (&self.rgb, &self.se, &self.n))
    }
}

/// Radiance, standard error and samples of the pixel of this index, as far as planes hold them.
pub(crate) fn told(i: usize, (rgb, se, n): (&[f32], &[f32], &[u32])) -> Vec<(String, String)> {
    let three =
        |plane: &[f32]| plane.get(i * 3..i * 3 + 3).map(|v| format!("{} {} {}", v[0], v[1], v[2]));
    let n = n.get(i).map(u32::to_string);
    let all = [("radiance", three(rgb)), ("standard error", three(se)), ("samples", n)];
    all.into_iter().filter_map(|(name, value)| Some((name.to_owned(), value?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_pixel_of_a_coarse_step_tells_the_one_that_stands_for_it() {
        let window = Rect::new(UVec2::new(5, 3), UVec2::new(7, 4));
        let film = Film::new(UVec2::new(32, 16), window);
        for (step, columns) in [(1, 7), (2, 4), (8, 1)] {
            let mut exact = Exact::of_film(&film, step);
            let n = exact.n.len();
            exact.rgb = (0..3 * n).map(|i| i as f32 + 0.1).collect();
            exact.n = (0..n).map(|i| u32::try_from(i).unwrap()).collect();
            for at in window.points() {
                let cell = (at - window.min) / step;
                let i = (cell.y * columns + cell.x) as usize;
                let wanted = [
                    ("radiance", format!("{}.1 {}.1 {}.1", 3 * i, 3 * i + 1, 3 * i + 2)),
                    ("standard error", "inf inf inf".into()),
                    ("samples", i.to_string()),
                ];
                assert_eq!(exact.facts(at), wanted.map(|(name, value)| (name.to_owned(), value)));
            }
            for outside in [UVec2::new(4, 3), UVec2::new(12, 3), UVec2::new(5, 7), UVec2::MAX] {
                assert!(exact.facts(outside).is_empty(), "{outside}");
            }
        }
    }
}
