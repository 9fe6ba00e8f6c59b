//! Ribbons.

use glam::{DVec2, DVec3, Vec4Swizzles as _};
use luxel_sdk::kind::Shape as _;
use luxel_sdk::num::{Ray, offset_origin};
use luxel_sdk::sampling::Rng;

use super::super::cubic::eval;
use super::super::{Form, Strand};
use super::{Given, troubles};
use crate::shape::testing::direction;

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
    let normals = [[0.0, 0.0, 3.0]; 4].concat();
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
                    assert!(at.uv.cmpge(DVec2::ZERO).all() && at.uv.max_element() <= 1.0);
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
            let c = DVec2::new(c.dot(x), c.dot(y));
            let w = DVec2::new(w.dot(x), w.dot(y));
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
