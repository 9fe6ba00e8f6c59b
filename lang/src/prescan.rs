//! One pass over the bytes: where statements begin, and brackets, strings and comments that do not close.
//!
//! No recursion and no allocation per token. Between statements it skips by table and by memchr.

mod brackets;
mod strings;
mod tables;

use std::ops::Range;

use memchr::memchr;

use crate::words::{CONTINUE, NO_VALUES, PREFIX};

pub(crate) use brackets::opens_object;
pub(crate) use tables::table;

/// What is wrong with the brackets, strings or comments of a text; offsets are bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// A bracket at `at` that is nested deeper than the limit. Nothing after it was scanned.
    TooDeep {
        /// The bracket.
        at: usize,
    },
    /// A bracket that never closes.
    Unclosed {
        /// The bracket.
        open: usize,
    },
    /// A closing bracket of another kind than the open one.
    Mismatch {
        /// The open bracket.
        open: usize,
        /// The closing one.
        at: usize,
        /// How many brackets are open within the one that it closes.
        left: usize,
    },
    /// A closing bracket without an open one.
    Stray {
        /// The bracket.
        at: usize,
    },
    /// A string that does not end on its line.
    String {
        /// From the quote to the end of the line.
        at: Range<usize>,
    },
    /// A block comment that never ends.
    Comment {
        /// Its first byte.
        at: usize,
    },
    /// A backslash that begins no known escape.
    Escape {
        /// The escape.
        at: Range<usize>,
    },
}

impl Fault {
    /// The bracket that never closes, if that is what is wrong.
    pub fn unclosed(&self) -> Option<usize> {
        match self {
            Self::Unclosed { open } => Some(*open),
            _ => None,
        }
    }

    /// The byte that is to blame.
    pub fn at(&self) -> usize {
        match self {
            Self::TooDeep { at }
            | Self::Mismatch { at, .. }
            | Self::Stray { at }
            | Self::Comment { at } => *at,
            Self::Unclosed { open } => *open,
            Self::String { at } | Self::Escape { at } => at.start,
        }
    }
}

/// What one pass found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Scan {
    /// Where statements begin at the wanted depth, their doc comments included.
    pub starts: Vec<usize>,
    /// What does not close.
    pub faults: Vec<Fault>,
    /// Brackets that are open where they nest too deep.
    pub open: Vec<usize>,
    /// The start that was known: the scan ended there, and it is not among the others.
    pub met: Option<usize>,
}

/// Faults that are noted: with more a text is no scene, and nothing after the last is scanned.
pub(crate) const FAULTS: usize = 1000;

/// Bytes that matter inside brackets: quotes, slashes, hashes and brackets.
const STRUCTURAL: [bool; 256] = {
    let mut table = [false; 256];
    let bytes = b"\"/#()[]{}";
    let mut i = 0;
    while i < bytes.len() {
        table[bytes[i] as usize] = true;
        i += 1;
    }
    table
};

/// Scans `text[range]`, noting the statements that begin inside `depth` brackets, up to `limit`
/// nested brackets.
pub fn scan(text: &str, range: Range<usize>, depth: usize, limit: usize) -> Scan {
    scan_until(text, range, depth, limit, &mut |_| false)
}

/// The same up to the first statement whose start `is_known`: what follows depends on nothing before.
pub fn scan_until(
    text: &str,
    range: Range<usize>,
    depth: usize,
    limit: usize,
    is_known: &mut dyn FnMut(usize) -> bool,
) -> Scan {
    Scanner { at: range.start, depth, limit, ..Scanner::new(&text[..range.end], is_known) }.run()
}

/// Whether a text is one statement with nothing wrong with its brackets. Ends where it is not.
pub(crate) fn is_one(text: &str, limit: usize) -> bool {
    let mut n_begun = 0;
    let mut is_second = |_| {
        n_begun += 1;
        n_begun > 1
    };
    let found = Scanner { limit, most: 1, ..Scanner::new(text, &mut is_second) }.run();
    found.faults.is_empty() && found.starts.len() == 1 && found.met.is_none()
}

