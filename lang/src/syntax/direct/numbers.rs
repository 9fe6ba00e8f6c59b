//! Long lists of numbers, read on several threads.

use std::ops::Range;

use super::Reader;
use super::cursor::Cursor;
use crate::shares;

/// Bytes from which on a list is long.
const LONG: usize = 1 << 20;

/// Bytes of a list that are read at one go.
const PART: usize = 1 << 15;

impl Reader<'_> {
    /// Takes the numbers of a long list into `numbers`, each with the comma behind it, but for the last
    /// one. Takes nothing of a shorter list, nor where something else stands among them.
    pub(super) fn most_literals(&mut self, close: u8) {
        if self.cursor.rest().len() >= LONG {
            self.most_literals_of(close, LONG);
        }
    }

    fn most_literals_of(&mut self, close: u8, long: usize) {
        let rest = self.cursor.rest();
        // What holds a comment is left to whoever reads byte by byte.
        let Some(length) = memchr::memchr2(close, b'/', rest) else { return };
        if rest[length] == b'/' || length < long {
            return;
        }
        let inside = rest[..length].trim_ascii_end();
        let inside = inside.strip_suffix(b",").unwrap_or(inside);
        let Some(last) = memchr::memrchr(b',', inside) else { return };
        let text = self.cursor.slice(self.cursor.at..self.cursor.at + last + 1);
        let read = |parts: &[Range<usize>]| -> Option<Vec<f64>> {
            let mut out = vec![];
            for part in parts {
                numbers(&text[part.clone()], &mut out)?;
            }
            Some(out)
        };
        let all = shares::map(&parts(text), Range::len, read);
        if let Some(all) = all.into_iter().collect::<Option<Vec<_>>>() {
            self.numbers.extend(all.into_iter().flatten());
            self.cursor.at += text.len();
            self.cursor.skip();
        }
    }
}

/// Parts of a list, each up to a comma.
fn parts(text: &str) -> Vec<Range<usize>> {
    let (mut out, mut start) = (vec![], 0);
    while start < text.len() {
        let from = (start + PART).min(text.len() - 1);
        let end =
            memchr::memchr(b',', &text.as_bytes()[from..]).map_or(text.len(), |at| from + at + 1);
        out.push(start..end);
        start = end;
    }
    out
}

/// The numbers of a text, each with a comma behind it; `None` if something else stands there.
fn numbers(text: &str, out: &mut Vec<f64>) -> Option<()> {
    let mut cursor = Cursor::new(text, 0);
    cursor.skip();
    while cursor.at < text.len() {
        out.push(cursor.number()?);
        cursor.mark(b',')?;
        cursor.skip();
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use luxel_core::diag::SourceId;

    use super::super::Words;
    use super::*;
    use crate::Budgets;
    use crate::chance::next;

    /// What is left after the numbers that were taken, and these.
    fn taken(text: &str) -> (&str, Vec<f64>) {
        let (budgets, mut words) = (Budgets::default(), Words::default());
        let mut reader = Reader::new(Cursor::new(text, 0), SourceId(0), &budgets, &mut words);
        reader.most_literals_of(b']', 4);
        (&text[reader.cursor.at..], reader.numbers)
    }

    #[test]
    fn all_but_the_last_are_taken_or_none() {
        assert_eq!(taken("1, -2.5,\n3e1 , 4]"), ("4]", vec![1.0, -2.5, 30.0]));
        assert_eq!(taken("1, 2, 3, ]"), ("3, ]", vec![1.0, 2.0]));
        for text in ["1, 2 m, 3]", "1, /* 5, */ 2, 3]", "1, , 3]", "1, a, 3]", "1, 2, 3", "1]"] {
            assert_eq!(taken(text), (text, vec![]));
        }
    }

    #[test]
    fn a_list_of_many_parts_is_read_as_one() {
        let mut state = 5;
        let all: Vec<f64> = (0..40_000).map(|_| next(&mut state, 10_000) as f64 / 8.0).collect();
        let mut gap = || [",", ", ", ",\n  "][next(&mut state, 3)];
        let words: Vec<String> = all.iter().map(|x| format!("{x}{}", gap())).collect();
        let text = format!("{} 7 ]", words.concat());
        assert!(parts(&text).len() > 4);
        assert_eq!(taken(&text), ("7 ]", all));
    }
}
