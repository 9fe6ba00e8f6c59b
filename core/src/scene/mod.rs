//! The scene graph: plain data that prints, hashes and compares.
//!
//! Evaluating a scene file gives nodes (a class with its parameters) and groups (nodes and groups in
//! their places). Groups that are placed several times are shared, not copied. Nothing here traces,
//! reads files or knows a plugin by name.

mod arguments;
mod changed;
mod color;
mod compact;
mod conform;
mod diff;
mod expect;
mod feature;
mod gather;
mod hash;
mod parts;
mod pose;
mod print;
mod setting;
mod terms;
mod value;
mod world;

use std::collections::BTreeSet;
use std::sync::Arc;

use luxel_sdk::kind::Kind;

use self::terms::{Sum, Terms};
use crate::diag::Span;

pub use arguments::Arguments;
pub use changed::{Changed, NewValues};
pub use color::Color;
pub use compact::{IsOver, Order};
pub use conform::{
    DefaultUnits, Given, Misfit, bare_help, conform, describe, number_words, range_words, said,
    said_unit, wanted,
};
pub use diff::{Change, Difference, How, Known, called, diff, diff_in};
pub use expect::{Area, Claim, Expectation, Expected};
pub use feature::Feature;
pub use hash::Hash;
pub use pose::{Key, Pose, Step};
pub use print::print;
pub use setting::Setting;
pub use value::Value;

/// Most placements that a scene may come to, if nobody allows more: each takes half a kilobyte.
pub const MOST_INSTANCES: usize = 2_000_000;

/// Parameters of a film that no sample depends on.
const SHOWN: [&str; 3] = ["exposure", "display", "file"];

/// Why a feature is not both required and dropped.
const BOTH: &str = "it is both required and dropped";

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
    pub class: &'static str,
    /// Its name, for people; does not count for its hash.
    pub label: Option<Arc<str>>,
    /// The parameters that were given, by name. Each fits its schema.
    pub params: Arguments,
    /// For assets: materials that take the place of the file's own, by their name in the file
    /// (characters that no identifier has are `_`).
    pub overrides: Vec<(Arc<str>, NodeId)>,
    /// Where it is written.
    pub span: Span,
    /// Hash of kind, class and parameters, children by their hash: a sum, of one hash for each.
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

    /// The nodes that it refers to.
    pub fn children(&self) -> impl Iterator<Item = NodeId> + '_ {
        let params = self.params.iter().filter_map(|argument| match argument.value {
            Value::Node(id) | Value::Moved(id, _) => Some(id),
            _ => None,
        });
        params.chain(self.overrides.iter().map(|(_, id)| *id))
    }
}

/// What stands in a place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
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
    pub pose: Pose,
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

