//! A scene whose nodes are known for the most part: what is new is taken over, and the whole is copied in
//! the order in which it is met from the world on.

use std::sync::Arc;

use luxel_sdk::params::leave;

use super::compact::{IsOver, Order, UNMET, look};
use super::parts::in_parts;
use super::{
    Argument, Arguments, Expectation, Group, GroupId, Node, NodeId, Placed, Scene, Target, Value,
};
use crate::diag::Span;

impl Scene {
    /// The scene that `compact` would make of this one, whose nodes are hashed and in this order, with every
    /// place in a file as `place` has it; `None` once it is over.
    pub fn gathered(
        &self,
        order: &Order,
        place: &(impl Fn(Span) -> Span + Sync),
        is_over: IsOver<'_>,
    ) -> Option<Self> {
        look(is_over)?;
        let nodes = met(&order.nodes, order.n_nodes);
        let groups = met(&order.groups, order.n_groups);
        let put = Put { nodes: &order.nodes, groups: &order.groups, place };
        let slot = |id: Option<NodeId>| id.map(|id| put.id(id));
        let expected = |said: &Expectation| Expectation { span: place(said.span), ..said.clone() };
        let of_nodes = |part: &[u32], out: &mut Vec<Node>| {
            put.nodes(part.iter().map(|old| self.node(NodeId(*old))), out);
        };
        let root = put.large_group(&self.root, is_over)?;
        Some(Self {
            nodes: in_parts(&nodes, is_over, &of_nodes)?,
            groups: groups.iter().map(|old| put.group(self.group(GroupId(*old)))).collect(),
            root,
            camera: slot(self.camera),
            camera_pose: self.camera_pose.clone(),
            film: slot(self.film),
            integrator: slot(self.integrator),
            sampler: slot(self.sampler),
            filter: slot(self.filter),
            medium: slot(self.medium),
            expectations: self.expectations.iter().map(expected).collect(),
            required: self.required.clone(),
            dropped: self.dropped.clone(),
            most_instances: self.most_instances,
            own: nodes.iter().map(|old| self.own[*old as usize]).collect(),
        })
    }

    /// The same scene once more; `None` once it is over.
    pub fn copied(&self, is_over: IsOver<'_>) -> Option<Self> {
        let items = in_parts(&self.root.items, is_over, &add)?;
        Some(Self {
            nodes: in_parts(&self.nodes, is_over, &add)?,
            groups: in_parts(&self.groups, is_over, &add)?,
            root: Group { label: self.root.label.clone(), items },
            own: in_parts(&self.own, is_over, &add)?,
            camera_pose: self.camera_pose.clone(),
            expectations: self.expectations.clone(),
            required: self.required.clone(),
            dropped: self.dropped.clone(),
            ..*self
        })
    }

    /// Makes a scene as it was evaluated one of which copies are gathered: changes every place in a file,
    /// and hashes the nodes. `None`, and a scene of no use, once it is over.
    pub fn prepare(
        &mut self,
        place: &(impl Fn(Span) -> Span + Sync),
        is_over: IsOver<'_>,
    ) -> Option<()> {
        let numbers = |n: usize| (0..).take(n).collect::<Vec<u32>>();
        let (same, groups) = (numbers(self.nodes.len()), numbers(self.groups.len()));
        let put = Put { nodes: &same, groups: &groups, place };
        let of_nodes = |part: &[Node], out: &mut Vec<Node>| put.nodes(part.iter(), out);
        let nodes = in_parts(&self.nodes, is_over, &of_nodes)?;
        // Those before are as many small pieces of memory as there are nodes.
        leave(std::mem::replace(&mut self.nodes, nodes));
        // Next to one another, so that copying finds them soon.
        let label = |node: &Node| node.label.as_deref().map(Arc::from);
        let labels: Vec<Option<Arc<str>>> = self.nodes.iter().map(label).collect();
        for (node, label) in self.nodes.iter_mut().zip(labels) {
            node.label = label;
        }
        self.groups = self.groups.iter().map(|group| put.group(group)).collect();
        self.root = put.large_group(&self.root, is_over)?;
        self.hash_more(is_over)
    }

