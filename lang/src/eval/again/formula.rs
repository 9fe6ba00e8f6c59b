//! What a parameter's value is written as, where it takes the same steps whatever its names stand for.

use std::collections::HashSet;
use std::sync::Arc;

use luxel_sdk::params::Dimension;

use super::source_of;
use super::steps::{Bodies, Called, Functions, Reckoner, Step, calls, names, renumbered};
use crate::Budgets;
use crate::eval::arithmetic::Measured;
use crate::eval::numbered::Known;
use crate::sink::Sink;
use crate::syntax::{Expr, ExprNode, Form, parse_expr};

/// Items of a vector, at most.
pub(super) const MOST_ITEMS: usize = 3;

/// A name, or numbers that are reckoned with: numbers, names, operators, brackets and calls of functions of
/// numbers alone; or a vector of two or three such.
///
/// Where such an expression came to a number, each of its operands was one, for no operator makes a number
/// of anything else, and no such function; and where one came to a vector of numbers, each of its items did.
/// So it takes as many steps when it comes to that again.
#[derive(Clone, Copy, Debug)]
pub(super) struct Formula<'a> {
    pub(super) text: &'a Arc<str>,
    form: Of,
    steps: &'a [Step],
    bodies: &'a Bodies,
}

/// Formulas by number. All their steps are one piece of memory: where a name changes that many have, they are
/// gone through one after the other.
#[derive(Debug, Default)]
pub(super) struct Formulas {
    /// The text of each, what it is, and where its steps end.
    each: Vec<(Arc<str>, Of, u32)>,
    steps: Vec<Step>,
    bodies: Bodies,
}

impl Formulas {
    pub(super) fn get(&self, i: u32) -> Formula<'_> {
        let i = i as usize;
        let start = i.checked_sub(1).map_or(0, |last| self.each[last].2);
        let (text, form, end) = &self.each[i];
        let steps = &self.steps[start as usize..*end as usize];
        Formula { text, form: *form, steps, bodies: &self.bodies }
    }

    /// Each in turn.
    pub(super) fn iter(&self) -> impl Iterator<Item = Formula<'_>> {
        (0..narrow(self.each.len())).map(|i| self.get(i))
    }

    /// Adds a text as one, and gives its number; `None` of any other.
    pub(super) fn read(
        &mut self,
        text: &str,
        budgets: &Budgets,
        (known, functions): (&Known, Functions<'_>),
    ) -> Option<u32> {
        let first = self.steps.len();
        let reckoner = Reckoner::new(known, functions, &mut self.bodies, &mut self.steps);
        let found = read(text, budgets).and_then(|expr| form(&expr, reckoner));
        if found.is_none() {
            self.steps.truncate(first);
        }
        found.map(|form| self.put(text.into(), form))
    }

    /// Adds the functions of others, and gives the number here of each.
    pub(super) fn take_over(&mut self, others: &Self) -> Vec<u32> {
        self.bodies.take_over(&others.bodies)
    }

    /// Adds one of others whose functions have these numbers.
    pub(super) fn add(&mut self, other: Formula<'_>, bodies: &[u32]) -> u32 {
        self.steps.extend(renumbered(other.steps, bodies));
        self.put(other.text.clone(), other.form)
    }

    /// What is called with a function of the file, by its number.
    pub(super) fn called(&self, body: u32) -> &Called {
        self.bodies.called(body)
    }

    /// Forgets functions among names that are defined anew, by their numbers, and those that call them.
    pub(super) fn forget(&mut self, redefined: &HashSet<u32>) {
        self.bodies.forget(redefined);
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
        names(self.steps)
    }

    /// The functions of the file that it calls, by their numbers.
    pub(super) fn calls(self) -> impl Iterator<Item = u32> + 'a {
        calls(self.steps)
    }

    /// The number that it comes to, with those that names stand for and bare ones in these units; `None`
    /// where it is none, a mistake, or too many stand open.
    pub(super) fn number(
        self,
        name: &dyn Fn(u32) -> Option<Measured>,
        units: &dyn Fn(Dimension) -> Option<f64>,
    ) -> Option<Measured> {
        if self.is_vector() { None } else { self.bodies.number(self.steps, name, units) }
    }
}

fn read(text: &str, budgets: &Budgets) -> Option<Expr> {
    let mut sink = Sink::new(1);
    let expr = parse_expr(text, 0, source_of(u32::MAX), budgets, &mut sink);
    expr.filter(|_| sink.kept().is_empty())
}

