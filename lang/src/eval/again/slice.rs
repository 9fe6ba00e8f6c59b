//! Evaluation of some statements of a file, and what of it takes the place of what was kept.

use std::rc::Rc;
use std::sync::Arc;

use luxel_core::diag::Diagnostic;
use luxel_core::files::Files;
use luxel_core::registry::Registry;
use luxel_sdk::params::leave;

use super::handed::Fitted;
use super::made::{Cost, Made};
use super::plan::{After, Plan, Task};
use super::{State, Statement, source_of};
use crate::eval::env::{Env, File};
use crate::eval::exec::{Body, Place};
use crate::eval::note::Noting;
use crate::eval::resolve::defines;
use crate::eval::value::Value;
use crate::eval::{Evaluator, OpenGroup};
use crate::syntax::{Name, Tree, read_piece};
use crate::{Loaded, Settings};

/// A number that nothing has.
const NONE: u32 = u32::MAX;

/// How many statements may come to another number of things than before: for each, all that stand behind
/// it are moved.
const MOVED: usize = 8;

/// What the statements of a plan came to.
struct Evaluated {
    made: Vec<Made>,
    /// What is told of each.
    found: Vec<Vec<Diagnostic>>,
    fitted: Fitted,
}

impl State {
    /// The load that follows an edit; `None` if it cannot go on from this one, which stays as it is or
    /// is of the new text.
    pub(super) fn again(
        &mut self,
        files: &dyn Files,
        registry: &Registry,
        settings: &Settings,
    ) -> Option<Loaded> {
        if !self.asked.are_answered_alike(files) || self.is_worn() {
            return None;
        }
        let bytes = files.read(&self.path).ok()?;
        let budgets = &self.settings.budgets;
        let n_bytes = self.other_bytes.saturating_add(bytes.len());
        if bytes.len() > budgets.file_bytes || n_bytes > budgets.total_bytes {
            return None;
        }
        let text: Arc<str> = str::from_utf8(&bytes).ok()?.into();
        let mut evaluator = Evaluator::new(files, registry, settings, usize::MAX);
        let is_over = evaluator.sink.over();
        let plan = self.plan(&text, &is_over)?;
        let evaluated = self.evaluate(&plan, &text, &mut evaluator);
        let Some(Evaluated { mut made, found, fitted }) = evaluated else {
            if is_over() {
                leave((plan, evaluator.scene));
            }
            return None;
        };
        let before = Cost::of(&evaluator);
        if !self.set_again(&plan, &mut evaluator) {
            return None;
        }
        let set = Cost::of(&evaluator).minus(before).plus(fitted.cost(&plan.handed));
        let values = self.values_after(&plan, evaluator.noted.take())?;
        let values = if settings.noting {
            values.handed_on(&plan.handed, &fitted, &self.scene.nodes)
        } else {
            values
        };
        let after = After::of(self, &plan.gone, &plan.fresh);
        let (spent, n_moved) = self.spent(&plan, &made, &after, set)?;
        let is_told_of_sets = !evaluator.sink.kept().is_empty();
        if evaluator.sink.is_full() || !evaluator.sink.is_whole() || is_told_of_sets {
            return None;
        }
        if plan.is_wrong() || evaluator.sink.errors() > 0 {
            return self.told(plan, text, (evaluator, found), &values);
        }
        if n_moved > MOVED {
            return None;
        }
        self.warn(&plan, &mut made, found)?;
        let renamed = self.renamed(&plan.tasks, &made, &after, &plan)?;
        (self.n_evaluated, self.spent) = (plan.tasks.len(), spent);
        self.put(plan, (made, fitted), text, &mut evaluator, renamed)?;
        self.values = values;
        self.gathered(&mut evaluator, settings)
    }

    /// Whether more is gone than is left.
    fn is_worn(&self) -> bool {
        self.scene.nodes.len() + self.scene.groups.len() > 2 * self.n_kept + self.stmts.len()
    }

