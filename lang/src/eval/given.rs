//! From values of the language to values that the schema's check knows, and its answers to
//! diagnostics.

use std::sync::Arc;

use luxel_core::diag::{Diagnostic, Span};
use luxel_core::scene::{self, Given, Misfit, NodeId};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Dimension, Param, Type, Unit};

use super::env::File;
use super::ops::with_zeros;
use super::value::{FieldValue, Value, What};
use super::{Evaluator, OF_KINDS};
use crate::syntax::Form;

/// Bytes of a mend that is offered for a value as a whole.
const LINE: usize = 100;

impl Evaluator<'_> {
    /// Fits a field to its parameter; `None` after a mistake.
    pub(super) fn conform(&mut self, param: &Param, field: &FieldValue) -> Option<scene::Value> {
        self.bare_word(param, field);
        let given = self.given(param, field)?;
        let is_heat =
            is_spectrum(param) && matches!(given, Given::Number(_, Dimension::TEMPERATURE));
        let units = |dimension: Dimension| field.file.units.get(&dimension).copied();
        match scene::conform(param, given, &units) {
            Ok(value) => Some(value),
            Err(misfit) => {
                let mut found = self.misfit(&misfit, field.span);
                found = self.with_unquoted(found, param, field);
                let is_wanted = |dimension| {
                    let mut units = param.unit.split('|').filter_map(|unit| Unit::parse(unit).ok());
                    units.any(|unit| unit.dimension == dimension)
                };
                found = self.with_part(found, field.span, is_wanted);
                found = self.with_matt(found, param, field);
                if is_heat {
                    let body = format!("blackbody({})", self.written(field.span));
                    found = found.help("light of a temperature is that of a black body");
                    found = found.guess(field.span, body);
                }
                self.tell(found);
                None
            }
        }
    }

    /// With the matt surface that may be meant by a colour or a texture: `material = rgb.srgb(1, 0, 0)`.
    fn with_matt(&self, found: Diagnostic, param: &Param, field: &FieldValue) -> Diagnostic {
        let is_colour = match &field.value {
            Value::Color(_, dimension) => dimension.is_none(),
            Value::Object(object) => matches!(object.what, What::Node(_, Kind::Texture)),
            _ => false,
        };
        let matt = self.registry.class(Kind::Material, "diffuse");
        if !is_colour || param.ty != Type::Object(Kind::Material) || matt.is_none() {
            return found;
        }
        let found = found.help("a colour is the `reflectance` of a material");
        let written = self.written(field.span);
        let surface = format!("material diffuse {{ reflectance = {written} }}");
        if surface.len() <= LINE { found.guess(field.span, surface) } else { found }
    }

    fn misfit(&self, misfit: &Misfit, span: Span) -> Diagnostic {
        let mut diagnostic = Diagnostic::error(misfit.code, span, misfit.message.clone());
        diagnostic = diagnostic.meant_text(span, misfit.word);
        if !misfit.help.is_empty() {
            diagnostic = diagnostic.help(misfit.help.clone());
        }
        self.with_units(diagnostic, span, &misfit.units)
    }

    fn given(&mut self, param: &Param, field: &FieldValue) -> Option<Given> {
        match &field.value {
            Value::Poison => None,
            Value::Bool(value) => Some(Given::Bool(*value)),
            Value::Number(x, dimension) => Some(Given::Number(*x, *dimension)),
            Value::Text(text) if param.ty == Type::File => {
                Some(Given::Path(field.file.folder.join(&**text)))
            }
            Value::Text(text) => Some(Given::Text(text.clone())),
            Value::Numbers(n) => {
                // Each is looked at, and may be copied into other units.
                let is_copied = n.dimension.is_none() && !param.unit.is_empty() && n.data.len() > 3;
                let bytes = if is_copied { n.data.len() * size_of::<f64>() } else { 0 };
                let is_within =
                    self.tick(n.data.len() as u64 / 16, field.span) && self.hold(bytes, field.span);
                is_within.then(|| Given::Numbers(n.data.clone(), n.dimension))
            }
            Value::Items(items) => self.given_items(param, &items.items, field),
            Value::Color(color, dimension) => Some(Given::Color(color.clone(), *dimension)),
            Value::Look(look) => Some(Given::Look(**look)),
            Value::Object(object) => match object.what {
                What::Node(id, kind) => Some(Given::Node(id, kind)),
                What::Group(..) => {
                    let message =
                        format!("`{}` wants {}, not a group", param.name, scene::wanted(param));
                    self.poison("E0408", field.span, message);
                    None
                }
            },
            other => {
                let message = format!(
                    "`{}` wants {}, not {}",
                    param.name,
                    scene::wanted(param),
                    other.describe()
                );
                self.poison("E0214", field.span, message);
                None
            }
        }
    }

    /// A vector with bare zeros, or a table whose rows are vectors.
    fn given_items(&mut self, param: &Param, items: &[Value], field: &FieldValue) -> Option<Given> {
        if !self.tick(items.len() as u64, field.span) {
            return None;
        }
        if let Some((data, dimension)) = with_zeros(items) {
            return Some(Given::Numbers(data.into(), dimension));
        }
        if let Some((data, dimension)) = with_file_units(items, &field.file) {
            return Some(Given::Numbers(data.into(), dimension));
        }
        if param.ty == Type::Table
            && let Some(given) = self.rows(items, field)
        {
            return Some(given);
        }
        let message = format!(
            "`{}` wants {}, not {} values {OF_KINDS}",
            param.name,
            scene::wanted(param),
            items.len()
        );
        let number = |item: &Value| match item {
            Value::Number(_, dimension) => Some(*dimension),
            _ => None,
        };
        let numbers: Option<Vec<_>> = items.iter().map(number).collect();
        let mut units = numbers.unwrap_or_default();
        units.retain(|dimension| *dimension != Dimension::NONE);
        units.dedup();
        let found = Diagnostic::error("E0214", field.span, message);
        self.tell(match &units[..] {
            [_] => found.help(
                "each has its unit, `(1 m, 2 m, x)`, or one stands behind bare numbers, \
                 `(1, 2, 3) m`",
            ),
            _ => found,
        });
        None
    }

    /// Rows of numbers, one after another.
    fn rows(&mut self, items: &[Value], field: &FieldValue) -> Option<Given> {
        let mut data = vec![];
        let mut dimension = None;
        for item in items {
            let (row, found): (Arc<[f64]>, Dimension) = match item {
                Value::Numbers(n) => (n.data.clone(), n.dimension),
                Value::Number(x, d) => (Arc::new([*x]), *d),
                Value::Items(row) if row.form == Form::Tuple => {
                    let (row, d) = with_zeros(&row.items)?;
                    (row.into(), d)
                }
                _ => return None,
            };
            let zero = found.is_none() && row.iter().all(|x| x.abs() <= 0.0);
            if *dimension.get_or_insert(found) != found && !zero {
                return None;
            }
            if !self.tick(row.len() as u64, field.span) || data.len() > self.budgets.list {
                return None;
            }
            data.extend_from_slice(&row);
        }
        Some(Given::Numbers(data.into(), dimension.unwrap_or_default()))
    }

    /// The node of a value that must be an object of a kind; `None` after a mistake.
    pub(super) fn node_of(&mut self, field: &FieldValue, wanted: Kind) -> Option<NodeId> {
        match &field.value {
            Value::Poison => None,
            Value::Object(object) => match object.what {
                What::Node(id, kind) if kind == wanted => Some(id),
                _ => {
                    let message =
                        format!("`{}` wants a {wanted}, not a {}", field.name.text, object.word());
                    self.poison("E0408", field.span, message);
                    None
                }
            },
            other => {
                let message =
                    format!("`{}` wants a {wanted}, not {}", field.name.text, other.describe());
                self.poison("E0408", field.span, message);
                None
            }
        }
    }
}

/// Whether a parameter says of which colour light is, and nothing of how much.
fn is_spectrum(param: &Param) -> bool {
    param.ty == Type::Emission && param.group.is_empty()
}

/// A vector in which bare numbers stand beside numbers of one dimension, in the file's units.
fn with_file_units(items: &[Value], file: &File) -> Option<(Vec<f64>, Dimension)> {
    let dimension = items.iter().find_map(|item| match item {
        Value::Number(_, d) if !d.is_none() => Some(*d),
        _ => None,
    })?;
    let scale = file.units.get(&dimension)?;
    let number = |item: &Value| match item {
        Value::Number(x, d) if *d == dimension => Some(*x),
        Value::Number(x, Dimension::NONE) => Some(x * scale),
        _ => None,
    };
    Some((items.iter().map(number).collect::<Option<_>>()?, dimension))
}
