//! What was evaluated takes the place of what was kept.

use std::collections::HashSet;
use std::ops::Range;
use std::sync::Arc;

use luxel_core::diag::SourceId;
use luxel_core::registry::Registry;
use luxel_core::scene::{NodeId, Placed};

use super::handed::Fitted;
use super::handing::Written;
use super::made::Made;
use super::plan::Plan;
use super::{State, Statement};
use crate::eval::Evaluator;
use crate::eval::numbered::Firsts;

impl State {
    /// Becomes the state of the new text. `nodes` and `groups` are the numbers here of those that were
    /// evaluated. `None`, and broken, if that is given up.
    pub(super) fn put(
        &mut self,
        plan: Plan,
        (mut made, fitted): (Vec<Made>, Fitted),
        text: Arc<str>,
        evaluator: &mut Evaluator<'_>,
        [nodes, groups]: [Vec<u32>; 2],
    ) -> Option<()> {
        self.is_broken = true;
        let is_rearranged = fitted.has_nodes() || self.rearranges(&plan, &made);
        let is_over = evaluator.sink.over();
        let mut evaluated = std::mem::take(&mut evaluator.scene);
        let open = std::mem::take(&mut evaluator.open_groups);
        evaluated.root = open.into_iter().next().unwrap_or_default().group;
        let items = self.scene.take_over(evaluated, [&nodes, &groups], &is_over)?;
        if is_rearranged {
            self.put_items(&plan, &made, items);
            self.order = None;
        }
        for made in &mut made {
            made.nodes = renamed(&made.nodes, &nodes);
            made.groups = renamed(&made.groups, &groups);
            for slot in made.rare.iter_mut().flat_map(|rare| &mut rare.slots) {
                slot.id = NodeId(nodes[slot.id.0 as usize]);
            }
        }
        let Plan { edit, gone, fresh, tasks, tables, n_names, handed, .. } = plan;
        self.hand_on(handed, &fitted, &nodes, &is_over)?;
        self.n_names = n_names;
        if let Some(tables) = tables {
            self.tables = tables;
        }
        for stmt in &mut self.stmts[gone.end..] {
            stmt.range = edit.shifted(stmt.range.start)..edit.shifted(stmt.range.end);
        }
        self.n_ids += fresh.len();
        let gone: Vec<Statement> = self.stmts.splice(gone, fresh).collect();
        self.sources.replace(SourceId(0), text.clone());
        self.text = text;
        let mut new = vec![];
        for (task, made) in tasks.into_iter().zip(made).filter(|(task, _)| task.is_new) {
            self.stmts[task.i].made = made;
            new.push(task.i);
        }
        self.hand_anew(&gone, &new, evaluator.registry);
        (self.is_broken, self.is_wrong, self.has_odd_names) = (false, false, false);
        Some(())
    }

    /// Finds what new statements hand on, where others are gone.
    fn hand_anew(&mut self, gone: &[Statement], new: &[usize], registry: &Registry) {
        let new_stmts = new.iter().map(|i| &self.stmts[*i]);
        let defines = gone.iter().chain(new_stmts).flat_map(|stmt| stmt.names.defines());
        let redefined: HashSet<u32> = defines.copied().collect();
        if !redefined.is_empty() {
            self.handing.forget(&redefined);
        }
        let firsts = Firsts::new(&self.names, &self.tables);
        let (stmts, text) = (&self.stmts, &*self.text);
        let definition = |name| Some(&text[stmts[firsts.definer_of(name)?].range.clone()]);
        let written = Written {
            text,
            nodes: &self.scene.nodes,
            names: &self.names,
            budgets: &self.settings.budgets,
            registry,
            n_shadows: self.n_shadows,
            definition: &definition,
        };
        let handing = &mut self.handing;
        let hands: Vec<_> = new.iter().map(|i| handing.add(&stmts[*i], &written)).collect();
        for (i, hands) in new.iter().zip(hands) {
            self.stmts[*i].hands = hands;
        }
    }

    /// Whether something is put into the world or a setting is given, or was by what is gone. Whatever uses
    /// what either of these makes is evaluated too.
    fn rearranges(&self, plan: &Plan, made: &[Made]) -> bool {
        let new = || plan.tasks.iter().zip(made).filter(|(task, _)| task.is_new);
        let replaced = new().filter_map(|(task, _)| Some(&self.stmts[plan.old(task.i)?]));
        let gone = self.stmts[plan.gone.clone()].iter().chain(replaced).map(|stmt| &stmt.made);
        gone.chain(new().map(|(_, made)| made)).any(Made::stands_somewhere)
    }

    /// Puts what stands in the world now in the place of what stood there.
    fn put_items(&mut self, plan: &Plan, made: &[Made], items: Vec<Placed>) {
        let mut starts = Vec::with_capacity(self.stmts.len() + 1);
        let mut start = 0;
        for stmt in &self.stmts {
            starts.push(start);
            start += stmt.made.n_items;
        }
        starts.push(start);
        let mut changes = vec![(starts[plan.gone.start]..starts[plan.gone.end], vec![])];
        let mut items = items.into_iter();
        for (task, made) in plan.tasks.iter().zip(made) {
            let some = items.by_ref().take(made.n_items);
            if !task.is_new {
                some.for_each(drop);
            } else if let Some(old) = plan.old(task.i) {
                changes.push((starts[old]..starts[old + 1], some.collect()));
            } else {
                changes[0].1.extend(some);
            }
        }
        changes.sort_by_key(|(range, _)| (range.start, range.end));
        // From the end, so that the places before stay what they are.
        for (range, some) in changes.into_iter().rev() {
            self.scene.root.items.splice(range, some);
        }
    }
}

/// Numbers that follow one another, under their new names.
fn renamed(numbers: &Range<usize>, names: &[u32]) -> Range<usize> {
    let first = names.get(numbers.start).filter(|_| !numbers.is_empty());
    let first = first.map_or(0, |first| *first as usize);
    first..first + numbers.len()
}
