//! What was found, for people.

use std::fmt::Write;

use super::estimate::{Estimate, Number};
use super::outcome::Outcome;
use super::verify::{Verdict, Verified, WITHIN};
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

/// `-12.5 % ± 0.03`
pub(super) fn signed(number: Number) -> String {
    let sign = if number.value < 0.0 { '-' } else { '+' };
    format!("{sign}{}", with_error(Number { value: number.value.abs(), ..number }))
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
    let Verified { samples, seen_at: [least, most], pictures, rmse, seconds } = verified;
    let off = verified.off(target);
    let [low, high] = verified.bounds(target).map(|bound| bound * 100.0);
    let word = match verified.verdict(target) {
        Verdict::Near => "within 10 %".to_owned(),
        Verdict::Better => "better than asked".to_owned(),
        Verdict::Missed => "MISSED".to_owned(),
        Verdict::Unsure => {
            format!("not certain, from {low:+.1} % to {high:+.1} % by {WITHIN} of them")
        }
    };
    let at = if least == most { format!("{least}") } else { format!("{least} to {most}") };
    format!(
        "verified by {pictures} pictures with fresh random numbers at {at} spp: {} at {samples} spp in {} \
         each, {:+.1} % ± {:.1} off the target of {}: {word}",
        with_error(*rmse),
        duration(*seconds),
        off.value * 100.0,
        off.error * 100.0,
        percent(target),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_miss_is_told_as_one() {
        let told = |value: f64, most: u32| {
            let rmse = Number { value, error: 0.0004 };
            let (pictures, seconds) = (24, 1.5);
            let seen_at = [200, most];
            verdict(&Verified { samples: 208, seen_at, pictures, rmse, seconds }, 0.02)
        };
        assert_eq!(
            told(0.0205, 208),
            "verified by 24 pictures with fresh random numbers at 200 to 208 spp: 2.05 % ± 0.04 at 208 spp \
             in 1.50 s each, +2.5 % ± 2.0 off the target of 2.00 %: within 10 %"
        );
        assert!(told(0.0205, 200).contains(" numbers at 200 spp: "));
        assert!(told(0.0230, 200).ends_with("+15.0 % ± 2.0 off the target of 2.00 %: MISSED"));
        assert!(
            told(0.0158, 200)
                .ends_with("-21.0 % ± 2.0 off the target of 2.00 %: better than asked")
        );
        let unsure = told(0.0215, 200);
        assert!(
            unsure.ends_with("%: not certain, from +3.5 % to +11.5 % by 2 of them"),
            "{unsure}"
        );
    }

    #[test]
    fn shares_have_three_digits() {
        assert_eq!([0.2134, 0.02134, 0.0002134].map(percent), ["21.3 %", "2.13 %", "0.0213 %"]);
    }
}
