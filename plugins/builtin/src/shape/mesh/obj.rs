//! Wavefront OBJ, parsed by `tobj` once its indices are known to be in range.

use std::borrow::Cow;

use glam::{DVec3, Vec2, Vec3};
use luxel_sdk::color::srgb_decode;
use luxel_sdk::kind::TriangleMesh;
use luxel_sdk::params::BuildContext;
use tobj::LoadOptions;

use super::assemble::{Axes, MOST_POINTS};
use super::inline::unit_color;
use crate::stop::{STRIDE, Stoppable, go_on, wanted};

const OPTIONS: LoadOptions =
    LoadOptions { single_index: true, triangulate: true, ignore_points: true, ignore_lines: true };

/// All groups of the file as one mesh; materials are the scene's business.
///
/// # Errors
/// What is wrong, with its line where `tobj` would not tell it.
pub(super) fn read(
    bytes: &[u8],
    axes: Axes,
    context: &dyn BuildContext,
) -> Result<TriangleMesh, String> {
    // Names and comments may be in any old encoding; numbers are not.
    let text = String::from_utf8_lossy(bytes);
    check(&text, Most::OF_MESH, context)?;
    let text: Cow<'_, [u8]> = match text {
        Cow::Borrowed(text) => Cow::Borrowed(text.as_bytes()),
        Cow::Owned(text) => Cow::Owned(text.into_bytes()),
    };
    let is_over = || context.cancelled();
    let loaded = tobj::load_obj_buf(&mut Stoppable::new(&text, &is_over), &OPTIONS, |_| {
        Ok(Default::default())
    });
    let (models, _) = loaded.map_err(|error| error.to_string().to_lowercase())?;
    let meshes: Vec<_> = models.into_iter().map(|model| model.mesh).collect();
    let points = meshes.iter().flat_map(|m| m.positions.as_chunks().0);
    let rebased = axes.rebase(wanted(points.map(|p| DVec3::from_array(*p)), context));
    let mut out = rebased.map_err(|bad| match line_of(&text, bad.p) {
        Some(line) => format!("line {line}: this point {}", bad.what),
        None => bad.to_string(),
    })?;
    go_on(context)?;
    let any_normals = meshes.iter().any(|m| !m.normals.is_empty());
    let any_uvs = meshes.iter().any(|m| !m.texcoords.is_empty());
    for mesh in &meshes {
        let n = mesh.positions.len() / 3;
        // A corner without a normal of its own leaves the list short: then none can be told apart.
        let complete = mesh.normals.len() == mesh.positions.len();
        let normals = if complete { mesh.normals.as_chunks().0 } else { &[] };
        if any_normals {
            let turned = normals.iter().map(|n| axes.normal(DVec3::from_array(*n).as_vec3()));
            out.normals.extend(turned.chain(std::iter::repeat(Vec3::ZERO)).take(n));
        }
        let complete = mesh.texcoords.len() == 2 * n;
        let uvs = if complete { mesh.texcoords.as_chunks().0 } else { &[] };
        if any_uvs {
            let narrow = uvs.iter().map(|uv: &[f64; 2]| glam::DVec2::from_array(*uv).as_vec2());
            out.uvs.extend(narrow.chain(std::iter::repeat(Vec2::ZERO)).take(n));
        }
    }
    // Some points without a colour leave the list short.
    if meshes.iter().all(|m| m.vertex_color.len() == m.positions.len()) {
        let colors = meshes.iter().flat_map(|m| m.vertex_color.as_chunks().0);
        out.colors = colors.map(|c| color_of(*c)).collect();
    }
    out.indices = triangles(&meshes)?;
    Ok(out)
}

fn triangles(meshes: &[tobj::Mesh]) -> Result<Vec<[u32; 3]>, String> {
    let mut out = Vec::with_capacity(meshes.iter().map(|m| m.indices.len() / 3).sum());
    let mut start = 0u32;
    for mesh in meshes {
        let corners = mesh.indices.as_chunks::<3>().0;
        out.extend(corners.iter().map(|t| t.map(|i| i + start)));
        let n = u32::try_from(mesh.positions.len() / 3).ok();
        let next = n.and_then(|n| start.checked_add(n));
        start = next.ok_or(TOO_MANY)?;
    }
    if out.is_empty() {
        return Err("an OBJ file without a face (no line `f 1 2 3`)".to_owned());
    }
    Ok(out)
}

