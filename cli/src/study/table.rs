//! What was found, for people.

use std::fmt::Write;

use super::choose::Verified;
use super::estimate::{Estimate, Number};
use super::outcome::Outcome;
use crate::progress::duration;

/// What the columns are.
const HEAD: [&str; 7] = ["configuration", "error", "slope", "bias", "time", "efficiency", "needs"];

/// The table, with a line that says what the columns are.
pub(super) fn table(outcomes: &[Outcome], target: f64, seeds: usize) -> String {
    let Some(base) = outcomes.first() else { return String::new() };
    let mut rows = vec![HEAD.map(str::to_owned)];
    rows.extend(outcomes.iter().map(|outcome| row(outcome, base, target)));
    let width = |i: usize| rows.iter().map(|row| row[i].chars().count()).max().unwrap_or(0);
    let widths: [usize; 7] = std::array::from_fn(width);
    let mut out = String::new();
    for row in &rows {
        let mut line = String::new();
        for (cell, width) in row.iter().zip(widths) {
            let _ = write!(line, "{cell:width$}  ");
        }
        let _ = writeln!(out, "{}", line.trim_end());
    }
    let _ = writeln!(
        out,
        "error: relative, root mean square, at {} spp, of {seeds} seeds; slope: of log error over log \
         spp; time and\nefficiency: against the scene as it is; needs: for {}",
        base.best().spp,
        percent(target),
    );
    out
}

fn row(outcome: &Outcome, base: &Outcome, target: f64) -> [String; 7] {
    let estimate = &outcome.best().estimate;
    let error = Number { value: estimate.rmse(), error: estimate.variance.root().error };
    let slope = outcome.fit.map_or("–".to_owned(), |fit| {
        let Number { value, error } = fit.measured;
        format!("{:+.2} ± {:.2}", -value / 2.0, error / 2.0)
    });
    let efficiency = match outcome.fit {
        Some(_) if !estimate.is_biased() => format!("{:.2}", outcome.efficiency(base)),
        _ => "–".to_owned(),
    };
    let needs = outcome.samples_for(target).map_or("never: bias".to_owned(), |samples| {
        format!("{samples} spp, {}", duration(samples * outcome.cost))
    });
    let [low, median, high] = outcome.slower;
    let time = format!("{median:.2} ({low:.2}–{high:.2})");
    [outcome.name.clone(), with_error(error), slope, bias(estimate), time, efficiency, needs]
}

/// The bias, or what could not have been seen of it.
pub(super) fn bias(estimate: &Estimate) -> String {
    if estimate.is_biased() {
        with_error(estimate.bias2.root())
    } else {
        format!("none > {}", percent(estimate.unseen()))
    }
}

/// What leaving a feature out adds to the error, and what it saves of the time.
pub(super) fn dropped(outcome: &Outcome) -> String {
    let Outcome { name, slower: [_, median, _], .. } = outcome;
    let estimate = &outcome.best().estimate;
    let time = match 1.0 - median {
        saved if saved >= 0.0 => format!("saves {} of the time", percent(saved)),
        lost => format!("takes {} longer", percent(-lost)),
    };
    match bias(estimate) {
        added if estimate.is_biased() => format!("{name} adds an error of {added} and {time}"),
        unseen => format!("{name} adds no error that is seen ({unseen}) and {time}"),
    }
}

/// `2.13 % ± 0.02`
fn with_error(Number { value, error }: Number) -> String {
    format!("{} ± {:.2}", percent(value), error * 100.0)
}

/// Three digits.
pub(super) fn percent(share: f64) -> String {
    let percent = share * 100.0;
    match percent {
        _ if percent >= 10.0 => format!("{percent:.1} %"),
        _ if percent >= 0.1 => format!("{percent:.2} %"),
        _ => format!("{percent:.4} %"),
    }
}

/// Whether the recommended settings keep what they promise.
pub(super) fn verdict(verified: &Verified, target: f64) -> String {
    let Verified { choice, rmse, seconds } = verified;
    let off = (rmse.value / target - 1.0) * 100.0;
    let word = match verified.is_near(target) {
        true => "within 10 %",
        false if verified.is_met(target) => "better than asked",
        false => "MISSED",
    };
    format!(
        "verified by a render with fresh random numbers: {} at {} spp in {}, {off:+.1} % off the target \
         of {}: {word}",
        with_error(*rmse),
        choice.samples,
        duration(*seconds),
        percent(target),
    )
}

#[cfg(test)]
mod tests {
    use super::super::choose::Choice;
    use super::*;

    #[test]
    fn a_miss_is_told_as_one() {
        let told = |value: f64| {
            let choice = Choice { of: 0, samples: 208 };
            let rmse = Number { value, error: 0.0004 };
            verdict(&Verified { choice, rmse, seconds: 1.5 }, 0.02)
        };
        assert_eq!(
            told(0.0205),
            "verified by a render with fresh random numbers: 2.05 % ± 0.04 at 208 spp in 1.50 s, +2.5 % \
             off the target of 2.00 %: within 10 %"
        );
        assert!(told(0.0225).ends_with("+12.5 % off the target of 2.00 %: MISSED"));
        assert!(told(0.0158).ends_with("-21.0 % off the target of 2.00 %: better than asked"));
    }

    #[test]
    fn shares_have_three_digits() {
        assert_eq!([0.2134, 0.02134, 0.0002134].map(percent), ["21.3 %", "2.13 %", "0.0213 %"]);
    }
}
