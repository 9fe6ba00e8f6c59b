//! Meshes whose numbers stand in the scene.

use glam::{DVec2, DVec3, Vec2, Vec3};
use luxel_sdk::kind::TriangleMesh;
use luxel_sdk::params::{BuildContext, Fault};

use super::assemble::{Axes, check_n_points, fan};
use super::polygons::Polygons;
use super::{Mesh, stopped};
use crate::stop::{go_on, wanted};

/// Takes the tables apart; all that is wrong with them at once.
pub(super) fn build(
    mesh: &Mesh<'_>,
    context: &dyn BuildContext,
) -> Result<TriangleMesh, Vec<Fault>> {
    let tables = Tables::read(mesh, context)?;
    let rebased = tables.axes.rebase(tables.places(context));
    let mut out = rebased.map_err(|bad| vec![Fault::mesh("points", bad.to_string())])?;
    for face in wanted(tables.starts.windows(2), context) {
        fan(&tables.corners[face[0] as usize..face[1] as usize], &mut out.indices);
    }
    (out.normals, out.uvs) = (tables.normals(context), tables.uvs(context));
    out.colors = tables.colors(context);
    go_on(context).map_err(stopped)?;
    Ok(out)
}

/// The same, with faces as they were given.
pub(super) fn polygons(
    mesh: &Mesh<'_>,
    context: &dyn BuildContext,
) -> Result<Polygons, Vec<Fault>> {
    let tables = Tables::read(mesh, context)?;
    let rebased = tables.axes.rebase(tables.places(context));
    rebased.map_err(|bad| vec![Fault::mesh("points", bad.to_string())])?;
    let (normals, uvs) = (tables.normals(context), tables.uvs(context));
    let colors = tables.colors(context);
    let points = tables.places(context).map(|p| tables.axes.point(p)).collect();
    go_on(context).map_err(stopped)?;
    let mut out =
        Polygons { points, starts: tables.starts, corners: tables.corners, ..Polygons::default() };
    (out.normals, out.uvs) = (out.spread(&normals), out.spread(&uvs));
    out.colors = out.spread(&colors);
    out.weld(context).map_err(stopped)?;
    Ok(out)
}

/// What the scene says, found to fit together.
struct Tables<'a> {
    axes: Axes,
    points: &'a [[f64; 3]],
    normals: &'a [[f64; 3]],
    uvs: &'a [[f64; 2]],
    colors: &'a [[f64; 3]],
    corners: Vec<u32>,
    starts: Vec<u32>,
}

impl<'a> Tables<'a> {
    fn read(mesh: &Mesh<'a>, context: &dyn BuildContext) -> Result<Self, Vec<Fault>> {
        let mut faults = vec![];
        let points = groups::<3>("points", mesh.points.get(), &mut faults);
        if let Err(message) = check_n_points(points.len()) {
            faults.push(Fault::mesh("points", message));
        }
        let normals = groups::<3>("normals", mesh.normals.get(), &mut faults);
        let uvs = groups::<2>("uvs", mesh.uvs.get(), &mut faults);
        let colors = groups::<3>("colors", mesh.colors.get(), &mut faults);
        let (indices, sides) = (mesh.indices.get(), mesh.sides.get());
        let starts = starts(indices.len(), sides, &mut faults);
        // What is begun counts as one, lest a number too few be told of all.
        let n_points = mesh.points.get().len().div_ceil(3);
        let lists = [
            ("normals", mesh.normals.get().len().div_ceil(3)),
            ("uvs", mesh.uvs.get().len().div_ceil(2)),
            ("colors", mesh.colors.get().len().div_ceil(3)),
        ];
        for (field, n) in lists {
            if n != 0 && n != n_points {
                let message = format!("{n} {field} for {n_points} points: there must be as many");
                faults.push(Fault::mesh(field, message));
            }
        }
        let out_of_range = |x: &f64| !(0.0..=1.0).contains(x);
        if let Some(i) = wanted(colors.as_flattened(), context).position(out_of_range) {
            let message = format!("colour {} has {}, outside [0, 1]", i / 3, mesh.colors.get()[i]);
            faults.push(Fault::mesh("colors", message));
        }
        let what = if sides.is_empty() { "triangle" } else { "face" };
        let corners = corners((indices, &starts), n_points, what, context);
        let corners = corners.map_err(|fault| faults.push(fault)).unwrap_or_default();
        go_on(context).map_err(stopped)?;
        let axes = Axes { turn: mesh.up.turn(), ..Axes::METRES };
        let tables = Self { axes, points, normals, uvs, colors, corners, starts };
        if faults.is_empty() { Ok(tables) } else { Err(faults) }
    }

