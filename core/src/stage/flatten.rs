//! Groups in their places into one list, with poses joined.

use luxel_sdk::kind::Kind;

use crate::accel::{TopBvh, Watch};
use crate::diag::Diagnostic;
use crate::scene::{Group, NodeId, Pose, Scene, Target};

/// A node in the world.
#[derive(Clone, Debug)]
pub(super) struct Flat {
    pub(super) node: NodeId,
    pub(super) pose: Pose,
    /// The material of the nearest placement or group that gives one.
    pub(super) material: Option<NodeId>,
    /// Where the outermost placement is written.
    pub(super) span: crate::diag::Span,
}

/// Most steps of a pose that moves: each costs time for every ray that comes near.
const MOST_STEPS: usize = 256;

/// Most placements that a stage can hold, whatever the scene is allowed.
const LIMIT: usize = 100_000_000;

const _: () = assert!(LIMIT <= TopBvh::MOST, "a tree numbers every placement");

/// Placements between two looks at the watch: far below a millisecond's work.
const STRIDE: usize = 1 << 12;

/// Every shape and light of the scene in the world; some of them once the watch is cancelled.
///
/// # Errors
/// E0501 when there are too many.
pub(super) fn flatten(scene: &Scene, watch: &Watch) -> Result<Vec<Flat>, Box<Diagnostic>> {
    within(scene.most_instances().min(LIMIT), scene, watch)
}

/// The same with at most `limit`.
fn within(limit: usize, scene: &Scene, watch: &Watch) -> Result<Vec<Flat>, Box<Diagnostic>> {
    let mut walk = Walk { scene, limit, watch, out: vec![] };
    walk.over(&scene.root, &Pose::Here, None)?;
    Ok(walk.out)
}

/// On the way through groups.
struct Walk<'a> {
    scene: &'a Scene,
    limit: usize,
    watch: &'a Watch,
    out: Vec<Flat>,
}

impl Walk<'_> {
    fn over(
        &mut self,
        group: &Group,
        pose: &Pose,
        material: Option<NodeId>,
    ) -> Result<(), Box<Diagnostic>> {
        for (i, item) in group.items.iter().enumerate() {
            if i.is_multiple_of(STRIDE) && self.watch.is_cancelled() {
                return Ok(());
            }
            let pose = item.pose.then(pose);
            if matches!(&pose, Pose::Moving(steps) if steps.len() > MOST_STEPS) {
                let message = format!(
                    "more than {MOST_STEPS} steps of the poses of groups in each other move"
                );
                return Err(Box::new(Diagnostic::error("E0501", item.span, message)));
            }
            let material = item.material.or(material);
            match item.target {
                Target::Group(id) => self.over(self.scene.group(id), &pose, material)?,
                Target::Node(node) => {
                    if matches!(self.scene.node(node).kind, Kind::Shape | Kind::Light) {
                        self.out.push(Flat { node, pose, material, span: item.span });
                    }
                }
            }
            if self.out.len() > self.limit {
                let message = format!("more than {} instances", self.limit);
                let told = Diagnostic::error("E0501", item.span, message);
                let advice = format!("`--budget instances={:.0e}` allows more", 2 * self.limit);
                return Err(Box::new(if self.limit < LIMIT { told.help(advice) } else { told }));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::{SourceId, Span};
    use crate::scene::{Arguments, GroupId, Node, Placed};

    #[test]
    fn one_instance_more_than_the_limit_is_told_where_it_stands() {
        let at = |place| Span::new(SourceId(0), place, place + 1);
        let mut scene = Scene::default();
        let node = scene.add(Node {
            kind: Kind::Shape,
            class: "any",
            label: None,
            params: Arguments::default(),
            overrides: vec![],
            span: at(0),
            hash: [0; 32],
        });
        let pose = Pose::Here;
        let placed =
            |target, span| Placed { target, pose: pose.clone(), material: None, span: at(span) };
        let pair = [1, 2].map(|place| placed(Target::Node(node), place)).to_vec();
        scene.groups.push(Group { label: None, items: pair });
        let group = Target::Group(GroupId(0));
        scene.root.items = [7, 8].map(|place| placed(group, place)).to_vec();
        let watch = Watch::default();
        assert_eq!(within(4, &scene, &watch).unwrap().len(), 4);
        let told = within(3, &scene, &watch).unwrap_err();
        assert_eq!((told.code, &*told.message), ("E0501", "more than 3 instances"));
        watch.cancel();
        assert!(within(3, &scene, &watch).unwrap().is_empty());
    }
}
