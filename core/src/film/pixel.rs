//! The estimate of one pixel, and how wrong it may be.
//!
//! Sobol' points err less than independent ones, so the spread of samples says too much. Blocks of
//! consecutive samples are point sets of their own, and their means spread as such sets err. Samples
//! fall into parts, each as long as all before it (16, 16, 32, 64, …), and each part but the first into
//! eight blocks. Blocks and parts are taken as independent; where together they err less, as scrambled
//! nets do, the standard error is an upper estimate (docs/decisions/0024).
//!
//! # Source
//! Owen 1997, Monte Carlo variance of scrambled net quadrature; batch means as in Law 2015, Simulation
//! Modeling and Analysis, §9.5.3.

use glam::{DVec3, Vec3};

/// Samples of the first part, each a block.
const FIRST: u32 = 16;
/// Blocks of each later part.
const BLOCKS: u32 = 8;

/// The estimate of one pixel, per channel, in f64.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// Samples that count.
    pub n: u32,
    /// Samples that were not finite, and were left out.
    pub bad: u32,
    /// Mean of linear sRGB, in the radiance unit of `luxel_sdk::color`.
    pub mean: DVec3,
    /// What `mean` lacks, below its last digit.
    pub(super) rest: Vec3,
    /// Squares of the samples' distances from their mean.
    pub(super) m2: DVec3,
    /// Sum of the samples since the last whole block.
    pub(super) open: DVec3,
    /// Mean of the blocks of the part that is not whole.
    pub(super) block_mean: DVec3,
    /// Squares of their distances from it.
    pub(super) block_m2: DVec3,
    /// Root of the variance of the mean of the whole parts, times their samples: a picture's errors are
    /// written in single precision, too.
    pub(super) before: Vec3,
}

impl Pixel {
    /// No sample.
    pub const NONE: Self = Self {
        n: 0,
        bad: 0,
        mean: DVec3::ZERO,
        rest: Vec3::ZERO,
        m2: DVec3::ZERO,
        open: DVec3::ZERO,
        block_mean: DVec3::ZERO,
        block_m2: DVec3::ZERO,
        before: Vec3::ZERO,
    };

    /// Adds a sample; one that is not finite is counted and left out.
    pub fn push(&mut self, rgb: DVec3) {
        if !rgb.is_finite() {
            self.bad += 1;
            return;
        }
        let part = Part::of(self.n);
        self.n += 1;
        let delta = self.off(rgb);
        self.move_mean(delta / f64::from(self.n));
        self.m2 += delta * self.off(rgb);
        self.open += rgb;
        if (self.n - part.start).is_multiple_of(part.block) {
            self.end_block(part);
        }
    }

    /// How far a sample is from the mean.
    fn off(&self, rgb: DVec3) -> DVec3 {
        (rgb - self.mean) - self.rest.as_dvec3()
    }

    /// Adds to the mean, and keeps what the sum cannot hold (Knuth's `TwoSum`).
    fn move_mean(&mut self, step: DVec3) {
        let step = step + self.rest.as_dvec3();
        let sum = self.mean + step;
        let of_step = sum - self.mean;
        self.rest = ((self.mean - (sum - of_step)) + (step - of_step)).as_vec3();
        self.mean = sum;
    }

    fn end_block(&mut self, part: Part) {
        let blocks = (self.n - part.start) / part.block;
        let mean = self.open / f64::from(part.block);
        self.open = DVec3::ZERO;
        let delta = mean - self.block_mean;
        self.block_mean += delta / f64::from(blocks);
        self.block_m2 += delta * (mean - self.block_mean);
        if blocks == part.blocks {
            self.before = root(self.per_sample()).as_vec3().min(Vec3::MAX);
            (self.block_mean, self.block_m2) = (DVec3::ZERO, DVec3::ZERO);
        }
    }

    /// Variance of the mean, times the number of samples.
    fn per_sample(&self) -> DVec3 {
        let part = Part::of(self.n - 1);
        let here = self.n - part.start;
        if part.start == 0 {
            return self.variance();
        }
        // Blocks that are not there yet vary as the parts before.
        let blocks = (here / part.block).max(1);
        let missing = f64::from(part.blocks - blocks);
        let before = self.before();
        let found = self.block_m2 * f64::from(part.block) + before * missing;
        let latest = found / f64::from(part.blocks - 1);
        (before * f64::from(part.start) + latest * f64::from(here)) / f64::from(self.n)
    }

