//! A value against the schema: whether it fits a parameter, and what it becomes.
//!
//! Pure and without places in a file: the language and the importers use the same rules and add
//! their own spans.

mod color;
mod range;

use std::path::PathBuf;
use std::sync::Arc;

use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Dimension, Look, Param, Role, Type, Unit};

pub use range::{number_words, range_words, said, said_unit};

use super::{Color, NodeId, Value};
use crate::diag::{Near, near};

/// A value before anyone knows which parameter it is for.
#[derive(Clone, Debug, PartialEq)]
pub enum Given {
    /// True or false.
    Bool(bool),
    /// A number in SI units with what it measures.
    Number(f64, Dimension),
    /// A vector or table in SI units with what its numbers measure.
    Numbers(Arc<[f64]>, Dimension),
    /// Text or a choice's word.
    Text(Arc<str>),
    /// A file.
    Path(PathBuf),
    /// The bytes of a file inside another one, with a name for messages.
    Bytes(Arc<str>, Arc<[u8]>),
    /// A colour or spectrum with the dimension that multiplies it.
    Color(Color, Dimension),
    /// Where something stands and looks.
    Look(Look),
    /// Another node and its kind.
    Node(NodeId, Kind),
}

/// Why a value does not fit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Misfit {
    /// The catalogue's code.
    pub code: &'static str,
    /// What was found and what is wanted, lower case, no full stop.
    pub message: String,
    /// Advice; may be empty.
    pub help: String,
    /// The word that was probably meant, for a choice.
    pub word: Option<Near<'static>>,
    /// Units that a bare number most likely lacks.
    pub units: Vec<&'static str>,
}

impl Misfit {
    fn new(code: &'static str, message: String) -> Self {
        Self { code, message, help: String::new(), word: None, units: vec![] }
    }

    fn help(self, help: impl Into<String>) -> Self {
        Self { help: help.into(), ..self }
    }
}

/// How many SI units a bare number of a dimension counts, where a file declares that.
pub type DefaultUnits<'a> = &'a dyn Fn(Dimension) -> Option<f64>;

/// Fits a value to a parameter: checks type, dimension and range.
///
/// Numbers are in SI units; a bare number for a dimensioned parameter is taken in `units` if those
/// say so. Numbers that are not finite never fit. A colour passes only where its role allows it.
///
/// # Errors
/// Why it does not fit.
pub fn conform(param: &Param, given: Given, units: DefaultUnits<'_>) -> Result<Value, Misfit> {
    match (param.ty, given) {
        (Type::Object(wanted), Given::Node(id, kind)) if wanted == kind => Ok(Value::Node(id)),
        (Type::Part, Given::Node(id, Kind::Shape)) => Ok(Value::Node(id)),
        (_, Given::Node(id, Kind::Texture)) if param.textured => Ok(Value::Node(id)),
        (_, Given::Node(_, kind)) => Err(wrong_node(param, kind)),
        (Type::Bool, Given::Bool(value)) => Ok(Value::Bool(value)),
        (Type::Choice, Given::Text(word)) => choice(param, word),
        (Type::Text, Given::Text(text)) => Ok(Value::Text(text)),
        (Type::File, Given::Text(path)) => Ok(Value::Path(PathBuf::from(&*path))),
        (Type::File, Given::Path(path)) => Ok(Value::Path(path)),
        (Type::File, Given::Bytes(name, bytes)) => Ok(Value::Bytes(name, bytes)),
        (Type::Look, Given::Look(look)) => Ok(Value::look(look)),
        (
            Type::Float | Type::Double | Type::Int | Type::MaybeFloat,
            Given::Number(x, dimension),
        ) => number(param, x, dimension, units),
        (Type::Emission, Given::Number(x, dimension)) if !param.group.is_empty() => {
            number(param, x, dimension, units)
        }
        (Type::Vec2, Given::Numbers(v, dimension)) => vector(param, &v, 2, dimension, units),
        (Type::Vec3 | Type::DVec3, Given::Numbers(v, dimension)) => {
            vector(param, &v, 3, dimension, units)
        }
        (Type::Table, Given::Numbers(v, dimension)) => table(param, v, dimension, units),
        (Type::Spectrum | Type::ComplexIor | Type::Emission, given)
            if param.ty != Type::Emission || param.group.is_empty() =>
        {
            color::conform(param, given, units)
        }
        (_, given) => Err(wrong_type(param, &given)),
    }
}

