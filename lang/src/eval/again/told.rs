//! What is wrong after an edit, if that is in the statements that it concerns.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, SourceId, Span};
use luxel_sdk::kind::Kind;

use super::edit::Edit;
use super::made::Told;
use super::plan::{After, Plan, Task};
use super::values::KeptValues;
use super::warn::faults;
use super::{State, in_file, source_of};
use crate::eval::Evaluator;
use crate::eval::names::{Facts, Odd, tell_odd};
use crate::eval::numbered::Firsts;
use crate::eval::resolve::{Around, follows_fn};
use crate::sink::Sink;
use crate::syntax::Name;
use crate::{Budgets, Loaded, ParamInfo};

/// Statements with something wrong about their names that are looked at one by one.
const ODD: usize = 100;

impl State {
    /// What is wrong with the names of statements that are `odd`; `None` if looking at these statements alone
    /// does not tell.
    pub(super) fn odd_names(
        &self,
        (text, edit): (&str, &Edit),
        after: &After<'_>,
        firsts: &Firsts<'_>,
        odd: &[usize],
    ) -> Option<Vec<Diagnostic>> {
        let budgets = &self.settings.budgets;
        let around = Among { text, edit, after, firsts, budgets };
        let mut sink = Sink::new(budgets.diagnostics);
        for i in odd.iter().take(ODD + 1) {
            let (statement, range) = after.get(*i, edit);
            // Of a function it matters what others mention.
            if text[range.clone()].contains("fn") {
                return None;
            }
            let (stmt, _) = statement.read(&text[range.clone()], budgets)?;
            let stmts = std::slice::from_ref(&stmt);
            let facts = Facts::of(&text[range.clone()], stmts);
            let mut found = sink.rest();
            let odd = Odd { i: *i, text: &text[range], stmts, facts: &facts };
            tell_odd(&odd, &around, &mut None, &mut found);
            sink.absorb(found);
        }
        (odd.len() <= ODD && !sink.is_full()).then(|| sink.finish())
    }

    /// A load with mistakes, after which all is kept as it was; `None` if there are too many, or they may
    /// not be all.
    pub(super) fn told(
        &mut self,
        plan: Plan,
        text: Arc<str>,
        (evaluator, found): (Evaluator<'_>, Vec<Vec<Diagnostic>>),
        values: &KeptValues,
    ) -> Option<Loaded> {
        // What is set may be wrong for things that are right, and the other way round.
        if !plan.sets.labels.is_empty() {
            return None;
        }
        let Plan { edit, gone, fresh, tasks, read, names, .. } = plan;
        let after = After::of(self, &gone, &fresh);
        if concerns_others(&after, &tasks, &evaluator) {
            return None;
        }
        let mut sink = Sink::new(self.settings.budgets.diagnostics);
        for found in faults(after.iter()) {
            sink.push(found.clone());
        }
        let now = read.into_iter().zip(gone.start..).map(|(told, i)| (i, told)).collect();
        merge(&after, now, |told| &told.read, &mut sink);
        for found in names {
            sink.push(found);
        }
        let now = tasks.iter().zip(found).filter(|(task, _)| task.is_new);
        let now = now.map(|(task, told)| (task.i, told)).collect();
        merge(&after, now, |told| &told.found, &mut sink);
        if sink.is_full() {
            return None;
        }
        let begun = (0..after.iter().count()).map(|i| {
            let (stmt, range) = after.get(i, &edit);
            (range.start, stmt.id)
        });
        let mut starts = vec![0; self.n_ids + fresh.len()];
        begun.clone().for_each(|(start, id)| starts[id as usize] = start);
        sink.each(&mut |found| found.place(|span| in_file(span, &starts)));
        let mut sources = self.sources.clone();
        sources.replace(SourceId(0), text);
        let param =
            |param: &ParamInfo| ParamInfo { span: in_file(param.span, &starts), ..param.clone() };
        let n_evaluated = tasks.len();
        let loaded = Loaded {
            scene: None,
            rest: None,
            diagnostics: sink.finish(),
            sources,
            params: self.params.iter().map(param).collect(),
            values: self.values_of(begun.map(|(start, id)| (start, source_of(id))), values),
        };
        self.n_evaluated = n_evaluated;
        Some(loaded)
    }
}

/// Tells what is said of each statement now, or was and still is.
fn merge(
    after: &After<'_>,
    mut now: BTreeMap<usize, Vec<Diagnostic>>,
    kept: fn(&Told) -> &Vec<Diagnostic>,
    sink: &mut Sink,
) {
    for (i, stmt) in after.iter().enumerate() {
        let told = match (now.remove(&i), &stmt.made.rare) {
            (Some(told), _) => told,
            (None, Some(rare)) => kept(&rare.told).clone(),
            (None, None) => continue,
        };
        for found in told {
            sink.push(found);
        }
    }
}

/// Whether more may be wrong than with the statements that were evaluated: an expectation is held against
/// the whole scene, what two statements give is told of the second, and a camera may be missing.
fn concerns_others(after: &After<'_>, tasks: &[Task], evaluator: &Evaluator<'_>) -> bool {
    let evaluated: BTreeSet<usize> = tasks.iter().map(|task| task.i).collect();
    let others = after.iter().enumerate().filter(|(i, _)| !evaluated.contains(i));
    let mut given: Vec<Kind> = evaluator.slots.iter().map(|(kind, _)| *kind).collect();
    let mut expects = !evaluator.scene.expectations.is_empty();
    for rare in others.filter_map(|(_, stmt)| stmt.made.rare.as_ref()) {
        given.extend(rare.slots.iter().map(|slot| slot.kind));
        expects |= !rare.expectations.is_empty();
    }
    let (n_given, has_camera) = (given.len(), given.contains(&Kind::Camera));
    given.sort_unstable();
    given.dedup();
    expects || given.len() < n_given || !has_camera
}

/// The names of the statements after an edit.
struct Among<'a> {
    text: &'a str,
    edit: &'a Edit,
    after: &'a After<'a>,
    firsts: &'a Firsts<'a>,
    budgets: &'a Budgets,
}

impl Among<'_> {
    fn span(&self, i: usize, names: fn(&Facts) -> &[Name], text: &str) -> Option<(usize, Span)> {
        let (statement, range) = self.after.get(i, self.edit);
        let part = &self.text[range];
        let (stmt, _) = statement.read(part, self.budgets)?;
        let facts = Facts::of(part, std::slice::from_ref(&stmt));
        names(&facts).iter().find(|name| *name.text == *text).map(|name| (i, name.span))
    }
}

impl Around for Among<'_> {
    fn definer(&self, name: &str) -> Option<(usize, Span)> {
        self.span(self.firsts.definer(name)?, |facts| &facts.defines, name)
    }

    fn labeller(&self, label: &str) -> Option<(usize, Span)> {
        self.span(self.firsts.labeller(label)?, |facts| &facts.labels, label)
    }

    fn before(&self, statement: usize) -> Vec<&str> {
        self.firsts.before(statement)
    }

    fn has_function_before(&self, statement: usize, name: &str) -> bool {
        self.definer(name).is_some_and(|(definer, at)| {
            let (_, range) = self.after.get(definer, self.edit);
            definer < statement && follows_fn(&self.text[range], at)
        })
    }
}
