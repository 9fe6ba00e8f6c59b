//! Rays that meet a closed mesh where they leave it, offset and traced as a stage does it.

use glam::DVec2;
use luxel_core::accel::{Precision, Processor};
use luxel_core::stage::Mesh;
use luxel_sdk::num::{Ray, offset_origin};
use luxel_sdk::sampling::{uniform_sphere, uniform_triangle};

use super::shots::Random;
use super::staged::{Asked, Staged, Way};
use crate::errors::true_t;

/// How many of `n` rays from a mesh meet the triangle that they leave, or one behind their origin.
pub(super) fn count(
    staged: &Staged,
    precision: Precision,
    with: (Processor, Way),
    n: usize,
) -> usize {
    let mut random = Random(98);
    let mesh = staged.mesh();
    let ray = |i| leaving(mesh, precision, i, &mut random);
    staged.count(with, n, ray, |(ray, from), hit| {
        let is_self = |met: u32| Some(met) == *from || true_t(mesh, ray, met) <= 0.0;
        hit.is_some_and(|hit| is_self(hit.hit.face))
    })
}

/// To either side, every second ray close to the surface.
fn leaving(mesh: &Mesh, precision: Precision, i: usize, random: &mut Random) -> Asked {
    let (face, at) = start(mesh, i, random);
    let surface = mesh.surface(face, at, precision, 0.0);
    let d = uniform_sphere([random.next(), random.next()]).as_dvec3().normalize();
    let height = d.dot(surface.ng) * if i.is_multiple_of(2) { 1.0 } else { 1e-2 };
    let d = (d - surface.ng * d.dot(surface.ng) + surface.ng * height).normalize();
    let o = offset_origin(surface.p, surface.p_err, surface.ng, d);
    (Ray { o, d, t_max: f64::INFINITY }, Some(face))
}

/// A point of a triangle with an area: its first corner, one of its edges, or anywhere.
fn start(mesh: &Mesh, i: usize, random: &mut Random) -> (u32, DVec2) {
    let triangles = mesh.triangles();
    let face = loop {
        let face = random.below(triangles.indices.len());
        let face = u32::try_from(face).expect("the ball has 81,590 triangles");
        let [a, b, c] = triangles.corners(face);
        if (b - a).cross(c - a).length_squared() > 0.0 {
            break face;
        }
    };
    let [_, b, c] = uniform_triangle([random.next(), random.next()]).map(f64::from);
    let at = match i % 3 {
        0 => DVec2::ZERO,
        1 => DVec2::new(b, 0.0),
        _ => DVec2::new(b, c),
    };
    (face, at)
}
