//! The cone, whole or truncated, open or closed.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3, Vec3Swizzles as _};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64};
use luxel_sdk::params::Fault;
use luxel_sdk::sampling::disk_concentric;

use super::axial::{across, frame, length_of, local, place, turn_of};

/// A cone with its point up, or with `top_radius` a frustum; with `caps` it is solid.
///
/// Texture coordinates on the side: `u` once around, `v` from the base to the top.
///
/// ```scene
/// shape cone "lampshade" { radius = 20 cm, top_radius = 8 cm, height = 25 cm, material = paint }
/// shape cone "spire"     { radius = 1 m, height = 4 m, caps = true, material = white }
/// ```
#[derive(Params, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Cone {
    /// Middle of the lower end.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    pub(crate) base: DVec3,
    /// Direction from the base to the top; any length above 0.
    #[param(default = [0.0, 1.0, 0.0])]
    pub(crate) axis: DVec3,
    /// Radius at the base; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) radius: f64,
    /// Radius at the top; 0 for a point.
    #[param(default = 0.0, unit = "m", min = 0)]
    pub(crate) top_radius: f64,
    /// From the base to the top; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) height: f64,
    /// Whether both ends are closed by disks.
    #[param(default = false)]
    pub(crate) caps: bool,
    /// Tangents and axis.
    #[param(derived)]
    frame: [DVec3; 3],
    /// Growth of the radius along the axis.
    #[param(derived)]
    slope: f64,
}

const SIDE: u32 = 0;
const BOTTOM: u32 = 1;
const TOP: u32 = 2;

/// Parameters of a line, each with the face that is met there.
type Crossing = (f64, u32);

impl Shape for Cone {
    fn prepare(&mut self) {
        self.frame = frame(self.axis);
        self.slope = (self.top_radius - self.radius) / self.height;
    }

    fn check(&self) -> Result<(), Fault> {
        super::check_direction("axis", self.axis)?;
        super::check_length("radius", self.radius)?;
        super::check_length("height", self.height)?;
        if self.top_radius > 0.0 {
            super::check_length("top_radius", self.top_radius)
        } else {
            Ok(())
        }
    }

    fn bounds(&self) -> Bounds3 {
        let (z, across) = (self.frame[2], across(self.frame[2]));
        let ring = |radius: f64, z: DVec3| super::bounds_about(self.base + z, across * radius);
        // The room is for the larger end and for what the height rounds.
        let (low, top) = (ring(self.radius, DVec3::ZERO), ring(self.top_radius, z * self.height));
        let room = DVec3::splat((self.radius + self.height) * gamma64(8));
        let all = low.union(top);
        Bounds3 { min: all.min - room, max: all.max + room }
    }

    /// What the slab of both ends and the cone, which is convex there, have in common.
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let length = length_of(ray)?;
        let o = local(&self.frame, ray.o - self.base);
        let d = local(&self.frame, ray.d / length);
        let (near, far) = self.slab(o.z, d.z)?;
        // The point between both ends that is nearest to the axis: all that counts is then about as
        // small as the cone, however far away the ray began.
        let flat = d.xy().length_squared();
        let nearest = if flat > 0.0 { -o.xy().dot(d.xy()) / flat } else { 0.0 };
        let start = nearest.max(near.0).min(far.0);
        let line = Line { o: o + d * start, d, radius: self.radius, slope: self.slope };
        let side = line.side()?.map(|s| start + line.polished(s));
        let (t, face) = if self.caps {
            let enter = if near.0 > side[0] { near } else { (side[0], SIDE) };
            let leave = if far.0 < side[1] { far } else { (side[1], SIDE) };
            let first = if enter.0 > 0.0 { enter } else { leave };
            (enter.0 <= leave.0).then_some(first)?
        } else {
            let found = |t: &f64| *t > 0.0 && (near.0..=far.0).contains(t);
            (side.into_iter().find(found)?, SIDE)
        };
        let p = line.o + d * (t - start);
        let at = if face == SIDE { DVec2::new(p.y.atan2(p.x), p.z) } else { p.xy() };
        let t = t / length;
        (t > 0.0 && t <= ray.t_max && t < f64::INFINITY).then_some(Hit { t, at, face })
    }

    fn surface(&self, _ray: &Ray, hit: &Hit) -> Surface {
        self.surface_at(hit.face, hit.at)
    }

    fn area(&self) -> f64 {
        let [side, bottom, top] = self.areas();
        side + bottom + top
    }

    fn sample(&self, _from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let [side, bottom, top] = self.areas();
        let (mut rest, v) = (f64::from(u[0]) * self.area(), f64::from(u[1]));
        let surface = if rest < side || bottom + top <= 0.0 {
            // The circles grow with the radius: its square is uniform.
            let (low, high) = (self.radius, self.top_radius);
            let r = (low * low + v * (high - low) * (high + low)).max(0.0).sqrt();
            let part = v * (low + high) / (low + r);
            self.surface_at(SIDE, DVec2::new((rest / side - 0.5) * TAU, part * self.height))
        } else {
            rest -= side;
            let on_bottom = rest < bottom || top <= 0.0;
            let (face, part, radius) = if on_bottom {
                (BOTTOM, rest / bottom, self.radius)
            } else {
                (TOP, (rest - bottom) / top, self.top_radius)
            };
            #[expect(clippy::cast_possible_truncation, reason = "a random number again")]
            let across = (part as f32).clamp(0.0, 1.0);
            let on_disk = disk_concentric([across, u[1]]).as_dvec2();
            self.surface_at(face, on_disk.clamp_length_max(1.0) * radius)
        };
        Some(ShapeSample { surface, pdf: self.area().recip() })
    }

    fn pdf(&self, _from: Option<DVec3>, _at: &Surface) -> f64 {
        self.area().recip()
    }

    fn is_closed(&self) -> bool {
        self.caps
    }

    /// None at an apex.
    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        if hit.face != SIDE {
            return Some(NormalDerivatives::FLAT);
        }
        // The normal leans outwards by as much all around.
        let radius = self.radius + self.slope * hit.at.y;
        let dn_du = at.dp_du / (radius * 1f64.hypot(self.slope));
        let told = radius > 0.0 && dn_du.is_finite();
        told.then_some(NormalDerivatives { dn_du, dn_dv: DVec3::ZERO })
    }
}

