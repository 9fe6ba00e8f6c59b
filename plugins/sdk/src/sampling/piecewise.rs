//! Piecewise-constant densities over [0, 1), and discrete choice by the same table.

use super::weights::{WeightError, largest, relative};

/// A density over [0, 1) that is constant on each of n equal steps.
///
/// Probabilities are differences of the stored f64 cumulative table: exactly how often a step is
/// drawn, so that a weight lost to rounding has probability 0 and no estimate is biased.
#[derive(Clone, Debug, PartialEq)]
pub struct Piecewise1 {
    /// Cumulative probabilities: n + 1 numbers from 0 to 1.
    cdf: Vec<f64>,
    /// For each of a power of two of equal parts of [0, 1): how many of `cdf` are ≤ its start.
    guide: Vec<u32>,
    mean: f64,
}

/// A draw from a [`Piecewise1`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piecewise1Sample {
    /// The place in [0, 1).
    pub x: f64,
    /// Density at `x` with respect to length; its integral is 1.
    pub pdf: f64,
    /// Probability of the step.
    pub pmf: f64,
    /// The step that holds `x`.
    pub index: usize,
    /// Where in its step `x` lies, in [0, 1): a fresh random number for a discrete choice.
    pub u: f64,
}

impl Piecewise1 {
    /// A density proportional to `weights`; uniform if all are zero.
    ///
    /// # Errors
    /// If there are no weights, 2³² or more, or one is negative, infinite or NaN.
    pub fn new(weights: &[f64]) -> Result<Self, WeightError> {
        let largest = largest(weights)?;
        let mut cdf = Vec::with_capacity(weights.len() + 1);
        let mut sum = 0.0;
        cdf.push(0.0);
        for &w in weights {
            sum += relative(w, largest);
            cdf.push(sum);
        }
        for c in &mut cdf {
            *c /= sum;
        }
        let mean = if largest > 0.0 { largest * (sum / weights.len() as f64) } else { 0.0 };
        Ok(Self { guide: guide(&cdf)?, cdf, mean })
    }

    /// Number of steps.
    pub fn n_steps(&self) -> usize {
        self.cdf.len() - 1
    }

    /// Bytes of memory that it takes.
    pub(super) fn bytes(&self) -> usize {
        size_of::<Self>() + size_of_val(&*self.cdf) + size_of_val(&*self.guide)
    }

    /// The integral of the weights as a function over [0, 1): their mean.
    pub fn integral(&self) -> f64 {
        self.mean
    }

    /// Draws a place and a step; `u` in [0, 1), and anything else counts as the nearer end.
    ///
    /// Increasing in `u`; a step of probability 0 is never drawn.
    pub fn sample(&self, u: f64) -> Piecewise1Sample {
        let n = self.n_steps();
        let u = u.max(0.0).min(1.0f64.next_down());
        let index = self.find(u).clamp(1, n) - 1;
        let pmf = self.pmf(index);
        let within = ((u - self.cdf[index]) / pmf).clamp(0.0, 1.0f64.next_down());
        // The sum may round up to the next step.
        let end = ((index + 1) as f64 / n as f64).next_down();
        let x = ((index as f64 + within) / n as f64).min(end);
        Piecewise1Sample { x, pdf: pmf * n as f64, pmf, index, u: within }
    }

    /// Density at `x`, per length; 0 outside [0, 1).
    pub fn pdf(&self, x: f64) -> f64 {
        self.step(x).map_or(0.0, |i| self.pmf(i) * self.n_steps() as f64)
    }

    /// Probability of step `index`; 0 beyond the last.
    pub fn pmf(&self, index: usize) -> f64 {
        match self.cdf.get(index..) {
            Some([low, high, ..]) => high - low,
            _ => 0.0,
        }
    }

    /// How many of the cumulative probabilities are ≤ `u`, in [0, 1).
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "u is in [0, 1)")]
    fn find(&self, u: f64) -> usize {
        // A power of two of parts makes product and part exact: `u` is not below its part's start.
        let part = (u * (self.guide.len() - 1) as f64) as usize;
        let (low, high) = (self.guide[part] as usize, self.guide[part + 1] as usize);
        low + self.cdf[low..high].partition_point(|&c| c <= u)
    }

    /// The step that holds `x`; none outside [0, 1).
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "x is in [0, 1)")]
    pub(super) fn step(&self, x: f64) -> Option<usize> {
        let n = self.n_steps();
        (0.0..1.0).contains(&x).then(|| ((x * n as f64) as usize).min(n - 1))
    }
}

