//! Whether two scenes have the same world, whatever it is looked at with.

use super::{Group, Placed, Scene, Target};

impl Scene {
    /// Whether the same stands in the same places of both, to the bit, and all that it is made of has
    /// the same name in both. Settings do not count, nor labels, nor where something is written.
    pub(crate) fn has_same_world(&self, other: &Self) -> bool {
        let groups = self.groups.iter().zip(&other.groups).chain([(&self.root, &other.root)]);
        let mut used = vec![false; self.nodes.len()];
        self.left_out().eq(other.left_out())
            && self.groups.len() == other.groups.len()
            && self.medium == other.medium
            && groups.into_iter().all(|(group, other)| is_same_group(group, other, &mut used))
            && self.nodes_are_same(other, used)
    }

    /// Whether the nodes that are used, and what those are made of, are the same.
    fn nodes_are_same(&self, other: &Self, mut used: Vec<bool>) -> bool {
        self.medium.iter().for_each(|id| used[id.0 as usize] = true);
        // Children stand before those that refer to them.
        for i in (0..self.nodes.len()).rev() {
            if !used[i] {
                continue;
            }
            let Some(there) = other.nodes.get(i) else { return false };
            let here = &self.nodes[i];
            if here.hash != there.hash || !here.children().eq(there.children()) {
                return false;
            }
            here.children().for_each(|id| used[id.0 as usize] = true);
        }
        true
    }
}

fn is_same_group(group: &Group, other: &Group, used: &mut [bool]) -> bool {
    let is_same = |(a, b): (&Placed, &Placed)| {
        let target = if let Target::Node(id) = a.target { Some(id) } else { None };
        target.into_iter().chain(a.material).for_each(|id| used[id.0 as usize] = true);
        a.target == b.target && a.material == b.material && a.pose.is_same(&b.pose)
    };
    group.items.len() == other.items.len() && group.items.iter().zip(&other.items).all(is_same)
}

#[cfg(test)]
mod tests {
    use glam::{DAffine3, DVec3};

    use super::super::compact::tests::node;
    use super::super::{GroupId, NodeId, Pose};
    use super::*;
    use crate::diag::{SourceId, Span};

    /// Two shapes, one of which is made of another, and a camera; `at` is where they are written.
    fn scene(at: usize, x: f64, child: u32) -> Scene {
        let mut scene = Scene::default();
        for i in 0..2 {
            scene.add(node(at + i, None));
        }
        let whole = scene.add(node(at + 2, Some(child)));
        scene.camera = Some(scene.add(node(at + 3, Some(2))));
        let pose = Pose::from(DAffine3::from_translation(DVec3::X * x));
        let span = Span::new(SourceId(0), at, at);
        let placed = |target| Placed { target, pose: pose.clone(), material: None, span };
        scene.groups.push(Group { label: None, items: vec![placed(Target::Node(whole))] });
        scene.root.items.push(placed(Target::Group(GroupId(0))));
        scene
    }

    #[test]
    fn worlds_are_the_same_where_places_and_what_stands_there_are() {
        let first = scene(0, 1.0, 0);
        let mut other = scene(9, 1.0, 0);
        other.camera = None;
        other.nodes.pop();
        assert!(first.has_same_world(&other) && other.has_same_world(&first));
        assert!(!first.has_same_world(&scene(0, 2.0, 0)));
        assert!(!scene(0, 0.0, 0).has_same_world(&scene(0, -0.0, 0)), "to the bit");
        // The same content by another name: what is called after a node would be called otherwise.
        assert!(!first.has_same_world(&scene(0, 1.0, 1)));
        other.medium = Some(NodeId(0));
        assert!(!first.has_same_world(&other));
        let mut dropped = scene(0, 1.0, 0);
        dropped.leave_out(crate::scene::Feature::Media).unwrap();
        assert!(!first.has_same_world(&dropped));
    }
}
