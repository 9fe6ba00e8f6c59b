//! Which bracket a closing one closes.

use memchr::{memchr, memrchr};

use super::{Fault, LOOKED_AT, Scanner, closing};

impl Scanner<'_> {
    fn rest_of_line(&self) -> &[u8] {
        let rest = &self.bytes[self.at + 1..];
        &rest[..memchr(b'\n', rest).unwrap_or(rest.len()).min(LOOKED_AT)]
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
        let line = memrchr(b'\n', &self.bytes[..self.at]).unwrap_or(0);
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

    /// Whether a bracket that does not fit the one that was just closed is one too many, rather than
    /// another one than was meant: a block that began on a line before goes on, and so does the rest of
    /// this line; or one of this line does, where otherwise one would end that began before.
    fn is_one_too_many(&self, open: usize, byte: u8) -> bool {
        if byte == b'}'
            || self.bytes[open] != b'{'
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
                let outer = outer.filter(goes_on);
                let left = outer.map_or(0, |outer| self.open.len() - outer);
                self.open.truncate(outer.unwrap_or(self.open.len()));
                self.out.faults.push(Fault::Mismatch { open, at: self.at, left });
            }
            Some(_) => {}
        }
        (self.operand, self.newline) = (true, false);
        self.at += 1;
    }
}
