//! What reading a statement will cost, by one look at its bytes.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, SourceId, Span};

use super::lex::tokens;
use crate::budgets::Budgets;
use crate::prescan::block_comment;

/// What is to be told of a statement that would take too much to read.
pub(super) fn too_large(
    text: &str,
    chunk: &Range<usize>,
    source: SourceId,
    budgets: &Budgets,
) -> Option<Diagnostic> {
    let Budgets { pieces, string, .. } = *budgets;
    if chunk.len() <= pieces.min(string) {
        return None;
    }
    let weight = weigh(&text[chunk.clone()], string);
    if let Some(at) = weight.text {
        let span = Span::new(source, chunk.start + at.start, chunk.start + at.end);
        let what = if text[span.range()].starts_with('"') { "string" } else { "word" };
        let message = format!("a {what} of more than {string} bytes");
        return Some(Diagnostic::error("E0509", span, message));
    }
    (weight.pieces > pieces).then(|| {
        let first = tokens(text, chunk.clone()).next().map_or(0..0, |t| t.start..t.end());
        let message = format!("a statement of more than {pieces} words and marks");
        let found = Diagnostic::error("E0510", Span::new(source, first.start, first.end), message);
        found.help("part it; many numbers belong into `#[ … ]` or a file")
    })
}

/// How large a statement is.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Weight {
    /// Words, marks, texts and lines of doc comments; numbers and what parts them are read at one go and
    /// count nothing.
    pieces: usize,
    /// The first text or word that is longer than the limit.
    text: Option<Range<usize>>,
}

/// Weighs a statement whose brackets and texts close; texts and words longer than `limit` are noted.
fn weigh(text: &str, limit: usize) -> Weight {
    let bytes = text.as_bytes();
    let (mut out, mut at, mut last) = (Weight::default(), 0, b',');
    while let Some(&byte) = bytes.get(at) {
        let start = at;
        at += 1;
        match byte {
            b' ' | b'\t' | b'\n' | b'\r' => continue,
            b'/' if bytes.get(at) == Some(&b'/') => {
                // Doc comments are kept.
                out.pieces += usize::from(bytes.get(at + 1) == Some(&b'/'));
                at += memchr::memchr(b'\n', &bytes[at..]).unwrap_or(bytes.len() - at);
                continue;
            }
            b'/' if bytes.get(at) == Some(&b'*') => {
                at = block_comment(&bytes[start..]).map_or(bytes.len(), |length| start + length);
                continue;
            }
            b'#' if bytes.get(at) == Some(&b'[') => {
                at += memchr::memchr(b']', &bytes[at..]).unwrap_or(bytes.len() - at);
            }
            b'"' => {
                at = end_of_text(bytes, at);
                if at - start > limit + 2 && out.text.is_none() {
                    out.text = Some(start..at);
                }
                out.pieces += 1;
            }
            b'0'..=b'9' => {
                // Digits, what parts numbers, and blanks count nothing, whatever stands before.
                let is_plain = |b: &&u8| matches!(b, b'0'..=b'9' | b',' | b' ' | b'\n');
                at += bytes[at..].iter().take_while(is_plain).count();
                let is_blank = |b: &u8| matches!(b, b' ' | b'\n');
                last =
                    bytes[start..at].iter().rev().copied().find(|b| !is_blank(b)).unwrap_or(byte);
                continue;
            }
            b'.' | b'e' | b'E' if is_number(last, byte) => {}
            b',' => {}
            // A sign before a number, or in its exponent.
            b'+' | b'-' if matches!(last, b',' | b'[' | b'(' | b'e' | b'E') => {}
            _ => {
                let is_word = |b: &&u8| b.is_ascii_alphanumeric() || **b == b'_';
                if is_word(&&byte) {
                    at += bytes[at..].iter().take_while(is_word).count();
                    if at - start > limit && out.text.is_none() {
                        out.text = Some(start..at);
                    }
                }
                out.pieces += 1;
            }
        }
        last = byte;
    }
    out
}

/// Whether a point or an `e` belongs to a number, by the byte before that is no blank.
fn is_number(last: u8, byte: u8) -> bool {
    last.is_ascii_digit() || last == b'.' && byte != b'.'
}

/// One past the quote that ends a text.
fn end_of_text(bytes: &[u8], mut at: usize) -> usize {
    while let Some(found) = memchr::memchr2(b'"', b'\\', &bytes[at.min(bytes.len())..]) {
        at += found + 1;
        if bytes[at - 1] == b'"' {
            return at;
        }
        at += 1;
    }
    bytes.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_marks_and_texts_count_and_numbers_do_not() {
        let pieces = |text| weigh(text, 10).pieces;
        // `let`, `a`, `=`, the brackets.
        assert_eq!(pieces("let a = [1, -2.5, 1e-3, 4]"), 5);
        assert_eq!(pieces("let a = #[ 1 2 x y z ] m"), 5);
        assert_eq!(pieces("x.a.a + b"), 7);
        assert_eq!(pieces("a /* #[ \" */ = b // 5\" wide\n + c /**/ /* "), 5);
        assert_eq!(pieces("/// one\n/// two\n// none\na\n"), 3);
        assert_eq!(weigh("a = b12345678901", 10).text, Some(4..16));
        assert_eq!(weigh("a = b123456789", 10).text, None);
        assert_eq!(weigh("a = \"0123456789\"", 10).text, None);
        assert_eq!(weigh("a = \"01234\\\"6789a\"", 10).text, Some(4..18));
    }
}
