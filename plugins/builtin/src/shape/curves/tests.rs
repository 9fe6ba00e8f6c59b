//! What curves promise: by distances that are measured along the curve, and by other shapes.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DVec3, DVec4, Vec4Swizzles as _};
use luxel_sdk::kind::{Shape as _, Surface};
use luxel_sdk::num::{Ray, offset_origin};
use luxel_sdk::params::{Build as _, BuildContext, Shared, Table};
use luxel_sdk::sampling::Rng;

use super::cubic::eval;
use super::{Basis, Curves, Form, Strand, Strands};
use crate::shape::testing::direction;

struct Nothing;

impl BuildContext for Nothing {
    fn read(&self, _: &str) -> Result<Arc<[u8]>, String> {
        Err(String::new())
    }
    fn read_beside(&self, _: &str, _: &str) -> Result<Arc<[u8]>, String> {
        Err(String::new())
    }
    fn warn(&self, _: &str) {}
}

/// What a scene gives, before it is built.
#[derive(Clone)]
struct Given {
    points: Vec<f64>,
    radius: f64,
    radii: Vec<f64>,
    strands: Vec<f64>,
    normals: Vec<f64>,
    basis: Basis,
    form: Form,
}

impl Given {
    fn new(points: &[[f64; 3]], radii: &[f64]) -> Self {
        let [radius, radii] = match radii {
            [one] => [vec![*one], vec![]],
            many => [vec![0.0], many.to_vec()],
        };
        Self {
            points: points.concat(),
            radius: radius[0],
            radii,
            strands: vec![],
            normals: vec![],
            basis: Basis::Bezier,
            form: Form::Round,
        }
    }

    /// With all lengths scaled, and then moved.
    fn placed(&self, scale: f64, by: DVec3) -> Self {
        let place = |(i, x): (usize, &f64)| x * scale + by[i % 3];
        Self {
            points: self.points.iter().enumerate().map(place).collect(),
            radius: self.radius * scale,
            radii: self.radii.iter().map(|r| r * scale).collect(),
            ..self.clone()
        }
    }