/// What a value is, in words.
pub fn describe(given: &Given) -> String {
    match given {
        Given::Bool(value) => format!("`{value}`"),
        Given::Number(_, dimension) => dimension.name(),
        Given::Numbers(v, _) => format!("{} numbers", v.len()),
        Given::Text(text) => format!("the text \"{text}\""),
        Given::Path(_) | Given::Bytes(..) => "a file".to_owned(),
        Given::Color(..) => "a colour".to_owned(),
        Given::Look(_) => "a view".to_owned(),
        Given::Node(_, kind) => format!("a {kind}"),
    }
}

/// What a parameter takes, in words.
pub fn wanted(param: &Param) -> String {
    let unit = param.unit.replace('|', " or ");
    let with_unit = |what: &str| match param.unit {
        "" | "EV" => what.to_owned(),
        _ => format!("{what} in {unit}"),
    };
    match param.ty {
        Type::Int => "a whole number".to_owned(),
        Type::Bool => "`true` or `false`".to_owned(),
        Type::Vec2 => with_unit("a vector (x, y)"),
        Type::Vec3 | Type::DVec3 => with_unit("a vector (x, y, z)"),
        Type::Spectrum if param.role == Role::Waves => with_unit("a number"),
        Type::Spectrum | Type::ComplexIor => with_unit("a colour or spectrum"),
        Type::Emission if param.group.is_empty() => "a colour or spectrum".to_owned(),
        Type::Float | Type::Double | Type::MaybeFloat | Type::Emission => with_unit("a number"),
        Type::Choice => format!("one of \"{}\"", words(param)),
        Type::Text => "text".to_owned(),
        Type::File => "a file's path".to_owned(),
        Type::Table => with_unit("a list of numbers"),
        Type::Look => "look_at(from, to, up)".to_owned(),
        Type::Object(kind) => format!("a {kind}"),
        Type::Part => "a shape".to_owned(),
    }
}

fn wrong_type(param: &Param, given: &Given) -> Misfit {
    let message = format!("`{}` wants {}, not {}", param.name, wanted(param), describe(given));
    Misfit::new("E0214", message)
}

fn wrong_node(param: &Param, kind: Kind) -> Misfit {
    let message = format!("`{}` wants {}, not a {kind}", param.name, wanted(param));
    let misfit = Misfit::new("E0408", message);
    if kind == Kind::Texture {
        misfit.help("a texture cannot drive this parameter")
    } else {
        misfit
    }
}

fn words(param: &Param) -> String {
    param.words().collect::<Vec<_>>().join("\", \"")
}

fn choice(param: &Param, word: Arc<str>) -> Result<Value, Misfit> {
    if param.words().any(|known| known == &*word) {
        return Ok(Value::Text(word));
    }
    let message = format!("`{}` has no choice \"{word}\"", param.name);
    let known = format!("known are \"{}\"", words(param));
    let near = near(&word, param.words());
    Err(Misfit { word: near, ..Misfit::new("E0416", message).help(known) })
}

/// The dimensions that a parameter takes; a plugin's misspelt unit counts as none.
fn dimensions(param: &Param) -> impl Iterator<Item = Dimension> {
    param.unit.split('|').map(|unit| match unit {
        "" => Dimension::NONE,
        unit => Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension),
    })
}

/// The factor to SI units and the dimension that a number of this dimension has here.
fn unit_of(
    param: &Param,
    found: Dimension,
    units: DefaultUnits<'_>,
) -> Result<(f64, Dimension), Misfit> {
    if dimensions(param).any(|wanted| wanted == found) {
        return Ok((1.0, found));
    }
    if found.is_none() {
        let default = dimensions(param).find_map(|d| units(d).map(|scale| (scale, d)));
        return default.ok_or_else(|| bare(param));
    }
    let light = !param.group.is_empty();
    let code = if light { "E0213" } else { "E0202" };
    let what = found.name();
    let message = match param.unit {
        "" if matches!(param.ty, Type::Spectrum | Type::Emission) => {
            format!("`{}` wants {}, not {what}", param.name, wanted(param))
        }
        "" => format!("`{}` wants a plain number, not {what}", param.name),
        unit => {
            let named = dimensions(param).next().unwrap_or_default().name();
            let named =
                if named.starts_with('a') { format!("{named}, as in ") } else { String::new() };
            format!("`{}` wants {named}{}, not {what}", param.name, unit.replace('|', " or "))
        }
    };
    Err(Misfit::new(code, message))
}

fn bare(param: &Param) -> Misfit {
    let units: Vec<&str> =
        param.unit.split('|').flat_map(|unit| likely_units(param.role, unit)).collect();
    let written = match (param.role, param.unit) {
        (Role::Waves, _) => units[0].to_owned(),
        (_, "rad") => "deg or rad".to_owned(),
        (_, unit) => unit.replace('|', " or "),
    };
    let message = format!("`{}` wants a unit, as in {written}", param.name);
    let help = bare_help(dimensions(param).next().unwrap_or_default());
    Misfit { units, ..Misfit::new("E0201", message).help(help) }
}

