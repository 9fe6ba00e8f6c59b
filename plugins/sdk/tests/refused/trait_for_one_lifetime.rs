use glam::Vec3;
use luxel_sdk::{
    Params,
    abi::Class,
    kind::{Eval, Material, Sample},
    params::Text,
};

/// A surface.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Surface<'a> {
    /// A name.
    #[param(required)]
    name: Text<'a>,
}

impl Material for Surface<'static> {
    fn eval(&self, _wo: Vec3, _wi: Vec3) -> Eval {
        Eval::ZERO
    }
    fn sample(&self, _wo: Vec3, _u: [f32; 3]) -> Option<Sample> {
        None
    }
}

//~ is not general enough
const CLASS: Class = Class::material::<Surface<'static>>("surface");

fn main() {}
