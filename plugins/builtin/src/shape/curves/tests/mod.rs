//! What curves promise: by distances that are measured along the curve, and by other shapes.

mod ribbons;
mod rods;

use std::sync::Arc;

use glam::{DVec3, DVec4, Vec4Swizzles as _};
use luxel_sdk::kind::Shape as _;
use luxel_sdk::num::{Bounds3, Ray};
use luxel_sdk::params::{Build as _, BuildContext, Shared, Table};
use luxel_sdk::sampling::Rng;

use super::{Basis, Curves, Form, Strand, Strands};
use crate::shape::testing::{check_turning, direction};
use crate::stop::STRIDE;
use crate::stop::testing::ends_wherever;

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
        let none = Arc::new(Strands { strands: vec![], bounds: Bounds3::EMPTY });
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

#[test]
fn normals_of_strands_turn_as_those_beside_them() {
    let points = [[0.0, 0.0, 0.0], [0.4, 0.3, 0.0], [0.7, 0.5, 0.5], [1.0, 0.1, 0.6]];
    for form in [Form::Round, Form::Ribbon] {
        let given = Given { form, ..Given::new(&points, &[0.2, 0.25, 0.1, 0.15]) };
        let n = given.ask(|curves| check_turning(&curves, 801, 0.0));
        assert!(n > 50, "{n}");
    }
}

#[test]
fn strands_end_soon_after_they_are_not_wanted_any_more() {
    let points: Vec<[f64; 3]> =
        (0..30_001).map(|i| [f64::from(i), f64::from(i % 7), f64::from(i % 5)]).collect();
    // One of all, and many short ones.
    for (points, each) in [(&points[..], 30_001.0), (&points[..30_000], 4.0)] {
        let given = Given { strands: vec![each], ..Given::new(points, &[0.1]) };
        let none = Arc::new(Strands { strands: vec![], bounds: Bounds3::EMPTY });
        let looks = given.with(&none, |curves| ends_wherever(|patience| curves.build(patience)));
        assert!(looks >= 2 * points.len() / STRIDE, "{looks} looks");
    }
}
