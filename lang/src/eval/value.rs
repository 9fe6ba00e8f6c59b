//! What expressions give.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::Arc;

use glam::DAffine3;
use luxel_core::diag::Span;
use luxel_core::scene::{Argument, Color, GroupId, Node, NodeId, Pose};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Dimension, Look};

use super::OF_KINDS;
use super::builtins::Builtin;
use super::env::{Env, File};
use crate::syntax::{FnDef, Form, Name};

/// A value. Large ones are shared.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    /// What a mistake leaves; it was told, and whatever uses it says nothing more.
    Poison,
    Bool(bool),
    /// In SI units.
    Number(f64, Dimension),
    Text(Arc<str>),
    /// A vector or list of numbers of one dimension.
    Numbers(Rc<Numbers>),
    /// Any other vector or list.
    Items(Rc<Mixed>),
    Record(Rc<Record>),
    Range(Range),
    Color(Color, Dimension),
    Transform(Rc<Pose>),
    Look(Rc<Look>),
    Object(Rc<ObjectValue>),
    Module(Rc<Module>),
    Function(Rc<Function>),
    Builtin(&'static Builtin),
}

/// Numbers of one dimension, in SI units.
#[derive(Clone, Debug)]
pub(crate) struct Numbers {
    pub(crate) data: Arc<[f64]>,
    pub(crate) dimension: Dimension,
    pub(crate) form: Form,
}

/// Values of any kind.
#[derive(Clone, Debug)]
pub(crate) struct Mixed {
    pub(crate) items: Vec<Value>,
    pub(crate) form: Form,
    /// How deep others stand in it.
    depth: usize,
}

/// Values with names.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    pub(crate) fields: Vec<FieldValue>,
    /// How deep others stand in it.
    depth: usize,
}

/// `start..end` or `start..=end`, in SI units.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Range {
    pub(crate) start: f64,
    pub(crate) end: f64,
    pub(crate) inclusive: bool,
    pub(crate) dimension: Dimension,
}

impl Range {
    /// Whether a value lies in it.
    pub(crate) fn contains(&self, x: f64) -> bool {
        self.start <= x && if self.inclusive { x <= self.end } else { x < self.end }
    }
}

/// `name = value` with its places and the file that says it.
#[derive(Clone, Debug)]
pub(crate) struct FieldValue {
    pub(crate) name: Name,
    pub(crate) value: Value,
    pub(crate) span: Span,
    pub(crate) file: Rc<File>,
}

/// What an object is in the scene.
#[derive(Clone, Debug)]
pub(crate) enum What {
    Node(NodeId, Kind),
    /// A group and the material of shapes in it that have none.
    Group(GroupId, Option<NodeId>),
}

/// An object: a node or group of the scene, with what was said of it, so that it can be changed.
#[derive(Clone, Debug)]
pub(crate) struct ObjectValue {
    pub(crate) what: What,
    pub(crate) fields: Vec<FieldValue>,
    pub(crate) pose: Pose,
    pub(crate) head: Head,
    /// How deep other objects stand in it.
    pub(crate) depth: usize,
    /// How many placements it stands for.
    pub(crate) instances: u64,
    /// What it holds, counted until it is dropped.
    #[expect(dead_code, reason = "it counts as long as it is there")]
    pub(crate) held: Held,
}

/// Bytes of an object, which count for as long as it lives.
#[derive(Debug)]
pub(crate) struct Held {
    bytes: usize,
    all: Rc<Cell<usize>>,
}

impl Held {
    /// Those of an object with so many fields and of its node, added to those of `all`.
    pub(crate) fn of(n_fields: usize, all: &Rc<Cell<usize>>) -> Self {
        let of_field = size_of::<FieldValue>() + size_of::<Argument>();
        // A transform is a piece of memory beside an object, of which any may have one.
        let of_one = size_of::<ObjectValue>() + size_of::<DAffine3>() + size_of::<Node>();
        let bytes = of_one + n_fields * of_field;
        Self { bytes, all: all.clone() }.counted()
    }

    fn counted(self) -> Self {
        self.all.set(self.all.get().saturating_add(self.bytes));
        self
    }
}

impl Clone for Held {
    fn clone(&self) -> Self {
        Self { bytes: self.bytes, all: self.all.clone() }.counted()
    }
}

impl Drop for Held {
    fn drop(&mut self) {
        self.all.set(self.all.get().saturating_sub(self.bytes));
    }
}

impl ObjectValue {
    /// Its kind's word, or `group`.
    pub(crate) fn word(&self) -> &'static str {
        match self.what {
            What::Node(_, kind) => kind.word(),
            What::Group(..) => "group",
        }
    }
}

/// The head of an object: `category kind "label"`.
#[derive(Clone, Debug)]
pub(crate) struct Head {
    pub(crate) kind: Option<Kind>,
    /// The class's name and where it is written; of a group, the word `group`.
    pub(crate) class: Name,
    pub(crate) label: Option<Name>,
    pub(crate) span: Span,
}

/// The names of an imported file.
#[derive(Debug)]
pub(crate) struct Module {
    pub(crate) names: BTreeMap<Arc<str>, Value>,
    pub(crate) path: String,
}

