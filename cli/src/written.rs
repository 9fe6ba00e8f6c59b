//! Values as a scene file writes them: read again they are the same to the last bit.

use std::fmt::Write;

use luxel_core::diag::Sources;
use luxel_core::registry::Registry;
use luxel_core::scene::{Argument, Node, Value};
use luxel_sdk::params::{Dimension, Unit};

/// A class with its parameters as a scene gives them: `path { max_depth = 8 }`.
pub(crate) fn node(node: &Node, value: impl Fn(&Argument) -> String) -> String {
    let fields = node.params.iter().map(|given| format!("{} = {}", given.name, value(given)));
    let fields = fields.collect::<Vec<_>>().join(", ");
    let inside = if fields.is_empty() { "{}".to_owned() } else { format!("{{ {fields} }}") };
    format!("{} {inside}", node.class)
}

/// The value of a parameter, as it is written.
pub(crate) fn value(
    argument: &Argument,
    node: &Node,
    registry: &Registry,
    sources: &Sources,
) -> String {
    match &argument.value {
        Value::Bool(value) => value.to_string(),
        Value::Number(x, dimension) => number(*x, *dimension),
        Value::Vector(v) => {
            let class = registry.class(node.kind, node.class);
            let param = class.and_then(|class| {
                Registry::params(class).find(|param| param.name == argument.name)
            });
            let unit = param.and_then(|param| param.unit.split('|').next()).unwrap_or_default();
            // Numbers are kept in SI units.
            let si = Unit::parse(unit).map_or(Dimension::NONE, |unit| unit.dimension);
            let numbers: Vec<_> = v.iter().map(ToString::to_string).collect();
            format!("({}){}", numbers.join(", "), behind(si))
        }
        Value::Text(text) => quoted(text),
        // As its author has it.
        _ => {
            let span = argument.span;
            let text = sources.text(span.source);
            text.get(span.range()).unwrap_or_default().to_owned()
        }
    }
}

fn behind(si: Dimension) -> String {
    if si.is_none() { String::new() } else { format!(" {si}") }
}

/// In the first unit in which it is short and comes out the same.
fn number(x: f64, dimension: Dimension) -> String {
    let units: &[&str] = match dimension {
        Dimension::ANGLE => &["deg"],
        Dimension::LENGTH if x.abs() < 0.1 => &["mm"],
        _ => &[],
    };
    for name in units {
        let Some(unit) = Unit::named(name) else { continue };
        let short: f64 = format!("{:.12e}", x / unit.scale).parse().unwrap_or(f64::NAN);
        if (short * unit.scale).to_bits() == x.to_bits() {
            return format!("{short} {name}");
        }
    }
    format!("{x}{}", behind(dimension))
}

/// A text with its marks.
pub(crate) fn quoted(text: &str) -> String {
    let mut out = String::from('"');
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            '\n' => out.push_str("\\n"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{{{:x}}}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
