//! Values that names had in a load, as text, for editors.

use std::collections::BTreeMap;
use std::sync::Arc;

use luxel_core::diag::SourceId;

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
    pub fn at(&self, source: SourceId, byte: usize) -> Option<&str> {
        let (place, byte) = self.in_statement(source, byte);
        let at = u32::try_from(byte).ok()?;
        let notes = self.own.of(place).unwrap_or_default();
        match notes.binary_search_by_key(&at, |note| note.0) {
            Ok(i) => Some(&*notes[i].1),
            Err(_) => self.others.get(&(place, at)).map(|(_, value)| &**value),
        }
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
    pub fn all(&self) -> BTreeMap<(SourceId, usize), &str> {
        let starts: BTreeMap<SourceId, usize> =
            self.stmts.iter().map(|(start, id)| (*id, *start)).collect();
        let placed = |source: SourceId, at: u32| {
            let start = starts.get(&source);
            start.map_or((source, at as usize), |start| (SourceId(0), start + at as usize))
        };
        let others = self.others.iter();
        let others = others.map(|((source, at), (_, value))| (placed(*source, *at), &**value));
        let own = self.stmts.iter().flat_map(|(_, id)| {
            let notes = self.own.of(*id).unwrap_or_default().iter();
            notes.map(|(at, value)| (placed(*id, *at), &**value))
        });
        others.chain(own).collect()
    }
}

/// What was noted of statements by one load after the other: the newest of each counts.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layers(Vec<Arc<Layer>>);

impl Layers {
    /// What was noted of a statement, if it was evaluated.
    pub(crate) fn of(&self, statement: SourceId) -> Option<&Notes> {
        self.0.iter().rev().find_map(|layer| layer.get(&statement)).map(|notes| &**notes)
    }

    /// Puts newer ones on top. Each layer has less than half as many as the one below: there are few.
    pub(crate) fn push(&mut self, mut newer: Layer) {
        if newer.is_empty() {
            return;
        }
        while let Some(older) = self.0.pop_if(|older| newer.len() * 2 > older.len()) {
            let mut both = Layer::clone(&older);
            both.append(&mut newer);
            newer = both;
        }
        self.0.push(Arc::new(newer));
    }
}
