//! Sampled directions against the density and the value that are claimed for them.

use glam::DVec3;
use luxel_sdk::num::Moments;
use luxel_sdk::sampling::Rng;

use crate::cells::{Cells, HEMISPHERE, Integral, Place, direction, integrate, place};
use crate::report::Judge;
use crate::statistics::{Tally, chi_square, deviation, mean_error, share};

/// A sampled direction and eval / pdf, one number of all lanes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Drawn {
    pub(crate) wi: DVec3,
    pub(crate) weight: f64,
}

/// What samples directions and claims a density and a value for each.
pub(crate) struct Lobes<'a> {
    /// `None` where nothing is sampled, or from a delta lobe, which has no density.
    pub(crate) sample: &'a dyn Fn([f32; 3]) -> Option<Drawn>,
    /// Density (sr⁻¹) and value (its integral is the mean weight) of a unit direction.
    pub(crate) eval: &'a dyn Fn(DVec3) -> [f64; 2],
}

/// The check that [`Found::dense`] is near 0, alone and on the average over many directions.
pub(crate) const SHARES: &str = "lobes get their shares";

/// What was found of one direction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found {
    /// ∫ pdf and ∫ value.
    pub(crate) total: Integral,
    /// By how many standard deviations the half of the density that is most dense has too many
    /// samples: where one lobe in a wider one is chosen too often, this sees it before chi-square
    /// does, which spreads it over all cells.
    pub(crate) dense: f64,
}

/// Evaluations for all cells of one direction.
const BUDGET: u32 = 250_000;

/// Samples of the first batch in a cell.
const PER_CELL: usize = 40;

/// What f32 rounds in a density, relative.
const ROUNDING: f64 = 2e-5;

/// The largest share of a mean that one sample may have, for the mean to be normal.
const LARGEST: f64 = 0.01;

impl Lobes<'_> {
    /// Chi-square of directions, ∫ pdf against the chance of a sample, ∫ value against the mean
    /// weight.
    ///
    /// Gives back both integrals, and how the samples are shared.
    pub(crate) fn judge(
        &self,
        judge: &mut Judge,
        rng: &mut Rng,
        n: u32,
        at: &dyn Fn() -> String,
    ) -> Found {
        let mut numbers = || {
            let [u, v] = rng.pair();
            [u, v, rng.f32()]
        };
        let training: Vec<Place> =
            (0..n / 2).filter_map(|_| Some(place((self.sample)(numbers())?.wi))).collect();
        let cells = Cells::new(2, &training, PER_CELL);
        let mut tallies = vec![Tally::default(); cells.leaves.len()];
        let (mut weights, mut largest, mut count) = (Moments::default(), 0.0f64, 0.0);
        for _ in 0..n {
            let drawn = (self.sample)(numbers());
            weights.push(drawn.map_or(0.0, |drawn| drawn.weight));
            if let Some(drawn) = drawn {
                largest = largest.max(drawn.weight);
                tallies[cells.leaf(place(drawn.wi))].found += 1.0;
                count += 1.0;
            }
        }
        let n = f64::from(n);
        let total = self.expect(&cells, &mut tallies, n);
        let dense = denser_half(&cells, &tallies, n);
        let z = chi_square(tallies);
        judge.statistic("samples follow their pdf", z, at);
        judge.statistic(SHARES, dense.abs(), at);
        let error = total.error[0] + ROUNDING * total.value[0];
        judge.statistic(
            "pdf integrates to P(sample)",
            share(count / n, total.value[0], error, n),
            || {
                format!(
                    "{}: ∫pdf = {:.6} ± {error:.1e}, P = {:.6}",
                    at(),
                    total.value[0],
                    count / n
                )
            },
        );
        let (mean, error) = (weights.mean, total.error[1] + ROUNDING * total.value[1].abs());
        if largest <= LARGEST * mean * n || largest <= 0.0 {
            let sigma = mean_error(&weights).max(total.value[1].abs() / n);
            let z = deviation(mean - total.value[1], error, sigma);
            judge.statistic("mean weight is the integral", z, || {
                format!("{}: ∫f = {:.6} ± {error:.1e}, mean = {mean:.6}", at(), total.value[1])
            });
        }
        Found { total, dense }
    }

    /// Integrates over every cell; the sums.
    fn expect(&self, cells: &Cells, tallies: &mut [Tally], n: f64) -> Integral {
        let f = |at: Place| (self.eval)(direction(at)).map(|x| x * HEMISPHERE);
        let mut total = Integral::default();
        let leaves = tallies.len();
        let mut budget = BUDGET;
        for (i, (cell, tally)) in cells.leaves.iter().zip(tallies).enumerate() {
            // What a cell leaves of its share, the next ones may use.
            let mut own = budget / u32::try_from(leaves - i).unwrap_or(u32::MAX) * 4;
            own = own.min(budget).max(200);
            let before = own;
            let part = integrate(&f, *cell, 2e-4 / leaves as f64, &mut own);
            budget = budget.saturating_sub(before - own);
            tally.expected = n * part.value[0];
            tally.error = n * part.error[0] + ROUNDING * tally.expected;
            for k in 0..2 {
                total.value[k] += part.value[k];
                total.error[k] += part.error[k];
            }
        }
        total
    }
}

/// `Found::dense` of `n` samples.
fn denser_half(cells: &Cells, tallies: &[Tally], n: f64) -> f64 {
    let density = |i: &usize| tallies[*i].expected / cells.leaves[*i].area();
    let mut order: Vec<usize> = (0..tallies.len()).collect();
    order.sort_by(|a, b| density(b).total_cmp(&density(a)));
    let half = 0.5 * tallies.iter().map(|tally| tally.expected).sum::<f64>();
    let mut sum = Tally::default();
    for tally in order.into_iter().map(|i| tallies[i]) {
        if sum.expected >= half {
            break;
        }
        sum.expected += tally.expected;
        sum.error += tally.error;
        sum.found += tally.found;
    }
    let p = sum.expected / n;
    let over = sum.found - sum.expected;
    // A single cell that holds everything has no halves.
    if p > 0.01 && p < 0.99 {
        deviation(over, sum.error, (n * p * (1.0 - p)).sqrt()).copysign(over)
    } else {
        0.0
    }
}
