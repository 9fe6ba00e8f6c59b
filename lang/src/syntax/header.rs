//! What a file begins with: `scene 1`.

use luxel_core::diag::{Diagnostic, near};

use super::habits::COMMENTS;
use super::lex::{Token, TokenKind, tokens};
use super::parse::Reader;
use super::peers::{BEGINS, XML, is_pbrt, is_xml};

impl Reader<'_> {
    /// Reads what stands before the first statement; gives where that ends, or `None` if reading on is
    /// of no use.
    pub(super) fn head(&mut self) -> Option<usize> {
        if let Some(at) = memchr::memchr(0, self.text.as_bytes()) {
            let message = format!("a NUL byte at offset {at}: this is not a text");
            self.sink.push(Diagnostic::error("E0004", self.span(at..at + 1), message));
            return None;
        }
        if self.text.starts_with('\u{FEFF}') {
            let message = "the file begins with a byte order mark, which is not needed";
            let span = self.span(0..3);
            self.sink.push(Diagnostic::warning("E0004", span, message).fix(span, ""));
        }
        self.header()
    }

    /// Reads `scene 1`; gives where it ends, or `None` if reading on is of no use.
    fn header(&mut self) -> Option<usize> {
        let (marks, from) = marks(self.text);
        for at in marks {
            let found = self.marked(at);
            self.sink.push(found);
        }
        let mut tokens = tokens(self.text, from..self.text.len());
        let Some(first) = tokens.next() else {
            let message = "the file is empty: a scene begins with `scene 1`";
            let span = self.span(0..0);
            self.sink.push(Diagnostic::error("E0001", span, message).guess(span, "scene 1\n"));
            return None;
        };
        let span = self.span(first.start..first.end());
        if first.text == "Scene" || first.text == "SCENE" {
            let message = "`scene` is written in small letters";
            self.sink.push(Diagnostic::error("E0001", span, message).fix(span, "scene"));
        } else if first.text != "scene" {
            if let Some(end) = self.slipped(&first, tokens.next()) {
                return Some(end);
            }
            if is_xml(self.text, first.start) {
                self.sink.push(Diagnostic::error("E0021", span, XML).help(BEGINS));
                return None;
            }
            // What can be read is not told to be pbrt's.
            let line = self.text[first.end()..].lines().next().unwrap_or_default();
            if !is_pbrt(first.text) || line.contains(['{', '=']) {
                let start = self.span(first.start..first.start);
                let message = "a scene begins with `scene 1`";
                let found = Diagnostic::error("E0001", span, message).guess(start, "scene 1\n");
                self.sink.push(found);
            }
            return Some(first.start);
        }
        // Blanks alone may stand before the version: no comment, no carriage return.
        let is_next =
            |t: &Token<'_>| self.text[first.end()..t.start].trim_matches([' ', '\t']).is_empty();
        let next = tokens.next().filter(is_next);
        let Some(version) = next.filter(|t| t.kind == TokenKind::Number) else {
            // `scene "v1"`
            if let Some(text) = next.filter(|t| t.kind == TokenKind::Text) {
                let span = self.span(text.start..text.end());
                let message = "the version of the language is a number";
                self.sink.push(Diagnostic::error("E0001", span, message).guess(span, "1"));
                return Some(text.end());
            }
            let message = "`scene` wants the version of the language";
            let end = self.span(first.end()..first.end());
            self.sink.push(Diagnostic::error("E0001", span, message).guess(end, " 1"));
            return Some(first.end());
        };
        if version.text != "1" {
            let span = self.span(version.start..version.end());
            let message = format!("version {} is not known; the newest is 1", version.text);
            let found = Diagnostic::error("E0002", span, message);
            // `scene 1.0`
            if version.text.starts_with("1.") {
                self.sink.push(found.fix(span, "1"));
                return Some(version.end());
            }
            self.sink.push(found.guess(span, "1"));
            return None;
        }
        Some(version.end())
    }

    /// `sene 1` and `1 scene`: where what is to be read begins.
    fn slipped(&mut self, first: &Token<'_>, next: Option<Token<'_>>) -> Option<usize> {
        let next = next.filter(|next| !next.first_on_line)?;
        let is_misspelt = next.text == "1" && near(first.text, ["scene"]).is_some();
        if !is_misspelt && (first.text, next.text) != ("1", "scene") {
            return None;
        }
        let span = self.span(first.start..next.end());
        let found = Diagnostic::error("E0001", span, "a scene begins with `scene 1`");
        self.sink.push(found.fix(span, "scene 1"));
        Some(next.end())
    }

    /// What is told of a line before `scene` that begins with `#`.
    fn marked(&self, at: usize) -> Diagnostic {
        let span = self.span(at..at + 1);
        if self.text[at + 1..].trim_start().starts_with("include") {
            let message = "another file is read behind `scene 1`, by `include`";
            return Diagnostic::error("E0001", span, message);
        }
        Diagnostic::error("E0023", span, COMMENTS).guess(span, "//")
    }
}

/// Lines before `scene` that are looked at for comments as other languages write them.
const COMMENTED: usize = 100;

/// Where `#` begins lines that stand before `scene`, if there only comments do, and where what is to be read
/// begins.
fn marks(text: &str) -> (Vec<usize>, usize) {
    let (mut at, mut marks) = (0, vec![]);
    for line in text.split_inclusive('\n').take(COMMENTED) {
        let written = line.trim_start();
        if written.starts_with('#') {
            marks.push(at + line.len() - written.len());
        } else if !written.is_empty() && !written.starts_with("//") {
            let is_head = written.starts_with("scene") && !marks.is_empty();
            return if is_head { (marks, at) } else { (vec![], 0) };
        }
        at += line.len();
    }
    (vec![], 0)
}
