//! The cylinder, open or closed.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64, sphere_roots};
use luxel_sdk::params::Fault;
use luxel_sdk::sampling::disk_concentric;

use super::axial::within_half_a_turn;

/// A round tube, or with `caps` a solid rod.
///
/// Texture coordinates on the side: `u` once around, `v` from the base to the top.
///
/// ```scene
/// shape cylinder { base = (0, 0, 0) m, axis = (0, 1, 0), radius = 1 cm, height = 90 cm, material = steel }
/// ```
#[derive(Params, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Cylinder {
    /// Middle of the lower end.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    pub(crate) base: DVec3,
    /// Direction from the base to the top; any length above 0.
    #[param(default = [0.0, 1.0, 0.0])]
    pub(crate) axis: DVec3,
    /// Greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) radius: f64,
    /// From the base to the top; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) height: f64,
    /// Whether both ends are closed by disks.
    #[param(default = false)]
    pub(crate) caps: bool,
    #[param(derived)]
    x: DVec3,
    #[param(derived)]
    y: DVec3,
    #[param(derived)]
    z: DVec3,
}

const SIDE: u32 = 0;
const BOTTOM: u32 = 1;
const TOP: u32 = 2;

impl Shape for Cylinder {
    fn prepare(&mut self) {
        self.z = (self.axis / self.axis.abs().max_element()).normalize();
        (self.x, self.y) = self.z.any_orthonormal_pair();
    }

    fn check(&self) -> Result<(), Fault> {
        super::check_direction("axis", self.axis)?;
        super::check_length("radius", self.radius)?;
        super::check_length("height", self.height)
    }

    fn bounds(&self) -> Bounds3 {
        let across = (DVec3::ONE - self.z * self.z).max(DVec3::ZERO).map(f64::sqrt) * self.radius;
        let along = self.z * self.height;
        super::bounds_about(self.base + 0.5 * along, across + 0.5 * along.abs())
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (o, d) = (self.local(ray.o - self.base), self.local(ray.d));
        let (flat_o, flat_d) = (o.with_z(0.0), d.with_z(0.0));
        let side = if flat_d.length_squared() > 0.0 {
            sphere_roots(flat_o, flat_d, self.radius)?
        } else if self.caps && flat_o.length_squared() <= self.radius * self.radius {
            (f64::NEG_INFINITY, f64::INFINITY)
        } else {
            return None;
        };
        let (t, face) = if self.caps {
            self.solid(side, o.z, d.z)?
        } else {
            let found = |t: &f64| *t > 0.0 && (0.0..=self.height).contains(&(o.z + d.z * t));
            ([side.0, side.1].into_iter().find(found)?, SIDE)
        };
        let p = o + d * t;
        let at = if face == SIDE { DVec2::new(p.y.atan2(p.x), p.z) } else { p.truncate() };
        (t > 0.0 && t <= ray.t_max && t < f64::INFINITY).then_some(Hit { t, at, face })
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Surface {
        self.surface_at(hit.face, hit.at)
    }

    fn area(&self) -> f64 {
        self.side_area() + if self.caps { 2.0 * self.cap_area() } else { 0.0 }
    }

    /// Uniform over the area that can be seen, of a solid rod from outside; else over all of it.
    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let seen = self.seen_from(from);
        let side = seen.side(self);
        let rest = f64::from(u[0]) * seen.area(self);
        let surface = if rest < side || seen.caps[0] + seen.caps[1] <= 0.0 {
            let turn = seen.towards + (rest / side - 0.5) * 2.0 * seen.half;
            self.surface_at(
                SIDE,
                DVec2::new(within_half_a_turn(turn), f64::from(u[1]) * self.height),
            )
        } else {
            let (rest, low) = (rest - side, seen.caps[0]);
            let (face, rest) =
                if rest < low { (BOTTOM, rest / low) } else { (TOP, (rest - low) / seen.caps[1]) };
            #[expect(clippy::cast_possible_truncation, reason = "a random number again")]
            let across = rest as f32;
            let on_disk = disk_concentric([across.clamp(0.0, 1.0), u[1]]).as_dvec2();
            self.surface_at(face, on_disk.clamp_length_max(1.0) * self.radius)
        };
        let pdf = self.density(&seen, &surface);
        (pdf > 0.0 && pdf.is_finite()).then_some(ShapeSample { surface, pdf })
    }

    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        self.density(&self.seen_from(from), at)
    }

    fn is_closed(&self) -> bool {
        self.caps
    }

    /// Of a solid rod: that of the rectangle which it is around its axis.
    fn distance(&self, p: DVec3) -> Option<f64> {
        let q = self.local(p - self.base);
        let half = 0.5 * self.height;
        let out = DVec2::new(q.truncate().length() - self.radius, (q.z - half).abs() - half);
        self.caps.then(|| out.max(DVec2::ZERO).length() + out.max_element().min(0.0))
    }

    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        let round = NormalDerivatives { dn_du: at.dp_du / self.radius, dn_dv: DVec3::ZERO };
        Some(if hit.face == SIDE { round } else { NormalDerivatives::FLAT })
    }
}