    fn with<R>(&self, strands: &Arc<Strands>, ask: impl FnOnce(Curves<'_>) -> R) -> R {
        ask(Curves {
            points: Table::new(&self.points),
            radius: self.radius,
            radii: Table::new(&self.radii),
            strands: Table::new(&self.strands),
            normals: Table::new(&self.normals),
            basis: self.basis,
            form: self.form,
            table: Shared::new(strands),
        })
    }

    fn built(&self) -> Result<Arc<Strands>, (&'static str, String)> {
        let none = Arc::new(Strands { strands: vec![], bounds: luxel_sdk::num::Bounds3::EMPTY });
        self.with(&none, |curves| {
            curves.build(&Nothing).map_err(|f| (f[0].field, f[0].message.clone()))
        })
    }

    fn ask<R>(&self, ask: impl FnOnce(Curves<'_>) -> R) -> R {
        self.with(&self.built().unwrap(), ask)
    }
}

/// A strand that goes on through all kinds of trouble.
fn troubles() -> Vec<(&'static str, Given)> {
    let bow = [[-2.0, -0.5, 0.3], [-0.9, 1.0, -0.6], [1.1, 0.9, 0.8], [2.1, -0.7, -0.2]];
    let cusp = [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]];
    let bend = [[0.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.1, 3.0, 0.0], [0.1, 0.0, 0.0]];
    let straight = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 2.0, 3.0], [1.0, 2.0, 3.0]];
    let corner = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [2.0, 1.0, 0.0],
        [1.0, 2.0, 1.0],
    ];
    let spline = Given {
        basis: Basis::Bspline,
        ..Given::new(
            &[
                [0.0, 0.0, 0.0],
                [1.0, 1.0, 0.0],
                [2.0, -1.0, 1.0],
                [3.0, 0.5, 0.0],
                [2.0, 2.0, -1.0],
                [2.0, 2.0, -1.0],
                [0.0, 2.5, 1.0],
            ],
            &[0.3],
        )
    };
    vec![
        ("bow", Given::new(&bow, &[0.2])),
        ("thin bow", Given::new(&bow, &[1e-3])),
        ("thick bow", Given::new(&bow, &[1.5])),
        ("tip", Given::new(&bow, &[0.3, 0.2, 0.1, 0.0])),
        ("swell", Given::new(&bow, &[0.1, 0.9, 0.0, 0.4])),
        ("swallowed", Given::new(&bow, &[0.1, 0.1, 4.0, 6.0])),
        ("cusp", Given::new(&cusp, &[0.1])),
        ("sharp bend", Given::new(&bend, &[0.3])),
        ("uneven", Given::new(&straight, &[0.4, 0.1, 0.3, 0.2])),
        ("point", Given::new(&[[1.0, 2.0, 3.0]; 4], &[0.7])),
        ("corner", Given::new(&corner, &[0.2])),
        ("spline", spline),
    ]
}

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
            while i < 400 {
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
            assert!(n_hits > 150 && unknown < 20, "{name}: {n_hits} hits, {unknown} unknown");
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
    for i in 0..400 {
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
    assert!(n_hits > 150, "{name}: {n_hits} hits");
}

#[test]
fn every_line_leaves_a_rod_as_often_as_it_enters() {
    for (k, (name, given)) in (0..).zip(troubles()) {
        given.ask(|curves| {
            let (b, mut rng) = (curves.bounds(), Rng::new(900 + k));
            let size = b.diagonal().length();
            for i in 0..1000 {
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
    if let Some((t, _)) = luxel_sdk::num::sphere_roots(flat(o), flat(ray.d), radius) {
        let p = o + ray.d * t;
        if (0.0..=height).contains(&z.dot(p)) {
            all.push((t, flat(p)));
        }
    }
    for centre in [DVec3::ZERO, along] {
        if let Some((t, _)) = luxel_sdk::num::sphere_roots(o - centre, ray.d, radius) {
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

#[test]
fn a_spline_is_its_bezier_segments() {
    let spline = Given {
        basis: Basis::Bspline,
        ..Given::new(
            &[
                [6.0, 0.0, 0.0],
                [0.0, 6.0, 3.0],
                [-6.0, 0.0, 6.0],
                [0.0, -6.0, 9.0],
                [6.0, 6.0, 6.0],
            ],
            &[0.6, 1.2, 0.6, 1.2, 0.6],
        )
    };
    let bezier = Given::new(
        &[
            [0.0, 4.0, 3.0],
            [-2.0, 4.0, 4.0],
            [-4.0, 2.0, 5.0],
            [-4.0, 0.0, 6.0],
            [-4.0, -2.0, 7.0],
            [-2.0, -4.0, 8.0],
            [0.0, -3.0, 8.0],
        ],
        &[1.0, 1.0, 0.8, 0.8, 0.8, 1.0, 1.0],
    );
    let (a, b) = (spline.built().unwrap(), bezier.built().unwrap());
    let place = |s: &Strand, p: DVec4| (p.xyz() * s.unit + s.centre).extend(p.w * s.unit);
    for (i, segment) in a.strands[0].segments.iter().enumerate() {
        for (p, q) in segment.curve.iter().zip(&b.strands[0].segments[i].curve) {
            let off = (place(&a.strands[0], *p) - place(&b.strands[0], *q)).abs().max_element();
            assert!(off <= 8.0 * f64::EPSILON * 8.0, "{i}: {off}");
        }
    }
    assert_eq!(a.strands[0].segments.len(), 2);
}

fn ribbons() -> Vec<Given> {
    let rods = troubles().into_iter().filter(|(name, _)| !matches!(*name, "point" | "swallowed"));
    rods.map(|(_, given)| Given { form: Form::Ribbon, ..given }).collect()
}

#[test]
fn a_level_ribbon_faces_up_and_is_a_rectangle() {
    let points = [0.0, 1.0, 2.0, 3.0].map(|x| [x, 2.0, 5.0]);
    let given = Given { form: Form::Ribbon, ..Given::new(&points, &[0.5]) };
    given.ask(|curves| {
        let down = |x: f64, z: f64| Ray::new(DVec3::new(x, 4.0, z), -2.0 * DVec3::Y);
        for (x, z, met) in [
            (0.25, 5.0, true),
            (2.75, 5.4999, true),
            (2.75, 4.5001, true),
            (2.75, 4.4999, false),
            (1.0, 5.5001, false),
            (-0.0001, 5.0, false),
            (3.0001, 5.0, false),
        ] {
            let hit = curves.intersect(&down(x, z));
            assert_eq!(hit.is_some(), met, "{x} {z}");
            let Some(hit) = hit else { continue };
            let at = curves.surface(&down(x, z), &hit);
            assert!(
                (hit.t - 1.0).abs() <= 1e-15 && (at.p - DVec3::new(x, 2.0, z)).length() < 1e-14
            );
            assert!((at.ng - DVec3::Y).length() <= 1e-15);
            assert!((at.uv.x - x / 3.0).abs() <= 1e-15 && (at.uv.y - (5.5 - z)).abs() <= 1e-15);
            assert!((at.dp_du - DVec3::X * 3.0).length() <= 1e-14);
            assert!((at.dp_dv + DVec3::Z).length() <= 1e-14);
        }
        // Within its plane there is nothing to meet.
        let level = Ray::new(DVec3::new(-1.0, 2.0, 5.0), DVec3::X);
        assert!(curves.intersect(&level).is_none() && !curves.is_closed());
    });
}

#[test]
fn a_ribbon_faces_where_its_normals_say() {
    let points = [0.0, 1.0, 2.0, 3.0].map(|x| [x, 0.0, 0.0]);
    let normals = vec![[0.0, 0.0, 3.0]; 4].concat();
    let given = Given { form: Form::Ribbon, normals, ..Given::new(&points, &[0.5]) };
    given.ask(|curves| {
        let ray = Ray::new(DVec3::new(1.5, 0.2, 4.0), -DVec3::Z);
        let hit = curves.intersect(&ray).unwrap();
        assert!((curves.surface(&ray, &hit).ng - DVec3::Z).length() <= 1e-15);
    });
}

#[test]
fn lines_cross_ribbons_where_a_fine_table_says() {
    for (k, given) in (0..).zip(ribbons()) {
        given.ask(|curves| {
            let (strand, mut rng) = (&curves.table.strands[0], Rng::new(950 + k));
            let size = curves.bounds().diagonal().length();
            let mut n_hits = 0;
            for i in 0..300 {
                let segment = &strand.segments[i % strand.segments.len()];
                let (s, v) = (rng.f64(), 2.2 * rng.f64() - 1.1);
                let p = eval(&segment.curve, s).0.xyz() + eval(&segment.across, s).0 * v;
                let d = direction(&mut rng);
                let first = strand.centre + p * strand.unit - d * (2.0 * size);
                let (truth, sure) = crossings(strand, first, d);
                let (mut o, mut found) = (first, 0);
                while let Some(hit) = curves.intersect(&Ray::new(o, d)) {
                    let ray = Ray::new(o, d);
                    let at = curves.surface(&ray, &hit);
                    let off = (ray.at(hit.t) - at.p).length() * at.ng.dot(d).abs();
                    assert!(off <= 4.0 * at.p_err.length(), "{k}: {off} off the ray");
                    assert!(at.uv.cmpge(glam::DVec2::ZERO).all() && at.uv.max_element() <= 1.0);
                    assert!(
                        curves.bounds().contains(at.p) && at.dp_du.cross(at.dp_dv).dot(at.ng) > 0.0
                    );
                    let cut = |t_max: f64| curves.intersect(&Ray { t_max, ..ray });
                    assert!(cut(hit.t) == Some(hit) && cut(hit.t.next_down()).is_none());
                    o = offset_origin(at.p, at.p_err, at.ng, d);
                    found += 1;
                    assert!(found < 30, "{k}: no end");
                }
                assert!(!sure || truth == found, "{k}: {first} {d}: {truth} is {found}");
                n_hits += found;
            }
            assert!(n_hits > 200, "{k}: {n_hits} hits");
        });
    }
}

/// How often a line crosses a ribbon, by the signs of c × w in small steps, and whether that is for
/// sure: no crossing at an edge or along the ribbon.
fn crossings(strand: &Strand, o: DVec3, d: DVec3) -> (usize, bool) {
    const STEPS: u32 = 4000;
    let (x, y) = d.any_orthonormal_pair();
    let o = (o - strand.centre) / strand.unit;
    let (mut n, mut sure) = (0, true);
    for segment in &strand.segments {
        let look = |i: u32| {
            let s = f64::from(i) / f64::from(STEPS);
            let (c, w) = (eval(&segment.curve, s).0.xyz() - o, eval(&segment.across, s).0);
            let c = glam::DVec2::new(c.dot(x), c.dot(y));
            let w = glam::DVec2::new(w.dot(x), w.dot(y));
            (c.perp_dot(w), -c.dot(w) / w.length_squared(), w.length())
        };
        let all: Vec<_> = (0..=STEPS).map(look).collect();
        for i in 1..all.len() {
            let ((a, v, w), (b, v1, _)) = (all[i - 1], all[i]);
            if (a >= 0.0) != (b >= 0.0) {
                n += usize::from(v.abs() <= 1.0);
                sure &= (v.abs() - 1.0).abs() > 2.0 * (v1 - v).abs() + 1e-3;
            } else if v.abs() < 1.1 {
                // Two changes of sign within a step: where it all but touches 0.
                sure &= a.abs().min(b.abs()) > (b - a).abs() || i < 2 || w < 1e-9;
            }
        }
    }
    (n, sure)
}

#[test]
fn what_makes_no_curve_is_refused_with_its_numbers() {
    let points =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 1.0, 0.0], [3.0, 0.0, 0.0], [4.0, 0.0, 0.0]];
    let good = Given::new(&points[..4], &[0.1]);
    let says = |given: &Given, field: &str, message: &str| {
        let (what, said) = given.built().unwrap_err();
        assert!(what == field && said.contains(message), "{what}: {said}");
    };
    says(&Given::new(&points, &[0.1]), "points", "strand 0 has 5 points: 4, 7, 10");
    let spline = Given { basis: Basis::Bspline, ..good.clone() };
    assert!(Given { basis: Basis::Bspline, ..Given::new(&points, &[0.1]) }.built().is_ok());
    let three = Given { points: points[..3].concat(), ..spline };
    says(&three, "points", "strand 0 has 3 points: a B-spline has 4 or more");
    says(&Given { points: vec![0.0; 11], ..good.clone() }, "points", "11 numbers");
    says(&Given { points: vec![], ..good.clone() }, "points", "strand 0 has 0 points");
    for odd in [f64::NAN, f64::INFINITY, 1e300] {
        let mut points = good.points.clone();
        points[7] = odd;
        says(&Given { points, ..good.clone() }, "points", "at point 2");
        says(&Given { radius: odd, ..good.clone() }, "radius", "");
        let radii = vec![0.1, 0.1, 0.1, odd];
        says(&Given { radii, ..good.clone() }, "radii", "at point 3");
    }
    says(&Given { radius: 0.0, ..good.clone() }, "radius", "exceed 0");
    says(&Given { radii: vec![0.1; 3], ..good.clone() }, "radii", "3 radii for 4 points");
    says(&Given { radii: vec![0.0; 4], ..good.clone() }, "radii", "nowhere");
    says(&Given { radii: vec![0.1, -0.1, 0.1, 0.1], ..good.clone() }, "radii", "at point 1");
    let strands = |numbers: &[f64]| Given { strands: numbers.to_vec(), ..good.clone() };
    says(&strands(&[3.0]), "strands", "4 points in strands of 3");
    says(&strands(&[4.0, 4.0]), "strands", "strands of 8 points in all, but there are 4");
    says(&strands(&[2.0, 2.0]), "strands", "strand 0 has 2 points");
    for odd in [0.0, -4.0, 4.5, f64::NAN, f64::INFINITY] {
        says(&strands(&[odd]), "strands", "in place 0 is no number of points");
    }
    says(&Given { normals: vec![1.0; 9], ..good.clone() }, "normals", "3 normals for 4 points");
    let along = [[0.0, 1.0, 0.0], [0.0; 3], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]].concat();
    says(&Given { normals: along, ..good }, "normals", "at point 1 does not face away");
}

#[test]
fn strands_are_parts_and_the_whole_is_the_nearest_of_them() {
    let mut rng = Rng::new(43);
    let mut given = Given::new(&[], &[0.02]);
    for _ in 0..60 {
        let root = direction(&mut rng);
        for i in 0..4 {
            let p = root * (1.0 + 0.3 * f64::from(i)) + direction(&mut rng) * 0.1;
            given.points.extend(p.to_array());
        }
    }
    given.strands = vec![4.0];
    given.ask(|curves| {
        assert_eq!(curves.parts(), 60);
        let mut n_hits = 0;
        for _ in 0..2000 {
            let (o, d) = (direction(&mut rng) * 3.0, direction(&mut rng));
            let ray = Ray::new(o, (d - o).normalize());
            let parts = (0..60).filter_map(|i| curves.intersect_part(i, &ray));
            let nearest = parts.min_by(|a, b| a.t.total_cmp(&b.t));
            assert_eq!(curves.intersect(&ray), nearest);
            n_hits += usize::from(nearest.is_some());
        }
        assert!(n_hits > 200, "{n_hits}");
        assert!(curves.intersect_part(60, &Ray::new(DVec3::ZERO, DVec3::X)).is_none());
        assert!(curves.part_bounds(60).is_empty());
    });
}