impl Cone {
    /// Areas of the side and of both caps.
    fn areas(&self) -> [f64; 3] {
        let (low, top) = (self.radius, self.top_radius);
        let caps = if self.caps { PI } else { 0.0 };
        [PI * (low + top) * self.height.hypot(top - low), caps * low * low, caps * top * top]
    }

    /// Where a line is between both ends; `None` if nowhere.
    fn slab(&self, o: f64, d: f64) -> Option<(Crossing, Crossing)> {
        if d == 0.0 {
            let all = ((f64::NEG_INFINITY, SIDE), (f64::INFINITY, SIDE));
            return (0.0..=self.height).contains(&o).then_some(all);
        }
        let (bottom, top) = ((-o / d, BOTTOM), ((self.height - o) / d, TOP));
        let finite = bottom.0.is_finite() && top.0.is_finite();
        finite.then_some(if d > 0.0 { (bottom, top) } else { (top, bottom) })
    }

    /// The point of a face: on the side at (angle in radians, height in metres), on a cap at
    /// metres about its middle.
    ///
    /// Error: sines, products and sums round eight times, the frame is orthonormal to eight
    /// roundings, and a ray that starts there is turned into the frame with eight more and finds
    /// its distance to the side with four.
    fn surface_at(&self, face: u32, at: DVec2) -> Surface {
        let place = |x: f64, y: f64, z: f64| place(&self.frame, DVec3::new(x, y, z));
        let size = self.radius.max(self.top_radius) + self.height;
        let p_err = self.base.abs() * gamma64(3) + DVec3::splat(size * gamma64(28));
        if face == SIDE {
            let (sin, cos) = at.x.sin_cos();
            let z = at.y.clamp(0.0, self.height);
            let v = z / self.height;
            let r = self.radius + (self.top_radius - self.radius) * v;
            let ng = place(cos, sin, -self.slope).normalize();
            let grows = self.top_radius - self.radius;
            // At the point ∂p/∂u vanishes: a direction of the right length close by.
            let circle = TAU * r.max(f64::EPSILON * self.radius.max(self.top_radius));
            return Surface {
                p: self.base + place(cos * r, sin * r, z),
                p_err,
                ng,
                ns: ng,
                uv: DVec2::new(turn_of(at.x), v),
                dp_du: place(-sin, cos, 0.0) * circle,
                dp_dv: place(cos * grows, sin * grows, self.height),
            };
        }
        let top = face == TOP;
        let (z, side) = if top { (self.height, 1.0) } else { (0.0, -1.0) };
        let width = 2.0 * if top { self.top_radius } else { self.radius };
        // A ray through the point of a closed cone may name its top.
        let width = if width > 0.0 { width } else { f64::EPSILON * self.radius };
        let ng = self.frame[2] * side;
        Surface {
            p: self.base + place(at.x, at.y, z),
            p_err,
            ng,
            ns: ng,
            uv: DVec2::new(side * at.x, at.y) / width + 0.5,
            dp_du: self.frame[0] * (side * width),
            dp_dv: self.frame[1] * width,
        }
    }
}

