//! Rays that get out of a closed mesh: aimed from inside at its corners and edges; and rays from the
//! mesh itself that meet it where they leave it.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use libloading::Library;
use luxel_core::accel::{Precision, Processor};
use luxel_sdk::num::Ray;

use super::embree::{Embree, Flags};
use super::knot::Soup;
use super::peers::Tracer;
use super::self_hits;
use super::shots::{Landing, Random, Shot};
use super::staged::{Staged, Way};

/// Scale and translation of the mesh, written into its single-precision points.
const CASES: [(f64, f64); 11] = [
    (1.0, 0.0),
    (1e-6, 0.0),
    (1e6, 0.0),
    (1.0, 1.0),
    (1.0, 1e2),
    (1.0, 1e4),
    (1.0, 1e6),
    (1e-3, 1.0),
    (1e-6, 1.0),
    (1e3, 1e6),
    (1e6, 1e6),
];

/// Rings and segments of the ball.
const RINGS: u32 = 200;
const SEGMENTS: u32 = 205;

/// Prints how many of `n` rays for each case meet the triangle that they leave, and how many of as many
/// others get out: by every precision, on every processor, one by one and side by side.
pub(crate) fn run(library: Option<&Library>, n: usize) {
    let cases = CASES.map(|(scale, by)| case(scale, by, n));
    println!("\n== self-hits: rays of {n} from a closed mesh that meet it where they leave it");
    heads();
    rows(&[Precision::Standard, Precision::Exact], &cases, |staged, precision, with, _| {
        self_hits::count(staged, precision, with, n)
    });
    println!("\n== leaks: rays of {n} aimed at corners and edges of a closed mesh that get out");
    heads();
    rows(&Precision::ALL, &cases, |staged, _, with, shots| {
        let ray = |shot: &Shot| Ray::new(shot.o.as_dvec3(), shot.d.as_dvec3());
        staged.count(with, n, |i| (ray(&shots[i]), None), |_, hit| hit.is_none())
    });
    let Some(library) = library else { return };
    for (name, flags) in [("Embree", Flags::Default), ("Embree, robust", Flags::Robust)] {
        row(name, &cases, |soup, shots| Some(count(&Embree::new(library, soup, flags)?, shots)));
    }
}

type Case = (Soup, Vec<Shot>);

/// A row for each way through the stage: what is counted of the rays of each case.
fn rows(
    precisions: &[Precision],
    cases: &[Case],
    counted: impl Fn(&Staged, Precision, (Processor, Way), &[Shot]) -> usize,
) {
    for precision in precisions {
        for (processor, way) in Processor::all().into_iter().flat_map(|p| Way::ALL.map(|w| (p, w)))
        {
            let name = format!("{}, {}{}", precision.word(), processor.name(), way.suffix());
            row(&name, cases, |soup, shots| {
                let staged = Staged::new(soup, *precision).expect("a ball of triangles is a scene");
                Some(counted(&staged, *precision, (processor, way), shots))
            });
        }
    }
}

fn heads() {
    print!("{:<39}", "scale / translation");
    for (scale, by) in CASES {
        print!("{:>11}", format!("{scale:.0e}/{by:.0e}"));
    }
    println!();
}

fn row(name: &str, cases: &[Case], counted: impl Fn(&Soup, &[Shot]) -> Option<usize>) {
    print!("{name:<39}");
    for (soup, shots) in cases {
        let n = counted(soup, shots).map_or_else(|| "–".to_owned(), |n| n.to_string());
        print!("{n:>11}");
    }
    println!();
}

fn count(tracer: &dyn Tracer, shots: &[Shot]) -> usize {
    let mut found = vec![Landing::NOWHERE; shots.len()];
    tracer.nearest(shots, &mut found);
    found.iter().filter(|landing| landing.triangle == u32::MAX).count()
}

#[expect(clippy::cast_possible_truncation, reason = "points are kept in single precision")]
fn case(scale: f64, by: f64, n: usize) -> Case {
    let offset = glam::DVec3::new(by, 0.7 * by, -0.3 * by);
    let mut soup = ball();
    for p in &mut soup.points {
        *p = (p.as_dvec3() * scale + offset).as_vec3();
    }
    let shots = shots(&soup, offset.as_vec3(), scale as f32, n);
    (soup, shots)
}

/// A closed ball with bumps; every point of the inner half sees all of it.
fn ball() -> Soup {
    let mut points = vec![Vec3::Y];
    for ring in 1..RINGS {
        let theta = PI * ring as f32 / RINGS as f32;
        for segment in 0..SEGMENTS {
            let phi = TAU * segment as f32 / SEGMENTS as f32;
            let r = 1.0 + 0.02 * (9.0 * theta).sin() * (7.0 * phi).cos();
            let (sin, cos) = theta.sin_cos();
            points.push(r * Vec3::new(sin * phi.cos(), cos, sin * phi.sin()));
        }
    }
    points.push(-Vec3::Y);
    let last = (RINGS - 1) * SEGMENTS + 1;
    let at = |ring: u32, segment: u32| match ring {
        0 => 0,
        RINGS => last,
        _ => 1 + (ring - 1) * SEGMENTS + segment % SEGMENTS,
    };
    let mut indices = vec![];
    for (ring, segment) in (0..RINGS).flat_map(|r| (0..SEGMENTS).map(move |s| (r, s))) {
        let (a, b) = (at(ring, segment), at(ring, segment + 1));
        let (c, d) = (at(ring + 1, segment), at(ring + 1, segment + 1));
        if ring > 0 {
            indices.push([a, b, c]);
        }
        if ring + 1 < RINGS {
            indices.push([b, d, c]);
        }
    }
    Soup { points, indices }
}

/// Rays from the middle and from about it, at corners, middles of edges and anywhere on edges; of
/// unit length or not.
fn shots(soup: &Soup, middle: Vec3, scale: f32, n: usize) -> Vec<Shot> {
    let mut random = Random(99);
    let mut shots = Vec::with_capacity(n);
    for i in 0..n {
        let [a, b, _] = soup.corners(random.below(soup.indices.len()));
        let p = match i % 3 {
            0 => a,
            1 => (a + b) * 0.5,
            _ => a + (b - a) * random.next(),
        };
        let mut away = || (random.next() - 0.5) * 0.8 * scale;
        let about = Vec3::new(away(), away(), away());
        let o = if i % 2 == 0 { middle } else { middle + about };
        let d = p - o;
        let d = if i % 4 < 2 { d.as_dvec3().normalize().as_vec3() } else { d };
        let d = if d == Vec3::ZERO || !d.is_finite() { Vec3::Z * scale } else { d };
        shots.push(Shot { o, d, t_max: f32::INFINITY });
    }
    shots
}