/// What a viewer sees.
struct Seen {
    /// Where the viewer stands around the axis, radians, and how far to either side of that the side
    /// faces it.
    towards: f64,
    half: f64,
    /// Areas of bottom and top, 0 for one that is not seen.
    caps: [f64; 2],
}

impl Seen {
    fn side(&self, of: &Cylinder) -> f64 {
        2.0 * self.half * of.radius * of.height
    }

    fn area(&self, of: &Cylinder) -> f64 {
        self.side(of) + self.caps[0] + self.caps[1]
    }
}

/// Shares of the whole area that are as good as nothing: a viewer so near is as good as inside.
const LEAST: f64 = 1e-6;

impl Cylinder {
    fn seen_from(&self, from: Option<DVec3>) -> Seen {
        let cap = if self.caps { self.cap_area() } else { 0.0 };
        let all = Seen { towards: 0.0, half: PI, caps: [cap; 2] };
        let Some(from) = from.filter(|_| self.caps) else { return all };
        let q = self.local(from - self.base);
        let far = q.truncate().length();
        let half = if far > self.radius { (self.radius / far).acos() } else { 0.0 };
        let caps = [q.z < 0.0, q.z > self.height].map(|is_seen| if is_seen { cap } else { 0.0 });
        let seen = Seen { towards: q.y.atan2(q.x), half, caps };
        if seen.area(self) > LEAST * self.area() { seen } else { all }
    }

    /// Density over the area, m⁻², with which a point is sampled.
    fn density(&self, seen: &Seen, at: &Surface) -> f64 {
        let n = self.local(at.ng);
        let is_seen = if n.z.abs() > 0.5 {
            seen.caps[usize::from(n.z > 0.0)] > 0.0
        } else {
            let aside = n.y.atan2(n.x) - seen.towards;
            within_half_a_turn(aside).abs() <= seen.half
        };
        if is_seen { seen.area(self).recip() } else { 0.0 }
    }

    fn side_area(&self) -> f64 {
        TAU * self.radius * self.height
    }

    fn cap_area(&self) -> f64 {
        PI * self.radius * self.radius
    }

