//! Which configuration reaches an error soonest, and a render that shows that it does.

use super::estimate::{Estimate, Number, Reference};
use super::lab::{Lab, Shot};
use super::outcome::Outcome;
use crate::exit::Failure;
use luxel_core::stage::Stage;

/// A verified error may be off its target by this share.
pub(super) const NEAR: f64 = 0.1;
/// Renders that verify, each with the samples that the one before asks for.
const TRIES: usize = 3;
/// Pictures of such a render: two tell what scatters between them.
const PICTURES: usize = 2;
/// Standard errors by which another setting is to lead: of a dozen that are no better, the luckiest leads by
/// so many once in sixty studies.
const SURE: f64 = 3.0;
/// More samples are not tried.
const MOST: f64 = (1 << 24) as f64;

/// What is recommended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Choice {
    /// Index of the configuration.
    pub(super) of: usize,
    pub(super) samples: u32,
}

/// What a render with fresh random numbers showed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Verified {
    pub(super) choice: Choice,
    /// Relative error, root mean square.
    pub(super) rmse: Number,
    /// Of one picture.
    pub(super) seconds: f64,
}

impl Verified {
    pub(super) fn is_near(&self, target: f64) -> bool {
        (self.rmse.value / target - 1.0).abs() <= NEAR
    }

    /// Near, or better than was asked.
    pub(super) fn is_met(&self, target: f64) -> bool {
        self.rmse.value <= target || self.is_near(target)
    }
}

/// The fastest of those that reach the error at all; another than the scene as it is only where it is
/// sooner beyond noise.
pub(super) fn choose(outcomes: &[Outcome], target: f64) -> Option<Choice> {
    let candidate = |(of, outcome): (usize, &Outcome)| {
        let samples = outcome.samples_for(target).filter(|n| *n <= MOST)?;
        Some((outcome.work_for(target)?, Choice { of, samples: whole(samples) }))
    };
    let candidates: Vec<_> = outcomes.iter().enumerate().filter_map(candidate).collect();
    let base = candidates.iter().find(|(_, choice)| choice.of == 0).map(|(work, _)| *work);
    let is_sure = |(work, choice): &&(Number, Choice)| {
        choice.of == 0 || base.is_none_or(|base| is_sooner(*work, base))
    };
    let sure = candidates.iter().filter(is_sure);
    sure.min_by(|a, b| a.0.value.total_cmp(&b.0.value)).map(|(_, choice)| *choice)
}

/// Whether one time is less than another beyond what scatters; their errors are relative.
fn is_sooner(one: Number, other: Number) -> bool {
    (other.value / one.value).ln() > SURE * one.error.hypot(other.error)
}

/// Renders what is recommended, and corrects its samples where it missed.
///
/// # Errors
/// Ctrl-C; what rendering says.
pub(super) fn verify(
    choice: Choice,
    (outcome, stage): (&Outcome, &Stage),
    reference: &Reference,
    target: f64,
    lab: &mut Lab<'_>,
) -> Result<Verified, Failure> {
    let bias2 = outcome.best().estimate.known_bias2();
    let mut verified = shown(choice, stage, reference, lab)?;
    for _ in 1..TRIES {
        let Some(fit) = outcome.fit.filter(|_| !verified.is_near(target)) else { break };
        let found = verified.rmse.value.powi(2) - bias2;
        let n = f64::from(verified.choice.samples);
        let samples = fit.corrected(n, found, target * target - bias2).ceil();
        if found <= 0.0 || samples > MOST {
            break;
        }
        let choice = Choice { samples: whole(samples.max(1.0)), ..choice };
        if choice == verified.choice {
            break;
        }
        verified = shown(choice, stage, reference, lab)?;
    }
    Ok(verified)
}

fn shown(
    choice: Choice,
    stage: &Stage,
    reference: &Reference,
    lab: &mut Lab<'_>,
) -> Result<Verified, Failure> {
    let shots = (0..PICTURES).map(|_| lab.shot(stage, choice.samples));
    let shots = shots.collect::<Result<Vec<Shot>, _>>()?;
    let pictures: Vec<&[f32]> = shots.iter().map(|shot| &*shot.picture).collect();
    let total = Estimate::of(&pictures, reference).total;
    let seconds = shots.iter().map(|shot| shot.seconds).sum::<f64>() / PICTURES as f64;
    Ok(Verified { choice, rmse: total.root(), seconds })
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 1 to MOST")]
fn whole(samples: f64) -> u32 {
    samples as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_setting_leads_by_more_than_noise() {
        let work = |value, error| Number { value, error };
        // ln 2 = 0.69 is 3 times 0.23.
        assert!(is_sooner(work(1.0, 0.16), work(2.0, 0.16)));
        assert!(!is_sooner(work(1.0, 0.17), work(2.0, 0.17)));
        assert!(
            !is_sooner(work(2.0, 0.0), work(2.0, 0.0))
                && !is_sooner(work(3.0, 0.1), work(2.0, 0.1))
        );
    }
}
