//! What is told of statements, kept with them.
//!
//! Known are only those whose places all lie in the statement that they are told of.

use std::ops::Range;

use luxel_core::diag::{Diagnostic, Span};

use super::made::{Made, Told};
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
            let at = told.span()?.range().start;
            let i = ranges.partition_point(|range| range.start <= at).checked_sub(1)?;
            let (told, stmt) = (placed(told, place), &mut self.stmts[i]);
            is_of(&told, stmt.id).then(|| stmt.made.told_mut().read.push(told))?;
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
        self.is_wrong_beside || told.any(Diagnostic::is_error)
    }
}

impl Told {
    /// Whether one of them is a mistake, of how the statement is written if it is evaluated again.
    fn is_wrong(&self, is_evaluated: bool) -> bool {
        let found = if is_evaluated { &[] } else { &self.found[..] };
        self.read.iter().chain(found).any(Diagnostic::is_error)
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
                *made.told_mut() = Told { read, found };
            }
        }
        Some(())
    }

    /// All warnings, by places in the file: first of how it is written.
    pub(super) fn warnings(&self, starts: &[usize]) -> Vec<Diagnostic> {
        let rare = self.stmts.iter().filter_map(|stmt| stmt.made.rare.as_ref());
        let (read, found): (Vec<_>, Vec<_>) =
            rare.map(|rare| (&rare.told.read, &rare.told.found)).unzip();
        let all = read.into_iter().chain(found).flatten();
        all.map(|told| placed(told, |span| in_file(span, starts))).collect()
    }
}
