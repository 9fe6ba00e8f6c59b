//! How standard errors that are told compare with those that are true: of pictures of many seeds.

use std::path::Path;

use glam::UVec2;
use luxel_core::film::Film;
use luxel_core::render::{Control, Options, render};
use luxel_sdk::color::RgbSpace;

use super::Form;
use super::asked::{SCENES, stage_of};

const SPP: u32 = 64;

/// # Errors
/// A scene that does not build.
pub(super) fn table(root: &Path, form: Form) -> Result<String, String> {
    let (seeds, side) = (form.pick(64, 4), form.pick(64, 16));
    let mut rows = vec![
        "| | of pixels: said / true | of the whole picture: said / true |".to_owned(),
        "|---|---|---|".to_owned(),
    ];
    for (name, file, assets) in SCENES {
        let stage = stage_of(&root.join("scenes"), (file, assets), UVec2::splat(side))?;
        let options = |seed| Options { spp: Some(SPP), seed: Some(seed), ..Options::default() };
        let mut found = Found::new(side * side);
        for seed in 0..seeds {
            found.add(&render(&stage, &options(seed), &Control::default()).0);
        }
        let [pixels, whole] = found.said_over_true();
        rows.push(format!("| {name} | {pixels:.2} | {whole:.2} |"));
    }
    Ok(rows.join("\n"))
}

/// Luminances of some pictures.
struct Found {
    pictures: f64,
    /// Of each pixel: sum, sum of squares, sum of told variances.
    pixels: Vec<[f64; 3]>,
    whole: [f64; 3],
}

impl Found {
    fn new(pixels: u32) -> Self {
        Self { pictures: 0.0, pixels: vec![[0.0; 3]; pixels as usize], whole: [0.0; 3] }
    }

    fn add(&mut self, film: &Film) {
        let weights = RgbSpace::LinearSrgb.luminance_weights();
        let n = self.pixels.len() as f64;
        let (mut sum, mut told) = (0.0, 0.0);
        for ((_, pixel), found) in film.pixels().zip(&mut self.pixels) {
            // Channels of one sample go up and down together: so their errors add.
            let (y, error) = (weights.dot(pixel.mean), weights.dot(pixel.standard_error()));
            add(found, y, error * error);
            (sum, told) = (sum + y, told + error * error);
        }
        self.pictures += 1.0;
        add(&mut self.whole, sum / n, told / (n * n));
    }

    /// Roots of the mean told variance over the mean true one: of pixels, and of the whole.
    fn said_over_true(&self) -> [f64; 2] {
        let n = self.pictures;
        let variance = |[sum, squares, _]: &[f64; 3]| (squares - sum * sum / n) / (n - 1.0);
        let all: f64 = self.pixels.iter().map(variance).sum();
        let told: f64 = self.pixels.iter().map(|found| found[2] / n).sum();
        [(told / all).sqrt(), (self.whole[2] / n / variance(&self.whole)).sqrt()]
    }
}

fn add(found: &mut [f64; 3], value: f64, told: f64) {
    *found = [found[0] + value, found[1] + value * value, found[2] + told];
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_told_is_held_against_how_values_scatter() {
        // Two pixels of 1 ± 1 and 2 ± 2, the root of 8/7 larger as of eight pictures; the whole scatters
        // as their mean does.
        let mut found = Found::new(2);
        for i in 0..8 {
            let sign = |bit: u32| f64::from(i >> bit & 1) * 2.0 - 1.0;
            let (a, b) = (1.0 + sign(0), 2.0 + 2.0 * sign(1));
            add(&mut found.pixels[0], a, 4.0);
            add(&mut found.pixels[1], b, 16.0);
            add(&mut found.whole, f64::midpoint(a, b), 20.0 / 4.0);
            found.pictures += 1.0;
        }
        let expected = 2.0 / (8.0_f64 / 7.0).sqrt();
        assert!(found.said_over_true().iter().all(|ratio| (ratio - expected).abs() < 1e-12));
    }
}
