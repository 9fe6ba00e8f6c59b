//! Numbers that look random, for tests: the same in every run.

/// The next number below a bound.
pub(crate) fn next(state: &mut u64, below: usize) -> usize {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    usize::try_from(*state >> 33).unwrap() % below.max(1)
}
