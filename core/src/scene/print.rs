//! A scene as text: every node and placement, the same text for the same scene.

use std::fmt::Write;

use glam::DAffine3;
use luxel_sdk::params::Dimension;

use super::conform::number_words;
use super::{Group, Node, NodeId, Placed, Pose, Scene, Step, Target, Value};

/// Tables longer than this are shown by their first numbers, their length and a hash.
const SHOWN: usize = 12;

/// The scene as text: nodes with their parameters, groups with what stands in them, the world, and
/// what the scene has once. Numbers are in SI units. Equal scenes give equal texts; the converse
/// holds up to the collision of 64 hash bits of long tables.
pub fn print(scene: &Scene) -> String {
    let mut out = String::new();
    for (i, node) in scene.nodes.iter().enumerate() {
        print_node(&mut out, i, node);
    }
    for (i, group) in scene.groups.iter().enumerate() {
        let _ = write!(out, "group g{i}");
        print_group(&mut out, group);
    }
    out.push_str("world");
    print_group(&mut out, &scene.root);
    let slots: [(&str, Option<NodeId>); 6] = [
        ("camera", scene.camera),
        ("film", scene.film),
        ("integrator", scene.integrator),
        ("sampler", scene.sampler),
        ("filter", scene.filter),
        ("medium", scene.medium),
    ];
    for (name, id) in slots {
        if let Some(id) = id {
            let _ = write!(out, "{name} = n{}", id.0);
            if name == "camera" {
                print_pose(&mut out, &scene.camera_pose);
            }
            out.push('\n');
        }
    }
    for expectation in &scene.expectations {
        let _ = writeln!(out, "expect {expectation}");
    }
    out
}

fn print_node(out: &mut String, index: usize, node: &Node) {
    let _ = write!(out, "n{index} = {} {}", node.kind, node.class);
    if let Some(label) = &node.label {
        let _ = write!(out, " {label:?}");
    }
    let mut params: Vec<_> = node.params.iter().collect();
    params.sort_by_key(|argument| argument.name);
    out.push_str(" {");
    for argument in params {
        let _ = write!(out, "\n  {} = ", argument.name);
        print_value(out, &argument.value);
    }
    for (name, material) in &node.overrides {
        let _ = write!(out, "\n  material {name} = n{}", material.0);
    }
    let empty = node.params.is_empty() && node.overrides.is_empty();
    out.push_str(if empty { "}\n" } else { "\n}\n" });
}

fn print_group(out: &mut String, group: &Group) {
    if let Some(label) = &group.label {
        let _ = write!(out, " {label:?}");
    }
    out.push_str(" {\n");
    for item in &group.items {
        print_placed(out, item);
    }
    out.push_str("}\n");
}

fn print_placed(out: &mut String, item: &Placed) {
    let _ = match item.target {
        Target::Node(id) => write!(out, "  n{}", id.0),
        Target::Group(id) => write!(out, "  g{}", id.0),
    };
    print_pose(out, &item.pose);
    if let Some(material) = item.material {
        let _ = write!(out, " material n{}", material.0);
    }
    out.push('\n');
}

fn print_pose(out: &mut String, pose: &Pose) {
    for step in pose.steps() {
        match step {
            Step::Fixed(transform) => print_transform(out, &transform),
            Step::Keys(keys) => {
                for key in keys.iter() {
                    let _ = write!(out, " when {} s", key.time);
                    print_matrix(out, &key.transform);
                }
            }
            Step::Spin { axis, rate } => {
                let _ = write!(out, " spin about {axis} by {rate} rad/s");
            }
        }
    }
}

fn print_transform(out: &mut String, transform: &DAffine3) {
    if *transform != DAffine3::IDENTITY {
        print_matrix(out, transform);
    }
}

fn print_matrix(out: &mut String, transform: &DAffine3) {
    let rows = transform.matrix3.transpose().to_cols_array();
    let t = transform.translation;
    out.push_str(" at [");
    for row in 0..3 {
        let r = &rows[3 * row..3 * row + 3];
        let end = if row == 2 { "]" } else { "; " };
        let _ = write!(out, "{} {} {} {}{end}", r[0], r[1], r[2], t[row]);
    }
}

fn print_value(out: &mut String, value: &Value) {
    let unit = |dimension: &Dimension| match *dimension {
        Dimension::NONE => String::new(),
        dimension => format!(" {dimension}"),
    };
    let _ = match value {
        Value::Bool(value) => write!(out, "{value}"),
        Value::Number(x, dimension) => write!(out, "{x}{}", unit(dimension)),
        Value::Vector(v) => write!(out, "{v:?}"),
        Value::Text(text) => write!(out, "{text:?}"),
        Value::Path(path) => write!(out, "file {:?}", path.to_string_lossy()),
        Value::Bytes(name, bytes) => {
            write!(out, "{} bytes of {name:?}, hash {}", bytes.len(), short_hash(bytes))
        }
        Value::Table(table) => {
            print_table(out, table);
            Ok(())
        }
        Value::Color(color, dimension) => write!(out, "{color:?}{}", unit(dimension)),
        Value::Look(look) => {
            write!(out, "look_at(from = {}, to = {}, up = {})", look.from, look.to, look.up)
        }
        Value::Node(id) => write!(out, "n{}", id.0),
        Value::Moved(id, transform) => {
            let _ = write!(out, "n{}", id.0);
            print_transform(out, transform);
            Ok(())
        }
    };
}

/// What a line tells of a value, in SI units; `None` of what it does not tell whole.
pub(super) fn in_line(value: &Value) -> Option<String> {
    match value {
        Value::Bool(value) => Some(value.to_string()),
        Value::Number(x, Dimension::NONE) => Some(number_words(*x)),
        Value::Number(x, dimension) => Some(format!("{} {dimension}", number_words(*x))),
        Value::Vector(v) => {
            let all: Vec<_> = v.iter().map(|x| number_words(*x)).collect();
            Some(format!("({})", all.join(", ")))
        }
        Value::Text(text) => Some(format!("{text:?}")),
        Value::Path(path) => Some(format!("{:?}", path.to_string_lossy())),
        _ => None,
    }
}

fn print_table(out: &mut String, table: &[f64]) {
    if table.len() <= SHOWN {
        let _ = write!(out, "{table:?}");
        return;
    }
    let mut bytes = Vec::with_capacity(8 * table.len());
    for x in table {
        bytes.extend(x.to_bits().to_le_bytes());
    }
    let first = &table[..SHOWN / 2];
    let _ = write!(out, "{} numbers {first:?}…, hash {}", table.len(), short_hash(&bytes));
}

fn short_hash(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex()[..16].to_owned()
}
