//! The torus, exact for the thinnest tube and from any distance.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, Vec3Swizzles as _};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64};
use luxel_sdk::params::Fault;

use super::axial::{across, frame, length_of, local, place, turn_of};
use super::root::rising_root;

/// A ring with a round tube: closed.
///
/// Texture coordinates: `u` once around the axis, `v` once around the tube, from the outer rim
/// upwards.
///
/// ```scene
/// shape torus "ring" { axis = (0, 1, 0), radius = 9 mm, tube = 1 mm, material = gold }
/// ```
#[derive(Params, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Torus {
    /// The middle.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    pub(crate) center: DVec3,
    /// Through the hole; any length above 0.
    #[param(default = [0.0, 1.0, 0.0])]
    pub(crate) axis: DVec3,
    /// From the middle of the ring to that of the tube; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) radius: f64,
    /// Radius of the tube; greater than 0 and less than `radius`, a quarter of which it is unless
    /// given.
    #[param(optional, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) tube: f64,
    /// Radius of the tube, given or not.
    #[param(derived)]
    minor: f64,
    /// Tangents and axis.
    #[param(derived)]
    frame: [DVec3; 3],
}

impl Shape for Torus {
    fn prepare(&mut self) {
        self.frame = frame(self.axis);
        self.minor = self.given_or_usual();
    }

    fn check(&self) -> Result<(), Fault> {
        super::check_direction("axis", self.axis)?;
        super::check_length("radius", self.radius)?;
        let (tube, radius) = (self.given_or_usual(), self.radius);
        super::check_length("tube", tube)?;
        if tube < radius {
            return Ok(());
        }
        let message = format!("a tube of {tube} m closes the hole of a ring of {radius} m");
        Err(Fault::range("tube", message))
    }

    fn bounds(&self) -> Bounds3 {
        super::bounds_about(self.center, across(self.frame[2]) * self.radius + self.minor)
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let length = length_of(ray)?;
        // Lengths of the ring's radius, about the point of the line that is nearest to the middle.
        let far = local(&self.frame, ray.o - self.center) / self.radius;
        let d = local(&self.frame, ray.d / length);
        let shift = -far.dot(d);
        let near = far + d * shift;
        // Once more: what the first shift rounded was relative to the distance.
        let rest = -near.dot(d);
        let line = Line { o: near + d * rest, d, tube: self.minor / self.radius };
        let after = -(shift + rest);
        let before = ray.t_max * length / self.radius + after;
        let s = line.first(after, before + (before.abs() + after.abs()) * gamma64(8))?;
        let t = (s - after) * self.radius / length;
        let p = line.o + d * s;
        let at = DVec2::new(p.y.atan2(p.x), p.z.atan2(p.xy().length() - 1.0));
        (t > 0.0 && t <= ray.t_max && t < f64::INFINITY).then_some(Hit { t, at, face: 0 })
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Surface {
        self.surface_at(hit.at)
    }

    fn area(&self) -> f64 {
        TAU * self.radius * TAU * self.minor
    }

    /// Uniform around the axis. Around the tube the circles are longer outside: v + k sin v is
    /// uniform, with k = tube / radius, solved as Kepler's equation is.
    fn sample(&self, _from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let [around, mean] = u.map(|u| (f64::from(u) - 0.5) * TAU);
        let k = self.minor / self.radius;
        let v =
            rising_root((-PI, PI), mean, |v, _| Some((v + k * v.sin() - mean, 1.0 + k * v.cos())));
        Some(ShapeSample { surface: self.surface_at(DVec2::new(around, v)), pdf: self.pdf_all() })
    }

    fn pdf(&self, _from: Option<DVec3>, _at: &Surface) -> f64 {
        self.pdf_all()
    }

    fn is_closed(&self) -> bool {
        true
    }

    fn distance(&self, p: DVec3) -> Option<f64> {
        let q = local(&self.frame, p - self.center);
        Some((q.xy().length() - self.radius).hypot(q.z) - self.minor)
    }

    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        let out = hit.at.y.cos();
        let dn_du = at.dp_du * (out / (self.radius + self.minor * out));
        Some(NormalDerivatives { dn_du, dn_dv: at.dp_dv / self.minor })
    }
}

impl Torus {
    fn given_or_usual(&self) -> f64 {
        if self.tube == 0.0 { 0.25 * self.radius } else { self.tube }
    }

