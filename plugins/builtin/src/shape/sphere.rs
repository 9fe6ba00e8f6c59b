//! The sphere, exact from a nanometre to a planet.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64, sphere_roots};
use luxel_sdk::params::Fault;
use luxel_sdk::sampling::one_minus_cos_from_sin2;

/// Height above the surface, in radii, below which `sample` ignores the viewer: stored points are
/// good to 2⁻⁵³ radii, so that closer than this their distance keeps fewer than 13 bits.
const NEAR: f64 = 1.0 / (1u64 << 40) as f64;

/// A sphere: round, closed, exact however large, small or far away.
///
/// Texture coordinates are longitude and latitude: `u` runs once around the vertical axis, east to
/// the right, and `v` from the south pole (-Y) to the north pole (+Y).
///
/// ```scene
/// shape sphere "ball" { center = (0, 0.5, 0) m, radius = 50 cm, material = white }
/// ```
#[derive(Params, Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct Sphere {
    /// The middle.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    pub(crate) center: DVec3,
    /// From the middle to the surface; greater than 0.
    #[param(required, unit = "m", min = f64::MIN_POSITIVE)]
    pub(crate) radius: f64,
}

impl Shape for Sphere {
    fn check(&self) -> Result<(), Fault> {
        super::check_length("radius", self.radius)
    }

    fn bounds(&self) -> Bounds3 {
        super::bounds_about(self.center, DVec3::splat(self.radius))
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (t0, t1) = sphere_roots(ray.o - self.center, ray.d, self.radius)?;
        let t = if t0 > 0.0 { t0 } else { t1 };
        (t > 0.0 && t <= ray.t_max).then_some(Hit { t, at: DVec2::ZERO, face: 0 })
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.surface_at((ray.o - self.center + ray.d * hit.t).normalize_or(DVec3::Y))
    }

    fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }

    /// Uniform in the cone of directions that the sphere fills; inside and very close, uniform
    /// over the surface.
    ///
    /// # Source
    /// PBR4 §6.2.4; the polar angle is found at the centre, from sines, which stay exact for the
    /// smallest cones.
    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let [u0, u1] = u.map(f64::from);
        let (sin_phi, cos_phi) = (TAU * u1).sin_cos();
        let n = if let Some((axis, distance)) = self.seen_from(from) {
            let sin_max = self.radius / distance;
            let x = u0 * one_minus_cos_from_sin2(sin_max * sin_max);
            let (cos, sin2) = (1.0 - x, x * (2.0 - x));
            let part = (sin2 / (sin_max * sin_max)).min(1.0);
            let rest = (1.0 - part).sqrt();
            let sin_alpha = (sin2.sqrt() * (cos / sin_max - rest)).max(0.0);
            let cos_alpha = part * sin_max + cos * rest;
            let (s, t) = axis.any_orthonormal_pair();
            s * (sin_alpha * cos_phi) + t * (sin_alpha * sin_phi) + axis * cos_alpha
        } else {
            let z = 1.0 - 2.0 * u0;
            let r = (4.0 * u0 * (1.0 - u0)).max(0.0).sqrt();
            DVec3::new(r * cos_phi, r * sin_phi, z)
        };
        let surface = self.surface_at(n.normalize());
        let pdf = self.pdf(from, &surface);
        (pdf > 0.0 && pdf.is_finite()).then_some(ShapeSample { surface, pdf })
    }

    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        let (Some((_, distance)), Some(from)) = (self.seen_from(from), from) else {
            return self.area().recip();
        };
        let to = from - at.p;
        let d2 = to.length_squared();
        let cos = at.ng.dot(to) / d2.sqrt();
        let sin_max = self.radius / distance;
        let solid_angle = TAU * one_minus_cos_from_sin2(sin_max * sin_max);
        if cos > 0.0 { cos / (solid_angle * d2) } else { 0.0 }
    }

    fn is_closed(&self) -> bool {
        true
    }

    fn distance(&self, p: DVec3) -> Option<f64> {
        Some((p - self.center).length() - self.radius)
    }

    fn normal_derivatives(&self, _hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        let (dn_du, dn_dv) = (at.dp_du / self.radius, at.dp_dv / self.radius);
        Some(NormalDerivatives { dn_du, dn_dv })
    }
}

impl Sphere {
    /// Unit direction from the centre to a viewer outside, and the distance.
    fn seen_from(&self, from: Option<DVec3>) -> Option<(DVec3, f64)> {
        let to = from? - self.center;
        let distance = to.length();
        let outside = distance > self.radius * (1.0 + NEAR) && distance.is_finite();
        outside.then(|| (to / distance, distance))
    }

