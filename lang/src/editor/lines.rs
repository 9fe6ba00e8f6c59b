//! Where the lines of a text begin, kept while it is edited. A carriage return alone ends a line too:
//! editors count so (Language Server Protocol 3.17, "Text Documents").

use std::ops::Range;

/// The first byte of each line; there is always one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Lines(Vec<u32>);

impl Lines {
    pub(super) fn of(text: &str) -> Self {
        let mut starts = vec![0];
        starts.extend(begun(text, 0..text.len()));
        Self(starts)
    }

    /// `range` has become so many bytes of what is `text` now.
    pub(super) fn edit(&mut self, range: &Range<usize>, length: usize, text: &str) {
        // What ends a line depends on the byte behind it, so that one before the range may have changed.
        let from = range.start.saturating_sub(1);
        let first = self.0.partition_point(|start| *start as usize <= from);
        let last = self.0.partition_point(|start| *start as usize <= range.end);
        let old = narrow(range.end);
        let new = narrow(range.start + length);
        for start in &mut self.0[last..] {
            *start = *start - old + new;
        }
        self.0.splice(first..last, begun(text, from..range.start + length));
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    /// The number of the line, from 0, in which a byte stands.
    pub(super) fn of_byte(&self, byte: usize) -> usize {
        self.0.partition_point(|start| *start as usize <= byte).saturating_sub(1)
    }

    /// The bytes of a line, without what ends it; the last line if there are fewer.
    pub(super) fn range(&self, line: usize, text: &str) -> Range<usize> {
        let line = line.min(self.0.len() - 1);
        let start = self.0[line] as usize;
        let Some(next) = self.0.get(line + 1) else { return start..text.len() };
        let bytes = &text.as_bytes()[start..*next as usize];
        start..start + bytes.strip_suffix(b"\r\n").unwrap_or(&bytes[..bytes.len() - 1]).len()
    }
}

/// Where lines begin that end with one of these bytes.
fn begun(text: &str, ends: Range<usize>) -> impl Iterator<Item = u32> + '_ {
    let bytes = text.as_bytes();
    let found = memchr::memchr2_iter(b'\n', b'\r', &bytes[ends.clone()]);
    found
        .map(move |at| ends.start + at)
        .filter(|at| bytes[*at] == b'\n' || bytes.get(at + 1) != Some(&b'\n'))
        .map(|at| narrow(at + 1))
}

fn narrow(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chance::next;

    #[test]
    fn edited_lines_are_those_of_the_new_text() {
        let mut text = "a\nbb\r\n\nc".to_owned();
        let mut lines = Lines::of(&text);
        for (range, with) in [
            (0..0, "x\n"),
            (1..3, ""),
            (3..6, "\n\n\n"),
            (2..2, "é"),
            (0..1, ""),
            (0..0, "\r"),
            (1..1, "\n"),
            (1..1, "a\r"),
            (1..3, "\r\r"),
            (0..1, ""),
        ] {
            text.replace_range(range.clone(), with);
            lines.edit(&range, with.len(), &text);
            assert_eq!(lines, Lines::of(&text), "{text:?}");
        }
        let mut state = 7;
        for _ in 0..2000 {
            let start = next(&mut state, text.len() + 1);
            let range = start..(start + next(&mut state, 3)).min(text.len());
            if !text.is_char_boundary(range.start) || !text.is_char_boundary(range.end) {
                continue;
            }
            let with = ["", "\r", "\n", "\r\n", "a", "\n\r"][next(&mut state, 6)];
            text.replace_range(range.clone(), with);
            lines.edit(&range, with.len(), &text);
            assert_eq!(lines, Lines::of(&text), "{text:?}");
        }
        let lone = "a\rb\r\n\rc\r";
        let all = (0..5).map(|line| &lone[Lines::of(lone).range(line, lone)]);
        assert_eq!(all.collect::<Vec<_>>(), ["a", "b", "", "c", ""]);
        assert_eq!(Lines::of("a\r\nb").range(0, "a\r\nb"), 0..1);
        assert_eq!(Lines::of("a\r\nb").range(9, "a\r\nb"), 3..4);
    }
}