    fn pdf_all(&self) -> f64 {
        self.area().recip()
    }

    /// The point at angles around the axis and around the tube.
    ///
    /// Error: sines, products and sums round eight times, the frame is orthonormal to eight
    /// roundings, and a ray that starts there is turned into the frame, shifted and measured with
    /// sixteen more.
    fn surface_at(&self, at: DVec2) -> Surface {
        let place = |x: f64, y: f64, z: f64| place(&self.frame, DVec3::new(x, y, z));
        let ((sin, cos), (up, out)) = (at.x.sin_cos(), at.y.sin_cos());
        let ng = place(cos * out, sin * out, up).normalize();
        let reach = self.radius + self.minor;
        let turn = self.radius + self.minor * out;
        Surface {
            p: self.center + (place(cos, sin, 0.0) * self.radius + ng * self.minor),
            p_err: self.center.abs() * gamma64(3) + DVec3::splat(reach * gamma64(32)),
            ng,
            ns: ng,
            uv: DVec2::new(turn_of(at.x), turn_of(at.y)),
            dp_du: place(-sin, cos, 0.0) * (TAU * turn),
            dp_dv: place(-cos * up, -sin * up, out) * (TAU * self.minor),
        }
    }
}

/// A line in the frame of a ring of radius 1: unit direction, from its point nearest to the middle.
struct Line {
    o: DVec3,
    d: DVec3,
    tube: f64,
}

/// Room around the ring, in tubes and, where those are nothing, in radii: outside for certain.
const ROOM: (f64, f64) = (1e-6, 1e-14);

/// Below this distance from the axis the line counts as through it.
const ON_AXIS: f64 = 1e-10;

/// What is found at a place of a line.
#[derive(Clone, Copy)]
struct Look {
    s: f64,
    /// Distance to the tube: negative inside.
    gap: f64,
    /// Distance from the circle in the tube's middle.
    distance: f64,
    /// Half the first and second derivatives of the square of that.
    slope: f64,
    bend: f64,
}

impl Line {
    fn look(&self, s: f64) -> Look {
        let (o, d) = (self.o.xy(), self.d.xy());
        let (flat, z) = (o + d * s, self.o.z + self.d.z * s);
        let r = flat.length();
        let growth = if r > 0.0 { flat.dot(d) / r } else { 0.0 };
        let distance = ((r - 1.0) * (r - 1.0) + z * z).sqrt();
        let slope = z * self.d.z + (r - 1.0) * growth;
        // 1 − ρ'', see `concave`: (o × d)² = a δ².
        let cross = o.perp_dot(d);
        let bend = 1.0 - cross * cross / (r * r * r);
        Look { s, gap: distance - self.tube, distance, slope, bend }
    }

    /// The first root after `after`, unless it is far beyond `before`.
    ///
    /// Along the line the squared distance from the circle is s² + c − 2ρ(s), where ρ, the distance
    /// from the axis, is a hyperbola. So it is concave exactly where ρ'' > 1, which is one interval
    /// about the point nearest to the axis, and convex on either side: at most a minimum, a maximum
    /// and another minimum. A place inside the tube near a minimum, or outside near the maximum,
    /// splits the line into parts with one change of sign each, which is one root. Nothing is
    /// expanded into a quartic: the distance is measured at points and rounds like coordinates.
    fn first(&self, after: f64, before: f64) -> Option<f64> {
        let (low, high) = self.range()?;
        let low = low.max(after);
        if !(low < high && low <= before) {
            return None;
        }
        let (left, right) = self.concave().unwrap_or((high, high));
        let (left, right) = (left.clamp(low, high), right.clamp(low, high));
        let mut from = self.look(low);
        for (start, end, is_convex) in
            [(low, left, true), (left, right, false), (right, high, true)]
        {
            if from.s > before {
                return None;
            }
            if start < end
                && (from.gap > 0.0) == is_convex
                && let Some(to) = self.other_side(start, end)
            {
                if let Some(s) = self.between(from, to).filter(|s| *s > after) {
                    return Some(s);
                }
                from = to;
            }
        }
        self.between(from, self.look(high)).filter(|s| *s > after)
    }

