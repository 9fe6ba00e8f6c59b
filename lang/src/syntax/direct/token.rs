//! Numbers, units, strings and tables.

use std::ops::Range;
use std::sync::Arc;

use luxel_sdk::params::Unit;

use super::Reader;
use super::cursor::{Cursor, is_in_word};
use super::expr::Place;
use super::head::is_keyword;
use crate::syntax::make::{self, Inside};
use crate::syntax::number;
use crate::syntax::tree::{ExprNode, Form, Name};

/// The units that may stand after `/` or `*`.
const KNOWN: [&str; 30] = [
    "km", "cm", "mm", "um", "µm", "nm", "inch", "ft", "sr", "ms", "us", "deg", "rad", "kW", "mW",
    "W", "klx", "lx", "klm", "lm", "kcd", "cd", "nit", "kg", "K", "J", "Hz", "m", "s", "g",
];

impl Cursor<'_> {
    /// Takes digits, with `_` between them.
    fn digits(&mut self) -> bool {
        let start = self.at;
        self.take_while(|byte| byte.is_ascii_digit());
        while self.at > start
            && self.peek() == Some(b'_')
            && self.ahead(1).is_some_and(|b| b.is_ascii_digit())
        {
            self.at += 1;
            self.take_while(|byte| byte.is_ascii_digit());
        }
        self.at > start
    }

    /// Takes a number without sign.
    fn unsigned(&mut self) -> bool {
        let whole = self.digits();
        let has_part = self.ahead(1).is_some_and(|byte| byte.is_ascii_digit());
        if has_part && self.takes(b'.') {
            self.digits();
        } else if !whole {
            return false;
        }
        self.exponent();
        true
    }

    fn exponent(&mut self) {
        let start = self.at;
        if !self.takes(b'e') && !self.takes(b'E') {
            return;
        }
        let _sign = self.takes(b'+') || self.takes(b'-');
        let digits = self.at;
        self.take_while(|byte| byte.is_ascii_digit());
        if self.at == digits {
            self.at = start;
        }
    }

    /// Takes a number with or without sign; gives what it is.
    pub(super) fn number(&mut self) -> Option<f64> {
        let start = self.at;
        let _sign = self.takes(b'-') || self.takes(b'+');
        let is_number = self.unsigned();
        let number = is_number.then(|| number::parse(self.since(start).as_bytes())).flatten();
        number.filter(|number| number.is_finite())
    }

    /// Takes a power, as the `^2` of a unit.
    fn power(&mut self) {
        let length = match self.rest() {
            [b'^', b'-', digit, ..] if digit.is_ascii_digit() => 3,
            [b'^', digit, ..] if digit.is_ascii_digit() => 2,
            _ => return,
        };
        if !self.ahead(length).is_some_and(|next| next.is_ascii_digit() || next == b'.') {
            self.at += length;
        }
    }

    /// Takes the name with which a unit begins: any word that is none of the language.
    fn unit_name(&mut self) -> bool {
        let start = self.at;
        match self.rest() {
            [first, ..] if first.is_ascii_alphabetic() => {}
            [0xC2, 0xB5, ..] => self.at += 2,
            _ => return false,
        }
        self.take_while(is_in_word);
        !is_keyword(self.since(start))
    }

    /// Takes what a unit is multiplied or divided by.
    fn unit_factor(&mut self) -> bool {
        if !self.takes(b'/') && !self.takes(b'*') {
            return false;
        }
        let start = self.at;
        if self.rest().starts_with("µ".as_bytes()) {
            self.at += 2;
        }
        self.take_while(|byte| byte.is_ascii_alphabetic() || byte == b'_');
        if !KNOWN.contains(&self.since(start)) {
            return false;
        }
        self.power();
        !self.peek().is_some_and(is_in_word)
    }

    /// Takes a string; gives where its body stands.
    pub(super) fn quoted(&mut self) -> Option<Range<usize>> {
        let start = self.at + 1;
        self.takes(b'"').then_some(())?;
        loop {
            self.take_while(|byte| !matches!(byte, b'"' | b'\\' | b'\n'));
            match self.rest() {
                [b'"', ..] => {
                    self.at += 1;
                    return Some(start..self.at - 1);
                }
                [b'\\', b'"' | b'\\' | b'n' | b't', ..] => self.at += 2,
                [b'\\', b'u', b'{', code @ ..] => {
                    let digits = code.iter().take_while(|b| b.is_ascii_hexdigit()).count();
                    let ends = code.get(digits) == Some(&b'}');
                    ((1..=6).contains(&digits) && ends).then_some(())?;
                    self.at += digits + 4;
                }
                _ => return None,
            }
        }
    }
}

