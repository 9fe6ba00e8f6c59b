//! Functions and constants that every scene has. A definition in a scene shadows one of its name.

mod color;
mod math;
mod motion;
mod numbers;
mod order;
mod spectrum_file;
mod sun;
mod table;
#[cfg(test)]
mod tests;
mod transform;

use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Grade, Span};
use luxel_sdk::params::Dimension;

pub(super) use self::color::SpectrumFile;
pub(crate) use self::numbers::OfNumbers;

use super::Evaluator;
use super::arithmetic::scale;
use super::call::takes_only;
use super::elsewhere;
use super::env::Env;
use super::ops::with_zeros;
use super::value::Value;
use crate::syntax::Name;

/// A function that every scene has.
#[derive(Debug)]
pub(crate) struct Builtin {
    /// The name in a scene, dots included.
    pub(crate) name: &'static str,
    /// The names of its arguments; a `?` after one says that it may be left out.
    args: &'static [&'static str],
    run: Run,
    /// What it gives, with units and ranges.
    doc: &'static str,
    /// An expression that calls it, without a mistake.
    example: &'static str,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Run {
    Number(OfNumbers),
    Math(math::Math),
    Transform(transform::Transform),
    Color(color::Make),
    Sun,
}

/// An argument as it was given.
#[derive(Debug)]
pub(crate) struct Given {
    pub(crate) name: Option<Name>,
    pub(crate) value: Value,
    pub(crate) span: Span,
}

/// An argument in its place.
#[derive(Clone, Debug)]
struct Argument {
    value: Value,
    span: Span,
}

/// A number that every scene has.
#[derive(Debug)]
struct Constant {
    name: &'static str,
    value: f64,
    doc: &'static str,
    example: &'static str,
}

/// Every function, by what it is about.
static SUBJECTS: [(&str, &[Builtin]); 5] = [
    ("Numbers", &table::NUMBERS),
    ("Vectors and lists", &table::VECTORS),
    ("Transforms, motion and views", &table::TRANSFORMS),
    ("Colours and spectra", &table::COLOURS),
    ("Light", &table::LIGHT),
];

/// A function or constant that every scene has, as its manual tells it.
#[derive(Clone, Debug)]
pub struct Function {
    /// The name in a scene, dots included.
    pub name: &'static str,
    /// How it is written: `clamp(x, low, high)`; of a constant its name.
    pub usage: String,
    /// The names of its arguments; of a constant there are none.
    pub arguments: Vec<&'static str>,
    /// What it is about: the heading that it stands under.
    pub subject: &'static str,
    /// What it gives, with units and ranges.
    pub doc: &'static str,
    /// An expression that has it.
    pub example: &'static str,
}

impl Function {
    /// What it gives, and the example as code.
    pub fn text(&self) -> String {
        format!("{}\n\n```scene\n{}\n```", self.doc, self.example)
    }
}

fn all() -> impl Iterator<Item = &'static Builtin> {
    SUBJECTS.iter().flat_map(|(_, of_subject)| of_subject.iter())
}

fn find(name: &str) -> Option<&'static Builtin> {
    all().find(|builtin| builtin.name == name)
}

/// Every function and constant, those of a subject together.
pub fn functions() -> impl Iterator<Item = Function> {
    let constants = table::CONSTANTS.iter().map(|constant| Function {
        name: constant.name,
        usage: constant.name.to_owned(),
        arguments: vec![],
        subject: SUBJECTS[0].0,
        doc: constant.doc,
        example: constant.example,
    });
    let functions = SUBJECTS.iter().flat_map(|(subject, of_subject)| {
        of_subject.iter().map(|builtin| Function {
            name: builtin.name,
            usage: builtin.usage(),
            arguments: builtin.arguments().collect(),
            subject,
            doc: builtin.doc,
            example: builtin.example,
        })
    });
    constants.chain(functions)
}

