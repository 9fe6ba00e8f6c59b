//! A load that keeps what each statement came to.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use luxel_core::diag::{SourceId, Span};

use super::asked::Questions;
use super::made::{Cost, Made};
use super::values::KeptValues;
use super::{State, Statement, source_of};
use crate::eval::Evaluator;
use crate::eval::builtins;
use crate::eval::env::Env;
use crate::eval::exec::Body;
use crate::eval::names::{Facts, Known};
use crate::eval::note::Noting;
use crate::eval::numbered::Tables;
use crate::syntax::{Cut, Stmt, StmtNode};
use crate::{Loaded, Settings};

/// What has been noted of a root file so far.
#[derive(Default)]
pub(in crate::eval) struct Record {
    /// Where statements may begin.
    from: usize,
    cuts: Vec<Cut>,
    names: Known,
    stmts: Vec<Statement>,
    /// What was spent before the first of them.
    before: Cost,
    /// Some statement changes others, in ways that names do not tell.
    has_sets: bool,
}

impl Record {
    fn note(&mut self, stmt: &Stmt, facts: &Facts, made: Made) {
        let names = self.names.numbered(facts);
        let range = self.cuts.get(self.stmts.len()).map_or(0..0, |cut| cut.range.clone());
        let id = narrow(self.stmts.len());
        self.stmts.push(Statement::new(id, range, names, stmt, facts).with(made));
    }
}

impl Statement {
    /// A statement that is still to be evaluated.
    pub(super) fn new(
        id: u32,
        range: Range<usize>,
        names: crate::eval::names::Numbered,
        stmt: &Stmt,
        facts: &Facts,
    ) -> Self {
        let declares = matches!(stmt.node, StmtNode::Units(_) | StmtNode::Param(_));
        let shadows = facts.defines.iter().any(|name| builtins::begins(&name.text));
        let is_wide = declares || shadows;
        Self { id, range, names, made: Made::default(), declares, shadows, is_wide }
    }

    /// The same, evaluated.
    pub(super) fn with(self, made: Made) -> Self {
        Self { is_wide: self.is_wide || made.has_read(), made, ..self }
    }
}

impl Evaluator<'_> {
    /// The statements of the root file are about to be evaluated.
    pub(in crate::eval) fn begin_record(&mut self, from: usize, cuts: Vec<Cut>) {
        let before = Cost::of(self);
        if let Some(record) = &mut self.record {
            (record.from, record.cuts, record.before) = (from, cuts, before);
        }
    }

    /// Evaluates statements of the root file; what each came to, if that is wanted.
    pub(in crate::eval) fn stmts_recorded(
        &mut self,
        stmts: &[Stmt],
        env: &Env,
        body: &mut Body,
    ) -> Vec<Made> {
        if self.record.is_none() {
            self.stmts(stmts, env, body);
            return vec![];
        }
        let first = self.record.as_ref().map_or(0, |record| record.stmts.len());
        let one = |(i, stmt): (usize, &Stmt)| {
            let mark = self.mark();
            self.begin_noting(Noting { id: source_of(narrow(i)), span: stmt.span });
            self.stmts(std::slice::from_ref(stmt), env, body);
            self.end_noting();
            self.made_since(&mark)
        };
        (first..).zip(stmts).map(one).collect()
    }

    /// Notes the next of them.
    pub(in crate::eval) fn record_next(&mut self, stmt: &Stmt, facts: &Facts, made: Option<Made>) {
        if let (Some(record), Some(made)) = (&mut self.record, made) {
            record.note(stmt, facts, made);
        }
    }

    /// All of them have been evaluated, and `set` is still to be.
    pub(in crate::eval) fn end_record(&mut self) {
        if let Some(record) = &mut self.record {
            record.has_sets = !self.labels.sets.is_empty();
        }
    }

    /// As `finish`; and the state that the next load goes on from, if everything went well in a file that
    /// was read in turns.
    pub(super) fn finish_recorded(
        mut self,
        path: &Path,
        settings: &Settings,
    ) -> (Loaded, Option<State>) {
        self.lacks();
        let record = self.record.take().filter(|record| {
            let is_whole = record.cuts.len() == record.stmts.len() && !record.stmts.is_empty();
            is_whole && !record.has_sets && self.sink.is_empty() && !self.damaged && !self.stopped
        });
        let Some(record) = record else { return (self.finish(), None) };
        let text: Arc<str> = self.sources.shared(SourceId(0));
        let ranges: Vec<_> = record.stmts.iter().map(|stmt| stmt.range.clone()).collect();
        let place = |span: Span| in_statement(span, &ranges);
        let mut scene = std::mem::take(&mut self.scene);
        scene.root = std::mem::take(&mut self.open_groups).pop().unwrap_or_default().group;
        scene.prepare(&place);
        let mut stmts = record.stmts;
        for stmt in &mut stmts {
            stmt.names.move_together();
        }
        let rare = stmts.iter_mut().filter_map(|stmt| stmt.made.rare.as_mut());
        let said = rare.flat_map(|rare| &mut rare.expectations);
        said.for_each(|said| said.span = place(said.span));
        let (tables, _) = Tables::of(&record.names, stmts.iter().map(|stmt| &stmt.names));
        let values = self.noted.take().map(|noted| KeptValues::of(noted, &ranges));
        let mut params = std::mem::take(&mut self.params);
        for param in &mut params {
            param.span = place(param.span);
        }
        let mut state = State {
            path: path.to_owned(),
            settings: Settings { stop: None, ..settings.clone() },
            from: record.from,
            names: record.names,
            tables,
            n_names: stmts.iter().map(|stmt| stmt.names.defines().len()).sum(),
            n_shadows: stmts.iter().filter(|stmt| stmt.shadows).count(),
            spent: stmts.iter().fold(record.before, |sum, stmt| sum.plus(stmt.made.cost)),
            n_ids: stmts.len(),
            n_kept: scene.nodes.len() + scene.groups.len(),
            stmts,
            scene,
            sources: self.sources.clone(),
            params,
            asked: Questions::default(),
            other_bytes: self.bytes_read - text.len(),
            text,
            n_evaluated: 0,
            values: values.unwrap_or_default(),
        };
        state.n_evaluated = state.stmts.len();
        match state.gathered(&mut self, settings) {
            Some(loaded) => (loaded, Some(state)),
            // What it lacks has been told.
            None => (Loaded { values: state.values(), ..self.finish() }, None),
        }
    }
}

fn narrow(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

/// A place in the root file as one in its statement.
pub(super) fn in_statement(span: Span, ranges: &[Range<usize>]) -> Span {
    let at = span.range();
    let next = ranges.partition_point(|range| range.start <= at.start);
    match next.checked_sub(1).filter(|_| span.source == SourceId(0)) {
        Some(i) => {
            let start = ranges[i].start;
            Span::new(source_of(narrow(i)), at.start - start, at.end - start)
        }
        None => span,
    }
}
