//! Triangle meshes: written into the scene, or read from a file.

mod assemble;
mod inline;
mod moving;
mod obj;
mod obj_faces;
mod ply;
mod polygons;
mod net;
mod subdivide;
mod displace;

use std::sync::Arc;

use glam::{DVec2, DVec3};
use luxel_sdk::kind::{Hit, Shape, Surface, TextureRef, TriangleMesh};
use luxel_sdk::num::{Bounds3, Ray, gamma64};
use luxel_sdk::params::{Build, BuildContext, Fault, File, Shared, Table};
use luxel_sdk::{Choice, Params};

use self::assemble::Axes;
use self::subdivide::Scheme;
use super::up::Up;
use crate::sniff;
use crate::stop::{go_on, wanted};

/// What is done about shading normals.
#[derive(Choice, Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub(crate) enum Shading {
    /// As given: smooth with normals, flat without; what is subdivided or displaced is smooth.
    Keep,
    /// Flat: given normals are dropped.
    Flat,
    /// Smooth: normals are made from the faces where none are given.
    Smooth,
}

/// Triangles, from a file or written out.
///
/// Files are Wavefront `.obj` and `.ply` (text or binary); polygons become fans of triangles, so
/// they should be convex. `unit` says how long one unit of the file is.
///
/// With `subdivide`, the faces are the cage of a smooth surface, which every point is moved to: quads
/// and others after Catmull and Clark, triangles after Loop. Edges stay sharp at `creases` and where
/// no two faces join, as do points of a single face; texture coordinates are interpolated linearly
/// within each face of the cage, and their seams never tear. Points of tables and PLY files that are
/// at the same place are one; OBJ files say themselves which are.
///
/// With `displace`, a texture moves the surface, split into triangles of at most `edge`. Both make
/// 8,388,608 triangles at most.
///
/// With `next` or `next_points` the corners move from one place to the other, in straight lines; a
/// film whose `shutter` is open for a while sees them on their way.
///
/// ```scene
/// shape mesh "cow"   { file = "assets/spot.obj", unit = 1 m, material = white }
/// shape mesh "floor" {
///   points  = #[ -1 0 -1   1 0 -1   1 0 1   -1 0 1 ] m
///   indices = #[ 0 2 1   0 3 2 ]
///   material = white
/// }
/// ```
///
/// A cage of triangles, smooth but for two edges, with the squares of a chessboard on it:
///
/// ```scene
/// shape mesh "pebble" {
///   points  = #[ 1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1 ] cm
///   indices = #[ 0 2 4  2 1 4  1 3 4  3 0 4  2 0 5  1 2 5  3 1 5  0 3 5 ]
///   subdivide = 2, scheme = "loop", creases = #[ 0 2 1.5  2 1 1.5 ]
///   displace = texture checker {}, displace_by = 0.5 mm, edge = 1 mm
///   material = white
/// }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Mesh<'a> {
    /// Corners: x y z each.
    #[param(optional, unit = "m", group = "geometry")]
    pub(crate) points: Table<'a>,
    /// Places in `points`, counted from 0: three for each triangle, counter-clockwise from outside;
    /// with `sides` as many as each face has.
    #[param(optional)]
    pub(crate) indices: Table<'a>,
    /// Shading normals: x y z for each corner, or none.
    #[param(optional)]
    pub(crate) normals: Table<'a>,
    /// Texture coordinates: u v for each corner, or none.
    #[param(optional)]
    pub(crate) uvs: Table<'a>,
    /// Colours, linear sRGB: r g b in [0, 1] for each corner, or none; see `texture vertex_color`.
    #[param(optional)]
    pub(crate) colors: Table<'a>,
    /// An OBJ or PLY file.
    #[param(optional, group = "geometry")]
    pub(crate) file: File<'a>,
    /// Length of one unit of the file; a file has to state it.
    #[param(optional, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) unit: f64,
    /// Which axis of the points is up.
    #[param(choice, default = Up::Y)]
    pub(crate) up: Up,
    /// What is done about shading normals.
    #[param(choice, default = Shading::Keep)]
    pub(crate) smooth: Shading,
    /// The number of corners of each face, 3 or more; without it all are triangles.
    #[param(optional)]
    pub(crate) sides: Table<'a>,
    /// How often faces are subdivided, before points are moved to the limit surface.
    #[param(default = 0, max = 8)]
    pub(crate) subdivide: u32,
    /// How faces are subdivided.
    #[param(choice, default = Scheme::CatmullClark)]
    pub(crate) scheme: Scheme,
    /// Edges that stay sharp while they are subdivided: two points, counted from 0 (also in files),
    /// and for how many levels; 10 is for ever.
    #[param(optional)]
    pub(crate) creases: Table<'a>,
    /// Moves the surface, after it is subdivided, along its normals: a value, or the luminance of a
    /// colour. Without texture coordinates, it is asked at (0, 0) of each point of the shape's frame.
    #[param(optional)]
    pub(crate) displace: TextureRef<'a>,
    /// How far a value of 1 moves it, outwards; `displace` has to have it.
    #[param(optional, unit = "m")]
    pub(crate) displace_by: f64,
    /// The value that leaves it where it is.
    #[param(default = 0.0)]
    pub(crate) displace_from: f64,
    /// Longest edge of a triangle that `displace` moves, before it moves; `displace` has to have it.
    #[param(optional, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) edge: f64,
    /// A second file with the same faces, whose corners those of `file` move to, evenly.
    #[param(optional)]
    pub(crate) next: File<'a>,
    /// Where `points` move to: as many.
    #[param(optional, unit = "m")]
    pub(crate) next_points: Table<'a>,
    /// When the corners are where `file` or `points` says; before that they stand.
    #[param(unit = "s", default = 0.0)]
    pub(crate) at: f64,
    /// When they are where `next` or `next_points` says; after that they stand.
    #[param(unit = "s", default = 1.0)]
    pub(crate) next_at: f64,
    #[param(shared)]
    table: Shared<'a, Arc<TriangleMesh>>,
}

