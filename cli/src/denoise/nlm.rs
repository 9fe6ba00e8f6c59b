//! Non-local means: each pixel becomes the mean of those about it whose neighbourhoods differ from its
//! own by no more than their noise.
//!
//! Rousselle, Knaus and Zwicker, "Adaptive Rendering with Non-Local Means Filtering", SIGGRAPH Asia
//! 2012, eq. 5 to 8, without its two half buffers: the file holds one. Weights by features as in their
//! "Robust Denoising using Feature and Color Information", 2013: the lesser of the two counts.

use std::num::NonZeroUsize;

use glam::Vec3;

use super::guide::Guide;

/// Pixels to each side of which a mean is taken, and to each side of those that are compared.
const WINDOW: i32 = 10;
const PATCH: usize = 3;

/// How many standard deviations of the difference make one step of the weight; theirs.
const STEP: f32 = 0.45;

/// What is smoothed.
pub(super) struct Noisy {
    pub(super) width: usize,
    pub(super) rgb: Vec<Vec3>,
    /// Variance of the mean, finite and not below zero where `valid`.
    pub(super) variance: Vec<Vec3>,
    /// Whether a pixel has a finite value and says how wrong it may be.
    pub(super) valid: Vec<bool>,
    pub(super) guide: Guide,
}

/// Rows of one thread.
struct Band {
    from: usize,
    sums: Vec<(Vec3, f32)>,
}

/// Smooths all rows, on as many threads as there are cores; the values do not depend on how many.
pub(super) fn smooth(noisy: &Noisy) -> Vec<Vec3> {
    let width = noisy.width;
    let height = noisy.rgb.len() / width;
    let threads = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let rows = height.div_ceil(threads).max(1);
    let mut bands: Vec<Band> = (0..height)
        .step_by(rows)
        .map(|from| Band { from, sums: vec![(Vec3::ZERO, 0.0); rows.min(height - from) * width] })
        .collect();
    std::thread::scope(|scope| {
        for band in &mut bands {
            scope.spawn(|| fill(noisy, height, band));
        }
    });
    let sums = bands.into_iter().flat_map(|band| band.sums).enumerate();
    sums.map(|(i, (sum, weight))| {
        // A pixel without any neighbour that counts stays as it is.
        if weight > 0.0 { sum / weight } else { noisy.rgb[i] }
    })
    .collect()
}

/// Adds all neighbours of a band's pixels.
fn fill(noisy: &Noisy, height: usize, band: &mut Band) {
    let width = noisy.width;
    let rows = band.sums.len() / width;
    // Patches reach into the bands beside.
    let (first, end) = (band.from.saturating_sub(PATCH), (band.from + rows + PATCH).min(height));
    let mut distances = vec![0.0; (end - first) * width];
    for (dx, dy) in (-WINDOW..=WINDOW).flat_map(|dy| (-WINDOW..=WINDOW).map(move |dx| (dx, dy))) {
        let other = |x: usize, y: usize| -> Option<usize> {
            let (x, y) = (x.checked_add_signed(dx as isize)?, y.checked_add_signed(dy as isize)?);
            (x < width && y < height).then(|| y * width + x)
        };
        for (row, y) in distances.chunks_exact_mut(width).zip(first..end) {
            for (x, distance) in row.iter_mut().enumerate() {
                *distance = other(x, y).map_or(0.0, |q| distance_of(noisy, y * width + x, q));
            }
        }
        average(&mut distances, width);
        for (i, sum) in band.sums.iter_mut().enumerate() {
            let (x, y) = (i % width, band.from + i / width);
            let p = y * width + x;
            let Some(q) = other(x, y).filter(|q| noisy.valid[*q]) else { continue };
            let colour = distances[(y - first) * width + x].max(0.0);
            let apart = ((dx * dx + dy * dy) as f32).sqrt();
            let weight = (-colour.max(noisy.guide.distance(p, q, apart))).exp();
            // The pixel itself is like itself, whatever its patch says of rounding.
            let weight = if p == q { 1.0 } else { weight };
            sum.0 += noisy.rgb[q] * weight;
            sum.1 += weight;
        }
    }
}