    /// Between two places where the squared distance is convex and falls, then rises: a place inside
    /// the tube. Where it is concave and rises, then falls: one outside. `None` if there is none.
    fn other_side(&self, start: f64, end: f64) -> Option<Look> {
        let (first, last) = (self.look(start), self.look(end));
        let is_convex = first.slope <= 0.0;
        if is_convex == (last.slope <= 0.0) {
            return None;
        }
        let sign = if is_convex { 1.0 } else { -1.0 };
        let mut found = None;
        rising_root((start, end), 0.5 * (start + end), |s, room| {
            let at = self.look(s);
            found = ((at.gap > 0.0) != is_convex).then_some(at);
            // The extremum is within `room`, and the distance changes by no more than the way.
            let none = at.gap.abs() > room;
            (found.is_none() && !none).then_some((sign * at.slope, sign * at.bend))
        });
        found
    }

    /// Where the line is within the ball and between the planes that hold the ring.
    fn range(&self) -> Option<(f64, f64)> {
        let reach = self.tube * (1.0 + ROOM.0) + ROOM.1;
        let half = (1.0 + reach - self.o.length()) * (1.0 + reach + self.o.length());
        let ball = if half > 0.0 { half.sqrt() } else { return None };
        let (mut low, mut high) = (-ball, ball);
        if self.d.z != 0.0 {
            let (a, b) = ((-reach - self.o.z) / self.d.z, (reach - self.o.z) / self.d.z);
            (low, high) = (low.max(a.min(b)), high.min(a.max(b)));
        } else if self.o.z.abs() > reach {
            return None;
        }
        (low < high).then_some((low, high))
    }

    /// Where ρ'' = a δ² / ρ³ exceeds 1, with ρ² = a (s − s₀)² + δ²: δ is the least distance from
    /// the axis.
    fn concave(&self) -> Option<(f64, f64)> {
        let (o, d) = (self.o.xy(), self.d.xy());
        let a = d.length_squared();
        let least = o.perp_dot(d).abs() / a.sqrt();
        if !(least < a) {
            return None;
        }
        let middle = -o.dot(d) / a;
        let edge = (a * least * least).cbrt();
        let half = ((edge - least) * (edge + least) / a).max(0.0).sqrt().max(ON_AXIS);
        middle.is_finite().then_some((middle - half, middle + half))
    }

