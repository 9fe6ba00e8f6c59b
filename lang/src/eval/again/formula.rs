//! What a parameter's value is written as, where it takes the same steps whatever its names stand for.

use std::sync::Arc;

use luxel_core::diag::Span;

use super::source_of;
use crate::Budgets;
use crate::eval::arithmetic::{Measured, joined, measured};
use crate::eval::numbered::Known;
use crate::sink::Sink;
use crate::syntax::{Expr, ExprNode, Form, Op, parse_expr};

/// Items of a vector, at most.
pub(super) const MOST_ITEMS: usize = 3;

/// The number that a word stands for, if it does.
pub(super) type Words<'a> = &'a dyn Fn(&str) -> Option<Measured>;

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

    /// The number that it comes to, with the numbers that `word` has for its words; `None` where it is not
    /// one for all of them, or a mistake.
    pub(super) fn number(&self, word: Words<'_>) -> Option<Measured> {
        number(&self.expr, word).filter(|(x, _)| x.is_finite())
    }

    /// The names that the file knows, and how often each stands there.
    pub(super) fn names(&self) -> impl Iterator<Item = (u32, u32)> {
        self.names.iter().copied()
    }
}

/// What an expression comes to that is reckoned.
fn number(expr: &Expr, word: Words<'_>) -> Option<Measured> {
    match &expr.node {
        ExprNode::Number(x, unit) => Some(measured(*x, unit.as_deref())),
        ExprNode::Path(path) => word(&path.first()?.text),
        ExprNode::Paren { inner, unit } => {
            let (x, dimension) = number(inner, word)?;
            let is_bare = unit.is_none() || dimension.is_none();
            is_bare.then(|| unit.as_deref().map_or((x, dimension), |it| measured(x, Some(it))))
        }
        ExprNode::Unary { inner, .. } => number(inner, word).map(|(x, dimension)| (-x, dimension)),
        ExprNode::Chain { first, rest } => {
            let (mut a, mut left) = (number(first, word)?, &rest[..]);
            while let [(op, _, operand), others @ ..] = left {
                // Powers are taken from the right.
                if *op == Op::Pow {
                    return joined(*op, a, powers(operand, others, word)?).ok();
                }
                a = joined(*op, a, number(operand, word)?).ok()?;
                left = others;
            }
            Some(a)
        }
        _ => None,
    }
}

/// A power of powers.
fn powers(base: &Expr, rest: &[(Op, Span, Expr)], word: Words<'_>) -> Option<Measured> {
    let base = number(base, word)?;
    let [(op, _, exponent), others @ ..] = rest else { return Some(base) };
    joined(*op, base, powers(exponent, others, word)?).ok()
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
    use luxel_sdk::params::Dimension;

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

    #[test]
    fn numbers_are_what_an_evaluation_makes_of_them() {
        let word = |word: &str| match word {
            "r" => Some((0.5, Dimension::LENGTH)),
            "k" => Some((3.0, Dimension::NONE)),
            _ => None,
        };
        let of = |text: &str| number(&read(text, &Budgets::default()).unwrap(), &word);
        let (none, length) = (Dimension::NONE, Dimension::LENGTH);
        for (text, wanted) in [
            ("r", Some((0.5, length))),
            ("-(-r) * 2 - 1 cm", Some((0.99, length))),
            ("7 - 4 - 2", Some((1.0, none))),
            ("2 ^ k ^ 2", Some((512.0, none))),
            ("(k + 1) cm / r", Some((0.08, none))),
            ("(r) cm", None),
            ("r + k", None),
            ("r / (k - 3)", None),
            ("k ^ r", None),
            ("k * q", None),
        ] {
            assert_eq!(of(text), wanted, "{text}");
        }
    }
}
