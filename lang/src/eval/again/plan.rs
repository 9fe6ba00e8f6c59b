//! Which statements an edit concerns, from their names alone.

use std::collections::{BTreeSet, VecDeque};
use std::ops::Range;

use luxel_core::diag::Diagnostic;
use luxel_core::scene::IsOver;
use luxel_sdk::params::leave;

use super::edit::{Edit, Recut, recut};
use super::handed::Handed;
use super::sets::Sets;
use super::warn::{are_within, fault_of, faults};
use super::{State, Statement, source_of};
use crate::budgets::Budgets;
use crate::eval::builtins;
use crate::eval::mention::mention_stmts;
use crate::eval::names::Facts;
use crate::eval::numbered::{Firsts, Tables};
use crate::eval::turns::declares;
use crate::shares;
use crate::syntax::{Cut, Stmt, read_head, read_piece};

/// Of how many statements one at most is evaluated again: of more, all are as soon.
const SHARE: usize = 4;

/// How often at most something that is set may bring on more that is: each time all names are looked through.
const ROUNDS: usize = 8;

/// What an edit comes to.
pub(super) struct Plan {
    pub(super) edit: Edit,
    /// The statements that are gone.
    pub(super) gone: Range<usize>,
    /// Those that stand in their place.
    pub(super) fresh: Vec<Statement>,
    /// What is to be evaluated, in order.
    pub(super) tasks: Vec<Task>,
    /// Who defines what, if that has changed.
    pub(super) tables: Option<Tables>,
    /// How many names the file defines.
    pub(super) n_names: usize,
    /// What is said of how each of the fresh ones is written.
    pub(super) read: Vec<Vec<Diagnostic>>,
    /// What is wrong with names.
    pub(super) names: Vec<Diagnostic>,
    /// Something is wrong with what it does not concern.
    pub(super) is_wrong_beside: bool,
    pub(super) sets: Sets,
    /// What hands on the values that have changed.
    pub(super) handed: Handed,
}

impl Plan {
    /// Whether a statement stands in the place of those that are gone.
    pub(super) fn is_fresh(&self, i: usize) -> bool {
        (self.gone.start..self.gone.start + self.fresh.len()).contains(&i)
    }

    /// Which of the old statements a new one is, unless it is fresh.
    pub(super) fn old(&self, i: usize) -> Option<usize> {
        match i {
            i if self.is_fresh(i) => None,
            i if i < self.gone.start => Some(i),
            i => Some(i - self.fresh.len() + self.gone.len()),
        }
    }
}

/// A statement to evaluate.
pub(super) struct Task {
    /// Which of the new statements it is.
    pub(super) i: usize,
    pub(super) stmt: Stmt,
    /// Whether its nodes are new; else it is evaluated for what it defines.
    pub(super) is_new: bool,
}

/// Statements that were read.
#[derive(Default)]
struct Fresh {
    stmts: Vec<Statement>,
    trees: Vec<Option<Stmt>>,
    /// What is said of how each is written.
    said: Vec<Vec<Diagnostic>>,
}

/// The statements after an edit.
pub(super) struct After<'s> {
    stmts: &'s [Statement],
    gone: Range<usize>,
    fresh: &'s [Statement],
}

impl<'s> After<'s> {
    pub(super) fn of(state: &'s State, gone: &Range<usize>, fresh: &'s [Statement]) -> Self {
        Self { stmts: &state.stmts, gone: gone.clone(), fresh }
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = &'s Statement> + Clone {
        let before = self.stmts[..self.gone.start].iter();
        before.chain(self.fresh).chain(&self.stmts[self.gone.end..])
    }

