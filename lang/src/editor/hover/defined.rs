//! What is told of names: where and as what they are defined.

use super::super::define::{Place, definition, symbol_at};
use super::super::document::Document;
use super::super::piece::Piece;
use super::super::symbols::{Role, Sort};
use super::{Asked, Hover};
use crate::syntax::tokens;

impl Asked<'_> {
    /// What is defined at a place.
    pub(super) fn defined(&self, place: Place) -> Option<Hover> {
        let document = self.around.project.document(&place.path)?;
        let piece = document.piece_at(place.range.0)?;
        let found = symbol_at(&document, place.range.0);
        let told = match found.map(|found| &found.symbol.role) {
            Some(Role::Definition(Sort::ArgumentOf(function))) => {
                let function = usage(&document, piece, piece.start + function);
                let own = upto(&document, piece, place.range.0, &[",", ")"]);
                self.told(own, format!("An argument of `{function}`."))
            }
            Some(Role::Definition(Sort::Item)) => {
                let before = tokens(document.text(), piece.start..place.range.0);
                let start = before.filter(|token| token.text == "for").last()?.start;
                let told = self.told(upto(&document, piece, start, &["{", "=>", "if"]), "");
                Hover { value_is: "one of", ..told }
            }
            _ => {
                let (code, text) = statement(&document, piece, &place);
                self.told(code, text)
            }
        };
        Some(told.of(place))
    }

    /// A part of what a name stands for.
    pub(super) fn member(&self, space: &str) -> Option<Hover> {
        let before = self.here.back(2)?.start;
        let place = definition(self.around.project, self.around.path, before)?;
        let document = self.around.project.document(&place.path)?;
        let (code, doc) = statement(&document, document.piece_at(place.range.0)?, &place);
        let of = format!("Of\n\n```scene\n{code}\n```\n\n{doc}");
        let name = format!("{space}.{}", self.here.word());
        Some(self.told(name, of.trim()).of(self.own()))
    }
}

/// How a function is declared whose name begins at a byte.
fn usage(document: &Document, piece: &Piece, start: usize) -> String {
    let (mut depth, mut end) = (0, start);
    for token in tokens(document.text(), start..piece.end) {
        end = token.end();
        match token.text {
            "(" => depth += 1,
            ")" if depth == 1 => break,
            ")" => depth -= 1,
            _ => {}
        }
    }
    one_line(&document.text()[start..end])
}

/// What begins at a byte and ends before one of these marks that stands in no bracket.
fn upto(document: &Document, piece: &Piece, start: usize, marks: &[&str]) -> String {
    let (mut depth, mut end) = (0, start);
    for token in tokens(document.text(), start..piece.end) {
        match token.text {
            mark if depth == 0 && marks.contains(&mark) => break,
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        end = token.end();
    }
    one_line(&document.text()[start..end])
}

fn one_line(text: &str) -> String {
    shortened(&text.split_whitespace().collect::<Vec<_>>().join(" "))
}

/// Lines of a definition that are shown.
const SHOWN_LINES: usize = 6;

/// The statement that defines what stands at a place, and what its doc comment says.
fn statement(document: &Document, piece: &Piece, place: &Place) -> (String, String) {
    let mut names = piece.read.facts.defines.iter();
    let own = names.any(|name| piece.start + name.span.range().start == place.range.0);
    let line = document.line(document.line_of(place.range.0));
    let range = match piece.read.stmts.first() {
        Some(stmt) if own => {
            let docs = stmt.docs.last().map(|doc| doc.span.range().end);
            piece.start + docs.unwrap_or(stmt.span.range().start)..piece.end
        }
        _ => line,
    };
    let mut lines: Vec<&str> = document.text()[range].trim().lines().collect();
    if lines.len() > SHOWN_LINES {
        lines.truncate(SHOWN_LINES);
        lines.push("…");
    }
    let lines: Vec<String> = lines.into_iter().map(shortened).collect();
    (lines.join("\n"), if own { piece.doc() } else { String::new() })
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