    /// Variance of the mean of the whole parts, times their samples.
    fn before(&self) -> DVec3 {
        let root = self.before.as_dvec3();
        root * root
    }

    /// Variance of one sample, per channel; zero below two samples.
    pub fn variance(&self) -> DVec3 {
        if self.n < 2 { DVec3::ZERO } else { self.m2 / f64::from(self.n - 1) }
    }

    /// Standard error of the mean, per channel; infinite below two samples. Honest for independent
    /// samples, an upper estimate for scrambled nets.
    pub fn standard_error(&self) -> DVec3 {
        if self.n < 2 {
            return DVec3::INFINITY;
        }
        // At the end of a part its blocks have been forgotten for what they came to.
        let is_whole = Part::of(self.n).start == self.n;
        let per_sample = if is_whole { self.before() } else { self.per_sample() };
        root(per_sample / f64::from(self.n))
    }
}

fn root(v: DVec3) -> DVec3 {
    v.map(f64::sqrt)
}

/// The part that a sample belongs to.
#[derive(Clone, Copy)]
struct Part {
    /// Number of its first sample.
    start: u32,
    /// Samples of each of its blocks.
    block: u32,
    /// Its blocks.
    blocks: u32,
}

impl Part {
    fn of(sample: u32) -> Self {
        if sample < FIRST {
            return Self { start: 0, block: 1, blocks: FIRST };
        }
        let start = 1 << sample.ilog2();
        Self { start, block: start / BLOCKS, blocks: BLOCKS }
    }
}

