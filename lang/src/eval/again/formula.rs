//! What a parameter's value is written as, where it takes the same steps whatever its names stand for.

use std::sync::Arc;

use arrayvec::ArrayVec;
use luxel_sdk::params::Unit;

use super::source_of;
use crate::Budgets;
use crate::eval::arithmetic::{Measured, joined, measured};
use crate::eval::builtins;
use crate::eval::numbered::Known;
use crate::eval::value::Value;
use crate::sink::Sink;
use crate::syntax::{Expr, ExprNode, Form, Op, parse_expr};

/// Items of a vector, at most.
pub(super) const MOST_ITEMS: usize = 3;

/// Numbers that may stand open while one is reckoned; few people nest brackets so deep.
const OPEN: usize = 16;

/// A name, or numbers that are reckoned with: numbers, names, operators and brackets alone; or a vector of
/// two or three such.
///
/// Where such an expression came to a number, each of its operands was one, for no operator makes a number
/// of anything else; and where one came to a vector of numbers, each of its items did. So it takes as many
/// steps when it comes to that again.
#[derive(Clone, Copy, Debug)]
pub(super) struct Formula<'a> {
    pub(super) text: &'a Arc<str>,
    form: Of,
    steps: &'a [Step],
}

/// Formulas by number. All their steps are one piece of memory: where a name changes that many have, they are
/// gone through one after the other.
#[derive(Debug, Default)]
pub(super) struct Formulas {
    /// The text of each, what it is, and where its steps end.
    each: Vec<(Arc<str>, Of, u32)>,
    steps: Vec<Step>,
}

impl Formulas {
    pub(super) fn get(&self, i: u32) -> Formula<'_> {
        let i = i as usize;
        let start = i.checked_sub(1).map_or(0, |last| self.each[last].2);
        let (text, form, end) = &self.each[i];
        Formula { text, form: *form, steps: &self.steps[start as usize..*end as usize] }
    }

    /// Each in turn.
    pub(super) fn iter(&self) -> impl Iterator<Item = Formula<'_>> {
        (0..narrow(self.each.len())).map(|i| self.get(i))
    }

    /// Adds a text as one, and gives its number; `None` of any other.
    pub(super) fn read(&mut self, text: &str, budgets: &Budgets, known: &Known) -> Option<u32> {
        let first = self.steps.len();
        let found = read(text, budgets).and_then(|expr| form(&expr, known, &mut self.steps));
        if found.is_none() {
            self.steps.truncate(first);
        }
        found.map(|form| self.put(text.into(), form))
    }

    /// Adds one of others.
    pub(super) fn add(&mut self, other: Formula<'_>) -> u32 {
        self.steps.extend_from_slice(other.steps);
        self.put(other.text.clone(), other.form)
    }

    /// One whose steps have been added.
    fn put(&mut self, text: Arc<str>, form: Of) -> u32 {
        self.each.push((text, form, narrow(self.steps.len())));
        narrow(self.each.len() - 1)
    }
}

/// What a formula is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Of {
    /// A name alone, which may stand for anything.
    Name,
    Number,
    Vector,
}

/// A step of a reckoning, which puts a number on those before or joins the last ones.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Step {
    Number(Measured),
    /// That of a name that the file knows, by number.
    Name(u32),
    /// The last one, which is bare, in this unit.
    Measure(Unit),
    Negate,
    Join(Op),
}

impl<'a> Formula<'a> {
    /// It, to be evaluated.
    pub(super) fn expr(self, budgets: &Budgets) -> Option<Expr> {
        read(self.text, budgets)
    }

    /// Whether it is a name alone, which may stand for anything.
    pub(super) fn is_name(self) -> bool {
        self.form == Of::Name
    }

    /// Whether it is a vector of what is reckoned.
    pub(super) fn is_vector(self) -> bool {
        self.form == Of::Vector
    }

    /// The names that the file knows, each as often as it stands there.
    pub(super) fn names(self) -> impl Iterator<Item = u32> + 'a {
        self.steps.iter().filter_map(|step| match step {
            Step::Name(name) => Some(*name),
            _ => None,
        })
    }

    /// The number that it comes to, with those that names stand for; `None` where it is none, a mistake, or
    /// too many stand open.
    pub(super) fn number(self, name: &dyn Fn(u32) -> Option<Measured>) -> Option<Measured> {
        let mut open: ArrayVec<Measured, OPEN> = ArrayVec::new();
        for step in self.steps {
            let next = match step {
                Step::Number(number) => *number,
                Step::Name(number) => name(*number)?,
                Step::Negate => open.pop().map(|(x, dimension)| (-x, dimension))?,
                Step::Measure(unit) => {
                    let (x, dimension) = open.pop()?;
                    dimension.is_none().then(|| measured(x, Some(unit)))?
                }
                Step::Join(op) => {
                    let right = open.pop()?;
                    joined(*op, open.pop()?, right).ok()?
                }
            };
            open.try_push(next).ok()?;
        }
        let number = open.pop().filter(|(x, _)| x.is_finite());
        number.filter(|_| open.is_empty() && !self.is_vector())
    }
}