impl Build<Arc<TriangleMesh>> for Mesh<'_> {
    fn build(&self, context: &dyn BuildContext) -> Result<Arc<TriangleMesh>, Vec<Fault>> {
        self.warn_of_idle(context);
        self.warn_of_idle_motion(context);
        let motion = self.motion();
        let mut mesh = self.triangles(context, motion.is_some())?;
        if let Some(field) = motion {
            mesh.later = Some(self.later(&mesh, field, context)?);
        }
        Ok(mesh.into())
    }
}

impl Mesh<'_> {
    /// The triangles with their normals; each corner on its own if they are made and `apart`.
    fn triangles(
        &self,
        context: &dyn BuildContext,
        apart: bool,
    ) -> Result<TriangleMesh, Vec<Fault>> {
        let made = self.subdivide > 0 || self.displace.is_given();
        let mut mesh = if made { self.refined(context, apart)? } else { self.plain(context)? };
        let repaired = assemble::finish(&mut mesh, self.smooth, context);
        go_on(context).map_err(stopped)?;
        if repaired > 0 {
            let path = self.file.path.get();
            let name = if path.is_empty() { "the mesh" } else { path };
            let message = format!("{name}: {repaired} unusable normals were made from the faces");
            context.warn(&message);
        }
        Ok(mesh)
    }

    /// Tells of what is given and does nothing.
    fn warn_of_idle(&self, context: &dyn BuildContext) {
        if self.subdivide == 0 && !self.creases.get().is_empty() {
            context.warn("`creases` do nothing without `subdivide`");
        }
        if !self.displace.is_given() && (self.edge > 0.0 || self.displace_by.abs() > 0.0) {
            context.warn("`displace_by` and `edge` do nothing without `displace`");
        }
    }

    /// Triangles as they were given.
    fn plain(&self, context: &dyn BuildContext) -> Result<TriangleMesh, Vec<Fault>> {
        if self.file.path.get().is_empty() {
            return inline::build(self, context);
        }
        self.read(context, ply::read, obj::read)
    }

    /// Triangles that are made of the given faces.
    fn refined(&self, context: &dyn BuildContext, apart: bool) -> Result<TriangleMesh, Vec<Fault>> {
        let faces = if self.file.path.get().is_empty() {
            inline::polygons(self, context)?
        } else {
            self.read(context, ply::polygons, obj_faces::read)?
        };
        let mut net = if self.subdivide > 0 {
            let settings = subdivide::Settings {
                levels: self.subdivide,
                scheme: self.scheme,
                creases: self.creases.get(),
            };
            let faces = faces.clean(context).map_err(stopped)?;
            subdivide::subdivide(faces, settings, context)?
        } else {
            faces.fans(context).map_err(stopped)?
        };
        let mut field = "subdivide";
        if self.displace.is_given() {
            let settings = displace::Settings {
                texture: self.displace,
                by: self.displace_by,
                from: self.displace_from,
                edge: self.edge,
            };
            field = "displace_by";
            net = displace::displace(net, settings, self.smooth, context)?;
        }
        net.into_mesh(apart, context).map_err(|message| vec![Fault::mesh(field, message)])
    }

    /// What a file holds, by what it is rather than by what it is called.
    fn read<T>(
        &self,
        context: &dyn BuildContext,
        ply: fn(&[u8], Axes, &dyn BuildContext) -> Result<T, String>,
        obj: fn(&[u8], Axes, &dyn BuildContext) -> Result<T, String>,
    ) -> Result<T, Vec<Fault>> {
        let path = self.file.path.get();
        let bytes = context.read(path).map_err(|message| vec![Fault::file("file", message)])?;
        let axes = Axes { turn: self.up.turn(), unit: self.unit };
        let found = if bytes.starts_with(b"ply") {
            ply(&bytes, axes, context)
        } else if has_extension(path, "ply") {
            let found = sniff::what(&bytes);
            Err(format!("not a PLY file, which begins with `ply`, but {found}"))
        } else if let Some(told) = stranger(&bytes) {
            Err(told)
        } else {
            obj(&bytes, axes, context)
        };
        found.map_err(|message| vec![Fault::file("file", format!("{path}: {message}"))])
    }
}