    /// What `f` makes of a few of those from one on at a time, with the number of the first.
    fn shared<R: Send>(
        &self,
        from: usize,
        f: impl Fn(&[Statement]) -> R + Sync,
    ) -> Vec<(usize, R)> {
        let end = self.gone.start + self.fresh.len();
        let pieces = [
            (0, &self.stmts[..self.gone.start]),
            (self.gone.start, self.fresh),
            (end, &self.stmts[self.gone.end..]),
        ];
        let mut out = vec![];
        for (start, stmts) in pieces {
            let passed = from.saturating_sub(start).min(stmts.len());
            let mut at = start + passed;
            let some = |part: &[Statement]| (part.len(), f(part));
            for (n, made) in shares::map(&stmts[passed..], |stmt| stmt.range.len(), some) {
                out.push((at, made));
                at += n;
            }
        }
        out
    }

    /// One of them.
    pub(super) fn at(&self, i: usize) -> &'s Statement {
        let fresh = self.gone.start..self.gone.start + self.fresh.len();
        match i {
            i if fresh.contains(&i) => &self.fresh[i - fresh.start],
            i if i < fresh.start => &self.stmts[i],
            i => &self.stmts[i - fresh.end + self.gone.end],
        }
    }

    /// One of them, and where in the new text it begins and ends.
    pub(super) fn get(&self, i: usize, edit: &Edit) -> (&'s Statement, Range<usize>) {
        let (stmt, end) = (self.at(i), self.gone.start + self.fresh.len());
        if i < end {
            return (stmt, stmt.range.clone());
        }
        (stmt, edit.shifted(stmt.range.start)..edit.shifted(stmt.range.end))
    }
}

impl State {
    /// What has to be evaluated for `text`; `None` if that cannot be told, or once it is over.
    pub(super) fn plan(&mut self, text: &str, is_over: IsOver<'_>) -> Option<Plan> {
        let budgets = self.settings.budgets;
        let edit = Edit::of(&self.text, text);
        let (from, told) = read_head(text, &budgets);
        if from != Some(self.from) || !told.is_empty() || edit.old.start <= self.from {
            return None;
        }
        let Recut { gone, pieces, faults: unclosed } =
            recut((text, self.from), &edit, &self.stmts, &budgets)?;
        if self.stmts.len() - gone.len() + pieces.len() > budgets.statements {
            return None;
        }
        let Fresh { stmts: fresh, trees, said } = self.fresh(text, pieces, &unclosed)?;
        let after = After::of(self, &gone, &fresh);
        if (self.is_wrong || !unclosed.is_empty()) && !are_within(faults(after.iter())) {
            return None;
        }
        let n_names = |stmts: &[Statement]| -> usize {
            stmts.iter().map(|stmt| stmt.names.defines().len()).sum()
        };
        let n_names = self.n_names - n_names(&self.stmts[gone.clone()]) + n_names(&fresh);
        let (mut tables, mut names) = (None, vec![]);
        if self.has_odd_names || !self.is_named_alike(&gone, &fresh) {
            let (found, odd) = Tables::of(&self.names, after.iter().map(|stmt| &stmt.names));
            if n_names > budgets.names {
                return None;
            }
            let firsts = Firsts::new(&self.names, &found);
            names = self.odd_names((text, &edit), &after, &firsts, &odd)?;
            tables = Some(found);
        }
        let firsts = Firsts::new(&self.names, tables.as_ref().unwrap_or(&self.tables));
        let (new, handed, sets) = self.concerned_with_sets(&gone, &after, &firsts)?;
        let known = handed.names().filter_map(|name| firsts.definer_of(name));
        let wanted: BTreeSet<usize> =
            new.iter().chain(&sets.setters).copied().chain(known).collect();
        let tasks = self.tasks((text, &edit), &after, &firsts, (&new, wanted), (trees, is_over))?;
        let is_wrong_beside = self.is_wrong_beside(&after, &tasks);
        Some(Plan {
            edit,
            gone,
            fresh,
            tasks,
            tables,
            n_names,
            read: said,
            names,
            is_wrong_beside,
            sets,
            handed,
        })
    }

