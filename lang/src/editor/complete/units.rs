//! Units that may be written at a place.

use luxel_sdk::params::{Dimension, Param, UNITS, Unit};

use super::super::context::Head;
use super::super::schema::{self, Given};
use super::{Asked, Item, ItemKind};
use crate::eval::types;
use crate::syntax::{Token, TokenKind};

impl Asked<'_> {
    /// Units behind what a unit may stand behind: a number or a closed bracket, or a part of a unit,
    /// as in `5 W/|`.
    pub(super) fn units(&self) -> Option<Vec<Item>> {
        if self.here.is_fresh {
            return None;
        }
        if ends_number(&self.here.before) {
            return Some(self.whole_units());
        }
        let begun = self.begun()?;
        let mut out = self.rest_of(&begun);
        // It may be a quotient after all.
        out.extend(self.values());
        Some(out)
    }

    /// The units that `units { length = | }` may give.
    pub(super) fn units_of_type(&self) -> Vec<Item> {
        let wanted = types::dimension(self.here.text_back(2));
        let fit = UNITS.iter().filter(|(_, unit)| Some(unit.dimension) == wanted);
        fit.map(|(name, unit)| one(name, *unit)).collect()
    }

    /// Units; those that are wanted stand first.
    fn whole_units(&self) -> Vec<Item> {
        let (wanted, param) = self.wanted();
        let whole = param.into_iter().flat_map(written).filter(|unit| unit.contains(['/', '^']));
        let first = whole.map(|unit| Item::new(unit, ItemKind::Unit).rank(0));
        let all = UNITS.iter().map(|(name, unit)| {
            one(name, *unit).rank(if wanted == Some(unit.dimension) { 1 } else { 6 })
        });
        first.chain(all).collect()
    }

    /// What a unit may go on with; what makes it the one that is wanted stands first.
    fn rest_of(&self, begun: &str) -> Vec<Item> {
        let (wanted, param) = self.wanted();
        let rest = |unit: &'static str| unit.strip_prefix(begun).filter(|rest| !rest.is_empty());
        let whole = param.into_iter().flat_map(written).filter_map(rest);
        let whole: Vec<&str> = whole.filter(|rest| rest.contains(['/', '^'])).collect();
        let first = whole.into_iter().map(|rest| Item::new(rest, ItemKind::Unit).rank(0));
        let makes = |name: &str| Unit::parse(&format!("{begun}{name}")).ok();
        let parts = UNITS.iter().filter(|(name, _)| *name != "EV").map(|(name, unit)| {
            let fits = wanted.is_some() && makes(name).map(|made| made.dimension) == wanted;
            one(name, *unit).rank(if fits { 1 } else { 2 })
        });
        first.chain(parts).collect()
    }

    /// What the value at the place is to measure, and the parameter that it is given to.
    fn wanted(&self) -> (Option<Dimension>, Option<&'static Param>) {
        let here = self.here;
        let Some(equals) = here.before.iter().rposition(|token| token.text == "=") else {
            return (None, None);
        };
        let back = |n: usize| equals.checked_sub(n).map_or("", |i| here.before[i].text);
        if back(2) == ":" {
            return (types::dimension(back(1)), None);
        }
        let heads = here.frames.iter().rev().map(|frame| &frame.what);
        let mut objects = heads.filter(|head| matches!(head, Head::Object { .. } | Head::Amend(_)));
        let givens = objects.next().map(|head| schema::givens(self.around, head));
        let mut fitting = givens.into_iter().flatten().filter(|given| given.name() == back(1));
        match fitting.next() {
            Some(Given::Param(param, _)) => (schema::dimension(param), Some(param)),
            _ => (None, None),
        }
    }

    /// The unit that is begun directly before the place, up to its last `/` or `*`.
    fn begun(&self) -> Option<String> {
        let all = &self.here.before;
        let (mut first, mut start) = (all.len(), self.here.word.start);
        while let Some(token) = first.checked_sub(1).map(|i| &all[i])
            && token.end() == start
            && is_part(&all[..first])
        {
            (first, start) = (first - 1, token.start);
        }
        let last = all.last().filter(|last| matches!(last.text, "/" | "*"))?;
        all.get(first).filter(|token| token.kind == TokenKind::Word)?;
        let begun = &self.here.document.text()[start..last.end()];
        let known = || Unit::parse(begun.trim_end_matches(['/', '*'])).is_ok();
        (ends_number(&all[..first]) && known()).then(|| begun.to_owned())
    }
}

/// Whether the last token may be part of a unit: a name, a sign, or a power.
fn is_part(tokens: &[Token<'_>]) -> bool {
    match tokens {
        [.., before, last] if last.kind == TokenKind::Number => {
            matches!(before.text, "^" | "-")
        }
        [.., last] => last.kind == TokenKind::Word || matches!(last.text, "/" | "*" | "^" | "-"),
        [] => false,
    }
}

/// Whether tokens end in a number, or in a bracket that closes behind one.
fn ends_number(tokens: &[Token<'_>]) -> bool {
    let Some((last, rest)) = tokens.split_last() else { return false };
    last.kind == TokenKind::Number || last.kind == TokenKind::Table || {
        let inside = rest.last().map_or("", |token| token.text);
        matches!(last.text, ")" | "]") && inside.starts_with(|c: char| c.is_ascii_digit())
    }
}

/// The units of a parameter, as its schema writes them.
fn written(param: &'static Param) -> impl Iterator<Item = &'static str> {
    param.unit.split('|')
}

fn one(name: &str, unit: Unit) -> Item {
    Item::new(name, ItemKind::Unit).detail(unit.dimension.name())
}