/// Where to look for the numbers of each part: Chen & Asau 1974.
fn guide(cdf: &[f64]) -> Result<Vec<u32>, WeightError> {
    let parts = (cdf.len() - 1).next_power_of_two();
    let mut below = 0;
    let start = |part: usize| part as f64 / parts as f64;
    (0..=parts)
        .map(|part| {
            while below < cdf.len() && cdf[below] <= start(part) {
                below += 1;
            }
            u32::try_from(below).map_err(|_| WeightError::Size)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Rng;
    use crate::sampling::chi_square::Counts;

    #[test]
    fn samples_follow_the_weights() {
        let weights = [0.0, 3.0, 1.0, 0.0, 0.5, 6.0, 0.0];
        let d = Piecewise1::new(&weights).unwrap();
        assert!((d.integral() - 1.5).abs() <= 4.0 * f64::EPSILON);
        let mut counts = Counts::new(7);
        let mut rng = Rng::new(23);
        for _ in 0..20_000 {
            let s = d.sample(rng.f64());
            counts.add(s.index);
            assert!((s.pdf - d.pdf(s.x)).abs() <= 0.0 && d.step(s.x) == Some(s.index));
            assert!((0.0..1.0).contains(&s.u) && s.pdf > 0.0);
        }
        counts.check(|i| weights[i] / 10.5);
    }

    #[test]
    fn the_place_within_a_step_is_uniform_and_increasing() {
        let d = Piecewise1::new(&[1.0, 3.0]).unwrap();
        for (u, x) in [(0.0, 0.0), (0.125, 0.25), (0.25, 0.5), (0.625, 0.75)] {
            assert!((d.sample(u).x - x).abs() <= f64::EPSILON);
        }
        assert!(d.sample(1.0f64.next_down()).x < 1.0);
    }

    #[test]
    fn all_zero_weights_are_uniform() {
        let d = Piecewise1::new(&[0.0; 4]).unwrap();
        assert_eq!(d.sample(0.6).index, 2);
        assert!((d.pdf(0.6) - 1.0).abs() <= f64::EPSILON && d.integral() <= 0.0);
    }

    #[test]
    fn the_guide_finds_what_a_plain_search_finds() {
        let mut rng = Rng::new(27);
        for n in [1, 2, 3, 64, 100, 1000] {
            let weights: Vec<_> = (0..n).map(|_| (rng.f64() - 0.3).max(0.0).powi(9)).collect();
            let d = Piecewise1::new(&weights).unwrap();
            let edges: Vec<_> =
                d.cdf.iter().flat_map(|&c| [c, c.next_down(), c.next_up()]).collect();
            let parts = (0..64).map(|i| f64::from(i) / 64.0);
            for u in edges.into_iter().chain(parts).filter(|u| (0.0..1.0).contains(u)) {
                assert_eq!(d.find(u), d.cdf.partition_point(|&c| c <= u), "{n} {u}");
            }
        }
    }

    #[test]
    fn extreme_weights_neither_overflow_nor_vanish() {
        let d = Piecewise1::new(&[f64::MAX, f64::MAX, 0.0]).unwrap();
        assert!((d.pmf(0) - 0.5).abs() <= f64::EPSILON && d.integral().is_finite());
        let d = Piecewise1::new(&[5e-324, 0.0, 5e-324]).unwrap();
        assert!((d.pmf(2) - 0.5).abs() <= f64::EPSILON);
        let d = Piecewise1::new(&[1e-30, 1.0, 1e-30]).unwrap();
        assert_eq!(d.sample(1.0f64.next_down()).index, 1);
        assert!(d.pmf(2) <= 0.0);
    }

    #[test]
    fn numbers_outside_the_unit_interval_are_clamped() {
        let d = Piecewise1::new(&[0.0, 1.0, 1.0, 0.0]).unwrap();
        for (u, index) in [(-1.0, 1), (f64::NAN, 1), (1.0, 2), (f64::INFINITY, 2)] {
            assert_eq!(d.sample(u).index, index);
        }
        assert!([-0.1, 1.0, f64::NAN].iter().all(|&x| d.pdf(x) <= 0.0));
        assert!(d.pmf(4) <= 0.0 && d.pmf(usize::MAX) <= 0.0);
    }
}
