//! Each statement read straight from its bytes is what the grammar of record makes of it, within large
//! budgets and small ones.

use luxel_lang::{Budgets, agree};

pub(crate) fn judge(bytes: &[u8]) -> bool {
    let Ok(text) = str::from_utf8(bytes) else { return false };
    let large = Budgets::default();
    let small = Budgets { brackets: 8, operators: 8, string: 32, pieces: 64, ..large };
    let found = [large, small]
        .map(|budgets| agree(text, &budgets).unwrap_or_else(|why| panic!("{why}\n{text}")));
    found[0].direct > 0
}
