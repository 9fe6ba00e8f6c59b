//! What reading a text may cost, measured against other texts at the same time: so it holds on any
//! machine and in any build.

use std::time::Duration;

use luxel_lang::{Budgets, parse_only};
use rustix::time::{ClockId, clock_gettime};

/// So often each mistake that is told may have the text read again, and the text itself.
const LOOKS: u32 = 2;
/// So many times as long a look takes by the grammar of record, which mistakes are told from, as one
/// straight at the bytes (52 MB/s against 2).
const SLOWER: u32 = 30;
/// So many times as long a text may take that is four times as long: linear with room for a busy
/// machine, below the sixteen times of a quadratic.
const GROWTH: u32 = 10;
/// Any text may take so long: what is shorter tells nothing in a build that counts branches, beside others.
const FLOOR: Duration = Duration::from_millis(250);
/// So often it is tried: a machine that is busy is not so each time.
const TRIES: usize = 5;
const PLAIN: &str = "shape sphere { radius = 1 m, material = a }\n";

/// Holds the time that a text takes against that of a plain one of its length.
///
/// # Panics
/// If it took too long each time.
pub(crate) fn bounded(text: &str, budgets: &Budgets) {
    if time(text, budgets) > FLOOR {
        let plain = format!("scene 1\n{}", PLAIN.repeat(text.len().div_ceil(PLAIN.len())));
        let [plain, took] = least([&plain, text], budgets);
        let mistakes = u32::try_from(budgets.diagnostics).unwrap_or(u32::MAX);
        let limit = FLOOR + plain * SLOWER * LOOKS * (1 + mistakes);
        assert!(took <= limit, "{} bytes took {took:?}; {limit:?} are allowed", text.len());
    }
}

/// Holds the time that a text takes against that of one a quarter as long.
///
/// # Panics
/// If it took too many times as long each time.
pub(crate) fn linear(quarter: &str, text: &str, budgets: &Budgets) {
    if time(text, budgets) > FLOOR {
        let [quarter, took] = least([quarter, text], budgets);
        let limit = FLOOR.max(quarter * GROWTH);
        assert!(took <= limit, "{} bytes took {took:?}, a quarter {quarter:?}", text.len());
    }
}

fn time(text: &str, budgets: &Budgets) -> Duration {
    let start = spent();
    parse_only(text, budgets);
    spent().saturating_sub(start)
}

/// What this thread has had of a processor, on which texts as short as these are read: a busy machine lets
/// it wait, and what waits longer waits more often.
fn spent() -> Duration {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    let whole = |n: i64| u64::try_from(n).unwrap_or_default();
    Duration::from_secs(whole(time.tv_sec)) + Duration::from_nanos(whole(time.tv_nsec))
}

/// The least times of several turns, in which both are read.
fn least(texts: [&str; 2], budgets: &Budgets) -> [Duration; 2] {
    let mut out = [Duration::MAX; 2];
    for _ in 0..TRIES {
        for (least, text) in out.iter_mut().zip(texts) {
            *least = time(text, budgets).min(*least);
        }
    }
    out
}