/// A line in the frame of the cone: unit direction, from the point between both ends that is
/// nearest to the axis.
struct Line {
    o: DVec3,
    d: DVec3,
    radius: f64,
    slope: f64,
}

impl Line {
    /// The part of the line within the cone that opens along the axis on and on, not in its mirror
    /// image; `None` if it is outside. Either end may be infinite.
    ///
    /// The squared distance to the axis less the squared radius: a s² + 2 b s + c. The line is
    /// within where that is negative: between its roots, or, where the line is steeper than the
    /// side, beyond one of them.
    fn side(&self) -> Option<[f64; 2]> {
        let Self { o, d, slope, .. } = *self;
        let (r, rise) = (self.radius + slope * o.z, slope * d.z);
        let (flat, distance) = (d.xy().length(), o.xy().length());
        let a = (flat - rise.abs()) * (flat + rise.abs());
        let b = o.xy().dot(d.xy()) - rise * r;
        let c = (distance - r) * (distance + r);
        let discriminant = b * b - a * c;
        if a > 0.0 && !(discriminant >= 0.0) || (a == 0.0 && b == 0.0 && c > 0.0) {
            return None;
        }
        if a == 0.0 && b == 0.0 {
            return Some([f64::NEG_INFINITY, f64::INFINITY]);
        }
        // Below zero only by rounding where the line is steep: it passes through the point.
        let q = -(b + discriminant.max(0.0).sqrt().copysign(b));
        let (s, t) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
        let (low, high) = if s <= t { (s, t) } else { (t, s) };
        Some(match (a < 0.0, rise > 0.0) {
            (false, _) => [low, high],
            (true, true) => [high, f64::INFINITY],
            (true, false) => [f64::NEG_INFINITY, low],
        })
    }

