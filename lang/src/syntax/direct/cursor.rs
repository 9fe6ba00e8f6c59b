//! A place in a text, and what may be taken there.

use std::ops::Range;

use crate::prescan::block_comment;

/// Reads a text byte by byte.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cursor<'a> {
    text: &'a str,
    /// The next byte.
    pub(super) at: usize,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(text: &'a str, at: usize) -> Self {
        Self { text, at }
    }

    pub(super) fn slice(&self, range: Range<usize>) -> &'a str {
        &self.text[range]
    }

    /// The text from `start` to here.
    pub(super) fn since(&self, start: usize) -> &'a str {
        &self.text[start..self.at]
    }

    /// The bytes that are left.
    pub(super) fn rest(&self) -> &'a [u8] {
        &self.text.as_bytes()[self.at..]
    }

    pub(super) fn peek(&self) -> Option<u8> {
        self.text.as_bytes().get(self.at).copied()
    }

    /// The byte `n` places on.
    pub(super) fn ahead(&self, n: usize) -> Option<u8> {
        self.text.as_bytes().get(self.at + n).copied()
    }

    /// Whether the byte stands here; it is taken.
    pub(super) fn takes(&mut self, byte: u8) -> bool {
        let is_here = self.peek() == Some(byte);
        self.at += usize::from(is_here);
        is_here
    }

    /// Takes a byte that must stand here, perhaps after blanks and comments.
    pub(super) fn mark(&mut self, byte: u8) -> Option<()> {
        self.skip();
        self.takes(byte).then_some(())
    }

    /// Takes `=`, which is not the first half of `==`, perhaps after blanks and comments.
    pub(super) fn equals(&mut self) -> bool {
        self.skip();
        self.ahead(1) != Some(b'=') && self.takes(b'=')
    }

    /// Takes blanks that do not end the line; says whether there are any.
    pub(super) fn blanks(&mut self) -> bool {
        let start = self.at;
        self.take_while(|byte| matches!(byte, b' ' | b'\t'));
        self.at > start
    }

    /// Takes blanks and lines.
    pub(super) fn lines(&mut self) {
        self.take_while(|byte| matches!(byte, b' ' | b'\t' | b'\r' | b'\n'));
    }

    /// Takes what may stand anywhere: blanks, lines and comments. A byte order mark may too, but is
    /// left to pest.
    pub(super) fn skip(&mut self) {
        self.lines();
        while self.peek() == Some(b'/') && self.comment() {
            self.lines();
        }
    }

    fn comment(&mut self) -> bool {
        let rest = self.rest();
        let length = match rest {
            [b'/', b'/', ..] if self.is_doc() => None,
            [b'/', b'/', ..] => Some(memchr::memchr(b'\n', rest).unwrap_or(rest.len())),
            [b'/', b'*', ..] => block_comment(rest),
            _ => None,
        };
        self.at += length.unwrap_or(0);
        length.is_some()
    }

    /// Whether a doc comment begins here.
    pub(super) fn is_doc(&self) -> bool {
        let rest = self.rest();
        rest.starts_with(b"///") && rest.get(3) != Some(&b'/')
    }

    /// Takes bytes as long as `is_part`.
    pub(super) fn take_while(&mut self, is_part: impl Fn(u8) -> bool) {
        while self.peek().is_some_and(&is_part) {
            self.at += 1;
        }
    }

    /// Takes a word.
    pub(super) fn word(&mut self) -> Option<&'a str> {
        let start = self.at;
        self.peek().filter(|byte| begins_word(*byte))?;
        self.take_while(is_in_word);
        Some(self.since(start))
    }

    /// Whether that very word stands here, perhaps after blanks and comments; it is taken.
    pub(super) fn takes_word(&mut self, word: &str) -> bool {
        self.skip();
        let is_here = self.is_word(word);
        self.at += if is_here { word.len() } else { 0 };
        is_here
    }

    /// Whether that very word stands here.
    pub(super) fn is_word(&self, word: &str) -> bool {
        self.rest().starts_with(word.as_bytes()) && !self.ahead(word.len()).is_some_and(is_in_word)
    }
}

/// Whether a word may begin with the byte.
pub(super) fn begins_word(byte: u8) -> bool {
    byte.is_ascii_alphabetic() || byte == b'_'
}

/// Whether a word may go on with the byte.
pub(super) fn is_in_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}
