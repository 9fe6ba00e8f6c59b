//! Where a function of one number vanishes.

/// The root of a function that is negative before it and positive after it, between `low` and
/// `high`: Newton's steps where they stay between and gain enough, else halves.
///
/// The function is asked with how far the root may be off, gives its derivative too, and may end the
/// search.
pub(super) fn rising_root(
    (mut low, mut high): (f64, f64),
    start: f64,
    mut f: impl FnMut(f64, f64) -> Option<(f64, f64)>,
) -> f64 {
    let mut s = start;
    let mut last = high - low;
    // Halving alone takes 60 from a whole range to a rounding.
    for _ in 0..128 {
        let Some((value, slope)) = f(s, (s - low).max(high - s)) else { break };
        if value == 0.0 {
            break;
        }
        if value > 0.0 {
            high = s;
        } else {
            low = s;
        }
        let newton = s - value / slope;
        let good = newton > low && newton < high && (newton - s).abs() < 0.75 * last;
        let next = if good { newton } else { 0.5 * (low + high) };
        last = (next - s).abs();
        s = next;
        if last <= 2.0 * f64::EPSILON {
            break;
        }
    }
    s
}