    /// What each statement of a plan comes to and what is told of it; `None` if that cannot be put in the
    /// place of what it did.
    fn evaluate(
        &self,
        plan: &Plan,
        text: &Arc<str>,
        evaluator: &mut Evaluator<'_>,
    ) -> Option<Evaluated> {
        let env = self.surroundings(text, evaluator);
        let after = After::of(self, &plan.gone, &plan.fresh);
        let begun = |task: &Task| (task.stmt.span.source, after.get(task.i, &plan.edit).1.start);
        evaluator.begun.extend(plan.tasks.iter().map(begun));
        let mut body = Body::new(Place::File);
        let (mut all, mut told, mut is_poisoned) = (vec![], vec![], false);
        let mut room = self.room(plan);
        for task in &plan.tasks {
            let Task { stmt, is_new, .. } = task;
            let mark = evaluator.mark();
            let most = plan.most_noted(task, room);
            evaluator.note_at_most(most);
            evaluator.labels.keep(*is_new && !self.set_labels.is_empty());
            if *is_new {
                evaluator.begin_noting(Noting { id: stmt.span.source, span: stmt.span });
            }
            evaluator.stmts(std::slice::from_ref(stmt), &env, &mut body);
            room = room.saturating_sub(most - evaluator.end_noting().min(most));
            let made = evaluator.made_since(&mark);
            let is_poison = |name: &Name| matches!(env.get(&name.text), Some(Value::Poison));
            is_poisoned |= defines(stmt).iter().any(is_poison);
            if *is_new && made.has_read() {
                return None;
            }
            all.push(made);
            told.push(evaluator.sink.take());
        }
        // Nothing comes of a mistake, but without one something does.
        let is_told = evaluator.sink.errors() > 0 || plan.is_wrong();
        let is_good = !evaluator.stopped && (is_told || !evaluator.damaged && !is_poisoned);
        let is_alike = evaluator.sources.n_texts() == self.sources.n_texts();
        let is_set = evaluator.labels.sets.len() == plan.sets.setters.len();
        let fitted = self.fitted(&plan.handed, &env, evaluator)?;
        (is_good && is_alike && is_set).then_some(Evaluated { made: all, found: told, fitted })
    }

    /// What stands around the statements of the file, with the texts that were read before.
    fn surroundings(&self, text: &Arc<str>, evaluator: &mut Evaluator<'_>) -> Env {
        let Settings { set, budgets, .. } = &self.settings;
        evaluator.sources.add(self.path.to_string_lossy(), text.clone());
        let declaring = self.stmts.iter().filter(|stmt| stmt.declares);
        let read = |stmt: &Statement| {
            // They stand where they stood: what declares is not among what is gone.
            let part = &self.text[stmt.range.clone()];
            read_piece(part, false, source_of(stmt.id), budgets).0
        };
        let begun = |stmt: &Statement| (source_of(stmt.id), stmt.range.start);
        evaluator.begun.extend(declaring.clone().map(begun));
        let declared = Tree { stmts: declaring.flat_map(read).collect() };
        let units = evaluator.units(&declared.stmts);
        let overrides = evaluator.settings(&declared, set);
        evaluator.sources.add_rest(&self.sources);
        evaluator.n_foreseen = evaluator.sources.n_texts();
        evaluator.chain.push((evaluator.files.canonical(&self.path), None));
        evaluator.open_groups.push(OpenGroup::default());
        let folder = self.path.parent().map_or_else(Default::default, std::path::Path::to_path_buf);
        Env::new(Rc::new(File { folder, units, overrides, is_root: true }))
    }

    /// For nodes and groups that were evaluated, their numbers among those that are kept: those of what is
    /// as it was, and new ones. `None` if what is as it was has others than before.
    fn renamed(
        &self,
        tasks: &[Task],
        made: &[Made],
        after: &After<'_>,
        plan: &Plan,
    ) -> Option<[Vec<u32>; 2]> {
        let narrow = |n: usize| u32::try_from(n).unwrap_or(NONE);
        let mut next = [narrow(self.scene.nodes.len()), narrow(self.scene.groups.len())];
        let mut out = [vec![], vec![]];
        for (task, made) in tasks.iter().zip(made) {
            let before = &after.get(task.i, &plan.edit).0.made;
            let kept = [&before.nodes, &before.groups];
            for (k, now) in [&made.nodes, &made.groups].into_iter().enumerate() {
                if task.is_new {
                    out[k].extend(next[k]..next[k] + narrow(now.len()));
                    next[k] += narrow(now.len());
                } else if now.len() == kept[k].len() {
                    out[k].extend(kept[k].clone().map(narrow));
                } else {
                    return None;
                }
            }
        }
        Some(out)
    }

    /// What is spent now, with the cost of what is `set` and handed on, and how many statements have come to
    /// another number of things; `None` if it is more than the budgets allow.
    fn spent(
        &self,
        plan: &Plan,
        made: &[Made],
        after: &After<'_>,
        set: Cost,
    ) -> Option<(Cost, usize)> {
        let gone = self.stmts[plan.gone.clone()].iter();
        let mut spent = gone.fold(self.spent.plus(set), |sum, stmt| sum.minus(stmt.made.cost));
        let mut n_moved = 0;
        for (task, made) in plan.tasks.iter().zip(made).filter(|(task, _)| task.is_new) {
            let before = &after.get(task.i, &plan.edit).0.made;
            spent = spent.minus(before.cost).plus(made.cost);
            n_moved += usize::from(!plan.is_fresh(task.i) && before.n_items != made.n_items);
        }
        spent.is_within(&self.settings.budgets).then_some((spent, n_moved))
    }
}
