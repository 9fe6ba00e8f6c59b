//! A scene without what nothing refers to, in the order in which it is met from the world on.

use super::terms::Terms;
use super::{GroupId, Hash, NodeId, Placed, Scene, Target, Value};

/// The number of what was not met.
pub(super) const UNMET: u32 = u32::MAX;

/// Says whether what is made of a scene is not wanted any more; asked every few thousand nodes.
pub type IsOver<'a> = &'a (dyn Fn() -> bool + Sync);

/// Nodes between two looks at that: some three milliseconds' work to hash, which is what takes longest.
pub(super) const STRIDE: usize = 1 << 12;

/// `None` once it is over.
pub(super) fn look(is_over: IsOver<'_>) -> Option<()> {
    (!is_over()).then_some(())
}

impl Scene {
    /// Leaves out nodes and groups that nothing refers to, brings children before those that refer to
    /// them, in the order in which they are met from the world on, and computes every hash anew: until
    /// then nodes may be put among `nodes` as they come.
    ///
    /// Nothing may stand in itself, nor so deep that the recursion has no room. `None`, and a scene of no
    /// use, once it is over.
    pub fn compact(&mut self, is_over: IsOver<'_>) -> Option<()> {
        let Order { nodes, groups, n_nodes, n_groups } = self.order();
        look(is_over)?;
        self.rename(&nodes, &groups);
        look(is_over)?;
        arrange(&mut self.nodes, nodes, n_nodes);
        arrange(&mut self.groups, groups, n_groups);
        self.own.clear();
        self.hash_more(is_over)
    }

    /// In which order what the world and the settings refer to is met.
    pub fn order(&self) -> Order {
        let (nodes, groups) = (vec![UNMET; self.nodes.len()], vec![UNMET; self.groups.len()]);
        let order = Order { nodes, groups, n_nodes: 0, n_groups: 0 };
        let mut walk = Walk { scene: self, order };
        walk.items(&self.root.items);
        let slots = [self.camera, self.film, self.integrator, self.sampler];
        for id in slots.into_iter().chain([self.filter, self.medium]).flatten() {
            walk.node(id);
        }
        walk.order
    }

    /// Computes the hashes of the nodes that were put among `nodes` since it was last called; `None`, and
    /// only some of them, once it is over.
    pub(super) fn hash_more(&mut self, is_over: IsOver<'_>) -> Option<()> {
        let first = self.own.len();
        let mut hashing = HashFrom {
            first,
            is_hashed: vec![false; self.nodes.len() - first],
            terms: Terms::default(),
        };
        self.own.resize(self.nodes.len(), Hash::default());
        for i in first..self.nodes.len() {
            if i.is_multiple_of(STRIDE) {
                look(is_over)?;
            }
            self.hash_from(i, &mut hashing);
        }
        Some(())
    }

    /// Computes a node's hashes after those of what it refers to.
    fn hash_from(&mut self, i: usize, hashing: &mut HashFrom) {
        let first = hashing.first;
        if std::mem::replace(&mut hashing.is_hashed[i - first], true) {
            return;
        }
        let inner = self.nodes[i].children().map(|id| id.0 as usize);
        let inner: Vec<_> =
            inner.filter(|at| *at >= first && !hashing.is_hashed[at - first]).collect();
        for at in inner {
            self.hash_from(at, hashing);
        }
        let hashes = hashing.terms.hashes(&self.nodes[i], |id| self.node(id).hash);
        [self.nodes[i].hash, self.own[i]] = hashes;
    }

    /// Gives what is referred to its new number.
    pub(super) fn rename(&mut self, nodes: &[u32], groups: &[u32]) {
        let node = |id: &mut NodeId| id.0 = nodes[id.0 as usize];
        for (held, _) in self.nodes.iter_mut().zip(nodes).filter(|(_, number)| **number != UNMET) {
            for argument in held.params.to_mut() {
                if let Value::Node(id) | Value::Moved(id, _) = &mut argument.value {
                    node(id);
                }
            }
            held.overrides.iter_mut().for_each(|(_, id)| node(id));
        }
        let kept = self.groups.iter_mut().zip(groups).filter(|(_, number)| **number != UNMET);
        for group in kept.map(|(group, _)| group).chain([&mut self.root]) {
            for item in &mut group.items {
                match &mut item.target {
                    Target::Node(id) => node(id),
                    Target::Group(GroupId(id)) => *id = groups[*id as usize],
                }
                item.material.iter_mut().for_each(node);
            }
        }
        let Self { camera, film, integrator, sampler, filter, medium, .. } = self;
        for slot in [camera, film, integrator, sampler, filter, medium] {
            slot.iter_mut().for_each(node);
        }
    }
}

