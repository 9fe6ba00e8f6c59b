//! Rays that leave a flat mesh do not meet it again: neither the triangle that they leave, which is
//! passed, nor its neighbour in the same plane, which only the offset of the origin keeps away.

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::{Hit, Kind, Shape, ShapeSample, Surface, TriangleMesh};
use luxel_sdk::num::{Bounds3, Ray, offset_origin};
use luxel_sdk::params::{Build, BuildContext, Fault, Shared, Table};
use luxel_sdk::sampling::Rng;

use super::{Approach, Mesh};
use crate::accel::{Direction, Precision, Processor};
use crate::diag::{SourceId, Span};
use crate::files::MemoryFiles;
use crate::object::{Builder, ColorMode, Objects};
use crate::registry::Registry;
use crate::scene::{Argument, Node, Scene, Value};

/// Rays per triangle.
const N: u32 = 20_000;

/// A direction on either side of `ng`, also close to the surface.
fn direction(rng: &mut Rng, ng: DVec3) -> DVec3 {
    let [u, v] = rng.pair();
    let d = luxel_sdk::sampling::uniform_sphere([u, v]).as_dvec3().normalize();
    let height = d.dot(ng) * if rng.f32() < 0.5 { 1.0 } else { 1e-2 };
    (d - ng * d.dot(ng) + ng * height).normalize()
}

/// A parallelogram of two triangles: three of its corners are in the table.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Triangle<'a> {
    /// Nine numbers.
    #[param(required)]
    points: Table<'a>,
    #[param(shared)]
    mesh: Shared<'a, Arc<TriangleMesh>>,
}

impl Build<Arc<TriangleMesh>> for Triangle<'_> {
    fn build(&self, _: &dyn BuildContext) -> Result<Arc<TriangleMesh>, Vec<Fault>> {
        let mut points: Vec<_> = self.points.get().chunks(3).map(DVec3::from_slice).collect();
        points.push(points[0] + points[2] - points[1]);
        Ok(TriangleMesh::rebased(&points, vec![[0, 1, 2], [0, 2, 3]]).into())
    }
}

impl Shape for Triangle<'_> {
    fn bounds(&self) -> Bounds3 {
        Bounds3::ALL
    }
    fn intersect(&self, _: &Ray) -> Option<Hit> {
        None
    }
    fn surface(&self, _: &Ray, _: &Hit) -> Surface {
        unreachable!("the host takes the mesh over")
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
    fn mesh(&self) -> Option<Arc<TriangleMesh>> {
        Some(Arc::clone(&self.mesh))
    }
}

fn mesh_of(corners: [DVec3; 3]) -> Mesh {
    let mut registry = Registry::default();
    registry.add("test", &[Class::shape::<Triangle<'_>>("triangle")]).unwrap();
    let mut scene = Scene::default();
    let span = Span::new(SourceId(0), 0, 0);
    let table: Vec<f64> = corners.iter().flat_map(DVec3::to_array).collect();
    let points = Argument { name: "points", value: Value::Table(table.into()), span };
    let id = scene.add(Node {
        kind: Kind::Shape,
        class: "triangle".into(),
        label: None,
        params: vec![points],
        overrides: vec![],
        span,
        hash: [0; 32],
    });
    let (files, before) = (MemoryFiles::default(), Objects::default());
    let object =
        Builder::new(&registry, &scene, &files, ColorMode::Rgb, &before).build(id).unwrap();
    let mesh = object.fixed().shape().mesh().unwrap();
    Mesh::build(mesh, [0.0; 2]).unwrap()
}

#[test]
fn rays_from_a_flat_quad_do_not_meet_it_whatever_its_place_and_shape() {
    let mut rng = Rng::new(7);
    let triangles = [
        // A wall in a coordinate plane, in the middle of the mesh and far from it.
        [DVec3::ZERO, DVec3::new(0.0, 0.5, 0.0), DVec3::new(0.0, 0.5, 0.6)],
        [DVec3::new(3.0, 0.0, 0.0), DVec3::new(3.0, 0.5, 0.0), DVec3::new(3.0, 0.5, 0.6)],
        // Anywhere.
        [DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.9, -0.4, 0.5), DVec3::new(-0.7, 0.3, 0.8)],
        // Long and thin.
        [DVec3::ZERO, DVec3::new(1.0, 1e-3, 0.0), DVec3::new(0.5, 1e-3, 1e-3)],
    ];
    for (index, corners) in triangles.iter().enumerate() {
        let promises = [Precision::Standard, Precision::Exact];
        for (scale, precision) in
            [1e-3, 1.0, 1e3].into_iter().flat_map(|scale| promises.map(|p| (scale, p)))
        {
            let corners = corners.map(|p| p * scale);
            let mesh = mesh_of(corners);
            let mut hits = 0;
            for _ in 0..N {
                let [u, v] = rng.pair();
                let at = luxel_sdk::sampling::uniform_triangle([u, v]);
                let at = DVec2::new(f64::from(at[1]), f64::from(at[2]));
                let surface = mesh.surface(0, at, precision, 0.0);
                let d = direction(&mut rng, surface.ng);
                let o = offset_origin(surface.p, surface.p_err, surface.ng, d);
                let ray = Ray { o, d, t_max: f64::INFINITY };
                let direction = Direction::new(d).unwrap();
                let approach = Approach {
                    processor: Processor::ANY,
                    precision,
                    direction: Some(&direction),
                    t_enter: 0.0,
                    from: Some(0),
                    time: 0.0,
                };
                hits += u32::from(mesh.intersect(&ray, approach, &mut 0).is_some());
            }
            assert_eq!(hits, 0, "triangle {index} at scale {scale}, {precision:?}");
        }
    }
}

#[test]
fn colours_are_interpolated_between_corners() {
    let bare = mesh_of([DVec3::ZERO, DVec3::X, DVec3::Y]);
    assert!(bare.color(0, DVec2::splat(0.25)).is_none());
    // Four corners, of which the second triangle takes the first, third and fourth.
    let colors = vec![Vec3::X, Vec3::Y, Vec3::Z, Vec3::ONE];
    let triangles = TriangleMesh { colors, ..bare.triangles().clone() };
    let mesh = Mesh { triangles: Arc::new(triangles), ..bare };
    assert_eq!(mesh.color(0, DVec2::new(0.25, 0.5)), Some(Vec3::new(0.25, 0.25, 0.5)));
    assert_eq!(mesh.color(1, DVec2::new(0.25, 0.5)), Some(Vec3::new(0.75, 0.5, 0.75)));
}
