//! Blended solids: what a ray meets, against every sign along it.

use super::*;
use crate::shape::capsule::tests::capsule;
use crate::shape::gyroid_wall::GyroidWall;
use crate::shape::testing::check_turning;
use crate::shape::torus::tests::torus;

#[test]
fn no_ray_along_a_slab_passes_a_fin() {
    let slab = Box { center: DVec3::Y * -0.1, size: DVec3::new(2.0, 0.2, 2.0) };
    let mut rng = Rng::new(191);
    for thick in [1e-6, 1e-4, 5e-3, 2e-2] {
        let fin = Box { center: DVec3::Y * 5e-3, size: DVec3::new(thick, 2e-2, 1.0) };
        let sharp = pair(Op::Union, &slab, &fin, 0.0);
        for smooth in [1e-6, 1e-4, 1e-3, 3e-2, 1.0] {
            let solid = pair(Op::Union, &slab, &fin, smooth);
            for height in [1e-9, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2] {
                for _ in 0..4 {
                    let o = DVec3::new(-3.0, height, 0.8 * rng.f64() - 0.4);
                    let tilt = DVec3::new(1.0, -0.1 * height * rng.f64(), 1e-3 * rng.f64());
                    let ray = Ray::new(o, tilt);
                    let first = sharp.intersect(&ray).unwrap().t;
                    assert!((first - 3.0).abs() <= 0.51 * thick + 1e-12, "the fin's side: {first}");
                    let met = solid.intersect(&ray).unwrap_or_else(|| {
                        panic!("{thick} m are passed {height} m above, blended over {smooth} m")
                    });
                    assert!(met.t <= first + 1e-12, "{thick} {height} {smooth}: {met:?} {first}");
                    // Where the blend does not reach, the fin is the sharp one.
                    let off = (met.t - first).abs();
                    assert!(height < 1.2 * smooth || off <= 1e-12, "{thick} {height} {smooth}");
                }
            }
        }
    }
}

/// The first hit against the signs of f at four hundred places: all before it are that of the origin,
/// and behind it there is the other one. Values below `blur` have none.
fn check_first(shape: &dyn Shape, ray: &Ray, blur: f64) -> usize {
    const PLACES: u32 = 400;
    let f = |t: f64| shape.distance(ray.at(t)).unwrap();
    let (size, outside) = (shape.bounds().diagonal().length(), f(0.0) > 0.0);
    let turned = |t: f64| f(t).abs() > blur && (f(t) > 0.0) != outside;
    let hit = shape.intersect(ray);
    let end = hit.map_or(4.0 * size, |hit| hit.t);
    for i in 0..PLACES {
        let t = end * f64::from(i) / f64::from(PLACES);
        assert!(!turned(t), "{ray:?}: {hit:?}, but {} at {t}", f(t));
    }
    let Some(hit) = hit else { return 0 };
    // What crawls for too long is said to meet what it crawls along.
    let off = f(hit.t).abs();
    assert!(off <= size / 32768.0, "{ray:?}: {off} at {hit:?}");
    usize::from(off <= blur)
}

/// Rays of all directions, along the axes, and along the surface: a little above and below it.
fn check_rays(shape: &dyn Shape, seed: u64) -> usize {
    let mut rng = Rng::new(seed);
    let bounds = shape.bounds();
    let (centre, size) = (bounds.centre(), bounds.diagonal().length());
    let blur = 1e-13 * (size + bounds.max.abs().max_element());
    let mut n_hits = 0;
    for i in 0..18 {
        let d = if i % 3 == 0 { DVec3::AXES[i / 3 % 3] } else { direction(&mut rng) };
        let ray = Ray::new(centre + direction(&mut rng) * (0.3 * size) - d * size, d);
        n_hits += check_first(shape, &ray, blur);
        let Some(hit) = shape.intersect(&ray) else { continue };
        let s = shape.surface(&ray, &hit);
        let (x, y) = s.ng.any_orthonormal_pair();
        let turn = TAU * rng.f64();
        for height in [1e-3, 1e-5, -1e-4] {
            let along = x * turn.cos() + y * turn.sin();
            n_hits += check_first(shape, &Ray::new(s.p + s.ng * (height * size), along), blur);
        }
    }
    n_hits
}

