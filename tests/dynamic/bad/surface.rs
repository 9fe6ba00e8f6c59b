//! A material, a texture and a light.

use std::f32::consts::FRAC_1_PI;

use glam::{DVec3, Vec3};
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Escaped, Eval, Light, LightForm, LightQuery, LightSample, Lobe, Material, Needs, Output,
    Sample, Texture, TexturePoint,
};
use luxel_sdk::params::{Build, BuildContext, Fault, Shared};

use super::{Bomb, Wrong};

/// A matt material.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Paint {
    /// What is wrong.
    #[param(default = Wrong::Nothing, choice)]
    wrong: Wrong,
    /// How much it reflects.
    #[param(default = 0.5, min = 0, max = 1, textured)]
    grey: f32,
    #[param(derived)]
    ready: u32,
}

impl Material for Paint {
    fn prepare(&mut self) {
        self.wrong.at(Wrong::Prepare);
        self.ready = 1;
    }
    fn check(&self) -> Result<(), Fault> {
        self.wrong.at(Wrong::Check);
        Ok(())
    }
    fn needs(&self) -> Needs {
        self.wrong.at(Wrong::Other);
        Needs::LIGHT
    }
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        self.wrong.at(Wrong::Eval);
        let pdf = if wo.z * wi.z > 0.0 { wi.z.abs() * FRAC_1_PI } else { 0.0 };
        Eval { f: Spectrum::splat(self.wrong.number(self.grey * pdf)), pdf }
    }
    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        self.wrong.at(Wrong::Sample);
        let up = luxel_sdk::sampling::cosine_hemisphere([u[0], u[1]]);
        let wi = Vec3::new(up.x, up.y, up.z.copysign(wo.z));
        let wi = match self.wrong {
            Wrong::SampleNan => Vec3::NAN,
            Wrong::SampleLong => wi * 1e30,
            Wrong::Zero => Vec3::ZERO,
            _ => wi,
        };
        let pdf = if self.wrong == Wrong::SampleZero { 0.0 } else { up.z * FRAC_1_PI };
        let weight = Spectrum::splat(self.grey);
        Some(Sample { weight, wi, pdf, eta: 1.0, lobe: Lobe::NONE })
    }
}

/// A grey texture, with a table of its own.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Pattern<'a> {
    /// What is wrong.
    #[param(default = Wrong::Nothing, choice)]
    wrong: Wrong,
    #[param(shared)]
    table: Shared<'a, (f32, Option<Bomb>)>,
}

impl Build<(f32, Option<Bomb>)> for Pattern<'_> {
    fn build(&self, context: &dyn BuildContext) -> Result<(f32, Option<Bomb>), Vec<Fault>> {
        self.wrong.at(Wrong::Prepare);
        if self.wrong == Wrong::Dangling {
            let said = context.read("../../nothing").unwrap_err();
            return Err(vec![Fault::file("no such field", said)]);
        }
        Ok((0.5, (self.wrong == Wrong::Bomb).then(|| Bomb)))
    }
}

impl Texture for Pattern<'_> {
    fn eval(&self, _: &TexturePoint) -> Spectrum {
        self.wrong.at(Wrong::Eval);
        Spectrum::splat(self.wrong.number(self.table.0))
    }
    fn output(&self) -> Output {
        self.wrong.at(Wrong::Other);
        Output::Value
    }
}

/// Light from above, from a point or from far away.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(super) struct Lamp {
    /// What is wrong.
    #[param(default = Wrong::Nothing, choice)]
    wrong: Wrong,
    /// Whether it is far away.
    #[param(default = false)]
    far: bool,
}

impl Light for Lamp {
    fn form(&self) -> LightForm {
        self.wrong.at(Wrong::Prepare);
        if self.far { LightForm::Infinite } else { LightForm::Point }
    }
    fn sample(&self, _: &LightQuery) -> Option<LightSample> {
        self.wrong.at(Wrong::Sample);
        let mut wi = DVec3::Z;
        let mut sample = (1.0, 5.0);
        match self.wrong {
            Wrong::SampleNan => wi = DVec3::NAN,
            Wrong::SampleLong => wi *= 1e300,
            Wrong::SampleZero => sample.0 = 0.0,
            Wrong::Beyond => sample.1 = f64::NAN,
            Wrong::Zero => sample.1 = -1.0,
            _ => {}
        }
        let le = Spectrum::splat(self.wrong.number(1.0));
        Some(LightSample { le, wi, distance: sample.1, pdf: sample.0, delta: !self.far })
    }
    fn escaped(&self, _: DVec3) -> Escaped {
        self.wrong.at(Wrong::Eval);
        let pdf = if self.wrong == Wrong::OtherNan { f32::NAN } else { 0.0 };
        Escaped { le: Spectrum::splat(self.wrong.number(1.0)), pdf }
    }
    fn power(&self, _: f64, _: f64) -> f32 {
        self.wrong.at(Wrong::Second);
        if self.wrong == Wrong::SecondNan { f32::NAN } else { 1.0 }
    }
}