    fn local(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// Entry or exit of the solid: the overlap of the infinite rod with the slab of its ends.
    fn solid(&self, side: (f64, f64), o: f64, d: f64) -> Option<(f64, u32)> {
        let (mut enter, mut leave) = ((side.0, SIDE), (side.1, SIDE));
        if d == 0.0 {
            if !(0.0..=self.height).contains(&o) {
                return None;
            }
        } else {
            let (bottom, top) = ((-o / d, BOTTOM), ((self.height - o) / d, TOP));
            let (near, far) = if d > 0.0 { (bottom, top) } else { (top, bottom) };
            enter = if near.0 > enter.0 { near } else { enter };
            leave = if far.0 < leave.0 { far } else { leave };
        }
        let first = if enter.0 > 0.0 { enter } else { leave };
        (enter.0 <= leave.0).then_some(first)
    }

    /// The point of a face: on the side at (angle in radians, height in metres), on a cap at
    /// metres about its middle.
    ///
    /// Error: sines, products and sums round eight times, the frame is orthonormal to eight
    /// roundings, and a ray that starts there is turned into the frame with eight more.
    fn surface_at(&self, face: u32, at: DVec2) -> Surface {
        let place = |x: f64, y: f64, z: f64| self.x * x + self.y * y + self.z * z;
        let size = self.radius + self.height;
        let p_err = self.base.abs() * gamma64(3) + DVec3::splat(size * gamma64(24));
        if face == SIDE {
            let (sin, cos) = at.x.sin_cos();
            let z = at.y.clamp(0.0, self.height);
            let ng = place(cos, sin, 0.0).normalize();
            let turn = at.x / TAU;
            let u = if turn < 0.0 { turn + 1.0 } else { turn };
            return Surface {
                p: self.base + (ng * self.radius + self.z * z),
                p_err,
                ng,
                ns: ng,
                uv: DVec2::new(u, z / self.height),
                dp_du: place(-sin, cos, 0.0) * (TAU * self.radius),
                dp_dv: self.z * self.height,
            };
        }
        let (z, side) = if face == TOP { (self.height, 1.0) } else { (0.0, -1.0) };
        Surface {
            p: self.base + place(at.x, at.y, z),
            p_err,
            ng: self.z * side,
            ns: self.z * side,
            uv: DVec2::new(side * at.x, at.y) / (2.0 * self.radius) + 0.5,
            dp_du: self.x * (side * 2.0 * self.radius),
            dp_dv: self.y * (2.0 * self.radius),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::testing::{check_convex, check_sampling, check_solid_angle, visible_area};

    fn cylinder(base: DVec3, radius: f64, height: f64, caps: bool) -> Cylinder {
        let axis = DVec3::new(2.0, 6.0, -3.0);
        let zero = DVec3::ZERO;
        let mut c = Cylinder { base, axis, radius, height, caps, x: zero, y: zero, z: zero };
        c.prepare();
        c
    }

    fn residual(c: &Cylinder, p: DVec3) -> f64 {
        let axis = c.axis / 7.0;
        let z = axis.dot(p - c.base);
        let r = (p - c.base - axis * z).length();
        (r - c.radius).max(z - c.height).max(-z).abs()
    }

    #[test]
    fn hits_and_offsets_hold_at_every_scale_and_distance() {
        for (base, scale) in [
            (DVec3::ZERO, 1.0),
            (DVec3::new(1e6, -1e6, 1e6), 1.0),
            (DVec3::ONE, 1e-6),
            (DVec3::ONE, 1e6),
        ] {
            let c = cylinder(base, scale, 2.0 * scale, true);
            check_convex(&c, 41, |p| residual(&c, p));
        }
    }

    #[test]
    fn an_open_tube_shows_its_inside() {
        let c = cylinder(DVec3::ZERO, 1.0, 2.0, false);
        let (axis, across) = (c.axis / 7.0, c.x);
        assert!(c.intersect(&Ray::new(-axis, axis)).is_none());
        let ray = Ray::new(-axis, axis * 2.0 + across * 0.9);
        let hit = c.intersect(&ray).unwrap();
        assert!(c.surface(&ray, &hit).ng.dot(ray.d) > 0.0, "seen from inside");
        assert!(!c.is_closed() && cylinder(DVec3::ZERO, 1.0, 2.0, true).is_closed());
        let through = Ray::new(across * 5.0 + axis, -across);
        assert!((c.intersect(&through).unwrap().t - 4.0).abs() <= 1e-14);
        assert!(c.intersect(&Ray::new(across * 5.0 + axis * 2.5, -across)).is_none());
    }

    #[test]
    fn rays_along_the_axis_meet_the_caps() {
        let c = cylinder(DVec3::ZERO, 1.0, 2.0, true);
        let axis = c.z;
        let hit = c.intersect(&Ray::new(axis * 5.0 + c.x * 0.5, -axis)).unwrap();
        assert!((hit.t - 3.0).abs() <= 1e-14 && hit.face == TOP);
        let inside = c.intersect(&Ray::new(axis + c.x * 0.5, -axis)).unwrap();
        assert!((inside.t - 1.0).abs() <= 1e-14 && inside.face == BOTTOM);
    }

    #[test]
    fn samples_cover_the_area_and_the_solid_angle() {
        for caps in [false, true] {
            let c = cylinder(DVec3::ONE, 1.0, 2.0, caps);
            check_sampling(&c, None, 42);
            let truth = TAU * if caps { 3.0 } else { 2.0 };
            assert!((c.area() - truth).abs() <= 1e-14);
        }
        // Closed, as in a tube one side hides another, which the samples do not see.
        let c = cylinder(DVec3::ZERO, 1.0, 2.0, true);
        check_solid_angle(&c, c.z * 3.0 + c.x * 3.0, 43);
    }

    #[test]
    fn distances_are_to_the_side_to_a_cap_or_to_its_rim() {
        let c = cylinder(DVec3::ONE, 1.0, 2.0, true);
        let at = |x: f64, z: f64| c.distance(c.base + c.x * x + c.z * z).unwrap();
        for (x, z, truth) in
            [(3.0, 1.0, 2.0), (0.5, 4.0, 2.0), (4.0, 6.0, 5.0), (0.8, 1.0, -0.2), (0.0, 0.3, -0.3)]
        {
            assert!((at(x, z) - truth).abs() < 1e-14, "{x} {z}: {}", at(x, z));
        }
        assert!(cylinder(DVec3::ONE, 1.0, 2.0, false).distance(DVec3::ZERO).is_none());
    }

    #[test]
    fn only_what_is_seen_of_a_rod_is_sampled() {
        let c = cylinder(DVec3::ONE, 1.0, 2.0, true);
        let at = |x: f64, y: f64, z: f64| c.base + c.x * x + c.y * y + c.z * z;
        // Half of the side at most, by the arccosine of 1/2; a cap; both; and all from inside.
        let third = TAU / 3.0 * 2.0;
        for (k, (from, seen)) in (0..).zip([
            (at(1.2, -1.6, 1.0), third),
            (at(0.1, 0.2, 5.0), PI),
            (at(0.0, -2.0, -3.0), third + PI),
            (at(0.3, 0.2, 0.5), c.area()),
        ]) {
            check_sampling(&c, Some(from), 44 + k);
            let area = visible_area(&c, Some(from), 20_000, 54 + k).mean;
            assert!((area / seen - 1.0).abs() < 1e-3, "{from}: {area} {seen}");
        }
        check_solid_angle(&c, at(1.2, -1.6, 2.5), 45);
    }

    #[test]
    fn impossible_cylinders_are_refused() {
        assert!(cylinder(DVec3::ZERO, 0.0, 1.0, false).check().is_err());
        assert!(cylinder(DVec3::ZERO, 1.0, f64::NAN, false).check().is_err());
        let c = Cylinder { axis: DVec3::ZERO, ..cylinder(DVec3::ZERO, 1.0, 1.0, false) };
        assert_eq!(c.check().unwrap_err().field, "axis");
    }
}
