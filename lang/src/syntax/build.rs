//! From pest's pairs to the syntax tree: statements.

use std::ops::Range;
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, SourceId, Span};
use luxel_sdk::params::{Dimension, Unit};
use pest::iterators::Pair;

use super::Rule;
use super::edits::Edits;
use super::gaps::Gaps;
use super::make;
use super::tree::{
    Block, Doc, Expect, Expr, ExprNode, Field, FnBody, FnDef, FnParam, Name, Object, ParamDef,
    Quoted, Stmt, StmtNode,
};
use crate::budgets::Budgets;
use crate::sink::Sink;
use crate::words::{BEFORE_NAMES, RESERVED};

/// Builds trees from pairs whose text begins at byte `base` of the source.
pub(super) struct Builder<'a> {
    pub(super) source: SourceId,
    pub(super) base: usize,
    pub(super) sink: &'a mut Sink,
    pub(super) budgets: &'a Budgets,
    /// What stands in the text for statements that cannot be read.
    pub(super) gaps: Gaps,
    /// What was mended of what was written.
    pub(super) edits: Edits,
    /// A word that begins an object, and its last byte, if it was read as a unit.
    pub(super) begun: Option<(usize, Name)>,
}

fn is_keyword(rule: Rule) -> bool {
    matches!(
        rule,
        Rule::kw_let
            | Rule::kw_param
            | Rule::kw_fn
            | Rule::kw_for
            | Rule::kw_if
            | Rule::kw_else
            | Rule::kw_include
            | Rule::kw_import
            | Rule::kw_use
            | Rule::kw_plugin
            | Rule::kw_version
            | Rule::kw_place
            | Rule::kw_set
            | Rule::kw_assert
            | Rule::kw_expect
            | Rule::kw_units
            | Rule::kw_with
            | Rule::kw_where
            | Rule::kw_as
            | Rule::kw_in
            | Rule::eq
            | Rule::colon
            | Rule::pm
    )
}

