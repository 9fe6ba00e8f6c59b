//! From pest's pairs to the syntax tree: expressions.

use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Span};
use luxel_sdk::params::Unit;
use pest::iterators::Pair;

use super::Rule;
use super::build::{Builder, parts, take};
use super::number::{self, BadToken};
use super::tree::{Arg, Comp, Expr, ExprNode, Form, Op};

/// Calls, indices and members after one operand: more than any person writes.
const POSTFIX_LIMIT: usize = 64;

/// An operand with the signs before it.
struct Operand {
    prefixes: Vec<(Op, Span)>,
    expr: Expr,
}

impl Builder<'_> {
    /// An expression or condition.
    pub(super) fn expr(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let whole = self.span(&pair);
        let (mut operands, mut ops, mut prefixes) = (Vec::<Operand>::new(), vec![], vec![]);
        let (mut postfixes, mut excess) = (0, None);
        for part in pair.into_inner() {
            let span = self.span(&part);
            match part.as_rule() {
                Rule::prefix => prefixes.push((prefix(part.as_str()), span)),
                Rule::infix => ops.push((Op::of(part.as_str()), span)),
                Rule::call | Rule::index | Rule::member | Rule::amend => {
                    postfixes += 1;
                    if postfixes > POSTFIX_LIMIT {
                        excess = excess.or(Some(span));
                    } else if let Some(last) = operands.pop() {
                        let expr = self.postfix(last.expr, part);
                        operands.push(Operand { expr, ..last });
                    }
                }
                _ => {
                    postfixes = 0;
                    let expr = self.primary(part);
                    operands.push(Operand { prefixes: std::mem::take(&mut prefixes), expr });
                }
            }
            let count = ops.len().max(prefixes.len() * self.budgets.operators / 8);
            if count > self.budgets.operators {
                excess = excess.or(Some(span));
            }
        }
        if let Some(span) = excess {
            let message =
                format!("more than {} operators in one expression", self.budgets.operators);
            self.sink.push(
                Diagnostic::error("E0506", span, message)
                    .help("give a part of it a name with `let`, or use a list and a loop"),
            );
            return Expr { span: whole, node: ExprNode::Broken };
        }
        chain(operands, ops, 0)
    }

    fn postfix(&mut self, of: Expr, pair: Pair<'_, Rule>) -> Expr {
        let span = of.span.to(self.span(&pair));
        let of_box = |of| Box::new(of);
        let node = match pair.as_rule() {
            Rule::call => return self.call(of, pair),
            Rule::index => {
                let at = Box::new(self.expr(take(&mut pair.into_inner())));
                ExprNode::Index { of: of_box(of), at }
            }
            Rule::member => {
                let name = self.name(&take(&mut pair.into_inner()));
                ExprNode::Member { of: of_box(of), name }
            }
            _ => {
                let fields = self.record(take(&mut parts(pair)));
                ExprNode::With { of: of_box(of), fields }
            }
        };
        Expr { span, node }
    }

    /// A call of what stands before.
    pub(super) fn call(&mut self, callee: Expr, pair: Pair<'_, Rule>) -> Expr {
        let span = callee.span.to(self.span(&pair));
        Expr { span, node: ExprNode::Call { callee: Box::new(callee), args: self.args(pair) } }
    }

    /// What stands between the brackets of a call.
    pub(super) fn args(&mut self, pair: Pair<'_, Rule>) -> Vec<Arg> {
        pair.into_inner().map(|arg| self.arg(arg)).collect()
    }

    fn arg(&mut self, pair: Pair<'_, Rule>) -> Arg {
        let mut parts = parts(pair);
        let first = take(&mut parts);
        if first.as_rule() == Rule::ident {
            let name = self.name(&first);
            return Arg { name: Some(name), value: self.expr(take(&mut parts)) };
        }
        Arg { name: None, value: self.expr(first) }
    }

    fn primary(&mut self, pair: Pair<'_, Rule>) -> Expr {
        let span = self.span(&pair);
        let node = match pair.as_rule() {
            Rule::quantity => self.quantity(pair),
            Rule::string => ExprNode::Text(self.string(pair).text),
            Rule::list => self.items(pair, Form::List),
            Rule::paren => self.items(pair, Form::Tuple),
            Rule::bulk => self.table(pair),
            Rule::list_comp => self.comp(pair),
            Rule::if_expr => self.if_expr(pair),
            Rule::record => ExprNode::Record(self.record(pair)),
            Rule::obj_expr => ExprNode::Object(Arc::new(self.object(&mut parts(pair)))),
            _ => {
                let path = self.path(take(&mut pair.into_inner()));
                match (path.len(), &*path[0].text) {
                    (1, "true") => ExprNode::Bool(true),
                    (1, "false") => ExprNode::Bool(false),
                    _ => ExprNode::Path(path),
                }
            }
        };
        Expr { span, node }
    }

    fn quantity(&mut self, pair: Pair<'_, Rule>) -> ExprNode {
        let whole = self.span(&pair);
        let mut parts = pair.into_inner();
        let token = take(&mut parts);
        let number = number::parse(token.as_str().as_bytes()).unwrap_or(f64::NAN);
        if !number.is_finite() {
            let message = format!("`{}` is too large for a number", token.as_str());
            self.sink.push(Diagnostic::error("E0209", self.span(&token), message));
            return ExprNode::Broken;
        }
        let Some(unit) = parts.next() else { return ExprNode::Number(number, None) };
        let adjacent = unit.as_span().start() == token.as_span().end();
        if adjacent && matches!(unit.as_str(), "e" | "E") {
            let message = "a number ends in an exponent without digits";
            self.sink.push(
                Diagnostic::error("E0016", whole, message).guess(whole, token.as_str().to_owned()),
            );
            return ExprNode::Broken;
        }
        match self.unit(&unit) {
            Some(unit) => ExprNode::Number(number, Some(unit)),
            None => ExprNode::Broken,
        }
    }

    fn items(&mut self, pair: Pair<'_, Rule>, form: Form) -> ExprNode {
        let (mut items, mut numbers, mut unit, mut comma) = (vec![], None, None, false);
        for part in pair.into_inner() {
            match part.as_rule() {
                Rule::nums => {
                    comma = part.as_str().trim_end().ends_with(',');
                    numbers = Some(self.numbers(&part));
                }
                Rule::item => items.push(self.expr(take(&mut part.into_inner()))),
                Rule::comma => comma = true,
                _ => match self.unit(&part) {
                    Some(found) => unit = Some(found),
                    None => return ExprNode::Broken,
                },
            }
        }
        let single = form == Form::Tuple && !comma;
        match numbers {
            Some(None) => ExprNode::Broken,
            Some(Some((data, span))) if data.len() == 1 && single => {
                let inner = Expr { span, node: ExprNode::Number(data[0], None) };
                ExprNode::Paren { inner: Box::new(inner), unit }
            }
            Some(Some((data, _))) => ExprNode::Numbers { data: data.into(), unit, form },
            None if items.len() == 1 && single => {
                let inner = items.pop().expect("its length is one");
                ExprNode::Paren { inner: Box::new(inner), unit }
            }
            None => ExprNode::Items { items, unit, form },
        }
    }

    fn table(&mut self, pair: Pair<'_, Rule>) -> ExprNode {
        let mut parts = pair.into_inner();
        let data = self.numbers(&take(&mut parts));
        let unit: Option<Option<Unit>> = parts.next().map(|unit| self.unit(&unit));
        match (data, unit) {
            (None, _) | (_, Some(None)) => ExprNode::Broken,
            (Some((data, _)), unit) => {
                ExprNode::Numbers { data: data.into(), unit: unit.flatten(), form: Form::List }
            }
        }
    }

    /// Many literal numbers; `None` if one is bad, which is told.
    fn numbers(&mut self, pair: &Pair<'_, Rule>) -> Option<(Vec<f64>, Span)> {
        let span = self.span(pair);
        match number::parse_many(pair.as_str(), self.budgets.list) {
            Ok(data) if data.len() <= self.budgets.list => Some((data, span)),
            Ok(_) => {
                let message = format!("a list of more than {} elements", self.budgets.list);
                self.sink.push(Diagnostic::error("E0503", span, message));
                None
            }
            Err(bad) => {
                self.bad_number(pair, &bad);
                None
            }
        }
    }

    fn bad_number(&mut self, pair: &Pair<'_, Rule>, bad: &BadToken) {
        let start = self.base + pair.as_span().start();
        let span = Span::new(self.source, start + bad.start, start + bad.end);
        let token: String = pair.as_str()[bad.start..bad.end].chars().take(40).collect();
        let place = bad.index + 1;
        let diagnostic = if bad.overflow {
            Diagnostic::error("E0209", span, format!("`{token}` is too large for a number"))
        } else {
            let message = format!("token {place} of the table, `{token}`, is not a number");
            Diagnostic::error("E0018", span, message)
        };
        self.sink.push(diagnostic);
    }

    fn comp(&mut self, pair: Pair<'_, Rule>) -> ExprNode {
        let mut parts = parts(pair);
        let (index, item) = self.loop_names(&mut parts);
        let over = self.expr(take(&mut parts));
        let next = take(&mut parts);
        let (filter, value) = match next.as_rule() {
            Rule::cond => (Some(self.expr(next)), self.expr(take(&mut parts))),
            _ => (None, self.expr(next)),
        };
        ExprNode::Comp(Box::new(Comp { index, item, over, filter, value }))
    }

    fn if_expr(&mut self, pair: Pair<'_, Rule>) -> ExprNode {
        let mut parts = parts(pair);
        let cond = self.expr(take(&mut parts));
        let mut arms = vec![(cond, self.expr(take(&mut parts)))];
        loop {
            let part = take(&mut parts);
            if part.as_rule() == Rule::elif_expr {
                let mut inner = self::parts(part);
                let cond = self.expr(take(&mut inner));
                arms.push((cond, self.expr(take(&mut inner))));
            } else {
                return ExprNode::If { arms, otherwise: Box::new(self.expr(part)) };
            }
        }
    }
}

