//! How the building of trees is followed and stopped from another thread.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Primitives of one task of a pass over many, between two looks at the watch: far below a
/// millisecond's work.
pub(super) const STRIDE: usize = 1 << 14;

/// What is being built, and how much of it is done.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Standing {
    /// A name for people; empty before anything is built.
    pub what: String,
    /// What is counted, in the plural.
    pub unit: &'static str,
    /// So many are in their place in the tree.
    pub done: u64,
    /// Of so many.
    pub total: u64,
}

/// How a build is followed and stopped from another thread. It changes no bit of what is built.
///
/// Trees are built one after another: the standing is that of the last one begun.
#[derive(Debug, Default)]
pub struct Watch {
    cancelled: Arc<AtomicBool>,
    standing: Mutex<Standing>,
    #[cfg(test)]
    pub(super) looks: Looks,
}

impl Watch {
    /// Asks for an end; there is no way back.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// Set once an end is asked for: for whoever knows nothing of trees.
    pub fn flag(&self) -> Arc<AtomicBool> {
        self.cancelled.clone()
    }

    /// Whether an end was asked for.
    pub fn is_cancelled(&self) -> bool {
        #[cfg(test)]
        self.looks.count(self);
        self.cancelled.load(Ordering::Relaxed)
    }

    /// The same, asked for each primitive: tests do not count this.
    pub(crate) fn is_over(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Items, until an end is asked for.
    pub(crate) fn until<I: IntoIterator>(&self, items: I) -> impl Iterator<Item = I::Item> {
        items.into_iter().take_while(|_| !self.is_over())
    }

    /// How far the build has come.
    pub fn standing(&self) -> Standing {
        self.lock().clone()
    }

    /// The next tree is that of this.
    pub(crate) fn name(&self, what: &str) {
        *self.lock() = Standing { what: what.to_owned(), ..Standing::default() };
    }

    /// A tree over so many is begun.
    pub(super) fn begin(&self, total: usize, unit: &'static str) {
        let mut standing = self.lock();
        (standing.done, standing.total, standing.unit) = (0, total as u64, unit);
    }

    /// So many more are in their place.
    pub(super) fn add(&self, n: usize) {
        self.lock().done += n as u64;
    }

    fn lock(&self) -> MutexGuard<'_, Standing> {
        self.standing.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Writes down at each look how much was done, and cancels at a look of choice.
#[cfg(test)]
#[derive(Debug, Default)]
pub(super) struct Looks {
    pub(super) seen: Mutex<Vec<u64>>,
    /// Cancels at this look; 0 for never.
    pub(super) last: usize,
}

#[cfg(test)]
impl Looks {
    fn count(&self, watch: &Watch) {
        let mut seen = self.seen.lock().unwrap();
        seen.push(watch.standing().done);
        if seen.len() == self.last {
            watch.cancel();
        }
    }
}