/// A function of a scene file with the names that it sees.
#[derive(Debug)]
pub(crate) struct Function {
    pub(crate) def: Arc<FnDef>,
    pub(crate) env: Env,
}

/// Characters of a text that are shown, at most.
const LONGEST: usize = 100;

impl Value {
    /// A plain number.
    pub(crate) fn plain(x: f64) -> Self {
        Self::Number(x, Dimension::NONE)
    }

    /// Values between brackets; numbers of one dimension are packed.
    pub(crate) fn list(items: Vec<Self>, form: Form) -> Self {
        let dimension = match items.first() {
            Some(Self::Number(_, dimension)) => *dimension,
            _ => return Self::mixed(items, form),
        };
        let packed: Option<Vec<f64>> = items
            .iter()
            .map(|item| match item {
                Self::Number(x, d) if *d == dimension => Some(*x),
                _ => None,
            })
            .collect();
        match packed {
            Some(data) => Self::numbers(data, dimension, form),
            None => Self::mixed(items, form),
        }
    }

    fn mixed(items: Vec<Self>, form: Form) -> Self {
        let depth = 1 + items.iter().map(Self::depth).max().unwrap_or_default();
        Self::Items(Rc::new(Mixed { items, form, depth }))
    }

    /// Values with names.
    pub(crate) fn record(fields: Vec<FieldValue>) -> Self {
        let depth = 1 + fields.iter().map(|field| field.value.depth()).max().unwrap_or_default();
        Self::Record(Rc::new(Record { fields, depth }))
    }

    /// How deep lists and records stand in it.
    pub(crate) fn depth(&self) -> usize {
        match self {
            Self::Items(items) => items.depth,
            Self::Record(record) => record.depth,
            _ => 0,
        }
    }

    /// Numbers of one dimension.
    pub(crate) fn numbers(data: impl Into<Arc<[f64]>>, dimension: Dimension, form: Form) -> Self {
        Self::Numbers(Rc::new(Numbers { data: data.into(), dimension, form }))
    }

    /// About how many bytes it takes, the smaller part of what it shares left out.
    pub(crate) fn bytes(&self) -> usize {
        let inside = match self {
            Self::Numbers(n) => 64 + n.data.len() * size_of::<f64>(),
            Self::Items(i) => 64 + i.items.len() * size_of::<Self>(),
            Self::Record(record) => 64 + record.fields.len() * size_of::<FieldValue>(),
            Self::Transform(_) | Self::Look(_) => 256,
            _ => 0,
        };
        size_of::<Self>() + inside
    }

    /// Whether a mistake left it.
    pub(crate) fn is_poison(&self) -> bool {
        matches!(self, Self::Poison)
    }

    /// What it is, in words, for messages.
    pub(crate) fn describe(&self) -> String {
        match self {
            Self::Poison => "a mistake".to_owned(),
            Self::Bool(value) => format!("`{value}`"),
            Self::Number(_, dimension) => dimension.name(),
            Self::Text(_) => "text".to_owned(),
            Self::Numbers(n) if n.form == Form::Tuple => {
                format!("a vector of {} numbers", n.data.len())
            }
            Self::Numbers(n) => format!("a list of {} numbers", n.data.len()),
            Self::Items(i) if i.form == Form::Tuple => {
                let are_numbers = i.items.iter().all(|item| matches!(item, Self::Number(..)));
                let kinds = if are_numbers { format!(" {OF_KINDS}") } else { String::new() };
                format!("a vector of {}{kinds}", i.items.len())
            }
            Self::Items(i) => format!("a list of {}", i.items.len()),
            Self::Record(_) => "a record".to_owned(),
            Self::Range(_) => "a range".to_owned(),
            Self::Color(..) => "a colour".to_owned(),
            Self::Transform(_) => "a transform".to_owned(),
            Self::Look(_) => "a view".to_owned(),
            Self::Object(object) => format!("a {}", object.word()),
            Self::Module(_) => "an imported file".to_owned(),
            Self::Function(_) | Self::Builtin(_) => "a function".to_owned(),
        }
    }

    /// The value as a person would write it, shortened.
    pub(crate) fn show(&self) -> String {
        match self {
            Self::Number(x, dimension) => show_number(*x, *dimension),
            Self::Text(text) => match text.char_indices().nth(LONGEST) {
                Some((end, _)) => format!("{:?}…", &text[..end]),
                None => format!("{text:?}"),
            },
            Self::Numbers(n) if n.data.len() <= 4 => {
                let parts: Vec<String> = n.data.iter().map(ToString::to_string).collect();
                let unit = unit_text(n.dimension);
                format!("({}){unit}", parts.join(", "))
            }
            other => other.describe().replace('`', ""),
        }
    }
}

fn unit_text(dimension: Dimension) -> String {
    if dimension.is_none() { String::new() } else { format!(" {dimension}") }
}

/// A number in SI units with their names.
pub(crate) fn show_number(x: f64, dimension: Dimension) -> String {
    format!("{x}{}", unit_text(dimension))
}
