//! Texts that repeat themselves, one part in another or one after another: time stays linear.
//!
//! `~` parts what opens, what stands within, and what closes.

use luxel_lang::Budgets;

use super::cost;

/// So deep brackets may be, with room for those of one part.
const DEPTH: usize = 112;
/// Bytes of the longest text.
const LENGTH: usize = 8 << 10;
/// Mistakes that are told: each may cost another look at all that follows, and so few are in the shorter
/// of two texts as well.
const MISTAKES: usize = 10;

pub(crate) fn judge(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    let mut parts = text.splitn(3, '~').map(|part| part.get(..200).unwrap_or(part));
    let [open, middle, close] = [(); 3].map(|()| parts.next().unwrap_or_default());
    let most = LENGTH / (open.len() + close.len()).max(1);
    let budgets = Budgets { diagnostics: MISTAKES, ..Budgets::default() };
    for n in [most.min(DEPTH), most] {
        let text = |n| format!("scene 1\n{}{middle}{}\n", open.repeat(n), close.repeat(n));
        cost::bounded(&text(n), &budgets);
        cost::linear(&text(n / 4), &text(n), &budgets);
    }
    most >= 4
}
