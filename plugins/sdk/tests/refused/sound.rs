use glam::Vec3;
use luxel_sdk::{
    Choice, Params,
    abi::Class,
    kind::{Eval, Material, Sample},
    params::Text,
};

/// Which axis.
#[derive(Choice, Clone, Copy)]
#[repr(u32)]
enum Axis {
    /// Along x.
    X,
}

/// What the others are but for their one mistake.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface<'a> {
    /// How rough.
    #[param(default = 0.5, min = 0, max = 1)]
    roughness: f32,
    /// How wide.
    #[param(default = [0.0, 0.0, 1.0], min = 0, unit = "m")]
    size: Vec3,
    /// Which axis.
    #[param(required, choice)]
    axis: Axis,
    /// A name.
    #[param(required)]
    name: Text<'a>,
    #[param(derived)]
    weights: [f32; 4],
}

impl Material for Surface<'_> {
    fn eval(&self, _wo: Vec3, _wi: Vec3) -> Eval {
        Eval::ZERO
    }
    fn sample(&self, _wo: Vec3, _u: [f32; 3]) -> Option<Sample> {
        None
    }
}

const CLASS: Class = Class::material::<Surface<'static>>("surface");

fn main() {}
