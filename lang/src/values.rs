//! Values that names had in a load, as text, for editors.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::sync::Arc;

use arrayvec::ArrayVec;
use luxel_core::diag::SourceId;
use luxel_sdk::params::Dimension;

/// A name: the text in which it stands, and its first byte there.
pub(crate) type Place = (SourceId, u32);

/// Names of a statement, by their first byte, with their values.
pub(crate) type Notes = [(u32, Arc<str>)];

/// Names that have their value by what stands elsewhere, as those in the body of a function: with the
/// statement that gave it.
pub(crate) type Elsewhere = BTreeMap<Place, (SourceId, Arc<str>)>;

/// What was noted of statements.
pub(crate) type Layer = BTreeMap<SourceId, Arc<Notes>>;

/// The first value of each `let`, `param` and field of a load, as text.
///
/// It is shared with what is kept of the load: that another statement was evaluated, or stands elsewhere,
/// costs no more than that.
#[derive(Clone, Debug, Default)]
pub struct Values {
    /// Where statements of the root file begin, whose places count from there.
    pub(crate) stmts: Vec<(usize, SourceId)>,
    pub(crate) own: Layers,
    pub(crate) others: Arc<Elsewhere>,
}

impl Values {
    /// The value of the name whose first byte stands there.
    pub fn at(&self, source: SourceId, byte: usize) -> Option<Cow<'_, str>> {
        let (place, byte) = self.in_statement(source, byte);
        let at = u32::try_from(byte).ok()?;
        let elsewhere = || self.others.get(&(place, at)).map(|(_, value)| Cow::Borrowed(&**value));
        self.own.value(place, at).or_else(elsewhere)
    }

    /// A place in the root file as one in its statement.
    fn in_statement(&self, source: SourceId, byte: usize) -> (SourceId, usize) {
        let next = self.stmts.partition_point(|(start, _)| *start <= byte);
        match next.checked_sub(1).filter(|_| source == SourceId(0)) {
            Some(i) => (self.stmts[i].1, byte - self.stmts[i].0),
            None => (source, byte),
        }
    }

    /// Every value, by the text in which its name stands and its first byte there.
    pub fn all(&self) -> BTreeMap<(SourceId, usize), Cow<'_, str>> {
        let starts: BTreeMap<SourceId, usize> =
            self.stmts.iter().map(|(start, id)| (*id, *start)).collect();
        let placed = |source: SourceId, at: u32| {
            let start = starts.get(&source);
            start.map_or((source, at as usize), |start| (SourceId(0), start + at as usize))
        };
        let others = self.others.iter();
        let others = others
            .map(|((source, at), (_, value))| (placed(*source, *at), Cow::Borrowed(&**value)));
        let own = self.stmts.iter().flat_map(|(_, id)| {
            let notes = self.own.of(*id).unwrap_or_default().iter();
            let value = |at: u32| Some((placed(*id, at), self.own.value(*id, at)?));
            notes.filter_map(move |(at, _)| value(*at))
        });
        others.chain(own).collect()
    }
}

/// What was noted of statements by one load after the other: the newest of each counts.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layers {
    notes: Vec<Arc<Layer>>,
    /// Newer than what was noted.
    handed: Arc<HandedOn>,
}

impl Layers {
    /// What was noted of a statement, if it was evaluated; its names may have been handed other values since.
    pub(crate) fn of(&self, statement: SourceId) -> Option<&Notes> {
        self.notes.iter().rev().find_map(|layer| layer.get(&statement)).map(|notes| &**notes)
    }

    /// The value of the name that stands there in a statement.
    fn value(&self, statement: SourceId, at: u32) -> Option<Cow<'_, str>> {
        let notes = self.of(statement)?;
        let i = notes.binary_search_by_key(&at, |note| note.0).ok()?;
        match self.handed.get((statement, at)) {
            Some(shown) => shown.text(),
            None => Some(Cow::Borrowed(&notes[i].1)),
        }
    }

    /// Puts newer ones on top. Each layer has less than half as many as the one below: there are few.
    pub(crate) fn push(&mut self, mut newer: Layer) {
        if newer.is_empty() {
            return;
        }
        if newer.keys().any(|statement| self.handed.concerns(*statement)) {
            self.handed = Arc::new(self.handed.without(&newer));
        }
        while let Some(older) = self.notes.pop_if(|older| newer.len() * 2 > older.len()) {
            let mut both = Layer::clone(&older);
            both.append(&mut newer);
            newer = both;
        }
        self.notes.push(Arc::new(newer));
    }

    /// Gives names other values, as far as something was noted of them.
    pub(crate) fn hand_on(&mut self, newer: Vec<(Place, Shown)>) {
        if !newer.is_empty() {
            self.handed = Arc::new(self.handed.with(newer));
        }
    }
}

