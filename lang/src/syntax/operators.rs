//! Operands and operators joined as they bind.

use std::iter::Peekable;
use std::vec::IntoIter;

use luxel_core::diag::Span;

use super::tree::{Expr, ExprNode, Op};

/// Calls, indices and members after one operand: more than any person writes.
pub(super) const POSTFIX_LIMIT: usize = 64;

/// What binds strongest.
const POWER: usize = 6;

/// An operand with the signs before it.
pub(super) struct Operand {
    pub(super) prefixes: Vec<(Op, Span)>,
    pub(super) expr: Expr,
}

/// Whether so many operators, and signs before one operand, are more than `limit` allows.
pub(super) fn are_too_many(operators: usize, prefixes: usize, limit: usize) -> bool {
    operators.max(prefixes * limit / 8) > limit
}

/// The operator that the sign before an operand is.
pub(super) fn prefix(token: &str) -> Op {
    if token == "-" { Op::Sub } else { Op::Not }
}

/// Joins operands by the operators between them.
pub(super) fn join(operands: Vec<Operand>, ops: Vec<(Op, Span)>) -> Expr {
    Joiner { operands: operands.into_iter(), ops: ops.into_iter().peekable() }.chain(0)
}

struct Joiner {
    operands: IntoIter<Operand>,
    ops: Peekable<IntoIter<(Op, Span)>>,
}

impl Joiner {
    /// Joins by operators that bind at least as strongly as `level`.
    fn chain(&mut self, level: usize) -> Expr {
        if level == POWER {
            return self.power();
        }
        let first = self.chain(level + 1);
        let mut rest = vec![];
        while let Some((op, span)) = self.ops.next_if(|(op, _)| op.strength() == level) {
            rest.push((op, span, self.chain(level + 1)));
        }
        chained(first, rest)
    }

    /// Joins by `^`. A sign before the first applies to the entire power: −2² is −4.
    fn power(&mut self) -> Expr {
        let first = self.operand();
        let mut rest = vec![];
        while let Some((op, span)) = self.ops.next_if(|(op, _)| op.strength() == POWER) {
            let next = self.operand();
            rest.push((op, span, signed(next.prefixes, next.expr)));
        }
        signed(first.prefixes, chained(first.expr, rest))
    }

    fn operand(&mut self) -> Operand {
        self.operands.next().expect("an operand stands on each side of an operator")
    }
}

fn chained(first: Expr, rest: Vec<(Op, Span, Expr)>) -> Expr {
    let Some((_, _, last)) = rest.last() else { return first };
    let span = first.span.to(last.span);
    Expr { span, node: ExprNode::Chain { first: Box::new(first), rest } }
}

/// An operand under the signs before it.
pub(super) fn signed(prefixes: Vec<(Op, Span)>, mut expr: Expr) -> Expr {
    for (op, span) in prefixes.into_iter().rev() {
        let span = span.to(expr.span);
        expr = Expr { span, node: ExprNode::Unary { op, inner: Box::new(expr) } };
    }
    expr
}
