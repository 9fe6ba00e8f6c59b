//! What is told of a place: the manual, the definition, the value.

use std::ops::Range;
use std::path::Path;

use luxel_core::registry::Registry;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::UNITS;

use super::context::{Context, Inside, dotted};
use super::define::{Place, Project, definition};
use super::document::Document;
use super::named::Around;
use super::schema;
use super::statements::page_of;
use crate::eval::types;
use crate::manual;
use crate::syntax::TokenKind;

/// What is told of a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hover {
    /// The bytes that it is told of.
    pub range: Range<usize>,
    /// What stands in the scene, to be shown as code.
    pub code: String,
    /// What it means, as paragraphs.
    pub text: String,
    /// Where what it names is defined, whose value may be told too; of a field its own name.
    pub of: Option<Place>,
}

/// What is told of a byte of a file.
pub fn hover(project: &dyn Project, path: &Path, at: usize, registry: &Registry) -> Option<Hover> {
    let document = project.document(path)?;
    let around = Around { project, path, document: &document, registry };
    let end = word_end(document.text(), at);
    let here = Context::at(&document, end);
    if here.inside != Inside::Code || here.word.is_empty() {
        return None;
    }
    let told =
        |code: String, text: String| Hover { range: here.word.clone(), code, text, of: None };
    let word = here.word();
    let next = here.after().map_or("", |token| token.text);
    if let Some((code, text)) = of_field(around, &here, next) {
        let of = Place { path: path.to_owned(), range: (here.word.start, here.word.end) };
        return Some(Hover { of: Some(of), ..told(code, text) });
    }
    if let Some((code, text)) = of_object(registry, &here) {
        return Some(told(code, text));
    }
    if !here.is_fresh
        && here.back(1).is_some_and(|last| last.kind == TokenKind::Number)
        && let Some((name, unit)) = UNITS.iter().find(|(name, _)| *name == word)
    {
        let text = format!("{}; 1 {name} is {} in SI units", unit.dimension.name(), unit.scale);
        return Some(told((*name).to_owned(), text));
    }
    if here.text_back(1) == ":" && types::names().any(|name| name == word) {
        let text = types::dimension(word).map_or(String::new(), luxel_sdk::params::Dimension::name);
        return Some(told(word.to_owned(), text));
    }
    if let Some(place) = definition(project, path, here.word.start) {
        let (code, text) = of_definition(project, &place)?;
        return Some(Hover { of: Some(place), ..told(code, text) });
    }
    let (before, _) = dotted(&here.before[..here.before.len().saturating_sub(1)]);
    let dotted =
        if here.text_back(1) == "." { format!("{before}.{word}") } else { word.to_owned() };
    let function = manual::function(&dotted)?;
    let text = function.text();
    Some(told(function.usage, text))
}

/// The end of the word at a byte.
fn word_end(text: &str, at: usize) -> usize {
    let rest = text.get(at..).unwrap_or_default();
    at + rest.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').count()
}

/// The manual of a parameter that is given.
fn of_field(around: Around<'_>, here: &Context<'_>, next: &str) -> Option<(String, String)> {
    let head = here.head().filter(|_| next == "=" && here.begins())?;
    let givens = schema::givens(around, head);
    let given = givens.into_iter().find(|given| given.name() == here.word())?;
    Some((format!("{}: {}", given.name(), given.facts()), given.doc().to_owned()))
}

/// The manual of a category or kind of object.
fn of_object(registry: &Registry, here: &Context<'_>) -> Option<(String, String)> {
    let word = here.word();
    let before = here.text_back(1);
    if !here.is_fresh
        && let Some(kind) = Kind::of_word(before)
        && let Some(class) = registry.class(kind, word)
    {
        return Some((format!("{kind} {word}"), class.doc.trim().to_owned()));
    }
    let next = here.after()?;
    let is_head = matches!(next.kind, TokenKind::Word | TokenKind::Text) || next.text == "{";
    if !is_head {
        return None;
    }
    if let Some(page) = page_of(word) {
        return Some((word.to_owned(), page.trim().to_owned()));
    }
    let kind = Kind::of_word(word)?;
    let names: Vec<_> = registry.of_kind(kind).map(|entry| entry.class.name).collect();
    Some((word.to_owned(), format!("A category of objects. Kinds: {}.", names.join(", "))))
}

/// Lines of a definition that are shown.
const SHOWN_LINES: usize = 6;

/// The statement that defines what stands at a place, and what its doc comment says.
fn of_definition(project: &dyn Project, place: &Place) -> Option<(String, String)> {
    let document = project.document(&place.path)?;
    let piece = document.piece_at(place.range.0)?;
    let stmt = piece.read.stmts.first()?;
    let own = piece
        .read
        .facts
        .defines
        .iter()
        .any(|name| piece.start + name.span.range().start == place.range.0);
    let start = if own { piece.start + after_docs(stmt) } else { line_start(&document, place) };
    let end = if own { piece.end } else { document.line(document.line_of(place.range.0)).end };
    let mut lines: Vec<&str> = document.text()[start..end].trim().lines().collect();
    if lines.len() > SHOWN_LINES {
        lines.truncate(SHOWN_LINES);
        lines.push("…");
    }
    let lines: Vec<String> = lines.into_iter().map(shortened).collect();
    Some((lines.join("\n"), if own { piece.doc() } else { String::new() }))
}

fn line_start(document: &Document, place: &Place) -> usize {
    document.line(document.line_of(place.range.0)).start
}

fn after_docs(stmt: &crate::syntax::Stmt) -> usize {
    stmt.docs.last().map_or(stmt.span.range().start, |doc| doc.span.range().end)
}

/// Characters of a line that are shown.
const SHOWN_CHARS: usize = 100;

fn shortened(line: &str) -> String {
    let mut out: String = line.chars().take(SHOWN_CHARS).collect();
    if out.len() < line.len() {
        out.push('…');
    }
    out
}
