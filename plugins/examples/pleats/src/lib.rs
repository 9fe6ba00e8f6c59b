//! A procedural shape that hands its triangles over, as a plugin: a pleated curtain.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec2};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, Shape, ShapeSample, Surface, TriangleMesh};
use luxel_sdk::num::{Bounds3, Ray};
use luxel_sdk::params::{Build, BuildContext, Fault, Shared};

/// A curtain that hangs in soft folds from the line y = 0, its middle at the origin. Its texture
/// coordinates run along the cloth: `u` from left to right, `v` from the hem up.
///
/// ```scene
/// shape pleats { width = 2 m, height = 2.5 m, depth = 12 cm, folds = 9, material = white }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub struct Pleats<'a> {
    /// From side to side.
    #[param(default = 1.0, unit = "m", min = 1e-6, max = 1e6)]
    width: f64,
    /// From the line down to the hem.
    #[param(default = 1.0, unit = "m", min = 1e-6, max = 1e6)]
    height: f64,
    /// From the front of the folds to their back, at the hem; the line is straight.
    #[param(default = 0.1, unit = "m", min = 0, max = 1e6)]
    depth: f64,
    /// How many folds there are.
    #[param(default = 8, min = 1, max = 1000)]
    folds: u32,
    #[param(shared)]
    mesh: Shared<'a, Arc<TriangleMesh>>,
}

/// Columns of each fold, and rows: a fold is round to a three-hundredth of its depth.
const COLUMNS: u32 = 24;
const ROWS: u32 = 24;

impl Build<Arc<TriangleMesh>> for Pleats<'_> {
    fn build(&self, _: &dyn BuildContext) -> Result<Arc<TriangleMesh>, Vec<Fault>> {
        let columns = self.folds * COLUMNS;
        let grid = |n: u32| move |i: u32| f64::from(i) / f64::from(n);
        let places: Vec<(f64, f64)> = (0..=ROWS)
            .flat_map(|row| {
                (0..=columns).map(move |column| (grid(columns)(column), grid(ROWS)(row)))
            })
            .collect();
        let points: Vec<DVec3> = places.iter().map(|(u, v)| self.point(*u, *v)).collect();
        let at = |row: u32, column: u32| row * (columns + 1) + column;
        let mut indices = vec![];
        for row in 0..ROWS {
            for column in 0..columns {
                let [a, b] = [at(row, column), at(row, column + 1)];
                let [c, d] = [at(row + 1, column), at(row + 1, column + 1)];
                indices.extend([[a, b, d], [a, d, c]]);
            }
        }
        let normals = places.iter().map(|(u, v)| self.normal(*u, *v).as_vec3()).collect();
        let uvs = places.iter().map(|(u, v)| DVec2::new(*u, *v).as_vec2()).collect::<Vec<Vec2>>();
        Ok(Arc::new(TriangleMesh { normals, uvs, ..TriangleMesh::rebased(&points, indices) }))
    }
}

impl Pleats<'_> {
    /// How far the cloth is in front, and how that changes along u: folds open towards the hem.
    fn front(&self, u: f64, v: f64) -> (f64, f64) {
        let (turns, open) = (TAU * f64::from(self.folds), 0.5 * self.depth * (1.0 - v));
        (open * (turns * u).sin(), open * turns * (turns * u).cos())
    }

    fn point(&self, u: f64, v: f64) -> DVec3 {
        DVec3::new((u - 0.5) * self.width, (v - 1.0) * self.height, self.front(u, v).0)
    }

    fn normal(&self, u: f64, v: f64) -> DVec3 {
        let turns = TAU * f64::from(self.folds);
        let along_u = DVec3::new(self.width, 0.0, self.front(u, v).1);
        let along_v = DVec3::new(0.0, self.height, -0.5 * self.depth * (turns * u).sin());
        along_u.cross(along_v).normalize()
    }
}

impl Shape for Pleats<'_> {
    fn bounds(&self) -> Bounds3 {
        let mesh = &**self.mesh;
        Bounds3::of_points(mesh.points.iter().map(|p| mesh.centre + p.as_dvec3()))
    }

    fn mesh(&self) -> Option<Arc<TriangleMesh>> {
        Some(Arc::clone(&self.mesh))
    }

    // The host takes the triangles over and never asks for the rest.
    fn intersect(&self, _: &Ray) -> Option<Hit> {
        None
    }

    fn surface(&self, _: &Ray, _: &Hit) -> Surface {
        let (p, ng) = (DVec3::ZERO, DVec3::Z);
        Surface { p, p_err: p, ng, ns: ng, uv: DVec2::ZERO, dp_du: DVec3::X, dp_dv: DVec3::Y }
    }

    fn area(&self) -> f64 {
        0.0
    }

    fn sample(&self, _: Option<DVec3>, _: [f32; 2]) -> Option<ShapeSample> {
        None
    }

    fn pdf(&self, _: Option<DVec3>, _: &Surface) -> f64 {
        0.0
    }
}

luxel_sdk::plugin! { shape "pleats" => Pleats<'_>; }