impl Reader<'_> {
    /// A string that must stand here.
    pub(super) fn string(&mut self) -> Option<Name> {
        self.cursor.skip();
        let start = self.cursor.at;
        let body = self.cursor.quoted()?;
        if body.len() > self.budgets.string {
            return None;
        }
        Some(Name { text: make::unescape(self.cursor.slice(body)), span: self.span(start) })
    }

    /// A number with its unit.
    pub(super) fn quantity(&mut self) -> Option<ExprNode> {
        let number = self.cursor.number()?;
        self.with_unit(|unit| ExprNode::Number(number, unit))
    }

    /// What `make` makes of the unit that stands after a number or bracket on its line, if one does.
    pub(super) fn with_unit(
        &mut self,
        make: impl FnOnce(Option<Arc<Unit>>) -> ExprNode,
    ) -> Option<ExprNode> {
        let cursor = &mut self.cursor;
        let before = cursor.at;
        cursor.blanks();
        let start = cursor.at;
        if !cursor.unit_name() {
            cursor.at = before;
            return Some(make(None));
        }
        cursor.power();
        let mut end = cursor.at;
        while cursor.unit_factor() {
            end = cursor.at;
        }
        cursor.at = end;
        let text = cursor.since(start);
        self.words.unit(text).map(|unit| make(Some(unit)))
    }

    /// What stands between brackets up to `close`, and whether a comma stands after the last.
    pub(super) fn inside(&mut self, close: u8) -> Option<(Inside, bool)> {
        self.cursor.skip();
        let literals = self.literals(close);
        if self.numbers.len() > self.budgets.list {
            return None;
        }
        literals.or_else(|| {
            let (items, comma) = self.listed(close, |reader| reader.expr(Place::Value))?;
            Some((Inside::Items(items), comma))
        })
    }

    /// Literal numbers alone; takes nothing if something else is among them.
    fn literals(&mut self, close: u8) -> Option<(Inside, bool)> {
        let start = self.cursor.at;
        self.numbers.clear();
        self.most_literals(close);
        while let Some(number) = self.cursor.number() {
            self.numbers.push(number);
            let span = self.span(start);
            self.cursor.skip();
            let comma = self.cursor.takes(b',');
            self.cursor.skip();
            if self.cursor.takes(close) {
                return Some((Inside::Numbers(self.numbers[..].into(), span), comma));
            }
            if !comma || self.numbers.len() > self.budgets.list {
                break;
            }
        }
        self.cursor.at = start;
        None
    }

    /// `#[ … ]`
    pub(super) fn table(&mut self) -> Option<ExprNode> {
        let rest = self.cursor.rest();
        let length = rest.strip_prefix(b"#[").and_then(|inside| memchr::memchr(b']', inside))?;
        let start = self.cursor.at + 2;
        self.cursor.at = start + length + 1;
        let inside = self.cursor.slice(start..start + length);
        let data = number::parse_many(inside, self.budgets.list).ok()?;
        if data.len() > self.budgets.list {
            return None;
        }
        let data = data.into();
        self.with_unit(|unit| ExprNode::Numbers { data, unit, form: Form::List })
    }
}
