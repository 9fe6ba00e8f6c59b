//! A load that keeps what each statement came to.

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use luxel_core::diag::{SourceId, Span};
use luxel_sdk::params::leave;

use super::asked::Questions;
use super::handing::{Handing, Hands, Written, is_plain};
use super::made::{Cost, Made};
use super::sets::set_label;
use super::values::KeptValues;
use super::{State, Statement, source_of};
use crate::eval::Evaluator;
use crate::eval::builtins;
use crate::eval::env::Env;
use crate::eval::exec::Body;
use crate::eval::names::{Facts, Known, Numbered};
use crate::eval::note::Noting;
use crate::eval::numbered::{Firsts, Tables};
use crate::syntax::{Cut, Stmt, StmtNode};
use crate::{Loaded, Settings};

/// What has been noted of a root file so far.
#[derive(Default)]
pub(in crate::eval) struct Record {
    /// Where statements may begin.
    from: usize,
    pub(super) cuts: Vec<Cut>,
    pub(super) names: Known,
    pub(super) stmts: Vec<Statement>,
    /// What was spent before the first of them and after the last.
    around: Cost,
    /// How much is set of labelled things.
    pub(super) n_sets: usize,
    /// How much was told of how it is written, and of that and its names.
    pub(super) n_written: usize,
    pub(super) n_read: usize,
}

/// What was noted of a file, of whose mistakes each is one of a statement.
struct KnownRecord {
    record: Record,
    /// The bytes of its statements.
    ranges: Vec<Range<usize>>,
    /// The labels of which something is set.
    set_labels: BTreeSet<u32>,
}

impl Record {
    fn note(&mut self, stmt: &Stmt, facts: &Facts, made: Made) {
        let range = self.cuts.get(self.stmts.len()).map_or(0..0, |cut| cut.range.clone());
        let id = narrow(self.stmts.len());
        let stmt = Statement::new(id, range, stmt, facts, &mut self.names);
        self.stmts.push(Statement { made, ..stmt });
    }
}

impl Statement {
    /// A statement that is still to be evaluated.
    pub(super) fn new(
        id: u32,
        range: Range<usize>,
        stmt: &Stmt,
        facts: &Facts,
        known: &mut Known,
    ) -> Self {
        let (names, set) = (known.numbered(facts), set_label(stmt, known));
        let declares = matches!(stmt.node, StmtNode::Units(_) | StmtNode::Param(_));
        let shadows = facts.defines.iter().any(|name| builtins::begins(&name.text));
        let is_plain = is_plain(stmt);
        let (made, hands) = (Made::default(), Hands::default());
        Self { id, range, names, made, set, declares, shadows, is_plain, hands }
    }

    /// What it concerns is not known from its names.
    pub(super) fn is_wide(&self) -> bool {
        self.declares || self.shadows || self.made.has_read()
    }
}

