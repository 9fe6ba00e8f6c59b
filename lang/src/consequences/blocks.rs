//! Blocks that begin with another bracket than a brace: their lines have been read as values.

use luxel_core::diag::{Diagnostic, Fix, Grade, Sources, Span};

use super::line_of;

/// Takes out what is told of such lines, but for what is wrong with brackets, and offers a brace.
pub(super) fn sift(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    let mut blocks = vec![];
    for found in &mut *diagnostics {
        if let Some((open, lines)) = block(found, sources) {
            let brace = Fix { span: open, replacement: "{".into(), grade: Grade::Guess };
            found.fixes = vec![brace];
            blocks.push(lines);
        }
    }
    let is_of_bracket = |found: &Diagnostic| matches!(found.code, "E0008" | "E0009" | "E0010");
    let is_in = |at: Span, block: &Span| {
        block.source == at.source && block.start <= at.start && at.end <= block.end
    };
    diagnostics.retain(|found| {
        let at = found.span().filter(|_| !is_of_bracket(found));
        at.is_none_or(|at| !blocks.iter().any(|block| is_in(at, block)))
    });
}

/// The bracket of such a block, `group (` where a brace closes it further down, and its lines with the word before
/// the bracket. What a call takes, or a vector, may stand on lines of its own too: `look_at(`, `at = (`.
fn block(found: &Diagnostic, sources: &Sources) -> Option<(Span, Span)> {
    let at = found.span().filter(|_| found.code == "E0009")?;
    let open = found.labels.get(1)?.span;
    let text = sources.text(at.source);
    let lines = text.get(open.range().end..at.range().start)?;
    let is_one = text.get(open.range()) == Some("(") && text.get(at.range()) == Some("}");
    let head = text.get(line_of(open, sources)..open.range().start)?;
    let word = head.trim_end();
    let ends_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '"' | ')' | ']');
    let is_apart = word.len() < head.len() && word.ends_with(ends_word);
    let is_block = is_one && is_apart && lines.trim_start_matches(' ').starts_with('\n');
    let start = line_of(open, sources) + word.rfind(' ').map_or(0, |gap| gap + 1);
    is_block.then(|| (open, Span::new(at.source, start, at.range().end)))
}