/// The fault of a mesh that is not wanted any more.
fn stopped(message: String) -> Vec<Fault> {
    vec![Fault::mesh("file", message)]
}

/// What is said of bytes that are no OBJ file, which is text and has no beginning of its own.
fn stranger(bytes: &[u8]) -> Option<String> {
    let found = sniff::what(bytes);
    let help = match found {
        "text" => return None,
        found if found.contains("glTF") => "place it as an asset: `let a = asset gltf { … }`",
        _ => "as meshes, OBJ and PLY files are read",
    };
    Some(format!("not a mesh but {found}: {help}"))
}

fn has_extension(path: &str, wanted: &str) -> bool {
    path.rsplit_once('.').is_some_and(|(_, extension)| extension.eq_ignore_ascii_case(wanted))
}

impl Shape for Mesh<'_> {
    fn check(&self) -> Result<(), Fault> {
        self.check_motion()?;
        if self.displace.is_given() && self.displace_by.abs() <= 0.0 {
            let message = "`displace` needs `displace_by`, how far a value of 1 moves, as `displace_by = 1 cm`";
            return Err(Fault::mesh("displace_by", message));
        }
        if self.displace.is_given() && self.edge <= 0.0 {
            let message = "`displace` needs `edge`, its longest triangle edge, as `edge = 2 mm`";
            return Err(Fault::mesh("edge", message));
        }
        if self.file.path.get().is_empty() || self.unit > 0.0 {
            return Ok(());
        }
        let message = "a mesh file needs `unit`, the length of one of its units, as `unit = 1 m`";
        Err(Fault { field: "unit", code: "E0415", message: message.to_owned() })
    }

    fn bounds(&self) -> Bounds3 {
        bounds_of(&self.table)
    }

    /// Nothing: the host takes the triangles over.
    fn intersect(&self, _ray: &Ray) -> Option<Hit> {
        None
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Surface {
        surface_of(&self.table, hit)
    }

    fn area(&self) -> f64 {
        area_of(&self.table)
    }

    fn mesh(&self) -> Option<Arc<TriangleMesh>> {
        Some(Arc::clone(&self.table))
    }
}

/// A mesh of these points about the centre of their bounds, without a triangle yet.
///
/// # Errors
/// A point that single precision does not reach. That it is not wanted any more.
pub(super) fn rebased<I: Iterator<Item = DVec3> + Clone>(
    points: I,
    context: &dyn BuildContext,
) -> Result<TriangleMesh, String> {
    let mesh = Axes::METRES.rebase(wanted(points, context))?;
    go_on(context)?;
    Ok(mesh)
}

/// The box around all corners.
pub(super) fn bounds_of(mesh: &TriangleMesh) -> Bounds3 {
    Bounds3::of_points(mesh.points.iter().map(|p| mesh.centre + p.as_dvec3()))
}

/// The point of triangle `hit.face` at barycentric coordinates `hit.at` of its second and third
/// corners.
pub(super) fn surface_of(mesh: &TriangleMesh, hit: &Hit) -> Surface {
    let [a, b, c] = mesh.corners(hit.face);
    let (e1, e2) = (b - a, c - a);
    let ng = e1.cross(e2).normalize_or(DVec3::Y);
    let p = a + e1 * hit.at.x + e2 * hit.at.y;
    let p_err = (a.abs() + e1.abs() + e2.abs()) * gamma64(7);
    let uv = DVec2::new(hit.at.x, hit.at.y);
    Surface { p, p_err, ng, ns: ng, uv, dp_du: e1, dp_dv: e2 }
}

/// The sum of the triangles' areas, m².
pub(super) fn area_of(mesh: &TriangleMesh) -> f64 {
    let n = u32::try_from(mesh.indices.len()).unwrap_or(u32::MAX);
    (0..n)
        .map(|i| {
            let [a, b, c] = mesh.corners(i);
            0.5 * (b - a).cross(c - a).length()
        })
        .sum()
}

#[cfg(test)]
mod tests;
