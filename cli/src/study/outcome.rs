//! What was found out about each configuration.

use super::estimate::{Estimate, Number, Reference};
use super::fit::Fit;
use super::lab::{Series, Shot};

/// Pictures with one number of samples.
pub(super) struct Point {
    pub(super) spp: u32,
    pub(super) estimate: Estimate,
    /// Of one picture, median.
    pub(super) seconds: f64,
    /// Whether nothing that was measured is better in both time and error.
    pub(super) is_on_front: bool,
}

/// One configuration.
pub(super) struct Outcome {
    pub(super) name: String,
    /// By number of samples.
    pub(super) points: Vec<Point>,
    pub(super) fit: Option<Fit>,
    /// Mean luminance of the pictures with the most samples.
    pub(super) mean: Number,
    /// Time for a sample of every pixel, seconds.
    pub(super) cost: f64,
    /// The same as a share of that of the scene as it is: lower quartile, median, upper quartile.
    pub(super) slower: [f64; 3],
    /// Rounds that this was measured in.
    rounds: usize,
    /// Samples that were not finite.
    pub(super) bad: u64,
}

impl Outcome {
    /// The most samples, which tell most.
    pub(super) fn best(&self) -> &Point {
        self.points.last().expect("a sweep has two numbers of samples at least")
    }

    /// One over variance and time, as a share of another's.
    pub(super) fn efficiency(&self, base: &Self) -> f64 {
        let work = |outcome: &Self, ratio: f64| outcome.best().estimate.variance.value * ratio;
        work(base, 1.0) / work(self, self.slower[1])
    }

    /// Time for a relative error, seconds, with its relative standard error; `None` as below.
    pub(super) fn work_for(&self, target: f64) -> Option<Number> {
        let samples = self.samples_for(target)?;
        let error =
            self.fit.map_or(0.0, |fit| fit.relative_error(samples)).hypot(self.cost_error());
        Some(Number { value: samples * self.cost, error })
    }

    /// Relative standard error of the cost, from its quartiles: those of normal noise are 1.349 standard
    /// deviations apart, and its median scatters 1.253 times as much as its mean.
    fn cost_error(&self) -> f64 {
        let [low, median, high] = self.slower;
        1.253 * (high - low) / 1.349 / median / (self.rounds as f64).sqrt()
    }

    /// Samples of each pixel for a relative error, whole; `None` where bias stands in the way.
    pub(super) fn samples_for(&self, target: f64) -> Option<f64> {
        let allowed = target * target - self.best().estimate.known_bias2();
        let needed = self.fit.map_or(1.0, |fit| fit.samples(allowed));
        (allowed > 0.0).then(|| needed.ceil().max(1.0))
    }
}

/// Everything, with the scene as it is first.
pub(super) fn outcomes(names: &[String], series: &Series, reference: &Reference) -> Vec<Outcome> {
    let base: Vec<f64> =
        series.shots.first().map(|shots| rates(shots, &series.spp)).unwrap_or_default();
    let one = |(name, shots): (&String, &Vec<Vec<Shot>>)| {
        let point = |(spp, shots): (&u32, &Vec<Shot>)| {
            let pictures: Vec<&[f32]> = shots.iter().map(|shot| &*shot.picture).collect();
            Point {
                spp: *spp,
                estimate: Estimate::of(&pictures, reference),
                seconds: quartiles(shots.iter().map(|shot| shot.seconds).collect())[1],
                is_on_front: false,
            }
        };
        let points: Vec<Point> = series.spp.iter().zip(shots).map(point).collect();
        let falling: Vec<(u32, Number)> =
            points.iter().map(|point| (point.spp, point.estimate.variance)).collect();
        // Of each round by itself: what slowed it slowed both.
        let slower = rates(shots, &series.spp).into_iter().zip(&base).map(|(own, base)| own / base);
        let slower = quartiles(slower.collect());
        let mean = |shot: &Shot| {
            shot.picture.iter().map(|y| f64::from(*y)).sum::<f64>() / shot.picture.len() as f64
        };
        Outcome {
            name: name.clone(),
            fit: Fit::of(&falling),
            mean: Number::of(shots.iter().rev().take(1).flatten().map(mean)),
            cost: slower[1] * quartiles(base.clone())[1],
            slower,
            rounds: shots.last().map_or(1, Vec::len),
            bad: shots.iter().flatten().map(|shot| shot.bad).sum(),
            points,
        }
    };
    let mut outcomes: Vec<Outcome> = names.iter().zip(&series.shots).map(one).collect();
    mark_front(&mut outcomes);
    outcomes
}