    /// The point whose outer normal is `n`, unit.
    ///
    /// Error: the point rounds twice, and a ray that starts there finds |o| − r with a difference,
    /// a length (four roundings) and a difference; n itself is unit to four roundings.
    fn surface_at(&self, n: DVec3) -> Surface {
        let local = n * self.radius;
        let p_err = local.abs() * gamma64(12) + self.center.abs() * gamma64(2);
        let around = n.x.hypot(n.z);
        // East and north; at a pole every longitude is as good as 0.
        let (cos, sin) = if around > 0.0 { (n.x / around, -n.z / around) } else { (1.0, 0.0) };
        let east = DVec3::new(-sin, 0.0, -cos);
        let north = DVec3::new(-n.y * cos, around, n.y * sin);
        let turn = sin.atan2(cos) / TAU;
        let uv =
            DVec2::new(if turn < 0.0 { turn + 1.0 } else { turn }, n.y.atan2(around) / PI + 0.5);
        // At a pole ∂p/∂u vanishes: a direction of the right length in a tiny neighbourhood.
        let circle = TAU * self.radius * around.max(f64::EPSILON);
        Surface {
            p: self.center + local,
            p_err,
            ng: n,
            ns: n,
            uv,
            dp_du: east * circle,
            dp_dv: north * (PI * self.radius),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::testing::{check_convex, check_sampling, solid_angle, visible_area};

    fn sphere(center: DVec3, radius: f64) -> Sphere {
        Sphere { center, radius }
    }

    #[test]
    fn hits_and_offsets_hold_at_every_scale_and_distance() {
        for (center, radius) in [
            (DVec3::ZERO, 1.0),
            (DVec3::new(1e6, -1e6, 1e6), 1.0),
            (DVec3::new(1.0, 2.0, 3.0), 1e-6),
            (DVec3::new(0.0, -6.4e6, 0.0), 6.4e6),
        ] {
            let s = sphere(center, radius);
            check_convex(&s, 1, |p| ((p - center).length() - radius).abs());
        }
    }

    #[test]
    fn samples_agree_with_their_density_from_anywhere() {
        let s = sphere(DVec3::new(1.0, 2.0, 3.0), 2.0);
        let foot = s.center + DVec3::X * 2.0;
        for from in [
            None,
            Some(s.center),
            Some(foot),
            Some(foot + DVec3::X * 1e-3),
            Some(DVec3::new(9.0, 2.0, 3.0)),
            Some(DVec3::new(1e7, 2.0, -3e7)),
        ] {
            check_sampling(&s, from, 2);
        }
    }

    #[test]
    fn the_cone_holds_exactly_the_solid_angle_of_the_sphere() {
        // Every sample of the cone has the same solid-angle density, so one is enough.
        for (distance, tolerance) in [(4.0, 1e-12), (1e5, 1e-9), (1.0001, 1e-9)] {
            let s = sphere(DVec3::new(0.5, 0.0, 0.0), 1.0);
            let from = s.center + DVec3::new(0.0, distance, 0.0);
            let sin = 1.0 / distance;
            let truth = TAU * one_minus_cos_from_sin2(sin * sin);
            let found = solid_angle(&s, from, 200, 3);
            assert!((found.mean / truth - 1.0).abs() <= tolerance, "{distance}: {}", found.mean);
        }
        // The truth `visible.sphere`: R = 1, d = 4.
        let omega = solid_angle(&sphere(DVec3::ZERO, 1.0), DVec3::Z * 4.0, 10, 4).mean;
        assert!((omega - 0.199_517_293_219_168_42).abs() <= 1e-12);
    }

    #[test]
    fn the_area_seen_from_outside_is_that_of_the_cap() {
        let s = sphere(DVec3::ZERO, 2.0);
        let found = visible_area(&s, Some(DVec3::Y * 3.0), 20_000, 5);
        let truth = TAU * 4.0 * (1.0 - 2.0 / 3.0);
        assert!((found.mean - truth).abs() <= 5.0 * found.standard_error());
    }

    #[test]
    fn tangents_are_right_handed_even_at_the_poles() {
        let s = sphere(DVec3::ZERO, 3.0);
        for d in [DVec3::Y, -DVec3::Y, DVec3::X, -DVec3::Z, DVec3::new(1e-9, 1.0, 0.0)] {
            let ray = Ray::new(d * 10.0, -d);
            let hit = s.intersect(&ray).unwrap();
            let at = s.surface(&ray, &hit);
            assert!(at.dp_du.length() > 0.0);
            let n = at.dp_du.cross(at.dp_dv).normalize();
            assert!(n.dot(at.ng) > 1.0 - 8.0 * f64::EPSILON, "{d}");
            assert!(at.uv.cmpge(DVec2::ZERO).all() && at.uv.cmple(DVec2::ONE).all());
        }
    }

    #[test]
    fn a_radius_of_nothing_is_refused() {
        assert!(sphere(DVec3::ZERO, 0.0).check().is_err());
        assert!(sphere(DVec3::ZERO, f64::NAN).check().is_err());
        assert!(sphere(DVec3::ZERO, 1e-9).check().is_ok());
    }
}
