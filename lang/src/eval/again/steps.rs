//! Formulas as the steps of their reckoning.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use arrayvec::ArrayVec;
use luxel_sdk::params::{Dimension, Unit};

use crate::eval::arithmetic::{Measured, joined, measured, scale};
use crate::eval::builtins::{self, OfNumbers};
use crate::eval::numbered::Known;
use crate::eval::types::dimension;
use crate::eval::value::Value;
use crate::syntax::{Arg, Expr, ExprNode, FnBody, FnDef, ListTy, Name, Op, Ty};

/// Numbers that may stand open while one is reckoned; few people nest brackets so deep.
const OPEN: usize = 16;

/// Steps that a function takes at most, with those of what it calls, and how deep such calls nest.
const CALLED: usize = 1 << 6;
const NESTED: usize = 8;

/// A step of a reckoning, which puts a number on those that are open or makes one of the last ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    Number(Measured),
    /// That of a name that the file knows, by number.
    Name(u32),
    /// The last in this unit; it is bare.
    Measure(Unit),
    Negate,
    Join(Op),
    /// What a function that every scene has makes of the last so many.
    Of(OfNumbers, u8),
    /// What a function of the file makes of the last ones, by its number among `Bodies`.
    Call(u32),
    /// In a function: the argument that stands so far back, the last at 1, once more.
    Argument(u8),
    /// That argument becomes a number of this dimension, perhaps a whole one.
    Fit(u8, Dimension, bool),
    /// The function ends: so many arguments go, and what it came to stays.
    Return(u8),
}

/// A function of the file where so many of its arguments are given.
#[derive(Clone, Debug)]
struct Body {
    /// The number of its name, and how many.
    of: (u32, usize),
    params: Box<[Arc<str>]>,
    steps: Vec<Step>,
    called: Called,
    /// Steps that it takes.
    n_steps: usize,
}

/// What is called with a function, by the numbers of names.
#[derive(Clone, Debug, Default)]
pub(super) struct Called {
    /// It, and those that it calls.
    pub(super) functions: Vec<u32>,
    /// Names that stand in them.
    pub(super) names: Vec<u32>,
}

/// Functions of the file that make numbers of numbers, each behind those that it calls.
#[derive(Debug, Default)]
pub(super) struct Bodies {
    all: Vec<Body>,
    /// By the number of its name and how many arguments are given; `None` of any other.
    known: HashMap<(u32, usize), Option<u32>>,
    /// How many are being looked for, each for the one before.
    n_sought: usize,
}

/// Finds a function of the file by the number of its name.
pub(super) type Functions<'a> = &'a dyn Fn(u32) -> Option<Arc<FnDef>>;

impl Bodies {
    /// What is called with a function, by its number.
    pub(super) fn called(&self, body: u32) -> &Called {
        &self.all[body as usize].called
    }

    /// The number that steps come to, with those that names stand for and bare ones in these units; `None`
    /// where it is none, a mistake, or too many stand open.
    pub(super) fn number(
        &self,
        steps: &[Step],
        name: &dyn Fn(u32) -> Option<Measured>,
        units: &dyn Fn(Dimension) -> Option<f64>,
    ) -> Option<Measured> {
        let mut open = ArrayVec::new();
        self.take(steps, &mut open, name, units)?;
        let number = open.pop().filter(|(x, _)| x.is_finite());
        number.filter(|_| open.is_empty())
    }

    fn take(
        &self,
        steps: &[Step],
        open: &mut ArrayVec<Measured, OPEN>,
        name: &dyn Fn(u32) -> Option<Measured>,
        units: &dyn Fn(Dimension) -> Option<f64>,
    ) -> Option<()> {
        for step in steps {
            let next = match step {
                Step::Number(number) => *number,
                Step::Name(number) => name(*number)?,
                Step::Measure(unit) => {
                    let (x, dimension) = open.pop()?;
                    dimension.is_none().then(|| measured(x, Some(unit)))?
                }
                Step::Negate => open.pop().map(|(x, dimension)| (-x, dimension))?,
                Step::Join(op) => {
                    let right = open.pop()?;
                    joined(*op, open.pop()?, right).ok()?
                }
                Step::Of(function, n) => {
                    let first = open.len().checked_sub(usize::from(*n))?;
                    let made = function.of(&mut open[first..], units)?;
                    open.truncate(first);
                    made
                }
                Step::Call(body) => {
                    self.take(&self.all[*body as usize].steps, open, name, units)?;
                    continue;
                }
                Step::Argument(back) => *open.get(open.len().checked_sub(usize::from(*back))?)?,
                Step::Fit(back, wanted, is_whole) => {
                    let at = open.len().checked_sub(usize::from(*back))?;
                    let (x, found) = open.get_mut(at)?;
                    *x *= scale(*found, *wanted, units)?;
                    *found = *wanted;
                    (!is_whole || x.fract().abs() <= 0.0).then_some(())?;
                    continue;
                }
                Step::Return(n) => {
                    let result = open.pop()?;
                    open.truncate(open.len().checked_sub(usize::from(*n))?);
                    result
                }
            };
            open.try_push(next).ok()?;
        }
        Some(())
    }