    /// The only change of sign between two places, if there is one.
    fn between(&self, from: Look, to: Look) -> Option<f64> {
        let sign = match (from.gap > 0.0, to.gap > 0.0) {
            (true, false) => -1.0,
            (false, true) => 1.0,
            _ => return None,
        };
        // From outside, as far as the tube is away at least.
        let start = if from.gap > 0.0 { from.s + from.gap } else { to.s - to.gap };
        Some(rising_root((from.s, to.s), start.clamp(from.s, to.s), |s, _| {
            let at = self.look(s);
            Some((sign * at.gap, sign * at.slope / at.distance))
        }))
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::shape::testing::{Profile, check_against, check_sampling, visible_area};
    use luxel_sdk::num::offset_origin;
    use luxel_sdk::sampling::Rng;

    pub(in crate::shape) fn torus(center: DVec3, radius: f64, tube: f64) -> Torus {
        let (axis, frame) = (DVec3::new(2.0, 6.0, -3.0), [DVec3::ZERO; 3]);
        let mut t = Torus { center, axis, radius, tube, minor: 0.0, frame };
        t.prepare();
        t
    }

    fn distance(t: &Torus, p: DVec3) -> f64 {
        let q = Profile { base: t.center, axis: t.axis / 7.0 }.flat(p);
        ((q - DVec2::X * t.radius).length() - t.minor).abs()
    }

    #[test]
    fn hits_are_those_of_marching_rays() {
        for tube in [0.3, 0.01, 1e-4, 0.9, 0.999] {
            for scale in [1.0, 1e-6, 1e6] {
                let t = torus(DVec3::ZERO, scale, scale * tube);
                check_against(&t, 71, |p| distance(&t, p));
            }
        }
    }

    #[test]
    fn a_line_crosses_it_up_to_four_times() {
        let t = torus(DVec3::ZERO, 2.0, 0.5);
        let [x, y, z] = t.frame;
        let crossings = |o: DVec3, d: DVec3| {
            let (mut o, mut found) = (o, vec![]);
            while let Some(hit) = t.intersect(&Ray::new(o, d)) {
                let ray = Ray::new(o, d);
                let at = t.surface(&ray, &hit);
                found.push((at.p - x * -5.0).dot(d));
                o = offset_origin(at.p, at.p_err, at.ng, d);
            }
            found
        };
        let through = crossings(x * -5.0, x);
        for (found, truth) in through.iter().zip([2.5, 3.5, 6.5, 7.5]) {
            assert!((found - truth).abs() <= 1e-14, "{through:?}");
        }
        assert_eq!(through.len(), 4);
        assert_eq!(crossings(z * 5.0, -z).len(), 0, "through the hole");
        assert_eq!(crossings(z * 5.0 + x * 2.0, -z).len(), 2, "parallel to the axis");
        assert_eq!(crossings(x * 2.0 - y * 9.0, y).len(), 2);
        // Tangent to the inner equator: into the tube, along the rim of the hole, and out.
        let inner = crossings(x * (1.5 + 1e-9) - y * 9.0, y);
        assert_eq!(inner.len(), 2, "{inner:?}");
        let inner = crossings(x * (1.5 - 1e-9) - y * 9.0, y);
        assert_eq!(inner.len(), 4, "{inner:?}");
        // Resting on it as a plate: just above and just below the top.
        assert_eq!(crossings(z * (0.5 + 1e-12) - x * 9.0, x).len(), 0);
        assert_eq!(crossings(z * (0.5 - 1e-12) - x * 9.0, x).len(), 4);
    }

    #[test]
    fn rays_leave_without_meeting_the_place_they_left() {
        let mut rng = Rng::new(72);
        for (center, radius, tube) in [
            (DVec3::ZERO, 1.0, 0.3),
            (DVec3::new(1e6, -1e6, 1e6), 1.0, 0.3),
            (DVec3::ONE, 1e-6, 1e-9),
            (DVec3::ONE, 1e6, 9.9e5),
        ] {
            let t = torus(center, radius, tube);
            for i in 0..2000 {
                let Some(s) = t.sample(None, rng.pair()) else { continue };
                let at = s.surface;
                let slack = at.p_err.dot(at.ng.abs()) + gamma64(4) * at.p.abs().dot(at.ng.abs());
                assert!(distance(&t, at.p) <= slack);
                let mut d = crate::shape::testing::direction(&mut rng);
                if i % 2 == 0 {
                    d = d.cross(at.ng).normalize() + at.ng * [1e-3, 1e-2, 0.1][i % 3];
                }
                for d in [d, -d] {
                    let o = offset_origin(at.p, at.p_err, at.ng, d);
                    let hit = t.intersect(&Ray::new(o, d));
                    let again = hit.is_some_and(|h| h.t <= 0.01 * tube * d.dot(at.ng).abs());
                    assert!(!again, "{d} from {o}: {hit:?}");
                    assert!(d.dot(at.ng) > 0.0 || hit.is_some(), "{d} from {o} finds no way out");
                }
            }
        }
    }

    #[test]
    fn samples_cover_the_area_evenly() {
        let t = torus(DVec3::ONE, 2.0, 0.5);
        assert!((t.area() - 4.0 * PI * PI).abs() <= 1e-13);
        check_sampling(&t, None, 73);
        assert!((visible_area(&t, None, 3, 74).mean / t.area() - 1.0).abs() <= 4e-15);
        let fat = torus(DVec3::ZERO, 1.0, 0.999);
        check_sampling(&fat, None, 75);
        // The mean distance from the axis, by area: R + r²/2R (Pappus, about the tube's middle).
        let mut rng = Rng::new(76);
        let profile = Profile { base: t.center, axis: t.axis / 7.0 };
        let mut mean = luxel_sdk::num::Moments::default();
        for _ in 0..20_000 {
            mean.push(profile.flat(t.sample(None, rng.pair()).unwrap().surface.p).x);
        }
        assert!((mean.mean - (2.0 + 0.25 / 4.0)).abs() <= 5.0 * mean.standard_error());
    }

    #[test]
    fn a_tube_that_closes_the_hole_is_refused() {
        assert_eq!(torus(DVec3::ZERO, 1.0, 1.0).check().unwrap_err().field, "tube");
        assert_eq!(torus(DVec3::ZERO, 1.0, -0.1).check().unwrap_err().field, "tube");
        assert_eq!(torus(DVec3::ZERO, f64::NAN, 1.0).check().unwrap_err().field, "radius");
        assert!(torus(DVec3::ZERO, 1.0, 0.999).check().is_ok());
        let usual = torus(DVec3::ZERO, 1.0, 0.0);
        assert!(usual.check().is_ok() && (usual.bounds().diagonal().max_element() < 2.6));
    }
}