/// Degrees of freedom of the standard error of a pixel with `n` samples: `n − 1` in the first part,
/// then 15 to 21; zero below two samples.
///
/// # Source
/// Satterthwaite 1946, for parts of equal variance per sample.
pub fn degrees_of_freedom(n: u32) -> f64 {
    if n <= FIRST {
        return f64::from(n.saturating_sub(1));
    }
    let whole = 1_u32 << n.ilog2();
    let share = |samples: u32| f64::from(samples) / f64::from(whole);
    let first = share(FIRST).powi(2) / f64::from(FIRST - 1);
    let starts = std::iter::successors(Some(FIRST), |start| start.checked_mul(2));
    let later = starts.take_while(|start| *start < whole);
    let later: f64 = later.map(|start| share(start).powi(2) / f64::from(BLOCKS - 1)).sum();
    1.0 / (first + later)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(samples: impl Iterator<Item = f64>) -> Pixel {
        let mut pixel = Pixel::NONE;
        samples.for_each(|x| pixel.push(DVec3::splat(x)));
        pixel
    }

    /// The same number for the same index, in [0, 1).
    fn noise(i: u32) -> f64 {
        f64::from(luxel_sdk::sampling::hash_combine(7, i)) / 4_294_967_296.0
    }

    #[test]
    fn mean_and_variance_survive_a_large_offset() {
        let pixel = of((0..1000).map(|i| 1e9 + f64::from(i % 2)));
        // Alternating 0 and 1: variance n/(n−1)/4; cancellation costs 1e9·2⁻⁵² of one.
        assert!((pixel.variance().x - 0.25 * 1000.0 / 999.0).abs() < 1e-6);
        assert!((pixel.mean.y - 1e9 - 0.5).abs() < 1e-6);
    }

    #[test]
    fn samples_that_are_not_finite_are_counted_and_left_out() {
        let mut pixel = of([1.0].into_iter());
        pixel.push(DVec3::new(1.0, f64::NAN, 0.0));
        assert_eq!((pixel.n, pixel.bad, pixel.mean), (1, 1, DVec3::ONE));
        assert_eq!(pixel.standard_error(), DVec3::INFINITY);
    }

    #[test]
    fn up_to_sixteen_samples_the_error_is_that_of_independent_ones() {
        for n in 2..=16 {
            let pixel = of((0..n).map(noise));
            let plain = (pixel.variance().x / f64::from(n)).sqrt();
            // At the end of the part its root is rounded to single precision.
            let most = if n == 16 { 2f64.powi(-24) } else { 1e-12 };
            assert!((pixel.standard_error().x / plain - 1.0).abs() <= most, "{n}");
        }
    }

    #[test]
    fn parts_are_weighed_by_their_samples_and_blocks_by_their_means() {
        let samples: Vec<f64> = (0..64).map(noise).collect();
        let pixel = of(samples.iter().copied());
        // By hand: parts of 16 × 1, 8 × 2 and 8 × 4 samples.
        let mut expected = 0.0;
        for (part, block) in [(&samples[..16], 1), (&samples[16..32], 2), (&samples[32..], 4)] {
            let means: Vec<f64> =
                part.chunks(block).map(|b| b.iter().sum::<f64>() / b.len() as f64).collect();
            let mean = means.iter().sum::<f64>() / means.len() as f64;
            let m2: f64 = means.iter().map(|m| (m - mean).powi(2)).sum();
            let of_mean = m2 / (means.len() - 1) as f64 / means.len() as f64;
            expected += of_mean * (part.len() as f64 / 64.0).powi(2);
        }
        // Roots in single precision of the first part, of the first two and of all three: the square of each
        // errs by 2^-23 at most.
        assert!((pixel.standard_error().y.powi(2) / expected - 1.0).abs() < 3.0 * 2f64.powi(-23));
    }

    #[test]
    fn the_error_of_independent_samples_is_right_at_every_count() {
        for n in [17, 20, 24, 40, 64, 100, 1000] {
            // 400 estimates with 15 degrees of freedom or more: their mean errs by sqrt(2/15/400).
            let pixels: Vec<Pixel> =
                (0..400).map(|k| of((0..n).map(|i| noise(k * 5000 + i)))).collect();
            let said = pixels.iter().map(|p| p.standard_error().x.powi(2)).sum::<f64>() / 400.0;
            let is = 1.0 / 12.0 / f64::from(n);
            assert!((said / is - 1.0).abs() < 4.0 * 0.0183, "{n}: {}", said / is);
        }
    }

    #[test]
    fn degrees_of_freedom_are_those_of_the_parts() {
        for (n, degrees) in [(0, 0.0), (1, 0.0), (2, 1.0), (16, 15.0)] {
            assert!((degrees_of_freedom(n) - degrees).abs() <= 0.0, "{n}");
        }
        assert!((degrees_of_freedom(32) - 1.0 / (0.25 / 7.0 + 0.25 / 15.0)).abs() < 1e-9);
        assert!((20.9..21.0).contains(&degrees_of_freedom(1 << 20)));
        assert!((20.9..21.1).contains(&degrees_of_freedom(u32::MAX)));
    }

    #[test]
    fn a_mean_of_many_samples_is_right_to_twelve_digits() {
        let n = count();
        // Multiples of 2⁻³² have an exact sum; most are small and a few large, as fireflies are.
        let (mut pixel, mut sum) = (Pixel::NONE, 0_u128);
        for i in 0..n {
            let hash = luxel_sdk::sampling::hash_combine(3, i);
            let firefly = if hash.is_multiple_of(1000) { 1 << 20 } else { 1 };
            sum += u128::from(hash) * firefly;
            pixel.push(DVec3::splat(f64::from(hash) / 4_294_967_296.0 * firefly as f64));
        }
        let expected = sum as f64 / 4_294_967_296.0 / f64::from(n);
        let error = (pixel.mean.x / expected - 1.0).abs();
        println!("relative error of the mean of {n} samples: {error:.1e}");
        assert!(error <= 1e-12, "{error:.1e}");
        // A constant that no float holds drifts where sums are plain.
        let constant = of((0..n).map(|_| 0.1));
        assert!((constant.mean.x - 0.1).abs() <= 1e-17 && constant.standard_error().x <= 1e-17);
    }

    /// A million samples, or as many as `LUXEL_SAMPLES` says.
    #[expect(clippy::disallowed_methods, reason = "whoever runs the test says so")]
    fn count() -> u32 {
        let asked = std::env::var("LUXEL_SAMPLES").ok();
        asked.and_then(|n| n.parse::<f64>().ok()).map_or(1_000_000, crate::cast::whole)
    }
}
