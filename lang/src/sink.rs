//! Where diagnostics are gathered: each once, up to a limit.

use std::collections::HashSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use luxel_core::diag::{Diagnostic, Severity, Span};

/// Characters of one line that is told: a name may be as long as a file.
const LONGEST: usize = 4000;

/// Cuts a line that nobody reads to its end.
fn shorten(line: &mut String) {
    if let Some((end, _)) = line.char_indices().nth(LONGEST) {
        line.truncate(end);
        line.push('…');
    }
}

/// Diagnostics of one load, in the order in which they were found.
#[derive(Clone, Debug)]
pub(crate) struct Sink {
    list: Vec<Diagnostic>,
    seen: HashSet<(&'static str, Option<Span>)>,
    limit: usize,
    errors: usize,
    /// Errors and warnings of the list: each have the limit for themselves.
    kept: [usize; 2],
    /// Those that are not in it.
    dropped: [usize; 2],
    stop: Option<Arc<AtomicBool>>,
}

impl Sink {
    /// Keeps at most `limit` errors, and as many warnings.
    pub(crate) fn new(limit: usize) -> Self {
        let (list, seen) = (vec![], HashSet::new());
        Self { list, seen, limit, errors: 0, kept: [0; 2], dropped: [0; 2], stop: None }
    }

    /// The same, full as soon as `stop` is set.
    pub(crate) fn until(self, stop: Option<Arc<AtomicBool>>) -> Self {
        Self { stop, ..self }
    }

    /// What tells it to stop.
    pub(crate) fn stop(&self) -> Option<Arc<AtomicBool>> {
        self.stop.clone()
    }

    /// Whether it was told to stop, for others to ask.
    pub(crate) fn over(&self) -> impl Fn() -> bool + Sync + 'static {
        let stop = self.stop();
        move || is_set(stop.as_deref())
    }

    /// Whether it was told to stop.
    pub(crate) fn is_stopped(&self) -> bool {
        is_set(self.stop.as_deref())
    }

    /// Keeps a diagnostic, unless the same code was told of the same place: a loop makes each
    /// mistake once. Whether it was new.
    pub(crate) fn push(&mut self, mut diagnostic: Diagnostic) -> bool {
        if !self.seen.insert((diagnostic.code, diagnostic.span())) {
            return false;
        }
        self.errors += usize::from(diagnostic.is_error());
        let sort = usize::from(!diagnostic.is_error());
        if self.kept[sort] < self.limit {
            self.kept[sort] += 1;
            std::iter::once(&mut diagnostic.message).chain(&mut diagnostic.help).for_each(shorten);
            self.list.push(diagnostic);
        } else {
            self.dropped[sort] += 1;
        }
        true
    }

    /// An empty one of the same kind, for a part of the text.
    pub(crate) fn like(&self) -> Self {
        Self::new(self.limit).until(self.stop.clone())
    }

    /// An empty one for a part of which it keeps all that the other one keeps.
    pub(crate) fn rest(&self) -> Self {
        Self::new(self.limit - self.kept[0]).until(self.stop.clone())
    }

    /// Takes out what is kept and not wanted.
    pub(crate) fn retain(&mut self, is_wanted: &dyn Fn(&Diagnostic) -> bool) {
        let before = self.n_errors_kept();
        self.list.retain(|found| is_wanted(found));
        self.errors -= before - self.n_errors_kept();
    }

    fn n_errors_kept(&self) -> usize {
        self.list.iter().filter(|found| found.is_error()).count()
    }

    /// Changes each diagnostic that is kept.
    pub(crate) fn each(&mut self, change: &mut dyn FnMut(&mut Diagnostic)) {
        self.list.iter_mut().for_each(change);
    }

    /// Counts errors that it would not keep.
    pub(crate) fn count(&mut self, errors: usize) {
        self.errors += errors;
        self.dropped[0] += errors;
    }

    /// Takes in what was told of a part.
    pub(crate) fn absorb(&mut self, part: Self) {
        self.errors += part.errors - part.n_errors_kept();
        self.dropped[0] += part.dropped[0];
        self.dropped[1] += part.dropped[1];
        for found in part.list {
            self.push(found);
        }
    }

    /// Whether an error is kept whose code begins so.
    pub(crate) fn tells(&self, code: &str) -> bool {
        self.list.iter().any(|found| found.is_error() && found.code.starts_with(code))
    }

    /// What is kept of what was told so far.
    pub(crate) fn kept(&self) -> &[Diagnostic] {
        &self.list
    }

    /// The same, taken out: it is not told again.
    pub(crate) fn take(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.list)
    }

    /// Whether all that was told is kept.
    pub(crate) fn is_whole(&self) -> bool {
        self.dropped == [0; 2]
    }

    /// How many errors there were, dropped ones included.
    pub(crate) fn errors(&self) -> usize {
        self.errors
    }

    /// Whether no more errors are kept: going on is of no use. Warnings end nothing.
    pub(crate) fn is_full(&self) -> bool {
        self.kept[0] >= self.limit || self.is_stopped()
    }

    /// The diagnostics; the last ones say how many were dropped.
    pub(crate) fn finish(mut self) -> Vec<Diagnostic> {
        let [errors, warnings] = self.dropped;
        if errors > 0 {
            let message = format!("{errors} more mistakes are not shown");
            self.list.push(Diagnostic::unplaced("E0508", message));
        }
        if warnings > 0 {
            let message = format!("{warnings} more warnings are not shown");
            let told = Diagnostic::unplaced("E0508", message);
            self.list.push(Diagnostic { severity: Severity::Warning, ..told });
        }
        self.list
    }
}
fn is_set(stop: Option<&AtomicBool>) -> bool {
    stop.is_some_and(|stop| stop.load(Ordering::Relaxed))
}
