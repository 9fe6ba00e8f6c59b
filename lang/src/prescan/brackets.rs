//! Which bracket a closing one closes.

use luxel_sdk::kind::Kind;
use memchr::{memchr, memrchr};

use super::{Before, Fault, LOOKED_AT, Scanner, closing, table};

/// Bytes of a line before a bracket that are looked at, and behind one that was taken for one of another kind.
const FAR: usize = 1 << 12;

/// The bytes of the line before a byte, if they are few.
fn before_on_line(bytes: &[u8], at: usize) -> Option<&[u8]> {
    let first = at.saturating_sub(FAR);
    let line = memrchr(b'\n', &bytes[first..at]).map(|end| first + end + 1);
    Some(&bytes[line.or((first == 0).then_some(0))?..at])
}

/// Whether a `(` stands where an object has its `{`: behind a category, a kind and perhaps a label.
pub(crate) fn opens_object(bytes: &[u8], open: usize) -> bool {
    let Some(line) = before_on_line(bytes, open).filter(|_| bytes[open] == b'(') else {
        return false;
    };
    let mut head = line.trim_ascii_end();
    if let Some(label) = head.strip_suffix(b"\"") {
        let start = memrchr(b'"', label).unwrap_or_default();
        head = label[..start].trim_ascii_end();
    }
    let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.');
    let word = |text: &[u8]| {
        let length = text.iter().rev().take_while(|byte| is_word(byte)).count();
        text.len() - length
    };
    let kind = word(head);
    let before = head[..kind].trim_ascii_end();
    let category = str::from_utf8(&before[word(before)..]).unwrap_or_default();
    kind < head.len() && before.len() < kind && Kind::of_word(category).is_some()
}

/// Bytes of a table that are looked at where it begins with a bracket that begins none.
const SMALL: usize = 1 << 12;

