//! Round strands.

use std::f64::consts::TAU;

use glam::{DVec3, DVec4, Vec4Swizzles as _};
use luxel_sdk::kind::{Shape as _, Surface};
use luxel_sdk::num::{Ray, offset_origin, sphere_roots};
use luxel_sdk::sampling::Rng;

use super::super::cubic::eval;
use super::super::{Curves, Strand};
use super::{Given, troubles};
use crate::shape::testing::direction;

/// Signed distance from a rod: the least over balls along it, by a fine table and golden sections.
fn distance(strand: &Strand, p: DVec3) -> f64 {
    const STEPS: u32 = 64;
    let p = (p - strand.centre) / strand.unit;
    let gap = |curve: &[DVec4; 4], s: f64| {
        let c = eval(curve, s).0;
        (p - c.xyz()).length() - c.w
    };
    let mut least = f64::INFINITY;
    for segment in &strand.segments {
        let at = |i: u32| gap(&segment.curve, f64::from(i) / f64::from(STEPS));
        let all: Vec<f64> = (0..=STEPS).map(at).collect();
        for i in 0..=STEPS {
            let here = all[i as usize];
            least = least.min(here);
            let (low, high) = (i.saturating_sub(1), (i + 1).min(STEPS));
            if here > all[low as usize] || here > all[high as usize] {
                continue;
            }
            let (mut a, mut b) = (f64::from(low), f64::from(high));
            for _ in 0..50 {
                let (x, y) = (b - 0.618_033_988 * (b - a), a + 0.618_033_988 * (b - a));
                let value = |x: f64| gap(&segment.curve, x / f64::from(STEPS));
                if value(x) < value(y) { b = y } else { a = x }
            }
            least = least.min(gap(&segment.curve, 0.5 * (a + b) / f64::from(STEPS)));
        }
    }
    least * strand.unit
}

/// Steps of a ray as long as its distance from the surface, inside and outside. `Ok` of where it
/// meets the surface, if it does; `Err` where it runs along it for too long to tell. `d` is unit.
fn march(o: DVec3, d: DVec3, size: f64, gap: impl Fn(DVec3) -> f64) -> Result<Option<f64>, ()> {
    let (mut t, inside) = (0.0, gap(o) < 0.0);
    for _ in 0..3000 {
        let here = gap(o + d * t);
        let here = if inside { -here } else { here };
        if here <= 1e-14 * size {
            return Ok(Some(t));
        }
        t += here;
        if t > 8.0 * size {
            return Ok(None);
        }
    }
    Err(())
}

#[test]
fn hits_of_rods_are_those_of_marching_rays() {
    for (k, (name, given)) in (0..).zip(troubles()) {
        given.ask(|curves| {
            let strand = &curves.table.strands[0];
            let b = curves.bounds();
            let size = b.diagonal().length();
            let (mut rng, mut n_hits, mut unknown) = (Rng::new(700 + k), 0, 0);
            let mut i = 0;
            while i < 60 {
                let segment = &strand.segments[i % strand.segments.len()];
                let c = eval(&segment.curve, rng.f64()).0;
                let near = direction(&mut rng) * (c.w * 1.1 * rng.f64());
                let target = strand.centre + (c.xyz() + near) * strand.unit;
                let d = if i % 7 == 0 { DVec3::AXES[i / 7 % 3] } else { direction(&mut rng) };
                let o = if i % 3 == 0 { target } else { target - d * (1.5 * size * rng.f64()) };
                i += 1;
                if distance(strand, o).abs() < 1e-9 * size {
                    continue;
                }
                let hit = curves.intersect(&Ray::new(o, d));
                let Ok(truth) = march(o, d, size, |p| distance(strand, p)) else {
                    unknown += 1;
                    continue;
                };
                let (Some(t), Some(hit)) = (truth, hit) else {
                    // A miss by less than marching tells.
                    let grazes = |t: f64| distance(strand, o + d * t) > -1e-12 * size;
                    let tiny = truth.is_none() && hit.is_none();
                    assert!(
                        tiny || truth.is_some_and(grazes),
                        "{name}: {o} {d}: {truth:?} {hit:?}"
                    );
                    unknown += usize::from(!tiny);
                    continue;
                };
                let at = curves.surface(&Ray::new(o, d), &hit);
                let cos = at.ng.dot(d).abs().max(1e-6);
                // Marching ends 1e-14 sizes before the surface.
                let off = (hit.t - t).abs() * cos;
                assert!(off <= 1e-13 * size, "{name}: {o} {d}: {} is {t}: {cos}", hit.t);
                n_hits += 1;
            }
            assert!(n_hits > 20 && unknown < 10, "{name}: {n_hits} hits, {unknown} unknown");
        });
    }
}

