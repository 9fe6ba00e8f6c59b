//! Which configuration reaches an error soonest, and pictures that show that it does.

use super::estimate::{Number, Reference};
use super::lab::{Lab, Shot};
use super::outcome::Outcome;
use super::verify::{Asked, Verified, Witness};
use crate::exit::Failure;
use luxel_core::stage::Stage;

/// Standard errors by which another setting is to lead: of a dozen that are no better, the luckiest leads by
/// so many once in sixty studies.
const SURE: f64 = 3.0;
/// More samples are not tried.
pub(super) const MOST: f64 = (1 << 24) as f64;

/// What is recommended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Choice {
    /// Index of the configuration.
    pub(super) of: usize,
    pub(super) samples: u32,
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

/// Renders what is recommended with fresh random numbers, in `left` seconds if time is short; nothing if that
/// is too little for two pictures.
///
/// # Errors
/// Ctrl-C before two pictures; what rendering says.
pub(super) fn verify(
    choice: Choice,
    (outcome, stage): (&Outcome, &Stage),
    reference: &Reference,
    (target, left): (f64, Option<f64>),
    lab: &mut Lab<'_>,
) -> Result<Option<Verified>, Failure> {
    let asked = Asked {
        target,
        fit: outcome.fit,
        bias2: outcome.best().estimate.known_bias2(),
        common: reference.common_error(),
        cost: outcome.cost,
        left,
    };
    asked.verify(choice.samples, &mut |samples| {
        let Shot { picture, seconds, .. } = lab.shot(stage, samples)?;
        Ok(Witness { samples, squared: reference.squared_error(&picture), seconds })
    })
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