    /// Reads statements that were cut anew, some of which do not close.
    fn fresh(&mut self, text: &str, pieces: Vec<Cut>, unclosed: &[Diagnostic]) -> Option<Fresh> {
        let mut out = Fresh::default();
        for (k, Cut { range, faulty, .. }) in pieces.into_iter().enumerate() {
            let id = u32::try_from(self.n_ids + k).ok()?;
            let part = &text[range.clone()];
            let (stmt, found) = read(part, faulty, id, &self.settings.budgets)?;
            // What cannot be read may have been meant to be about the whole file.
            if (faulty || !found.is_empty()) && declares(part) {
                return None;
            }
            let facts = Facts::of(part, std::slice::from_ref(&stmt));
            let mut next = Statement::new(id, range.clone(), &stmt, &facts, &mut self.names);
            if faulty {
                let is_own = |fault: &&Diagnostic| {
                    fault.span().is_some_and(|span| range.contains(&span.range().start))
                };
                let own = unclosed.iter().filter(is_own).map(|fault| fault_of(fault, id, &range));
                next.made.told_mut().faults = own.collect::<Option<_>>()?;
            }
            out.stmts.push(next);
            out.trees.push(Some(stmt));
            out.said.push(found);
        }
        Some(out)
    }

    /// Whether statements have the same to do with names as those that they stand for.
    fn is_named_alike(&self, gone: &Range<usize>, fresh: &[Statement]) -> bool {
        let mut pairs = self.stmts[gone.clone()].iter().zip(fresh);
        gone.len() == fresh.len() && pairs.all(|(one, other)| one.names == other.names)
    }

    /// The statements that come to something else, with those of which something else is set; `None` if they
    /// are too many, or come after one another too often.
    fn concerned_with_sets(
        &self,
        gone: &Range<usize>,
        after: &After<'_>,
        firsts: &Firsts<'_>,
    ) -> Option<(Vec<usize>, Handed, Sets)> {
        let mut bearers = BTreeSet::new();
        for _ in 0..ROUNDS {
            let (new, handed) = self.concerned(gone, (after, firsts), &bearers)?;
            let sets = self.sets(gone, after, firsts, &new)?;
            if sets.bearers.iter().all(|i| new.binary_search(i).is_ok()) {
                return Some((new, handed, sets));
            }
            bearers.clone_from(&sets.bearers);
        }
        None
    }

    /// The statements that are new, one of `those`, or use a name that a statement with another value defines;
    /// apart from them those that only hand that value on.
    fn concerned(
        &self,
        gone: &Range<usize>,
        (after, firsts): (&After<'_>, &Firsts<'_>),
        those: &BTreeSet<usize>,
    ) -> Option<(Vec<usize>, Handed)> {
        let fresh = gone.start..gone.start + after.fresh.len();
        let new: BTreeSet<usize> = fresh.chain(those.iter().copied()).collect();
        let mut gone_or_new =
            self.stmts[gone.clone()].iter().chain(new.iter().map(|i| after.at(*i)));
        if gone_or_new.any(Statement::is_wide) {
            return None;
        }
        let is_changed = self.changed_names(&self.stmts[gone.clone()], &new, (after, firsts));
        if !is_changed.contains(&true) {
            return Some((new.into_iter().collect(), Handed::default()));
        }
        let first = new.first().map_or(gone.start, |first| gone.start.min(*first));
        let ids: BTreeSet<u32> = those.iter().map(|i| after.at(*i).id).collect();
        let is_new = |stmt: &Statement| stmt.id as usize >= self.n_ids || ids.contains(&stmt.id);
        let parts = after.shared(first, |stmts| self.users(stmts, &is_changed, is_new));
        let (mut concerned, mut handed) = (Vec::from_iter(new.clone()), vec![]);
        for (start, users) in parts {
            concerned.extend(users.others.into_iter().map(|i| start + i));
            handed.push(users.handed);
        }
        concerned.sort_unstable();
        concerned.dedup();
        let is_small = concerned.len() <= self.stmts.len() / SHARE + new.len();
        let is_one_wide = concerned.iter().any(|i| after.at(*i).is_wide());
        (is_small && !is_one_wide).then(|| (concerned, self.handed(handed)))
    }

