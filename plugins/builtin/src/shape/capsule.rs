//! The capsule: a rod with round ends.

use std::cmp::Ordering;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64, sphere_roots};
use luxel_sdk::params::Fault;

use super::axial::{frame, length_of, local, place, turn_of, within_half_a_turn};

/// A solid rod with round ends: everything within `radius` of a line of length `height`.
///
/// Texture coordinates: `u` once around, `v` over the lower end, the side and the upper end in
/// proportion to their lengths.
///
/// ```scene
/// shape capsule { axis = (1, 0, 0), radius = 10 cm, height = 60 cm, material = paint }
/// ```
#[derive(Params, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Capsule {
    /// Middle of the lower round end, where the side begins.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    pub(crate) base: DVec3,
    /// Direction from the lower to the upper end; any length above 0.
    #[param(default = [0.0, 1.0, 0.0])]
    pub(crate) axis: DVec3,
    /// Of the side and of both ends; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) radius: f64,
    /// Length of the side, without the round ends; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) height: f64,
    /// Tangents and axis.
    #[param(derived)]
    frame: [DVec3; 3],
}

const SIDE: u32 = 0;
const LOW: u32 = 1;
const HIGH: u32 = 2;

impl Shape for Capsule {
    fn prepare(&mut self) {
        self.frame = frame(self.axis);
    }

    fn check(&self) -> Result<(), Fault> {
        super::check_direction("axis", self.axis)?;
        super::check_length("radius", self.radius)?;
        super::check_length("height", self.height)
    }

    fn bounds(&self) -> Bounds3 {
        let half = 0.5 * self.frame[2] * self.height;
        super::bounds_about(self.base + half, half.abs() + self.radius)
    }

    /// The endless rod is met first; where that is beyond an end, the ball there counts instead. It
    /// touches the rod in a circle, so that either will do at the seam.
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        length_of(ray)?;
        let (o, d) = (local(&self.frame, ray.o - self.base), local(&self.frame, ray.d));
        let (flat_o, flat_d) = (o.with_z(0.0), d.with_z(0.0));
        let (enter, leave) = if flat_d.length_squared() > 0.0 {
            sphere_roots(flat_o, flat_d, self.radius)?
        } else if flat_o.length_squared() <= self.radius * self.radius {
            (f64::NEG_INFINITY, f64::INFINITY)
        } else {
            return None;
        };
        let met = |t: f64, root: fn((f64, f64)) -> f64| {
            let z = if d.z == 0.0 { o.z } else { o.z + d.z * t };
            let ball = |z: f64| sphere_roots(o - DVec3::Z * z, d, self.radius).map(root);
            if z < 0.0 {
                Some((ball(0.0)?, LOW))
            } else if z > self.height {
                Some((ball(self.height)?, HIGH))
            } else {
                Some((t, SIDE))
            }
        };
        let first = met(enter, |roots| roots.0)?;
        let (t, face) = if first.0 > 0.0 { first } else { met(leave, |roots| roots.1)? };
        let at = self.place_of(o + d * t, face);
        (t > 0.0 && t <= ray.t_max && t < f64::INFINITY).then_some(Hit { t, at, face })
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Surface {
        self.surface_at(hit.face, hit.at)
    }

    fn area(&self) -> f64 {
        TAU * self.radius * self.length()
    }

