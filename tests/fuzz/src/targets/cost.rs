//! What reading a text may cost.

use std::time::{Duration, Instant};

/// For each byte: the design's 10 ms per KiB, some twenty times what a scene takes, and four times
/// that in a build with checks: one for fuzzing counts branches too.
const PER_BYTE: Duration =
    Duration::from_nanos(if cfg!(debug_assertions) { 4 * 9766 } else { 9766 });
/// For any text.
const FLOOR: Duration = Duration::from_millis(50);
/// So often it is tried: a machine that is busy is not so each time.
const TRIES: usize = 5;

/// Runs, and runs again while it took longer than so many bytes of text may; gives the least time.
///
/// # Panics
/// If it took too long each time.
pub(crate) fn bounded(bytes: usize, run: impl Fn()) -> Duration {
    let limit = FLOOR + PER_BYTE * u32::try_from(bytes).unwrap_or(u32::MAX);
    let mut least = Duration::MAX;
    for _ in 0..TRIES {
        let start = Instant::now();
        run();
        least = least.min(start.elapsed());
        if least <= limit {
            return least;
        }
    }
    panic!("{bytes} bytes took {least:?} at least; {limit:?} are allowed");
}
