//! Texts that repeat themselves, one part in another or one after another: time stays linear.
//!
//! `~` parts what opens, what stands within, and what closes.

use std::time::Duration;

use luxel_lang::{Budgets, parse_only};

use super::cost;

/// So deep brackets may be, with room for those of one part.
const DEPTH: usize = 112;
/// Bytes of the longest text.
const LENGTH: usize = 12 << 10;
/// So many times as long a text may take that is four times as long: linear with room for a busy
/// machine, below the sixteen times of a quadratic.
const GROWTH: u32 = 10;
/// Below this, times tell nothing.
const FLOOR: Duration = Duration::from_millis(40);

pub(crate) fn judge(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let mut parts = text.splitn(3, '~').map(|part| part.get(..200).unwrap_or(part));
    let [open, middle, close] = [(); 3].map(|()| parts.next().unwrap_or_default());
    let most = LENGTH / (open.len() + close.len()).max(1);
    for n in [most.min(DEPTH), most] {
        let [short, long] = [n / 4, n].map(|n| {
            let text = format!("scene 1\n{}{middle}{}\n", open.repeat(n), close.repeat(n));
            cost::bounded(text.len(), || drop(parse_only(&text, &Budgets::default())))
        });
        assert!(long <= FLOOR.max(short * GROWTH), "{n} times: {long:?}, a quarter: {short:?}");
    }
    most >= 4
}