/// A point of the surface: on it by its stated error, with a normal that leads away from it, and
/// derivatives along it.
fn check_point(name: &str, curves: &Curves<'_>, at: &Surface) {
    let strand = &curves.table.strands[0];
    assert!(curves.bounds().contains(at.p), "{name}: {}", at.p);
    assert!((at.ng.length() - 1.0).abs() <= 8.0 * f64::EPSILON);
    let miss = distance(strand, at.p).abs();
    // What measuring rounds: twenty roundings of the strand's size and of where it is.
    let slack = at.p_err.dot(at.ng.abs()) + 2e-15 * (strand.unit + at.p.length());
    assert!(miss <= slack, "{name}: residual {miss} beyond {slack} at {}", at.p);
    let n = at.dp_du.cross(at.dp_dv).normalize();
    assert!(n.dot(at.ng) >= 1.0 - 1e-9, "{name}: {n} {}", at.ng);
}

#[test]
fn points_lie_on_rods_and_rays_leave_them_at_every_scale_and_distance() {
    for (k, (name, given)) in (0..).zip(troubles()) {
        for (scale, by) in [
            (1.0, DVec3::ZERO),
            (1e-6, DVec3::ZERO),
            (1e6, DVec3::ZERO),
            (1.0, DVec3::new(1e6, -1e6, 1e6)),
        ] {
            given.placed(scale, by).ask(|curves| leaves(name, &curves, 800 + k));
        }
    }
}

fn leaves(name: &str, curves: &Curves<'_>, seed: u64) {
    let strand = &curves.table.strands[0];
    let b = curves.bounds();
    let (size, mut rng, mut n_hits) = (b.diagonal().length(), Rng::new(seed), 0);
    for i in 0..60 {
        let c = eval(&strand.segments[i % strand.segments.len()].curve, rng.f64()).0;
        let target =
            strand.centre + (c.xyz() + direction(&mut rng) * (c.w * rng.f64())) * strand.unit;
        let d = direction(&mut rng);
        let length = [1e-6, 1.0, 1e6][i % 3];
        let ray = Ray::new(target - d * (size * [1.0, 1e4][i / 3 % 2]), d * length);
        let Some(hit) = curves.intersect(&ray) else { continue };
        n_hits += 1;
        let at = curves.surface(&ray, &hit);
        check_point(name, curves, &at);
        let cut = |t_max: f64| curves.intersect(&Ray { t_max, ..ray });
        assert_eq!(cut(hit.t), Some(hit), "{name}: a hit at t_max counts");
        assert_eq!(cut(hit.t.next_down()), None, "{name}");
        assert_eq!(cut(f64::NAN), None);
        for j in 0..4 {
            let mut out = direction(&mut rng);
            out = if out.dot(at.ng) < 0.0 { -out } else { out };
            if j == 3 {
                out = out.cross(at.ng).normalize() + at.ng * 1e-6;
            }
            // Outside until the next hit, and inside until the way out, which there always is.
            for out in [out, -out] {
                let o = offset_origin(at.p, at.p_err, at.ng, out);
                let outwards = out.dot(at.ng) > 0.0;
                let hit = curves.intersect(&Ray::new(o, out));
                assert!(outwards || hit.is_some(), "{name}: {out} from {o} finds no way out");
                let Some(hit) = hit else { continue };
                let middle = distance(strand, o + out * (0.5 * hit.t));
                let slack = 4.0 * at.p_err.length();
                let right = if outwards { middle >= -slack } else { middle <= slack };
                assert!(right, "{name}: {out} from {o}: {hit:?} {middle}");
                let near = hit.t * out.dot(at.ng).abs() <= slack && out.dot(at.ng).abs() > 1e-3;
                // At a tip there is nothing but rounding.
                let thick = at.dp_dv.length() > 1e-3 * size;
                assert!(!(near && thick), "{name}: {out} from {o} meets itself: {hit:?}");
            }
        }
    }
    assert!(n_hits > 20, "{name}: {n_hits} hits");
}

#[test]
fn every_line_leaves_a_rod_as_often_as_it_enters() {
    for (k, (name, given)) in (0..).zip(troubles()) {
        given.ask(|curves| {
            let (b, mut rng) = (curves.bounds(), Rng::new(900 + k));
            let size = b.diagonal().length();
            for i in 0..500 {
                let strand = &curves.table.strands[0];
                let c = eval(&strand.segments[i % strand.segments.len()].curve, rng.f64()).0;
                let mut d = direction(&mut rng);
                let side = d.cross(direction(&mut rng)).normalize();
                // Through the curve, across it and all but touching it.
                let reach = c.w * [0.0, rng.f64(), 1.0 - 1e-9, 1.0 + 1e-9, 1.0][i % 5];
                let through = strand.centre + (c.xyz() + side * reach) * strand.unit;
                if i % 11 == 0 {
                    d = DVec3::AXES[i / 11 % 3];
                }
                let (mut o, mut turns) = (through - d * (2.0 * size), vec![]);
                while let Some(hit) = curves.intersect(&Ray::new(o, d)) {
                    let at = curves.surface(&Ray::new(o, d), &hit);
                    turns.push(at.ng.dot(d));
                    o = offset_origin(at.p, at.p_err, at.ng, d);
                    assert!(turns.len() < 40, "{name}: no end");
                }
                if turns.iter().all(|cos| cos.abs() > 1e-5) {
                    let in_turn = turns.iter().enumerate().all(|(i, c)| (*c < 0.0) == (i % 2 == 0));
                    assert!(turns.len() % 2 == 0 && in_turn, "{name}: {through} {d}: {turns:?}");
                }
            }
        });
    }
}