/// The bytes of the block comment with which a text begins; `None` if it never ends. The `*` that
/// begins it does not end it too: `/*/` goes on.
pub(crate) fn block_comment(text: &[u8]) -> Option<usize> {
    memchr::memmem::find(text.get(2..)?, b"*/").map(|end| end + 4)
}

/// What stands before, comments apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Before {
    /// What may end an expression.
    Operand,
    /// A sign, which a value follows: where a statement begins on the next line, it is missing.
    Sign,
    /// A word or bracket behind which a statement goes on.
    Opening,
}

struct Scanner<'a> {
    bytes: &'a [u8],
    at: usize,
    depth: usize,
    /// Brackets that may be open.
    limit: usize,
    /// Faults after which nothing is scanned.
    most: usize,
    is_known: &'a mut dyn FnMut(usize) -> bool,
    open: Vec<usize>,
    before: Before,
    newline: bool,
    /// Between `for` and `in`, or in an `assert` before its text, where a comma separates no statements.
    in_for: bool,
    /// The word that continues the running statement on a new line.
    follower: Option<&'static [u8]>,
    /// Whether no statement has begun in this block.
    first: bool,
    doc: Option<usize>,
    /// One past the last bracket that closed nothing.
    stray: Option<usize>,
    out: Scan,
}

impl<'a> Scanner<'a> {
    fn new(text: &'a str, is_known: &'a mut dyn FnMut(usize) -> bool) -> Self {
        Self {
            bytes: text.as_bytes(),
            at: 0,
            depth: 0,
            limit: 0,
            most: FAULTS,
            is_known,
            open: vec![],
            before: Before::Operand,
            newline: true,
            in_for: false,
            follower: None,
            first: true,
            doc: None,
            stray: None,
            out: Scan::default(),
        }
    }
}

