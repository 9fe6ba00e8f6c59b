//! Scenes in which words were deleted, doubled, swapped and exchanged: nothing crashes, and what is
//! told points into the text. The fuzzer's mutator does the damage.

use luxel_lang::Budgets;

use super::{load, told};

/// Small enough that a loop of many turns ends soon.
const STEPS: u64 = 20_000;

pub(crate) fn judge(bytes: &[u8]) -> bool {
    let loaded = load(bytes, Budgets { steps: STEPS, ..Budgets::default() });
    told::holds(&loaded);
    // What is no more like a scene teaches little.
    loaded.diagnostics.len() < 10
}