/// Hashes of a whole scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Hashes {
    /// Of everything that it shows: `Scene::hash`.
    pub shown: Hash,
    /// Equal where the measurement is: `Scene::measured_hash`.
    pub measured: Hash,
    /// The same without the number of samples: equal where one is measured by the first samples of the
    /// other, if its sampler gives the same ones.
    pub sampled: Hash,
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
    /// From the frame that the camera's parameters speak of to the world.
    pub camera_pose: Pose,
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
    /// What its file says of its picture. Nothing that is measured depends on it, nor any hash.
    pub expectations: Vec<Expectation>,
    /// Modelled though the scene may not require it. No bit of a picture depends on it, nor any hash.
    required: BTreeSet<Feature>,
    /// Left out though the scene may require it.
    dropped: BTreeSet<Feature>,
    /// Most placements that it may come to, if not as many as usual.
    most_instances: Option<usize>,
    /// Of each node the hash without what every node of its kind may have.
    own: Vec<Hash>,
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

    /// Lets it come to so many placements, where memory is no matter. Changes no bit of a picture.
    pub fn allow_instances(&mut self, most: usize) {
        self.most_instances = Some(most);
    }

    /// Most placements that it may come to.
    pub fn most_instances(&self) -> usize {
        self.most_instances.unwrap_or(MOST_INSTANCES)
    }

    /// Has a feature modelled, whether the scene requires it or not. Changes no bit of a picture.
    ///
    /// # Errors
    /// Why that cannot be.
    pub fn require(&mut self, feature: Feature) -> Result<(), &'static str> {
        if self.dropped.contains(&feature) {
            return Err(BOTH);
        }
        if let Some(why) = feature.unrequirable() {
            return Err(why);
        }
        self.required.insert(feature);
        Ok(())
    }

    /// Leaves a feature out, whether the scene requires it or not: less is modelled.
    ///
    /// # Errors
    /// Why that cannot be.
    pub fn leave_out(&mut self, feature: Feature) -> Result<(), &'static str> {
        if self.required.contains(&feature) {
            return Err(BOTH);
        }
        feature.dropped()?;
        self.dropped.insert(feature);
        Ok(())
    }

    /// Whether a feature is to be modelled even if the scene does not require it.
    pub fn is_required(&self, feature: Feature) -> bool {
        self.required.contains(&feature)
    }

    /// What is left out even if the scene requires it, in the order of `Feature::ALL`.
    pub fn left_out(&self) -> impl Iterator<Item = Feature> + '_ {
        self.dropped.iter().copied()
    }

    /// Whether a feature is left out even if the scene requires it.
    pub fn leaves_out(&self, feature: Feature) -> bool {
        self.dropped.contains(&feature)
    }

    /// Hash of everything that the scene shows: what stands where, and its settings. Labels, places
    /// in files and nodes that nothing uses do not count; nor do the contents of files by path.
    pub fn hash(&self) -> Hash {
        self.hashes().shown
    }

    /// The same without what decides only how a picture is shown and where it goes: equal where the
    /// measurement is.
    pub fn measured_hash(&self) -> Hash {
        self.hashes().measured
    }

    /// Hashes of the scene: what stands in it, which takes nearly all of the time, is hashed once.
    pub fn hashes(&self) -> Hashes {
        let content = hash::hash_content(self);
        let film = |left_out| self.without(self.film, left_out);
        let sampler = |left_out| self.without(self.sampler, left_out);
        let hash = |film, sampler| hash::hash_scene(self, &content, film, sampler);
        Hashes {
            shown: hash(film(&[]), sampler(&[])),
            measured: hash(film(&SHOWN), sampler(&[])),
            sampled: hash(film(&SHOWN), sampler(&["samples"])),
        }
    }

    /// The hash of a setting without some of its parameters.
    fn without(&self, setting: Option<NodeId>, names: &[&str]) -> Option<Hash> {
        let node = self.node(setting?);
        let those = terms::of_params(node, names, |id| self.node(id).hash);
        Some(Sum::of(&node.hash).minus(those).hash())
    }

    /// Hash of a node without the parameters that the host adds to its kind: equal where the object
    /// itself is equal, whatever its surface or what fills it.
    pub fn own_hash(&self, id: NodeId) -> Hash {
        self.own[id.0 as usize]
    }

    /// Adds a node whose children are already here; its hash is computed.
    ///
    /// # Panics
    /// From 2³² nodes on: the budget is far below.
    pub fn add(&mut self, mut node: Node) -> NodeId {
        let [hash, own] = Terms::default().hashes(&node, |id| self.node(id).hash);
        node.hash = hash;
        self.add_hashed(node, own)
    }

    /// The same of a node whose hashes are known.
    pub(crate) fn add_hashed(&mut self, node: Node, own: Hash) -> NodeId {
        self.nodes.push(node);
        self.own.push(own);
        NodeId(u32::try_from(self.nodes.len() - 1).expect("the node budget is far below 2^32"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::SourceId;

    fn camera(label: &str, focal: f64) -> Scene {
        let mut scene = Scene::default();
        let span = Span::new(SourceId(0), 0, 0);
        let value = Value::Number(focal, luxel_sdk::params::Dimension::LENGTH);
        let id = scene.add(Node {
            kind: Kind::Camera,
            class: "perspective",
            label: Some(label.into()),
            params: vec![Argument { name: "focal_length", value, span }].into(),
            overrides: vec![],
            span,
            hash: [0; 32],
        });
        scene.camera = Some(id);
        scene
    }

    #[test]
    fn the_scenes_hash_ignores_labels_and_sees_values_and_places() {
        let scene = camera("a", 0.05);
        assert_eq!(scene.hash(), camera("b", 0.05).hash());
        assert_ne!(scene.hash(), camera("a", 0.06).hash());
        let placed = |x: f64| {
            let mut scene = camera("a", 0.05);
            let target = Target::Node(NodeId(0));
            let pose = glam::DAffine3::from_translation(glam::DVec3::X * x).into();
            let span = Span::new(SourceId(0), 0, 0);
            scene.root.items.push(Placed { target, pose, material: None, span });
            scene.hash()
        };
        assert_ne!(placed(0.0), scene.hash());
        assert_ne!(placed(0.0), placed(1.0));
    }

    #[test]
    fn how_a_picture_is_shown_does_not_count_for_what_is_measured() {
        let with = |name, value: Value| {
            let mut scene = camera("a", 0.05);
            scene.set_resolution(glam::UVec2::new(3, 4));
            scene.set_param(Setting::Film, name, value);
            (scene.hash(), scene.measured_hash())
        };
        let plain = with("resolution", Value::vector([3.0, 4.0]));
        for name in SHOWN {
            let shown = with(name, Value::Text("x".into()));
            assert!(shown.0 != plain.0 && shown.1 == plain.1, "{name}");
        }
        let time = with("shutter", Value::Text("x".into()));
        assert!(time.0 != plain.0 && time.1 != plain.1);
    }

    #[test]
    fn what_is_dropped_counts_for_the_hash_and_what_is_required_does_not() {
        let mut scene = camera("a", 0.05);
        let plain = [scene.hash(), scene.measured_hash(), scene.hashes().sampled];
        scene.require(Feature::Media).unwrap();
        assert_eq!([scene.hash(), scene.measured_hash(), scene.hashes().sampled], plain);
        scene.leave_out(Feature::Motion).unwrap();
        assert_ne!(scene.hash(), plain[0]);
        assert_ne!(scene.measured_hash(), plain[1]);
        assert_ne!(scene.hashes().sampled, plain[2]);
        let mut other = camera("a", 0.05);
        other.leave_out(Feature::Nested).unwrap();
        assert_ne!(scene.hash(), other.hash());
    }

    #[test]
    fn what_cannot_be_required_or_dropped_is_refused() {
        let mut scene = camera("a", 0.05);
        assert!(scene.require(Feature::Spectral).unwrap_err().contains("film spectral"));
        assert!(scene.require(Feature::Layers).unwrap_err().contains("--aov"));
        assert!(scene.leave_out(Feature::OpenSurfaces).unwrap_err().contains("drop `media`"));
        assert!(scene.leave_out(Feature::LightChoice).unwrap_err().contains("missing"));
        scene.require(Feature::Media).unwrap();
        assert_eq!(scene.leave_out(Feature::Media), Err(BOTH));
        scene.leave_out(Feature::Motion).unwrap();
        assert_eq!(scene.require(Feature::Motion), Err(BOTH));
        assert!(scene.left_out().eq([Feature::Motion]));
    }
}