impl Scanner<'_> {
    fn run(mut self) -> Scan {
        self.first = self.depth == 0;
        loop {
            if self.open.len() != self.depth {
                while self.bytes.get(self.at).is_some_and(|b| !STRUCTURAL[usize::from(*b)]) {
                    self.at += 1;
                }
            }
            let Some(&byte) = self.bytes.get(self.at) else { break };
            if self.out.faults.len() >= self.most {
                return self.out;
            }
            match byte {
                b'"' => self.string(),
                b'/' if self.next_is(b'/') => self.line_comment(),
                b'/' if self.next_is(b'*') => self.block_comment(),
                b'#' if self.next_is(b'[') => {
                    if !self.table() {
                        return self.out;
                    }
                }
                b'#' if self.begins_table_otherwise() => {}
                b'(' | b'[' | b'{' => {
                    if !self.open_bracket(byte) {
                        return self.out;
                    }
                }
                b')' | b']' | b'}' => self.close_bracket(byte),
                _ => self.between(byte),
            }
            if self.out.met.is_some() {
                return self.out;
            }
        }
        // What a comment has swallowed may have closed them.
        if !matches!(self.out.faults.last(), Some(Fault::Comment { .. })) {
            let unclosed = self.open.iter().map(|&open| Fault::Unclosed { open });
            self.out.faults.extend(unclosed);
        }
        self.out
    }

    fn follows_operand(&self) -> bool {
        self.before == Before::Operand
    }

    fn next_is(&self, byte: u8) -> bool {
        self.bytes.get(self.at + 1) == Some(&byte)
    }

    /// A byte outside strings, comments and brackets.
    fn between(&mut self, byte: u8) {
        let word = |b: &u8| b.is_ascii_alphanumeric() || *b == b'_';
        let start = self.at;
        self.at += 1;
        match byte {
            b'\n' => self.newline = true,
            b' ' | b'\t' | b'\r' | 0xEF | 0xBB | 0xBF => {}
            b',' if self.in_for => self.before = Before::Opening,
            b',' | b';' => {
                (self.before, self.newline, self.follower) = (Before::Operand, true, None);
            }
            b'a'..=b'z' | b'A'..=b'Z' | b'_' | b'@' => {
                while self.bytes.get(self.at).is_some_and(word) {
                    self.at += 1;
                }
                if self.is_member(start) {
                    (self.before, self.doc) = (Before::Operand, None);
                    return;
                }
                let name = &self.bytes[start..self.at];
                let follows = self.follower == Some(name) && self.may_follow(name);
                if follows || is_one_of(CONTINUE, name) {
                    (self.newline, self.doc) = (false, None);
                    self.follower = self.follower.filter(|_| !follows);
                } else {
                    let begins = self.word(start);
                    // These words have no other use, and may follow `@off`.
                    self.follower = match name {
                        b"expect" => Some(b"where"),
                        b"use" => Some(b"version"),
                        _ => self.follower.filter(|_| !begins),
                    };
                    self.in_for &= !begins;
                }
                let opens = byte == b'@' || is_one_of(PREFIX, name);
                self.before = if opens { Before::Opening } else { Before::Operand };
                self.in_for = matches!(name, b"for" | b"assert") || (self.in_for && name != b"in");
            }
            b'0'..=b'9' => {
                while self.bytes.get(self.at).is_some_and(word) {
                    self.at += 1;
                }
                // `5.` is a mistake, but not one of the line after it.
                let is_end = |b: &u8| !word(b) && *b != b'.';
                if self.bytes.get(self.at) == Some(&b'.')
                    && self.bytes.get(self.at + 1).is_none_or(is_end)
                {
                    self.at += 1;
                }
                (self.before, self.newline) = (Before::Operand, false);
            }
            // `#define x`: no mistake of the statement before.
            b'#' if self.follows_operand() && self.newline && self.open.len() == self.depth => {
                self.word(start);
                (self.before, self.in_for) = (Before::Sign, false);
            }
            _ => {
                // `{ = 1 m }`: a value without a name, whose unit begins no statement.
                self.first &= byte != b'=' || self.open.len() != self.depth;
                (self.before, self.newline) = (Before::Sign, false);
            }
        }
    }

    /// Whether a dot alone joins the word to what it is a member of: then it is any name.
    fn is_member(&self, start: usize) -> bool {
        matches!(self.bytes[..start], [.., before, b'.'] if before != b'.')
    }

    /// `version` may also be a name: only with a text behind it does it follow `use`.
    fn may_follow(&self, name: &[u8]) -> bool {
        name != b"version" || self.next_mark() == Some(b'"')
    }

    /// The next byte that is neither blank nor of a comment.
    fn next_mark(&self) -> Option<u8> {
        let mut rest = self.bytes[self.at..].trim_ascii_start();
        loop {
            let comment = match rest {
                [b'/', b'/', ..] => memchr(b'\n', rest)?,
                [b'/', b'*', ..] => block_comment(rest)?,
                _ => return rest.first().copied(),
            };
            rest = rest[comment..].trim_ascii_start();
        }
    }

    /// Whether a statement begins with the word.
    fn word(&mut self, start: usize) -> bool {
        let mut begins = false;
        if self.open.len() == self.depth {
            let is_apart = match self.before {
                Before::Operand => true,
                Before::Sign => is_one_of(NO_VALUES, &self.bytes[start..self.at]),
                Before::Opening => false,
            };
            begins = self.first || (is_apart && self.newline);
            if begins {
                let start = self.doc.unwrap_or(start);
                if !self.is_in_doubt(start) && (self.is_known)(start) {
                    self.out.met = Some(start);
                } else {
                    self.out.starts.push(start);
                }
            }
            self.first = false;
        }
        self.doc = None;
        self.newline = false;
        begins
    }

    fn line_comment(&mut self) {
        let rest = &self.bytes[self.at..];
        let is_doc = rest.get(2) == Some(&b'/') && rest.get(3) != Some(&b'/');
        if is_doc && self.doc.is_none() && self.follows_operand() && self.open.len() == self.depth {
            self.doc = Some(self.at);
        }
        self.at += memchr(b'\n', rest).unwrap_or(rest.len());
    }

    fn block_comment(&mut self) {
        let start = self.at;
        let end = block_comment(&self.bytes[start..]).map(|length| start + length);
        if end.is_none() {
            self.out.faults.push(Fault::Comment { at: start });
        }
        let stop = end.unwrap_or(self.bytes.len());
        self.newline |= memchr(b'\n', &self.bytes[start..stop]).is_some();
        self.at = stop;
    }

    /// A table; one that does not end is a bracket in which anything may stand.
    fn table(&mut self) -> bool {
        let Some(length) = table(&self.bytes[self.at..]) else {
            self.at += 1;
            return self.open_bracket(b'[');
        };
        self.at += length;
        (self.before, self.newline, self.doc) = (Before::Operand, false, None);
        true
    }

    fn open_bracket(&mut self, byte: u8) -> bool {
        if self.open.len() == self.limit {
            self.out.faults.push(Fault::TooDeep { at: self.at });
            self.out.open = std::mem::take(&mut self.open);
            return false;
        }
        self.open.push(self.at);
        if self.open.len() == self.depth {
            self.first = true;
        }
        let block = byte == b'{';
        self.before = if block { Before::Operand } else { Before::Opening };
        (self.newline, self.doc) = (block, None);
        self.at += 1;
        true
    }
}

