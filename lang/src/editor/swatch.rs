//! Colours that the text alone tells: calls with literal arguments.

use std::collections::HashMap;
use std::ops::Range;

use luxel_core::scene::Color;
use luxel_sdk::color::{glass, is_blackbody, is_illuminant, is_metal};
use luxel_sdk::params::{Dimension, Unit};

use super::document::Document;
use crate::eval::builtins::{self, linear_srgb};
use crate::eval::names::moved;
use crate::eval::note::{on_screen, shown};
use crate::syntax::{Arg, Expr, ExprNode, Form, Op, Stmt, each_expr};

/// A colour in a text.
#[derive(Clone, Debug, PartialEq)]
pub struct Swatch {
    /// The call that makes it.
    pub range: Range<usize>,
    /// What a screen shows: sRGB, each in [0, 1].
    pub srgb: [f64; 3],
}

/// The colours of calls with literal arguments, in order; nothing more once `stop` says so.
pub fn swatches(document: &Document, stop: &dyn Fn() -> bool) -> Vec<Swatch> {
    let mut out = vec![];
    // The same spectra come often, and cost a thousand times what three numbers do.
    let mut known: HashMap<&str, Option<[f64; 3]>> = HashMap::new();
    for piece in document.pieces().iter().take_while(|_| !stop()) {
        for stmt in &piece.read.stmts {
            each_call(stmt, &mut |call, callee, args| {
                if stop() {
                    return;
                }
                let Some(color) = literal(callee, args) else { return };
                let range = moved(call.span, piece.start).range();
                let srgb = match &color {
                    Color::Rgb(_) => on_screen(&color),
                    _ => *known
                        .entry(&document.text()[range.clone()])
                        .or_insert_with(|| on_screen(&color)),
                };
                out.extend(srgb.map(|srgb| Swatch { range, srgb }));
            });
        }
    }
    out
}

fn each_call<'s>(stmt: &'s Stmt, each: &mut dyn FnMut(&'s Expr, &'s Expr, &'s [Arg])) {
    each_expr(stmt, &mut |expr| {
        if let ExprNode::Call { callee, args } = &expr.node {
            each(expr, callee, args);
        }
    });
}

/// The colour in words of the call whose function's name a byte stands in, if its arguments are literal.
pub(super) fn literal_at(document: &Document, at: usize) -> Option<String> {
    let piece = document.piece_at(at)?;
    let mut found = None;
    for stmt in &piece.read.stmts {
        each_call(stmt, &mut |_, callee, args| {
            if moved(callee.span, piece.start).range().contains(&at) {
                found = literal(callee, args);
            }
        });
    }
    found.as_ref().map(shown)
}

/// What a name of a catalogue stands for, in words.
pub(super) fn named(function: &str, name: &str) -> Option<String> {
    of_name(function, name).as_ref().map(shown)
}

/// The colour that a call makes of literal arguments.
fn literal(callee: &Expr, args: &[Arg]) -> Option<Color> {
    let ExprNode::Path(path) = &callee.node else { return None };
    let function = path.iter().map(|name| &*name.text).collect::<Vec<_>>().join(".");
    let mut given: [Option<&Expr>; 3] = [None; 3];
    for (i, arg) in args.iter().enumerate() {
        let name = arg.name.as_ref();
        let place = name.map_or(Some(i), |name| builtins::place(&function, &name.text))?;
        *given.get_mut(place)? = Some(&arg.value);
    }
    let plain = |value: &Expr| number(value, Dimension::NONE);
    let first = given[0]?;
    match (&*function, &first.node) {
        ("blackbody", _) => {
            let kelvin = number(first, Dimension::TEMPERATURE)?;
            is_blackbody(kelvin).then_some(Color::Blackbody(kelvin))
        }
        ("spectrum.constant", _) => plain(first).map(Color::Constant),
        ("spectrum", ExprNode::Items { items, unit: None, form: Form::List }) => {
            Some(Color::Curve(items.iter().map(point).collect::<Option<Vec<_>>>()?.into()))
        }
        (function, ExprNode::Text(name)) => of_name(function, name),
        (function, _) => {
            let numbers = [plain(first)?, plain(given[1]?)?, plain(given[2]?)?];
            linear_srgb(function, numbers).map(Color::Rgb)
        }
    }
}

fn of_name(function: &str, name: &str) -> Option<Color> {
    match function {
        "metal" if is_metal(name) => Some(Color::Metal(name.into())),
        "glass" if glass(name).is_some() => Some(Color::Glass(name.into())),
        "illuminant" if is_illuminant(name) => Some(Color::Illuminant(name.into())),
        _ => None,
    }
}

/// A literal number of a dimension, in SI units.
fn number(value: &Expr, dimension: Dimension) -> Option<f64> {
    match &value.node {
        ExprNode::Number(x, unit) => {
            let unit = unit.as_deref().copied().unwrap_or(Unit::ONE);
            (unit.dimension == dimension).then_some(x * unit.scale)
        }
        ExprNode::Unary { op: Op::Sub, inner } => number(inner, dimension).map(|x| -x),
        _ => None,
    }
}

/// A wavelength in nanometres and a value: `(400 nm, 0.1)`.
fn point(value: &Expr) -> Option<(f64, f64)> {
    match &value.node {
        ExprNode::Items { items, unit: None, form: Form::Tuple } => match &**items {
            [wavelength, y] => {
                let metres = number(wavelength, Dimension::LENGTH)?;
                Some((metres * 1e9, number(y, Dimension::NONE)?))
            }
            _ => None,
        },
        _ => None,
    }
}

/// How a colour of a screen may be written in the place of a call: by the same function, and as sRGB;
/// not at all where that is no call with three numbers, for a spectrum cannot be had back.
pub fn written(call: &str, srgb: [f64; 3]) -> Vec<String> {
    let function = call.split('(').next().unwrap_or_default().trim();
    let Some(own) = builtins::of_screen(function, srgb) else { return vec![] };
    let form = |function: &str, parts: [String; 3]| format!("{function}({})", parts.join(", "));
    let encoded = form("rgb.srgb", srgb.map(|x| ((x * 1000.0).round() / 1000.0).to_string()));
    if function == "rgb.srgb" {
        return vec![encoded];
    }
    // Finer than one of a screen's 255 steps where it is darkest.
    let digits = own.map(|x| ((x * 1e5).round() / 1e5 + 0.0).to_string());
    vec![form(function, digits), encoded]
}
