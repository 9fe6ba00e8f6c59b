//! Whether a mesh encloses a volume.

use luxel_sdk::kind::TriangleMesh;

use crate::cast::index;

/// Whether every edge is run along once in each direction.
///
/// Corners at the same place count as one, so that seams of texture coordinates do not open a mesh.
pub(super) fn is_closed(mesh: &TriangleMesh) -> bool {
    let mut order: Vec<u32> = (0..index(mesh.points.len())).collect();
    let key = |i: &u32| mesh.points[*i as usize].to_array().map(|x| (x + 0.0).to_bits());
    order.sort_unstable_by_key(key);
    let mut same = vec![0u32; order.len()];
    for pair in 0..order.len() {
        let joined = pair > 0 && key(&order[pair]) == key(&order[pair - 1]);
        same[order[pair] as usize] =
            if joined { same[order[pair - 1] as usize] } else { order[pair] };
    }
    let mut edges: Vec<(u32, u32)> = vec![];
    for triangle in &mesh.indices {
        let [a, b, c] = triangle.map(|i| same[i as usize]);
        edges.extend([(a, b), (b, c), (c, a)].into_iter().filter(|(a, b)| a != b));
    }
    let mut back: Vec<_> = edges.iter().map(|&(a, b)| (b, a)).collect();
    edges.sort_unstable();
    back.sort_unstable();
    !edges.is_empty() && edges == back
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn a_tetrahedron_is_closed_until_a_face_is_missing() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let faces = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        assert!(is_closed(&TriangleMesh::rebased(&points, faces.clone())));
        assert!(!is_closed(&TriangleMesh::rebased(&points, faces[..3].to_vec())));
    }
}
