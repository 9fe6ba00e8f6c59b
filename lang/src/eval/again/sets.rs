//! `set` statements: what they change is evaluated again with them.
//!
//! Known are only those of a label that one statement of the file bears itself, and that stands for one
//! object: then whatever concerns one of them concerns that statement and all that `set` names of it.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use super::plan::{After, Plan};
use super::record::Record;
use super::{State, Statement};
use crate::eval::Evaluator;
use crate::eval::emit::Labels;
use crate::eval::names::Known;
use crate::eval::numbered::Firsts;
use crate::syntax::{Stmt, StmtNode};

/// Which statements a `set` concerns.
#[derive(Debug, Default)]
pub(super) struct Sets {
    /// Those that bear a label of which something is set.
    pub(super) bearers: BTreeSet<usize>,
    /// What sets something of them.
    pub(super) setters: BTreeSet<usize>,
    /// The labels.
    pub(super) labels: BTreeSet<u32>,
}

/// The label, by number, of which a statement sets something.
pub(super) fn set_label(stmt: &Stmt, names: &mut Known) -> Option<u32> {
    match &stmt.node {
        StmtNode::Set { path, .. } if !stmt.is_off() => Some(names.number(&path.first()?.text)),
        _ => None,
    }
}

impl Record {
    /// The labels of which something is set, if nothing else is.
    pub(super) fn set_labels(&self, labels: &Labels) -> Option<BTreeSet<u32>> {
        let setting = self.stmts.iter().filter_map(|stmt| stmt.set);
        if setting.clone().count() != self.n_sets {
            return None;
        }
        let set: BTreeSet<u32> = setting.collect();
        let mut borne: BTreeMap<u32, usize> = set.iter().map(|label| (*label, 0)).collect();
        for label in self.stmts.iter().flat_map(|stmt| stmt.names.labels()) {
            borne.entry(*label).and_modify(|n| *n += 1);
        }
        let is_one = |label: &u32| labels.n_of(self.names.name(*label)) == 1;
        let is_known = borne.values().all(|n| *n == 1) && set.iter().all(is_one);
        is_known.then_some(set)
    }
}

impl State {
    /// What of `new` statements, and of those that are gone, has to do with a `set`; `None` if that cannot
    /// be told.
    pub(super) fn sets(
        &self,
        gone: &Range<usize>,
        after: &After<'_>,
        firsts: &Firsts<'_>,
        new: &[usize],
    ) -> Option<Sets> {
        let mut sets = Sets::default();
        let is_set = |label: &&u32| self.set_labels.contains(*label);
        let mut note = |stmt: &Statement| {
            sets.labels.extend(stmt.set);
            sets.labels.extend(stmt.names.labels().iter().filter(is_set));
        };
        self.stmts[gone.clone()].iter().for_each(&mut note);
        for i in new {
            note(after.at(*i));
        }
        for label in &sets.labels {
            sets.bearers.insert(firsts.labeller_of(*label).filter(|_| is_set(&label))?);
        }
        if !sets.labels.is_empty() {
            let is_one = |stmt: &Statement| stmt.set.is_some_and(|it| sets.labels.contains(&it));
            let ones = after.iter().enumerate().filter(|(_, stmt)| is_one(stmt));
            sets.setters.extend(ones.map(|(i, _)| i));
        }
        Some(sets)
    }

    /// Does what is set of the things that were evaluated; whether that is all of it.
    pub(super) fn set_again(&self, plan: &Plan, evaluator: &mut Evaluator<'_>) -> bool {
        let labels = &evaluator.labels;
        let is_foreseen = |label: &u32| {
            let n = labels.n_of(self.names.name(*label));
            n == usize::from(plan.sets.labels.contains(label))
        };
        let is_foreseen = self.set_labels.iter().all(is_foreseen);
        if is_foreseen {
            evaluator.apply_sets();
        }
        is_foreseen
    }
}
