//! Spheres with a fault.

use glam::DVec3;
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::kind::{Hit, Shape, ShapeSample, Surface};
use luxel_sdk::num::{Bounds3, Ray};

use super::Mutant;
use crate::reference::Ball;

/// A sphere whose hits, surfaces and random numbers pass through three functions.
macro_rules! faulty {
    ($name:ident, $hit:expr, $surface:expr, $numbers:expr) => {
        /// A sphere with a fault.
        #[derive(Params, Clone, Copy)]
        #[repr(C)]
        struct $name {
            /// From the middle to the surface.
            #[param(default = 1.0, unit = "m", min = 1e-9, max = 1e9)]
            radius: f64,
        }

        impl $name {
            fn ball(&self) -> Ball {
                Ball { radius: self.radius }
            }
        }

        impl Shape for $name {
            fn bounds(&self) -> Bounds3 {
                self.ball().bounds()
            }

            fn intersect(&self, ray: &Ray) -> Option<Hit> {
                let find: fn(&Ball, &Ray) -> Option<Hit> = $hit;
                find(&self.ball(), ray)
            }

            fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
                let change: fn(Surface) -> Surface = $surface;
                change(self.ball().surface(ray, hit))
            }

            fn area(&self) -> f64 {
                self.ball().area()
            }

            fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
                let change: fn(Surface) -> Surface = $surface;
                let numbers: fn([f32; 2]) -> [f32; 2] = $numbers;
                let sample = self.ball().sample(from, numbers(u))?;
                Some(ShapeSample { surface: change(sample.surface), ..sample })
            }

            fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
                self.ball().pdf(from, at)
            }

            fn is_closed(&self) -> bool {
                true
            }
        }
    };
}

faulty!(InsideOut, Ball::intersect, |s| Surface { ng: -s.ng, ns: -s.ns, ..s }, |u| u);
faulty!(SureOfItself, Ball::intersect, |s| Surface { p_err: DVec3::ZERO, ..s }, |u| u);
faulty!(Endless, |ball, ray| ball.intersect(&Ray::new(ray.o, ray.d)), |s| s, |u| u);
faulty!(Crowded, Ball::intersect, |s| s, |[u, v]| [u * u, v]);

faulty!(
    Blunt,
    |ball, ray| ball.intersect(ray).filter(|hit| hit.t * ray.d.length() > 1e-4),
    |s| s,
    |u| u
);

/// All of them.
pub(super) const MUTANTS: &[Mutant] = &[
    Mutant { class: Class::shape::<InsideOut>("inside_out"), fault: "normals point inside" },
    Mutant { class: Class::shape::<SureOfItself>("sure_of_itself"), fault: "no error bounds" },
    Mutant { class: Class::shape::<Endless>("endless"), fault: "t_max is ignored" },
    Mutant { class: Class::shape::<Crowded>("crowded"), fault: "samples crowd at a pole" },
    Mutant { class: Class::shape::<Blunt>("blunt"), fault: "hits within 0.1 mm are passed over" },
];
