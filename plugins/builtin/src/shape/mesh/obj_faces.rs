//! Faces of a Wavefront OBJ as they stand in the file: which corners are one point is the file's to
//! say, apart from their texture coordinates.

use glam::{DVec2, DVec3, Vec2, Vec3};

use luxel_sdk::params::BuildContext;

use super::assemble::Axes;
use super::inline::finite_uv;
use super::obj::{Most, TOO_MANY, check, color_of};
use super::polygons::Polygons;
use crate::stop::{STRIDE, go_on, wanted};

/// All groups of the file as one mesh.
///
/// # Errors
/// What is wrong, with its line.
pub(super) fn read(
    bytes: &[u8],
    axes: Axes,
    context: &dyn BuildContext,
) -> Result<Polygons, String> {
    // Names and comments may be in any old encoding; numbers are not.
    let text = String::from_utf8_lossy(bytes);
    check(&text, Most::OF_MESH, context)?;
    let mut file = Lists { axes, ..Lists::default() };
    for (i, line) in text.lines().enumerate() {
        if i.is_multiple_of(STRIDE) {
            go_on(context)?;
        }
        file.line(line).map_err(|message| format!("line {}: {message}", i + 1))?;
    }
    let Lists { mut faces, lines, colors, .. } = file;
    if !colors.iter().any(|color| color.is_nan()) {
        faces.colors = faces.spread(&colors);
    }
    if faces.n_faces() == 0 {
        return Err("an OBJ file without a face (no line `f 1 2 3`)".to_owned());
    }
    let rebased = Axes::METRES.rebase(wanted(faces.points.iter().copied(), context));
    rebased.map_err(|bad| format!("line {}: this point {}", lines[bad.i] + 1, bad.what))?;
    go_on(context)?;
    // Where no corner has them, there are none.
    if faces.uvs.iter().all(|uv| uv.is_nan()) {
        faces.uvs.clear();
    }
    if faces.normals.iter().all(|n| *n == Vec3::ZERO) {
        faces.normals.clear();
    }
    for uv in &mut faces.uvs {
        *uv = if uv.is_nan() { Vec2::ZERO } else { *uv };
    }
    Ok(faces)
}

struct Lists {
    axes: Axes,
    faces: Polygons,
    /// The line of each point, from 0.
    lines: Vec<usize>,
    n_lines: usize,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    /// Of each point, not a number where it has none.
    colors: Vec<Vec3>,
}

impl Default for Lists {
    fn default() -> Self {
        let faces = Polygons { starts: vec![0], ..Polygons::default() };
        let (lines, uvs, normals, colors) = (vec![], vec![], vec![], vec![]);
        Self { axes: Axes::METRES, faces, lines, n_lines: 0, uvs, normals, colors }
    }
}

impl Lists {
    fn line(&mut self, line: &str) -> Result<(), String> {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("v") => {
                let [x, y, z, r, g, b] = numbers::<6>(words, 3, f64::NAN)?;
                // A fourth number alone is no colour but what the point is divided by.
                let p = if g.is_nan() && !r.is_nan() { [x / r, y / r, z / r] } else { [x, y, z] };
                self.colors.push(color([r, g, b]));
                self.faces.points.push(self.axes.point(DVec3::from_array(p)));
                self.lines.push(self.n_lines);
            }
            Some("vt") => {
                let [u, v] = numbers::<2>(words, 1, 0.0)?;
                self.uvs.push(finite_uv(DVec2::new(u, v)));
            }
            Some("vn") => {
                let n = numbers::<3>(words, 3, 0.0)?;
                self.normals.push(self.axes.normal(DVec3::from_array(n).as_vec3()));
            }
            Some("f") => self.face(words)?,
            _ => {}
        }
        self.n_lines += 1;
        Ok(())
    }

    fn face<'a>(&mut self, corners: impl Iterator<Item = &'a str>) -> Result<(), String> {
        let start = self.faces.corners.len();
        for corner in corners {
            let mut parts = corner.split('/');
            let mut place = |n: usize| Some(of_word(parts.next()?, n));
            let point = place(self.faces.points.len()).flatten();
            let point = point.ok_or_else(|| format!("`{corner}` names no point before it"))?;
            let uv = place(self.uvs.len()).flatten();
            let normal = place(self.normals.len()).flatten();
            self.faces.corners.push(u32::try_from(point).map_err(|_| TOO_MANY)?);
            self.faces.uvs.push(uv.map_or(Vec2::NAN, |i| self.uvs[i]));
            self.faces.normals.push(normal.map_or(Vec3::ZERO, |i| self.normals[i]));
        }
        if self.faces.corners.len() - start < 3 {
            return Err("a face with fewer than 3 corners".to_owned());
        }
        self.faces.starts.push(u32::try_from(self.faces.corners.len()).map_err(|_| TOO_MANY)?);
        Ok(())
    }
}

/// The place, from 0, that a word of a face names among those that the file has given before it.
fn of_word(word: &str, n: usize) -> Option<usize> {
    let i: i64 = word.parse().ok()?;
    let n = i64::try_from(n).ok()?;
    let place = if i < 0 { n + i } else { i - 1 };
    usize::try_from(place).ok().filter(|_| place < n)
}

/// What stands behind a point; not a number where it is no three numbers.
fn color(color: [f64; 3]) -> Vec3 {
    if color.iter().any(|x| x.is_nan()) { Vec3::NAN } else { color_of(color) }
}

/// Numbers of which the first `least` must be there; others that are not are `absent`.
fn numbers<'a, const N: usize>(
    mut words: impl Iterator<Item = &'a str>,
    least: usize,
    absent: f64,
) -> Result<[f64; N], String> {
    let mut out = [absent; N];
    for (i, x) in out.iter_mut().enumerate() {
        match words.next() {
            Some(word) => {
                *x = word.parse().map_err(|_| format!("`{word}` is not a number"))?;
            }
            None if i < least => return Err(format!("{i} numbers, but {least} are wanted")),
            None => {}
        }
    }
    Ok(out)
}