    /// Which names have another value, by number, where statements are gone or new. A second definition of
    /// a name gives it none.
    fn changed_names(
        &self,
        gone: &[Statement],
        new: &BTreeSet<usize>,
        (after, firsts): (&After<'_>, &Firsts<'_>),
    ) -> Vec<bool> {
        let mut is_changed = vec![false; self.names.len()];
        for name in gone.iter().flat_map(|stmt| stmt.names.defines()) {
            is_changed[*name as usize] = true;
        }
        let change = |i: usize, is_changed: &mut [bool]| {
            let defines = after.at(i).names.defines().iter();
            for name in defines.filter(|name| firsts.definer_of(**name) == Some(i)) {
                is_changed[*name as usize] = true;
            }
        };
        for i in new {
            change(*i, &mut is_changed);
        }
        if is_changed.contains(&true) {
            for i in firsts.definers() {
                if after.at(i).names.uses().any(|(name, _)| is_changed[name as usize]) {
                    change(i, &mut is_changed);
                }
            }
        }
        is_changed
    }

    /// The statements that are wanted, some of which are new, and those that define what they use.
    fn tasks(
        &self,
        (text, edit): (&str, &Edit),
        after: &After<'_>,
        firsts: &Firsts<'_>,
        (new, wanted): (&[usize], BTreeSet<usize>),
        (mut trees, is_over): (Vec<Option<Stmt>>, IsOver<'_>),
    ) -> Option<Vec<Task>> {
        let mut met = wanted;
        let mut open: VecDeque<usize> = met.iter().copied().collect();
        let mut tasks = vec![];
        while let Some(i) = open.pop_front() {
            if is_over() {
                leave(tasks);
                return None;
            }
            let (statement, range) = after.get(i, edit);
            let tree = i.checked_sub(after.gone.start).and_then(|k| trees.get_mut(k)?.take());
            let stmt = match tree {
                Some(stmt) => stmt,
                None => statement.read(&text[range], &self.settings.budgets)?.0,
            };
            // Of a second definition it matters what the name stands for already.
            let defines = statement.names.defines().iter().copied();
            let names = statement.names.uses().map(|(name, _)| name).chain(defines);
            let mut definers: Vec<usize> =
                names.filter_map(|name| firsts.definer_of(name)).collect();
            // What is wrong may use more names than it seems.
            let is_odd = !statement.names.is_sound;
            if is_odd || self.n_shadows > 0 {
                let mut mentioned = BTreeSet::new();
                mention_stmts(std::slice::from_ref(&stmt), &mut mentioned);
                let mentioned = mentioned.iter().filter(|name| is_odd || builtins::begins(name));
                definers.extend(mentioned.filter_map(|name| firsts.definer(name)));
            }
            open.extend(
                definers.into_iter().filter(|definer| *definer < i && met.insert(*definer)),
            );
            tasks.push(Task { i, stmt, is_new: new.binary_search(&i).is_ok() });
        }
        tasks.sort_unstable_by_key(|task| task.i);
        Some(tasks)
    }
}

impl Statement {
    /// The same once more, from its text.
    pub(super) fn read(&self, text: &str, budgets: &Budgets) -> Option<(Stmt, Vec<Diagnostic>)> {
        let is_faulty = self.made.rare.as_ref().is_some_and(|rare| !rare.told.faults.is_empty());
        read(text, is_faulty, self.id, budgets)
    }
}

/// The one statement of a piece, in which something does not close if it is `faulty`, and what is told of it.
fn read(text: &str, faulty: bool, id: u32, budgets: &Budgets) -> Option<(Stmt, Vec<Diagnostic>)> {
    let (mut stmts, told) = read_piece(text, faulty, source_of(id), budgets);
    stmts.pop().filter(|_| stmts.is_empty()).map(|stmt| (stmt, told))
}
