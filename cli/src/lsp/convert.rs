//! Bytes and paths as the protocol writes them.

use std::ops::Range;
use std::path::{Path, PathBuf};

use luxel_core::files::normalise;
use luxel_lang::editor::Document;
use serde_json::{Value, json};

/// What columns count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Utf8,
    Utf16,
}

impl Encoding {
    /// The protocol's word.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Utf8 => "utf-8",
            Self::Utf16 => "utf-16",
        }
    }

    /// How many columns a text takes.
    pub(super) fn width(self, text: &str) -> usize {
        match self {
            Self::Utf8 => text.len(),
            Self::Utf16 => text.encode_utf16().count(),
        }
    }

    /// The byte of a position; past the end of its line, the end; past the last line, the end of
    /// the text. `None` if it is no position.
    pub(super) fn byte(self, document: &Document, position: &Value) -> Option<usize> {
        let number = |name: &str| usize::try_from(position.get(name)?.as_u64()?).ok();
        let (line, column) = (number("line")?, number("character")?);
        if line >= document.n_lines() {
            return Some(document.text().len());
        }
        let range = document.line(line);
        let text = &document.text()[range.clone()];
        let mut left = column;
        for (at, c) in text.char_indices() {
            let width = if self == Self::Utf8 { c.len_utf8() } else { c.len_utf16() };
            if left < width {
                return Some(range.start + at);
            }
            left -= width;
        }
        Some(range.end)
    }

    /// The bytes of a range. `None` if it is no range.
    pub(super) fn bytes(self, document: &Document, range: &Value) -> Option<Range<usize>> {
        let start = self.byte(document, range.get("start")?)?;
        let end = self.byte(document, range.get("end")?)?;
        Some(start.min(end)..end.max(start))
    }

    /// Line and column of a byte.
    pub(super) fn place(self, document: &Document, byte: usize) -> (usize, usize) {
        let line = document.line_of(byte);
        let start = document.line(line).start;
        let mut end = byte.min(document.text().len());
        while !document.text().is_char_boundary(end) {
            end -= 1;
        }
        (line, self.width(&document.text()[start..end]))
    }

    /// The position of a byte.
    pub(super) fn position(self, document: &Document, byte: usize) -> Value {
        let (line, character) = self.place(document, byte);
        json!({ "line": line, "character": character })
    }

    /// The range of bytes.
    pub(super) fn range(self, document: &Document, range: &Range<usize>) -> Value {
        json!({
            "start": self.position(document, range.start),
            "end": self.position(document, range.end),
        })
    }
}

/// The path of a URI. What is no file is its own name.
pub(super) fn path_of(uri: &str) -> PathBuf {
    let Some(rest) = uri.strip_prefix("file://") else { return PathBuf::from(uri) };
    let path = rest.find('/').map_or(rest, |at| &rest[at..]);
    let (mut bytes, mut at) = (vec![], 0);
    let raw = path.as_bytes();
    while at < raw.len() {
        let hex = path.get(at + 1..at + 3).filter(|_| raw[at] == b'%');
        let (byte, length) = match hex.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => (byte, 3),
            None => (raw[at], 1),
        };
        bytes.push(byte);
        at += length;
    }
    String::from_utf8(bytes).map_or_else(|_| PathBuf::from(uri), |path| normalise(Path::new(&path)))
}

/// The URI of a path.
pub(super) fn uri_of(path: &Path) -> String {
    let text = path.to_string_lossy();
    if !text.starts_with('/') {
        return text.into_owned();
    }
    let mut out = "file://".to_owned();
    for byte in text.bytes() {
        if byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte) {
            out.push(char::from(byte));
        } else {
            let hex = |digit: u8| char::from(b"0123456789ABCDEF"[usize::from(digit)]);
            out.extend(['%', hex(byte >> 4), hex(byte & 15)]);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use luxel_lang::Budgets;

    use super::*;

    #[test]
    fn positions_count_what_was_agreed_and_are_brought_into_the_text() {
        let document = Document::new("scene 1\né𝄞x\r\n", &Budgets::default());
        let at = |encoding: Encoding, line: u64, character: u64| {
            encoding.byte(&document, &json!({ "line": line, "character": character })).unwrap()
        };
        assert_eq!(at(Encoding::Utf16, 1, 1), 10);
        assert_eq!((at(Encoding::Utf16, 1, 3), at(Encoding::Utf8, 1, 6)), (14, 14));
        // In the middle of a character: its start.
        assert_eq!((at(Encoding::Utf16, 1, 2), at(Encoding::Utf8, 1, 4)), (10, 10));
        assert_eq!((at(Encoding::Utf16, 1, 99), at(Encoding::Utf16, 9, 0)), (15, 17));
        assert_eq!(Encoding::Utf16.place(&document, 15), (1, 4));
        assert_eq!(Encoding::Utf8.place(&document, 15), (1, 7));
        assert_eq!(Encoding::Utf16.place(&document, 99), (2, 0));
        assert!(Encoding::Utf16.byte(&document, &json!({ "line": -1, "character": 0 })).is_none());
    }

    #[test]
    fn uris_and_paths_are_each_others() {
        for path in ["/a b/c%d/é.scene", "/x", "untitled:Untitled-1"] {
            assert_eq!(path_of(&uri_of(Path::new(path))), PathBuf::from(path));
        }
        assert_eq!(uri_of(Path::new("/a b/é")), "file:///a%20b/%C3%A9");
        assert_eq!(path_of("file://host/a%2Fb/../c"), PathBuf::from("/a/c"));
        // Never a panic, whatever it is.
        for odd in ["file:///c%3A/x%", "file:///%zz", "file://", "", "file:///%ff", "file:///é%é"]
        {
            path_of(odd);
        }
    }
}
