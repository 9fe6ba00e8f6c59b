//! Work that goes from class to class: a line of progress, and Ctrl-C between two of them.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use luxel_sdk::abi::Class;

use crate::exit::Failure;
use crate::interrupt::Guard;
use crate::progress::Steps;
use crate::report;

/// How far the work has come.
pub(super) struct Course {
    stop: Arc<AtomicBool>,
    steps: Steps,
    /// Classes that were begun.
    pub(super) begun: usize,
    /// Classes that were to be.
    pub(super) total: usize,
}

impl Course {
    /// # Errors
    /// If the system refuses to tell of Ctrl-C.
    pub(super) fn new() -> Result<Self, Failure> {
        let stop = Arc::new(AtomicBool::new(false));
        let stopping = stop.clone();
        Guard::default().on_ctrl_c(move || {
            stopping.store(true, Ordering::Relaxed);
            report::aside("interrupted: this class is judged to its end; Ctrl-C again gives it up");
        })?;
        Ok(Self { stop, steps: Steps::new(), begun: 0, total: 0 })
    }

    /// A class is next, unless the work was interrupted.
    pub(super) fn next(&mut self, class: &Class, done: usize, total: usize) -> ControlFlow<()> {
        self.total = total;
        if self.stop.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        self.begun = done + 1;
        self.steps.next(done, total, &format!("{class:?}"));
        ControlFlow::Continue(())
    }

    /// Whether no class was left out.
    pub(super) fn is_complete(&self) -> bool {
        self.begun == self.total
    }

    pub(super) fn seconds(&self) -> f64 {
        self.steps.seconds()
    }
}
