//! The Stanford polygon format: text, or binary of either byte order.
//!
//! A binary file is walked where it lies; nothing is held beside the mesh that is made.

mod header;
mod value;

use glam::{DVec2, DVec3, Vec3};
use luxel_sdk::color::srgb_decode;
use luxel_sdk::kind::TriangleMesh;
use luxel_sdk::params::BuildContext;

use self::header::{Element, Header};
use self::value::{Encoding, Reader, Scalar};
use super::assemble::{Axes, check_n_points, fan};
use super::inline::{finite_uv, unit_color};
use super::polygons::Polygons;

/// Reads the elements `vertex` and `face`; others are passed over.
///
/// # Errors
/// What does not fit together, with its vertex or face.
pub(super) fn read(
    bytes: &[u8],
    axes: Axes,
    context: &dyn BuildContext,
) -> Result<TriangleMesh, String> {
    let mut indices = vec![];
    let mesh = parse((bytes, context), axes, &mut indices, None)?;
    if indices.is_empty() {
        return Err(EMPTY.to_owned());
    }
    Ok(TriangleMesh { indices, ..mesh })
}

/// The same, with faces as they were given and points in double precision.
pub(super) fn polygons(
    bytes: &[u8],
    axes: Axes,
    context: &dyn BuildContext,
) -> Result<Polygons, String> {
    let mut out = Polygons { starts: vec![0], ..Polygons::default() };
    let mut points = vec![];
    let mesh = parse((bytes, context), axes, &mut out, Some(&mut points))?;
    if out.n_faces() == 0 {
        return Err(EMPTY.to_owned());
    }
    if u32::try_from(out.corners.len()).is_err() {
        return Err("more than 4,294,967,295 corners".to_owned());
    }
    out.points = points;
    (out.normals, out.uvs) = (out.spread(&mesh.normals), out.spread(&mesh.uvs));
    out.colors = out.spread(&mesh.colors);
    out.weld(context)?;
    Ok(out)
}

/// Where faces go.
trait Faces {
    /// So many are coming.
    fn expect(&mut self, n: usize);
    /// One more.
    fn add(&mut self, corners: &[u32]);
}

impl Faces for Vec<[u32; 3]> {
    fn expect(&mut self, n: usize) {
        self.reserve(n);
    }

    fn add(&mut self, corners: &[u32]) {
        fan(corners, self);
    }
}

impl Faces for Polygons {
    fn expect(&mut self, n: usize) {
        self.starts.reserve(n);
    }

    fn add(&mut self, corners: &[u32]) {
        if corners.len() >= 3 {
            self.corners.extend(corners);
            // Too many are refused when all are there.
            self.starts.push(u32::try_from(self.corners.len()).unwrap_or(u32::MAX));
        }
    }
}

const EMPTY: &str = "a mesh without a triangle";

/// Vertices as a mesh without triangles, and faces one by one; `exact` takes the points as they are.
fn parse(
    (bytes, context): (&[u8], &dyn BuildContext),
    axes: Axes,
    out: &mut impl Faces,
    mut exact: Exact<'_>,
) -> Result<TriangleMesh, String> {
    let header = Header::parse(bytes)?;
    let mut reader = Reader::new(&bytes[header.length..], header.encoding, context);
    let n_points = header.elements.iter().find(|e| e.name == "vertex").map_or(0, |e| e.count);
    check_n_points(n_points)?;
    let mut mesh = None;
    for element in &header.elements {
        element.check_count(&reader)?;
        match element.name.as_str() {
            "vertex" if mesh.is_none() => {
                mesh = Some(vertices(element, &mut reader, axes, exact.take())?);
            }
            "face" => faces(element, &mut reader, n_points, out)?,
            _ => skip(element, &mut reader)?,
        }
    }
    mesh.ok_or_else(|| "no element `vertex`".to_owned())
}

/// Where in a vertex its numbers are.
struct Layout {
    point: [usize; 3],
    normal: Option<[usize; 3]>,
    uv: Option<[usize; 2]>,
    color: Option<[usize; 3]>,
    /// How colours are stored, which says how they are meant.
    depth: Scalar,
}

impl Layout {
    fn of(element: &Element) -> Result<Self, String> {
        let find = |name: &str| element.properties.iter().position(|p| p.name == name);
        let all = |names: [&str; 3]| Some([find(names[0])?, find(names[1])?, find(names[2])?]);
        let pairs = [("u", "v"), ("s", "t"), ("texture_u", "texture_v"), ("u0", "v0")];
        let uv = pairs.iter().find_map(|(u, v)| Some([find(u)?, find(v)?]));
        let point = all(["x", "y", "z"]).ok_or("vertices without x, y and z")?;
        let color = all(["red", "green", "blue"]).or_else(|| all(["r", "g", "b"]));
        let depth = color.map_or(Scalar::F32, |color| element.properties[color[0]].value);
        Ok(Self { point, normal: all(["nx", "ny", "nz"]), uv, color, depth })
    }
}

type Exact<'a> = Option<&'a mut Vec<DVec3>>;

fn vertices(
    e: &Element,
    reader: &mut Reader<'_>,
    axes: Axes,
    exact: Exact<'_>,
) -> Result<TriangleMesh, String> {
    let layout = Layout::of(e)?;
    match (e.stride(), reader.encoding) {
        (Some(stride), Encoding::Little | Encoding::Big) => {
            let rows = reader.take(stride * e.count)?;
            let rows = rows.chunks_exact(stride.max(1));
            let mesh = strided((e, &layout), reader.wanted(rows), reader.encoding, axes, exact)?;
            // Whether there were all of them.
            reader.go_on(0)?;
            Ok(mesh)
        }
        _ => listed((e, &layout), reader, axes, exact),
    }
}