/// What to do about a number that lacks a unit of a dimension.
pub fn bare_help(wanted: Dimension) -> String {
    let give = "give the number a unit";
    let units = match wanted {
        Dimension::LENGTH => "length = mm",
        Dimension::ANGLE => "angle = deg",
        Dimension::TIME => "time = s",
        _ => return give.to_owned(),
    };
    format!("{give}, or state the file's units once: `units {{ {units} }}`")
}

/// The units that people use for the dimension of a schema's unit.
fn likely_units(role: Role, unit: &'static str) -> Vec<&'static str> {
    match (role, unit) {
        (Role::Waves, _) => vec!["nm", "um"],
        (_, "m") => vec!["m", "cm", "mm"],
        (_, "rad" | "deg") => vec!["deg", "rad"],
        (_, unit) if unit.starts_with("1/") => vec![],
        (_, unit) => vec![unit],
    }
}

fn in_range(param: &Param, x: f64, place: &str) -> Result<(), Misfit> {
    if !x.is_finite() {
        let message = format!("`{}`{place} is not a finite number", param.name);
        return Err(Misfit::new("E0209", message));
    }
    if param.min <= x && x <= param.max {
        return Ok(());
    }
    let unit = match param.unit {
        "" | "EV" => String::new(),
        "rad" | "deg" => " deg".to_owned(),
        _ => dimensions(param).next().map(|d| format!(" {d}")).unwrap_or_default(),
    };
    let reflectance = param.role == Role::Reflectance && x > param.max;
    let code = if reflectance { "E0210" } else { "E0405" };
    let legal = range_words(param).unwrap_or_default();
    let x = said(param, x);
    let message = format!("`{}`{place} is {x}{unit}; it must be {legal}{unit}", param.name);
    Err(Misfit::new(code, message))
}

fn number(
    param: &Param,
    x: f64,
    found: Dimension,
    units: DefaultUnits<'_>,
) -> Result<Value, Misfit> {
    let (scale, dimension) = unit_of(param, found, units)?;
    let x = x * scale;
    if param.ty == Type::Int && x.is_finite() {
        whole(param, x)?;
        in_range(param, x, "")?;
        if !(0.0..=f64::from(u32::MAX)).contains(&x) {
            let found = number_words(x);
            let message = format!("`{}` is {found}; it must be from 0 to {}", param.name, u32::MAX);
            return Err(Misfit::new("E0405", message));
        }
    }
    let single = !matches!(param.ty, Type::Double | Type::Int);
    if single && x.abs() > f64::from(f32::MAX) {
        let message = format!("`{}` is too large: {}", param.name, number_words(x));
        return Err(Misfit::new("E0405", message));
    }
    in_range(param, x, "")?;
    Ok(Value::Number(x, dimension))
}

/// Checks that a number is whole.
fn whole(param: &Param, x: f64) -> Result<(), Misfit> {
    if x.is_finite() && x.fract().abs() > 0.0 {
        let message = format!("`{}` wants a whole number, not {}", param.name, number_words(x));
        return Err(Misfit::new("E0208", message));
    }
    Ok(())
}

fn vector(
    param: &Param,
    v: &[f64],
    length: usize,
    found: Dimension,
    units: DefaultUnits<'_>,
) -> Result<Value, Misfit> {
    if v.len() != length {
        let message = format!("`{}` wants {length} numbers, {} are given", param.name, v.len());
        return Err(Misfit::new("E0207", message));
    }
    let (scale, _) = unit_of(param, found, units)?;
    let v: Vec<f64> = v.iter().map(|x| x * scale).collect();
    for x in v.iter().filter(|_| param.role == Role::Count) {
        whole(param, *x)?;
    }
    for (x, name) in v.iter().zip(["x", "y", "z"]) {
        in_range(param, *x, &format!(".{name}"))?;
    }
    Ok(Value::vector(v))
}

fn table(
    param: &Param,
    v: Arc<[f64]>,
    found: Dimension,
    units: DefaultUnits<'_>,
) -> Result<Value, Misfit> {
    let (scale, _) = unit_of(param, found, units)?;
    let scaled = (scale - 1.0).abs() > 0.0;
    let v = if scaled { v.iter().map(|x| x * scale).collect() } else { v };
    let bad = v.iter().position(|x| !(param.min <= *x && *x <= param.max && x.is_finite()));
    match bad {
        Some(i) => Err(in_range(param, v[i], &format!("[{i}]")).expect_err("it is out of range")),
        None => Ok(Value::Table(v)),
    }
}

#[cfg(test)]
mod tests;
