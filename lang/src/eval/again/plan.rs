//! Which statements an edit concerns, from their names alone.

use std::collections::{BTreeSet, VecDeque};
use std::ops::Range;

use luxel_core::diag::Diagnostic;

use super::edit::{Edit, Recut, recut};
use super::{State, Statement, source_of};
use crate::eval::builtins;
use crate::eval::mention::mention_stmts;
use crate::eval::names::Facts;
use crate::eval::numbered::{Firsts, Tables};
use crate::eval::turns::declares;
use crate::syntax::{Stmt, read_head, read_piece};

/// Of how many statements one at most is evaluated again: of more, all are as soon.
const SHARE: usize = 4;

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
    /// What is wrong with what is written and with names.
    pub(super) told: Vec<Diagnostic>,
}

/// A statement to evaluate.
pub(super) struct Task {
    /// Which of the new statements it is.
    pub(super) i: usize,
    pub(super) stmt: Stmt,
    /// Whether its nodes are new; else it is evaluated for what it defines.
    pub(super) is_new: bool,
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

    /// One of them, and where in the new text it begins and ends.
    pub(super) fn get(&self, i: usize, edit: &Edit) -> (&'s Statement, Range<usize>) {
        let fresh = self.gone.start..self.gone.start + self.fresh.len();
        if fresh.contains(&i) {
            let stmt = &self.fresh[i - fresh.start];
            return (stmt, stmt.range.clone());
        }
        if i < fresh.start {
            return (&self.stmts[i], self.stmts[i].range.clone());
        }
        let stmt = &self.stmts[i - fresh.end + self.gone.end];
        (stmt, edit.shifted(stmt.range.start)..edit.shifted(stmt.range.end))
    }
}

impl State {
    /// What has to be evaluated for `text`; `None` if that cannot be told.
    pub(super) fn plan(&mut self, text: &str) -> Option<Plan> {
        let budgets = self.settings.budgets;
        let edit = Edit::of(&self.text, text);
        let (from, told) = read_head(text, &budgets);
        if from != Some(self.from) || !told.is_empty() || edit.old.start <= self.from {
            return None;
        }
        let Recut { gone, pieces } = recut((text, self.from), &edit, &self.stmts, &budgets)?;
        let (mut fresh, mut trees, mut told) = (vec![], vec![], vec![]);
        for (k, range) in pieces.into_iter().enumerate() {
            let id = u32::try_from(self.n_ids + k).ok()?;
            let part = &text[range.clone()];
            let (stmt, found) = read(part, id, &budgets)?;
            // What cannot be read may have been meant to be about the whole file.
            if !found.is_empty() && declares(part) {
                return None;
            }
            told.extend(found);
            let facts = Facts::of(part, std::slice::from_ref(&stmt));
            let names = self.names.numbered(&facts);
            fresh.push(Statement::new(id, range, names, &stmt, &facts));
            trees.push(stmt);
        }
        let after = After::of(self, &gone, &fresh);
        let n_names = |stmts: &[Statement]| -> usize {
            stmts.iter().map(|stmt| stmt.names.defines().len()).sum()
        };
        let n_names = self.n_names - n_names(&self.stmts[gone.clone()]) + n_names(&fresh);
        let mut tables = None;
        if !self.is_named_alike(&gone, &fresh) {
            let (found, odd) = Tables::of(&self.names, after.iter().map(|stmt| &stmt.names));
            if n_names > budgets.names {
                return None;
            }
            let firsts = Firsts::new(&self.names, &found);
            told.extend(self.odd_names((text, &edit), &after, &firsts, &odd)?);
            tables = Some(found);
        }
        let new = self.concerned(&gone, &fresh)?;
        let firsts = Firsts::new(&self.names, tables.as_ref().unwrap_or(&self.tables));
        let tasks = self.tasks((text, &edit), &after, &firsts, (&new, trees))?;
        Some(Plan { edit, gone, fresh, tasks, tables, n_names, told })
    }

    /// Whether statements have the same to do with names as those that they stand for.
    fn is_named_alike(&self, gone: &Range<usize>, fresh: &[Statement]) -> bool {
        let mut pairs = self.stmts[gone.clone()].iter().zip(fresh);
        gone.len() == fresh.len() && pairs.all(|(one, other)| one.names == other.names)
    }

    /// The statements that are new, or use a name that a statement with another value defines.
    fn concerned(&self, gone: &Range<usize>, fresh: &[Statement]) -> Option<Vec<usize>> {
        let mut is_changed = vec![false; self.names.len()];
        let mut changes = false;
        for stmt in self.stmts[gone.clone()].iter().chain(fresh) {
            if stmt.is_wide {
                return None;
            }
            for name in stmt.names.defines() {
                (is_changed[*name as usize], changes) = (true, true);
            }
        }
        let end = gone.start + fresh.len();
        let mut new: Vec<usize> = (gone.start..end).collect();
        if !changes {
            return Some(new);
        }
        let most = (self.stmts.len() / SHARE).max(1);
        for (i, stmt) in (end..).zip(&self.stmts[gone.end..]) {
            if stmt.names.uses().any(|(name, _)| is_changed[name as usize]) {
                if stmt.is_wide || new.len() >= most {
                    return None;
                }
                stmt.names.defines().iter().for_each(|name| is_changed[*name as usize] = true);
                new.push(i);
            }
        }
        Some(new)
    }

    /// The statements that are new, and those that define what they use.
    fn tasks(
        &self,
        (text, edit): (&str, &Edit),
        after: &After<'_>,
        firsts: &Firsts<'_>,
        (new, trees): (&[usize], Vec<Stmt>),
    ) -> Option<Vec<Task>> {
        let mut trees = trees.into_iter();
        let mut met: BTreeSet<usize> = new.iter().copied().collect();
        let mut open: VecDeque<usize> = new.iter().copied().collect();
        let mut tasks = vec![];
        while let Some(i) = open.pop_front() {
            let (statement, range) = after.get(i, edit);
            // The fresh ones come first, and their trees are there.
            let stmt = match trees.next() {
                Some(stmt) => stmt,
                None => read(&text[range], statement.id, &self.settings.budgets)?.0,
            };
            let uses = statement.names.uses().filter_map(|(name, _)| firsts.definer_of(name));
            let mut definers: Vec<usize> = uses.collect();
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

/// The one statement of a piece, and what is told of it.
pub(super) fn read(
    text: &str,
    id: u32,
    budgets: &crate::Budgets,
) -> Option<(Stmt, Vec<Diagnostic>)> {
    let (mut stmts, told) = read_piece(text, false, source_of(id), budgets);
    stmts.pop().filter(|_| stmts.is_empty()).map(|stmt| (stmt, told))
}
