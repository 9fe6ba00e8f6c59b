//! What became of an object from a library: whether it failed, and what it said.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// Counts the failures of a session's objects: who renders looks at it, and ends if one is its own.
#[derive(Clone, Debug, Default)]
pub struct Alarm(Arc<AtomicU64>);

impl Alarm {
    /// How often an object has failed so far. Of each of them its watch tells.
    pub fn count(&self) -> u64 {
        self.0.load(Ordering::Acquire)
    }
}

/// One object's watch. An object that failed once is not called again.
#[derive(Debug)]
pub struct Watch {
    /// The object's class and origin, as messages name it.
    who: String,
    failed: AtomicBool,
    told: OnceLock<String>,
    alarm: Alarm,
}

impl Watch {
    pub(crate) fn new(who: String, alarm: Alarm) -> Self {
        Self { who, failed: AtomicBool::new(false), told: OnceLock::new(), alarm }
    }

    /// The object has failed: raises the alarm. What it says first counts.
    pub(super) fn fail(&self, told: &str) {
        let _ = self.told.set(format!("{} {told}", self.who));
        self.failed.store(true, Ordering::Relaxed);
        self.alarm.0.fetch_add(1, Ordering::Release);
    }

    /// Whether it has failed.
    #[inline(always)]
    pub fn has_failed(&self) -> bool {
        self.failed.load(Ordering::Relaxed)
    }

    /// Who failed and how.
    pub fn told(&self) -> Option<String> {
        self.told.get().cloned()
    }
}
