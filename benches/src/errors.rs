//! How far hits are from where they should be: against double-double arithmetic on the same rays.
//! Prints the tables of docs/accuracy.md, "Hits", and writes them there if asked to.

use std::path::Path;

use glam::{DQuat, DVec3, EulerRot};
use luxel_core::accel::{Precision, Processor};
use luxel_core::stage::{self, Stage};
use luxel_sdk::num::Ray;
use luxel_sdk::sampling::{sobol_owen_2d, uniform_sphere};
use twofloat::TwoFloat;

use crate::{document, scene};

/// Rays of each case that tell.
pub(crate) const RAYS: u32 = 20_000;

/// A shape of radius `size` about `centre`, hit by rays from `distance` radii away.
struct Case {
    rays: u32,
    size: f64,
    centre: DVec3,
    distance: f64,
}

/// The largest errors of a case's hits, in radii; of normals in radians.
#[derive(Default)]
struct Worst {
    t: f64,
    /// Between the point and the surface.
    off: f64,
    /// The same in parts of the bound that comes with the point.
    bound: f64,
    normal: f64,
    missed: u32,
}

/// Prints the curves: each column one case; and writes them into a document.
///
/// # Errors
/// If a scene of this program does not build; if the document has no place for them.
pub(crate) fn run(path: Option<&Path>, rays: u32) -> Result<(), String> {
    let tables = tables(rays)?;
    println!("{tables}");
    path.map_or(Ok(()), |path| document::write(path, "errors", &tables))
}

fn tables(rays: u32) -> Result<String, String> {
    let mut out = vec![];
    let powers = |exponents: &[i32]| exponents.iter().map(|e| 10f64.powi(*e)).collect::<Vec<_>>();
    let at =
        |size, away, distance| Case { rays, size, centre: DVec3::new(away, -away, away), distance };
    let distances = powers(&[0, 1, 2, 3, 4, 5, 6, 7]).into_iter();
    table(
        &mut out,
        "distance of the origin, radii",
        distances.map(|d| (d, at(1.0, 0.0, d + 1.0))),
    )?;
    let away = powers(&[0, 1, 2, 3, 4, 5, 6, 7]).into_iter();
    table(&mut out, "distance from the world's origin, radii", away.map(|a| (a, at(1.0, a, 4.0))))?;
    let sizes = powers(&[-9, -6, -3, 0, 3, 6, 9]).into_iter();
    table(
        &mut out,
        "radius, metres, 3 radii from the world's origin",
        sizes.map(|s| (s, at(s, 3.0 * s, 4.0))),
    )?;
    Ok(out.concat())
}

fn table(
    out: &mut Vec<String>,
    title: &str,
    cases: impl Iterator<Item = (f64, Case)>,
) -> Result<(), String> {
    let cases: Vec<(f64, Case)> = cases.collect();
    let heads: Vec<String> = cases.iter().map(|(x, _)| format!("{x:.0e}")).collect();
    let line = "---|".repeat(cases.len());
    out.push(format!("\n| {title} | {} |\n|---|{line}\n", heads.join(" | ")));
    let shapes = [
        ("sphere", None),
        ("mesh, fast", Some(Precision::Fast)),
        ("mesh, standard", Some(Precision::Standard)),
        ("mesh, exact", Some(Precision::Exact)),
    ];
    for (name, precision) in shapes {
        let found: Result<Vec<Worst>, String> =
            cases.iter().map(|(_, case)| worst(case, precision)).collect();
        let found = found?;
        let mut row = |what: &str, of: &dyn Fn(&Worst) -> f64| {
            let cells: Vec<String> =
                found.iter().map(|worst| format!("{:.0e}", of(worst))).collect();
            out.push(format!("| {name}: {what} | {} |\n", cells.join(" | ")));
        };
        row("t", &|worst| worst.t);
        row("off the surface", &|worst| worst.off);
        row("in parts of its bound", &|worst| worst.bound);
        row("normal", &|worst| worst.normal);
        let missed: u32 = found.iter().map(|worst| worst.missed).sum();
        if missed > 0 {
            return Err(format!("{title}: {missed} rays at the {name} missed it"));
        }
    }
    Ok(())
}

fn worst(case: &Case, precision: Option<Precision>) -> Result<Worst, String> {
    let text = if precision.is_some() { octahedron(case) } else { sphere(case) };
    let stage = stage_of(&text, precision.unwrap_or_default())?;
    let mut worst = Worst::default();
    for i in 0..case.rays {
        let [from, to] = [1, 2].map(|k| uniform_sphere(sobol_owen_2d(i, k)).as_dvec3());
        let o = case.centre + from * (case.distance * case.size);
        // Into the ball that even an octahedron holds.
        let d = (case.centre + to * (0.5 * case.size) - o).normalize();
        let ray = Ray { o, d, t_max: f64::INFINITY };
        let Some(hit) = stage.opening().intersect(Processor::widest(), &ray, None, &mut 0) else {
            worst.missed += 1;
            continue;
        };
        let surface = stage.opening().surface(&ray, &hit);
        let truth = if precision.is_some() {
            let stage::Geometry::Mesh(mesh) = &*stage.geometries[0] else {
                unreachable!("the scene holds a mesh alone")
            };
            of_plane(mesh, &ray, hit.hit.face, surface.p)
        } else {
            of_sphere(case, &ray, surface.p)
        };
        worst.t = worst.t.max((truth.t - TwoFloat::from(hit.hit.t)).abs().into());
        let off = f64::from(truth.off.abs());
        worst.off = worst.off.max(off);
        worst.bound = worst.bound.max(off / surface.ng.abs().dot(surface.p_err));
        worst.normal = worst.normal.max((surface.ng - truth.normal).length());
    }
    worst.t /= case.size;
    worst.off /= case.size;
    Ok(worst)
}