/// What a formula is, whose steps are added; `None` of any other expression.
fn form(expr: &Expr, mut reckoner: Reckoner<'_>) -> Option<Of> {
    match &expr.node {
        ExprNode::Items { items, form: Form::Tuple, .. } if items.len() <= MOST_ITEMS => {
            items.iter().try_for_each(|item| reckoner.add(item))?;
            Some(Of::Vector)
        }
        node => {
            reckoner.add(expr)?;
            Some(if matches!(node, ExprNode::Path(_)) { Of::Name } else { Of::Number })
        }
    }
}

pub(super) fn narrow(n: usize) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::{StmtNode, read_piece};

    const FUNCTIONS: [&str; 15] = [
        "fn f(x: length) = 2 * x",
        "fn h(x: length, y: float = 2) = f(x) / y + k * (x / y)",
        "fn i(n: int) = n",
        "fn j(x: any) = 2",
        "fn l(x: length) = if x > 1 m { x } else { 2 * x }",
        "fn n(x: float) = n(x) + n(x)",
        // The first of nine that call one another.
        "fn o(x: float) = x",
        "fn p(x: float) = o(x)",
        "fn q(x: float) = p(x)",
        "fn s(x: float) = q(x)",
        "fn t(x: float) = s(x)",
        "fn u(x: float) = t(x)",
        "fn v(x: float) = u(x)",
        "fn w(x: float) = v(x)",
        "fn x(x: float) = w(x)",
    ];

    /// A formula, behind another, of a file that knows some names, which have the numbers of their letters.
    fn formula(text: &str) -> Option<(Formulas, u32)> {
        let mut known = Known::default();
        for name in 'a'..='z' {
            known.number(&name.to_string().into());
        }
        let (mut formulas, budgets) = (Formulas::default(), Budgets::default());
        let functions = FUNCTIONS.map(|text| {
            let (stmts, told) = read_piece(text, false, source_of(0), &budgets);
            assert_eq!(told, []);
            match &stmts[0].node {
                StmtNode::Fn(def) => def.clone(),
                _ => panic!("{text}"),
            }
        });
        let function = |name: u32| {
            let name = known.name(name);
            functions.iter().find(|def| *def.name.text == *name).cloned()
        };
        formulas.read("z - y", &budgets, (&known, &function))?;
        let i = formulas.read(text, &budgets, (&known, &function))?;
        Some((formulas, i))
    }

    #[test]
    fn numbers_and_names_are_reckoned_with_and_nothing_else_is() {
        let names = |text: &str| -> Option<String> {
            let (formulas, i) = formula(text)?;
            let names = formulas.get(i).names();
            Some(names.filter_map(|i| ('a'..='z').nth(i as usize)).collect())
        };
        let yes = [
            ("r", "r"),
            ("2 * r", "r"),
            ("-(a + b % 3 m) cm ^ a / c", "abac"),
            ("1.5 km", ""),
            ("f(r)", "r"),
            ("w(r)", "r"),
            ("h(r + f(a), y = b) * sqrt(c)", "rabc"),
            ("(max(a, b), f(c))", "abc"),
        ];
        for (text, wanted) in yes {
            assert_eq!(names(text).as_deref(), Some(wanted), "{text}");
        }
        let no = [
            "f()",
            "f(r, 2)",
            "f(y = r)",
            "f((1, 2))",
            "j(r)",
            "l(r)",
            "n(r)",
            "x(r)",
            "r(r)",
            "sin(r, r)",
            "sin(x = r)",
            "dot(r, r)",
            "nowhere(r)",
            "rgb.linear_srgb(r, r, r)",
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
        let units = |dimension: Dimension| (dimension == length).then_some(1e-3);
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
            ("f(r) + f(2 * r)", Some((3.0, length))),
            ("h(r)", Some((1.25, length))),
            ("h(f(r), 4) - h(x = r)", Some((1.25 - 1.25, length))),
            ("f(k)", Some((0.006, length))),
            ("f(1 s)", None),
            ("i(k)", Some((3.0, none))),
            ("i(k / 2)", None),
            ("max(r, 75 cm) * cos(k * 0 rad)", Some((0.75, length))),
            ("sin(r)", None),
            ("log(k - 3)", None),
            ("(r, r)", None),
        ] {
            let (formulas, i) = formula(text).unwrap();
            assert_eq!(formulas.get(i).number(&name, &units), wanted, "{text}");
        }
    }
}
