//! A triangle as a part of the sphere around a viewer.
//!
//! Arvo 1995, "Stratified Sampling of Spherical Triangles": a part of the triangle beside one corner
//! takes its share of the solid angle, then a point on the arc that ends the part. Angles of tiny
//! triangles cancel and arccosines round (PBR4 §6.5.4 leaves solid angles below 2·10⁻⁴ to the area).
//! Here the solid angle is an arctangent (van Oosterom and Strackee 1983), and both arcs are found as
//! tangents of half angles along edges of the flat triangle, whose differences are exact: nothing
//! cancels, however small or far away the triangle is.

use glam::{DVec2, DVec3};

/// Least solid angle or distance to the plane, as a share of what it is a difference of: below, it
/// rounds by more than 2⁻²⁴, the grain of random numbers. The viewer all but stands on the triangle
/// or its edge.
const LEAST: f64 = 1.0 / (1u64 << 28) as f64;

/// Products of three distances whose rounding is that of their digits.
const RANGE: std::ops::RangeInclusive<f64> = 1e-290..=1e300;

/// What a viewer sees of a triangle.
#[derive(Clone, Copy, Debug)]
pub struct SphericalTriangle {
    /// From the viewer to the first corner.
    a: DVec3,
    /// From there to the second and to the third.
    edges: [DVec3; 2],
    /// Distances to the first two corners.
    la: f64,
    lb: f64,
    /// Six times the volume between the viewer and the triangle.
    volume: f64,
    solid_angle: f64,
}

impl SphericalTriangle {
    /// The triangle with its first corner at `a` from the viewer and these edges to the others, in
    /// any unit of length.
    ///
    /// `None` where its solid angle or places in it cannot be told: the viewer is in its plane or
    /// touches it, it has no area, or a number is not finite or beyond 10^±96.
    #[inline]
    pub fn new(a: DVec3, edges: [DVec3; 2]) -> Option<Self> {
        let [b, c] = edges.map(|edge| a + edge);
        let [la, lb, lc] = [a, b, c].map(DVec3::length);
        let volume = edges[0].cross(edges[1]).dot(a).abs();
        let product = la * lb * lc;
        let base = product + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        // NaN fails here; a volume of 0 after it.
        let usable = RANGE.contains(&product) && volume.max(base) >= LEAST * product;
        let solid_angle = 2.0 * volume.atan2(base);
        let told = usable && solid_angle >= f64::MIN_POSITIVE;
        told.then_some(Self { a, edges, la, lb, volume, solid_angle })
    }

    /// Solid angle, sr, in (0, 2π).
    #[inline]
    pub fn solid_angle(&self) -> f64 {
        self.solid_angle
    }

    /// Barycentrics of the second and the third corner of a point that is uniform in solid angle:
    /// not negative, their sum at most 1. `u` uniform in [0, 1)².
    #[inline]
    pub fn sample(&self, [u, v]: [f64; 2]) -> DVec2 {
        let Self { a, edges: [to_b, to_c], la, lb, .. } = *self;
        // Along a–c to where the part beside a–b has u of the solid angle.
        let (sin, cos) = (0.5 * u * self.solid_angle).sin_cos();
        let (b, across) = (a + to_b, a.cross(to_c).length());
        let tilt = to_b.dot(to_c) - (to_b.dot(a) / la) * (to_c.dot(a) / la);
        let num = sin * one_plus_cos(a, b, to_b, la * lb);
        let den = cos * self.volume - sin * tilt * la;
        let s = part(la, across, a.dot(to_c), (num * (across / la), den));
        // Along b–p, whose cosines are uniform.
        let to_p = to_c * s - to_b;
        let (p, across) = (b + to_p, b.cross(to_p).length());
        let (dot, lengths) = (b.dot(p), lb * p.length());
        let half = if dot < 0.0 { (lengths - dot) / across } else { across / (lengths + dot) };
        let half2 = half * half;
        let at = (half * v.sqrt(), (1.0 + (1.0 - v) * half2).sqrt());
        let r = part(lb, across, b.dot(to_p), at);
        DVec2::new(1.0 - r, r * s)
    }
}

