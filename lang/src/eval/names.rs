//! Names of a file that is being edited: each statement is looked at once, and again only if what
//! stands around it matters.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, SourceId, Span};

use super::mention::mention_stmts;
use super::numbered::{Firsts, Tables};
pub(crate) use super::numbered::{Known, Numbered};
use super::resolve::{Around, Resolver, Scope, defines, follows_fn, mentions, stray_names};
use crate::sink::Sink;
use crate::syntax::{Name, Stmt, StmtNode};

/// The source of spans that count from the first byte of their statement.
pub(crate) const RELATIVE: SourceId = SourceId(1);

/// What a statement has to do with the names around it.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Facts {
    /// Names that it uses and that others must define, and how often.
    pub(super) free: BTreeMap<Arc<str>, u32>,
    /// Names that it defines for what stands after it.
    pub(crate) defines: Vec<Name>,
    /// Those of them that a mistake in it only seems to define: defining them twice is not told.
    perhaps: Vec<Name>,
    pub(super) labels: Vec<Name>,
    /// What the functions in it mention.
    pub(super) mentions: Vec<(Arc<str>, BTreeSet<Arc<str>>)>,
    /// Nothing is wrong with it whatever stands around it.
    pub(super) sound: bool,
}

impl Facts {
    /// Looks at statements whose spans are relative to `text`.
    pub(crate) fn of(text: &str, stmts: &[Stmt]) -> Self {
        let mut sink = Sink::new(1);
        let mut resolver = Resolver::new(text, &mut sink);
        resolver.scopes.push(Scope::default());
        resolver.free = Some(BTreeMap::new());
        for stmt in stmts {
            resolver.stmt(stmt);
        }
        let scope = resolver.scopes.pop().unwrap_or_default();
        let free = resolver.free.take().unwrap_or_default();
        let on = || stmts.iter().filter(|stmt| !stmt.is_off());
        let mut labels: Vec<Name> =
            scope.labels.into_iter().map(|(text, span)| Name { text, span }).collect();
        labels.sort_by_key(|label| label.span);
        let strays = || on().flat_map(stray_names);
        let is_broken = |stmt: &&Stmt| matches!(stmt.node, StmtNode::Broken { .. });
        let perhaps = on().filter(is_broken).flat_map(defines).cloned().chain(strays()).collect();
        let defines = on().flat_map(defines).cloned().chain(strays()).collect();
        let mentions = on().filter_map(mentions).collect();
        Self { free, defines, perhaps, labels, mentions, sound: sink.errors() == 0 }
    }

    /// Whether it is one of the statements that nothing around concerns.
    pub(crate) fn is_alone(&self) -> bool {
        self.sound && self.free.is_empty() && self.defines.is_empty() && self.labels.is_empty()
    }
}

/// A statement in its place.
pub(crate) struct Placed<'p> {
    pub(crate) start: usize,
    /// What it is in the file.
    pub(crate) text: &'p str,
    pub(crate) stmts: &'p [Stmt],
    pub(crate) facts: &'p Facts,
    pub(crate) numbered: &'p Numbered,
}

/// Tells every name that is unknown, used too early or defined twice, as `resolve` does for a tree,
/// of statements whose names `known` has. Those that nothing is wrong with are not read.
pub(crate) fn resolve_placed<'p>(
    known: &Known,
    all: &(impl Iterator<Item = &'p Numbered> + Clone),
    at: &dyn Fn(usize) -> Placed<'p>,
    sink: &mut Sink,
) {
    let (tables, odd) = Tables::of(known, all.clone());
    let firsts = Firsts::new(known, &tables);
    let around = Among { firsts: &firsts, at };
    let mut mentions: Option<Mentions> = None;
    for i in odd {
        let Placed { start, text, stmts, facts, numbered } = at(i);
        // What is only counted is not looked at.
        if sink.is_full()
            && let Some(n) = firsts.count(i, numbered)
        {
            sink.count(n);
            continue;
        }
        if mentions.is_none() && text.contains("fn") {
            mentions = Some(all_mentions(all.clone(), at));
        }
        let mut part = sink.rest();
        tell_odd(&Odd { i, text, stmts, facts }, &around, &mut mentions, &mut part);
        part.each(&mut |found| place(found, start));
        sink.absorb(part);
    }
}