    // All of these end early when nobody wants them any more.

    fn places(&self, context: &'a dyn BuildContext) -> impl Iterator<Item = DVec3> + Clone {
        wanted(self.points, context).map(|p| DVec3::from_array(*p))
    }

    fn normals(&self, context: &dyn BuildContext) -> Vec<Vec3> {
        let unit = |n: &[f64; 3]| DVec3::from_array(*n).normalize_or_zero().as_vec3();
        wanted(self.normals, context).map(|n| self.axes.normal(unit(n))).collect()
    }

    fn colors(&self, context: &dyn BuildContext) -> Vec<Vec3> {
        wanted(self.colors, context).map(|c| DVec3::from_array(*c).as_vec3()).collect()
    }

    fn uvs(&self, context: &dyn BuildContext) -> Vec<Vec2> {
        wanted(self.uvs, context).map(|uv| finite_uv(DVec2::from_array(*uv))).collect()
    }
}

/// A colour of a surface: each part in [0, 1], 0 where it is no number.
pub(super) fn unit_color(color: DVec3) -> Vec3 {
    color.as_vec3().map(|x| if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) })
}

/// Texture coordinates in single precision; (0, 0) where they do not fit.
pub(super) fn finite_uv(uv: DVec2) -> Vec2 {
    let uv = uv.as_vec2();
    if uv.is_finite() { uv } else { Vec2::ZERO }
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

/// Where the corners of each face begin, and the last one's end.
fn starts(n_indices: usize, sides: &[f64], faults: &mut Vec<Fault>) -> Vec<u32> {
    let mut fault = |field, message: String| faults.push(Fault::mesh(field, message));
    let Ok(n) = u32::try_from(n_indices) else {
        fault("indices", "more than 4,294,967,295 indices".to_owned());
        return vec![];
    };
    if n == 0 {
        fault("indices", "a mesh without a triangle".to_owned());
    }
    if sides.is_empty() {
        if n % 3 != 0 {
            fault("indices", format!("{n} numbers in indices: not a multiple of 3"));
        }
        return (0..=n).step_by(3).collect();
    }
    let (mut out, mut at) = (vec![0], 0u64);
    for (i, side) in sides.iter().enumerate() {
        let Some(corners) = index(*side, u32::MAX as usize).filter(|n| *n >= 3) else {
            fault("sides", format!("face {i} has {side} sides: 3 or more are wanted"));
            return vec![];
        };
        at += u64::from(corners);
        out.push(u32::try_from(at).unwrap_or(u32::MAX));
    }
    if at != u64::from(n) {
        fault("sides", format!("{at} corners in sides, but {n} numbers in indices"));
        return vec![];
    }
    out
}

/// As many as are wanted.
fn corners(
    (indices, starts): (&[f64], &[u32]),
    n_points: usize,
    what: &str,
    context: &dyn BuildContext,
) -> Result<Vec<u32>, Fault> {
    let n = starts.last().map_or(0, |end| *end as usize);
    let mut out = Vec::with_capacity(n);
    for (i, x) in wanted(indices[..n].iter().enumerate(), context) {
        let Some(corner) = index(*x, n_points) else {
            let face = starts.partition_point(|start| *start as usize <= i).saturating_sub(1);
            let message =
                format!("index {x} of {what} {face} names no point: there are {n_points}, from 0");
            return Err(Fault::mesh("indices", message));
        };
        out.push(corner);
    }
    Ok(out)
}

/// A whole number below `n`.
pub(super) fn index(x: f64, n: usize) -> Option<u32> {
    let n = u32::try_from(n).unwrap_or(u32::MAX);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
    (x >= 0.0 && x < f64::from(n) && x.fract() == 0.0).then_some(x as u32)
}