/// Seconds for a sample of every pixel, by round, at the largest number of samples.
fn rates(shots: &[Vec<Shot>], spp: &[u32]) -> Vec<f64> {
    let (Some(shots), Some(spp)) = (shots.last(), spp.last()) else { return vec![] };
    shots.iter().map(|shot| shot.seconds / f64::from(*spp)).collect()
}

/// Of at least one number.
pub(super) fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    let last = values.len() - 1;
    [1, 2, 3].map(|quarter| {
        let (at, rest) = (last * quarter / 4, (last * quarter % 4) as f64 / 4.0);
        values[at] + rest * (values[(at + 1).min(last)] - values[at])
    })
}

fn mark_front(outcomes: &mut [Outcome]) {
    let all: Vec<(f64, f64)> = outcomes.iter().flat_map(|o| &o.points).map(place).collect();
    for point in outcomes.iter_mut().flat_map(|outcome| &mut outcome.points) {
        let (seconds, error) = place(point);
        let better =
            |(s, e): &(f64, f64)| *s <= seconds && *e <= error && (*s < seconds || *e < error);
        point.is_on_front = !all.iter().any(better);
    }
}

fn place(point: &Point) -> (f64, f64) {
    (point.seconds, point.estimate.rmse())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_lie_between_values() {
        let told = |values: &[f64]| format!("{:?}", quartiles(values.to_vec()));
        assert_eq!(told(&[4.0, 1.0, 3.0, 2.0, 5.0]), "[2.0, 3.0, 4.0]");
        assert_eq!(told(&[1.0, 2.0]), "[1.25, 1.5, 1.75]");
        assert_eq!(told(&[7.0]), "[7.0, 7.0, 7.0]");
    }

    /// Two pixels whose values are `1 ± off`, twice the time for the second subject.
    #[test]
    fn efficiency_and_front_follow_variance_and_time() {
        let shots = |off: f32, seconds: f64| -> Vec<Vec<Shot>> {
            let shot = |sign: f32, share: f32| Shot {
                picture: vec![1.0 + sign * off * share, 1.0 - sign * off * share],
                seconds: seconds / f64::from(share * share),
                bad: 0,
            };
            vec![vec![shot(1.0, 1.0), shot(-1.0, 1.0)], vec![shot(1.0, 0.5), shot(-1.0, 0.5)]]
        };
        let series = Series {
            spp: vec![4, 16],
            shots: vec![shots(0.1, 1.0), shots(0.1, 2.0), shots(0.05, 2.0)],
            reference: vec![],
            seeds: 2,
            is_interrupted: false,
        };
        let names = ["base", "slow", "good"].map(str::to_owned);
        let reference = Reference::flat(1.0, 2).unwrap();
        let found = outcomes(&names, &series, &reference);
        let efficiency = |i: usize| found[i].efficiency(&found[0]);
        assert!((efficiency(1) - 0.5).abs() < 1e-5 && (efficiency(2) - 2.0).abs() < 1e-5);
        assert_eq!(format!("{:?}", found[1].slower), "[2.0, 2.0, 2.0]");
        let front = found.iter().flat_map(|o| &o.points).map(|point| point.is_on_front);
        assert_eq!(front.collect::<Vec<_>>(), [true, false, false, false, true, true]);
        // Variance 0.01·2 at 4 samples, of two pictures against each other.
        let needed = found[0].samples_for(0.02).unwrap();
        assert!((needed - 200.0).abs() <= 1.0, "{needed}");
    }
}
