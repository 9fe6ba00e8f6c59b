//! One material laid over another, in parts.

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::kind::{Eval, Lobe, Material, MaterialRef, Needs, Sample};

/// Two materials side by side, too fine to see: at each point a share `weight` is `b`, the rest `a`.
/// A mask texture as weight makes rust on steel, or labels on glass.
///
/// ```scene
/// let rust  = material diffuse { reflectance = rgb.linear_srgb(0.3, 0.1, 0.05) }
/// let steel = material conductor { eta = metal("Fe"), roughness = 0.2 }
/// let worn  = material mix { a = steel, b = rust, weight = 0.3 }
/// ```
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Mix<'a> {
    /// What shows where the weight is 0.
    #[param(required)]
    a: MaterialRef<'a>,
    /// What shows where the weight is 1.
    #[param(required)]
    b: MaterialRef<'a>,
    /// Share of `b`.
    #[param(default = 0.5, min = 0, max = 1, textured)]
    weight: f32,
}

impl Material for Mix<'_> {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        let (a, b) = (self.a.eval(wo, wi), self.b.eval(wo, wi));
        let rest = 1.0 - self.weight;
        Eval { f: a.f * rest + b.f * self.weight, pdf: a.pdf * rest + b.pdf * self.weight }
    }

    fn sample(&self, wo: Vec3, [u, v, choice]: [f32; 3]) -> Option<Sample> {
        // What is left of the random number after the choice is as good as new.
        let (chosen, left) = if choice < self.weight {
            (self.b, choice / self.weight)
        } else {
            (self.a, (choice - self.weight) / (1.0 - self.weight))
        };
        let sample = chosen.sample(wo, [u, v, left.min(1.0f32.next_down())])?;
        // The chance of the choice cancels where only this material has the direction.
        if sample.lobe.has(Lobe::DELTA) {
            return Some(sample);
        }
        let Eval { f, pdf } = self.eval(wo, sample.wi);
        (pdf > 0.0).then_some(Sample { weight: f / pdf, pdf, ..sample })
    }

    fn needs(&self) -> Needs {
        self.a.needs().with(self.b.needs()).with(Needs::CHOICE)
    }
}

#[cfg(test)]
mod tests {
    use luxel_sdk::color::Spectrum;

    use super::super::check::{check_all, stays_finite};
    use super::super::{dielectric::Dielectric, diffuse::Diffuse};
    use super::*;

    #[test]
    fn mixtures_scatter_as_they_claim() {
        let matt = Diffuse { reflectance: Spectrum::new(0.8, 0.1, 0.5, 0.0) };
        let frosted = Dielectric { ior: Spectrum::splat(1.5), roughness: 0.3 };
        let clear = Dielectric { roughness: 0.0, ..frosted };
        for weight in [0.0, 0.25, 1.0] {
            let a = MaterialRef::new(&matt);
            let with_delta = Mix { a, b: MaterialRef::new(&clear), weight };
            let nested = Mix { a: MaterialRef::new(&with_delta), b: a, weight };
            stays_finite(&nested);
            if weight > 0.0 && weight < 1.0 {
                check_all(&Mix { a, b: MaterialRef::new(&frosted), weight });
                check_all(&with_delta);
            }
        }
    }

    #[test]
    fn a_specular_part_is_chosen_as_often_as_it_weighs() {
        let matt = Diffuse { reflectance: Spectrum::ONE };
        let clear = Dielectric { ior: Spectrum::splat(1.5), roughness: 0.0 };
        let mix = Mix { a: MaterialRef::new(&matt), b: MaterialRef::new(&clear), weight: 0.25 };
        assert!(mix.needs().has(Needs::LIGHT));
        for i in 0..64u8 {
            let choice = (f32::from(i) + 0.5) / 64.0;
            let sample = mix.sample(Vec3::Z, [0.3, 0.4, choice]).unwrap();
            assert_eq!(sample.lobe.has(Lobe::DELTA), i < 16);
        }
    }
}