    /// A root moved to where the distances themselves agree, not their squares, which say little
    /// where the cone is thin: Newton's method, as long as it gains. Those of the mirror image stay.
    fn polished(&self, root: f64) -> f64 {
        let Self { o, d, radius, slope } = *self;
        let gap = |s: f64| {
            let (p, z) = (o.xy() + d.xy() * s, o.z + d.z * s);
            let distance = p.length();
            (distance - (radius + slope * z), p.dot(d.xy()) / distance - slope * d.z)
        };
        let mut s = root;
        if !(s.is_finite() && radius + slope * (o.z + d.z * s) > 0.0) {
            return s;
        }
        let (mut off, mut growth) = gap(s);
        for _ in 0..3 {
            let next = s - off / growth;
            let (next_off, next_growth) = gap(next);
            if !(next_off.abs() < off.abs()) {
                break;
            }
            (s, off, growth) = (next, next_off, next_growth);
        }
        s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::testing::{
        Profile, check_against, check_convex, check_sampling, check_solid_angle,
    };

    fn cone(base: DVec3, radius: f64, top_radius: f64, height: f64, caps: bool) -> Cone {
        let (axis, frame) = (DVec3::new(2.0, 6.0, -3.0), [DVec3::ZERO; 3]);
        let mut c = Cone { base, axis, radius, top_radius, height, caps, frame, slope: 0.0 };
        c.prepare();
        c
    }

    /// Distance to the surface: that to its outline in the half plane through the axis.
    fn distance(c: &Cone, p: DVec3) -> f64 {
        let (low, top) = (DVec2::new(c.radius, 0.0), DVec2::new(c.top_radius, c.height));
        let mut outline = vec![(low, top)];
        if c.caps {
            outline.push((DVec2::ZERO, low));
            outline.push((DVec2::new(0.0, c.height), top));
        }
        Profile { base: c.base, axis: c.axis / 7.0 }.distance(p, &outline)
    }

    const SHAPES: [(f64, f64, f64); 6] = [
        (1.0, 0.0, 2.0),
        (1.0, 0.5, 2.0),
        (0.3, 1.0, 0.5),
        (1.0, 1.0, 1.0),
        (0.01, 0.002, 2.0),
        (1.0, 0.0, 0.01),
    ];

    #[test]
    fn hits_and_offsets_hold_at_every_scale_and_distance() {
        for (low, top, height) in SHAPES {
            for (base, scale) in [
                (DVec3::ZERO, 1.0),
                (DVec3::new(1e6, -1e6, 1e6), 1.0),
                (DVec3::ONE, 1e-6),
                (DVec3::ONE, 1e6),
            ] {
                let c = cone(base, low * scale, top * scale, height * scale, true);
                check_convex(&c, 51, |p| distance(&c, p));
            }
        }
    }

    #[test]
    fn hits_are_those_of_marching_rays() {
        for (low, top, height) in SHAPES {
            for (caps, scale) in [(false, 1.0), (true, 1e-6), (true, 1e6)] {
                let c = cone(DVec3::ZERO, low * scale, top * scale, height * scale, caps);
                check_against(&c, 52, |p| distance(&c, p));
            }
        }
    }

    #[test]
    fn rays_along_the_axis_and_along_the_side_meet_what_they_should() {
        let c = cone(DVec3::ZERO, 1.0, 0.0, 2.0, true);
        let [x, _, z] = c.frame;
        let down = c.intersect(&Ray::new(z * 5.0, -z)).unwrap();
        assert!((down.t - 3.0).abs() <= 1e-14, "the point itself: {}", down.t);
        let up = c.intersect(&Ray::new(-z, z)).unwrap();
        assert!((up.t - 1.0).abs() <= 1e-14 && up.face == BOTTOM);
        // Parallel to a line of the side, from inside through the base.
        let along = (z * 2.0 - x).normalize();
        let hit = c.intersect(&Ray::new(z * 0.5, along)).unwrap();
        assert_eq!(hit.face, SIDE);
        let back = c.intersect(&Ray::new(z * 0.5, -along)).unwrap();
        assert!(back.face == BOTTOM && (back.t - 0.5 / along.dot(z)).abs() <= 1e-14);
        // The mirror image above the point is none of it.
        assert!(c.intersect(&Ray::new(z * 3.0 + x * 5.0, -x)).is_none());
        let open = cone(DVec3::ZERO, 1.0, 0.5, 2.0, false);
        assert!(open.intersect(&Ray::new(-z, z)).is_none());
        assert!(!open.is_closed() && c.is_closed());
    }

    #[test]
    fn rays_pass_or_meet_what_they_all_but_touch() {
        for caps in [false, true] {
            let c = cone(DVec3::ZERO, 1.0, 0.25, 1.0, caps);
            let [x, y, z] = c.frame;
            let (middle, n) = (x * 0.625 + z * 0.5, (x * 4.0 + z * 3.0) / 5.0);
            let down = x * 3.0 - z * 4.0;
            for (height, met) in [(-1e-12, true), (1e-12, false)] {
                // Across the side, and almost along it.
                for d in [y, y + down * 0.1] {
                    let hit = c.intersect(&Ray::new(middle + n * height - d * 9.0, d));
                    assert_eq!(hit.is_some(), met, "{d}: {hit:?}");
                }
                let rim = c.intersect(&Ray::new(x * (1.0 + height) + z * 1e-13 - y * 9.0, y));
                assert_eq!(rim.is_some(), met, "{rim:?}");
            }
        }
    }

    #[test]
    fn samples_cover_the_area_and_the_solid_angle() {
        for (caps, top, truth) in [
            (false, 0.0, PI * 5f64.sqrt()),
            (true, 0.0, PI * (5f64.sqrt() + 1.0)),
            (true, 1.0, TAU * 3.0),
        ] {
            let c = cone(DVec3::ONE, 1.0, top, 2.0, caps);
            assert!((c.area() - truth).abs() <= 1e-14);
            check_sampling(&c, None, 53);
        }
        // Closed, as in an open one a side hides another, which the samples do not see.
        let c = cone(DVec3::ZERO, 1.0, 0.4, 2.0, true);
        check_solid_angle(&c, c.frame[2] * 3.0 + c.frame[0] * 3.0, 54);
    }

    #[test]
    fn impossible_cones_are_refused() {
        assert_eq!(cone(DVec3::ZERO, 0.0, 1.0, 1.0, false).check().unwrap_err().field, "radius");
        assert_eq!(
            cone(DVec3::ZERO, 1.0, 1e80, 1.0, false).check().unwrap_err().field,
            "top_radius"
        );
        assert_eq!(
            cone(DVec3::ZERO, 1.0, 1.0, f64::NAN, false).check().unwrap_err().field,
            "height"
        );
        let c = Cone { axis: DVec3::ZERO, ..cone(DVec3::ZERO, 1.0, 0.0, 1.0, false) };
        assert_eq!(c.check().unwrap_err().field, "axis");
    }
}
