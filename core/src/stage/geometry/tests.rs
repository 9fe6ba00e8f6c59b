//! Rays that leave a mesh do not meet it where they leave it: neither the triangle that they leave, which
//! is passed, nor one in the same plane or behind them, by whatever rounding.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec3};
use luxel_sdk::kind::{Hit, TriangleMesh};
use luxel_sdk::num::{Ray, offset_origin};
use luxel_sdk::sampling::Rng;

use super::{Approach, Mesh};
use crate::accel::{Direction, Precision, Processor, Watch};

/// Rays per triangle.
const N: u32 = 20_000;

/// A direction on either side of `ng`, also close to the surface.
fn direction(rng: &mut Rng, ng: DVec3) -> DVec3 {
    let [u, v] = rng.pair();
    let d = luxel_sdk::sampling::uniform_sphere([u, v]).as_dvec3().normalize();
    let height = d.dot(ng) * if rng.f32() < 0.5 { 1.0 } else { 1e-2 };
    (d - ng * d.dot(ng) + ng * height).normalize()
}

fn built(points: &[DVec3], indices: Vec<[u32; 3]>) -> Mesh {
    let triangles = Arc::new(TriangleMesh::rebased(points, indices));
    Mesh::build(triangles, [0.0; 2], &Watch::default()).unwrap()
}

/// A parallelogram of two triangles, by three of its corners.
fn mesh_of([a, b, c]: [DVec3; 3]) -> Mesh {
    built(&[a, b, c, a + c - b], vec![[0, 1, 2], [0, 2, 3]])
}

/// The ray that leaves a triangle at a place in a direction, as a stage offsets it, and what it meets.
fn leave(
    mesh: &Mesh,
    (face, at): (u32, DVec2),
    precision: Precision,
    rng: &mut Rng,
) -> (Ray, Option<Hit>) {
    let surface = mesh.surface(face, at, precision, 0.0);
    let d = direction(rng, surface.ng);
    let o = offset_origin(surface.p, surface.p_err, surface.ng, d);
    let ray = Ray { o, d, t_max: f64::INFINITY };
    let direction = Direction::new(d).unwrap();
    let approach = Approach {
        processor: Processor::ANY,
        precision,
        direction: Some(&direction),
        t_enter: 0.0,
        from: Some(face),
        time: 0.0,
    };
    (ray, mesh.intersect(&ray, approach, &mut 0))
}

/// Anywhere on a triangle.
fn anywhere(rng: &mut Rng) -> DVec2 {
    let [u, v] = rng.pair();
    let [_, b, c] = luxel_sdk::sampling::uniform_triangle([u, v]).map(f64::from);
    DVec2::new(b, c)
}

/// A closed ball of radius 1 whose points are rounded to sixteenths, a million metres out: its
/// triangles lie in few planes, on each other and across each other.
fn rounded_ball() -> Mesh {
    const RINGS: u32 = 200;
    let centre = DVec3::new(1e6, -1e6, 1e6);
    let point = |ring: u32, side: u32| {
        let (polar, turn) =
            (PI * f64::from(ring) / f64::from(RINGS), TAU * f64::from(side) / f64::from(RINGS));
        let p = DVec3::new(polar.sin() * turn.cos(), polar.sin() * turn.sin(), polar.cos());
        centre + (p * 16.0).round() / 16.0
    };
    let points: Vec<_> =
        (0..=RINGS).flat_map(|ring| (0..RINGS).map(move |side| point(ring, side))).collect();
    let quad = |ring: u32, side: u32| {
        let (a, b) = (ring * RINGS + side, ring * RINGS + (side + 1) % RINGS);
        [[a, a + RINGS, b + RINGS], [a, b + RINGS, b]]
    };
    let indices = (0..RINGS).flat_map(|ring| (0..RINGS).flat_map(move |side| quad(ring, side)));
    built(&points, indices.collect())
}

#[test]
fn rays_from_a_mesh_as_fine_as_its_numbers_meet_nothing_behind_them() {
    let (mesh, mut rng) = (rounded_ball(), Rng::new(8));
    let n_faces = u32::try_from(mesh.triangles.indices.len()).unwrap();
    let is_flat = |face: u32| {
        let [a, b, c] = mesh.opening_corners(face);
        (b - a).cross(c - a) == DVec3::ZERO
    };
    for precision in [Precision::Standard, Precision::Exact] {
        for i in 0..N {
            let face = rng.u32() % n_faces;
            if is_flat(face) {
                continue;
            }
            let at = if i % 2 == 0 { DVec2::ZERO } else { anywhere(&mut rng) };
            let (ray, hit) = leave(&mesh, (face, at), precision, &mut rng);
            let Some(hit) = hit else { continue };
            // Corners are sixteenths, so that only the products with `d` round.
            let [a, b, c] = mesh.opening_corners(hit.face);
            let n = (b - a).cross(c - a);
            let ahead = n.dot(a - ray.o) * n.dot(ray.d) > 0.0;
            assert!(hit.face != face && ahead, "{face} {at} {precision:?}: {hit:?}");
        }
    }
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
                let at = anywhere(&mut rng);
                hits += u32::from(leave(&mesh, (0, at), precision, &mut rng).1.is_some());
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
