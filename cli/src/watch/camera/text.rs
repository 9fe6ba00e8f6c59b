//! A camera as a scene file writes it.

use std::fmt::Write;

use luxel_core::diag::Sources;
use luxel_core::registry::Registry;
use luxel_core::scene::{Node, Pose, Value};
use luxel_sdk::params::Look;

use crate::written::{quoted, value};

/// The block of a camera that looks so. Read again in place of the camera's own, it gives the same
/// camera to the last bit; one that moves keeps the `transform` that it has.
pub(super) fn block(
    (node, pose): (&Node, &Pose),
    look: &Look,
    registry: &Registry,
    sources: &Sources,
) -> String {
    let mut out = format!("camera {}", node.class);
    if let Some(label) = &node.label {
        let _ = write!(out, " {}", quoted(label));
    }
    out.push_str(" {\n");
    for argument in &node.params {
        let value = match &argument.value {
            Value::Look(_) => view(look),
            _ => value(argument, node, registry, sources),
        };
        let _ = writeln!(out, "  {} = {value}", argument.name);
    }
    match pose.fixed() {
        None => out.push_str("  // and its `transform`, as it is\n"),
        Some(_) if pose.is_identity() => {}
        Some(pose) => {
            let rows = pose.matrix3.transpose().to_cols_array();
            let t = pose.translation.to_array();
            let row = |i: usize| {
                format!("{}, {}, {}, {}", rows[3 * i], rows[3 * i + 1], rows[3 * i + 2], t[i])
            };
            let rows = [row(0), row(1), row(2)].join(", ");
            let _ = writeln!(out, "  transform = matrix([{rows}, 0, 0, 0, 1])");
        }
    }
    out.push('}');
    out
}

fn view(Look { from, to, up }: &Look) -> String {
    format!("look_at(from = {from} m, to = {to} m, up = {up})")
        .replace("= [", "= (")
        .replace(']', ")")
}