/// |a|·|b|·(1 + cos) of the angle between two vectors, by what does not cancel.
#[inline]
fn one_plus_cos(a: DVec3, b: DVec3, a_to_b: DVec3, lengths: f64) -> f64 {
    let dot = a.dot(b);
    if dot < 0.0 { a.cross(a_to_b).length_squared() / (lengths - dot) } else { lengths + dot }
}

/// Which part of a segment lies within an angle at the viewer: the segment begins at this distance,
/// `across` and `along` are its parts beside and in line with the way there, times that distance, and
/// `num / den` is the tangent of half the angle.
#[inline]
fn part(distance: f64, across: f64, along: f64, (num, den): (f64, f64)) -> f64 {
    let bent = across * (den - num) * (den + num) - 2.0 * along * num * den;
    let part = 2.0 * distance * distance * num * den / bent;
    // What rounds below 0 has gone beyond the end. A segment that is seen as a point gives a NaN,
    // which `min` passes over.
    if part < 0.0 { 1.0 } else { part.min(1.0) }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, TAU};

    use super::*;
    use crate::sampling::Rng;
    use crate::sampling::chi_square::{Counts, fraction_cell};

    fn seen(corners: [DVec3; 3]) -> Option<SphericalTriangle> {
        let [a, b, c] = corners;
        SphericalTriangle::new(a, [b - a, c - a])
    }

    /// The point with these barycentrics, from the viewer.
    fn point(t: &SphericalTriangle, at: DVec2) -> DVec3 {
        t.a + t.edges[0] * at.x + t.edges[1] * at.y
    }

    /// Density of barycentrics where directions are uniform.
    fn density(t: &SphericalTriangle, at: DVec2) -> f64 {
        t.volume / (point(t, at).length().powi(3) * t.solid_angle)
    }

    /// Triangles from what is plain to what all but touches the viewer.
    const SEEN: [[[f64; 3]; 3]; 9] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[-1.0, -1.0, 0.3], [2.0, -1.0, 0.3], [0.0, 3.0, 0.3]],
        [[-1.0, -1.0, 1e-3], [2.0, -1.0, 1e-3], [0.0, 3.0, 1e-3]],
        // Edge-on, beside it and from afar; long, and nearly around the viewer.
        [[1.0, -1.0, 1e-7], [2.0, 0.5, 1e-7], [1.0, 3.0, 1e-7]],
        [[0.1, 1.0, 1e3], [-0.2, -1.0, 1e3], [0.5, 0.0, 1e3]],
        [[-50.0, 1.0, 1.0], [60.0, 1.1, 1.0], [0.0, 1.0, 0.99]],
        [[-5.0, -1.0, 0.1], [5.0, -1.0, 0.1], [0.0, 0.1, 0.1]],
        [[-1.0, -1e-6, 1e-6], [1.0, -1e-6, 1e-6], [0.0, 1.0, 2.0]],
        [[1e-7, 0.0, 2e-7], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]],
    ];

    #[test]
    fn samples_are_uniform_in_the_solid_angle_at_every_size() {
        for (i, corners) in SEEN.into_iter().enumerate() {
            for scale in [1.0, 1e-9, 1e9] {
                let t = seen(corners.map(|c| DVec3::from_array(c) * scale)).unwrap();
                check_uniform(&t, i as u64);
            }
        }
    }

    /// Parts of a triangle, halved over and over, hold their share of the samples.
    fn check_uniform(t: &SphericalTriangle, seed: u64) {
        let n = 64;
        let mut parts = vec![[DVec2::ZERO, DVec2::X, DVec2::Y]];
        while parts.len() < n {
            // The largest as the viewer sees it, cut at the middle of its longest edge in view.
            let largest =
                |x: &&[DVec2; 3], y: &&[DVec2; 3]| omega(t, **x).total_cmp(&omega(t, **y));
            let part = *parts.iter().max_by(largest).unwrap();
            parts.retain(|other| *other != part);
            let longest = |i: &usize, j: &usize| angle(t, part, *i).total_cmp(&angle(t, part, *j));
            let i = (0..3).max_by(longest).unwrap();
            let [a, b, c] = [part[i], part[(i + 1) % 3], part[(i + 2) % 3]];
            let m = halfway(t, a, b);
            parts.extend([[a, m, c], [m, b, c]]);
        }
        let mut counts = Counts::new(n);
        let mut rng = Rng::new(seed);
        for _ in 0..20_000 {
            let at = t.sample([rng.f64(), rng.f64()]);
            assert!(at.x >= 0.0 && at.y >= 0.0 && at.x + at.y <= 1.0 + f64::EPSILON, "{at}");
            let inside = |[a, b, c]: [DVec2; 3]| {
                let side = |p: DVec2, q: DVec2| (q - p).perp_dot(at - p);
                side(a, b).min(side(b, c)).min(side(c, a))
            };
            let deepest = |i: &usize, j: &usize| inside(parts[*i]).total_cmp(&inside(parts[*j]));
            counts.add((0..n).max_by(deepest).unwrap());
        }
        let whole = t.solid_angle();
        counts.check(|i| omega(t, parts[i]) / whole);
    }

    /// Solid angle of a part, by its corners in barycentrics.
    fn omega(t: &SphericalTriangle, part: [DVec2; 3]) -> f64 {
        let [e1, e2] = [part[1] - part[0], part[2] - part[0]];
        let edge = |e: DVec2| t.edges[0] * e.x + t.edges[1] * e.y;
        let [a, b, c] = part.map(|at| point(t, at));
        let [la, lb, lc] = [a, b, c].map(DVec3::length);
        let base = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * edge(e1).cross(edge(e2)).dot(a).abs().atan2(base)
    }

    /// The angle that an edge of a part fills.
    fn angle(t: &SphericalTriangle, part: [DVec2; 3], i: usize) -> f64 {
        let [a, b] = [part[i], part[(i + 1) % 3]].map(|at| point(t, at).normalize());
        2.0 * ((a - b).length() / 2.0).min(1.0).asin()
    }

    /// The point of a segment that lies halfway in view.
    fn halfway(t: &SphericalTriangle, a: DVec2, b: DVec2) -> DVec2 {
        let [la, lb] = [a, b].map(|at| point(t, at).length());
        a + (b - a) * (la / (la + lb))
    }

    #[test]
    fn solid_angles_are_those_of_closed_forms() {
        let octant = seen(SEEN[0].map(DVec3::from_array)).unwrap();
        assert!((octant.solid_angle() - FRAC_PI_2).abs() <= 4.0 * f64::EPSILON);
        // Half of a face of the cube around the viewer.
        let half = seen([DVec3::NEG_ONE, DVec3::new(1.0, -1.0, -1.0), DVec3::new(-1.0, 1.0, -1.0)]);
        assert!((half.unwrap().solid_angle() - TAU / 6.0).abs() <= 8.0 * f64::EPSILON);
        // Tiny: its area over the squared distance, to second order in its size.
        let tiny =
            |size: f64| seen([DVec3::Z, DVec3::new(size, 0.0, 1.0), DVec3::new(0.0, size, 1.0)]);
        for size in [1e-8, 1e-20, 1e-90] {
            let found = tiny(size).unwrap().solid_angle();
            assert!((found / (0.5 * size * size) - 1.0).abs() <= size * size + 8.0 * f64::EPSILON);
        }
    }

    #[test]
    fn a_tiny_triangle_is_sampled_like_its_area() {
        // Nothing cancels: to first order in its size all points look alike.
        let (x, y) = (DVec3::X * 1e-12, DVec3::new(3e-13, 2e-12, 1e-12));
        let t = SphericalTriangle::new(DVec3::new(0.3, 0.2, 1.0), [x, y]).unwrap();
        let mut rng = Rng::new(5);
        for _ in 0..1000 {
            let [u, v] = [rng.f64(), rng.f64()];
            let at = t.sample([u, v]);
            let r = v.sqrt();
            let flat = DVec2::new(1.0 - r, r * u);
            assert!((at - flat).length() <= 1e-11, "{at} {flat}");
        }
    }

    #[test]
    fn the_density_over_the_area_is_one_over_the_solid_angle() {
        // Cells of the square that becomes the triangle with the squared height.
        let t = seen(SEEN[1].map(DVec3::from_array)).unwrap();
        let n = 12;
        let mut counts = Counts::new(n * n);
        let mut rng = Rng::new(6);
        for _ in 0..50_000 {
            let at = t.sample([rng.f64(), rng.f64()]);
            let height = at.x + at.y;
            counts.add(fraction_cell(height, n) * n + fraction_cell(at.x / height, n));
        }
        let fine = 16;
        counts.check(|cell| {
            let mut sum = 0.0;
            for i in 0..fine * fine {
                let part =
                    |i: usize, j: usize| (i as f64 + (j as f64 + 0.5) / fine as f64) / n as f64;
                let (height, along) = (part(cell / n, i / fine), part(cell % n, i % fine));
                sum += height * density(&t, DVec2::new(along, 1.0 - along) * height);
            }
            sum / (n * n * fine * fine) as f64
        });
    }

    #[test]
    fn what_cannot_be_told_is_refused_and_the_rest_is_a_point() {
        let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
        let flat = [[x, y, -x - y], [x, x + y, x * 2.0], [DVec3::ZERO, x, y], [x, z, x - z]];
        for corners in flat {
            assert!(seen(corners).is_none(), "{corners:?}");
        }
        assert!(SphericalTriangle::new(z, [x, x * 3.0]).is_none());
        assert!(SphericalTriangle::new(DVec3::NAN, [x, y]).is_none());
        assert!(SphericalTriangle::new(z, [DVec3::INFINITY, y]).is_none());
        assert!(SphericalTriangle::new(z * 1e120, [x * 1e120, y * 1e120]).is_none());
        assert!(SphericalTriangle::new(z * 1e-120, [x * 1e-120, y * 1e-120]).is_none());
        // Close to the plane, an edge or a corner: always a number, and a legal place.
        let top = 1.0f64.next_down();
        let mut kept = 0;
        for k in 0..60usize {
            let near = 0.1f64.powf((k / 3) as f64);
            let from = [DVec3::new(0.2, 0.3, near), DVec3::new(0.4, -near, near), -z * near];
            let Some(t) = SphericalTriangle::new(-from[k % 3], [x, y]) else { continue };
            kept += 1;
            assert!(t.solid_angle() > 0.0 && t.solid_angle() < TAU);
            for u in [0.0, 1e-9, 0.5, top] {
                for v in [0.0, 1e-9, 0.5, top] {
                    let at = t.sample([u, v]);
                    assert!(at.x >= 0.0 && at.y >= 0.0 && at.x + at.y <= 1.0 + f64::EPSILON);
                }
            }
        }
        assert!(kept > 30, "{kept}");
    }

    #[test]
    fn the_first_number_is_the_share_of_the_solid_angle_beside_the_first_edge() {
        let t = seen(SEEN[6].map(DVec3::from_array)).unwrap();
        let mut rng = Rng::new(8);
        for _ in 0..1000 {
            let u = rng.f64();
            let at = t.sample([u, 0.5 + 0.5 * rng.f64()]);
            let s = at.y / (1.0 - at.x);
            let part = omega(&t, [DVec2::ZERO, DVec2::X, DVec2::Y * s]);
            // Roundings of numbers below 2π, and 1 − x of a few hundredths, which has lost two digits.
            assert!((part - u * t.solid_angle()).abs() <= 1e-12, "{u}: {part}");
        }
    }
}