/// The value of a name that every scene has.
pub(crate) fn value(name: &str) -> Option<Value> {
    let constant = table::CONSTANTS.iter().find(|constant| constant.name == name);
    let constant = constant.map(|constant| Value::plain(constant.value));
    constant.or_else(|| find(name).map(Value::Builtin))
}

/// Whether a function that every scene has takes an argument of this name.
pub(crate) fn takes(function: &str, name: &str) -> bool {
    find(function).is_some_and(|builtin| builtin.arguments().any(|arg| arg == name))
}

/// Whether a name that every scene has is a value by itself, not a function.
pub(crate) fn is_value(name: &str) -> bool {
    table::CONSTANTS.iter().any(|constant| constant.name == name)
}

/// Every name that every scene has.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    all().map(|builtin| builtin.name).chain(table::CONSTANTS.iter().map(|constant| constant.name))
}

/// Whether a name that every scene has is this one or begins with it and a dot.
pub(crate) fn begins(name: &str) -> bool {
    names().any(|known| known.split('.').next() == Some(name))
}

/// The function of a name that makes a number of so many others.
pub(crate) fn of_numbers(name: &str, n: usize) -> Option<OfNumbers> {
    match find(name).filter(|builtin| builtin.args.len() == n)?.run {
        Run::Number(function) => Some(function),
        _ => None,
    }
}

/// What a function makes of three numbers as linear sRGB, if it makes a colour of them.
pub(crate) fn linear_srgb(name: &str, c: [f64; 3]) -> Option<[f64; 3]> {
    use color::Make as C;
    match find(name)?.run {
        Run::Color(make @ (C::LinearSrgb | C::Srgb | C::AcesCg | C::Rec2020 | C::Xyz)) => {
            Some(color::linear_srgb(make, c))
        }
        _ => None,
    }
}

/// Three numbers from which a function makes a colour of a screen, sRGB, if it makes one of numbers.
pub(crate) fn of_screen(name: &str, srgb: [f64; 3]) -> Option<[f64; 3]> {
    match find(name)?.run {
        Run::Color(make) => color::of_screen(make, srgb),
        _ => None,
    }
}

/// Where a function takes an argument of a name, from 0.
pub(crate) fn place(function: &str, name: &str) -> Option<usize> {
    find(function)?.arguments().position(|argument| argument == name)
}

impl Builtin {
    /// The names of its arguments.
    fn arguments(&self) -> impl Iterator<Item = &'static str> {
        self.args.iter().map(|arg| arg.trim_end_matches('?'))
    }

    /// How it is called: `clamp(x, low, high)`.
    fn usage(&self) -> String {
        format!("{}({})", self.name, self.arguments().collect::<Vec<_>>().join(", "))
    }
}

