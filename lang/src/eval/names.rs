//! Names of a file that is being edited: each statement is looked at once, and again only if what
//! stands around it matters.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, SourceId, Span};

use super::mention::mention_stmts;
use super::numbered::Firsts;
pub(crate) use super::numbered::{Known, Numbered};
use super::resolve::{Resolver, Scope, defines, mentions};
use crate::sink::Sink;
use crate::syntax::{Name, Stmt};

/// The source of spans that count from the first byte of their statement.
pub(crate) const RELATIVE: SourceId = SourceId(1);

/// What a statement has to do with the names around it.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Facts {
    /// Names that it uses and that others must define, and how often.
    pub(super) free: BTreeMap<Arc<str>, u32>,
    /// Names that it defines for what stands after it.
    pub(crate) defines: Vec<Name>,
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
        let defines = on().filter_map(defines).cloned().collect();
        let mentions = on().filter_map(mentions).collect();
        Self { free, defines, labels, mentions, sound: sink.errors() == 0 }
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
    let (firsts, odd) = Firsts::of(known, all.clone());
    let mut mentions: Option<Mentions> = None;
    for i in odd {
        let placed = at(i);
        // What is only counted is not looked at.
        if sink.is_full()
            && let Some(n) = firsts.count(i, placed.numbered)
        {
            sink.count(n);
            continue;
        }
        let mut scope = scope(&firsts, i, at);
        if placed.text.contains("fn") {
            scope.mentions = mentions.take().unwrap_or_else(|| all_mentions(all.clone(), at));
        }
        let before = || firsts.before(i);
        let mut part = sink.like();
        let mut resolver = Resolver::new(placed.text, &mut part);
        resolver.before = Some(&before);
        resolver.scopes.push(scope);
        for stmt in placed.stmts {
            resolver.stmt(stmt);
        }
        let scope = resolver.scopes.pop().unwrap_or_default();
        mentions = mentions.or_else(|| Some(scope.mentions).filter(|of| !of.is_empty()));
        part.each(&mut |found| place(found, placed.start));
        sink.absorb(part);
    }
}

/// What the functions of a file mention.
type Mentions = BTreeMap<Arc<str>, BTreeSet<Arc<str>>>;

fn all_mentions<'p>(
    all: impl Iterator<Item = &'p Numbered>,
    at: &dyn Fn(usize) -> Placed<'p>,
) -> Mentions {
    let functions = all.enumerate().filter(|(_, numbered)| numbered.has_functions);
    functions.flat_map(|(i, _)| at(i).facts.mentions.iter().cloned()).collect()
}

/// What stands around a statement, as far as it mentions it.
fn scope<'p>(firsts: &Firsts<'_>, i: usize, at: &dyn Fn(usize) -> Placed<'p>) -> Scope {
    let Placed { stmts, facts, .. } = at(i);
    let mut scope = Scope::default();
    let mut mentioned = BTreeSet::new();
    mention_stmts(stmts, &mut mentioned);
    mentioned.extend(facts.defines.iter().chain(&facts.labels).map(|name| name.text.clone()));
    let span = |definer: usize, names: fn(&Facts) -> &[Name], text: &str| {
        let placed = at(definer);
        let name = names(placed.facts).iter().find(|name| *name.text == *text);
        name.map(|name| moved(name.span, placed.start))
    };
    for text in mentioned {
        let definer = firsts.definer(&text);
        if let Some((definer, span)) =
            definer.and_then(|it| Some((it, span(it, |facts| &facts.defines, &text)?)))
        {
            if definer < i {
                scope.names.insert(text.clone(), span);
            }
            scope.later.insert(text.clone(), span);
        }
        let labeller = firsts.labeller(&text).filter(|labeller| *labeller < i);
        if let Some(span) = labeller.and_then(|it| span(it, |facts| &facts.labels, &text)) {
            scope.labels.insert(text, span);
        }
    }
    scope
}

/// Brings a diagnostic of a statement into its file.
pub(crate) fn place(diagnostic: &mut Diagnostic, start: usize) {
    let place = |span: &mut Span| *span = moved(*span, start);
    diagnostic.labels.iter_mut().for_each(|label| place(&mut label.span));
    diagnostic.fixes.iter_mut().for_each(|fix| place(&mut fix.span));
}

/// A relative span in its file.
pub(crate) fn moved(span: Span, start: usize) -> Span {
    if span.source != RELATIVE {
        return span;
    }
    let range = span.range();
    Span::new(SourceId(0), start + range.start, start + range.end)
}