    /// Takes over nodes and groups of another scene: `nodes` and `groups` are their numbers here, of which
    /// those that are free are taken in order; what has the number of something here stands for that.
    /// Gives what stands in the other's world. The settings stay what they are. `None`, and a scene of no
    /// use, once it is over.
    pub fn take_over(
        &mut self,
        mut other: Self,
        [nodes, groups]: [&[u32]; 2],
        is_over: IsOver<'_>,
    ) -> Option<Vec<Placed>> {
        other.rename(nodes, groups);
        for (node, number) in other.nodes.into_iter().zip(nodes) {
            if *number as usize == self.nodes.len() {
                self.nodes.push(node);
            }
        }
        for (group, number) in other.groups.into_iter().zip(groups) {
            if *number as usize == self.groups.len() {
                self.groups.push(group);
            }
        }
        self.hash_more(is_over)?;
        Some(other.root.items)
    }
}

/// Adds what stands in a part as it is.
fn add<T: Clone>(part: &[T], out: &mut Vec<T>) {
    out.extend_from_slice(part);
}

/// The old numbers of what was met, by the new ones.
fn met(numbers: &[u32], n_met: u32) -> Vec<u32> {
    let mut out = vec![UNMET; n_met as usize];
    for (old, new) in (0..).zip(numbers).filter(|(_, new)| **new != UNMET) {
        out[*new as usize] = old;
    }
    out
}

/// Copies with new numbers, and places in a file.
struct Put<'a, P> {
    nodes: &'a [u32],
    groups: &'a [u32],
    place: &'a P,
}

