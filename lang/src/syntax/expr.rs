//! From pest's pairs to the syntax tree: expressions.

use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Span};
use luxel_sdk::params::Unit;
use pest::iterators::Pair;

use super::Rule;
use super::build::{Builder, parts, take};
use super::make::{self, Inside};
use super::number::{self, BadToken};
use super::operators::{Operand, POSTFIX_LIMIT, are_too_many, join, prefix};
use super::tree::{Arg, Comp, Expr, ExprNode, Form, Op};

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
            if are_too_many(ops.len(), prefixes.len(), self.budgets.operators) {
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
        join(operands.drain(..), ops.drain(..))
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
                let name = Box::new(self.name(&take(&mut pair.into_inner())));
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
    pub(super) fn args(&mut self, pair: Pair<'_, Rule>) -> Box<[Arg]> {
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
            _ => make::path(self.path(take(&mut pair.into_inner()))),
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
        let inside = match numbers {
            Some(None) => return ExprNode::Broken,
            Some(Some((data, span))) => Inside::Numbers(data, span),
            None => Inside::Items(items.into()),
        };
        make::bracketed(inside, comma, unit, form)
    }

    fn table(&mut self, pair: Pair<'_, Rule>) -> ExprNode {
        let mut parts = pair.into_inner();
        let data = self.numbers(&take(&mut parts));
        let unit: Option<Option<Arc<Unit>>> = parts.next().map(|unit| self.unit(&unit));
        match (data, unit) {
            (None, _) | (_, Some(None)) => ExprNode::Broken,
            (Some((data, _)), unit) => {
                ExprNode::Numbers { data, unit: unit.flatten(), form: Form::List }
            }
        }
    }

    /// Many literal numbers; `None` if one is bad, which is told.
    fn numbers(&mut self, pair: &Pair<'_, Rule>) -> Option<(Arc<[f64]>, Span)> {
        let span = self.span(pair);
        match number::parse_many(pair.as_str(), self.budgets.list) {
            Ok(data) if data.len() <= self.budgets.list => Some((data.into(), span)),
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
        let start = pair.as_span().start();
        let span = self.written(start + bad.start..start + bad.end);
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
                let otherwise = Box::new(self.expr(part));
                return ExprNode::If { arms: arms.into(), otherwise };
            }
        }
    }
}
