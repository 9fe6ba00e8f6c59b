//! The end of a load: what the scene lacks, and the nodes that nothing refers to left out.

use luxel_core::diag::Diagnostic;
use luxel_core::scene::{Group, GroupId, Node, NodeId, Scene, Target, Value};
use luxel_sdk::kind::Kind;

use super::Evaluator;
use crate::Loaded;

impl Evaluator<'_> {
    /// The scene, if there is no error, with everything that was found.
    pub(super) fn finish(mut self) -> Loaded {
        let incomplete = self.damaged || self.stopped || self.sink.errors() > 0;
        if !self.has_asset && !self.slots.contains_key(&Kind::Camera) && !incomplete {
            let known: Vec<_> = self.registry.of_kind(Kind::Camera).map(|e| e.class.name).collect();
            self.tell(
                Diagnostic::unplaced("E0409", "the scene has no camera")
                    .help(format!("known are {}", known.join(", "))),
            );
        }
        self.expectations_fit();
        let errors = self.sink.errors();
        let scene = (errors == 0 && !self.damaged).then(|| {
            self.scene.root = self.open_groups.pop().unwrap_or_default().group;
            compact(&self.scene)
        });
        let mut diagnostics = self.sink.finish();
        if scene.is_none() && errors == 0 {
            let message = "the scene could not be evaluated";
            diagnostics.push(Diagnostic::unplaced("E0023", message));
        }
        let values = self.values.unwrap_or_default();
        Loaded { scene, diagnostics, sources: self.sources, params: self.params, values }
    }
}

/// The nodes that a node refers to.
pub(super) fn children(node: &Node) -> impl Iterator<Item = NodeId> {
    let params = node.params.iter().filter_map(|argument| match argument.value {
        Value::Node(id) | Value::Moved(id, _) => Some(id),
        _ => None,
    });
    params.chain(node.overrides.iter().map(|(_, id)| *id))
}

/// The same scene without nodes and groups that nothing refers to; children stand before those that
/// refer to them, in the order in which they are met from the world on.
///
/// Objects and groups nest no deeper than the budget allows, so that the recursion is bounded.
fn compact(old: &Scene) -> Scene {
    let mut compactor = Compactor {
        nodes: vec![None; old.nodes.len()],
        groups: vec![None; old.groups.len()],
        old,
        new: Scene::default(),
    };
    let root = compactor.items(&old.root);
    let slots = [old.camera, old.film, old.integrator, old.sampler, old.filter, old.medium];
    let slots = slots.map(|slot| slot.map(|id| compactor.node(id)));
    let mut new = compactor.new;
    [new.camera, new.film, new.integrator, new.sampler, new.filter, new.medium] = slots;
    new.camera_pose = old.camera_pose.clone();
    new.expectations.clone_from(&old.expectations);
    new.root = root;
    new
}

struct Compactor<'a> {
    old: &'a Scene,
    new: Scene,
    nodes: Vec<Option<NodeId>>,
    groups: Vec<Option<GroupId>>,
}

impl Compactor<'_> {
    fn node(&mut self, id: NodeId) -> NodeId {
        if let Some(done) = self.nodes[id.0 as usize] {
            return done;
        }
        let mut node = self.old.node(id).clone();
        for argument in &mut node.params {
            if let Value::Node(child) | Value::Moved(child, _) = &mut argument.value {
                *child = self.node(*child);
            }
        }
        for (_, material) in &mut node.overrides {
            *material = self.node(*material);
        }
        let new = self.new.add(node);
        self.nodes[id.0 as usize] = Some(new);
        new
    }

    fn group(&mut self, id: GroupId) -> GroupId {
        if let Some(done) = self.groups[id.0 as usize] {
            return done;
        }
        let old = self.old;
        let group = self.items(old.group(id));
        let count = self.new.groups.len();
        let new = GroupId(u32::try_from(count).expect("the node budget is far below 2^32"));
        self.new.groups.push(group);
        self.groups[id.0 as usize] = Some(new);
        new
    }

    fn items(&mut self, group: &Group) -> Group {
        let mut items = Vec::with_capacity(group.items.len());
        for item in &group.items {
            let mut item = item.clone();
            item.target = match item.target {
                Target::Node(id) => Target::Node(self.node(id)),
                Target::Group(id) => Target::Group(self.group(id)),
            };
            item.material = item.material.map(|id| self.node(id));
            items.push(item);
        }
        Group { label: group.label.clone(), items }
    }
}