/// A point's colour, which programs write as sRGB.
pub(super) fn color_of(color: [f64; 3]) -> Vec3 {
    unit_color(DVec3::from_array(color).map(srgb_decode))
}

/// The line, counted from 1, that gives a point.
fn line_of(text: &[u8], p: DVec3) -> Option<usize> {
    let given = |line: &[u8]| {
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        let number = |word: &[u8]| str::from_utf8(word).ok()?.parse::<f64>().ok();
        let is_point = words.next() == Some(b"v");
        // Compared by their bits, as no NaN equals itself.
        let same = |x: f64| words.next().and_then(number).is_some_and(|y| alike(x, y));
        is_point && p.to_array().into_iter().all(same)
    };
    text.split(|b| *b == b'\n').position(given).map(|i| i + 1)
}

fn alike(a: f64, b: f64) -> bool {
    a.total_cmp(&b).is_eq() || a.is_nan() && b.is_nan()
}

pub(super) const TOO_MANY: &str = "more than 4,294,967,295 corners";

/// How many numbers of 32 bits tell apart, in `tobj` and here.
#[derive(Clone, Copy)]
pub(super) struct Most {
    /// Points, texture coordinates and normals each.
    lines: i64,
    /// Corners of all faces.
    corners: u64,
}

impl Most {
    /// What a mesh may have.
    pub(super) const OF_MESH: Self = Self { lines: MOST_POINTS as i64, corners: u32::MAX as u64 };
}

/// Finds the first face that names a corner which does not exist, and more lines or corners than can
/// be told apart.
pub(super) fn check(text: &str, most: Most, context: &dyn BuildContext) -> Result<(), String> {
    const NAMES: [&str; 3] = ["v", "vt", "vn"];
    let mut counts = [0i64; 3];
    let mut n_corners = 0u64;
    // For each list the greatest index, and the line that has it.
    let mut greatest = [(0i64, 0usize); 3];
    for (i, line) in text.lines().enumerate() {
        if i.is_multiple_of(STRIDE) {
            go_on(context)?;
        }
        let mut words = line.split_ascii_whitespace();
        let word = words.next();
        if let Some(k) = NAMES.iter().position(|name| word == Some(name)) {
            counts[k] += 1;
            if counts[k] > most.lines {
                let (name, most) = (NAMES[k], most.lines);
                return Err(format!("line {}: more than {most} lines `{name}`", i + 1));
            }
        } else if let Some("f" | "l") = word {
            let parts = words.flat_map(|word| word.split('/').zip(0..3));
            for (part, k) in parts {
                n_corners += u64::from(k == 0);
                if part.is_empty() {
                    continue;
                }
                let index = part.parse::<i64>().ok();
                let legal = index.filter(|x| *x > 0 || (*x < 0 && *x >= -counts[k]));
                let Some(index) = legal else {
                    let name = NAMES[k];
                    return Err(format!("line {}: `{part}` is no index of a {name}", i + 1));
                };
                if index > greatest[k].0 {
                    greatest[k] = (index, i + 1);
                }
            }
            if n_corners > most.corners {
                return Err(format!("line {}: more than {} corners", i + 1, most.corners));
            }
        }
    }
    for ((count, (index, line)), name) in counts.into_iter().zip(greatest).zip(NAMES) {
        if index > count {
            return Err(format!("line {line}: {name} {index} of {count}"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stop::testing::Patience;

    #[test]
    fn more_lines_or_corners_than_can_be_told_apart_are_refused_with_their_line() {
        let most = Most { lines: 3, corners: 6 };
        let points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        let face = "f 1 2 3\n";
        let patience = Patience::endless();
        assert_eq!(check(&format!("{points}{face}{face}"), most, &patience), Ok(()));
        for (text, expected) in [
            (format!("{points}v 0 0 1\n{face}"), "line 4: more than 3 lines `v`"),
            (format!("{points}{}", "vt 0 0\n".repeat(4)), "line 7: more than 3 lines `vt`"),
            (format!("{points}{}", face.repeat(3)), "line 6: more than 6 corners"),
        ] {
            assert_eq!(check(&text, most, &patience), Err(expected.to_owned()));
        }
    }

    #[test]
    fn what_a_mesh_may_have_fits_thirty_two_bits() {
        assert!(u32::try_from(Most::OF_MESH.lines).is_ok());
        assert!(u32::try_from(Most::OF_MESH.corners).is_ok());
    }
}
