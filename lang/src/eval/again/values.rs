//! Values that were noted of each statement.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use luxel_core::diag::{SourceId, Span};

use super::plan::{After, Plan, Task};
use super::record::in_statement;
use super::{State, source_of};
use crate::eval::note::{KEPT, Noted};
use crate::values::{Elsewhere, Layers, Values};

/// The values of a load, by statement.
#[derive(Clone, Debug, Default)]
pub(super) struct KeptValues {
    pub(super) own: Layers,
    others: Arc<Elsewhere>,
    /// How many there are of statements' own names.
    n_own: usize,
}

impl KeptValues {
    /// Those of a load whose statements have these bytes.
    pub(super) fn of(noted: Noted, ranges: &[Range<usize>]) -> Self {
        let place = |(source, at): (SourceId, u32)| {
            let span = in_statement(Span { source, start: at, end: at }, ranges);
            (span.source, span.start)
        };
        let Noted { mut layer, others, .. } = noted;
        for notes in layer.values_mut().filter_map(Arc::get_mut) {
            for (at, _) in notes {
                *at = place((SourceId(0), *at)).1;
            }
        }
        let others = others.into_iter().map(|(name, given)| (place(name), given)).collect();
        let n_own = layer.values().map(|notes| notes.len()).sum();
        let mut own = Layers::default();
        own.push(layer);
        Self { own, others: Arc::new(others), n_own }
    }

    fn n_of<'i>(&self, ids: impl Iterator<Item = &'i SourceId>) -> usize {
        ids.filter_map(|id| self.own.of(*id)).map(<[_]>::len).sum()
    }
}

impl Plan {
    /// Of how many names a statement may note the values if there is so much room left. Those of what was
    /// written just now are noted anyway.
    pub(super) fn most_noted(&self, task: &Task, room: usize) -> usize {
        let fresh = self.gone.start..self.gone.start + self.fresh.len();
        match (task.is_new, fresh.contains(&task.i)) {
            (true, true) => KEPT,
            (true, false) => room,
            (false, _) => 0,
        }
    }
}

/// Whose values an edit changes.
struct Changed {
    gone: BTreeSet<SourceId>,
    /// Those that are as they were, but evaluated anew, and which of the new statements they are.
    again: BTreeMap<SourceId, usize>,
}

impl State {
    fn changed(&self, plan: &Plan) -> Changed {
        let fresh = plan.gone.start..plan.gone.start + plan.fresh.len();
        let again = plan.tasks.iter().filter(|task| task.is_new && !fresh.contains(&task.i));
        Changed {
            gone: self.stmts[plan.gone.clone()].iter().map(|stmt| source_of(stmt.id)).collect(),
            again: again.map(|task| (task.stmt.span.source, task.i)).collect(),
        }
    }

    /// How many more values may be noted of what an edit concerns.
    pub(super) fn room(&self, plan: &Plan) -> usize {
        let Changed { gone, again } = self.changed(plan);
        let kept = &self.values;
        let n_replaced = kept.n_of(gone.iter().chain(again.keys()));
        (KEPT + n_replaced).saturating_sub(kept.n_own + kept.others.len())
    }

    /// The values of all statements after an edit; `None` if it cannot be known which statement gives a
    /// name its first value now.
    pub(super) fn values_after(&self, plan: &Plan, noted: Option<Noted>) -> Option<KeptValues> {
        let Some(Noted { layer, others, .. }) = noted else { return Some(KeptValues::default()) };
        let changed = self.changed(plan);
        let others = self.others_after(plan, &changed, others)?;
        let n_replaced = self.values.n_of(changed.gone.iter().chain(changed.again.keys()));
        let n_new: usize = layer.values().map(|notes| notes.len()).sum();
        let mut own = self.values.own.clone();
        own.push(layer);
        Some(KeptValues { own, others, n_own: self.values.n_own + n_new - n_replaced })
    }

    fn others_after(
        &self,
        plan: &Plan,
        Changed { gone, again }: &Changed,
        noted: Elsewhere,
    ) -> Option<Arc<Elsewhere>> {
        let is_changed = |id: &SourceId| gone.contains(id) || again.contains_key(id);
        let kept = &self.values.others;
        let concerned = |(name, (giver, _)): (&(SourceId, u32), &(SourceId, _))| {
            is_changed(giver) || gone.contains(&name.0)
        };
        if noted.is_empty() && !kept.iter().any(concerned) {
            return Some(kept.clone());
        }
        let places: BTreeMap<SourceId, usize> = After::of(self, &plan.gone, &plan.fresh)
            .iter()
            .map(|stmt| source_of(stmt.id))
            .zip(0..)
            .collect();
        let place = |giver: &SourceId| places.get(giver).copied().unwrap_or_default();
        let mut out = Elsewhere::clone(kept);
        for (name, (giver, _)) in kept.iter().filter(|given| concerned(*given)) {
            out.remove(name);
            // What still stands there and is not evaluated anew may have its value by a later one.
            let last = again.get(giver).map_or(plan.gone.start + plan.fresh.len(), |i| i + 1);
            let is_first = |(now, _): &(SourceId, _)| place(now) < last;
            if !is_changed(&name.0) && !noted.get(name).is_some_and(is_first) {
                return None;
            }
        }
        for (name, given) in noted {
            let before = out.get(&name).map(|(giver, _)| place(giver));
            if before.is_none_or(|before| place(&given.0) < before) {
                out.insert(name, given);
            }
        }
        Some(Arc::new(out))
    }
    /// The values of all statements where they stand.
    pub(super) fn values(&self) -> Values {
        let stmts = self.stmts.iter().map(|stmt| (stmt.range.start, source_of(stmt.id)));
        self.values_of(stmts, &self.values)
    }

    /// Those of statements that begin at these bytes.
    pub(super) fn values_of(
        &self,
        stmts: impl Iterator<Item = (usize, SourceId)>,
        values: &KeptValues,
    ) -> Values {
        if !self.settings.noting {
            return Values::default();
        }
        Values { stmts: stmts.collect(), own: values.own.clone(), others: values.others.clone() }
    }
}