fn prefix(token: &str) -> Op {
    if token == "-" { Op::Sub } else { Op::Not }
}

/// Joins operands by operators that bind at least as strongly as `level`.
fn chain(mut operands: Vec<Operand>, mut ops: Vec<(Op, Span)>, level: usize) -> Expr {
    if ops.is_empty() || level == 6 {
        return power(operands, ops);
    }
    if !ops.iter().any(|(op, _)| op.strength() == level) {
        return chain(operands, ops, level + 1);
    }
    // From the right, so that each part is split off the end of the lists.
    let mut parts = vec![];
    while let Some(at) = ops.iter().rposition(|(op, _)| op.strength() == level) {
        let tail = chain(operands.split_off(at + 1), ops.split_off(at + 1), level + 1);
        let (op, span) = ops.pop().expect("there is one at this place");
        parts.push((op, span, tail));
    }
    let first = chain(operands, ops, level + 1);
    parts.reverse();
    let span = parts.last().map_or(first.span, |(_, _, last)| first.span.to(last.span));
    Expr { span, node: ExprNode::Chain { first: Box::new(first), rest: parts } }
}

/// Joins operands by `^`. A sign before the first applies to the entire power: −2² is −4.
fn power(operands: Vec<Operand>, ops: Vec<(Op, Span)>) -> Expr {
    let mut operands = operands.into_iter();
    let first = operands.next().expect("an expression has an operand");
    let prefixes = first.prefixes;
    let rest: Vec<_> = ops
        .into_iter()
        .zip(operands)
        .map(|((op, span), operand)| (op, span, signed(operand.prefixes, operand.expr)))
        .collect();
    let base = first.expr;
    if rest.is_empty() {
        return signed(prefixes, base);
    }
    let span = rest.last().map_or(base.span, |(_, _, last)| base.span.to(last.span));
    signed(prefixes, Expr { span, node: ExprNode::Chain { first: Box::new(base), rest } })
}

fn signed(prefixes: Vec<(Op, Span)>, mut expr: Expr) -> Expr {
    for (op, span) in prefixes.into_iter().rev() {
        let span = span.to(expr.span);
        expr = Expr { span, node: ExprNode::Unary { op, inner: Box::new(expr) } };
    }
    expr
}
