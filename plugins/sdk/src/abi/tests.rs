//! The smallest plugin, as a third party would write it, seen through its class alone.

use std::marker::PhantomData;

use glam::Vec3;

use super::{Class, View};
use crate::Params;
use crate::color::Spectrum;
use crate::kind::{Eval, Material, MaterialRef, Sample, reflect};
use crate::params::{Preset, Type};

/// A perfect mirror.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Mirror {
    /// Fraction of light reflected.
    #[param(default = 1.0, role = reflectance, textured)]
    reflectance: Spectrum,
}

impl Material for Mirror {
    fn eval(&self, _wo: Vec3, _wi: Vec3) -> Eval {
        Eval::ZERO
    }
    fn sample(&self, wo: Vec3, _u: [f32; 3]) -> Option<Sample> {
        Some(Sample::delta(reflect(wo), self.reflectance))
    }
}

/// Another material, darker.
#[derive(Params, Clone, Copy)]
#[repr(C)]
struct Darker<'a> {
    /// What is darkened.
    #[param(required)]
    base: MaterialRef<'a>,
    /// By how much.
    #[param(default = 0.5, min = 0, max = 1)]
    factor: f32,
    #[param(derived)]
    squared: f32,
}

impl Material for Darker<'_> {
    fn prepare(&mut self) {
        self.squared = self.factor * self.factor;
    }
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        let inner = self.base.eval(wo, wi);
        Eval { f: inner.f * self.squared, ..inner }
    }
    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        let inner = self.base.sample(wo, u)?;
        Some(Sample { weight: inner.weight * self.squared, ..inner })
    }
}

#[test]
fn the_derive_writes_the_schema_down() {
    let class = Class::material::<Mirror>("mirror");
    assert_eq!(class.doc, "A perfect mirror.");
    let param = &class.params[0];
    assert_eq!((param.name, param.ty), ("reflectance", Type::Spectrum));
    assert_eq!(param.default, Preset::Numbers([1.0; 4]));
    assert!(param.min >= 0.0 && param.max <= 1.0);
    assert!(param.textured && class.prepare.is_none());
}

#[test]
fn a_view_calls_the_struct_behind_the_bytes() {
    let mirror = Mirror { reflectance: Spectrum::splat(0.5) };
    let class = Class::material::<Darker<'_>>("darker");
    let mut darker = Darker { base: MaterialRef::new(&mirror), factor: 0.5, squared: 0.0 };
    let prepare = class.prepare.expect("it has a derived field");
    // SAFETY: the address of a live `Darker`.
    unsafe { prepare((&raw mut darker).cast()) };
    let View::Material(view) = class.view else { panic!("a material's view") };
    // SAFETY: as above.
    let seen = unsafe { view((&raw const darker).cast(), PhantomData) };
    let sample = seen.sample(Vec3::Z, [0.0; 3]).unwrap();
    assert_eq!(sample.weight, Spectrum::splat(0.125));
}
