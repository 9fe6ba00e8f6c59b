//! Expressions.

use std::sync::Arc;

use luxel_core::diag::Span;

use super::Reader;
use super::cursor::begins_word;
use super::head::{Head, is_reserved};
use crate::syntax::make::{self, Inside};
use crate::syntax::operators::{Operand, POSTFIX_LIMIT, are_too_many, join, prefix, signed};
use crate::syntax::tree::{Arg, Comp, Expr, ExprNode, Field, Form, Name, Op};

/// Where an expression stands.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// Where it may be an object.
    Value,
    /// Before a brace, which it does not take.
    Cond,
    /// In `expect`, where `+-` ends it.
    Side,
}

impl Reader<'_> {
    /// An expression, with what the grammar takes after it: mostly the blanks and comments there.
    pub(super) fn expr(&mut self, place: Place) -> Option<Expr> {
        self.cursor.skip();
        self.deeper(|reader| {
            let head = if place == Place::Value { reader.head() } else { None };
            match head {
                Some(head) => reader.object_value(head),
                None => reader.operation(place),
            }
        })
    }

    /// An object, perhaps amended.
    fn object_value(&mut self, head: Head) -> Option<Expr> {
        let start = head.start();
        let object = Arc::new(self.object(head)?);
        let mut expr = Expr { span: self.span(start), node: ExprNode::Object(object) };
        let mut end = None;
        for _ in 0..=POSTFIX_LIMIT {
            self.cursor.skip();
            if !self.cursor.is_word("with") {
                self.cursor.at = end.unwrap_or(self.cursor.at);
                return Some(expr);
            }
            expr = self.postfix(expr)?;
            end = Some(self.cursor.at);
        }
        None
    }

    /// Operands joined by operators.
    fn operation(&mut self, place: Place) -> Option<Expr> {
        let (first, _) = self.operand(place)?;
        let Some(op) = self.infix(place) else { return Some(signed(first.prefixes, first.expr)) };
        let (operands, ops) = (self.operands.len(), self.ops.len());
        self.operands.push(first);
        let (mut next, mut end) = (Some(op), None);
        while let Some(op) = next {
            self.ops.push(op);
            let (operand, its_end) = self.operand(place)?;
            self.operands.push(operand);
            (end, next) = (its_end, self.infix(place));
        }
        if are_too_many(self.ops.len() - ops, 0, self.budgets.operators) {
            return None;
        }
        // What stands behind the last call or member is not taken.
        self.cursor.at = end.unwrap_or(self.cursor.at);
        Some(join(self.operands.drain(operands..), self.ops.drain(ops..)))
    }

    /// An operand with the blanks after it, and where its last call, index or member ends.
    fn operand(&mut self, place: Place) -> Option<(Operand, Option<usize>)> {
        self.cursor.skip();
        let mut prefixes = vec![];
        while matches!(self.cursor.peek(), Some(b'-' | b'!')) {
            let start = self.cursor.at;
            self.cursor.at += 1;
            prefixes.push((prefix(self.cursor.since(start)), self.span(start)));
            self.cursor.skip();
        }
        if are_too_many(0, prefixes.len(), self.budgets.operators) {
            return None;
        }
        let start = self.cursor.at;
        let node = self.primary(place)?;
        let mut expr = Expr { span: self.span(start), node };
        let mut end = None;
        for _ in 0..=POSTFIX_LIMIT {
            self.cursor.skip();
            if !self.is_postfix() {
                return Some((Operand { prefixes, expr }, end));
            }
            expr = self.postfix(expr)?;
            end = Some(self.cursor.at);
        }
        None
    }

    fn is_postfix(&self) -> bool {
        match self.cursor.peek() {
            Some(b'(' | b'[') => true,
            Some(b'.') => self.cursor.ahead(1).is_some_and(begins_word),
            Some(b'w') => self.cursor.is_word("with"),
            _ => false,
        }
    }

    /// A call, index, member or `with` of what stands before.
    fn postfix(&mut self, of: Expr) -> Option<Expr> {
        let start = of.span;
        let node = match self.cursor.peek()? {
            b'(' => return self.call(of),
            b'[' => {
                self.cursor.at += 1;
                let at = Box::new(self.expr(Place::Value)?);
                self.cursor.mark(b']')?;
                ExprNode::Index { of: Box::new(of), at }
            }
            b'.' => {
                self.cursor.at += 1;
                ExprNode::Member { of: Box::new(of), name: Box::new(self.name()?) }
            }
            _ => {
                self.cursor.at += "with".len();
                ExprNode::With { of: Box::new(of), fields: self.record()? }
            }
        };
        Some(Expr { span: start.to(self.span(self.cursor.at)), node })
    }

    /// A call of what stands before.
    pub(super) fn call(&mut self, callee: Expr) -> Option<Expr> {
        let (at, args) = self.args()?;
        let span = callee.span.to(at);
        Some(Expr { span, node: ExprNode::Call { callee: Box::new(callee), args } })
    }

    /// What stands between the brackets of a call, and where.
    pub(super) fn args(&mut self) -> Option<(Span, Box<[Arg]>)> {
        self.cursor.skip();
        let start = self.cursor.at;
        self.cursor.mark(b'(')?;
        let (args, _) = self.listed(b')', Self::arg)?;
        Some((self.span(start), args))
    }

    fn arg(&mut self) -> Option<Arg> {
        let start = self.cursor.at;
        self.cursor.word();
        let end = self.cursor.at;
        let name = if end > start && self.cursor.equals() {
            Some(self.placed(start..end))
        } else {
            self.cursor.at = start;
            None
        };
        Some(Arg { name, value: self.expr(Place::Value)? })
    }

    /// The operator that stands here.
    fn infix(&mut self, place: Place) -> Option<(Op, Span)> {
        let length = match self.cursor.rest() {
            [b'+', b'-', ..] if place == Place::Side => return None,
            [b'/', b'/', ..] | [b'.', b'.', b'.', ..] => return None,
            [b'.', b'.', b'=', ..] => 3,
            [b'.', b'.', ..]
            | [b'|', b'|', ..]
            | [b'&', b'&', ..]
            | [b'=' | b'!' | b'<' | b'>', b'=', ..] => 2,
            [b'<' | b'>' | b'+' | b'-' | b'*' | b'/' | b'%' | b'^', ..] => 1,
            _ => return None,
        };
        let start = self.cursor.at;
        self.cursor.at += length;
        Some((Op::of(self.cursor.since(start)), self.span(start)))
    }

    fn primary(&mut self, place: Place) -> Option<ExprNode> {
        match self.cursor.peek()? {
            b'0'..=b'9' | b'.' => self.quantity(),
            b'"' => Some(ExprNode::Text(self.string()?.text)),
            b'[' => self.list(),
            b'(' => self.tuple(),
            b'#' => self.table(),
            b'{' if place != Place::Cond => Some(ExprNode::Record(self.record()?)),
            _ if self.cursor.is_word("if") => self.choice(),
            _ => {
                let words = self.path()?;
                let may_stand = !is_reserved(&words[0].text) && !self.is_stray_head();
                may_stand.then(|| make::path(words))
            }
        }
    }

    fn list(&mut self) -> Option<ExprNode> {
        self.cursor.mark(b'[')?;
        if self.cursor.takes_word("for") {
            return self.comp();
        }
        let (inside, comma) = self.inside(b']')?;
        self.with_unit(|unit| make::bracketed(inside, comma, unit, Form::List))
    }

    fn tuple(&mut self) -> Option<ExprNode> {
        self.cursor.mark(b'(')?;
        let (inside, comma) = self.inside(b')')?;
        if matches!(&inside, Inside::Items(items) if items.is_empty()) {
            return None;
        }
        self.with_unit(|unit| make::bracketed(inside, comma, unit, Form::Tuple))
    }

    /// `[for i in 0..9 if c => value]` after `for`
    fn comp(&mut self) -> Option<ExprNode> {
        let (index, item) = self.loop_names()?;
        let over = self.expr(Place::Cond)?;
        let filtered = self.cursor.takes_word("if");
        let filter = if filtered { Some(self.expr(Place::Cond)?) } else { None };
        self.cursor.mark(b'=')?;
        self.cursor.takes(b'>').then_some(())?;
        let value = self.expr(Place::Value)?;
        self.cursor.mark(b']')?;
        Some(ExprNode::Comp(Box::new(Comp { index, item, over, filter, value })))
    }

    /// `i in` or `i, x in`: an index, if two names are given, and the item.
    pub(super) fn loop_names(&mut self) -> Option<(Option<Name>, Name)> {
        let first = self.definition()?;
        self.cursor.skip();
        let second = if self.cursor.takes(b',') { Some(self.definition()?) } else { None };
        self.cursor.takes_word("in").then_some(())?;
        Some(match second {
            Some(second) => (Some(first), second),
            None => (None, first),
        })
    }

    /// `if a { b } else { c }`
    fn choice(&mut self) -> Option<ExprNode> {
        let mut arms = vec![];
        while self.cursor.takes_word("if") {
            let cond = self.expr(Place::Cond)?;
            arms.push((cond, self.braced()?));
            self.cursor.takes_word("else").then_some(())?;
        }
        let otherwise = Box::new(self.braced()?);
        Some(ExprNode::If { arms: arms.into(), otherwise })
    }

    fn braced(&mut self) -> Option<Expr> {
        self.cursor.mark(b'{')?;
        let value = self.expr(Place::Value)?;
        self.cursor.mark(b'}')?;
        Some(value)
    }

    /// Fields between braces.
    pub(super) fn record(&mut self) -> Option<Box<[Field]>> {
        self.cursor.mark(b'{')?;
        let mut fields = vec![];
        loop {
            self.cursor.skip();
            if self.cursor.takes(b'}') {
                return Some(fields.into());
            }
            let name = self.definition()?;
            self.cursor.equals().then_some(())?;
            fields.push(Field { name, value: self.expr(Place::Value)? });
            self.cursor.skip();
            let _parted = self.cursor.takes(b',') || self.cursor.takes(b';');
        }
    }
}
