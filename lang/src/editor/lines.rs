//! Where the lines of a text begin, kept while it is edited.

use std::ops::Range;

/// The first byte of each line; there is always one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Lines(Vec<u32>);

impl Lines {
    pub(super) fn of(text: &str) -> Self {
        let mut starts = vec![0];
        starts.extend(after_newlines(text, 0));
        Self(starts)
    }

    /// `range` has become `with`.
    pub(super) fn edit(&mut self, range: &Range<usize>, with: &str) {
        let first = self.0.partition_point(|start| *start as usize <= range.start);
        let last = self.0.partition_point(|start| *start as usize <= range.end);
        let old = narrow(range.end);
        let new = narrow(range.start + with.len());
        for start in &mut self.0[last..] {
            *start = *start - old + new;
        }
        self.0.splice(first..last, after_newlines(with, range.start));
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
        let end = self.0.get(line + 1).map_or(text.len(), |next| *next as usize - 1);
        let end = if end > start && text.as_bytes()[end - 1] == b'\r' { end - 1 } else { end };
        start..end
    }
}

fn after_newlines(text: &str, base: usize) -> impl Iterator<Item = u32> + '_ {
    memchr::memchr_iter(b'\n', text.as_bytes()).map(move |at| narrow(base + at + 1))
}

fn narrow(at: usize) -> u32 {
    u32::try_from(at).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edited_lines_are_those_of_the_new_text() {
        let mut text = "a\nbb\r\n\nc".to_owned();
        let mut lines = Lines::of(&text);
        for (range, with) in [(0..0, "x\n"), (1..3, ""), (3..6, "\n\n\n"), (2..2, "é"), (0..1, "")]
        {
            lines.edit(&range, with);
            text.replace_range(range, with);
            assert_eq!(lines, Lines::of(&text), "{text:?}");
        }
        assert_eq!(Lines::of("a\r\nb").range(0, "a\r\nb"), 0..1);
        assert_eq!(Lines::of("a\r\nb").range(9, "a\r\nb"), 3..4);
    }
}