/// The parts of a rule, its keywords and punctuation left out.
pub(super) fn parts(pair: Pair<'_, Rule>) -> impl Iterator<Item = Pair<'_, Rule>> {
    pair.into_inner().filter(|part| !is_keyword(part.as_rule()))
}

/// Takes the next part; the grammar promises it.
pub(super) fn take<'i>(parts: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Pair<'i, Rule> {
    parts.next().expect("the grammar promises this part")
}

impl<'a> Builder<'a> {
    /// Of a text as it was written.
    pub(super) fn new(
        (source, base): (SourceId, usize),
        sink: &'a mut Sink,
        budgets: &'a Budgets,
    ) -> Self {
        let (gaps, edits) = (Gaps::default(), Edits::default());
        Self { source, base, sink, budgets, gaps, edits, begun: None }
    }
}

impl Builder<'_> {
    pub(super) fn span(&self, pair: &Pair<'_, Rule>) -> Span {
        let span = pair.as_span();
        self.written(span.start()..span.end())
    }

    /// Where some bytes of the text were written.
    pub(super) fn written(&self, range: Range<usize>) -> Span {
        let written = Span::new(self.source, self.base + range.start, self.base + range.end);
        if self.edits.is_empty() { written } else { self.edits.span(written) }
    }

    pub(super) fn name(&self, pair: &Pair<'_, Rule>) -> Name {
        Name { text: pair.as_str().into(), span: self.span(pair) }
    }

    /// A name that is being defined.
    pub(super) fn definition(&mut self, pair: &Pair<'_, Rule>) -> Name {
        let name = self.name(pair);
        let (text, span) = (pair.get_input(), pair.as_span());
        let is_given = || text[span.end()..].trim_start().starts_with('=');
        // In `let let = 3` the second is the name.
        let follows = |word: &&str| text[..span.start()].trim_end().ends_with(word);
        if BEFORE_NAMES.contains(&&*name.text) && is_given() && !BEFORE_NAMES.iter().any(follows) {
            self.sink.push(make::nameless(&name.text, name.span));
            return name;
        }
        self.is_free(&name);
        name
    }

    /// Whether a name is no word of the language; tells of one that is.
    fn is_free(&mut self, name: &Name) -> bool {
        let is_free = !RESERVED.contains(&&*name.text);
        if !is_free {
            let message = format!("`{}` is a word of the language and cannot be a name", name.text);
            self.sink.push(
                Diagnostic::error("E0019", name.span, message)
                    .help(format!("choose another name, as `{}_`", name.text)),
            );
        }
        is_free
    }

    /// The statements of a file or block.
    pub(super) fn stmt(&mut self, pair: Pair<'_, Rule>) -> Stmt {
        if let Some(broken) = self.gaps.at(self.base + pair.as_span().start()) {
            return broken;
        }
        let mut span = self.span(&pair);
        let (mut docs, mut attrs) = (vec![], vec![]);
        for part in pair.into_inner() {
            let place = self.span(&part);
            match part.as_rule() {
                Rule::doc => docs.push(make::doc(part.as_str(), place)),
                Rule::attr => {
                    let text = part.as_str()[1..].into();
                    attrs.push(self.attribute(Name { text, span: place }));
                }
                _ => {
                    if docs.is_empty() && attrs.is_empty() {
                        span = place;
                    }
                    span.end = place.end;
                    let node = self.node(part, &docs);
                    return Stmt {
                        span,
                        docs: docs.into(),
                        attrs: attrs.into(),
                        node,
                        is_likely: false,
                    };
                }
            }
        }
        let node = StmtNode::Broken { defines: Box::default() };
        Stmt { span, docs: docs.into(), attrs: attrs.into(), node, is_likely: false }
    }

    fn attribute(&mut self, name: Name) -> Name {
        if &*name.text != "off" {
            let message = format!("unknown attribute `@{}`", name.text);
            self.sink
                .push(Diagnostic::error("E0028", name.span, message).help(
                    "the only attribute is `@off`, which takes a statement out of the scene",
                ));
        }
        name
    }

    fn node(&mut self, pair: Pair<'_, Rule>, docs: &[Doc]) -> StmtNode {
        let rule = pair.as_rule();
        let mut parts = parts(pair);
        match rule {
            Rule::field => self.field_stmt(&mut parts),
            Rule::object => StmtNode::Object(Arc::new(self.object(&mut parts))),
            Rule::let_stmt => {
                let name = self.definition(&take(&mut parts));
                let mut next = take(&mut parts);
                let mut ty = None;
                if next.as_rule() == Rule::ty {
                    ty = Some(Box::new(make::ty(next.as_str(), self.span(&next))));
                    next = take(&mut parts);
                }
                StmtNode::Let { name, ty, value: self.expr(next) }
            }
            Rule::param_stmt => StmtNode::Param(Arc::new(self.param(&mut parts, docs))),
            Rule::fn_def => StmtNode::Fn(Arc::new(self.function(&mut parts))),
            Rule::for_stmt => {
                let (index, item) = self.loop_names(&mut parts);
                let over = Box::new(self.expr(take(&mut parts)));
                let body = Box::new(self.block(take(&mut parts)));
                StmtNode::For { index, item, over, body }
            }
            Rule::if_stmt => self.if_stmt(&mut parts),
            Rule::include_stmt => {
                let path = self.string(take(&mut parts));
                let with = parts.next().map_or_else(Box::default, |record| self.record(record));
                StmtNode::Include { path, with }
            }
            Rule::import_stmt => {
                let path = self.string(take(&mut parts));
                StmtNode::Import { path, name: self.definition(&take(&mut parts)) }
            }
            Rule::use_stmt => {
                let name = self.string(take(&mut parts));
                StmtNode::Use { name, version: parts.next().map(|part| self.string(part)) }
            }
            Rule::place_stmt => self.place(&mut parts),
            Rule::set_stmt => {
                let path = self.path(take(&mut parts));
                StmtNode::Set { path, value: self.expr(take(&mut parts)) }
            }
            Rule::assert_stmt => {
                let cond = self.expr(take(&mut parts));
                StmtNode::Assert { cond, message: self.string(take(&mut parts)) }
            }
            Rule::expect_stmt => StmtNode::Expect(Arc::new(self.expectation(&mut parts))),
            Rule::unit_stmt => StmtNode::Units(self.record(take(&mut parts))),
            _ => {
                let callee = take(&mut parts);
                let span = self.span(&callee);
                let callee = Expr { span, node: ExprNode::Path(self.path(callee)) };
                let call = take(&mut parts);
                StmtNode::Call(self.call(callee, call))
            }
        }
    }

    fn expectation<'i>(&mut self, parts: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Expect {
        let what = self.name(&take(parts));
        let given = Box::default();
        let mut out = Expect { what, at: None, path: None, values: vec![], given };
        for part in parts {
            match part.as_rule() {
                Rule::string => out.path = Some(self.string(part)),
                Rule::call => out.at = Some((self.span(&part), self.args(part))),
                Rule::record => out.given = self.record(part),
                _ => out.values.push(self.expr(part)),
            }
        }
        out
    }

    fn place<'i>(&mut self, parts: &mut impl Iterator<Item = Pair<'i, Rule>>) -> StmtNode {
        let path = take(parts);
        let span = self.span(&path);
        let path = self.path(path);
        let is_free = self.is_free(&path[0]);
        let node = if is_free { ExprNode::Path(path) } else { ExprNode::Broken };
        let what = Box::new(Expr { span, node });
        let (mut label, mut body) = (None, None);
        for part in parts {
            match part.as_rule() {
                Rule::string => label = Some(self.string(part)),
                _ => body = Some(Box::new(self.block(part))),
            }
        }
        StmtNode::Place { what, label, body }
    }

    fn if_stmt<'i>(&mut self, parts: &mut impl Iterator<Item = Pair<'i, Rule>>) -> StmtNode {
        let cond = self.expr(take(parts));
        let mut arms = vec![(cond, self.block(take(parts)))];
        let mut otherwise = None;
        for part in parts {
            if part.as_rule() == Rule::elif {
                let mut inner = self::parts(part);
                let cond = self.expr(take(&mut inner));
                arms.push((cond, self.block(take(&mut inner))));
            } else {
                otherwise = Some(Box::new(self.block(part)));
            }
        }
        StmtNode::If { arms: arms.into(), otherwise }
    }

    /// `i` or `i, x`: an index, if two names are given, and the item.
    pub(super) fn loop_names<'i>(
        &mut self,
        parts: &mut impl Iterator<Item = Pair<'i, Rule>>,
    ) -> (Option<Name>, Name) {
        let mut names = take(parts).into_inner();
        let first = self.definition(&take(&mut names));
        match names.next() {
            Some(second) => (Some(first), self.definition(&second)),
            None => (None, first),
        }
    }

    fn param<'i>(
        &mut self,
        parts: &mut impl Iterator<Item = Pair<'i, Rule>>,
        docs: &[Doc],
    ) -> ParamDef {
        let name = self.definition(&take(parts));
        let ty = take(parts);
        let ty = make::ty(ty.as_str(), self.span(&ty));
        let value = self.expr(take(parts));
        let range = parts.next().map(|range| self.expr(range));
        ParamDef { name, ty, value, range, doc: make::lines(docs) }
    }

    fn function<'i>(&mut self, parts: &mut impl Iterator<Item = Pair<'i, Rule>>) -> FnDef {
        let name = self.definition(&take(parts));
        let mut params = vec![];
        loop {
            let part = take(parts);
            match part.as_rule() {
                Rule::fn_param => params.push(self.fn_param(part)),
                Rule::block => {
                    let body = FnBody::Template(self.block(part));
                    return FnDef { name, params: params.into(), body };
                }
                _ => {
                    let body = FnBody::Value(self.expr(part));
                    return FnDef { name, params: params.into(), body };
                }
            }
        }
    }

    fn fn_param(&mut self, pair: Pair<'_, Rule>) -> FnParam {
        let mut parts = parts(pair);
        let name = self.definition(&take(&mut parts));
        let ty = take(&mut parts);
        let ty = make::ty(ty.as_str(), self.span(&ty));
        FnParam { name, ty, default: parts.next().map(|value| self.expr(value)) }
    }

    pub(super) fn block(&mut self, pair: Pair<'_, Rule>) -> Block {
        let span = self.span(&pair);
        let mut stmts = vec![];
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::stmt => stmts.push(self.stmt(part)),
                _ => self.dangling(&part),
            }
        }
        Block { span, stmts: stmts.into() }
    }

    /// Warns of a doc comment that documents nothing.
    pub(super) fn dangling(&mut self, pair: &Pair<'_, Rule>) {
        if pair.as_rule() != Rule::dangling_doc {
            return;
        }
        let message = "this doc comment is attached to nothing";
        self.sink.push(
            Diagnostic::warning("E0022", self.span(pair), message)
                .help("`///` documents the statement after it; `//` is a plain comment"),
        );
    }

    fn field<'i>(&mut self, parts: &mut impl Iterator<Item = Pair<'i, Rule>>) -> Field {
        let name = self.definition(&take(parts));
        Field { name, value: self.expr(take(parts)) }
    }

    /// A field, or `units = mm`.
    fn field_stmt<'i>(&mut self, parts: &mut impl Iterator<Item = Pair<'i, Rule>>) -> StmtNode {
        let name = take(parts);
        let value = take(parts);
        let unit =
            Unit::named(value.as_str().trim()).filter(|unit| unit.dimension == Dimension::LENGTH);
        if name.as_str() != "units" || unit.is_none() {
            return StmtNode::Field(Field {
                name: self.definition(&name),
                value: self.expr(value),
            });
        }
        let start = value.as_span().start();
        let unit = self.written(start..start + value.as_str().trim_end().len());
        let span = self.span(&name).to(unit);
        let mended = format!("units {{ length = {} }}", value.as_str().trim());
        let found = Diagnostic::error("E0023", span, "units stand between `{` and `}`");
        self.sink.push(found.guess(span, mended));
        let name = Name { text: "length".into(), span: unit };
        StmtNode::Units(Box::new([Field { name, value: self.expr(value) }]))
    }

    pub(super) fn record(&mut self, pair: Pair<'_, Rule>) -> Box<[Field]> {
        pair.into_inner().map(|field| self.field(&mut parts(field))).collect()
    }

    pub(super) fn object<'i>(
        &mut self,
        parts: &mut impl Iterator<Item = Pair<'i, Rule>>,
    ) -> Object {
        let (mut category, mut kind, mut label) = (None, None, None);
        let head = take(parts);
        let start = head.as_span().start();
        let before = &head.get_input()[..start];
        let begun = self.begun.take().filter(|(end, _)| {
            before.get(*end..).is_some_and(|gap| !gap.is_empty() && gap.trim().is_empty())
        });
        for part in head.into_inner() {
            match part.as_rule() {
                Rule::ident => category = Some(self.name(&part)),
                Rule::kind => kind = Some(self.name(&part)),
                _ => label = Some(self.string(part)),
            }
        }
        let mut category = category.expect("a head begins with a word");
        if let Some((_, word)) = begun {
            (category, kind) = (word, Some(category));
        }
        Object { category, kind, label, body: self.block(take(parts)) }
    }

    pub(super) fn path(&mut self, pair: Pair<'_, Rule>) -> Box<[Name]> {
        pair.into_inner().map(|name| self.name(&name)).collect()
    }

    pub(super) fn string(&mut self, pair: Pair<'_, Rule>) -> Quoted {
        let span = self.span(&pair);
        let body = take(&mut pair.into_inner());
        if body.as_str().len() > self.budgets.string {
            let message = format!("a string of more than {} bytes", self.budgets.string);
            self.sink.push(Diagnostic::error("E0509", span, message));
            return Name { text: "".into(), span };
        }
        Name { text: make::unescape(body.as_str()), span }
    }
}
