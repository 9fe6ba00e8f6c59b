//! Values of a parameter: a sensible one, those at the ends of its range, and random ones.

use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use luxel_core::scene::{Color, Value};
use luxel_sdk::params::{Dimension, Look, Param, Preset, Role, Type, Unit};
use luxel_sdk::sampling::Rng;

/// How far a set is from what people render.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Level {
    /// All checks.
    Usual,
    /// Only that nothing breaks: the range is open, and this is far out in it.
    Edge,
}

/// Where cameras and spots stand, and what they look at.
pub(crate) const LOOK: Look =
    Look { from: DVec3::new(0.0, 0.0, 5.0), to: DVec3::ZERO, up: DVec3::Y };

/// Beyond this an end of a range counts as open.
const OPEN: f64 = 1e9;

/// Rows and columns of the table that is given where one is wanted.
const SIDE: usize = 3;

/// The table that is given where that is refused: four places, which make a bow.
const BOW: [f64; 12] = [-2.0, -0.5, 0.3, -0.9, 1.0, -0.6, 1.1, 0.9, 0.8, 2.1, -0.7, -0.2];

/// The dimension of a parameter's first unit.
pub(crate) fn dimension(param: &Param) -> Dimension {
    let unit = param.unit.split('|').next().unwrap_or_default();
    Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension)
}

/// The first number of the default.
pub(crate) fn preset(param: &Param) -> Option<f64> {
    match param.default {
        Preset::Numbers(n) => Some(n[0]),
        _ => None,
    }
}

/// Whether a parameter without default is given although it may be absent: a metal's `k`, and a
/// light's spectrum, grey so that its amount is exact.
pub(crate) fn is_needed(param: &Param) -> bool {
    let light = param.ty == Type::Emission && param.group.is_empty();
    param.role == Role::ComplexIor || light
}

fn typical(param: &Param) -> f64 {
    let x = match (param.role, param.unit) {
        (Role::Ior, _) => 1.5,
        (Role::Reflectance, _) => 0.5,
        (Role::ComplexIor, _) if param.name == "k" => 3.0,
        (Role::ComplexIor, _) => 0.2,
        (_, "rad") => 0.7,
        _ => 1.0,
    };
    preset(param).unwrap_or(x).clamp(param.min, param.max)
}

/// Whether it varies over wavelengths.
pub(crate) fn is_spectrum(param: &Param) -> bool {
    matches!(param.ty, Type::Spectrum | Type::ComplexIor)
        || (param.ty == Type::Emission && param.group.is_empty())
}

/// What lengths are counted in that are told in waves, m.
const MICRON: f64 = 1e-6;

/// A number as a value of the parameter's type.
fn number(param: &Param, x: f64) -> Value {
    if param.role == Role::Waves {
        return Value::Color(Color::Waves(x * MICRON), dimension(param));
    }
    if is_spectrum(param) {
        return Value::Color(Color::Constant(x), dimension(param));
    }
    Value::Number(if param.ty == Type::Int { x.round() } else { x }, dimension(param))
}

pub(crate) fn is_number(param: &Param) -> bool {
    let number = matches!(
        param.ty,
        Type::Float | Type::Double | Type::Int | Type::MaybeFloat | Type::Emission
    );
    number || is_spectrum(param)
}

/// Numbers of a vector type.
fn lanes(ty: Type) -> Option<usize> {
    match ty {
        Type::Vec2 => Some(2),
        Type::Vec3 | Type::DVec3 => Some(3),
        _ => None,
    }
}

/// A value that is likely to be good; `index` tells vectors of a class from each other, `file` is
/// the one to be read; without one, tables are of places.
pub(crate) fn sensible(
    param: &Param,
    index: usize,
    file: &str,
    prop: impl Fn(Type, usize) -> Option<Value>,
) -> Option<Value> {
    if is_number(param) {
        return Some(number(param, typical(param)));
    }
    if let Some(n) = lanes(param.ty) {
        // Where no part may be negative, it is an extent; else directions across each other.
        let axis = |i: usize| if param.min >= 0.0 || i == index % n { 1.0 } else { 0.0 };
        return Some(Value::vector(match param.default {
            Preset::Numbers(numbers) => numbers[..n].to_vec(),
            _ => (0..n).map(axis).collect(),
        }));
    }
    match param.ty {
        Type::Bool => Some(Value::Bool(preset(param).unwrap_or(0.0) > 0.5)),
        Type::Choice => Some(Value::Text(param.words().next()?.into())),
        Type::Text => Some(Value::Text("text".into())),
        Type::File => Some(Value::Path(PathBuf::from(file))),
        Type::Table if file.is_empty() => Some(Value::Table(Arc::from(BOW))),
        Type::Table => Some(Value::Table(Arc::from([0.0; SIDE * SIDE]))),
        Type::Look => Some(Value::look(LOOK)),
        Type::Object(_) | Type::Part => prop(param.ty, index),
        _ => None,
    }
}