    /// Along the axis and around it, where a slice of a ball has the area of one of its hull: uniform,
    /// or from outside over the arcs that can be seen, by how long these about are.
    ///
    /// # Source
    /// Archimedes, *On the Sphere and Cylinder*.
    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let seen = self.seen_from(from);
        let [u, v] = u.map(f64::from);
        let (z, half) = match &seen {
            Some(seen) => {
                let z = self.along(seen, v);
                (z, self.arc(&seen.viewer, z))
            }
            None => (v * self.length() - self.radius, PI),
        };
        let turn = seen.as_ref().map_or(0.0, |seen| seen.towards) + (u - 0.5) * 2.0 * half;
        let turn = within_half_a_turn(turn);
        let above = z - self.height;
        let surface = if z < 0.0 {
            self.surface_at(LOW, DVec2::new(turn, (z / self.radius).max(-1.0).asin()))
        } else if above > 0.0 {
            self.surface_at(HIGH, DVec2::new(turn, (above / self.radius).min(1.0).asin()))
        } else {
            self.surface_at(SIDE, DVec2::new(turn, z))
        };
        let pdf = self.density(seen.as_ref(), &surface);
        (pdf > 0.0 && pdf.is_finite()).then_some(ShapeSample { surface, pdf })
    }

    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        self.density(self.seen_from(from).as_ref(), at)
    }

    fn is_closed(&self) -> bool {
        true
    }

    fn distance(&self, p: DVec3) -> Option<f64> {
        let q = local(&self.frame, p - self.base);
        Some((q - DVec3::Z * q.z.clamp(0.0, self.height)).length() - self.radius)
    }

    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        let along = if hit.face == SIDE { DVec3::ZERO } else { at.dp_dv / self.radius };
        Some(NormalDerivatives { dn_du: at.dp_du / self.radius, dn_dv: along })
    }
}

/// Pieces of either end along the axis; the side is one.
const PIECES: usize = 4;
/// What is added to the length of an arc, radians: where a piece was asked nothing is seen, but
/// something may be beside.
const LEAST_ARC: f64 = 0.05;

/// What a viewer outside sees.
struct Seen {
    /// The viewer: distance from the axis, and height.
    viewer: DVec2,
    /// Where it stands around the axis, radians.
    towards: f64,
    /// Shares with which pieces are chosen, along the axis.
    weights: [f64; 2 * PIECES + 1],
}

impl Capsule {
    fn seen_from(&self, from: Option<DVec3>) -> Option<Seen> {
        let from = from.filter(|from| self.distance(*from).is_some_and(|away| away > 0.0))?;
        let q = local(&self.frame, from - self.base);
        let viewer = DVec2::new(q.x.hypot(q.y), q.z);
        let weights = std::array::from_fn(|i| {
            let (low, high) = self.piece(i);
            let arcs = [low, 0.5 * (low + high), high].map(|z| self.arc(&viewer, z));
            (high - low) * ((arcs[0] + 4.0 * arcs[1] + arcs[2]) / 6.0 + LEAST_ARC)
        });
        viewer.is_finite().then_some(Seen { viewer, towards: q.y.atan2(q.x), weights })
    }

    /// From where to where a piece goes along the axis.
    fn piece(&self, i: usize) -> (f64, f64) {
        let step = self.radius / PIECES as f64;
        let low = |i: usize| i as f64 * step - self.radius;
        match i.cmp(&PIECES) {
            Ordering::Less => (low(i), low(i + 1)),
            Ordering::Equal => (0.0, self.height),
            Ordering::Greater => {
                let start = self.height + (i - PIECES - 1) as f64 * step;
                (start, start + step)
            }
        }
    }

    /// The half of the arc at a height that faces the viewer, radians: where n · viewer > n · p, with
    /// n and p about the nearest point of the axis.
    fn arc(&self, viewer: &DVec2, z: f64) -> f64 {
        let from = z.clamp(0.0, self.height);
        let sin = ((z - from) / self.radius).clamp(-1.0, 1.0);
        let cos = ((1.0 - sin) * (1.0 + sin)).sqrt();
        let least = (self.radius - sin * (viewer.y - from)) / (cos * viewer.x);
        if least.is_nan() { 0.0 } else { least.clamp(-1.0, 1.0).acos() }
    }

    /// A height by the weights of the pieces; `v` uniform in [0, 1).
    fn along(&self, seen: &Seen, v: f64) -> f64 {
        let mut rest = v * seen.weights.iter().sum::<f64>();
        let mut i = 0;
        while i < 2 * PIECES && rest >= seen.weights[i] {
            rest -= seen.weights[i];
            i += 1;
        }
        let (low, high) = self.piece(i);
        low + (high - low) * (rest / seen.weights[i]).min(1.0)
    }

