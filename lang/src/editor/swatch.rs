//! Colours that are written as numbers.

use std::ops::Range;

use luxel_sdk::color::srgb_encode;

use super::document::Document;
use crate::eval::builtins::linear_srgb;
use crate::eval::names::moved;
use crate::syntax::{Arg, Expr, ExprNode, Stmt, each_expr};

/// A colour in a text.
#[derive(Clone, Debug, PartialEq)]
pub struct Swatch {
    /// The call that makes it.
    pub range: Range<usize>,
    /// What a screen shows: sRGB, each in [0, 1].
    pub srgb: [f64; 3],
}

/// The colours that are written as numbers, in order; nothing more once `stop` says so.
pub fn swatches(document: &Document, stop: &dyn Fn() -> bool) -> Vec<Swatch> {
    let mut out = vec![];
    for piece in document.pieces().iter().take_while(|_| !stop()) {
        for stmt in &piece.read.stmts {
            of_stmt(stmt, piece.start, &mut out);
        }
    }
    out
}

fn of_stmt(stmt: &Stmt, start: usize, out: &mut Vec<Swatch>) {
    each_expr(stmt, &mut |expr| {
        if let ExprNode::Call { callee, args } = &expr.node
            && let Some(srgb) = shown(callee, args)
        {
            out.push(Swatch { range: moved(expr.span, start).range(), srgb });
        }
    });
}

/// What a call with three plain numbers makes.
fn shown(callee: &Expr, args: &[Arg]) -> Option<[f64; 3]> {
    let ExprNode::Path(path) = &callee.node else { return None };
    let name: Vec<&str> = path.iter().map(|name| &*name.text).collect();
    let number = |arg: &Arg| match (&arg.name, &arg.value.node) {
        (None, ExprNode::Number(x, None)) => Some(*x),
        _ => None,
    };
    let numbers: Vec<f64> = args.iter().map(number).collect::<Option<_>>()?;
    let linear = linear_srgb(&name.join("."), numbers.try_into().ok()?)?;
    Some(linear.map(|x| srgb_encode(x).clamp(0.0, 1.0)))
}

/// How a colour of a screen is written.
pub fn written(srgb: [f64; 3]) -> String {
    let parts = srgb.map(|x| ((x * 1000.0).round() / 1000.0).to_string());
    format!("rgb.srgb({})", parts.join(", "))
}