/// Bytes of a line that are looked at to see which bracket is the wrong one.
const LOOKED_AT: usize = 256;

/// Whether it is one of these words.
fn is_one_of(words: &[&str], name: &[u8]) -> bool {
    words.iter().any(|word| word.as_bytes() == name)
}

/// The bracket that closes an open one.
fn closing(open: u8) -> u8 {
    match open {
        b'(' => b')',
        b'[' => b']',
        _ => b'}',
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn starts(text: &str) -> Vec<&str> {
        let scan = scan(text, 0..text.len(), 0, 128);
        assert_eq!(scan.faults, []);
        scan.starts.iter().map(|&at| text[at..].lines().next().unwrap()).collect()
    }

    #[test]
    fn a_newline_between_an_operand_and_a_word_begins_a_statement() {
        let text =
            "scene 1\nlet a = 5 +\n  b\nlet c = [\nx,\ny]\n/// doc\nshape x {\n r = 1 }\n@off\nf()";
        assert_eq!(starts(text), ["scene 1", "let a = 5 +", "let c = [", "/// doc", "@off"]);
    }

    #[test]
    fn where_a_value_is_missing_the_next_statement_begins_all_the_same() {
        assert_eq!(starts("let a =\nlet b = 2 * // twice\n\nfn f() = 1\nuse +\nx").len(), 4);
        assert_eq!(starts("let a =\nif b { c } else { d }\n@off\nlet e = 1").len(), 2);
    }

    #[test]
    fn words_that_continue_begin_nothing() {
        assert_eq!(starts("let a = b\n  with { c = 1 }\nif x { y = 1 }\nelse { y = 2 }").len(), 2);
        assert_eq!(starts("expect mean = b\n  where { c = 1 }\nlet d = 1\nwhere = 2").len(), 3);
        assert_eq!(starts("@off expect mean = b\n  where { c = 1 }").len(), 1);
        assert_eq!(
            starts("@off use plugin \"a\"\n version /*1*/ // 2\n \"^1\"\nversion \"b\" {}").len(),
            2
        );
        assert_eq!(starts("use plugin \"a\"\nversion {}").len(), 2);
        assert_eq!(starts("assert a,\n  b(\"c\", d), \"m\",\nlet b = 1").len(), 2);
    }

    #[test]
    fn brackets_in_strings_comments_and_tables_do_not_count() {
        assert_eq!(starts("a = \"}{\" // ({[\n/* ) */ b = #[ 1 2 ( ]\nc = 1").len(), 3);
    }

    #[test]
    fn what_does_not_close_is_named() {
        let check = |text: &str, fault| {
            assert_eq!(scan(text, 0..text.len(), 0, 3).faults, [fault], "{text}");
        };
        check("a = \"x\nb = 1", Fault::String { at: 4..6 });
        check("a /* b", Fault::Comment { at: 2 });
        check("a {", Fault::Unclosed { open: 2 });
        check("a = [1, 2)", Fault::Mismatch { open: 4, at: 9, left: 0 });
        check("}", Fault::Stray { at: 0 });
        check("((((", Fault::TooDeep { at: 3 });
        check("\"\\q\"", Fault::Escape { at: 1..3 });
        check("#[ 1 2", Fault::Unclosed { open: 1 });
        check("a { b = #[ 1 }", Fault::Mismatch { open: 9, at: 13, left: 1 });
    }
}
