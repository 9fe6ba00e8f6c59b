//! Rings with a fault.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::{Hit, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64};
use luxel_sdk::params::Fault as Refusal;
use luxel_sdk::sampling::disk_concentric;

use super::Mutant;

#[derive(Clone, Copy, PartialEq)]
enum Fault {
    Sound,
    ShortOnOneSide,
    UnitRays,
    ForgetsHole,
    TangentOfRadius,
    SureFarAway,
    SaysClosed,
    CullsBacks,
}

/// A flat ring that faces +Y.
struct Plate {
    center: DVec3,
    radius: f64,
    hole: f64,
    fault: Fault,
}

impl Plate {
    fn bounds(&self) -> Bounds3 {
        let half = DVec3::new(self.radius, 0.0, self.radius);
        let room = (self.center.abs() + half) * gamma64(8);
        let (mut min, max) = (self.center - half - room, self.center + half + room);
        if self.fault == Fault::ShortOnOneSide {
            min.z += 0.02 * self.radius;
        }
        Bounds3 { min, max }
    }

    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        if self.fault == Fault::CullsBacks && ray.d.y > 0.0 {
            return None;
        }
        let to_center = self.center - ray.o;
        let mut t = to_center.y / ray.d.y;
        let q = ray.d * t - to_center;
        let at = DVec2::new(q.x, q.z);
        let r = at.length();
        if self.fault == Fault::UnitRays {
            t *= ray.d.length();
        }
        let inside = r <= self.radius && r >= self.hole;
        (inside && t > 0.0 && t <= ray.t_max).then_some(Hit { t, at, face: 0 })
    }

    fn surface(&self, at: DVec2) -> Surface {
        let reach = DVec3::new(self.radius, 0.0, self.radius);
        let width = if self.fault == Fault::TangentOfRadius { 1.0 } else { 2.0 } * self.radius;
        Surface {
            p: self.center + DVec3::new(at.x, 0.0, at.y),
            p_err: (self.center.abs() + reach) * gamma64(5),
            ng: DVec3::Y,
            ns: DVec3::Y,
            uv: DVec2::new(at.x, -at.y) / (2.0 * self.radius) + 0.5,
            dp_du: DVec3::X * width,
            dp_dv: DVec3::NEG_Z * (2.0 * self.radius),
        }
    }

    fn area(&self) -> f64 {
        let hole = if self.fault == Fault::ForgetsHole { 0.0 } else { self.hole };
        PI * (self.radius - hole) * (self.radius + hole)
    }

    fn sample(&self, u: [f32; 2]) -> ShapeSample {
        let on_disk = disk_concentric(u).as_dvec2();
        let part = on_disk.length_squared().min(1.0);
        let (outer2, inner2) = (self.radius * self.radius, self.hole * self.hole);
        let r = (inner2 + (outer2 - inner2) * part).sqrt();
        let at = on_disk.try_normalize().unwrap_or(DVec2::X) * r;
        ShapeSample { surface: self.surface(at), pdf: self.area().recip() }
    }
}

macro_rules! plate {
    ($name:ident) => {
        /// A ring with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// The middle.
            #[param(default = [0.0, 0.0, 0.0], unit = "m")]
            center: DVec3,
            /// From the middle to the rim.
            #[param(default = 1.0, unit = "m", min = 1e-9, max = 1e9)]
            radius: f64,
            /// Radius of the hole; less than `radius`.
            #[param(default = 0.0, unit = "m", min = 0, max = 1e9)]
            hole: f64,
        }

        impl $name {
            fn plate(&self) -> Plate {
                let Self { center, radius, hole } = *self;
                Plate { center, radius, hole, fault: Fault::$name }
            }
        }

        impl Shape for $name {
            fn check(&self) -> Result<(), Refusal> {
                if self.hole < self.radius {
                    return Ok(());
                }
                Err(Refusal::range("hole", "a hole as wide as the ring leaves nothing"))
            }

            fn bounds(&self) -> Bounds3 {
                self.plate().bounds()
            }

            fn intersect(&self, ray: &Ray) -> Option<Hit> {
                self.plate().intersect(ray)
            }

            fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
                let surface = self.plate().surface(hit.at);
                if self.plate().fault == Fault::SureFarAway {
                    return Surface { p: ray.at(hit.t), ..surface };
                }
                surface
            }

            fn area(&self) -> f64 {
                self.plate().area()
            }

            fn sample(&self, _from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
                Some(self.plate().sample(u))
            }

            fn pdf(&self, _from: Option<DVec3>, _at: &Surface) -> f64 {
                self.plate().area().recip()
            }

            fn is_closed(&self) -> bool {
                self.plate().fault == Fault::SaysClosed
            }
        }
    };
}

plate!(Sound);
plate!(ShortOnOneSide);
plate!(UnitRays);
plate!(ForgetsHole);
plate!(TangentOfRadius);
plate!(SureFarAway);
plate!(SaysClosed);
plate!(CullsBacks);

/// The same without a fault.
#[cfg(test)]
pub(super) const SOUND: Class = Class::shape::<Sound>("sound_plate");

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant {
        class: Class::shape::<ShortOnOneSide>("short_on_one_side"),
        fault: "bounds 1 % short towards −z",
    },
    Mutant { class: Class::shape::<UnitRays>("unit_rays"), fault: "t in metres, whatever |d|" },
    Mutant { class: Class::shape::<ForgetsHole>("forgets_hole"), fault: "area with the hole" },
    Mutant {
        class: Class::shape::<TangentOfRadius>("tangent_of_radius"), fault: "half of ∂p/∂u"
    },
    Mutant {
        class: Class::shape::<SureFarAway>("sure_far_away"),
        fault: "points along rays, errors of points in place",
    },
    Mutant { class: Class::shape::<SaysClosed>("says_closed"), fault: "encloses nothing" },
    Mutant { class: Class::shape::<CullsBacks>("culls_backs"), fault: "no hits from behind" },
];