/// A statement whose names are looked at among those of its file.
pub(super) struct Odd<'p> {
    /// Which of the file's statements.
    pub(super) i: usize,
    pub(super) text: &'p str,
    pub(super) stmts: &'p [Stmt],
    pub(super) facts: &'p Facts,
}

/// Names of statements that are read already.
struct Among<'a, 'p> {
    firsts: &'a Firsts<'a>,
    at: &'a dyn Fn(usize) -> Placed<'p>,
}

impl Among<'_, '_> {
    fn span(&self, i: usize, names: fn(&Facts) -> &[Name], text: &str) -> Option<(usize, Span)> {
        let placed = (self.at)(i);
        let name = names(placed.facts).iter().find(|name| *name.text == *text)?;
        Some((i, moved(name.span, placed.start)))
    }
}

impl Around for Among<'_, '_> {
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
        let definer = self.firsts.definer(name).filter(|definer| *definer < statement);
        definer.is_some_and(|definer| {
            let Placed { text, facts, .. } = (self.at)(definer);
            let mut names = facts.defines.iter().filter(|known| *known.text == *name);
            names.next().is_some_and(|known| follows_fn(text, known.span))
        })
    }
}

/// Tells what is wrong with the names of a statement; `mentions` are those of all functions, if it may
/// have some.
pub(super) fn tell_odd(
    odd: &Odd<'_>,
    around: &dyn Around,
    mentions: &mut Option<Mentions>,
    sink: &mut Sink,
) {
    let mut scope = scope(odd, around);
    scope.mentions = mentions.take().unwrap_or_default();
    let mut resolver = Resolver::new(odd.text, sink);
    resolver.around = Some((around, odd.i));
    resolver.scopes.push(scope);
    for stmt in odd.stmts {
        resolver.stmt(stmt);
    }
    let scope = resolver.scopes.pop().unwrap_or_default();
    *mentions = Some(scope.mentions).filter(|mentions| !mentions.is_empty());
}

/// What the functions of a file mention.
pub(super) type Mentions = BTreeMap<Arc<str>, BTreeSet<Arc<str>>>;

fn all_mentions<'p>(
    all: impl Iterator<Item = &'p Numbered>,
    at: &dyn Fn(usize) -> Placed<'p>,
) -> Mentions {
    let functions = all.enumerate().filter(|(_, numbered)| numbered.has_functions);
    functions.flat_map(|(i, _)| at(i).facts.mentions.iter().cloned()).collect()
}

/// What stands around a statement, as far as it mentions it.
fn scope(odd: &Odd<'_>, around: &dyn Around) -> Scope {
    let mut scope = Scope::default();
    let mut mentioned = BTreeSet::new();
    mention_stmts(odd.stmts, &mut mentioned);
    let own = odd.facts.defines.iter().chain(&odd.facts.labels);
    mentioned.extend(own.map(|name| name.text.clone()));
    for text in mentioned {
        if let Some((definer, span)) = around.definer(&text) {
            if definer < odd.i {
                scope.names.insert(text.clone(), span);
            }
            scope.later.insert(text.clone(), span);
        }
        if let Some((_, span)) = around.labeller(&text).filter(|(i, _)| *i < odd.i) {
            scope.labels.insert(text, span);
        }
    }
    scope
}

/// Brings a diagnostic of a statement into its file.
pub(crate) fn place(diagnostic: &mut Diagnostic, start: usize) {
    diagnostic.place(|span| moved(span, start));
}

/// A relative span in its file.
pub(crate) fn moved(span: Span, start: usize) -> Span {
    if span.source != RELATIVE {
        return span;
    }
    let range = span.range();
    Span::new(SourceId(0), start + range.start, start + range.end)
}
