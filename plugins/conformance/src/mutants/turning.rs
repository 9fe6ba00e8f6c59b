//! A sphere that turns its normals the wrong way, and a disk that is said to be a square.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::{Hit, NormalDerivatives, Parallelogram, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64};
use luxel_sdk::sampling::disk_concentric;

use super::Mutant;
use crate::reference::Ball;

/// A sphere whose normals are said to turn as those of a hollow.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Hollow {
    /// From the middle to the surface.
    #[param(default = 1.0, unit = "m", min = 1e-9, max = 1e9)]
    radius: f64,
}

impl Shape for Hollow {
    fn bounds(&self) -> Bounds3 {
        Ball { radius: self.radius }.bounds()
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        Ball { radius: self.radius }.intersect(ray)
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        Ball { radius: self.radius }.surface(ray, hit)
    }

    fn area(&self) -> f64 {
        Ball { radius: self.radius }.area()
    }

    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        Ball { radius: self.radius }.sample(from, u)
    }

    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        Ball { radius: self.radius }.pdf(from, at)
    }

    fn is_closed(&self) -> bool {
        true
    }

    fn normal_derivatives(&self, _: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        let (dn_du, dn_dv) = (-at.dp_du / self.radius, -at.dp_dv / self.radius);
        Some(NormalDerivatives { dn_du, dn_dv })
    }
}

/// A disk across y that is said to be the square around it.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Squared {
    /// From the middle to the rim.
    #[param(default = 1.0, unit = "m", min = 1e-9, max = 1e9)]
    radius: f64,
}

impl Squared {
    fn surface_at(self, at: DVec2) -> Surface {
        let p = DVec3::new(at.x, 0.0, -at.y);
        let (n, size) = (DVec3::Y, 2.0 * self.radius);
        Surface {
            p,
            p_err: DVec3::splat(self.radius * gamma64(4)),
            ng: n,
            ns: n,
            uv: at / size + 0.5,
            dp_du: DVec3::X * size,
            dp_dv: -DVec3::Z * size,
        }
    }
}

impl Shape for Squared {
    fn bounds(&self) -> Bounds3 {
        let half = DVec3::new(self.radius, self.radius * gamma64(8), self.radius);
        Bounds3 { min: -half, max: half }
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let t = -ray.o.y / ray.d.y;
        let p = ray.o + ray.d * t;
        let at = DVec2::new(p.x, -p.z);
        let inside = at.length() <= self.radius;
        (inside && t > 0.0 && t <= ray.t_max).then_some(Hit { t, at, face: 0 })
    }

    fn surface(&self, _: &Ray, hit: &Hit) -> Surface {
        self.surface_at(hit.at)
    }

    fn area(&self) -> f64 {
        PI * self.radius * self.radius
    }

    fn sample(&self, _: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        let on_disk = disk_concentric(u).as_dvec2().clamp_length_max(1.0);
        let surface = self.surface_at(on_disk * self.radius);
        Some(ShapeSample { surface, pdf: self.area().recip() })
    }

    fn pdf(&self, _: Option<DVec3>, _: &Surface) -> f64 {
        self.area().recip()
    }

    fn parallelogram(&self) -> Option<Parallelogram> {
        let size = 2.0 * self.radius;
        Some(Parallelogram { centre: DVec3::ZERO, u: DVec3::X * size, v: -DVec3::Z * size })
    }
}

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant { class: Class::shape::<Hollow>("hollow"), fault: "normals turn the wrong way" },
    Mutant { class: Class::shape::<Squared>("squared"), fault: "a disk is said to be a square" },
];
