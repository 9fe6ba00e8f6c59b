//! Functions and constants that every scene has. A definition in a scene shadows one of its name.

mod color;
mod math;
mod motion;
mod spectrum_file;
mod sun;
mod transform;

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Span, near};
use luxel_sdk::params::Dimension;

use super::Evaluator;
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
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Run {
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

const fn builtin(name: &'static str, args: &'static [&'static str], run: Run) -> Builtin {
    Builtin { name, args, run }
}

static BUILTINS: [Builtin; 45] = {
    use color::Make as C;
    use math::Math as M;
    use transform::Transform as T;
    [
        builtin("sin", &["x"], Run::Math(M::Sin)),
        builtin("cos", &["x"], Run::Math(M::Cos)),
        builtin("tan", &["x"], Run::Math(M::Tan)),
        builtin("asin", &["x"], Run::Math(M::Asin)),
        builtin("acos", &["x"], Run::Math(M::Acos)),
        builtin("atan", &["x"], Run::Math(M::Atan)),
        builtin("atan2", &["y", "x"], Run::Math(M::Atan2)),
        builtin("sqrt", &["x"], Run::Math(M::Sqrt)),
        builtin("abs", &["x"], Run::Math(M::Abs)),
        builtin("min", &["a", "b"], Run::Math(M::Min)),
        builtin("max", &["a", "b"], Run::Math(M::Max)),
        builtin("clamp", &["x", "low", "high"], Run::Math(M::Clamp)),
        builtin("floor", &["x"], Run::Math(M::Floor)),
        builtin("ceil", &["x"], Run::Math(M::Ceil)),
        builtin("round", &["x"], Run::Math(M::Round)),
        builtin("pow", &["x", "exponent"], Run::Math(M::Pow)),
        builtin("exp", &["x"], Run::Math(M::Exp)),
        builtin("log", &["x"], Run::Math(M::Log)),
        builtin("hash01", &["seed", "i"], Run::Math(M::Hash01)),
        builtin("len", &["list"], Run::Math(M::Len)),
        builtin("length", &["v"], Run::Math(M::Length)),
        builtin("normalize", &["v"], Run::Math(M::Normalize)),
        builtin("dot", &["a", "b"], Run::Math(M::Dot)),
        builtin("cross", &["a", "b"], Run::Math(M::Cross)),
        builtin("rotate", &["axis", "angle"], Run::Transform(T::Rotate)),
        builtin("move", &["by"], Run::Transform(T::Move)),
        builtin("scale", &["by"], Run::Transform(T::Scale)),
        builtin("matrix", &["rows"], Run::Transform(T::Matrix)),
        builtin("motion", &["keys"], Run::Transform(T::Motion)),
        builtin("spin", &["axis", "rate"], Run::Transform(T::Spin)),
        builtin("look_at", &["from", "to", "up"], Run::Transform(T::LookAt)),
        builtin("rgb", &["r?", "g?", "b?"], Run::Color(C::Bare)),
        builtin("rgb.linear_srgb", &["r", "g", "b"], Run::Color(C::LinearSrgb)),
        builtin("rgb.srgb", &["r", "g", "b"], Run::Color(C::Srgb)),
        builtin("rgb.acescg", &["r", "g", "b"], Run::Color(C::AcesCg)),
        builtin("rgb.rec2020", &["r", "g", "b"], Run::Color(C::Rec2020)),
        builtin("xyz", &["x", "y", "z"], Run::Color(C::Xyz)),
        builtin("blackbody", &["temperature"], Run::Color(C::Blackbody)),
        builtin("spectrum", &["points"], Run::Color(C::Spectrum)),
        builtin("spectrum.file", &["path", "column?"], Run::Color(C::File)),
        builtin("spectrum.constant", &["x"], Run::Color(C::Constant)),
        builtin("illuminant", &["name"], Run::Color(C::Illuminant)),
        builtin("metal", &["name"], Run::Color(C::Metal)),
        builtin("glass", &["name"], Run::Color(C::Glass)),
        builtin("sun_position", &["latitude", "longitude", "time"], Run::Sun),
    ]
};

/// The value of a name that every scene has.
pub(crate) fn value(name: &str) -> Option<Value> {
    match name {
        "pi" => return Some(Value::plain(PI)),
        "tau" => return Some(Value::plain(TAU)),
        _ => {}
    }
    BUILTINS.iter().find(|b| b.name == name).map(Value::Builtin)
}

/// Whether a function that every scene has takes an argument of this name.
pub(crate) fn takes(function: &str, name: &str) -> bool {
    let function = BUILTINS.iter().find(|builtin| builtin.name == function);
    function.is_some_and(|builtin| builtin.args.iter().any(|arg| arg.trim_end_matches('?') == name))
}

/// Every name that every scene has.
pub(crate) fn names() -> impl Iterator<Item = &'static str> {
    BUILTINS.iter().map(|b| b.name).chain(["pi", "tau"])
}

/// Whether a name that every scene has is this one or begins with it and a dot.
pub(crate) fn begins(name: &str) -> bool {
    names().any(|known| known.split('.').next() == Some(name))
}

/// The names of a function's arguments, if there is such a function.
pub(crate) fn arguments(name: &str) -> Option<Vec<&'static str>> {
    let found = BUILTINS.iter().find(|b| b.name == name)?;
    Some(found.args.iter().map(|arg| arg.trim_end_matches('?')).collect())
}

