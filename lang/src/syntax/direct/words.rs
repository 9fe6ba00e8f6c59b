//! Words that were met before, so that a name which stands ten thousand times is held once.

use std::sync::Arc;

/// Words that are kept: a later one takes the place of another that falls on it.
const KEPT: usize = 256;

/// The last words that were met.
#[derive(Debug, Default)]
pub(in crate::syntax) struct Words(Vec<Option<Arc<str>>>);

impl Words {
    /// The word, shared with where it was met before.
    pub(super) fn get(&mut self, word: &str) -> Arc<str> {
        if self.0.is_empty() {
            self.0.resize(KEPT, None);
        }
        let mix = |hash: usize, byte: &u8| hash.wrapping_mul(31).wrapping_add(usize::from(*byte));
        let hash = word.as_bytes().iter().fold(word.len(), mix);
        let place = &mut self.0[(hash ^ hash >> 8) % KEPT];
        match place {
            Some(kept) if **kept == *word => kept.clone(),
            _ => place.insert(word.into()).clone(),
        }
    }
}
