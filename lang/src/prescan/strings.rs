//! Strings.

use memchr::memchr3;

use super::{Before, Fault, LOOKED_AT, Scanner, closing};

impl Scanner<'_> {
    pub(super) fn string(&mut self) {
        let start = self.at;
        self.at += 1;
        loop {
            let Some(found) = memchr3(b'"', b'\\', b'\n', &self.bytes[self.at..]) else {
                self.at = self.bytes.len();
                self.at = self.likely_end(start + 1);
                self.out.faults.push(Fault::String { at: start..self.at });
                break;
            };
            self.at += found;
            match self.bytes[self.at] {
                b'"' => {
                    self.at += 1;
                    break;
                }
                b'\\' => self.escape(start),
                _ => {
                    self.at = self.likely_end(start + 1);
                    self.out.faults.push(Fault::String { at: start..self.at });
                    break;
                }
            }
        }
        (self.before, self.newline, self.doc) = (Before::Operand, false, None);
        // The text of an assertion ends it.
        self.in_for &= self.open.len() != self.depth;
    }

    /// An escape of the string that begins at `start`.
    fn escape(&mut self, start: usize) {
        let rest = &self.bytes[self.at + 1..];
        let length = match rest.first() {
            Some(b'"' | b'\\' | b'n' | b't') => Some(1),
            Some(b'u') if rest.get(1) == Some(&b'{') => {
                let digits = rest[2..].iter().take_while(|b| b.is_ascii_hexdigit()).count();
                let closed = rest.get(2 + digits) == Some(&b'}');
                let code = str::from_utf8(&rest[2..2 + digits.min(6)]).ok();
                let code = code.and_then(|code| u32::from_str_radix(code, 16).ok());
                let is_known = digits <= 6 && code.and_then(char::from_u32).is_some();
                (is_known && closed).then_some(digits + 3)
            }
            _ => None,
        };
        if let Some(length) = length {
            self.at += 1 + length;
            return;
        }
        // The whole character after the backslash, but never the end of the line.
        let continues = |b: &&u8| (**b & 0xC0) == 0x80;
        let length = match rest.first() {
            None | Some(b'\n') => 0,
            Some(_) => 1 + rest[1..].iter().take_while(continues).count(),
        };
        // Of a path with such between its folders one is told.
        let is_told = |fault: &Fault| matches!(fault, Fault::Escape { at } if at.start > start);
        let is_path = rest.first() != Some(&b'u');
        if !is_path || !self.out.faults.last().is_some_and(is_told) {
            self.out.faults.push(Fault::Escape { at: self.at..self.at + 1 + length });
        }
        self.at += 1 + length;
    }

    /// Where the string whose text begins at `start`, and which its line does not end, most likely ends:
    /// before brackets and commas if the line goes on well with them, else with the line, which ends at
    /// the place of the scan.
    fn likely_end(&self, start: usize) -> usize {
        let line = &self.bytes[start..self.at];
        let is_mark = |b: &u8| b"()[]{},".contains(b);
        let mark = line.iter().take(LOOKED_AT).position(is_mark);
        let Some(mark) = mark.filter(|mark| self.goes_on(&line[*mark..])) else { return self.at };
        start + line[..mark].trim_ascii_end().len()
    }

    /// Whether all brackets in the rest of a line close, or are closed, but a last that opens a block.
    fn goes_on(&self, rest: &[u8]) -> bool {
        let rest = rest.trim_ascii_end();
        let mut open: Vec<u8> = self.open.iter().map(|open| self.bytes[*open]).collect();
        let depth = open.len();
        let mut n_brackets = 0;
        for byte in rest {
            match byte {
                b'(' | b'[' | b'{' => open.push(*byte),
                b')' | b']' | b'}' if open.pop().is_none_or(|last| closing(last) != *byte) => {
                    return false;
                }
                b')' | b']' | b'}' => {}
                _ => continue,
            }
            n_brackets += 1;
        }
        let is_block = rest.ends_with(b"{");
        let is_item = n_brackets == 0 && rest == b",";
        open.len() <= depth + usize::from(is_block) && (n_brackets > 0 || is_item)
    }
}
