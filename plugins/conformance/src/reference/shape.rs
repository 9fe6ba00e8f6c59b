//! A sphere about the origin.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64, sphere_roots};
use luxel_sdk::params::Fault;

/// A sphere about the origin, sampled evenly over its area.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Ball {
    /// From the middle to the surface.
    #[param(default = 1.0, unit = "m", min = 1e-9, max = 1e9)]
    pub(crate) radius: f64,
}

impl Ball {
    pub(crate) fn surface_at(self, n: DVec3) -> Surface {
        let p = n * self.radius;
        // At a pole any direction along the surface will do.
        let east = DVec3::new(-n.y, n.x, 0.0);
        let dp_du = if east.length_squared() > 0.0 { east } else { DVec3::X } * self.radius * TAU;
        let turn = (n.y.atan2(n.x) / TAU).rem_euclid(1.0);
        let uv = DVec2::new(turn, n.z.clamp(-1.0, 1.0).acos() / PI);
        let dp_dv = n.cross(dp_du.normalize()) * (-PI * self.radius);
        // As for any sphere: the point, and what the next ray's roots round.
        let p_err = p.abs() * gamma64(12);
        Surface { p, p_err, ng: n, ns: n, uv, dp_du, dp_dv }
    }
}

impl Shape for Ball {
    fn check(&self) -> Result<(), Fault> {
        if self.radius > 0.0 {
            return Ok(());
        }
        Err(Fault::range("radius", "a radius exceeds 0"))
    }

    fn bounds(&self) -> Bounds3 {
        let r = self.radius * (1.0 + gamma64(8));
        Bounds3 { min: DVec3::splat(-r), max: DVec3::splat(r) }
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let (t0, t1) = sphere_roots(ray.o, ray.d, self.radius)?;
        let t = if t0 > 0.0 { t0 } else { t1 };
        (t > 0.0 && t <= ray.t_max).then_some(Hit { t, at: DVec2::ZERO, face: 0 })
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.surface_at(ray.at(hit.t).normalize_or(DVec3::Y))
    }

    fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }

    fn sample(&self, _from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let [u, v] = u.map(f64::from);
        let z = 1.0 - 2.0 * u;
        let (sin, cos) = (TAU * v).sin_cos();
        let r = (1.0 - z * z).max(0.0).sqrt();
        let surface = self.surface_at(DVec3::new(r * cos, r * sin, z).normalize());
        Some(ShapeSample { surface, pdf: self.area().recip() })
    }

    fn pdf(&self, _from: Option<DVec3>, _at: &Surface) -> f64 {
        self.area().recip()
    }

    fn is_closed(&self) -> bool {
        true
    }
}

/// A sphere about any point, which knows its distance: what solids of parts are made of.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Orb {
    /// The middle.
    #[param(default = [0.0, 0.0, 0.0], unit = "m")]
    center: DVec3,
    /// From the middle to the surface.
    #[param(default = 1.0, unit = "m", min = 1e-9, max = 1e9)]
    radius: f64,
}

impl Orb {
    fn ball(self) -> Ball {
        Ball { radius: self.radius }
    }

    /// From the middle to where the ball is.
    fn moved(&self, s: Surface) -> Surface {
        let p = s.p + self.center;
        Surface { p, p_err: s.p_err + (s.p.abs() + self.center.abs()) * gamma64(2), ..s }
    }

    fn about_middle(&self, ray: &Ray) -> Ray {
        Ray { o: ray.o - self.center, ..*ray }
    }
}

impl Shape for Orb {
    fn check(&self) -> Result<(), Fault> {
        self.ball().check()
    }

    fn bounds(&self) -> Bounds3 {
        let Bounds3 { min, max } = self.ball().bounds();
        let room = (self.center.abs() + self.radius) * gamma64(8);
        Bounds3 { min: min + self.center - room, max: max + self.center + room }
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.ball().intersect(&self.about_middle(ray))
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.moved(self.ball().surface(&self.about_middle(ray), hit))
    }

    fn area(&self) -> f64 {
        self.ball().area()
    }

    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let sample = self.ball().sample(from, u)?;
        Some(ShapeSample { surface: self.moved(sample.surface), ..sample })
    }

    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        self.ball().pdf(from, at)
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