impl Evaluator<'_> {
    /// The statements of the root file are about to be evaluated.
    pub(in crate::eval) fn begin_record(&mut self, from: usize, cuts: Vec<Cut>) {
        let before = Cost::of(self);
        if let Some(record) = &mut self.record {
            (record.from, record.cuts, record.around) = (from, cuts, before);
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

    /// All of them have been evaluated: does what `set` says. So much was told of how they are written, and of
    /// that and their names.
    pub(in crate::eval) fn end_record(&mut self, n_written: usize, n_read: usize) {
        let (n_sets, before) = (self.labels.sets.len(), Cost::of(self));
        self.apply_sets();
        let cost = Cost::of(self).minus(before);
        if let Some(record) = &mut self.record {
            (record.n_sets, record.n_written, record.n_read) = (n_sets, n_written, n_read);
            record.around = record.around.plus(cost);
        }
    }

    /// As `finish`; and the state that the next load goes on from, if each mistake is one of a statement in a
    /// file that was read in turns.
    pub(super) fn finish_recorded(
        mut self,
        path: &Path,
        settings: &Settings,
    ) -> (Loaded, Option<State>) {
        let is_over = self.sink.over();
        if is_over() {
            leave(self.record.take());
            return (self.finish(), None);
        }
        self.lacks();
        let Some(known) = self.known_record() else { return (self.finish(), None) };
        let is_wrong = self.sink.errors() > 0;
        let looked_at = is_wrong && self.is_looked_at();
        let copy = looked_at.then(|| (self.scene.clone(), self.open_groups.clone()));
        let params = if is_wrong { self.params.clone() } else { vec![] };
        let Some(mut state) = self.state(known, path, settings) else {
            return (self.finish(), None);
        };
        if is_wrong {
            (self.scene, self.open_groups) = copy.unwrap_or_default();
            let loaded = self.finished();
            let rest = loaded.rest.filter(|_| looked_at);
            return (Loaded { rest, params, values: state.values(), ..loaded }, Some(state));
        }
        match state.gathered(&mut self, settings) {
            Some(loaded) => (loaded, Some(state)),
            None if is_over() => {
                leave(state);
                (self.finish(), None)
            }
            // What it lacks has been told.
            None => (Loaded { values: state.values(), ..self.finish() }, None),
        }
    }

    /// What was noted of a file, if it is known which statement each mistake is of.
    fn known_record(&mut self) -> Option<KnownRecord> {
        let mut record = self.record.take().filter(|record| {
            let is_whole = record.cuts.len() == record.stmts.len() && !record.stmts.is_empty();
            // What a file says beyond its last statement is not known.
            let is_whole = is_whole && !self.sink.tells("E0512");
            is_whole && !self.stopped && (self.sink.errors() > 0 || !self.damaged)
        })?;
        let ranges: Vec<_> = record.stmts.iter().map(|stmt| stmt.range.clone()).collect();
        record.warn(&self.sink, &ranges)?;
        let set_labels = record.set_labels(&self.labels)?;
        Some(KnownRecord { record, ranges, set_labels })
    }

    /// What is kept of it; `None` once it is over.
    fn state(
        &mut self,
        KnownRecord { record, ranges, set_labels }: KnownRecord,
        path: &Path,
        settings: &Settings,
    ) -> Option<State> {
        let is_over = self.sink.over();
        let place = |span: Span| in_statement(span, &ranges);
        let mut scene = std::mem::take(&mut self.scene);
        scene.root = std::mem::take(&mut self.open_groups).pop().unwrap_or_default().group;
        let Record { from, names, mut stmts, around, n_written, n_read, .. } = record;
        let text: Arc<str> = self.sources.shared(SourceId(0));
        let n_shadows = stmts.iter().filter(|stmt| stmt.shadows).count();
        let found = scene.prepare(&place, &is_over).map(|()| {
            Numbered::move_together(stmts.iter_mut().map(|stmt| &mut stmt.names).collect());
            let all = stmts.iter().take_while(|_| !is_over());
            let tables = Tables::of(&names, all.map(|stmt| &stmt.names)).0;
            let firsts = Firsts::new(&names, &tables);
            let definition = |name| Some(&text[ranges.get(firsts.definer_of(name)?)?.clone()]);
            let (text, nodes, names) = (&*text, &*scene.nodes, &names);
            let (budgets, registry, definition) = (&settings.budgets, self.registry, &definition);
            let written = Written { text, nodes, names, budgets, registry, n_shadows, definition };
            let handing = Handing::of(&mut stmts, &written, &is_over);
            (tables, handing)
        });
        let Some((tables, handing)) = found.filter(|_| !is_over()) else {
            leave((scene, stmts, names));
            return None;
        };
        let rare = stmts.iter_mut().filter_map(|stmt| stmt.made.rare.as_mut());
        let said = rare.flat_map(|rare| &mut rare.expectations);
        said.for_each(|said| said.span = place(said.span));
        let values = self.noted.take().map(|noted| KeptValues::of(noted, &ranges));
        let mut params = std::mem::take(&mut self.params);
        for param in &mut params {
            param.span = place(param.span);
        }
        Some(State {
            path: path.to_owned(),
            settings: Settings { stop: None, ..settings.clone() },
            from,
            names,
            tables,
            n_names: stmts.iter().map(|stmt| stmt.names.defines().len()).sum(),
            n_shadows,
            set_labels,
            spent: stmts.iter().fold(around, |sum, stmt| sum.plus(stmt.made.cost)),
            n_ids: stmts.len(),
            n_kept: scene.nodes.len() + scene.groups.len(),
            n_evaluated: stmts.len(),
            stmts,
            scene,
            order: None,
            handing,
            sources: self.sources.clone(),
            params,
            asked: Questions::default(),
            is_broken: false,
            is_wrong: self.sink.errors() > 0,
            has_odd_names: n_read > n_written,
            other_bytes: self.bytes_read - text.len(),
            text,
            values: values.unwrap_or_default(),
        })
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
