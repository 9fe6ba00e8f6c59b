//! How the error falls with the number of samples: variance = v / nᵖ.

use super::estimate::Number;

/// Standard errors within which a power is taken for that of independent samples.
const SAME: f64 = 2.0;

/// A straight line through logarithms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fit {
    /// Variance of a picture with one sample per pixel, if the line held so far down.
    v: f64,
    /// p, as it is used: 1 where it may well be 1.
    pub(super) power: f64,
    /// p, as it was measured.
    pub(super) measured: Number,
    /// Logarithm of the samples in whose middle the line was laid.
    middle: f64,
    /// Standard error of the logarithm of the variance there.
    height_error: f64,
}

impl Fit {
    /// Of two numbers of samples or more, with the variance of each; `None` where there is no noise.
    ///
    /// All count alike: seldom samples make small variances look more certain than they are.
    pub(super) fn of(points: &[(u32, Number)]) -> Option<Self> {
        let n = points.len() as f64;
        if points.len() < 2 || points.iter().any(|(_, variance)| variance.value <= 0.0) {
            return None;
        }
        let x = |spp: u32| f64::from(spp).ln();
        let middle = points.iter().map(|(spp, _)| x(*spp)).sum::<f64>() / n;
        let spread: f64 = points.iter().map(|(spp, _)| (x(*spp) - middle).powi(2)).sum();
        let (mut slope, mut square, mut height, mut height_square) = (0.0, 0.0, 0.0, 0.0);
        for (spp, variance) in points {
            let weight = (x(*spp) - middle) / spread;
            slope += weight * variance.value.ln();
            let error = variance.error / variance.value;
            square += (weight * error).powi(2);
            height += variance.value.ln() / n;
            height_square += (error / n).powi(2);
        }
        let measured = Number { value: -slope, error: square.sqrt() };
        let is_one = (measured.value - 1.0).abs() <= SAME * measured.error;
        let power = if is_one { 1.0 } else { measured.value };
        let height_error = height_square.sqrt();
        Some(Self { v: (height + power * middle).exp(), power, measured, middle, height_error })
    }

    /// Samples at which the variance is that; not whole.
    pub(super) fn samples(&self, variance: f64) -> f64 {
        (self.v / variance).powf(1.0 / self.power)
    }

    /// Variance with so many samples.
    pub(super) fn variance(&self, samples: f64) -> f64 {
        self.v / samples.powf(self.power)
    }

    /// Relative standard error of so many samples, if they were found by `samples`: of the line's height,
    /// and of its slope the more, the further from its middle.
    pub(super) fn relative_error(&self, samples: f64) -> f64 {
        let leaning = (samples.ln() - self.middle) * self.measured.error;
        self.height_error.hypot(leaning) / self.power
    }

    /// Samples at which it is `target`, where it was `found` with `n`.
    pub(super) fn corrected(&self, n: f64, found: f64, target: f64) -> f64 {
        n * (found / target).powf(1.0 / self.power)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(power: f64, error: f64) -> Fit {
        let point = |n: u32| {
            let value = 3.0 * f64::from(n).powf(-power);
            (n, Number { value, error: error * value })
        };
        Fit::of(&[4, 16, 64].map(point)).unwrap()
    }

    #[test]
    fn a_power_law_is_found_and_a_power_of_nearly_one_is_one() {
        let steep = fit(1.5, 0.01);
        assert!((steep.measured.value - 1.5).abs() < 1e-12);
        // ln 4 between neighbours: the slope's error is that of a point over √2 ln 4.
        assert!((steep.measured.error - 0.01 / (2.0_f64.sqrt() * 4.0_f64.ln())).abs() < 1e-12);
        assert!((steep.samples(3.0 / 1000.0) - 100.0).abs() < 1e-9);
        // A point's error over √3 in the middle; a hundredfold of that off, the slope's error counts as well.
        let middle = 0.01 / 3.0_f64.sqrt() / 1.5;
        assert!((steep.relative_error(16.0) - middle).abs() < 1e-12);
        let leaning = 100.0_f64.ln() * steep.measured.error / 1.5;
        assert!((steep.relative_error(1600.0) - middle.hypot(leaning)).abs() < 1e-12);
        let nearly = fit(1.001, 0.01);
        assert!(
            nearly.power.to_bits() == 1.0_f64.to_bits()
                && (nearly.measured.value - 1.001).abs() < 1e-12
        );
        assert!((nearly.corrected(10.0, 0.3, 0.1) - 30.0).abs() < 1e-9);
    }

    #[test]
    fn where_nothing_scatters_there_is_nothing_to_fit() {
        let none = Number::default();
        assert!(Fit::of(&[(4, none), (16, none)]).is_none());
        assert!(Fit::of(&[(4, Number { value: 1.0, error: 0.1 })]).is_none());
    }
}
