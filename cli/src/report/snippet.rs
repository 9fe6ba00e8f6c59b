//! Diagnostics for people: the message, the lines at fault, advice and mends, as rustc shows them.

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Patch, Renderer, Snippet};
use luxel_core::diag::{Diagnostic, Grade, Label, Severity, Sources};

use super::plain::clean;
use super::window::Window;

/// Mends that are shown; there may be one for every unit.
const FIXES: usize = 3;

/// A diagnostic as text without a final line break.
pub(super) fn render(diagnostic: &Diagnostic, sources: &Sources, coloured: bool) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let title = level.primary_title(clean(&diagnostic.message)).id(diagnostic.code);
    let mut main = Group::with_title(title);
    for labels in together(&diagnostic.labels, sources) {
        main = excerpt(main, &labels, sources, labels[0] == &diagnostic.labels[0]);
    }
    if let (true, Some(scene)) = (diagnostic.labels.is_empty(), sources.first()) {
        main = main.element(Origin::path(clean(scene)));
    }
    for help in &diagnostic.help {
        main = main.element(Level::HELP.message(clean(help)));
    }
    let mut groups = vec![main];
    for fix in diagnostic.fixes.iter().take(FIXES) {
        let text = sources.text(fix.span.source);
        let Some(window) = Window::new(text, &[fix.span.range()]) else { continue };
        let line = line_of(sources, fix.span.source, window.start);
        let patch = Patch::new(window.spans[0].clone(), fix.replacement.clone());
        let snippet = Snippet::source(window.text).line_start(line).patch(patch);
        let title = match fix.grade {
            Grade::Sure => "this mends it",
            Grade::Guess => "perhaps this is meant",
        };
        groups.push(Group::with_title(Level::HELP.secondary_title(title)).element(snippet));
    }
    let renderer = if coloured { Renderer::styled() } else { Renderer::plain() };
    renderer.render(&groups)
}

/// Labels by excerpt: with the first one, those of its file that stand near; the others alone.
fn together<'a>(labels: &'a [Label], sources: &Sources) -> Vec<Vec<&'a Label>> {
    let Some((first, rest)) = labels.split_first() else { return vec![] };
    let mut near = vec![first];
    let mut far = vec![];
    for label in rest {
        let mut spans: Vec<_> = near.iter().map(|label| label.span.range()).collect();
        spans.push(label.span.range());
        let text = sources.text(first.span.source);
        if label.span.source == first.span.source && Window::new(text, &spans).is_some() {
            near.push(label);
        } else {
            far.push(vec![label]);
        }
    }
    far.insert(0, near);
    far
}

fn excerpt<'a>(group: Group<'a>, labels: &[&'a Label], sources: &Sources, main: bool) -> Group<'a> {
    let span = labels[0].span;
    let at = sources.line_column(span.source, span.start as usize);
    let name = clean(sources.name(span.source));
    let origin = || Origin::path(name.clone()).line(at.line).char_column(at.column);
    let spans: Vec<_> = labels.iter().map(|label| label.span.range()).collect();
    let Some(window) = Window::new(sources.text(span.source), &spans) else {
        return group.element(origin());
    };
    let line = line_of(sources, span.source, window.start);
    let annotations = labels.iter().zip(window.spans).enumerate().map(|(i, (label, span))| {
        let kind = if main && i == 0 { AnnotationKind::Primary } else { AnnotationKind::Context };
        let text = (!label.text.is_empty()).then(|| clean(&label.text));
        kind.span(span).label(text)
    });
    let snippet = Snippet::source(window.text).line_start(line).annotations(annotations);
    if window.cut {
        // The column is that of the file, which the cut line does not know.
        group.element(origin()).element(snippet)
    } else {
        group.element(snippet.path(name))
    }
}

fn line_of(sources: &Sources, id: luxel_core::diag::SourceId, byte: usize) -> usize {
    sources.line_column(id, byte).line
}

#[cfg(test)]
mod tests {
    use luxel_core::diag::Span;

    use super::*;

    #[test]
    fn a_mistake_is_shown_with_its_line_advice_and_mend() {
        let mut sources = Sources::default();
        let text = "scene 1\nshape sphere {\n  radus = 5 m\n}\n";
        let id = sources.add("a.scene", text);
        let at = text.find("radus").unwrap();
        let span = Span::new(id, at, at + 5);
        let found = Diagnostic::error("E0402", span, "a sphere has no `radus`")
            .saying("not a parameter")
            .label(Span::new(id, 8, 20), "this sphere")
            .help("it has `center` and `radius`")
            .fix(span, "radius");
        let shown = render(&found, &sources, false);
        for part in [
            "error[E0402]: a sphere has no `radus`",
            "--> a.scene:3:3",
            "3 |   radus = 5 m",
            "^^^^^ not a parameter",
            "this sphere",
            "help: it has `center` and `radius`",
            "radius = 5 m",
        ] {
            assert!(shown.contains(part), "{part} in\n{shown}");
        }
        assert!(!shown.contains('\x1b') && !shown.contains(":::"), "{shown}");
        assert!(render(&found, &sources, true).contains('\x1b'));
    }

    #[test]
    fn a_mistake_in_a_huge_line_is_short_and_keeps_its_column() {
        let mut sources = Sources::default();
        let text = format!("{}radus{}", " ".repeat(5_000_000), "x".repeat(5_000_000));
        let id = sources.add("a.scene", text);
        let span = Span::new(id, 5_000_000, 5_000_005);
        let shown = render(&Diagnostic::error("E0402", span, "what"), &sources, false);
        assert!(shown.len() < 2000, "{}", shown.len());
        assert!(shown.contains("a.scene:1:5000001"), "{shown}");
    }

    #[test]
    fn mistakes_without_place_and_in_empty_files_are_shown_and_escapes_are_not_obeyed() {
        let mut sources = Sources::default();
        let id = sources.add("empty\x1b.scene", "");
        let shown = render(&Diagnostic::unplaced("E0409", "no \x1b[31mcamera"), &sources, false);
        assert!(shown.starts_with("error[E0409]: no ") && !shown.contains('\x1b'), "{shown}");
        let empty = Diagnostic::error("E0001", Span::new(id, 0, 0), "the file is empty");
        let shown = render(&empty, &sources, false);
        assert!(shown.contains("E0001") && !shown.contains('\x1b'), "{shown}");
    }
}
