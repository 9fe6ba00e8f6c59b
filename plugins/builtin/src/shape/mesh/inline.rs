//! Meshes whose numbers stand in the scene.

use glam::{DVec3, Vec2, Vec3};
use luxel_sdk::kind::TriangleMesh;
use luxel_sdk::params::Fault;

use super::Mesh;
use super::assemble::Axes;

/// Takes the tables apart; all that is wrong with them at once.
pub(super) fn build(mesh: &Mesh<'_>) -> Result<TriangleMesh, Vec<Fault>> {
    let mut faults = vec![];
    let points = groups::<3>("points", mesh.points.get(), &mut faults);
    let normals = groups::<3>("normals", mesh.normals.get(), &mut faults);
    let uvs = groups::<2>("uvs", mesh.uvs.get(), &mut faults);
    let corners = groups::<3>("indices", mesh.indices.get(), &mut faults);
    for (field, n) in [("normals", normals.len()), ("uvs", uvs.len())] {
        if n != 0 && n != points.len() {
            let message = format!("{n} {field} for {} points: there must be as many", points.len());
            faults.push(Fault::mesh(field, message));
        }
    }
    let axes = Axes { turn: mesh.up.turn(), ..Axes::METRES };
    let indices = triangles(corners, points.len(), &mut faults);
    let rebased = axes.rebase(points.iter().map(|p| DVec3::from_array(*p)));
    let rebased = rebased.map_err(|bad| faults.push(Fault::mesh("points", bad.to_string())));
    let (Ok(mut out), true) = (rebased, faults.is_empty()) else { return Err(faults) };
    out.indices = indices;
    out.normals = normals
        .iter()
        .map(|n| axes.normal(DVec3::from_array(*n).normalize_or_zero().as_vec3()))
        .collect::<Vec<Vec3>>();
    #[expect(clippy::cast_possible_truncation, reason = "texture coordinates are f32")]
    let narrow = |x: f64| if x.is_finite() { x as f32 } else { 0.0 };
    out.uvs = uvs.iter().map(|uv| Vec2::from_array(uv.map(narrow))).collect();
    Ok(out)
}

fn groups<'a, const N: usize>(
    field: &'static str,
    numbers: &'a [f64],
    faults: &mut Vec<Fault>,
) -> &'a [[f64; N]] {
    let (groups, rest) = numbers.as_chunks();
    if !rest.is_empty() {
        let message = format!("{} numbers in {field}: not a multiple of {N}", numbers.len());
        faults.push(Fault::mesh(field, message));
    }
    groups
}

fn triangles(corners: &[[f64; 3]], n_points: usize, faults: &mut Vec<Fault>) -> Vec<[u32; 3]> {
    if corners.is_empty() {
        faults.push(Fault::mesh("indices", "a mesh without a triangle"));
    }
    let mut out = Vec::with_capacity(corners.len());
    for (i, corner) in corners.iter().enumerate() {
        let found = corner.map(|c| index(c, n_points));
        let [Some(a), Some(b), Some(c)] = found else {
            let k = found.iter().position(Option::is_none).unwrap_or(0);
            let message = format!(
                "index {} of triangle {i} names no point: there are {n_points}, from 0",
                corner[k]
            );
            faults.push(Fault::mesh("indices", message));
            return out;
        };
        out.push([a, b, c]);
    }
    out
}

/// A whole number below `n`.
pub(super) fn index(x: f64, n: usize) -> Option<u32> {
    let n = u32::try_from(n).unwrap_or(u32::MAX);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
    (x >= 0.0 && x < f64::from(n) && x.fract() == 0.0).then_some(x as u32)
}