impl Evaluator<'_> {
    /// Calls a builtin with evaluated arguments.
    pub(super) fn call_builtin(
        &mut self,
        builtin: &'static Builtin,
        given: Vec<Given>,
        span: Span,
        env: &Env,
    ) -> Value {
        if builtin.run == Run::Color(color::Make::Bare) {
            return self.bare_rgb(span);
        }
        // What a mistake left without a name may belong anywhere.
        if given.iter().any(|given| given.name.is_none() && given.value.is_poison()) {
            return Value::Poison;
        }
        if let Run::Transform(_) = builtin.run
            && let Some(found) = self.misarranged(builtin.name, &given)
        {
            self.tell(found);
            return Value::Poison;
        }
        if builtin.name == "look_at"
            && let Some(found) = order::unbracketed(&given).or_else(|| self.up_first(&given))
        {
            self.tell(found);
            return Value::Poison;
        }
        let n_wanted = builtin.args.iter().filter(|arg| !arg.ends_with('?')).count();
        if let Run::Color(_) = builtin.run
            && let Some(found) = self.bracketed(&builtin.usage(), n_wanted, &given)
        {
            self.tell(found);
            return Value::Poison;
        }
        let n_mistakes = self.mistakes();
        let n_unnamed = given.iter().filter(|given| given.name.is_none()).count();
        let args = self.arrange(builtin, given, span);
        // Of too many it is not known which was meant to be what.
        if n_unnamed > builtin.args.len() {
            return Value::Poison;
        }
        let is_poison =
            |arg: &Option<Argument>| arg.as_ref().is_some_and(|arg| arg.value.is_poison());
        let is_missing =
            |(name, arg): (&&str, &Option<Argument>)| arg.is_none() && !name.ends_with('?');
        let is_poisoned =
            args.iter().any(is_poison) || builtin.args.iter().zip(&args).any(is_missing);
        // It may do something else without what it can do without.
        let left_out = |(name, arg): (&&str, _)| name.ends_with('?') && is_poison(arg);
        if is_poisoned && builtin.args.iter().zip(&args).any(left_out) {
            return Value::Poison;
        }
        let mut call = Call { name: builtin.name, args, span, env };
        let value = match builtin.run {
            Run::Number(_) | Run::Math(_) if is_poisoned => Value::Poison,
            Run::Number(function) => self.of_numbers(function, &call),
            Run::Math(math) => self.math(math, &mut call),
            Run::Transform(transform) => self.make_transform(transform, &mut call),
            Run::Color(make) => self.color(make, &mut call),
            Run::Sun => self.sun(&mut call),
        };
        if is_poisoned || self.mistakes() > n_mistakes { Value::Poison } else { value }
    }

    /// Puts arguments into their places, also those whose misspelt name is surely meant; tells of those that
    /// have none, or are missing.
    fn arrange(
        &mut self,
        builtin: &Builtin,
        given: Vec<Given>,
        span: Span,
    ) -> Vec<Option<Argument>> {
        let mut out = vec![None; builtin.args.len()];
        let mut is_whole = true;
        for (i, given) in given.into_iter().enumerate() {
            let named = |name: &str| builtin.arguments().position(|arg| arg == name);
            let known = match &given.name {
                Some(name) => named(&name.text),
                None => Some(i).filter(|i| *i < out.len()),
            };
            // Of several that are too many the first is told.
            if known.is_none() && given.name.is_none() && !is_whole {
                continue;
            }
            let place = known.or_else(|| {
                let meant = self.misplaced(builtin, &given)?;
                named(meant).filter(|place| out[*place].is_none())
            });
            match place {
                None => is_whole = false,
                Some(place) if out[place].is_some() => {
                    is_whole = false;
                    let name = builtin.args[place].trim_end_matches('?');
                    self.poison("E0404", given.span, format!("`{name}` is given twice"));
                }
                Some(place) => {
                    out[place] = Some(Argument { value: given.value, span: given.span });
                }
            }
        }
        for (arg, value) in builtin.args.iter().zip(&out).filter(|_| is_whole) {
            if value.is_none() && !arg.ends_with('?') {
                let message = format!("`{}` wants `{arg}`", builtin.name);
                let usage = format!("it is called as `{}`", builtin.usage());
                self.tell(Diagnostic::error("E0403", span, message).help(usage));
            }
        }
        out
    }

    /// Tells of an argument that a function does not take; the name that is surely meant.
    fn misplaced(&mut self, builtin: &Builtin, given: &Given) -> Option<&'static str> {
        let (at, message, near) = match &given.name {
            Some(name) => {
                let message = format!("`{}` has no parameter `{}`", builtin.name, name.text);
                let known: Vec<&str> = builtin.arguments().collect();
                (name.span, message, elsewhere::meant(&name.text, &known))
            }
            None => (given.span, takes_only(builtin.name, builtin.args.len()), None),
        };
        let found = Diagnostic::error("E0402", at, message).meant(at, near);
        let known = near.filter(|near| near.grade == Grade::Sure);
        self.tell(found.help(format!("it is called as `{}`", builtin.usage())));
        builtin.arguments().find(|arg| known.is_some_and(|near| near.name == *arg))
    }

    /// A number of a dimension; a bare one takes the file's unit.
    fn number_arg(&mut self, call: &Call<'_>, i: usize, wanted: Dimension) -> Option<f64> {
        let arg = call.arg(i)?;
        match arg.value {
            Value::Number(x, d) if d == wanted => Some(x),
            Value::Number(x, d) => {
                let scale = self.unit_scale(call, d, wanted, arg.span)?;
                Some(x * scale)
            }
            other => {
                let message =
                    format!("`{}` wants {}, not {}", call.name, wanted.name(), other.describe());
                self.poison("E0214", arg.span, message);
                None
            }
        }
    }

    /// How many units of the wanted dimension a number of dimension `found` counts.
    fn unit_scale(
        &mut self,
        call: &Call<'_>,
        found: Dimension,
        wanted: Dimension,
        span: Span,
    ) -> Option<f64> {
        let units = |dimension: Dimension| call.env.file.units.get(&dimension).copied();
        if let Some(scale) = scale(found, wanted, &units) {
            return Some(scale);
        }
        if found.is_none() {
            let message =
                format!("`{}` wants {}, the number has no unit", call.name, wanted.name());
            let found = Diagnostic::error("E0201", span, message);
            let found = self.with_units(found, span, super::types::likely_units(wanted));
            self.tell(found);
        } else {
            let trigonometric = matches!(call.name, "sin" | "cos" | "tan");
            let code = if trigonometric { "E0205" } else { "E0202" };
            let message = format!("`{}` wants {}, not {}", call.name, wanted.name(), found.name());
            self.poison(code, span, message);
        }
        None
    }

    /// A vector with its dimension.
    fn vector_arg(&mut self, call: &Call<'_>, i: usize) -> Option<([f64; 3], Dimension, Span)> {
        let arg = call.arg(i)?;
        let (data, dimension): (Arc<[f64]>, Dimension) = match &arg.value {
            Value::Numbers(n) => (n.data.clone(), n.dimension),
            Value::Items(items) => match with_zeros(&items.items) {
                Some((data, dimension)) => (data.into(), dimension),
                None => return self.no_vector(call, &arg),
            },
            _ => return self.no_vector(call, &arg),
        };
        let Ok(vector) = <[f64; 3]>::try_from(&*data) else {
            let message =
                format!("`{}` wants a vector of 3 numbers, {} are given", call.name, data.len());
            self.poison("E0207", arg.span, message);
            return None;
        };
        Some((vector, dimension, arg.span))
    }

    fn no_vector<T>(&mut self, call: &Call<'_>, arg: &Argument) -> Option<T> {
        let message = format!(
            "`{}` wants a vector (x, y, z) of one unit, not {}",
            call.name,
            arg.value.describe()
        );
        self.poison("E0214", arg.span, message);
        None
    }

    /// A vector of a dimension; a bare one takes the file's unit.
    fn vector_of(&mut self, call: &Call<'_>, i: usize, wanted: Dimension) -> Option<glam::DVec3> {
        let (v, found, span) = self.vector_arg(call, i)?;
        let scale = self.unit_scale(call, found, wanted, span)?;
        Some(glam::DVec3::from_array(v) * scale)
    }

    fn text_arg(&mut self, call: &Call<'_>, i: usize) -> Option<(Arc<str>, Span)> {
        let arg = call.arg(i)?;
        match arg.value {
            Value::Text(text) => Some((text, arg.span)),
            other => {
                let message = format!("`{}` wants text, not {}", call.name, other.describe());
                self.poison("E0214", arg.span, message);
                None
            }
        }
    }
}

/// A call of a builtin.
struct Call<'a> {
    name: &'static str,
    args: Vec<Option<Argument>>,
    span: Span,
    env: &'a Env,
}

impl Call<'_> {
    /// An argument that was given; `None` also if there was a mistake in it.
    fn arg(&self, i: usize) -> Option<Argument> {
        self.args.get(i).cloned().flatten().filter(|arg| !arg.value.is_poison())
    }
}