/// The ends of the range, every choice, and far out where the range is open.
pub(crate) fn extremes(param: &Param) -> Vec<(Value, Level)> {
    let mut out = vec![];
    let ends = [(param.min, 0.0f64), (param.max, 1e6)];
    for (i, (end, far)) in ends.into_iter().enumerate() {
        let closed = end.abs() <= OPEN;
        let level = if closed && param.unit.is_empty() { Level::Usual } else { Level::Edge };
        let x = if closed { end } else { far.clamp(param.min, param.max) };
        if is_number(param) {
            out.push((number(param, x), level));
        } else if let Some(n) = lanes(param.ty) {
            out.push((Value::vector(vec![x; n]), Level::Edge));
        } else if param.ty == Type::Bool {
            out.push((Value::Bool(i == 1), Level::Usual));
        }
    }
    out.extend(about_zero(param).map(|x| (number(param, x), Level::Usual)));
    let coloured = matches!(param.role, Role::Coefficient | Role::Reflectance);
    if coloured && is_spectrum(param) && param.min <= 0.0 {
        // One lane of a colour may be at the end of its range where others are not.
        let x = typical(param);
        out.push((Value::Color(Color::Rgb([x, 0.0, x]), dimension(param)), Level::Edge));
    }
    if is_number(param) && preset(param).is_none() {
        out.push((number(param, typical(param)), Level::Usual));
    }
    if param.ty == Type::Int && preset(param).is_none() {
        // What may count the rows of a table.
        out.push((number(param, SIDE as f64), Level::Usual));
    }
    let words = param.words().take(8);
    out.extend(words.map(|word| (Value::Text(word.into()), Level::Usual)));
    out
}

/// At and near the middle of a range about 0, where formulae divide by it and plugins take another
/// way.
fn about_zero(param: &Param) -> impl Iterator<Item = f64> + use<> {
    let float = matches!(param.ty, Type::Float | Type::Double);
    let about = float && param.unit.is_empty() && param.min < 0.0 && param.max <= OPEN;
    let near = [0.0, 0.05 * param.max, 0.05 * param.min.max(-OPEN)];
    near.into_iter().filter(move |_| about && near[1] > 0.0)
}

/// A number of the range: evenly, or in its logarithm where the range is wide.
fn anywhere(param: &Param, rng: &mut Rng) -> f64 {
    let (low, high) = (param.min, param.max);
    let part = rng.f64();
    let wide = 10f64.powf(rng.f64() * 4.0 - 2.0);
    match (low.abs() <= OPEN, high.abs() <= OPEN) {
        (true, true) if rng.f32() < 0.4 => low + (high - low) * 10f64.powf(-3.0 * part),
        (true, true) => low + (high - low) * part,
        (true, false) => (low + wide).max(wide.min(high)),
        (false, true) => high - wide,
        (false, false) if part < 0.5 => -wide,
        (false, false) => wide,
    }
}

/// A random value; `bright` has colours at the upper end of their range. `None` for what is not a
/// number or a choice.
pub(crate) fn draw(param: &Param, rng: &mut Rng, bright: bool) -> Option<Value> {
    match (param.role, bright) {
        (Role::Reflectance, true) => return Some(number(param, param.max)),
        // A metal that loses next to nothing.
        (Role::ComplexIor, true) => {
            return Some(number(param, if param.name == "k" { 30.0 } else { 0.01 }));
        }
        _ => {}
    }
    if is_spectrum(param) {
        let reaches = param.role == Role::Reflectance;
        let mut lane = || if reaches { rng.f64() } else { anywhere(param, rng) };
        let rgb = [lane(), lane(), lane()];
        let grey = matches!(param.role, Role::Ior | Role::Illuminant | Role::Waves);
        return Some(if grey {
            let x = if param.role == Role::Ior { 1.0 + 1.5 * rng.f64() } else { rgb[0] };
            number(param, x.clamp(param.min, param.max))
        } else {
            Value::Color(Color::Rgb(rgb), dimension(param))
        });
    }
    if is_number(param) {
        return Some(number(param, anywhere(param, rng)));
    }
    if let Some(n) = lanes(param.ty) {
        // Of one order of magnitude: needles and plates say little of a shape.
        let scale = anywhere(param, rng).abs();
        let signed = param.min < 0.0;
        let mut part = || {
            let sign = if signed && rng.f32() < 0.5 { -1.0 } else { 1.0 };
            sign * scale * (0.2 + 0.8 * rng.f64())
        };
        let vector = (0..n).map(|_| part().clamp(param.min, param.max));
        return Some(Value::vector(vector));
    }
    match param.ty {
        Type::Bool => Some(Value::Bool(rng.f32() < 0.5)),
        Type::Choice => {
            let index = rng.u32() as usize % param.choices.len().max(1);
            Some(Value::Text(param.words().nth(index)?.into()))
        }
        _ => None,
    }
}

/// A measured index of refraction, for the roles that take one.
pub(crate) fn measured(param: &Param) -> Option<Value> {
    let color = match (param.role, param.ty) {
        (Role::Ior, _) => Color::Glass("N-BK7".into()),
        (Role::ComplexIor, Type::ComplexIor) => Color::Metal("Au".into()),
        _ => return None,
    };
    Some(Value::Color(color, Dimension::NONE))
}

/// A value for messages.
pub(crate) fn show(value: &Value) -> String {
    match value {
        Value::Number(x, _) | Value::Color(Color::Constant(x), _) => format!("{x:.6}"),
        Value::Color(Color::Rgb([r, g, b]), _) => format!("rgb({r:.4}, {g:.4}, {b:.4})"),
        Value::Vector(v) => format!("{v:.4?}"),
        Value::Text(text) => format!("\"{text}\""),
        Value::Bool(b) => b.to_string(),
        Value::Path(path) => path.display().to_string(),
        Value::Node(_) | Value::Moved(..) => "a reference".to_owned(),
        other => format!("{other:?}"),
    }
}
