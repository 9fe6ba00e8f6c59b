//! Operands and operators joined as they bind.

use std::vec::Drain;

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
pub(super) fn join(operands: Drain<'_, Operand>, ops: Drain<'_, (Op, Span)>) -> Expr {
    Joiner { operands, ops }.chain(0)
}

struct Joiner<'a> {
    operands: Drain<'a, Operand>,
    ops: Drain<'a, (Op, Span)>,
}

impl Joiner<'_> {
    /// Joins by operators that bind at least as strongly as `level`.
    fn chain(&mut self, level: usize) -> Expr {
        if level == POWER {
            return self.power();
        }
        let first = self.chain(level + 1);
        let n = self.count(level);
        self.chained(first, n, |joiner| joiner.chain(level + 1))
    }

    /// Joins by `^`. A sign before the first applies to the entire power: −2² is −4.
    fn power(&mut self) -> Expr {
        let first = self.operand();
        let n = self.count(POWER);
        let power = self.chained(first.expr, n, |joiner| {
            let next = joiner.operand();
            signed(next.prefixes, next.expr)
        });
        signed(first.prefixes, power)
    }

    /// How many operators of a level follow before one that binds less.
    fn count(&self, level: usize) -> usize {
        let strengths = self.ops.as_slice().iter().map(|(op, _)| op.strength());
        strengths.take_while(|strength| *strength >= level).filter(|it| *it == level).count()
    }

    fn operand(&mut self) -> Operand {
        self.operands.next().expect("an operand stands on each side of an operator")
    }

    /// An operand and the next `n` with the operators before them.
    fn chained(&mut self, first: Expr, n: usize, mut next: impl FnMut(&mut Self) -> Expr) -> Expr {
        if n == 0 {
            return first;
        }
        let mut rest = Vec::with_capacity(n);
        for _ in 0..n {
            let (op, span) = self.ops.next().expect("there are so many");
            rest.push((op, span, next(self)));
        }
        let span = rest.last().map_or(first.span, |(_, _, last)| first.span.to(last.span));
        Expr { span, node: ExprNode::Chain { first: Box::new(first), rest: rest.into() } }
    }
}

/// An operand under the signs before it.
pub(super) fn signed(prefixes: Vec<(Op, Span)>, mut expr: Expr) -> Expr {
    for (op, span) in prefixes.into_iter().rev() {
        let span = span.to(expr.span);
        expr = Expr { span, node: ExprNode::Unary { op, inner: Box::new(expr) } };
    }
    expr
}