/// Values that names got without their statements being evaluated, in order.
#[derive(Debug, Default)]
pub(crate) struct HandedOn(Vec<(Place, Shown)>);

/// A value as it is shown, or that is put into words once it is looked at; or nothing, where a mistake
/// hides it.
#[derive(Clone, Debug)]
pub(crate) enum Shown {
    Text(Arc<str>),
    Later(Unsaid),
    Nothing,
}

impl Shown {
    fn text(&self) -> Option<Cow<'_, str>> {
        match self {
            Self::Text(text) => Some(Cow::Borrowed(text)),
            Self::Later(it) => Some(Cow::Owned((it.say)(&it.numbers, it.measure))),
            Self::Nothing => None,
        }
    }
}

/// Numbers of a dimension, in SI units.
#[derive(Clone, Debug)]
pub(crate) struct Unsaid {
    pub(crate) numbers: ArrayVec<f64, 4>,
    pub(crate) measure: Dimension,
    /// Puts it into words.
    pub(crate) say: fn(&[f64], Dimension) -> String,
}

impl HandedOn {
    fn get(&self, place: Place) -> Option<&Shown> {
        let i = self.0.binary_search_by_key(&place, |(place, _)| *place).ok()?;
        Some(&self.0[i].1)
    }

    /// Whether a name of a statement is among them.
    fn concerns(&self, statement: SourceId) -> bool {
        let first = self.0.partition_point(|((other, _), _)| *other < statement);
        self.0.get(first).is_some_and(|((other, _), _)| *other == statement)
    }

    /// With newer ones.
    fn with(&self, mut newer: Vec<(Place, Shown)>) -> Self {
        newer.sort_by_key(|(place, _)| *place);
        // Where the same is handed on again, nothing older is left.
        let is_of = |((one, _), (other, _)): (&(Place, Shown), &(Place, Shown))| one == other;
        if self.0.len() == newer.len() && self.0.iter().zip(&newer).all(is_of) {
            return Self(newer);
        }
        let mut all: Vec<_> = self.0.iter().cloned().chain(newer).collect();
        // Finds that there are two runs, and keeps the newer of two behind the older.
        all.sort_by_key(|(place, _)| *place);
        all.dedup_by(|next, one| {
            let is_older = next.0 == one.0;
            if is_older {
                std::mem::swap(next, one);
            }
            is_older
        });
        Self(all)
    }

    /// Without those of statements that have been evaluated.
    fn without(&self, newer: &Layer) -> Self {
        let is_older = |((statement, _), _): &&(Place, Shown)| !newer.contains_key(statement);
        Self(self.0.iter().filter(is_older).cloned().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(notes: &[(u32, &[(u32, &str)])]) -> Layer {
        let of = |notes: &[(u32, &str)]| {
            notes.iter().map(|(at, value)| (*at, (*value).into())).collect()
        };
        notes.iter().map(|(id, notes)| (SourceId(*id), of(notes))).collect()
    }

    fn handed(values: &[(u32, u32, &str)]) -> Vec<(Place, Shown)> {
        let one = |(id, at, value): &(u32, u32, &str)| {
            ((SourceId(*id), *at), Shown::Text((*value).into()))
        };
        values.iter().map(one).collect()
    }

    #[test]
    fn of_what_is_noted_and_handed_on_the_newest_counts() {
        let mut layers = Layers::default();
        let all = |layers: &Layers| {
            let value = |id, at| layers.value(SourceId(id), at).map(Cow::into_owned);
            [value(1, 4), value(1, 9), value(2, 4), value(3, 4)].map(Option::unwrap_or_default)
        };
        layers.push(layer(&[(1, &[(4, "a"), (9, "b")]), (2, &[(4, "c")])]));
        assert_eq!(all(&layers), ["a", "b", "c", ""]);
        // The last is of a statement of which nothing was noted.
        layers.hand_on(handed(&[(2, 4, "d"), (1, 4, "e"), (3, 4, "e")]));
        assert_eq!(all(&layers), ["e", "b", "d", ""]);
        layers.hand_on(handed(&[(1, 9, "f"), (1, 4, "f")]));
        assert_eq!(all(&layers), ["f", "f", "d", ""]);
        assert_eq!(layers.handed.0.len(), 4, "what is older is given back");
        layers.push(layer(&[(1, &[(4, "g"), (9, "h")])]));
        assert_eq!(all(&layers), ["g", "h", "d", ""]);
        layers.hand_on(handed(&[(1, 9, "i")]));
        assert_eq!(all(&layers), ["g", "i", "d", ""]);
    }
}