/// What a function makes of three numbers as linear sRGB, if it makes a colour of them.
pub(crate) fn linear_srgb(name: &str, c: [f64; 3]) -> Option<[f64; 3]> {
    use color::Make as C;
    match BUILTINS.iter().find(|b| b.name == name)?.run {
        Run::Color(make @ (C::LinearSrgb | C::Srgb | C::AcesCg | C::Rec2020 | C::Xyz)) => {
            Some(color::linear_srgb(make, c))
        }
        _ => None,
    }
}

/// How a function is called: `clamp(x, low, high)`.
pub(crate) fn usage(name: &str) -> Option<String> {
    Some(format!("{name}({})", arguments(name)?.join(", ")))
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
        let Some(args) = self.arrange(builtin, given, span) else { return Value::Poison };
        if args.iter().flatten().any(|arg| arg.value.is_poison()) {
            return Value::Poison;
        }
        let mut call = Call { name: builtin.name, args, span, env };
        match builtin.run {
            Run::Math(math) => self.math(math, &mut call),
            Run::Transform(transform) => self.make_transform(transform, &mut call),
            Run::Color(make) => self.color(make, &mut call),
            Run::Sun => self.sun(&mut call),
        }
    }

    /// Puts arguments into their places; `None` after a mistake.
    fn arrange(
        &mut self,
        builtin: &Builtin,
        given: Vec<Given>,
        span: Span,
    ) -> Option<Vec<Option<Argument>>> {
        let mut out = vec![None; builtin.args.len()];
        let bare = |arg: &'static str| arg.trim_end_matches('?');
        for (i, given) in given.into_iter().enumerate() {
            let place = match &given.name {
                Some(name) => builtin.args.iter().position(|arg| bare(arg) == &*name.text),
                None => Some(i).filter(|i| *i < out.len()),
            };
            let Some(place) = place else {
                let at = given.name.as_ref().map_or(given.span, |name| name.span);
                let args: Vec<&str> = builtin.args.iter().map(|arg| bare(arg)).collect();
                let mut found = if let Some(name) = &given.name {
                    let message = format!("`{}` has no parameter `{}`", builtin.name, name.text);
                    Diagnostic::error("E0402", at, message)
                } else {
                    let count = args.len();
                    let message = format!("`{}` takes {count} arguments", builtin.name);
                    Diagnostic::error("E0402", at, message)
                };
                found =
                    found.meant(at, given.name.and_then(|n| near(&n.text, args.iter().copied())));
                let usage = format!("it is called as `{}({})`", builtin.name, args.join(", "));
                self.tell(found.help(usage));
                return None;
            };
            if out[place].is_some() {
                let message = format!("`{}` is given twice", bare(builtin.args[place]));
                self.poison("E0404", given.span, message);
                return None;
            }
            out[place] = Some(Argument { value: given.value, span: given.span });
        }
        for (arg, value) in builtin.args.iter().zip(&out) {
            if value.is_none() && !arg.ends_with('?') {
                let args: Vec<&str> = builtin.args.iter().map(|arg| bare(arg)).collect();
                let message = format!("`{}` wants `{arg}`", builtin.name);
                let usage = format!("it is called as `{}({})`", builtin.name, args.join(", "));
                self.tell(Diagnostic::error("E0403", span, message).help(usage));
                return None;
            }
        }
        Some(out)
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
        if found == wanted {
            return Some(1.0);
        }
        if let (true, Some(scale)) = (found.is_none(), call.env.file.units.get(&wanted)) {
            return Some(*scale);
        }
        if found.is_none() {
            let message =
                format!("`{}` wants {}, the number has no unit", call.name, wanted.name());
            let end = Span { start: span.end, ..span };
            let mut diagnostic = Diagnostic::error("E0201", span, message);
            for unit in super::types::likely_units(wanted) {
                diagnostic = diagnostic.guess(end, format!(" {unit}"));
            }
            self.tell(diagnostic);
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
    fn arg(&self, i: usize) -> Option<Argument> {
        self.args.get(i).cloned().flatten()
    }
}