fn sphere(case: &Case) -> String {
    let Case { size, centre: c, .. } = case;
    format!("shape sphere {{ center = ({:?}, {:?}, {:?}) m, radius = {size:?} m }}", c.x, c.y, c.z)
}

/// Leaning, so that no coordinate is a round number, and written where it stands: its middle is kept in
/// double precision, the rest in single.
fn octahedron(case: &Case) -> String {
    let lean = DQuat::from_euler(EulerRot::XYZ, 0.3, 0.5, 0.7);
    let corners = [DVec3::X, -DVec3::X, DVec3::Y, -DVec3::Y, DVec3::Z, -DVec3::Z];
    let points = corners.map(|corner| {
        let p = case.centre + lean * (corner * case.size);
        format!("{:?} {:?} {:?}", p.x, p.y, p.z)
    });
    let points = points.join("  ");
    format!(
        "shape mesh {{ points = #[ {points} ] m, indices = #[ 0 2 4  2 1 4  1 3 4  3 0 4
            2 0 5  1 2 5  3 1 5  0 3 5 ] }}"
    )
}

fn stage_of(shape: &str, precision: Precision) -> Result<Stage, String> {
    let text = format!(
        "scene 1\ncamera perspective {{ look = look_at(from = (0, 0, 4) m, to = (0, 0, 0) m,
            up = (0, 1, 0)), fov = 40 deg }}\n\
         film rgb {{ resolution = (8, 8), precision = \"{}\" }}\n{shape}\n",
        precision.word()
    );
    scene::stage_of(&scene::linked(), &text)
}

/// Three numbers of twice the digits.
#[derive(Clone, Copy)]
struct Wide([TwoFloat; 3]);

impl Wide {
    fn of(v: DVec3) -> Self {
        Self(v.to_array().map(TwoFloat::from))
    }

    fn zip(self, other: Self, f: impl Fn(TwoFloat, TwoFloat) -> TwoFloat) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    fn minus(self, other: Self) -> Self {
        self.zip(other, |a, b| a - b)
    }

    fn dot(self, other: Self) -> TwoFloat {
        let [x, y, z] = self.zip(other, |a, b| a * b).0;
        x + y + z
    }

    fn cross(self, other: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, other.0);
        Self([b * z - c * y, c * x - a * z, a * y - b * x])
    }

    fn narrow(self) -> DVec3 {
        DVec3::from_array(self.0.map(f64::from))
    }
}

/// Where a ray meets the surface, and how far the point that was found lies off it.
struct Truth {
    t: TwoFloat,
    off: TwoFloat,
    normal: DVec3,
}

fn of_sphere(case: &Case, ray: &Ray, p: DVec3) -> Truth {
    let (o, d) = (Wide::of(ray.o).minus(Wide::of(case.centre)), Wide::of(ray.d));
    let r = TwoFloat::from(case.size);
    let (a, half_b) = (d.dot(d), TwoFloat::from(0.0) - o.dot(d));
    let c = o.dot(o) - r * r;
    let root = (half_b * half_b - a * c).sqrt();
    let t = c / (half_b + root);
    let at = Wide::of(p).minus(Wide::of(case.centre));
    let scaled = Wide(std::array::from_fn(|i| o.0[i] + d.0[i] * t));
    Truth { t, off: at.dot(at).sqrt() - r, normal: scaled.narrow().normalize() }
}

/// Where a ray meets the plane of a triangle, behind its origin as well.
pub(crate) fn true_t(mesh: &stage::Mesh, ray: &Ray, face: u32) -> f64 {
    of_plane(mesh, ray, face, ray.o).t.into()
}

fn of_plane(mesh: &stage::Mesh, ray: &Ray, face: u32, p: DVec3) -> Truth {
    let triangles = mesh.triangles();
    let corner = |i: usize| {
        let about = triangles.points[triangles.indices[face as usize][i] as usize].as_dvec3();
        Wide::of(about).zip(Wide::of(triangles.centre), |a, b| a + b)
    };
    let [a, b, c] = [corner(0), corner(1), corner(2)];
    let n = b.minus(a).cross(c.minus(a));
    let t = a.minus(Wide::of(ray.o)).dot(n) / Wide::of(ray.d).dot(n);
    let off = Wide::of(p).minus(a).dot(n) / n.dot(n).sqrt();
    Truth { t, off, normal: n.narrow().normalize() }
}
