//! What a parameter's value is written as, where it takes the same steps whatever its names stand for.

use std::sync::Arc;

use super::source_of;
use crate::Budgets;
use crate::eval::numbered::Known;
use crate::sink::Sink;
use crate::syntax::{Expr, ExprNode, Form, Op, parse_expr};

/// Items of a vector, at most.
pub(super) const MOST_ITEMS: usize = 3;

/// A name, or numbers that are reckoned with: numbers, names, operators and brackets alone; or a vector of
/// two or three such.
///
/// Where such an expression came to a number, each of its operands was one, for no operator makes a number
/// of anything else; and where one came to a vector of numbers, each of its items did. So it takes as many
/// steps when it comes to that again.
#[derive(Debug)]
pub(super) struct Formula {
    pub(super) text: Arc<str>,
    pub(super) expr: Expr,
    /// The names that the file knows, by number, and how often each stands there.
    names: Vec<(u32, u32)>,
}

impl Formula {
    /// A text as one; `None` of any other.
    pub(super) fn of(text: &str, budgets: &Budgets, known: &Known) -> Option<Self> {
        let expr = read(text, budgets)?;
        let words = words(&expr)?;
        let mut names: Vec<(u32, u32)> = vec![];
        for number in words.iter().filter_map(|word| known.of(word)) {
            match names.iter_mut().find(|(name, _)| *name == number) {
                Some((_, times)) => *times += 1,
                None => names.push((number, 1)),
            }
        }
        Some(Self { text: text.into(), expr, names })
    }

    /// Whether it is a name alone, which may stand for anything.
    pub(super) fn is_name(&self) -> bool {
        matches!(self.expr.node, ExprNode::Path(_))
    }

    /// Whether it is a vector of what is reckoned.
    pub(super) fn is_vector(&self) -> bool {
        matches!(self.expr.node, ExprNode::Items { .. })
    }

    /// The names that the file knows, and how often each stands there.
    pub(super) fn names(&self) -> impl Iterator<Item = (u32, u32)> {
        self.names.iter().copied()
    }
}

fn read(text: &str, budgets: &Budgets) -> Option<Expr> {
    let mut sink = Sink::new(1);
    let expr = parse_expr(text, 0, source_of(u32::MAX), budgets, &mut sink);
    expr.filter(|_| sink.kept().is_empty())
}

/// The names in a formula; `None` if an expression is none.
fn words(expr: &Expr) -> Option<Vec<Arc<str>>> {
    let mut words = vec![];
    let is_one = match &expr.node {
        ExprNode::Items { items, form: Form::Tuple, .. } if items.len() <= MOST_ITEMS => {
            items.iter().all(|item| is_reckoned(item, &mut words))
        }
        _ => is_reckoned(expr, &mut words),
    };
    is_one.then_some(words)
}

/// Whether an expression is one of numbers, and the names in it.
fn is_reckoned(expr: &Expr, words: &mut Vec<Arc<str>>) -> bool {
    match &expr.node {
        ExprNode::Number(..) => true,
        ExprNode::Path(path) => {
            words.extend(path.first().map(|name| name.text.clone()));
            path.len() == 1
        }
        ExprNode::Paren { inner, .. } => is_reckoned(inner, words),
        ExprNode::Unary { op, inner } => *op == Op::Sub && is_reckoned(inner, words),
        ExprNode::Chain { first, rest } => {
            let joins =
                |op: &Op| matches!(op, Op::Add | Op::Sub | Op::Mul | Op::Div | Op::Rem | Op::Pow);
            let mut is_so = |operand: &Expr| is_reckoned(operand, words);
            is_so(first) && rest.iter().all(|(op, _, operand)| joins(op) && is_so(operand))
        }
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_names_are_reckoned_with_and_nothing_else_is() {
        let words = |text: &str| Some(words(&read(text, &Budgets::default())?)?.join(" "));
        let yes =
            [("r", "r"), ("2 * r", "r"), ("-(a + b % 3 m) cm ^ a / c", "a b a c"), ("1.5 km", "")];
        for (text, names) in yes {
            assert_eq!(words(text).as_deref(), Some(names), "{text}");
        }
        let no = [
            "f(r)",
            "v.x",
            "a < b",
            "a && b",
            "!a",
            "(a, b, c, d)",
            "(a, (b, c))",
            "((a, b))",
            "[a]",
            "a[0]",
            "\"a\"",
            "true",
            "if a { b } else { c }",
            "1..r",
            "r +",
            "r radius 2",
            "",
        ];
        for text in no {
            assert_eq!(words(text), None, "{text}");
        }
    }
}
