//! The tree of nodes, flattened into placements.

use glam::{DAffine3, DMat4, DQuat, DVec3};
use gltf::json::{Index, Node};
use luxel_sdk::num::Transform;

use super::Builder;
use crate::stop::{STRIDE, go_on};

/// Places what stands in a scene of the file: in order of the tree, in double precision.
///
/// # Errors
/// What keeps the tree from being followed.
pub(super) fn walk(
    build: &mut Builder<'_>,
    scene: Option<f32>,
    base: DAffine3,
) -> Result<(), String> {
    let source = build.source;
    let mut seen = vec![false; source.root.nodes.len()];
    let mut open: Vec<_> = roots(build, scene)?.into_iter().map(|node| (node, base)).collect();
    open.reverse();
    let mut n_seen = 0_usize;
    while let Some((index, parent)) = open.pop() {
        if n_seen.is_multiple_of(STRIDE) {
            go_on(source.context)?;
        }
        n_seen += 1;
        let i = index.value();
        let node = source.root.get(index).ok_or_else(|| format!("there is no nodes[{i}]"))?;
        // A second way to a node could lead in circles, and unfold without end.
        if std::mem::replace(&mut seen[i], true) {
            return Err(format!("nodes[{i}] is reached twice: nodes form a tree"));
        }
        let placement = parent * local(node);
        if Transform::new(placement).is_none() {
            build.warn(format!("nodes[{i}] is scaled to nothing: left out"));
            continue;
        }
        place(build, node, placement);
        let children = node.children.iter().flatten().rev();
        open.extend(children.map(|child| (*child, placement)));
    }
    Ok(())
}

fn place(build: &mut Builder<'_>, node: &Node, placement: DAffine3) {
    let mut made = node.mesh.map_or_else(Vec::new, |mesh| build.mesh(mesh));
    if let Some(camera) = node.camera {
        match build.camera(camera) {
            Ok(camera) => made.push(camera),
            Err(message) => build.faults.push(message),
        }
    }
    let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    if let Some(light) = light {
        match build.light(light.light) {
            Ok(light) => made.extend(light),
            Err(message) => build.faults.push(message),
        }
    }
    build.out.placed.extend(made.into_iter().map(|node| (node, placement)));
}

/// Where the tree starts: in the scene that is asked for, or the file's own, or its first.
fn roots(build: &Builder<'_>, scene: Option<f32>) -> Result<Vec<Index<Node>>, String> {
    let root = &build.source.root;
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
    let asked = scene.map(|scene| scene as usize);
    let n = root.scenes.len();
    let index = asked.or(root.scene.map(|scene| scene.value())).unwrap_or(0);
    match root.scenes.get(index) {
        Some(scene) => Ok(scene.nodes.clone()),
        None if n > 0 || asked.is_some() => Err(format!("there is no scene {index}: it has {n}")),
        None => {
            // A library without a scene: all that hangs on nothing.
            let children = root.nodes.iter().flat_map(|node| node.children.iter().flatten());
            let mut is_child = vec![false; root.nodes.len()];
            for child in children {
                if let Some(mark) = is_child.get_mut(child.value()) {
                    *mark = true;
                }
            }
            let all = (0u32..).zip(is_child).filter(|(_, child)| !child);
            Ok(all.map(|(i, _)| Index::new(i)).collect())
        }
    }
}

fn local(node: &Node) -> DAffine3 {
    if let Some(matrix) = node.matrix {
        return DAffine3::from_mat4(DMat4::from_cols_array(&matrix.map(f64::from)));
    }
    let vector =
        |v: Option<[f32; 3]>, default| v.map_or(default, |v| DVec3::from_array(v.map(f64::from)));
    let turn = node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)));
    // Written in single precision, so unit to seven digits only.
    let length = turn.length();
    let turn = if length > 0.0 { turn / length } else { DQuat::IDENTITY };
    let scale = vector(node.scale, DVec3::ONE);
    DAffine3::from_scale_rotation_translation(scale, turn, vector(node.translation, DVec3::ZERO))
}
