//! Plugins that need no scene to be wrong: for the suite.

use glam::{DVec3, Vec3};
use luxel_sdk::Params;
use luxel_sdk::abi::Class;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Eval, Hit, Material, Sample, Shape, ShapeSample, Surface, Texture, TexturePoint,
};
use luxel_sdk::num::{Bounds3, Ray};

use super::Wrong;
pub(in super::super) use super::quiet;
use super::shape::Square;

pub(in super::super) const CLASSES: &[Class] = &[
    Class::shape::<Narrow>("narrow"),
    Class::shape::<Falls>("panics"),
    Class::material::<Falls>("panics"),
    Class::texture::<Falls>("panics"),
];

/// A square whose bounds hold half of it.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Narrow {
    /// Nothing depends on it.
    #[param(default = 1.0, min = 0, max = 1)]
    unused: f64,
}

impl Narrow {
    const WHOLE: Square = Square::sound();
}

impl Shape for Narrow {
    fn bounds(&self) -> Bounds3 {
        let half = DVec3::new(0.5, 1.0, 1e-9);
        Bounds3 { min: -half, max: half }
    }
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        Self::WHOLE.intersect(ray)
    }
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        Self::WHOLE.surface(ray, hit)
    }
    fn area(&self) -> f64 {
        Self::WHOLE.area()
    }
    fn sample(&self, from: Option<DVec3>, u: [f32; 2]) -> Option<ShapeSample> {
        Self::WHOLE.sample(from, u)
    }
    fn pdf(&self, from: Option<DVec3>, at: &Surface) -> f64 {
        Self::WHOLE.pdf(from, at)
    }
}

/// Falls over whatever it is asked.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Falls {
    /// What is wrong.
    #[param(default = Wrong::Eval, choice)]
    wrong: Wrong,
}

impl Material for Falls {
    fn eval(&self, _: Vec3, _: Vec3) -> Eval {
        Wrong::Eval.at(Wrong::Eval);
        Eval::ZERO
    }
    fn sample(&self, _: Vec3, _: [f32; 3]) -> Option<Sample> {
        None
    }
}

impl Texture for Falls {
    fn eval(&self, _: &TexturePoint) -> Spectrum {
        Wrong::Eval.at(Wrong::Eval);
        Spectrum::ZERO
    }
}

impl Shape for Falls {
    fn bounds(&self) -> Bounds3 {
        Bounds3 { min: -DVec3::ONE, max: DVec3::ONE }
    }
    fn intersect(&self, _: &Ray) -> Option<Hit> {
        Wrong::Eval.at(Wrong::Eval);
        None
    }
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        Square::sound().surface(ray, hit)
    }
    fn area(&self) -> f64 {
        1.0
    }
    fn sample(&self, _: Option<DVec3>, _: [f32; 2]) -> Option<ShapeSample> {
        None
    }
    fn pdf(&self, _: Option<DVec3>, _: &Surface) -> f64 {
        1.0
    }
}