    /// Density over the area, m⁻², with which a point is sampled.
    fn density(&self, seen: Option<&Seen>, at: &Surface) -> f64 {
        let Some(seen) = seen else { return self.area().recip() };
        let q = local(&self.frame, at.p - self.base);
        let half = self.arc(&seen.viewer, q.z);
        let aside = q.y.atan2(q.x) - seen.towards;
        if !(within_half_a_turn(aside).abs() <= half && half > 0.0) {
            return 0.0;
        }
        let last = 2 * PIECES;
        let i = (0..last).find(|i| q.z < self.piece(*i).1).unwrap_or(last);
        let ((low, high), total) = (self.piece(i), seen.weights.iter().sum::<f64>());
        seen.weights[i] / (total * (high - low) * 2.0 * half * self.radius)
    }

    /// From end to end.
    fn length(&self) -> f64 {
        self.height + 2.0 * self.radius
    }

    /// Angle around the axis, and height on the side or latitude on a ball, of a local point.
    fn place_of(&self, p: DVec3, face: u32) -> DVec2 {
        let around = p.y.atan2(p.x);
        let flat = p.x.hypot(p.y);
        match face {
            SIDE => DVec2::new(around, p.z),
            LOW => DVec2::new(around, p.z.min(0.0).atan2(flat)),
            _ => DVec2::new(around, (p.z - self.height).max(0.0).atan2(flat)),
        }
    }