    /// Those of another part of the file too; gives the number here of each.
    pub(super) fn take_over(&mut self, other: &Self) -> Vec<u32> {
        let mut numbers = vec![];
        for body in &other.all {
            let known = self.known.get(&body.of).copied().flatten();
            let number = known.unwrap_or_else(|| {
                let steps = renumbered(&body.steps, &numbers).collect();
                self.add(Body { steps, ..body.clone() })
            });
            numbers.push(number);
        }
        numbers
    }

    /// Forgets functions among names that are defined anew, by their numbers, and those that call them.
    pub(super) fn forget(&mut self, redefined: &HashSet<u32>) {
        let Self { all, known, .. } = self;
        let functions = |body: u32| all[body as usize].called.functions.iter();
        let is_same = |body: u32| !functions(body).any(|name| redefined.contains(name));
        known.retain(|_, body| body.is_some_and(is_same));
    }

    fn add(&mut self, body: Body) -> u32 {
        let number = u32::try_from(self.all.len()).unwrap_or(u32::MAX);
        self.known.insert(body.of, Some(number));
        self.all.push(body);
        number
    }

    /// A function for so many arguments; `None` if it is none that makes a number of numbers.
    fn find(&mut self, of: (u32, usize), known: &Known, functions: Functions<'_>) -> Option<u32> {
        if let Some(found) = self.known.get(&of) {
            return *found;
        }
        if self.n_sought == NESTED {
            return None;
        }
        // While it is looked for it is none: it does not call itself.
        self.known.insert(of, None);
        self.n_sought += 1;
        let body = self.read(of, known, functions);
        self.n_sought -= 1;
        body.map(|body| self.add(body))
    }

    fn read(&mut self, of: (u32, usize), known: &Known, functions: Functions<'_>) -> Option<Body> {
        let def = functions(of.0)?;
        let FnBody::Value(body) = &def.body else { return None };
        let mut steps = vec![];
        let mut reckoner = Reckoner::new(known, functions, self, &mut steps);
        reckoner.n_open = of.1;
        reckoner.args = Some(vec![]);
        for (i, param) in def.params.iter().enumerate() {
            if i >= of.1 {
                reckoner.add(param.default.as_ref()?)?;
            }
            let (wanted, is_whole) = number_type(&param.ty)?;
            reckoner.push(Step::Fit(reckoner.back_to(i)?, wanted, is_whole))?;
            reckoner.args.as_mut()?.push(param.name.text.clone());
        }
        (of.1 <= def.params.len()).then(|| reckoner.add(body))??;
        reckoner.push(Step::Return(u8::try_from(def.params.len()).ok()?))?;
        let mut all = Called { functions: vec![of.0], names: names(&steps).collect() };
        for called in calls(&steps).map(|body| self.called(body)) {
            all.functions.extend(&called.functions);
            all.names.extend(&called.names);
        }
        for names in [&mut all.functions, &mut all.names] {
            names.sort_unstable();
            names.dedup();
        }
        let called = steps.iter().map(|step| match step {
            Step::Call(body) => self.all[*body as usize].n_steps,
            _ => 1,
        });
        let n_steps = called.sum();
        let params = def.params.iter().map(|param| param.name.text.clone()).collect();
        (n_steps <= CALLED).then_some(Body { of, params, steps, called: all, n_steps })
    }
}

/// The names that the file knows, each as often as it stands in the steps.
pub(super) fn names(steps: &[Step]) -> impl Iterator<Item = u32> {
    steps.iter().filter_map(|step| match step {
        Step::Name(name) => Some(*name),
        _ => None,
    })
}

/// The functions of the file that steps call, by their numbers.
pub(super) fn calls(steps: &[Step]) -> impl Iterator<Item = u32> {
    steps.iter().filter_map(|step| match step {
        Step::Call(body) => Some(*body),
        _ => None,
    })
}

/// Steps whose functions have other numbers.
pub(super) fn renumbered(steps: &[Step], numbers: &[u32]) -> impl Iterator<Item = Step> {
    steps.iter().map(|step| match step {
        Step::Call(body) => Step::Call(numbers[*body as usize]),
        step => *step,
    })
}

