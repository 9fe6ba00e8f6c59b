//! The scene graph: plain data that prints, hashes and compares.
//!
//! Evaluating a scene file gives nodes (a class with its parameters) and groups (nodes and groups in
//! their places). Groups that are placed several times are shared, not copied. Nothing here traces,
//! reads files or knows a plugin by name.

mod color;
mod conform;
mod print;
mod value;

use std::sync::Arc;

use glam::DAffine3;
use luxel_sdk::kind::Kind;

use crate::diag::Span;

pub use color::Color;
pub use conform::{DefaultUnits, Given, Misfit, conform, describe, wanted};
pub use print::print;
pub use value::{Hash, Value};

/// Names a node among `Scene::nodes`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(pub u32);

/// Names a group among `Scene::groups`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GroupId(pub u32);

/// An object of the scene: a class with its parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// What it is.
    pub kind: Kind,
    /// Which class; it exists in the registry that the scene was evaluated against.
    pub class: Arc<str>,
    /// Its name, for people; does not count for its hash.
    pub label: Option<Arc<str>>,
    /// The parameters that were given, by name. Each fits its schema.
    pub params: Vec<Argument>,
    /// For assets: materials that take the place of the file's own, by their name in the file
    /// (characters that no identifier has are `_`).
    pub overrides: Vec<(Arc<str>, NodeId)>,
    /// Where it is written.
    pub span: Span,
    /// Hash of kind, class and parameters, children by their hash.
    pub hash: Hash,
}

/// A parameter that was given.
#[derive(Clone, Debug, PartialEq)]
pub struct Argument {
    /// Its name in the schema.
    pub name: &'static str,
    /// Its value.
    pub value: Value,
    /// Where the value is written.
    pub span: Span,
}

impl Node {
    /// The value of a parameter, if it was given.
    pub fn get(&self, name: &str) -> Option<&Argument> {
        self.params.iter().find(|argument| argument.name == name)
    }
}

/// What stands in a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Target {
    /// A shape, a light or an asset.
    Node(NodeId),
    /// A group.
    Group(GroupId),
}

/// Something in its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// What.
    pub target: Target,
    /// From its frame to that of the group it stands in.
    pub transform: DAffine3,
    /// The material of shapes that have none of their own.
    pub material: Option<NodeId>,
    /// Where the placement is written.
    pub span: Span,
}

/// Things in their places, in a frame of their own.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Group {
    /// Its name, for people.
    pub label: Option<Arc<str>>,
    /// What stands in it.
    pub items: Vec<Placed>,
}

/// A whole scene.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Scene {
    /// Every node; children stand before those that refer to them.
    pub nodes: Vec<Node>,
    /// Every group; inner ones stand before those that hold them.
    pub groups: Vec<Group>,
    /// The group that is the world.
    pub root: Group,
    /// The camera. `None` only if an asset may bring one.
    pub camera: Option<NodeId>,
    /// The film, if given.
    pub film: Option<NodeId>,
    /// The integrator, if given.
    pub integrator: Option<NodeId>,
    /// The sampler, if given.
    pub sampler: Option<NodeId>,
    /// The pixel filter, if given.
    pub filter: Option<NodeId>,
    /// What fills the space that no shape encloses.
    pub medium: Option<NodeId>,
}

impl Scene {
    /// The node of that name. Names come from this scene.
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.0 as usize]
    }

    /// The group of that name. Names come from this scene.
    pub fn group(&self, id: GroupId) -> &Group {
        &self.groups[id.0 as usize]
    }

    /// Adds a node whose children are already here; its hash is computed.
    pub fn add(&mut self, mut node: Node) -> NodeId {
        node.hash = value::hash_node(&node, |id| self.node(id).hash);
        self.nodes.push(node);
        NodeId(u32::try_from(self.nodes.len() - 1).expect("the node budget is far below 2^32"))
    }
}
