//! Blocks that begin with another bracket than a brace: their lines have been read as values.

use luxel_core::diag::{Diagnostic, Fix, Grade, Sources, Span};

use super::line_of;

/// Takes out what is told of such lines, but for what is wrong with brackets, and offers a brace.
pub(super) fn sift(diagnostics: &mut Vec<Diagnostic>, sources: &Sources) {
    let blocks: Vec<Span> = diagnostics.iter().filter_map(|found| block(found, sources)).collect();
    let is_of_bracket = |found: &Diagnostic| matches!(found.code, "E0008" | "E0009" | "E0010");
    let is_in = |at: Span, block: &Span| {
        block.source == at.source && block.start <= at.start && at.end <= block.end
    };
    for found in &mut *diagnostics {
        if block(found, sources).is_some() {
            let open = found.labels.get(1).map(|open| open.span);
            let brace = |span| Fix { span, replacement: "{".into(), grade: Grade::Guess };
            found.fixes = open.map(brace).into_iter().collect();
        }
    }
    diagnostics.retain(|found| {
        let at = found.span().filter(|_| !is_of_bracket(found));
        at.is_none_or(|at| !blocks.iter().any(|block| is_in(at, block)))
    });
}

/// The lines of such a block, with the word before its bracket.
fn block(found: &Diagnostic, sources: &Sources) -> Option<Span> {
    let at = found.span().filter(|_| found.code == "E0009")?;
    let open = found.labels.get(1)?.span;
    let text = sources.text(at.source);
    let lines = text.get(open.range().end..at.range().start)?;
    let is_block =
        text.get(at.range()) == Some("}") && lines.trim_start_matches(' ').starts_with('\n');
    let before = text.get(line_of(open, sources)..open.range().start)?.trim_end();
    let word = before.rfind(' ').map_or(0, |gap| gap + 1);
    let start = line_of(open, sources) + word;
    is_block.then(|| Span::new(at.source, start, at.range().end))
}
