//! Types that a scene file writes, and whether values fit them.

use luxel_core::diag::{Diagnostic, Span};
use luxel_core::scene;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::Dimension;

use super::Evaluator;
use super::arithmetic::scale;
use super::env::Env;
use super::value::Value;
pub(crate) use crate::syntax::type_names::{dimension, meant, measured, names};
use crate::syntax::{Form, ListTy, Ty};

/// Whether a type exists.
fn is_known(ty: &str) -> bool {
    names().any(|known| known == ty)
}

impl Evaluator<'_> {
    /// The value if it fits the type; a bare number takes the file's unit. Else poison, and told.
    pub(super) fn fit(&mut self, ty: &Ty, value: Value, span: Span, env: &Env) -> Value {
        if value.is_poison() {
            return value;
        }
        let length = match ty.list {
            ListTy::One => return self.fit_one(&ty.name.text, value, span, env),
            ListTy::Any => None,
            ListTy::Exactly(length) => Some(length),
        };
        let found = match &value {
            Value::Numbers(n) if n.form == Form::List => n.data.len(),
            Value::Items(i) if i.form == Form::List => i.items.len(),
            _ => return self.unfit(&format!("a list of {}", ty.name.text), &value, span),
        };
        if let Some(wanted) = length.filter(|wanted| *wanted != found) {
            let message = format!("a list of {wanted} is wanted, {found} are given");
            return self.poison("E0207", span, message);
        }
        match &value {
            Value::Numbers(n) => {
                let wanted = dimension(&ty.name.text);
                let fits = wanted.is_some_and(|d| d == n.dimension) || &*ty.name.text == "any";
                if fits || n.data.is_empty() {
                    return value;
                }
                if !is_known(&ty.name.text) {
                    return Value::Poison;
                }
                self.unfit(&format!("a list of {}", ty.name.text), &value, span)
            }
            Value::Items(items) => {
                if !self.tick(items.items.len() as u64, span) {
                    return Value::Poison;
                }
                for item in &items.items {
                    if self.fit_one(&ty.name.text, item.clone(), span, env).is_poison() {
                        return Value::Poison;
                    }
                }
                value
            }
            _ => value,
        }
    }

    fn fit_one(&mut self, ty: &str, value: Value, span: Span, env: &Env) -> Value {
        if let Some(wanted) = dimension(ty) {
            return self.fit_number(ty, wanted, value, span, env);
        }
        let kind = Kind::of_word(ty);
        let fits = match (&value, ty) {
            (_, "any")
            | (Value::Bool(_), "bool")
            | (Value::Text(_), "string")
            | (Value::Color(..) | Value::Number(..), "color" | "spectrum")
            | (Value::Transform(_), "transform")
            | (Value::Look(_), "view")
            | (Value::Record(_), "record")
            | (Value::Object(_), "object") => true,
            (Value::Object(object), _) => object.word() == ty,
            (Value::Numbers(n), "vec2" | "vec3") => {
                let length = if ty == "vec2" { 2 } else { 3 };
                if n.data.len() != length {
                    let message =
                        format!("a vector of {length} is wanted, {} are given", n.data.len());
                    return self.poison("E0207", span, message);
                }
                true
            }
            (Value::Items(i), "vec2") => i.items.len() == 2,
            (Value::Items(i), "vec3") => i.items.len() == 3,
            _ => false,
        };
        match (fits, &value, kind) {
            (true, ..) => value,
            (false, Value::Object(_), Some(_)) => {
                let message = format!("a {ty} is wanted, {} is given", value.describe());
                self.poison("E0408", span, message)
            }
            // A type that does not exist was told when names were resolved; it may have given a bare number its
            // unit.
            (false, Value::Number(_, Dimension::NONE), _) if !is_known(ty) => Value::Poison,
            _ if !is_known(ty) => value,
            _ => self.unfit(&format!("a {ty}"), &value, span),
        }
    }

    fn unfit(&mut self, wanted: &str, value: &Value, span: Span) -> Value {
        let message = format!("{wanted} is wanted, {} is given", value.describe());
        self.poison("E0214", span, message)
    }

    fn fit_number(
        &mut self,
        ty: &str,
        wanted: Dimension,
        value: Value,
        span: Span,
        env: &Env,
    ) -> Value {
        let Value::Number(x, found) = value else {
            return self.unfit(&wanted.name(), &value, span);
        };
        if found == wanted {
            if ty == "int" && x.fract().abs() > 0.0 {
                return self.poison("E0208", span, format!("a whole number is wanted, not {x}"));
            }
            return value;
        }
        let units = |dimension: Dimension| env.file.units.get(&dimension).copied();
        if let Some(scale) = scale(found, wanted, &units) {
            return Value::Number(x * scale, wanted);
        }
        if !found.is_none() {
            let message = format!("{} is wanted, {} is given", wanted.name(), found.name());
            let found = Diagnostic::error("E0202", span, message);
            let found = self.with_part(found, span, |dimension| dimension == wanted);
            self.tell(found);
            return Value::Poison;
        }
        let message = format!("{} is wanted, the number has no unit", wanted.name());
        let found = Diagnostic::error("E0201", span, message).help(scene::bare_help(wanted));
        let found = self.with_units(found, span, likely_units(wanted));
        self.tell(found);
        Value::Poison
    }
}

/// The units that people use for a dimension.
pub(super) fn likely_units(dimension: Dimension) -> &'static [&'static str] {
    match dimension {
        Dimension::LENGTH => &["m", "cm", "mm"],
        Dimension::ANGLE => &["deg", "rad"],
        Dimension::TIME => &["s", "ms"],
        Dimension::TEMPERATURE => &["K"],
        Dimension::POWER => &["W"],
        _ => &[],
    }
}
