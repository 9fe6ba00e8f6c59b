//! Tangents of the limit surface, as weights of what lies around a point.
//!
//! All are left eigenvectors of the matrix that takes a point's surroundings to those of the next
//! level, for the eigenvalue λ = ¼ + μ of its first turn. Around a whole point they are well known.
//! Along a crease we solve for those of the rules as they are: the weights of Biermann, Levin & Zorin
//! 2000, which others use, belong to rules that they changed, and agree only in regular places.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::super::assemble::angle;
use super::Scheme;

/// What lies around a point, relative to it, counter-clockwise.
#[derive(Clone, Debug, Default)]
pub(super) struct Ring {
    /// Other ends of its edges; both ends of a fan that is not closed.
    pub(super) far: Vec<DVec3>,
    /// Corners across its quads.
    pub(super) across: Vec<DVec3>,
    /// Whether the last edge is followed by the first.
    pub(super) closed: bool,
    /// The point's own largest coordinate: differences are as wrong as it has digits.
    pub(super) reach: f64,
}

/// A sum, and the sum of what it adds by magnitude.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tangent {
    pub(super) sum: DVec3,
    pub(super) size: f64,
}

impl Tangent {
    fn add(&mut self, weight: f64, v: DVec3) {
        self.sum += v * weight;
        self.size += weight.abs() * v.length();
    }
}

impl Ring {
    /// The faces' own normals, weighted by their angles.
    pub(super) fn mean_normal(&self) -> DVec3 {
        let n = self.far.len();
        let n_faces = if self.closed { n } else { n - 1 };
        let mut sum = DVec3::ZERO;
        for i in 0..n_faces {
            let (a, b) = (self.far[i], self.far[(i + 1) % n]);
            sum += a.cross(b).normalize_or_zero() * angle(a, b);
        }
        sum.try_normalize().unwrap_or(DVec3::Y)
    }
}

/// Sixteen times μ for quads that turn by an angle with this cosine.
fn mu_16(cos: f64) -> f64 {
    let c = 1.0 + cos;
    c + (c * (8.0 + c)).sqrt()
}

/// Two tangents at a point whose faces go all around it.
///
/// # Source
/// Halstead, Kass & `DeRose` 1993, appendix; Loop 1987.
pub(super) fn smooth(scheme: Scheme, ring: &Ring) -> Option<[Tangent; 2]> {
    let n = ring.far.len();
    let turn = TAU / n as f64;
    let edge = if scheme == Scheme::Loop { 1.0 } else { mu_16(turn.cos()) };
    let mut out = [Tangent::default(); 2];
    for i in 0..n {
        let (a, b) = ((turn * i as f64).sin_cos(), (turn * (i + 1) as f64).sin_cos());
        out[0].add(edge * a.1, ring.far[i]);
        out[1].add(edge * a.0, ring.far[i]);
        if let Some(across) = ring.across.get(i) {
            out[0].add(a.1 + b.1, *across);
            out[1].add(a.0 + b.0, *across);
        }
    }
    // Two faces that share both edges turn by half a circle each: their sines vanish.
    (n > 2).then_some(out)
}

/// The tangents along a crease and across one side of it, whose faces are the ring's.
pub(super) fn crease(scheme: Scheme, ring: &Ring) -> [Tangent; 2] {
    let k = ring.far.len() - 1;
    let mut along = Tangent::default();
    along.add(1.0, ring.far[0]);
    along.add(-1.0, ring.far[k]);
    let mut cross = Tangent::default();
    if k == 1 {
        // A single face shrinks as fast as the curve bends, or faster: the bend is seen.
        cross.add(1.0, ring.far[0]);
        cross.add(1.0, ring.far[1]);
        return [along, cross];
    }
    let turn = PI / k as f64;
    let (sin, cos) = turn.sin_cos();
    // Of sin(iθ) for the edges inside.
    let sum = (0.5 * turn).tan().recip();
    let ends = match scheme {
        Scheme::CatmullClark => {
            let mu = mu_16(cos) / 16.0;
            let first = sin * (0.0625 + 0.015625 / mu);
            let all = -(0.375 + 0.03125 / mu) * sum;
            (all + 8.0 * (0.5 - mu) * first) / (1.0 + 8.0 * (mu - 0.25) * (0.5 - mu))
        }
        Scheme::Loop => {
            let rest = (3.0 - 2.0 * cos) / 8.0;
            (rest * sin - 0.375 * sum) / (1.0 + rest * (2.0 * cos - 1.0))
        }
    };
    cross.add(ends, ring.far[0]);
    cross.add(ends, ring.far[k]);
    for i in 1..k {
        cross.add((turn * i as f64).sin(), ring.far[i]);
    }
    for (i, across) in ring.across.iter().enumerate() {
        let around = (turn * i as f64).sin() + (turn * (i + 1) as f64).sin();
        cross.add(around / mu_16(cos), *across);
    }
    [along, cross]
}

/// The tangents of a fan between two sharp edges that end at a corner: those edges.
pub(super) fn corner(ring: &Ring) -> [Tangent; 2] {
    let mut out = [Tangent::default(); 2];
    out[0].add(1.0, ring.far[0]);
    out[1].add(1.0, ring.far[ring.far.len() - 1]);
    out
}
