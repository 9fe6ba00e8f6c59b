//! What is told of statements, kept with them.
//!
//! Known are only those whose places all lie in the statement that they are told of.

use std::ops::{Range, RangeInclusive};

use luxel_core::diag::{Diagnostic, SourceId, Span};

use super::made::{Made, Rare, Told};
use super::plan::{After, Plan, Task};
use super::record::{Record, in_statement};
use super::{State, Statement, in_file, source_of};
use crate::sink::Sink;

/// The same with other places.
fn placed(told: &Diagnostic, place: impl Fn(Span) -> Span) -> Diagnostic {
    let mut told = told.clone();
    told.place(place);
    told
}

/// What does not close in one statement, after which reading goes on with the next: a text, an escape, a
/// bracket, or one that another bracket closes. What closes nothing may belong to a statement further up.
const WITHIN: [&str; 4] = ["E0005", "E0007", UNCLOSED, "E0009"];
const UNCLOSED: &str = "E0008";
/// Codes of all that does not close, or closes nothing.
const FAULTS: RangeInclusive<&str> = "E0005"..="E0011";

/// What does not close in statements.
pub(super) fn faults<'a>(
    stmts: impl IntoIterator<Item = &'a Statement>,
) -> impl Iterator<Item = &'a Diagnostic> {
    let rare = stmts.into_iter().filter_map(|stmt| stmt.made.rare.as_ref());
    rare.flat_map(|rare| &rare.told.faults)
}

/// Whether these faults, in order, are each one of a statement for itself. What stands behind a bracket that
/// never closes is told of on its own.
pub(super) fn are_within<'a>(faults: impl IntoIterator<Item = &'a Diagnostic>) -> bool {
    let mut is_last = false;
    faults.into_iter().all(|fault| {
        let is_one = !is_last && WITHIN.contains(&fault.code);
        is_last = fault.code == UNCLOSED;
        is_one
    })
}

/// A fault by places in the statement with this number and these bytes, if all of it lies there.
pub(super) fn fault_of(fault: &Diagnostic, id: u32, of: &Range<usize>) -> Option<Diagnostic> {
    let fixes = fault.fixes.iter().map(|fix| fix.span);
    let mut spans = fault.labels.iter().map(|label| label.span).chain(fixes);
    let is_there = |span: Span| {
        let at = span.range();
        span.source == SourceId(0) && of.start <= at.start && at.end <= of.end
    };
    let place = |span: Span| {
        let at = span.range();
        Span::new(source_of(id), at.start - of.start, at.end - of.start)
    };
    spans.all(is_there).then(|| placed(fault, place))
}

/// Whether it concerns nothing but the statement with this number.
fn is_of(told: &Diagnostic, id: u32) -> bool {
    let fixes = told.fixes.iter().map(|fix| fix.span);
    let mut spans = told.labels.iter().map(|label| label.span).chain(fixes);
    !told.labels.is_empty() && spans.all(|span| span.source == source_of(id))
}

impl Record {
    /// Keeps with each statement what is said of it; `None` if something is said of several.
    pub(super) fn warn(&mut self, sink: &Sink, ranges: &[Range<usize>]) -> Option<()> {
        let (told, found) =
            sink.kept().split_at_checked(self.n_read).filter(|_| sink.is_whole())?;
        let (read, _) = told.split_at_checked(self.n_written)?;
        let place = |span: Span| in_statement(span, ranges);
        for told in read {
            let at = told.span()?.range();
            let i = ranges.partition_point(|range| range.start <= at.start).checked_sub(1)?;
            // Where something is missing at the end of a statement, the next one begins.
            if at.is_empty() && at.start == ranges[i].start {
                return None;
            }
            let (cut, stmt) = (&self.cuts[i], &mut self.stmts[i]);
            if cut.mend.is_some() {
                return None;
            }
            if cut.faulty && FAULTS.contains(&told.code) {
                let fault = fault_of(told, stmt.id, &cut.range)?;
                stmt.made.told_mut().faults.push(fault);
                continue;
            }
            let told = placed(told, place);
            is_of(&told, stmt.id).then(|| stmt.made.told_mut().read.push(told))?;
        }
        if !are_within(faults(&self.stmts)) {
            return None;
        }
        let mut found = found.iter();
        for stmt in &mut self.stmts {
            let n_told = stmt.made.rare.as_ref().map_or(0, |rare| rare.n_told);
            for told in found.by_ref().take(n_told) {
                let told = placed(told, place);
                is_of(&told, stmt.id).then(|| stmt.made.told_mut().found.push(told))?;
            }
        }
        found.next().is_none().then_some(())
    }
}

impl Plan {
    /// Whether something is wrong with what is written or with names.
    pub(super) fn is_wrong(&self) -> bool {
        let mut told = self.read.iter().flatten().chain(&self.names);
        let is_faulty = faults(&self.fresh).next().is_some();
        self.is_wrong_beside || is_faulty || told.any(Diagnostic::is_error)
    }
}

impl Told {
    /// Whether one of them is a mistake, of how the statement is written if it is evaluated again.
    fn is_wrong(&self, is_evaluated: bool) -> bool {
        let found = if is_evaluated { &[] } else { &self.found[..] };
        !self.faults.is_empty() || self.read.iter().chain(found).any(Diagnostic::is_error)
    }
}

impl State {
    /// Whether a statement that is as it was has a mistake, if these are evaluated.
    pub(super) fn is_wrong_beside(&self, after: &After<'_>, tasks: &[Task]) -> bool {
        let mut new = tasks.iter().filter(|task| task.is_new).map(|task| task.i).peekable();
        let mut is_wrong = |(i, stmt): (usize, &Statement)| {
            let is_evaluated = new.next_if_eq(&i).is_some();
            let told = stmt.made.rare.as_ref().map(|rare| &rare.told);
            told.is_some_and(|told| told.is_wrong(is_evaluated))
        };
        self.is_wrong && after.iter().enumerate().any(&mut is_wrong)
    }
}

/// All warnings, by places in the file: first of how it is written.
pub(super) fn warnings(rare: &[&Rare], starts: &[usize]) -> Vec<Diagnostic> {
    let read = rare.iter().map(|rare| &rare.told.read);
    let all = read.chain(rare.iter().map(|rare| &rare.told.found)).flatten();
    all.map(|told| placed(told, |span| in_file(span, starts))).collect()
}

impl State {
    /// Keeps what is said of the statements that were evaluated; `None` if it is said of others too.
    pub(super) fn warn(
        &self,
        plan: &Plan,
        made: &mut [Made],
        found: Vec<Vec<Diagnostic>>,
    ) -> Option<()> {
        for ((task, made), found) in plan.tasks.iter().zip(made).zip(found) {
            if !task.is_new {
                continue;
            }
            let (id, read) = if let Some(old) = plan.old(task.i) {
                let Statement { id, made, .. } = &self.stmts[old];
                let read = made.rare.as_ref().map(|rare| rare.told.read.clone());
                (*id, read.unwrap_or_default())
            } else {
                let k = task.i - plan.gone.start;
                (plan.fresh[k].id, plan.read[k].clone())
            };
            if !read.iter().chain(&found).all(|told| is_of(told, id)) {
                return None;
            }
            if !read.is_empty() || !found.is_empty() {
                *made.told_mut() = Told { faults: vec![], read, found };
            }
        }
        Some(())
    }
}
