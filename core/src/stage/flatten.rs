//! Groups in their places into one list, with poses joined.

use luxel_sdk::kind::Kind;

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

/// Most placements that a stage holds.
const LIMIT: usize = 100_000_000;

/// Every shape and light of the scene in the world.
///
/// # Errors
/// E0501 when there are too many.
pub(super) fn flatten(scene: &Scene) -> Result<Vec<Flat>, Box<Diagnostic>> {
    let mut out = vec![];
    walk(scene, &scene.root, &Pose::IDENTITY, None, &mut out)?;
    Ok(out)
}

fn walk(
    scene: &Scene,
    group: &Group,
    pose: &Pose,
    material: Option<NodeId>,
    out: &mut Vec<Flat>,
) -> Result<(), Box<Diagnostic>> {
    for item in &group.items {
        let pose = item.pose.then(pose);
        if matches!(&pose, Pose::Moving(steps) if steps.len() > MOST_STEPS) {
            let message =
                format!("more than {MOST_STEPS} steps of the poses of groups in each other move");
            return Err(Box::new(Diagnostic::error("E0501", item.span, message)));
        }
        let material = item.material.or(material);
        match item.target {
            Target::Group(id) => walk(scene, scene.group(id), &pose, material, out)?,
            Target::Node(node) => {
                if matches!(scene.node(node).kind, Kind::Shape | Kind::Light) {
                    out.push(Flat { node, pose, material, span: item.span });
                }
            }
        }
        if out.len() > LIMIT {
            let message = format!("more than {LIMIT} instances");
            return Err(Box::new(Diagnostic::error("E0501", item.span, message)));
        }
    }
    Ok(())
}
