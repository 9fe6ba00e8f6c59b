//! Mistakes that stand so near to one another that they are one.

use luxel_core::diag::{Diagnostic, Grade, Sources, Span};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::Unit;

use crate::syntax::tokens;

/// Tokens that stand between two mistakes of one slip at most.
const TOKENS: usize = 2;
/// Bytes between two mistakes that are looked at.
const BYTES: usize = 200;

/// What is told where something cannot be read.
const UNREAD: [&str; 9] =
    ["E0009", "E0010", "E0012", "E0013", "E0014", "E0015", "E0016", "E0017", "E0023"];

/// Takes out what is told next to something that cannot be read, unless how that is mended is sure; of two
/// such beside one another, the second. A sure mend beside which something else cannot be read is none.
pub(super) fn sift(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    let errors = diagnostics.iter().enumerate().filter(|(_, found)| found.is_error());
    let mut all: Vec<(Span, usize)> =
        errors.filter_map(|(i, found)| Some((found.span()?, i))).collect();
    all.sort_unstable();
    let mut is_out = vec![false; diagnostics.len()];
    let mut unsure = vec![];
    for pair in all.windows(2) {
        let [(before, i), (span, j)] = pair else { continue };
        let Some(n) = tokens_between(*before, *span, sources) else { continue };
        let (first, second) = (&diagnostics[*i], &diagnostics[*j]);
        if is_unread(first) && is_unread(second) {
            let text = sources.text(span.source).get(before.range().end..span.range().start);
            let is_line = text.is_none_or(|between| !between.contains('\n'));
            if second.sure().is_none() || first.sure().is_none() && is_line {
                is_out[*j] = true;
                unsure.push(*i);
            }
        } else if follows(second, first, n, sources) {
            is_out[*j] = true;
        } else if follows(first, second, n, sources) {
            is_out[*i] = true;
        }
    }
    for i in unsure {
        diagnostics[i].fixes.iter_mut().for_each(|fix| fix.grade = Grade::Guess);
    }
    let mut is_out = is_out.into_iter();
    diagnostics.retain(|_| !is_out.next().unwrap_or_default());
}

/// Whether something cannot be read where it is told, and not far away.
pub(super) fn is_unread(found: &Diagnostic) -> bool {
    found.is_error() && UNREAD.contains(&found.code)
}

/// Whether something is said only because of something else, so many tokens away.
fn follows(found: &Diagnostic, cause: &Diagnostic, n: usize, sources: &Sources) -> bool {
    let word = || found.span().and_then(|at| sources.text(at.source).get(at.range()));
    let is_unit = || word().is_some_and(|word| Unit::named(word).is_some());
    let is_category = || word().is_some_and(|word| Kind::of_word(word).is_some());
    let is_unsure = found.sure().is_none() && cause.sure().is_none();
    match (found.code, cause.code) {
        // A unit's own name is unknown only because the rest of it is.
        ("E0101", "E0101" | "E0204" | "E0014" | "E0016" | "E0023") if is_unit() => true,
        // `radius = 6 material m = gold`
        ("E0402", "E0204") => n == 0 && is_unit(),
        // What begins with a name that nothing stands for.
        ("E0114", "E0014" | "E0214") => n == 0,
        ("E0101", "E0023") if is_category() => true,
        ("E0101", "E0012" | "E0013" | "E0014" | "E0015" | "E0016" | "E0017" | "E0023") => {
            n == 0 && is_unsure
        }
        ("E0401", "E0023") => is_unsure,
        (code, "E0012" | "E0013" | "E0014" | "E0015" | "E0016" | "E0017" | "E0023") => {
            is_unsure && ["E01", "E02", "E04"].iter().any(|group| code.starts_with(group))
        }
        _ => false,
    }
}

/// How many tokens stand between two places, of which the first begins first; `None` if more than a few.
fn tokens_between(a: Span, b: Span, sources: &Sources) -> Option<usize> {
    if a.source != b.source {
        return None;
    }
    if b.start <= a.end {
        return Some(0);
    }
    let between = a.range().end..b.range().start;
    let is_short = between.len() <= BYTES;
    let n = is_short.then(|| tokens(sources.text(a.source), between).take(TOKENS + 1).count());
    n.filter(|n| *n <= TOKENS)
}
