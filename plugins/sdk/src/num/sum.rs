//! Sums and moments that keep their digits over 10⁹ terms.

/// A compensated sum: the error does not grow with the number of terms.
///
/// NaN and infinities travel as in a plain sum.
///
/// # Source
/// Neumaier 1974, "Rundungsfehleranalyse einiger Verfahren zur Summation endlicher Summen".
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sum {
    total: f64,
    lost: f64,
}

impl Sum {
    /// Adds one term.
    pub fn add(&mut self, x: f64) {
        let total = self.total + x;
        self.lost += if self.total.abs() >= x.abs() {
            (self.total - total) + x
        } else {
            (x - total) + self.total
        };
        self.total = total;
    }

    /// The sum so far: error within 2ε|Σx| + O(nε²)Σ|x|, ε = 2⁻⁵³.
    pub fn value(&self) -> f64 {
        if self.total.is_finite() { self.total + self.lost } else { self.total }
    }
}

impl Extend<f64> for Sum {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, terms: I) {
        for x in terms {
            self.add(x);
        }
    }
}

impl FromIterator<f64> for Sum {
    fn from_iter<I: IntoIterator<Item = f64>>(terms: I) -> Self {
        let mut sum = Self::default();
        sum.extend(terms);
        sum
    }
}

/// Count, mean and centred second moment of a stream of numbers.
///
/// A NaN or an infinity makes mean and variance NaN: filter before pushing.
///
/// # Source
/// Welford 1962; merging after Chan, Golub & `LeVeque` 1979.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moments {
    /// How many numbers were pushed.
    pub n: u64,
    /// Their mean; 0 if there are none.
    pub mean: f64,
    /// The sum of squared distances to the mean.
    pub m2: f64,
}

impl Moments {
    /// Takes in one number.
    pub fn push(&mut self, x: f64) {
        self.n += 1;
        let delta = x - self.mean;
        self.mean += delta / self.n as f64;
        self.m2 += delta * (x - self.mean);
    }

    /// Takes in all that `other` has seen.
    pub fn merge(&mut self, other: &Self) {
        if other.n == 0 {
            return;
        }
        let (na, nb) = (self.n as f64, other.n as f64);
        let share = nb / (na + nb);
        let delta = other.mean - self.mean;
        self.n += other.n;
        self.mean += delta * share;
        self.m2 += other.m2 + delta * delta * na * share;
    }

    /// The unbiased sample variance; infinite below two samples, as nothing bounds it.
    pub fn variance(&self) -> f64 {
        if self.n < 2 { f64::INFINITY } else { self.m2 / (self.n - 1) as f64 }
    }

    /// The standard error of the mean; infinite below two samples.
    pub fn standard_error(&self) -> f64 {
        if self.n < 2 { f64::INFINITY } else { (self.variance() / self.n as f64).sqrt() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::points::Points;

    #[test]
    fn compensated_sum_keeps_what_a_plain_sum_loses() {
        let sum: Sum = [1.0, 1e100, 1.0, -1e100].into_iter().collect();
        assert!((sum.value() - 2.0).abs() <= f64::EPSILON);
        // 0.1 as a double is 0.1 + 5.55e-18; a million of it rounds to 100000 within half an ulp.
        let sum: Sum = std::iter::repeat_n(0.1, 1_000_000).collect();
        assert!((sum.value() - 100_000.0).abs() <= 100_000.0 * f64::EPSILON);
    }

    #[test]
    fn compensated_sum_carries_infinity() {
        let sum: Sum = [1.0, f64::INFINITY, 1.0].into_iter().collect();
        assert!(sum.value().is_infinite());
    }

    #[test]
    fn moments_find_a_small_variance_around_a_large_mean() {
        let mut m = Moments::default();
        for i in 0..100_000 {
            m.push(if i % 2 == 0 { 1e6 + 0.1 } else { 1e6 - 0.1 });
        }
        // The inputs are themselves rounded to 1e6 ε, a relative 1e6 ε / 0.1 of their distance.
        let expected = 0.01 * 100_000.0 / 99_999.0;
        let bound = 4.0 * expected * 1e7 * f64::EPSILON;
        assert!((m.variance() - expected).abs() <= bound, "{}", m.variance() - expected);
        assert!((m.mean - 1e6).abs() <= 1e6 * f64::EPSILON);
        assert!((m.standard_error() - (expected / 1e5).sqrt()).abs() <= 1e-9);
    }

    #[test]
    fn merged_moments_equal_those_of_the_entire_stream() {
        let mut rng = Points::new(4);
        let (mut whole, mut parts) = (Moments::default(), Moments::default());
        for size in [0, 1, 7, 1000] {
            let mut part = Moments::default();
            for _ in 0..size {
                let x = rng.f64();
                whole.push(x);
                part.push(x);
            }
            parts.merge(&part);
        }
        // Each of 1008 updates rounds a few times, on values below one.
        let bound = 4.0 * 1008.0 * f64::EPSILON;
        assert_eq!(whole.n, parts.n);
        assert!((whole.mean - parts.mean).abs() <= bound);
        assert!((whole.variance() - parts.variance()).abs() <= bound);
    }

    #[test]
    fn one_sample_has_no_known_error() {
        let mut m = Moments::default();
        m.push(3.0);
        assert!(m.variance().is_infinite() && m.standard_error().is_infinite());
    }
}
