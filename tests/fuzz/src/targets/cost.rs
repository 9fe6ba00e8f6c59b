//! What reading a text may cost, measured against a text that has no mistake: so it holds on any
//! machine and in any build.

use std::time::{Duration, Instant};

use luxel_lang::{Budgets, parse_only};

/// So many times as long as a plain text of its length a text may take. That takes half a millisecond
/// for each KiB; the design allows ten.
const FACTOR: u32 = 20;
/// Any text may take so long: what is shorter tells nothing.
const FLOOR: Duration = Duration::from_millis(50);
/// So often it is tried: a machine that is busy is not so each time.
const TRIES: usize = 5;
const PLAIN: &str = "shape sphere { radius = 1 m, material = a }\n";

/// Runs, and runs again while it took longer than a text of so many bytes may; gives the least time.
///
/// # Panics
/// If it took too long each time.
pub(crate) fn bounded(bytes: usize, run: impl Fn()) -> Duration {
    let least = least(&run, FLOOR);
    if least > FLOOR {
        let plain = format!("scene 1\n{}", PLAIN.repeat(bytes.div_ceil(PLAIN.len())));
        let plain = self::least(&|| drop(parse_only(&plain, &Budgets::default())), Duration::ZERO);
        let limit = FLOOR + FACTOR * plain;
        assert!(least <= limit, "{bytes} bytes took {least:?}; {limit:?} are allowed");
    }
    least
}

/// The least time of several runs, or the first that is short enough.
fn least(run: &dyn Fn(), enough: Duration) -> Duration {
    let mut least = Duration::MAX;
    for _ in 0..TRIES {
        let start = Instant::now();
        run();
        least = least.min(start.elapsed());
        if least <= enough {
            break;
        }
    }
    least
}
