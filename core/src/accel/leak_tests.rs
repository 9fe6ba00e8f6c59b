//! No ray gets through a closed mesh.

use glam::Vec3;

use super::soup::{Arrays, Rng, icosphere};
use super::{Direction, MeshBvh, Precision, Processor, Query, Watch};

/// What promises that no ray gets through.
const WATERTIGHT: [Precision; 2] = [Precision::Standard, Precision::Exact];

impl MeshBvh {
    /// Where a ray is first stopped, at the farthest by any promise; infinite if one lets it through.
    fn stopped(&self, o: Vec3, d: Vec3) -> f64 {
        let t = |precision| {
            let hit = self.shoot_with(precision, o, d, f32::INFINITY).0;
            hit.map_or(f64::INFINITY, |hit| hit.t)
        };
        WATERTIGHT.map(t).into_iter().fold(0.0, f64::max)
    }

    fn stops(&self, o: Vec3, d: Vec3) -> bool {
        self.stopped(o, d) < f64::INFINITY
    }
}

/// Scales of the mesh, in powers of ten.
const SCALES: [i32; 9] = [-30, -9, -6, -3, 0, 3, 6, 9, 30];

/// A point of the mesh that is likely to leak: a vertex, the middle of an edge, or anywhere on one.
fn target((points, faces): &Arrays, kind: usize, rng: &mut Rng) -> Vec3 {
    let face = faces[rng.below(faces.len())];
    let (a, b) = (points[face[0] as usize], points[face[1] as usize]);
    match kind % 3 {
        0 => a,
        1 => a * 0.5 + b * 0.5,
        _ => a + (b - a) * rng.next(),
    }
}

fn scaled(level: u32, exponent: i32) -> (Arrays, f32) {
    let scale = 10f32.powi(exponent);
    (icosphere(level, scale), scale)
}

#[test]
fn no_ray_leaves_a_closed_mesh_through_an_edge_or_a_vertex() {
    for exponent in SCALES {
        let (arrays, scale) = scaled(3, exponent);
        let tree = MeshBvh::build(&arrays.0, &arrays.1).unwrap();
        let mut rng = Rng(11);
        for i in 0..4000 {
            let o = if i % 2 == 0 { Vec3::ZERO } else { rng.point() * 0.4 * scale };
            let towards = target(&arrays, i, &mut rng) - o;
            for d in [towards, towards / scale, (towards / scale).normalize()] {
                assert!(tree.stops(o, d), "leak at scale 1e{exponent}: o {o} d {d}");
            }
        }
    }
}

#[test]
fn no_ray_enters_the_far_side_without_the_near_one() {
    for exponent in SCALES {
        let (arrays, scale) = scaled(3, exponent);
        let tree = MeshBvh::build(&arrays.0, &arrays.1).unwrap();
        let mut rng = Rng(12);
        for i in 0..4000 {
            let p = target(&arrays, i, &mut rng);
            // From outside straight above the target, within 30° of its normal.
            let o = p * (1.2 + 3.0 * rng.next()) + rng.point() * 0.1 * scale;
            let t = tree.stopped(o, p - o);
            // The near side is at t = 1, the far one beyond 1.3: half a chord of at least 0.9 lies
            // behind the target, on rays of at most 3.4.
            assert!(t < 1.1, "through the near side at scale 1e{exponent}: t {t}");
        }
    }
}

#[test]
fn rays_along_the_axes_do_not_leak() {
    // Radius and axes make vertices and edges of this mesh lie in the coordinate planes.
    let (arrays, _) = scaled(3, 0);
    let tree = MeshBvh::build(&arrays.0, &arrays.1).unwrap();
    for &p in &arrays.0 {
        for d in [Vec3::X, Vec3::Y, Vec3::Z] {
            for d in [d, -d, Vec3::ZERO - d] {
                // Start on the plane through the centre, straight below or above a vertex.
                let o = p - p * d.abs();
                if o.length() < 0.99 {
                    assert!(tree.stops(o, d), "o {o} d {d}");
                }
            }
        }
    }
}

#[test]
fn far_origins_do_not_leak() {
    let (arrays, _) = scaled(3, 0);
    let tree = MeshBvh::build(&arrays.0, &arrays.1).unwrap();
    let mut rng = Rng(13);
    for i in 0..6000 {
        let p = target(&arrays, i, &mut rng) * 0.7;
        let o = rng.point() * 10f32.powi(i32::try_from(i % 6).unwrap());
        if o.length() > 2.0 {
            // The direction's rounding moves the ray at the mesh by at most u·|o|·√3 < 0.02.
            assert!(tree.stops(o, p - o), "o {o} p {p}");
        }
    }
}

#[test]
fn slivers_of_a_million_to_one_close_a_prism() {
    // A prism of 64 sides whose mantle is cut into slivers of height 1 and width 1e-6.
    let n = 2000u32;
    let ring = |z: f32| {
        (0..n).map(move |i| {
            // One face of a box is a comb of slivers, the others are plain.
            Vec3::new(1.0, (i as f32 - n as f32 / 2.0) * 1e-6, z)
        })
    };
    let points: Vec<Vec3> = ring(-1.0).chain(ring(1.0)).collect();
    let faces: Vec<[u32; 3]> =
        (0..n - 1).flat_map(|i| [[i, i + 1, n + i], [i + 1, n + i + 1, n + i]]).collect();
    let arrays = (points, faces);
    let tree = MeshBvh::build(&arrays.0, &arrays.1).unwrap();
    assert_eq!(tree.dropped(), 0);
    let mut rng = Rng(14);
    let mut shot = 0;
    for i in 0..6000 {
        let p = target(&arrays, i, &mut rng);
        // The border of the comb is an edge of one triangle only.
        if p.y.abs() < 0.9e-3 && p.z.abs() < 0.999 {
            shot += 1;
            let o = Vec3::new(0.1, 0.3, -0.2) * rng.next();
            assert!(tree.stops(o, p - o), "p {p}");
        }
    }
    assert!(shot > 1000, "{shot}");
}

#[test]
fn no_ray_leaves_a_closed_mesh_while_it_moves() {
    let (arrays, _) = scaled(3, 0);
    let to = |p: &Vec3| Vec3::new(1.3, 0.8, 1.0) * *p + Vec3::new(0.3, -0.2, 0.1);
    let last: Vec<Vec3> = arrays.0.iter().map(to).collect();
    let points = (&*arrays.0, &*last);
    let tree = MeshBvh::build_moving(points, &arrays.1, [0.0, 1.0], &Watch::default()).unwrap();
    let mut rng = Rng(15);
    for i in 0..4000 {
        let share = [0.0, 1.0, rng.next()][i % 3];
        let p = target(&arrays, i, &mut rng);
        let at = |p: Vec3| p + (to(&p) - p) * share;
        let o = at(rng.point() * 0.3);
        let direction = Direction::new((at(p) - o).as_dvec3()).unwrap();
        for (precision, processor) in
            WATERTIGHT.into_iter().flat_map(|it| Processor::all().into_iter().map(move |p| (it, p)))
        {
            let query = Query {
                o: o.as_dvec3(),
                direction: &direction,
                t_max: f64::INFINITY,
                skip: None,
                precision,
                share,
            };
            let hit = tree.intersect(processor, &query).0;
            assert!(hit.is_some(), "{precision:?}, {}: o {o} p {p} at {share}", processor.name());
        }
    }
}
