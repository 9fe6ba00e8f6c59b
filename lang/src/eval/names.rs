//! Names of a file that is being edited: each statement is looked at once, and again only if what
//! stands around it matters.

use std::collections::{BTreeSet, HashSet};
use std::sync::Arc;

use luxel_core::diag::{SourceId, Span};

use super::resolve::{Resolver, Scope, defines, mentions};
use crate::sink::Sink;
use crate::syntax::{Name, Stmt};

/// The source of spans that count from the first byte of their statement.
pub(crate) const RELATIVE: SourceId = SourceId(1);

/// What a statement has to do with the names around it.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Facts {
    /// Names that it uses and that others must define.
    free: BTreeSet<Arc<str>>,
    /// Names that it defines for what stands after it.
    pub(crate) defines: Vec<Name>,
    labels: Vec<Name>,
    /// What the functions in it mention.
    mentions: Vec<(Arc<str>, BTreeSet<Arc<str>>)>,
    /// Nothing is wrong with it whatever stands around it.
    sound: bool,
}

impl Facts {
    /// Looks at statements whose spans are relative to `text`.
    pub(crate) fn of(text: &str, stmts: &[Stmt]) -> Self {
        let mut sink = Sink::new(1);
        let mut resolver = Resolver::new(text, &mut sink);
        resolver.scopes.push(Scope::default());
        resolver.free = Some(BTreeSet::new());
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
}

/// Tells every name that is unknown, used too early or defined twice, as `resolve` does for a tree;
/// spans of the statement itself are relative, those of others have source 0. Gives the statements,
/// by number, that something was told of or may be told of.
pub(crate) fn resolve_placed<'p>(
    placed: impl Iterator<Item = Placed<'p>> + Clone,
    tell: &mut dyn FnMut(usize, Sink),
) {
    let odd = odd(placed.clone());
    if odd.is_empty() {
        return;
    }
    let mut top = Scope::default();
    for Placed { start, facts, .. } in placed.clone() {
        for name in &facts.defines {
            top.later.entry(name.text.clone()).or_insert(moved(name.span, start));
        }
        top.mentions.extend(facts.mentions.iter().cloned());
    }
    for (i, Placed { start, text, stmts, facts }) in placed.enumerate() {
        if odd.contains(&i) {
            let mut sink = Sink::new(usize::MAX);
            let mut resolver = Resolver::new(text, &mut sink);
            resolver.scopes.push(std::mem::take(&mut top));
            for stmt in stmts {
                resolver.stmt(stmt);
            }
            top = resolver.scopes.pop().unwrap_or_default();
            tell(start, sink);
        }
        for name in &facts.defines {
            let place = top.names.entry(name.text.clone()).or_insert(name.span);
            *place = moved(*place, start);
        }
        for label in &facts.labels {
            let place = top.labels.entry(label.text.clone()).or_insert(label.span);
            *place = moved(*place, start);
        }
    }
}

/// The statements, by number, that something is wrong with, or that define what is defined before.
fn odd<'p>(placed: impl Iterator<Item = Placed<'p>>) -> HashSet<usize> {
    let (mut names, mut labels) = (HashSet::new(), HashSet::new());
    let mut out = HashSet::new();
    for (i, Placed { facts, .. }) in placed.enumerate() {
        // Every name is put in, whatever was found of those before.
        let twice = |seen: &mut HashSet<_>, names: &'p [Name]| {
            names.iter().filter(|name| !seen.insert(&*name.text)).count() > 0
        };
        let known = facts.free.iter().all(|name| names.contains(&**name));
        let defined = twice(&mut names, &facts.defines);
        let labelled = twice(&mut labels, &facts.labels);
        let fine = facts.sound && known && !defined && !labelled;
        if !fine {
            out.insert(i);
        }
    }
    out
}

/// A relative span in its file.
pub(crate) fn moved(span: Span, start: usize) -> Span {
    if span.source != RELATIVE {
        return span;
    }
    let range = span.range();
    Span::new(SourceId(0), start + range.start, start + range.end)
}