    /// The point of a face at angle and height or latitude.
    ///
    /// Error: sines, products and sums round ten times, the frame is orthonormal to eight
    /// roundings, and a ray that starts there is turned into the frame with eight more.
    fn surface_at(&self, face: u32, at: DVec2) -> Surface {
        let place = |x: f64, y: f64, z: f64| place(&self.frame, DVec3::new(x, y, z));
        let (sin, cos) = at.x.sin_cos();
        let arc = FRAC_PI_2 * self.radius;
        let (z, latitude, along) = match face {
            SIDE => {
                let z = at.y.clamp(0.0, self.height);
                (z, 0.0, arc + z)
            }
            LOW => (0.0, at.y, arc + self.radius * at.y),
            _ => (self.height, at.y, arc + self.height + self.radius * at.y),
        };
        let (up, out) = latitude.sin_cos();
        let ng = place(cos * out, sin * out, up).normalize();
        let whole = 2.0 * arc + self.height;
        // At an end ∂p/∂u vanishes: a direction of the right length in a tiny neighbourhood.
        let circle = TAU * self.radius * out.max(f64::EPSILON);
        Surface {
            p: self.base + (ng * self.radius + self.frame[2] * z),
            p_err: self.base.abs() * gamma64(3)
                + DVec3::splat((self.radius + self.height) * gamma64(26)),
            ng,
            ns: ng,
            uv: DVec2::new(turn_of(at.x), (along / whole).clamp(0.0, 1.0)),
            dp_du: place(-sin, cos, 0.0) * circle,
            dp_dv: place(-cos * up, -sin * up, out) * whole,
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::shape::testing::{
        Profile, check_against, check_convex, check_sampling, check_solid_angle, visible_area,
    };

    pub(in crate::shape) fn capsule(base: DVec3, radius: f64, height: f64) -> Capsule {
        let (axis, frame) = (DVec3::new(2.0, 6.0, -3.0), [DVec3::ZERO; 3]);
        let mut c = Capsule { base, axis, radius, height, frame };
        c.prepare();
        c
    }

    fn distance(c: &Capsule, p: DVec3) -> f64 {
        let q = Profile { base: c.base, axis: c.axis / 7.0 }.flat(p);
        (q - DVec2::Y * q.y.clamp(0.0, c.height)).length()
    }

    #[test]
    fn hits_and_offsets_hold_at_every_scale_and_distance() {
        for (base, scale) in [
            (DVec3::ZERO, 1.0),
            (DVec3::new(1e6, -1e6, 1e6), 1.0),
            (DVec3::ONE, 1e-6),
            (DVec3::ONE, 1e6),
        ] {
            for (radius, height) in [(1.0, 2.0), (1.0, 0.01), (0.05, 2.0)] {
                let c = capsule(base, radius * scale, height * scale);
                check_convex(&c, 61, |p| (distance(&c, p) - c.radius).abs());
            }
        }
    }

    #[test]
    fn hits_are_those_of_marching_rays() {
        for (radius, height) in [(1.0, 2.0), (1.0, 1e-3), (0.01, 2.0), (1e-6, 2e-6), (1e6, 1e6)] {
            let c = capsule(DVec3::ZERO, radius, height);
            check_against(&c, 62, |p| (distance(&c, p) - c.radius).abs());
        }
    }

    #[test]
    fn rays_along_the_axis_meet_both_ends() {
        let c = capsule(DVec3::ZERO, 1.0, 2.0);
        let z = c.frame[2];
        let top = c.intersect(&Ray::new(z * 7.0, -z)).unwrap();
        assert!((top.t - 4.0).abs() <= 1e-14 && top.face == HIGH);
        let bottom = c.intersect(&Ray::new(z, -z * 2.0)).unwrap();
        assert!((bottom.t - 1.0).abs() <= 1e-14 && bottom.face == LOW);
        // Axes as coordinates, with zeros of both signs.
        let mut upright = Capsule { axis: DVec3::Y, ..c };
        upright.prepare();
        for zero in [0.0, -0.0] {
            let ray = Ray::new(DVec3::new(0.5, 9.0, 0.0), DVec3::new(zero, -1.0, zero));
            let hit = upright.intersect(&ray).unwrap();
            assert!((hit.t - (7.0 - 0.75f64.sqrt())).abs() <= 1e-14);
            let beside = Ray { o: DVec3::new(1.5, 9.0, 0.0), ..ray };
            assert!(upright.intersect(&beside).is_none());
        }
    }

    #[test]
    fn rays_pass_or_meet_what_they_all_but_touch() {
        let c = capsule(DVec3::ZERO, 1.0, 2.0);
        let [x, y, z] = c.frame;
        for (reach, met) in [(1.0 - 1e-12, true), (1.0 + 1e-12, false)] {
            for foot in [x * reach + z, x * reach, z * (2.0 + reach), z * -reach] {
                let hit = c.intersect(&Ray::new(foot - y * 9.0, y));
                assert_eq!(hit.is_some(), met, "{foot}: {hit:?}");
            }
            let along = c.intersect(&Ray::new(x * reach - z * 9.0, z));
            assert_eq!(along.is_some(), met, "{along:?}");
        }
    }

    #[test]
    fn only_what_is_seen_is_sampled() {
        let c = capsule(DVec3::ONE, 0.7, 2.0);
        let at = |x: f64, y: f64, z: f64| place(&c.frame, DVec3::new(x, y, z)) + c.base;
        for (k, from) in (0..).zip([
            at(1.0, -1.0, 1.0),
            at(0.1, 0.2, 5.0),
            at(0.0, -2.0, -3.0),
            at(0.9, 0.1, -0.2),
            at(4.0, 1.0, 3.0),
        ]) {
            check_sampling(&c, Some(from), 66 + k);
            let mut rng = luxel_sdk::sampling::Rng::new(80 + k);
            let mut faces = 0;
            for _ in 0..4000 {
                let Some(s) = c.sample(Some(from), rng.pair()) else { continue };
                assert!((from - s.surface.p).dot(s.surface.ng) >= -1e-9, "{from}: {:?}", s.surface);
                faces += 1;
            }
            assert!(faces > 3200, "{from}: {faces} of 4000");
            check_solid_angle(&c, from, 90 + 2 * k);
        }
    }

    #[test]
    fn samples_cover_the_area_and_the_solid_angle() {
        let c = capsule(DVec3::ONE, 1.0, 2.0);
        assert!((c.area() - 4.0 * TAU).abs() <= 1e-14);
        check_sampling(&c, None, 63);
        assert!((visible_area(&c, None, 3, 64).mean / c.area() - 1.0).abs() <= 1e-15 * 4.0);
        check_solid_angle(&c, c.base + c.frame[2] * 4.0 + c.frame[0] * 3.0, 65);
    }

    #[test]
    fn impossible_capsules_are_refused() {
        assert_eq!(capsule(DVec3::ZERO, 0.0, 1.0).check().unwrap_err().field, "radius");
        assert_eq!(capsule(DVec3::ZERO, 1.0, f64::NAN).check().unwrap_err().field, "height");
        let c = Capsule { axis: DVec3::ZERO, ..capsule(DVec3::ZERO, 1.0, 1.0) };
        assert_eq!(c.check().unwrap_err().field, "axis");
    }
}