#[test]
fn a_straight_rod_is_a_capsule() {
    for (scale, by) in
        [(1.0, DVec3::ZERO), (1e-6, DVec3::ONE), (1e6, DVec3::ZERO), (1.0, DVec3::splat(1e6))]
    {
        let a = DVec3::new(2.0, 6.0, -3.0);
        let points = [0.0, 1.0, 2.0, 3.0].map(|x| (a * (x / 3.0)).to_array());
        let given = Given::new(&points, &[0.5]).placed(scale, by);
        let base = DVec3::from_slice(&given.points);
        let mut rng = Rng::new(41);
        given.ask(|curves| {
            for i in 0..3000 {
                let far = [20.0, 200.0, 4e4][i % 3] * scale;
                let target = base + (a * rng.f64() + direction(&mut rng) * 0.6) * scale;
                let d = if i % 5 == 0 { a / 7.0 } else { direction(&mut rng) };
                let ray = Ray::new(target - d * far, d);
                let hit = curves.intersect(&ray);
                // The rod is the rounded one of the same points.
                let slack = 4e-15 * (far + 9.0 * scale + base.length());
                let truth = capsule(ray, base, a * scale, 0.5 * scale);
                match (hit, truth) {
                    (None, None) => {}
                    (Some(hit), Some((t, cos))) => {
                        let off = (hit.t - t).abs() * cos;
                        assert!(off <= slack, "{ray:?}: {off} beyond {slack}");
                    }
                    (_, truth) => {
                        let grazed = truth.is_none_or(|(_, cos)| cos * cos * scale <= 1e3 * slack);
                        assert!(grazed, "{ray:?}: {hit:?} {truth:?}");
                    }
                }
            }
        });
    }
}

/// Where a ray meets a capsule and at which cosine, by the built-in one's formulae for whole shapes.
fn capsule(ray: Ray, base: DVec3, along: DVec3, radius: f64) -> Option<(f64, f64)> {
    let z = along.normalize();
    let o = ray.o - base;
    let flat = |v: DVec3| v - z * z.dot(v);
    let height = along.length();
    let mut all = vec![];
    if let Some((t, _)) = sphere_roots(flat(o), flat(ray.d), radius) {
        let p = o + ray.d * t;
        if (0.0..=height).contains(&z.dot(p)) {
            all.push((t, flat(p)));
        }
    }
    for centre in [DVec3::ZERO, along] {
        if let Some((t, _)) = sphere_roots(o - centre, ray.d, radius) {
            all.push((t, o + ray.d * t - centre));
        }
    }
    let nearest = all.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((nearest.0, nearest.1.normalize().dot(ray.d).abs()))
}

#[test]
fn four_arcs_are_a_ring_but_for_what_cubics_miss_of_circles() {
    // The usual arc of 90°: off by 2.8e-4 of the radius at most.
    let k = 4.0 / 3.0 * (TAU / 16.0).tan();
    let corner = |i: i32| [DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y][i.rem_euclid(4) as usize];
    let mut points = vec![DVec3::X.to_array()];
    for i in 0..4 {
        let (a, b) = (corner(i), corner(i + 1));
        points.extend([a + b * k, b + a * k, b].map(|p| p.to_array()));
    }
    Given::new(&points, &[0.25]).ask(|curves| {
        let mut rng = Rng::new(42);
        let mut n_hits = 0;
        for _ in 0..3000 {
            let o = direction(&mut rng) * 3.0;
            let around = direction(&mut rng).with_z(0.0).normalize() + direction(&mut rng) * 0.2;
            let d = (around - o).normalize();
            let ray = Ray::new(o, d);
            let Some(hit) = curves.intersect(&ray) else { continue };
            n_hits += 1;
            let at = curves.surface(&ray, &hit);
            let flat = at.p.with_z(0.0);
            let gap = ((flat.length() - 1.0).hypot(at.p.z) - 0.25).abs();
            assert!(gap <= 2.8e-4, "{gap} at {}", at.p);
            // Both ends meet: u is the turn about z, but for the arcs' uneven speed.
            let turn = crate::shape::axial::turn_of(at.p.y.atan2(at.p.x));
            let off = (at.uv.x - turn).abs();
            assert!(off.min(1.0 - off) <= 5e-3, "{} {turn}", at.uv.x);
        }
        assert!(n_hits > 1000, "{n_hits}");
    });
}
