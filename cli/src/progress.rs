//! A line on the terminal while something long runs: of a render the rate, samples, share done and
//! time left; of other work the step.

use std::io::IsTerminal;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::{Duration, Instant};

use luxel_core::accel::Standing;

use crate::report;

/// Between two redraws.
const PERIOD: Duration = Duration::from_millis(100);

/// Runs `work` while a line is shown, which may depend on the seconds since the beginning, until it is
/// empty. No line is shown unless standard error is a terminal and `shown` is true.
pub(crate) fn shown_while<T>(
    line: impl Fn(f64) -> String + Send,
    shown: bool,
    work: impl FnOnce() -> T,
) -> T {
    if !is_shown(shown) {
        return work();
    }
    // The sender is dropped when the work ends, also by a panic; that ends the thread.
    let (end, ended) = mpsc::channel::<()>();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            let start = Instant::now();
            while ended.recv_timeout(PERIOD) == Err(RecvTimeoutError::Timeout) {
                let line = line(start.elapsed().as_secs_f64());
                if line.is_empty() {
                    return;
                }
                report::progress(&line);
            }
            report::progress("");
        });
        let _end = end;
        work()
    })
}

/// A line that tells which of some steps is being taken; wiped when dropped, also by a panic. No line
/// is shown unless standard error is a terminal.
pub(crate) struct Steps {
    start: Instant,
    shown: bool,
}

impl Steps {
    pub(crate) fn new() -> Self {
        Self { start: Instant::now(), shown: std::io::stderr().is_terminal() }
    }

    /// No line is shown.
    pub(crate) fn hidden() -> Self {
        Self { start: Instant::now(), shown: false }
    }

    /// The step after `done` of `total` begins.
    pub(crate) fn next(&self, done: usize, total: usize, what: &str) {
        if self.shown {
            report::progress(&step(done, total, what, self.seconds()));
        }
    }

    /// Since the first.
    pub(crate) fn seconds(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}

impl Drop for Steps {
    fn drop(&mut self) {
        if self.shown {
            report::progress("");
        }
    }
}

/// `3 of 12  filter gaussian  4.50 s left`, if the others take as long as those before.
fn step(done: usize, total: usize, what: &str, seconds: f64) -> String {
    let left = match done {
        0 => "…".into(),
        _ => duration(seconds / done as f64 * (total - done.min(total)) as f64),
    };
    format!("{} of {total}  {what}  {left} left", done + 1)
}

/// `building big.ply: 3.1 M of 7.0 M triangles`
pub(crate) fn building(standing: &Standing) -> String {
    let Standing { what, unit, done, total } = standing;
    match total {
        0 if what.is_empty() => "building the scene".to_owned(),
        0 => format!("building {what}"),
        _ => format!("building {what}: {} of {} {unit}", count(*done), count(*total)),
    }
}

/// `999`, `7.5 k`, `3.1 M`
fn count(n: u64) -> String {
    match n {
        0..1000 => n.to_string(),
        1000..1_000_000 => format!("{:.1} k", n as f64 / 1e3),
        _ => format!("{:.1} M", n as f64 / 1e6),
    }
}

/// Whether a line that is wanted has somebody who reads it.
pub(crate) fn is_shown(wanted: bool) -> bool {
    wanted && std::io::stderr().is_terminal()
}

/// ` 42 %  3.20 Msamples/s  110.1 of 262.1 Msamples  ±1.3 %  48 s left`; the error, if it is known, is
/// the median of pixels' relative standard errors. Where a time was given, that is what is left of it.
pub(crate) fn line(
    (done, total): (u64, u64),
    error: Option<f64>,
    (seconds, time): (f64, Option<f64>),
) -> String {
    let share = if total == 0 { 1.0 } else { done as f64 / total as f64 };
    let rate = done as f64 / seconds.max(f64::MIN_POSITIVE);
    let by_rate = (done > 0).then(|| (total - done.min(total)) as f64 / rate);
    let by_time = time.map(|time| (time - seconds).max(0.0));
    let left = match (by_rate, by_time) {
        (Some(a), Some(b)) => duration(a.min(b)),
        (Some(left), None) | (None, Some(left)) => duration(left),
        (None, None) => "…".into(),
    };
    let share = time.map_or(share, |time| share.max(seconds / time));
    let of = if by_time < by_rate && time.is_some() {
        String::new()
    } else {
        format!(" of {:.1}", total as f64 / 1e6)
    };
    let error = error.map_or_else(String::new, |error| format!("  ±{:.2} %", error * 100.0));
    format!(
        "{:3.0} %  {:.2} Msamples/s  {:.1}{of} Msamples{error}  {left} left",
        (share * 100.0).min(100.0),
        rate / 1e6,
        done as f64 / 1e6,
    )
}

/// A length of time for people: `0.42 s`, `48 s`, `3 min 05 s`, `2 h 11 min`.
#[expect(clippy::cast_possible_truncation, reason = "beyond 2^64 s the number stays at 2^64")]
#[expect(clippy::cast_sign_loss, reason = "a negative length counts as none")]
pub(crate) fn duration(seconds: f64) -> String {
    let whole = seconds.round() as u64;
    match whole {
        _ if seconds < 10.0 => format!("{seconds:.2} s"),
        0..60 => format!("{whole} s"),
        60..3600 => format!("{} min {:02} s", whole / 60, whole % 60),
        _ => format!("{} h {:02} min", whole / 3600, whole / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_tells_rate_share_error_and_time_left() {
        let told = line((1_000_000, 4_000_000), Some(0.0131), (2.0, None));
        assert_eq!(told, " 25 %  0.50 Msamples/s  1.0 of 4.0 Msamples  ±1.31 %  6.00 s left");
        assert!(line((0, 10), None, (0.0, None)).contains("Msamples  … left"));
        assert!(line((11, 10), None, (1.0, None)).starts_with("100 %"));
        // Of 5 s two are over; the samples would take six more.
        let told = line((1_000_000, 4_000_000), None, (2.0, Some(5.0)));
        assert_eq!(told, " 40 %  0.50 Msamples/s  1.0 Msamples  3.00 s left");
    }

    #[test]
    fn a_build_tells_what_is_built_and_how_far_it_is() {
        let mut standing = Standing {
            what: "big.ply".to_owned(),
            unit: "triangles",
            done: 3_140_000,
            total: 7_000_000,
        };
        assert_eq!(building(&standing), "building big.ply: 3.1 M of 7.0 M triangles");
        (standing.done, standing.total) = (12, 7500);
        assert_eq!(building(&standing), "building big.ply: 12 of 7.5 k triangles");
        standing.total = 0;
        assert_eq!(building(&standing), "building big.ply");
        assert_eq!(building(&Standing::default()), "building the scene");
    }

    #[test]
    fn a_step_tells_its_number_and_the_time_left() {
        assert_eq!(step(0, 3, "filter box", 0.1), "1 of 3  filter box  … left");
        assert_eq!(step(2, 3, "filter box", 3.0), "3 of 3  filter box  1.50 s left");
    }

    #[test]
    fn durations_are_short_and_never_lose_a_minute() {
        let told = [0.4249, 48.3, 59.7, 185.0, 7865.0].map(duration);
        assert_eq!(told, ["0.42 s", "48 s", "1 min 00 s", "3 min 05 s", "2 h 11 min"]);
    }
}
