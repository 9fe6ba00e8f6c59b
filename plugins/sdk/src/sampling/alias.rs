//! Discrete choice in constant time, for a million lights or triangles.

use crate::num::Sum;

use super::weights::{WeightError, largest, relative};

/// A table that draws an index with probability proportional to its weight, in O(1).
///
/// # Source
/// Walker 1974, built after Vose 1991; PBR4 §A.1.
#[derive(Clone, Debug, PartialEq)]
pub struct Alias {
    bins: Vec<Bin>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Bin {
    /// Share of the bin that is its own.
    keep: f64,
    /// Who has the rest.
    other: usize,
    /// Probability of the bin's own index.
    pmf: f64,
}

/// A draw from an [`Alias`] table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AliasSample {
    /// The chosen index.
    pub index: usize,
    /// Its probability, above zero.
    pub pmf: f64,
    /// What is left of the random number: uniform in [0, 1), independent of the choice. Of its 53
    /// bits, log₂ n are spent.
    pub u: f64,
}

impl Alias {
    /// A table for `weights`; uniform if all are zero.
    ///
    /// # Errors
    /// If there are no weights, or one is negative, infinite or NaN.
    pub fn new(weights: &[f64]) -> Result<Self, WeightError> {
        let largest = largest(weights)?;
        let n = weights.len();
        let sum = weights.iter().map(|&w| relative(w, largest)).collect::<Sum>().value();
        let bin = |w: &f64| Bin { keep: 1.0, other: 0, pmf: relative(*w, largest) / sum };
        let mut bins: Vec<_> = weights.iter().map(bin).collect();

        // Fill each bin that is below the mean from one that is above.
        let mut share: Vec<f64> = bins.iter().map(|b| b.pmf * n as f64).collect();
        let (mut below, mut above): (Vec<usize>, Vec<usize>) =
            (0..n).partition(|&i| share[i] < 1.0);
        while let (Some(&low), Some(&high)) = (below.last(), above.last()) {
            below.pop();
            bins[low].keep = share[low];
            bins[low].other = high;
            share[high] -= 1.0 - share[low];
            if share[high] < 1.0 {
                above.pop();
                below.push(high);
            }
        }
        // Shares left over average 1 up to rounding, so those bins are full: `keep` is 1 already.
        Ok(Self { bins })
    }

    /// Number of indices.
    pub fn n_bins(&self) -> usize {
        self.bins.len()
    }

    /// Draws an index; `u` in [0, 1), and anything else counts as the nearer end.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "u is clamped")]
    pub fn sample(&self, u: f64) -> AliasSample {
        let n = self.bins.len();
        let scaled = u.max(0.0).min(1.0f64.next_down()) * n as f64;
        let first = (scaled as usize).min(n - 1);
        let bin = &self.bins[first];
        let rest = scaled - first as f64;
        let (index, u) = if rest < bin.keep {
            (first, rest / bin.keep)
        } else {
            (bin.other, (rest - bin.keep) / (1.0 - bin.keep))
        };
        let u = u.clamp(0.0, 1.0f64.next_down());
        AliasSample { index, pmf: self.bins[index].pmf, u }
    }

    /// Probability of `index`; 0 beyond the last.
    pub fn pmf(&self, index: usize) -> f64 {
        self.bins.get(index).map_or(0.0, |b| b.pmf)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Moments;
    use crate::sampling::Rng;
    use crate::sampling::chi_square::Counts;

    /// Probability of each index as the table draws it.
    fn table_probabilities(t: &Alias) -> Vec<f64> {
        let mut p = vec![0.0; t.n_bins()];
        for (i, b) in t.bins.iter().enumerate() {
            p[i] += b.keep / t.n_bins() as f64;
            p[b.other] += (1.0 - b.keep) / t.n_bins() as f64;
        }
        p
    }

    #[test]
    fn the_table_draws_what_the_weights_say() {
        let weights = [0.0, 3.0, 1.0, 0.0, 0.5, 6.0, 0.0];
        let t = Alias::new(&weights).unwrap();
        for (p, w) in table_probabilities(&t).iter().zip(weights) {
            assert!((p - w / 10.5).abs() <= 8.0 * f64::EPSILON);
        }
        let mut counts = Counts::new(7);
        let mut left = Moments::default();
        let mut rng = Rng::new(25);
        for _ in 0..20_000 {
            let s = t.sample(rng.f64());
            counts.add(s.index);
            left.push(s.u);
            assert!((0.0..1.0).contains(&s.u) && (s.pmf - t.pmf(s.index)).abs() <= 0.0);
        }
        counts.check(|i| weights[i] / 10.5);
        assert!((left.mean - 0.5).abs() <= 5.0 * left.standard_error());
    }

    #[test]
    fn a_hundred_thousand_faint_lights_beside_a_strong_one_keep_their_share() {
        let n = 100_000;
        let mut weights = vec![1.0; n];
        weights[77] = 1e9;
        let t = Alias::new(&weights).unwrap();
        let p = table_probabilities(&t);
        // The donor loses n shares one after another: n roundings of a share of up to n.
        assert!((p[77] - t.pmf(77)).abs() <= n as f64 * f64::EPSILON);
        assert!((p[0] / t.pmf(0) - 1.0).abs() <= 1e-9);
    }

    #[test]
    fn an_index_of_weight_zero_is_never_drawn() {
        let mut rng = Rng::new(26);
        for n in 2..200 {
            let weights: Vec<_> =
                (0..n).map(|i| if i % 3 == 0 { 0.0 } else { rng.f64() * 0.1 }).collect();
            let t = Alias::new(&weights).unwrap();
            for (p, w) in table_probabilities(&t).iter().zip(weights) {
                assert!(w > 0.0 || *p <= 0.0);
            }
        }
    }

    #[test]
    fn edges_are_defined() {
        assert!((Alias::new(&[0.0; 4]).unwrap().pmf(3) - 0.25).abs() <= f64::EPSILON);
        let t = Alias::new(&[f64::MAX, f64::MAX, 0.0]).unwrap();
        assert!((t.pmf(0) - 0.5).abs() <= f64::EPSILON && t.pmf(9) <= 0.0);
        for u in [-1.0, 0.0, 1.0, f64::NAN, f64::INFINITY] {
            assert!(t.sample(u).index < 2);
        }
        assert_eq!(Alias::new(&[1.0, f64::NAN]), Err(WeightError::Invalid(1)));
        assert_eq!(Alias::new(&[]), Err(WeightError::Empty));
    }
}
