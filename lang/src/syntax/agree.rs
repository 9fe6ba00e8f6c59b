//! Whether both readers make the same of a text.

use luxel_core::diag::SourceId;

use super::direct::{self, Words};
use super::parse::{cut, read_as, read_head};
use crate::budgets::Budgets;

/// How many statements of a text were read by which reader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Agreement {
    /// Read straight from the bytes; pest makes the same of them.
    pub direct: usize,
    /// Left to pest, which has something to tell of them.
    pub told: usize,
    /// Left to pest, although it reads them and tells nothing.
    pub missed: usize,
}

/// Reads each statement of a text in both ways: by `scene.pest`, the grammar of record, and straight
/// from its bytes. For tests and fuzzing.
///
/// # Errors
/// The first statement of which the readers make different things.
pub fn agree(text: &str, budgets: &Budgets) -> Result<Agreement, String> {
    let mut out = Agreement::default();
    let Some(from) = read_head(text, budgets).0 else { return Ok(out) };
    let mut words = Words::default();
    for piece in cut(text, from, budgets, &mut |_| false).pieces {
        if piece.faulty {
            continue;
        }
        let pest = read_as(None, text, piece.range.clone(), budgets);
        let both = read_as(Some(Words::default()), text, piece.range.clone(), budgets);
        // As text, for `==` takes 0 for -0.
        let (pest_told, both_told) = (format!("{pest:?}"), format!("{both:?}"));
        if pest_told != both_told {
            let piece = &text[piece.range];
            return Err(format!("{piece}\npest: {pest_told}\nboth: {both_told}"));
        }
        if !pest.1.is_empty() {
            out.told += 1;
        } else if direct::read(text, piece.range, SourceId(0), budgets, &mut words).is_some() {
            out.direct += 1;
        } else {
            out.missed += 1;
        }
    }
    Ok(out)
}
