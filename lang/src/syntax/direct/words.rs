//! Words and units that were met before, so that what stands ten thousand times is held once.

use std::sync::Arc;

use luxel_sdk::params::Unit;

/// Words that are kept: a later one takes the place of another that falls on it.
const KEPT: usize = 256;

/// Units that are kept.
const UNITS: usize = 16;

/// The last words that were met, and the first units.
#[derive(Debug, Default)]
pub(in crate::syntax) struct Words {
    words: Vec<Option<Arc<str>>>,
    units: Vec<(Box<str>, Arc<Unit>)>,
}

impl Words {
    /// The word, shared with where it was met before.
    pub(super) fn get(&mut self, word: &str) -> Arc<str> {
        if self.words.is_empty() {
            self.words.resize(KEPT, None);
        }
        let mix = |hash: usize, byte: &u8| hash.wrapping_mul(31).wrapping_add(usize::from(*byte));
        let hash = word.as_bytes().iter().fold(word.len(), mix);
        let place = &mut self.words[(hash ^ hash >> 8) % KEPT];
        match place {
            Some(kept) if **kept == *word => kept.clone(),
            _ => place.insert(word.into()).clone(),
        }
    }

    /// The unit that a text names, if it is one.
    pub(super) fn unit(&mut self, text: &str) -> Option<Arc<Unit>> {
        if let Some((_, unit)) = self.units.iter().find(|(known, _)| **known == *text) {
            return Some(unit.clone());
        }
        let unit = Arc::new(Unit::parse(text).ok()?);
        if self.units.len() < UNITS {
            self.units.push((text.into(), unit.clone()));
        }
        Some(unit)
    }
}
