//! Work that goes from class to class: a line of progress, and Ctrl-C between two of them.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit::Failure;
use crate::interrupt::Guard;
use crate::isolate::Beat;
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
    /// A process that tells another how far it has come tells nobody else.
    ///
    /// # Errors
    /// If the system refuses to tell of Ctrl-C.
    pub(super) fn new(beat: &Beat) -> Result<Self, Failure> {
        let stop = Arc::new(AtomicBool::new(false));
        let stopping = stop.clone();
        let alone = beat.is_silent();
        let interrupt = Guard::default().on_ctrl_c(move || {
            stopping.store(true, Ordering::Relaxed);
            if alone {
                let told = "interrupted: this class is judged to its end; Ctrl-C again gives it up";
                report::aside(told);
            }
        })?;
        beat.on_stop(interrupt);
        let steps = if alone { Steps::new() } else { Steps::hidden() };
        Ok(Self { stop, steps, begun: 0, total: 0 })
    }

    /// A class, by its kind and name, is next, unless the work was interrupted.
    pub(super) fn next(&mut self, what: &str, done: usize, total: usize) -> ControlFlow<()> {
        self.total = total;
        if self.stop.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        self.begun = done + 1;
        self.steps.next(done, total, what);
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