/// What is being hashed.
struct HashFrom {
    /// Nodes before this one are.
    first: usize,
    is_hashed: Vec<bool>,
    terms: Terms,
}

/// The numbers of nodes and groups in the order in which they are met from the world on, by those that they
/// have: the same for as long as each refers to the same ones.
#[derive(Clone, Debug)]
pub struct Order {
    pub(super) nodes: Vec<u32>,
    pub(super) groups: Vec<u32>,
    pub(super) n_nodes: u32,
    pub(super) n_groups: u32,
}

/// The order of what has been met so far.
struct Walk<'a> {
    scene: &'a Scene,
    order: Order,
}

impl Walk<'_> {
    fn node(&mut self, id: NodeId) {
        if self.order.nodes[id.0 as usize] != UNMET {
            return;
        }
        let node = self.scene.node(id);
        for argument in &node.params {
            if let Value::Node(child) | Value::Moved(child, _) = argument.value {
                self.node(child);
            }
        }
        for (_, material) in &node.overrides {
            self.node(*material);
        }
        self.order.nodes[id.0 as usize] = self.order.n_nodes;
        self.order.n_nodes += 1;
    }

    fn group(&mut self, id: GroupId) {
        if self.order.groups[id.0 as usize] != UNMET {
            return;
        }
        self.items(&self.scene.group(id).items);
        self.order.groups[id.0 as usize] = self.order.n_groups;
        self.order.n_groups += 1;
    }

    fn items(&mut self, items: &[Placed]) {
        for item in items {
            match item.target {
                Target::Node(id) => self.node(id),
                Target::Group(id) => self.group(id),
            }
            item.material.into_iter().for_each(|id| self.node(id));
        }
    }
}

/// Brings each item to its new number, and drops those that have none, without room for a copy.
fn arrange<T>(items: &mut Vec<T>, mut numbers: Vec<u32>, n_kept: u32) {
    let dropped = numbers.iter_mut().filter(|number| **number == UNMET);
    for (number, next) in dropped.zip(n_kept..) {
        *number = next;
    }
    for i in 0..items.len() {
        while numbers[i] as usize != i {
            let to = numbers[i] as usize;
            items.swap(i, to);
            numbers.swap(i, to);
        }
    }
    items.truncate(n_kept as usize);
    items.shrink_to_fit();
}

#[cfg(test)]
pub(super) mod tests {
    use luxel_sdk::kind::Kind;

    use super::*;
    use crate::diag::{SourceId, Span};
    use crate::scene::{Argument, Group, Node, Placed, Pose};

    /// A node that stands at a byte and may refer to another.
    pub(in crate::scene) fn node(at: usize, child: Option<u32>) -> Node {
        let span = Span::new(SourceId(0), at, at + 1);
        let value = |id| Argument { name: "base", value: Value::Node(NodeId(id)), span };
        Node {
            kind: Kind::Shape,
            class: "any",
            label: None,
            params: child.map(value).into_iter().collect(),
            overrides: vec![],
            span,
            hash: [0; 32],
        }
    }

    #[test]
    fn what_is_referred_to_is_kept_in_the_order_in_which_it_is_met() {
        // The last one is met first, with its child; the second one by nobody.
        let nodes = vec![node(0, None), node(1, None), node(2, None), node(3, Some(2))];
        let mut scene = Scene { nodes, ..Scene::default() };
        let placed = |target, at| Placed {
            target,
            pose: Pose::Here,
            material: None,
            span: Span::new(SourceId(0), at, at),
        };
        let group = |target| Group { label: None, items: vec![placed(target, 0)] };
        scene.groups = vec![group(Target::Node(NodeId(1))), group(Target::Node(NodeId(3)))];
        scene.root.items = vec![placed(Target::Group(GroupId(1)), 7)];
        scene.camera = Some(NodeId(0));
        scene.compact(&|| false).unwrap();
        let places: Vec<_> = scene.nodes.iter().map(|node| node.span.start).collect();
        assert_eq!(places, [2, 3, 0]);
        assert_eq!(scene.nodes[1].params[0].value, Value::Node(NodeId(0)));
        assert_eq!(scene.groups.len(), 1);
        assert_eq!(scene.groups[0].items[0].target, Target::Node(NodeId(1)));
        assert_eq!(scene.root.items[0].target, Target::Group(GroupId(0)));
        assert_eq!(scene.camera, Some(NodeId(2)));
        let mut added = Scene::default();
        added.add(node(2, None));
        added.add(node(3, Some(0)));
        assert_eq!(scene.nodes[1].hash, added.nodes[1].hash);
        assert_eq!(scene.own_hash(NodeId(1)), added.own_hash(NodeId(1)));
    }
}
