//! A camera, a sampler and a pixel filter.

use glam::{DVec2, DVec3};
use luxel_sdk::Params;
use luxel_sdk::kind::{Camera, CameraRay, Filter, Raster, SampleAt, Sampler};
use luxel_sdk::num::Ray;

use super::Wrong;

/// A camera that looks down at the scene.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Lens {
    /// What is wrong.
    #[param(default = Wrong::Nothing, choice)]
    wrong: Wrong,
}

impl Camera for Lens {
    fn ray(&self, raster: Raster, p: DVec2, _: [f32; 2]) -> Option<CameraRay> {
        self.wrong.at(Wrong::Eval);
        let p = raster.to_screen(p);
        let (mut o, mut d) = (DVec3::new(p.x, p.y, 5.0), DVec3::NEG_Z);
        match self.wrong {
            Wrong::SampleNan => o.x = f64::NAN,
            Wrong::SampleLong => d *= 2.0,
            Wrong::Zero => d = DVec3::ZERO,
            _ => {}
        }
        Some(CameraRay { ray: Ray::new(o, d), weight: self.wrong.number(1.0) })
    }
    fn project(&self, _: Raster, _: DVec3) -> Option<DVec2> {
        None
    }
}

/// Always the same numbers.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Dice {
    /// What is wrong.
    #[param(default = Wrong::Nothing, choice)]
    wrong: Wrong,
}

impl Dice {
    fn number(self) -> f32 {
        self.wrong.at(Wrong::Eval);
        if self.wrong == Wrong::Beyond { 1.0 } else { self.wrong.number(0.3) }
    }
}

impl Sampler for Dice {
    fn samples(&self) -> u32 {
        self.wrong.at(Wrong::Other);
        4
    }
    fn seed(&self) -> u32 {
        self.wrong.at(Wrong::Second);
        1
    }
    fn get_1d(&self, _: SampleAt) -> f32 {
        self.number()
    }
    fn get_2d(&self, at: SampleAt) -> [f32; 2] {
        [self.number(), (at.index as f32 * 0.2).fract()]
    }
}

/// A box.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Pixel {
    /// What is wrong.
    #[param(default = Wrong::Nothing, choice)]
    wrong: Wrong,
}

impl Filter for Pixel {
    fn radius(&self) -> f32 {
        0.5
    }
    fn eval(&self, _: [f32; 2]) -> f32 {
        1.0
    }
    fn sample(&self, u: [f32; 2]) -> [f32; 2] {
        self.wrong.at(Wrong::Eval);
        [self.wrong.number(u[0]), u[1] - 0.5]
    }
}

/// A filter that always falls over, under the name of the one that the host takes by itself.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Fallen {
    /// Nothing depends on it.
    #[param(default = 1.0, min = 0, max = 1)]
    unused: f32,
}

impl Filter for Fallen {
    fn radius(&self) -> f32 {
        0.5
    }
    fn eval(&self, _: [f32; 2]) -> f32 {
        1.0
    }
    fn sample(&self, _: [f32; 2]) -> [f32; 2] {
        Wrong::Eval.at(Wrong::Eval);
        [0.0; 2]
    }
}