/// Finds the steps of expressions that are reckoned from numbers.
pub(super) struct Reckoner<'a> {
    known: &'a Known,
    functions: Functions<'a>,
    bodies: &'a mut Bodies,
    steps: &'a mut Vec<Step>,
    /// How many numbers stand open behind the last step.
    n_open: usize,
    /// In a function, its arguments so far: the first of what stands open.
    args: Option<Vec<Arc<str>>>,
}

impl<'a> Reckoner<'a> {
    pub(super) fn new(
        known: &'a Known,
        functions: Functions<'a>,
        bodies: &'a mut Bodies,
        steps: &'a mut Vec<Step>,
    ) -> Self {
        Self { known, functions, bodies, steps, n_open: 0, args: None }
    }

    /// Adds the steps of an expression; `None` if it is not reckoned from numbers.
    pub(super) fn add(&mut self, expr: &Expr) -> Option<()> {
        match &expr.node {
            ExprNode::Number(x, unit) => self.push(Step::Number(measured(*x, unit.as_deref()))),
            ExprNode::Path(path) => {
                let [word] = &path[..] else { return None };
                let step = self.name(&word.text)?;
                self.push(step)
            }
            ExprNode::Paren { inner, unit } => {
                self.add(inner)?;
                unit.as_deref().map_or(Some(()), |unit| self.push(Step::Measure(*unit)))
            }
            ExprNode::Unary { op: Op::Sub, inner } => {
                self.add(inner)?;
                self.push(Step::Negate)
            }
            ExprNode::Chain { first, rest } => {
                self.add(first)?;
                for (op, _, operand) in rest {
                    self.add(operand)?;
                    if *op != Op::Pow {
                        self.push(joins(*op).then_some(Step::Join(*op))?)?;
                    }
                }
                // Powers are taken from the right.
                let mut powers = rest.iter().filter(|(op, ..)| *op == Op::Pow);
                powers.try_for_each(|_| self.push(Step::Join(Op::Pow)))
            }
            ExprNode::Call { callee, args } => {
                let ExprNode::Path(path) = &callee.node else { return None };
                let [word] = &path[..] else { return None };
                self.call(&word.text, args)
            }
            _ => None,
        }
    }

    fn push(&mut self, step: Step) -> Option<()> {
        let (n_taken, n_put) = match step {
            Step::Number(_) | Step::Name(_) | Step::Argument(_) => (0, 1),
            Step::Fit(..) | Step::Measure(_) | Step::Negate => (1, 1),
            Step::Join(_) => (2, 1),
            Step::Of(_, n) => (usize::from(n), 1),
            Step::Call(body) => (self.bodies.all[body as usize].of.1, 1),
            Step::Return(n) => (usize::from(n) + 1, 1),
        };
        self.steps.push(step);
        self.n_open = self.n_open.checked_sub(n_taken)? + n_put;
        Some(())
    }

    /// How far back an argument stands.
    fn back_to(&self, argument: usize) -> Option<u8> {
        u8::try_from(self.n_open - argument).ok()
    }

    /// Which of the function's arguments has this name.
    fn argument(&self, word: &str) -> Option<usize> {
        self.args.as_ref()?.iter().position(|name| **name == *word)
    }

    fn name(&self, word: &str) -> Option<Step> {
        if let Some(argument) = self.argument(word) {
            return Some(Step::Argument(self.back_to(argument)?));
        }
        match (self.known.of(word), builtins::value(word)) {
            (Some(name), _) => Some(Step::Name(name)),
            (None, Some(Value::Number(x, dimension))) => Some(Step::Number((x, dimension))),
            _ => None,
        }
    }

    /// Adds a call of a function that makes a number of numbers.
    fn call(&mut self, word: &str, args: &[Arg]) -> Option<()> {
        if self.argument(word).is_some() {
            return None;
        }
        let (step, params) = if let Some(name) = self.known.of(word) {
            let body = self.bodies.find((name, args.len()), self.known, self.functions)?;
            (Step::Call(body), self.bodies.all[body as usize].params.clone())
        } else {
            let function = builtins::of_numbers(word, args.len())?;
            (Step::Of(function, u8::try_from(args.len()).ok()?), Box::default())
        };
        for (i, arg) in args.iter().enumerate() {
            let is_named = |name: &Name| params.get(i).is_some_and(|param| *param == name.text);
            arg.name.as_ref().is_none_or(is_named).then(|| self.add(&arg.value))??;
        }
        self.push(step)
    }
}

/// What a number of a type measures, and whether it is a whole one; `None` of any other type.
fn number_type(ty: &Ty) -> Option<(Dimension, bool)> {
    let name = &*ty.name.text;
    dimension(name).filter(|_| ty.list == ListTy::One).map(|wanted| (wanted, name == "int"))
}

/// Whether an operator makes numbers of numbers.
fn joins(op: Op) -> bool {
    matches!(op, Op::Add | Op::Sub | Op::Mul | Op::Div | Op::Rem)
}
