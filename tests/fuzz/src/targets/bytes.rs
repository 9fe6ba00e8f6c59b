//! Any bytes are read: without a panic, in bounded time, on a small stack.

use luxel_lang::Budgets;

use super::{cost, load, on_stack, told};

/// The stack on which a text is read, bytes.
const READING: usize = 512 << 10;
/// The stack on which a scene is loaded, bytes: as much as `load` promises to do with.
const LOADING: usize = 2 << 20;
/// Steps of evaluation, so that loops end soon.
const STEPS: u64 = 100_000;

pub(crate) fn judge(bytes: &[u8]) -> bool {
    let text = String::from_utf8_lossy(bytes);
    on_stack(READING, || cost::bounded(&text, &Budgets::default()));
    let budgets = Budgets { steps: STEPS, ..Budgets::default() };
    told::holds(&on_stack(LOADING, || load(bytes, budgets)));
    true
}