fn read(text: &str, budgets: &Budgets) -> Option<Expr> {
    let mut sink = Sink::new(1);
    let expr = parse_expr(text, 0, source_of(u32::MAX), budgets, &mut sink);
    expr.filter(|_| sink.kept().is_empty())
}

/// What a formula is, whose steps are added; `None` of any other expression.
fn form(expr: &Expr, known: &Known, steps: &mut Vec<Step>) -> Option<Of> {
    match &expr.node {
        ExprNode::Items { items, form: Form::Tuple, .. } if items.len() <= MOST_ITEMS => {
            items.iter().try_for_each(|item| reckon(item, known, steps))?;
            Some(Of::Vector)
        }
        node => {
            reckon(expr, known, steps)?;
            Some(if matches!(node, ExprNode::Path(_)) { Of::Name } else { Of::Number })
        }
    }
}

/// Adds the steps of an expression; `None` if it is not reckoned from numbers.
fn reckon(expr: &Expr, known: &Known, steps: &mut Vec<Step>) -> Option<()> {
    match &expr.node {
        ExprNode::Number(x, unit) => steps.push(Step::Number(measured(*x, unit.as_deref()))),
        ExprNode::Path(path) => {
            let [word] = &path[..] else { return None };
            steps.push(match (known.of(&word.text), builtins::value(&word.text)) {
                (Some(name), _) => Step::Name(name),
                (None, Some(Value::Number(x, dimension))) => Step::Number((x, dimension)),
                _ => return None,
            });
        }
        ExprNode::Paren { inner, unit } => {
            reckon(inner, known, steps)?;
            steps.extend(unit.as_deref().map(|unit| Step::Measure(*unit)));
        }
        ExprNode::Unary { op: Op::Sub, inner } => {
            reckon(inner, known, steps)?;
            steps.push(Step::Negate);
        }
        ExprNode::Chain { first, rest } => {
            reckon(first, known, steps)?;
            for (op, _, operand) in rest {
                reckon(operand, known, steps)?;
                if *op != Op::Pow {
                    steps.push(joins(*op).then_some(Step::Join(*op))?);
                }
            }
            // Powers are taken from the right.
            steps
                .extend(rest.iter().filter(|(op, ..)| *op == Op::Pow).map(|_| Step::Join(Op::Pow)));
        }
        _ => return None,
    }
    Some(())
}

/// Whether an operator makes numbers of numbers.
fn joins(op: Op) -> bool {
    matches!(op, Op::Add | Op::Sub | Op::Mul | Op::Div | Op::Rem)
}

pub(super) fn narrow(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use luxel_sdk::params::Dimension;

    use super::*;

    /// A formula, behind another, of a file that knows some names, which have the numbers of their letters.
    fn formula(text: &str) -> Option<(Formulas, u32)> {
        let mut known = Known::default();
        for name in 'a'..='z' {
            known.number(&name.to_string().into());
        }
        let (mut formulas, budgets) = (Formulas::default(), Budgets::default());
        formulas.read("z - y", &budgets, &known)?;
        let i = formulas.read(text, &budgets, &known)?;
        Some((formulas, i))
    }

    #[test]
    fn numbers_and_names_are_reckoned_with_and_nothing_else_is() {
        let names = |text: &str| -> Option<String> {
            let (formulas, i) = formula(text)?;
            let names = formulas.get(i).names();
            Some(names.filter_map(|i| ('a'..='z').nth(i as usize)).collect())
        };
        let yes =
            [("r", "r"), ("2 * r", "r"), ("-(a + b % 3 m) cm ^ a / c", "abac"), ("1.5 km", "")];
        for (text, wanted) in yes {
            assert_eq!(names(text).as_deref(), Some(wanted), "{text}");
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
            "nowhere",
            "",
        ];
        for text in no {
            assert_eq!(names(text), None, "{text}");
        }
    }

    #[test]
    fn numbers_are_what_an_evaluation_makes_of_them() {
        let (none, length) = (Dimension::NONE, Dimension::LENGTH);
        let name = |i: u32| match ('a'..='z').nth(i as usize) {
            Some('r') => Some((0.5, length)),
            Some('k') => Some((3.0, none)),
            _ => None,
        };
        for (text, wanted) in [
            ("r", Some((0.5, length))),
            ("-(-r) * 2 - 1 cm", Some((0.99, length))),
            ("7 - 4 - 2", Some((1.0, none))),
            ("2 ^ k ^ 2", Some((512.0, none))),
            ("(k + 1) cm / r", Some((0.08, none))),
            ("pi * k", Some((3.0 * std::f64::consts::PI, none))),
            ("(r) cm", None),
            ("r + k", None),
            ("r / (k - 3)", None),
            ("k ^ r", None),
            ("k * q", None),
            ("(r, r)", None),
        ] {
            let (formulas, i) = formula(text).unwrap();
            assert_eq!(formulas.get(i).number(&name), wanted, "{text}");
        }
    }
}