/// Squared difference beyond what noise explains, in parts of the noise; 0 where nothing is known.
fn distance_of(noisy: &Noisy, p: usize, q: usize) -> f32 {
    if !(noisy.valid[p] && noisy.valid[q]) {
        return 0.0;
    }
    let (a, b) = (noisy.variance[p], noisy.variance[q]);
    let (u, v) = (noisy.rgb[p], noisy.rgb[q]);
    let difference = u - v;
    // What is not random may differ by rounding.
    let rounding = (u.abs() + v.abs()) * f32::EPSILON + Vec3::splat(1e-18);
    let beyond = difference * difference - (a + a.min(b));
    let scale = rounding * rounding + (a + b) * (STEP * STEP);
    (beyond / scale).element_sum() / 3.0
}

/// Means over patches, cut at the borders.
fn average(values: &mut [f32], width: usize) {
    let mut line = vec![];
    for row in values.chunks_exact_mut(width) {
        line.clear();
        line.extend_from_slice(row);
        for (x, value) in row.iter_mut().enumerate() {
            let patch = &line[x.saturating_sub(PATCH)..(x + PATCH + 1).min(width)];
            *value = patch.iter().sum::<f32>() / patch.len() as f32;
        }
    }
    let before = values.to_vec();
    let rows = values.len() / width;
    for (y, row) in values.chunks_exact_mut(width).enumerate() {
        let (from, end) = (y.saturating_sub(PATCH), (y + PATCH + 1).min(rows));
        row.fill(0.0);
        for other in before[from * width..end * width].chunks_exact(width) {
            row.iter_mut().zip(other).for_each(|(sum, v)| *sum += v);
        }
        for sum in row {
            *sum /= (end - from) as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use luxel_sdk::sampling::Rng;

    use super::*;

    const SIDE: usize = 48;
    const NOISE: f32 = 0.1;

    /// Dark on the left, bright on the right, with noise.
    fn noisy(left: f32, right: f32, guide: Guide) -> (Noisy, Vec<f32>) {
        let mut rng = Rng::new(3);
        // The sum of twelve uniform numbers less 6 is nearly normal.
        let mut normal = || (0..12).map(|_| rng.f32()).sum::<f32>() - 6.0;
        let truth: Vec<f32> =
            (0..SIDE * SIDE).map(|i| if i % SIDE < SIDE / 2 { left } else { right }).collect();
        let rgb =
            truth.iter().map(|v| Vec3::splat(*v) + NOISE * Vec3::new(normal(), normal(), normal()));
        let rgb: Vec<Vec3> = rgb.collect();
        let variance = vec![Vec3::splat(NOISE * NOISE); rgb.len()];
        let valid = vec![true; rgb.len()];
        (Noisy { width: SIDE, rgb, variance, valid, guide }, truth)
    }

    fn mse(found: &[Vec3], truth: &[f32]) -> f32 {
        let squares = found.iter().zip(truth).map(|(f, t)| (*f - Vec3::splat(*t)).length_squared());
        squares.sum::<f32>() / (3 * truth.len()) as f32
    }

    #[test]
    fn noise_falls_and_an_edge_beyond_it_stays() {
        let (noisy, truth) = noisy(1.0, 2.0, Guide::default());
        let found = smooth(&noisy);
        let left = mse(&found, &truth);
        assert!(left < NOISE * NOISE / 20.0, "{left}");
        let at = |x: usize| found[SIDE / 2 * SIDE + x].x;
        // Beside the edge, half of the step would be five standard errors.
        assert!((at(SIDE / 2 - 1) - 1.0).abs() < NOISE && (at(SIDE / 2) - 2.0).abs() < NOISE);
    }

    #[test]
    fn an_edge_within_the_noise_stays_where_a_feature_shows_it() {
        let step = 0.5 * NOISE;
        let albedo = (0..SIDE * SIDE).map(|i| if i % SIDE < SIDE / 2 { 0.2 } else { 0.8 });
        let guide = Guide { albedo: albedo.map(Vec3::splat).collect(), ..Guide::default() };
        let (guided, truth) = noisy(1.0, 1.0 + step, guide);
        let (blind, _) = noisy(1.0, 1.0 + step, Guide::default());
        let (with, without) = (mse(&smooth(&guided), &truth), mse(&smooth(&blind), &truth));
        assert!(with < 0.7 * without, "{with} {without}");
    }

    #[test]
    fn a_pixel_that_is_no_number_is_filled_and_spoils_no_other() {
        let (mut noisy, truth) = noisy(1.0, 1.0, Guide::default());
        let at = 7 * SIDE + 9;
        (noisy.rgb[at], noisy.valid[at]) = (Vec3::NAN, false);
        let found = smooth(&noisy);
        assert!(mse(&found, &truth) < NOISE * NOISE / 20.0);
    }
}