impl<P: Fn(Span) -> Span + Sync> Put<'_, P> {
    fn id(&self, NodeId(old): NodeId) -> NodeId {
        NodeId(self.nodes[old as usize])
    }

    /// Adds nodes whose parameters are one piece of memory.
    fn nodes<'n>(&self, nodes: impl Iterator<Item = &'n Node> + Clone, out: &mut Vec<Node>) {
        let lengths = nodes.clone().map(|node| u32::try_from(node.params.len()).unwrap_or(0));
        let lengths: Vec<u32> = lengths.collect();
        let mut all = Vec::with_capacity(lengths.iter().map(|length| *length as usize).sum());
        for node in nodes.clone() {
            // Copied as they are, then changed: that takes two thirds of the time of making each anew.
            let first = all.len();
            all.extend_from_slice(&node.params);
            all[first..].iter_mut().for_each(|argument| self.rename(argument));
        }
        let runs = Arguments::runs(all, lengths);
        out.extend(nodes.zip(runs).map(|(node, params)| self.node(node, params)));
    }

    /// Gives a copied parameter its new number and place.
    fn rename(&self, argument: &mut Argument) {
        if let Value::Node(id) | Value::Moved(id, _) = &mut argument.value {
            *id = self.id(*id);
        }
        argument.span = (self.place)(argument.span);
    }

    fn node(&self, node: &Node, params: Arguments) -> Node {
        let overridden = |(name, id): &(_, NodeId)| (Arc::clone(name), self.id(*id));
        Node {
            kind: node.kind,
            class: node.class,
            label: node.label.clone(),
            params,
            overrides: node.overrides.iter().map(overridden).collect(),
            span: (self.place)(node.span),
            hash: node.hash,
        }
    }

    fn item(&self, item: &Placed) -> Placed {
        Placed {
            target: match item.target {
                Target::Node(id) => Target::Node(self.id(id)),
                Target::Group(GroupId(old)) => Target::Group(GroupId(self.groups[old as usize])),
            },
            pose: item.pose.clone(),
            material: item.material.map(|id| self.id(id)),
            span: (self.place)(item.span),
        }
    }

    /// A group of many; `None` once it is over.
    fn large_group(&self, group: &Group, is_over: IsOver<'_>) -> Option<Group> {
        let of_items = |part: &[Placed], out: &mut Vec<Placed>| {
            out.extend(part.iter().map(|item| self.item(item)));
        };
        let items = in_parts(&group.items, is_over, &of_items)?;
        Some(Group { label: group.label.clone(), items })
    }

    fn group(&self, group: &Group) -> Group {
        let items = group.items.iter().map(|item| self.item(item));
        Group { label: group.label.clone(), items: items.collect() }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;
    use crate::diag::SourceId;
    use crate::scene::Pose;
    use crate::scene::compact::STRIDE;
    use crate::scene::compact::tests::node;

    fn placed(target: Target, at: usize) -> Placed {
        let span = Span::new(SourceId(0), at, at);
        Placed { target, pose: Pose::Here, material: None, span }
    }

    #[test]
    fn what_is_gathered_is_what_is_compact() {
        let nodes = vec![node(0, None), node(1, Some(2)), node(2, None), node(3, Some(1))];
        let mut scene = Scene { nodes, camera: Some(NodeId(0)), ..Scene::default() };
        let inner = Group { label: None, items: vec![placed(Target::Node(NodeId(3)), 0)] };
        scene.groups = vec![Group::default(), inner];
        scene.root.items = vec![placed(Target::Group(GroupId(1)), 7)];
        let mut kept = scene.clone();
        kept.prepare(&|span| span, &|| false).unwrap();
        scene.compact(&|| false).unwrap();
        let order = kept.order();
        assert_eq!(kept.gathered(&order, &|span| span, &|| false).unwrap(), scene);
        assert_eq!(scene.copied(&|| false).unwrap(), scene);
        let later = |span: Span| Span { start: span.start + 3, ..span };
        let further = kept.gathered(&order, &later, &|| false).unwrap();
        assert_eq!(further.nodes[1].span.start, scene.nodes[1].span.start + 3);
        assert_eq!(further.nodes[1].params[0].span.start, scene.nodes[1].span.start + 3);
        assert_eq!(further.root.items[0].span.start, 10);
    }

    /// Work that may be over before it ends.
    type Way<'a> = &'a dyn Fn(IsOver<'_>) -> Option<()>;

    #[test]
    fn nothing_comes_of_what_is_over_at_any_look() {
        // Enough for four looks of each pass over the nodes.
        let n = 4 * u32::try_from(STRIDE).unwrap();
        let placed = |id| placed(Target::Node(NodeId(id)), 0);
        let made = || {
            let nodes = (0..n).map(|i| node(i as usize, None)).collect();
            let root = Group { label: None, items: (0..n).map(placed).collect() };
            Scene { nodes, root, ..Scene::default() }
        };
        let mut kept = made();
        kept.prepare(&|span| span, &|| false).unwrap();
        let order = kept.order();
        let ways: [Way<'_>; 4] = [
            &|is_over| made().compact(is_over),
            &|is_over| made().prepare(&|span| span, is_over),
            &|is_over| kept.gathered(&order, &|span| span, is_over).map(drop),
            &|is_over| kept.copied(is_over).map(drop),
        ];
        for way in ways {
            let looks = AtomicUsize::new(0);
            let n_looks = |last: usize| {
                looks.store(0, Ordering::Relaxed);
                way(&|| looks.fetch_add(1, Ordering::Relaxed) >= last)
            };
            n_looks(usize::MAX).unwrap();
            let all = looks.load(Ordering::Relaxed);
            assert!(all > 4, "{all}");
            for last in 0..all {
                assert_eq!(n_looks(last), None, "of {all} looks {last} were before the end");
            }
        }
    }

    #[test]
    fn what_is_taken_over_refers_to_what_it_stands_for() {
        let mut kept = Scene { nodes: vec![node(0, None), node(1, None)], ..Scene::default() };
        kept.prepare(&|span| span, &|| false).unwrap();
        let mut other = Scene { nodes: vec![node(1, None), node(5, Some(0))], ..Scene::default() };
        other.groups = vec![Group { label: None, items: vec![placed(Target::Node(NodeId(1)), 0)] }];
        other.root.items = vec![placed(Target::Group(GroupId(0)), 0)];
        let items = kept.take_over(other, [&[1, 2], &[0]], &|| false).unwrap();
        assert_eq!(kept.nodes.len(), 3);
        assert_eq!(kept.nodes[2].params[0].value, Value::Node(NodeId(1)));
        assert_eq!(kept.groups[0].items[0].target, Target::Node(NodeId(2)));
        kept.root.items = items;
        let mut fresh = Scene { nodes: vec![node(1, None), node(5, Some(0))], ..Scene::default() };
        fresh.groups = vec![Group { label: None, items: vec![placed(Target::Node(NodeId(1)), 0)] }];
        fresh.root.items = vec![placed(Target::Group(GroupId(0)), 0)];
        fresh.compact(&|| false).unwrap();
        assert_eq!(kept.gathered(&kept.order(), &|span| span, &|| false).unwrap(), fresh);
    }
}
