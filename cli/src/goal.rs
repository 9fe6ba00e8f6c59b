//! Arguments that say how good a picture is to be.

use std::time::Duration;

use clap::Args;
use luxel_core::film::Confidence;
use luxel_core::render::Goal;

use crate::args::MOST_SECONDS;

/// Instead of a number of samples.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct GoalArgs {
    /// Go on until the standard error of every tile of 16 by 16 pixels is this small, as in 1%: root
    /// mean square over its pixels, relative to their luminance or to a tenth of the picture's mean.
    /// --spp is then the most samples of a pixel [default: 1048576]
    #[arg(long, value_name = "SHARE", value_parser = share, allow_hyphen_values = true)]
    error: Option<f64>,
    /// Make --error hold for the half width of intervals that hold the truth this often, as in 95%,
    /// instead of for one standard error: with 95% about 2.1 times as much is asked, and 4.4 times the
    /// samples [from 50% to 99.9%]
    #[arg(long, value_name = "SHARE", value_parser = confidence, requires = "error")]
    confidence: Option<Confidence>,
    /// Go on for this long, as in 30s or 5min; samples go where they lower the error most, or, with
    /// --error, where that is not yet reached. It counts from the first sample of this run: with
    /// --resume it is added to what was spent before
    #[arg(long, value_name = "DURATION", value_parser = duration, allow_hyphen_values = true)]
    time: Option<Duration>,
}

impl GoalArgs {
    pub(crate) fn goal(&self) -> Goal {
        let Self { error, confidence, time } = *self;
        Goal { error, confidence, time }
    }
}

/// `1%` or `0.01`.
pub(crate) fn share(text: &str) -> Result<f64, String> {
    // By the text, for 99.9 / 100 is a little more than 0.999.
    let number = text.strip_suffix('%').map(|number| format!("{}e-2", number.trim()));
    let found = number.as_deref().unwrap_or(text).trim().parse().ok();
    let found = found.filter(|x| (1e-6..=1.0).contains(x));
    found.ok_or_else(|| "expected a share from 0.0001% to 100%, as in 1% or 0.01".into())
}

/// `95%` or `0.95`.
fn confidence(text: &str) -> Result<Confidence, String> {
    let found = share(text).ok().and_then(Confidence::new);
    found.ok_or_else(|| "expected a share from 50% to 99.9%, as in 95% or 0.95".into())
}

/// `30s`, `5min`, `1.5h`, `500ms`; seconds without a unit.
pub(crate) fn duration(text: &str) -> Result<Duration, String> {
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let unit = match &text[digits.len()..] {
        "" | "s" => 1.0,
        "ms" => 1e-3,
        "min" => 60.0,
        "h" => 3600.0,
        _ => f64::NAN,
    };
    let seconds = digits.trim().parse().ok().map(|x: f64| x * unit);
    let found = seconds.filter(|s| (1e-3..=MOST_SECONDS).contains(s));
    let told =
        || "expected a length of time of a millisecond or more, as in 30s, 5min or 1.5h".into();
    found.map(Duration::from_secs_f64).ok_or_else(told)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_and_times_are_read_or_refused() {
        assert_eq!(share("1%"), Ok(0.01));
        assert_eq!(share("2.5 %"), Ok(0.025));
        assert_eq!(share("0.02"), Ok(0.02));
        for bad in ["", "%", "0", "-1%", "101%", "NaN", "one"] {
            assert!(share(bad).is_err(), "{bad}");
        }
        assert_eq!(confidence("95%"), Ok(Confidence::USUAL));
        for most in ["99.9%", "0.999"] {
            assert!(confidence(most).is_ok(), "{most}");
        }
        assert!(confidence("100%").is_err() && confidence("5%").is_err());
        assert_eq!(duration("30s"), Ok(Duration::from_secs(30)));
        assert_eq!(duration("1.5h"), Ok(Duration::from_secs(5400)));
        assert_eq!(duration("2min"), Ok(Duration::from_secs(120)));
        assert_eq!(duration("500ms"), Ok(Duration::from_millis(500)));
        assert_eq!(duration("7"), Ok(Duration::from_secs(7)));
        for bad in ["", "s", "0", "-3s", "3 weeks", "1e9h", "NaN"] {
            assert!(duration(bad).is_err(), "{bad}");
        }
    }
}