impl Scanner<'_> {
    /// Passes a small table that begins with another bracket: `#{ 1 2 ]`.
    pub(super) fn begins_table_otherwise(&mut self) -> bool {
        let near = &self.bytes[self.at..self.bytes.len().min(self.at + SMALL)];
        let is_other = self.next_is(b'{') || self.next_is(b'(');
        let Some(length) = is_other.then(|| table(near)).flatten() else { return false };
        let (open, at) = (self.at + 1, self.at + length - 1);
        self.out.faults.push(Fault::Mismatch { open, at, left: 0 });
        self.at += length;
        (self.before, self.newline, self.doc) = (Before::Operand, false, None);
        true
    }

    fn rest_of_line(&self) -> &[u8] {
        let rest = &self.bytes[self.at + 1..];
        let rest = &rest[..rest.len().min(LOOKED_AT)];
        &rest[..memchr(b'\n', rest).unwrap_or(rest.len())]
    }

    /// How many brackets of the rest of the line close none of their kind, if `open` are open.
    fn misfits(&self, open: &[usize]) -> usize {
        // Few are enough: what closes on one line.
        let mut open: Vec<u8> = open.iter().rev().take(8).rev().map(|o| self.bytes[*o]).collect();
        let mut misfits = 0;
        for byte in self.rest_of_line() {
            match byte {
                b'(' | b'[' | b'{' => open.push(*byte),
                b')' | b']' | b'}' => {
                    let fits = open.pop().is_some_and(|last| closing(last) == *byte);
                    misfits += usize::from(!fits);
                }
                _ => {}
            }
        }
        misfits
    }

    /// A bracket that closes nothing: with others beside it, one mistake.
    fn stray(&mut self) {
        if self.stray != Some(self.at) {
            self.out.faults.push(Fault::Stray { at: self.at });
        }
        self.stray = Some(self.at + 1);
    }

    /// Whether the rest of the line closes a bracket that began on a line before, if `open` are open.
    fn closes_before(&self, open: &[usize]) -> bool {
        let first = self.at.saturating_sub(FAR);
        let line = memrchr(b'\n', &self.bytes[first..self.at]).map_or(first, |end| first + end);
        let (mut depth, mut n_closed) = (0_usize, 0);
        for byte in self.rest_of_line() {
            match byte {
                b'(' | b'[' | b'{' => depth += 1,
                b')' | b']' | b'}' if depth == 0 => n_closed += 1,
                b')' | b']' | b'}' => depth -= 1,
                _ => {}
            }
        }
        open.iter().rev().take(n_closed).any(|open| *open < line)
    }

    /// Whether a bracket alone on its line but for an `else`, which is indented as that of an open brace is,
    /// stands for the end of the block.
    fn ends_block(&self, open: usize) -> bool {
        let lines = before_on_line(self.bytes, self.at).zip(before_on_line(self.bytes, open));
        let Some((before, line)) = lines else { return false };
        let behind = self.rest_of_line().trim_ascii();
        let ends = behind.is_empty() || behind.starts_with(b"else ");
        let is_alone = before.trim_ascii().is_empty() && ends;
        let indent = line.len() - line.trim_ascii_start().len();
        is_alone && indent == before.len() && line.len() > indent
    }

    /// Whether on the line of this byte a bracket was taken for one of another kind: what begins behind it may
    /// belong to what the bracket ended.
    pub(super) fn is_in_doubt(&self, at: usize) -> bool {
        let last = match self.out.faults.last() {
            Some(Fault::Mismatch { at, left: 0, .. }) => *at,
            _ => return false,
        };
        at - last <= FAR && memchr(b'\n', &self.bytes[last..at]).is_none()
    }

    /// Whether this bracket closes what the one before that was taken for one of another kind was said to. Behind
    /// another of its own kind that was one too many; else one may be missing before it.
    fn makes_up_for_last(&mut self, byte: u8) -> bool {
        let closes = |open: usize| closing(self.bytes[open]) == byte;
        let Some(Fault::Mismatch { open, at, left: 0 }) = self.out.faults.last() else {
            return false;
        };
        let (open, at) = (*open, *at);
        if self.at - at > FAR || !closes(open) {
            return false;
        }
        let is_inside = self.open.last().is_none_or(|outer| *outer < open && !closes(*outer));
        let is_same = self.out.starts.last().is_none_or(|start| *start <= open)
            || before_on_line(self.bytes, self.at).is_some_and(|line| self.at - line.len() <= open);
        let makes_up = is_inside && is_same;
        if makes_up {
            if self.bytes[..at].trim_ascii_end().ends_with(&[self.bytes[at]]) {
                self.out.faults.pop();
                self.out.faults.push(Fault::Stray { at });
            }
            self.out.starts.truncate(self.out.starts.partition_point(|start| *start <= open));
        }
        makes_up
    }

    /// Whether a bracket that does not fit the one that was just closed is one too many, rather than
    /// another one than was meant: a block that began on a line before goes on, and so does the rest of
    /// this line; or one of this line does, where otherwise one would end that began before.
    fn is_one_too_many(&self, open: usize, byte: u8) -> bool {
        if byte == b'}'
            || self.bytes[open] != b'{'
            || self.ends_block(open)
            || self.open.iter().any(|o| closing(self.bytes[*o]) == byte)
        {
            return false;
        }
        let with: Vec<usize> = self.open.iter().copied().chain([open]).collect();
        let (kept, closed) = (self.misfits(&with), self.misfits(&self.open));
        let before = memchr(b'\n', &self.bytes[open..self.at]).is_some();
        let goes_on = || self.closes_before(&self.open) && !self.closes_before(&with);
        kept < closed || kept == closed && (before || goes_on())
    }

    pub(super) fn close_bracket(&mut self, byte: u8) {
        // No statement begins with a doc comment before a bracket that closes what stands above it.
        self.doc = None;
        if self.makes_up_for_last(byte) {
            (self.before, self.newline) = (Before::Operand, false);
            self.at += 1;
            return;
        }
        match self.open.pop() {
            None => self.stray(),
            Some(open) if self.is_one_too_many(open, byte) => {
                self.open.push(open);
                self.stray();
            }
            Some(open) if closing(self.bytes[open]) != byte => {
                // An outer bracket of this kind closes here too, if the line goes on better so; else
                // only this one does.
                let outer = self.open.iter().rposition(|&o| closing(self.bytes[o]) == byte);
                let goes_on =
                    |outer: &usize| self.misfits(&self.open[..*outer]) <= self.misfits(&self.open);
                let is_own = byte == b'}' && opens_object(self.bytes, open);
                let outer = outer.filter(goes_on).filter(|_| !is_own);
                let left = outer.map_or(0, |outer| self.open.len() - outer);
                self.open.truncate(outer.unwrap_or(self.open.len()));
                self.out.faults.push(Fault::Mismatch { open, at: self.at, left });
            }
            Some(_) => {}
        }
        (self.before, self.newline) = (Before::Operand, false);
        self.at += 1;
    }
}
