//! A mesh to measure on, made here so that nothing large is stored: a knotted, bumpy tube.
//!
//! Rays that leave it meet other strands of it far away, as they do in scanned statues.

use std::f32::consts::TAU;

use glam::Vec3;

/// Points and triangles, f32 about the origin.
pub(crate) struct Soup {
    pub(crate) points: Vec<Vec3>,
    pub(crate) indices: Vec<[u32; 3]>,
}

impl Soup {
    /// The corners of a triangle.
    pub(crate) fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.indices[triangle].map(|i| self.points[i as usize])
    }
}

/// How high the bumps are over the radius of the tube.
const BUMPS: [(f32, f32); 3] = [(0.12, 5.0), (0.05, 17.0), (0.02, 61.0)];

/// The (2, 3) torus knot at the angle `u`.
fn strand(u: f32) -> Vec3 {
    let r = 0.6 + 0.28 * (3.0 * u).cos();
    Vec3::new(r * (2.0 * u).cos(), r * (2.0 * u).sin(), 0.28 * (3.0 * u).sin())
}

/// A closed knot of `around`·`along`·2 triangles, within about 1 of the origin.
pub(crate) fn knot(along: u32, around: u32) -> Soup {
    let mut points = Vec::with_capacity((along * around) as usize);
    for i in 0..along {
        let u = TAU * i as f32 / along as f32;
        let (p, ahead) = (strand(u), strand(u + 1e-3) - strand(u - 1e-3));
        let (a, b) = ahead.normalize().any_orthonormal_pair();
        for j in 0..around {
            let v = TAU * j as f32 / around as f32;
            let bump = |(height, n): (f32, f32)| height * (n * u * 4.0).sin() * (n * v).cos();
            let r = 0.17 * (1.0 + BUMPS.into_iter().map(bump).sum::<f32>());
            points.push(p + r * (a * v.cos() + b * v.sin()));
        }
    }
    let at = |i: u32, j: u32| (i % along) * around + j % around;
    let mut indices = Vec::with_capacity(2 * points.len());
    for i in 0..along {
        for j in 0..around {
            indices.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
            indices.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    Soup { points, indices }
}

/// Eight of them on a floor of three by three, the middle one missing.
pub(crate) fn eight(one: &Soup) -> Soup {
    let mut all = Soup { points: vec![], indices: vec![] };
    for cell in (0..9u8).filter(|cell| *cell != 4) {
        let by = Vec3::new(f32::from(cell % 3) - 1.0, 0.0, f32::from(cell / 3) - 1.0) * 1.7;
        let first = u32::try_from(all.points.len()).expect("a few million points");
        all.points.extend(one.points.iter().map(|p| *p * 0.8 + by));
        all.indices.extend(one.indices.iter().map(|t| t.map(|i| i + first)));
    }
    all
}
