//! What reading a text may cost, measured against a text that has no mistake: so it holds on any
//! machine and in any build.

use std::time::{Duration, Instant};

use luxel_lang::{Budgets, parse_only};

/// So often each mistake that is told may have the text read again, and the text itself.
const LOOKS: u32 = 2;
/// Any text may take so long: what is shorter tells nothing.
const FLOOR: Duration = Duration::from_millis(50);
/// So often it is tried: a machine that is busy is not so each time.
const TRIES: usize = 5;
const PLAIN: &str = "shape sphere { radius = 1 m, material = a }\n";

/// Reads a text, and again while that took longer than it may; gives the least time.
///
/// # Panics
/// If it took too long each time.
pub(crate) fn bounded(text: &str, budgets: &Budgets) -> Duration {
    let read = |text: &str| drop(parse_only(text, budgets));
    let took = least(&|| read(text), FLOOR);
    if took > FLOOR {
        let plain = format!("scene 1\n{}", PLAIN.repeat(text.len().div_ceil(PLAIN.len())));
        let plain = least(&|| read(&plain), Duration::ZERO);
        let mistakes = u32::try_from(budgets.diagnostics).unwrap_or(u32::MAX);
        let limit = FLOOR + plain * LOOKS * (1 + mistakes);
        assert!(took <= limit, "{} bytes took {took:?}; {limit:?} are allowed", text.len());
    }
    took
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