/// Vertices of a fixed size: read in place, as often as needed.
fn strided<'a>(
    (element, layout): (&Element, &Layout),
    rows: impl Iterator<Item = &'a [u8]> + Clone,
    encoding: Encoding,
    axes: Axes,
    exact: Exact<'_>,
) -> Result<TriangleMesh, String> {
    let column = |property: usize| {
        let offset = element.properties[..property].iter().map(|p| p.value.size()).sum::<usize>();
        (offset, element.properties[property].value)
    };
    let at = move |row: &[u8], (offset, scalar): (usize, Scalar)| encoding.at(row, offset, scalar);
    let [x, y, z] = layout.point.map(column);
    let points = rows.clone().map(|row| DVec3::new(at(row, x), at(row, y), at(row, z)));
    if let Some(exact) = exact {
        exact.extend(points.clone().map(|p| axes.point(p)));
    }
    let mut mesh = axes.rebase(points)?;
    if let Some([x, y, z]) = layout.normal.map(|n| n.map(column)) {
        let normal = |row| DVec3::new(at(row, x), at(row, y), at(row, z)).as_vec3();
        mesh.normals = rows.clone().map(|row| axes.normal(normal(row))).collect();
    }
    if let Some([u, v]) = layout.uv.map(|uv| uv.map(column)) {
        mesh.uvs = rows.clone().map(|row| finite_uv(DVec2::new(at(row, u), at(row, v)))).collect();
    }
    if let Some([r, g, b]) = layout.color.map(|color| color.map(column)) {
        let color = |row| linear(DVec3::new(at(row, r), at(row, g), at(row, b)), layout.depth);
        mesh.colors = rows.map(color).collect();
    }
    Ok(mesh)
}

/// Vertices of text, or with lists among their properties: read once, into double precision.
fn listed(
    (element, layout): (&Element, &Layout),
    reader: &mut Reader<'_>,
    axes: Axes,
    exact: Exact<'_>,
) -> Result<TriangleMesh, String> {
    let mut points = Vec::with_capacity(element.count);
    let (mut normals, mut uvs, mut colors) = (vec![], vec![], vec![]);
    let mut row = vec![0.0; element.properties.len()];
    for i in 0..element.count {
        reader.go_on(i)?;
        for (value, property) in row.iter_mut().zip(&element.properties) {
            let read = match property.list {
                Some(count) => reader.skip_list(count, property.value).map(|()| 0.0),
                None => reader.next(property.value),
            };
            *value = read.map_err(|error| format!("vertex {i} of {}: {error}", element.count))?;
        }
        points.push(DVec3::from_array(layout.point.map(|k| row[k])));
        if let Some(n) = layout.normal {
            normals.push(axes.normal(DVec3::from_array(n.map(|k| row[k])).as_vec3()));
        }
        if let Some([u, v]) = layout.uv {
            uvs.push(finite_uv(DVec2::new(row[u], row[v])));
        }
        if let Some(color) = layout.color {
            colors.push(linear(DVec3::from_array(color.map(|k| row[k])), layout.depth));
        }
    }
    if let Some(exact) = exact {
        exact.extend(points.iter().map(|p| axes.point(*p)));
    }
    let mesh = axes.rebase(points.into_iter())?;
    Ok(TriangleMesh { normals, uvs, colors, ..mesh })
}

/// A colour as linear sRGB: whole numbers are parts of the greatest, of sRGB with its curve; others
/// are linear already. Outside [0, 1] is no colour of a surface.
fn linear(color: DVec3, depth: Scalar) -> Vec3 {
    let most = match depth {
        Scalar::U8 => f64::from(u8::MAX),
        Scalar::U16 => f64::from(u16::MAX),
        Scalar::U32 => f64::from(u32::MAX),
        _ => return unit_color(color),
    };
    unit_color((color / most).map(srgb_decode))
}

fn faces(
    element: &Element,
    reader: &mut Reader<'_>,
    n_points: usize,
    out: &mut impl Faces,
) -> Result<(), String> {
    let names = ["vertex_indices", "vertex_index"];
    let wanted = |p: &header::Property| p.list.is_some() && names.contains(&p.name.as_str());
    let list = element.properties.iter().position(wanted);
    let list = list.ok_or("faces without a list `vertex_indices`")?;
    // A triangle takes at least a byte for its length and one for each corner.
    out.expect(element.count.min(reader.rest().len() / 4));
    let mut corners = vec![];
    for i in 0..element.count {
        reader.go_on(i)?;
        let located = |error| format!("face {i} of {}: {error}", element.count);
        for (k, property) in element.properties.iter().enumerate() {
            let read = match property.list {
                Some(count) if k == list => {
                    corners.clear();
                    reader.list(count, property.value, n_points, &mut corners)
                }
                Some(count) => reader.skip_list(count, property.value),
                None => reader.next(property.value).map(|_| ()),
            };
            read.map_err(located)?;
        }
        out.add(&corners);
    }
    Ok(())
}

fn skip(element: &Element, reader: &mut Reader<'_>) -> Result<(), String> {
    if element.properties.is_empty() {
        return Ok(());
    }
    for i in 0..element.count {
        reader.go_on(i)?;
        for property in &element.properties {
            match property.list {
                Some(count) => reader.skip_list(count, property.value),
                None => reader.next(property.value).map(|_| ()),
            }
            .map_err(|error| format!("{} {i} of {}: {error}", element.name, element.count))?;
        }
    }
    Ok(())
}