#[test]
fn blended_solids_are_met_where_their_sign_changes_first() {
    let mut rng = Rng::new(192);
    let mut n_hits = 0;
    for i in 0..20 {
        let mut any = |least: f64| least + rng.f64();
        let block = Box { center: DVec3::ZERO, size: DVec3::new(any(0.1), any(0.1), any(0.1)) };
        let thin = Box { center: DVec3::X * 0.2, size: DVec3::new(1e-3, any(0.2), any(0.2)) };
        let ball = ball(any(-0.5), any(-0.5), any(0.2));
        let center = DVec3::new(any(-0.5), 0.1, 0.2);
        let (ring, rod) = (torus(center, any(0.2), 0.1), capsule(center, 0.1, any(0.1)));
        let shapes = [
            ShapeRef::new(&block),
            ShapeRef::new(&thin),
            ShapeRef::new(&ball),
            ShapeRef::new(&ring),
            ShapeRef::new(&rod),
        ];
        let (a, b) = (shapes[i % 5], shapes[(i + 1 + i / 5 % 4) % 5]);
        for (op, k) in [(OPS[i % 3], 0.02), (OPS[i % 3], 0.3), (Op::Union, 1e-3)] {
            if Pair::check(op, &a, &b, k).is_err() {
                continue;
            }
            let bounds = Pair::found_bounds(op, &a, &b, k);
            let whole = Solid(Pair { op, a, b, smooth: k, bounds, plain: [1; 2] });
            n_hits += check_rays(&whole, 193);
            // As a part of another one.
            n_hits += check_rays(&pair(Op::Union, &whole, &thin, 0.05), 194);
        }
    }
    assert!(n_hits > 1500, "{n_hits}");
}

#[test]
fn a_gyroid_is_met_where_its_sign_changes_first() {
    let area = OnceLock::new();
    for (cell, thickness) in [(0.3, 1e-4), (0.5, 0.03), (1.0, 0.4)] {
        let area = Shared::new(&area);
        let wall = GyroidWall { center: DVec3::ZERO, radius: 1.0, cell, thickness, area };
        let n_hits = check_rays(&wall, 195);
        assert!(n_hits > 10, "{n_hits}");
        let block = Box { center: DVec3::X * 0.7, size: DVec3::splat(0.9) };
        check_rays(&pair(Op::Intersection, &wall, &block, 0.05), 196);
    }
}

#[test]
fn normals_of_solids_turn_as_those_beside_them() {
    let (a, b) = (ball(-0.3, 0.1, 0.7), torus(DVec3::X * 0.3, 0.6, 0.2));
    for op in OPS {
        let (sharp, blended) = (pair(op, &a, &b, 0.0), pair(op, &a, &b, 0.2));
        let n = (check_turning(&sharp, 197, 0.0), check_turning(&blended, 198, 1e-9));
        assert!(n.0 > 100 && n.1 > 100, "{op:?}: {n:?}");
        assert!(check_turning(&pair(Op::Union, &sharp, &blended, 0.0), 199, 1e-9) > 100);
    }
    let area = OnceLock::new();
    let area = Shared::new(&area);
    let wall = GyroidWall { center: DVec3::ONE, radius: 1.0, cell: 0.6, thickness: 0.05, area };
    assert!(check_turning(&wall, 200, 0.0) > 300);
}

#[test]
fn a_ball_in_a_blend_that_does_not_reach_it_is_as_round_as_alone() {
    let (a, b) = (ball(0.0, 0.0, 2.0), ball(3.0, 0.0, 0.5));
    for smooth in [0.0, 0.3] {
        let solid = pair(Op::Union, &a, &b, smooth);
        let ray = Ray::new(DVec3::new(-9.0, 0.2, 0.3), DVec3::X);
        let hit = solid.intersect(&ray).unwrap();
        let s = solid.surface(&ray, &hit);
        let turns = solid.normal_derivatives(&hit, &s).unwrap();
        // Of a sphere of radius r each tangent turns by 1/r of itself; second differences over a
        // two-hundredth of the size leave a few times its fourth power.
        for (dn, dp) in [(turns.dn_du, s.dp_du), (turns.dn_dv, s.dp_dv)] {
            assert!((dn - 0.5 * dp).length() <= 1e-6 * dp.length(), "{smooth}: {dn} {dp}");
        }
    }
}
