//! What chance allows: significance over many tests, and the statistics that are held against it.
//!
//! Every statistic is turned into `z`, standard deviations of a normal variable, so that one limit
//! serves all.

use luxel_sdk::num::Moments;

/// Probability with which a whole run of correct plugins fails by chance.
pub const SIGNIFICANCE: f64 = 1e-6;

/// Least expectation of a group of cells: Pearson's statistic is then near chi-square far out in
/// its tail.
const MIN_EXPECTED: f64 = 20.0;

/// The limit of `z` for one of `n` independent one-sided tests that together fail by chance with
/// the probability [`SIGNIFICANCE`] (Šidák 1967). Grows with `n`; at least one test is assumed.
pub(crate) fn limit(n: u64) -> f64 {
    // 1 − (1 − p)^(1/n), without cancelling.
    let alpha = -((-SIGNIFICANCE).ln_1p() / n.max(1) as f64).exp_m1();
    let (mut low, mut high) = (2.0, 40.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if upper_tail(middle) > alpha {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// Probability that a normal variable exceeds `z` ≥ 2: the continued fraction of Mills' ratio,
/// good to 1e-9 there.
fn upper_tail(z: f64) -> f64 {
    let fraction = (1..60).rev().fold(z, |rest, i| z + f64::from(i) / rest);
    (-0.5 * z * z).exp() / (std::f64::consts::TAU.sqrt() * fraction)
}

/// What a group of cells expects and holds.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Tally {
    /// Expected number of samples.
    pub(crate) expected: f64,
    /// Bound of the error of `expected`.
    pub(crate) error: f64,
    /// Number found.
    pub(crate) found: f64,
}

/// `z` of Pearson's chi-square statistic over cells, which are joined in their order until each
/// group expects enough. Errors of the expectation are forgiven.
///
/// # Source
/// Wilson & Hilferty 1931: the cube root of chi-square over its degrees of freedom is nearly normal.
pub(crate) fn chi_square(cells: impl IntoIterator<Item = Tally>) -> f64 {
    let (mut statistic, mut groups) = (0.0, 0.0);
    let mut group = Tally::default();
    for cell in cells {
        group.expected += cell.expected;
        group.error += cell.error;
        group.found += cell.found;
        if group.expected >= MIN_EXPECTED {
            statistic += excess(group).powi(2) / group.expected;
            groups += 1.0;
            group = Tally::default();
        }
    }
    // The rest expects less than the least: as if it expected that much.
    if group.found > 0.0 || group.expected > 0.0 {
        statistic += excess(group).powi(2) / MIN_EXPECTED;
        groups += 1.0;
    }
    if groups < 1.0 {
        return 0.0;
    }
    let spread = 2.0 / (9.0 * groups);
    ((statistic / groups).cbrt() - (1.0 - spread)) / spread.sqrt()
}

fn excess(group: Tally) -> f64 {
    ((group.found - group.expected).abs() - group.error).max(0.0)
}

/// `z` of a share `found` of `n` trials where `expected` is right to within `error`.
pub(crate) fn share(found: f64, expected: f64, error: f64, n: f64) -> f64 {
    let p = found.clamp(0.0, 1.0);
    // No less than one trial in n can be told.
    let variance = (p * (1.0 - p)).max(1.0 / n) / n;
    deviation(found - expected, error, variance.sqrt())
}

/// Standard error of a mean; no less than what one sample more or less would change.
pub(crate) fn mean_error(m: &Moments) -> f64 {
    m.standard_error().max(m.mean.abs() / m.n as f64)
}

/// `z` of a difference, `error` of it forgiven. No spread at all counts as none: exact results
/// must agree to within the error.
pub(crate) fn deviation(difference: f64, error: f64, sigma: f64) -> f64 {
    let off = difference.abs() - error;
    if off <= 0.0 { 0.0 } else { off / sigma }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_limit_is_the_normal_quantile() {
        // Tables: 1e-6 at 4.753424, 1e-10 at 6.361341.
        assert!((limit(1) - 4.753_424_3).abs() < 1e-4);
        assert!((limit(10_000) - 6.361_341).abs() < 1e-4);
    }

    #[test]
    fn fair_dice_pass_and_loaded_ones_do_not() {
        let mut rng = luxel_sdk::sampling::Rng::new(1);
        let mut dice = [0.0; 6];
        let n = 6000;
        for _ in 0..n {
            dice[rng.u32() as usize % 6] += 1.0;
        }
        let cells = |loaded: f64| {
            let [mut first, rest @ ..] =
                dice.map(|found| Tally { expected: f64::from(n) / 6.0, error: 0.0, found });
            first.found += loaded;
            std::iter::once(first).chain(rest)
        };
        assert!(chi_square(cells(0.0)) < limit(1));
        assert!(chi_square(cells(300.0)) > limit(1));
    }

    #[test]
    fn samples_where_none_are_expected_fail() {
        let cells = [
            Tally { expected: 1000.0, error: 0.0, found: 1000.0 },
            Tally { expected: 0.0, error: 0.0, found: 40.0 },
        ];
        assert!(chi_square(cells) > limit(1));
    }

    #[test]
    fn certainty_that_is_claimed_twice_is_seen() {
        assert!(share(1.0, 1.02, 1e-3, 20_000.0) > limit(1000));
        assert!(share(1.0, 1.0, 0.0, 20_000.0) <= 0.0);
        assert!(deviation(1e-9, 0.0, 0.0).is_infinite());
    }
}
