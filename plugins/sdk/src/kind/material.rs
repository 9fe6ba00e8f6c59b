//! How a surface scatters light, given its parameters at one point.

use glam::Vec3;

use super::flags::flag_set;
use crate::color::Spectrum;
use crate::params::Fault;

/// Value and density of scattering from `wo` to `wi`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Eval {
    /// `f·|cos_i|`, sr⁻¹.
    pub f: Spectrum,
    /// Density with which `sample` finds `wi`, sr⁻¹; delta lobes do not count.
    pub pdf: f32,
}

impl Eval {
    /// Nothing is scattered that way.
    pub const ZERO: Self = Self { f: Spectrum::ZERO, pdf: 0.0 };
}

/// What kind of lobe a sample came from: a set of flags.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(transparent)]
pub struct Lobe(pub u32);

impl Lobe {
    /// Nothing special.
    pub const NONE: Self = Self(0);
    /// A direction that `eval` never finds.
    pub const DELTA: Self = Self(1);
    /// `wi` is on the other side than `wo`.
    pub const TRANSMISSION: Self = Self(2);
    /// `wi` depends on the wavelength: it holds for the first lane alone.
    pub const DISPERSIVE: Self = Self(4);
}
flag_set!(Lobe);

/// What a material looks at: a set of flags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct Needs(pub u32);

impl Needs {
    /// Nothing but `wo` and two random numbers.
    pub const NOTHING: Self = Self(0);
    /// Light that is looked for: `eval` is not zero everywhere.
    pub const LIGHT: Self = Self(1);
    /// The third random number, to choose between lobes; 0 where it is not needed.
    pub const CHOICE: Self = Self(2);
    /// The direction of dp/du; where it is not needed, x is any direction along the surface.
    pub const TANGENT: Self = Self(4);
    /// All of them.
    pub const ALL: Self = Self(7);
}
flag_set!(Needs);

/// A sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Sample {
    /// eval / pdf; for a delta lobe what it carries over the chance that it was chosen.
    pub weight: Spectrum,
    /// Unit direction in the local frame.
    pub wi: Vec3,
    /// Solid-angle density, sr⁻¹; 1 for a delta lobe.
    pub pdf: f32,
    /// Relative index `eta_t / eta_i` of a transmission (radiance grows by its square), else 1.
    pub eta: f32,
    /// Where it came from.
    pub lobe: Lobe,
}

impl Sample {
    /// A direction from a lobe with a density, on the viewer's side: its weight is `f / pdf`. `None`
    /// where `eval` says that it is never found.
    pub fn of(wi: Vec3, Eval { f, pdf }: Eval) -> Option<Self> {
        let found = || Self { weight: f / pdf, wi, pdf, eta: 1.0, lobe: Lobe::NONE };
        (pdf > 0.0).then(found)
    }

    /// A perfectly specular direction on the viewer's side.
    pub const fn delta(wi: Vec3, weight: Spectrum) -> Self {
        Self { weight, wi, pdf: 1.0, eta: 1.0, lobe: Lobe::DELTA }
    }
}

/// The mirror direction of `wo` about the local normal +z.
pub fn reflect(wo: Vec3) -> Vec3 {
    Vec3::new(-wo.x, -wo.y, wo.z)
}

/// How a surface scatters light.
///
/// Directions are unit vectors in the local frame: +z is the shading normal on the outside of the
/// shape, x along dp/du. `wo.z < 0` means that the viewer is inside. All results are finite and not
/// negative; where the mathematics has no answer (grazing, below the horizon) there is nothing.
pub trait Material: Send + Sync {
    /// Computes the derived fields; called after every change of the others.
    fn prepare(&mut self) {}

    /// Rules between parameters that no schema can state.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// `f·|cos_i|` and the density of `sample`, without delta lobes.
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval;

    /// A direction, `u` uniform in [0, 1)³. `None` when nothing is scattered.
    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample>;

    /// What it looks at here; the host leaves out the rest. All of it, unless you say otherwise: a
    /// flag too many costs time, one too few is a wrong picture.
    fn needs(&self) -> Needs {
        Needs::ALL
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_of_a_density_weighs_its_quotient_and_one_without_is_none() {
        let f = Spectrum::new(1.0, 0.5, 0.25, 0.0);
        let found = Sample::of(Vec3::Z, Eval { f, pdf: 0.5 }).unwrap();
        let expected = Spectrum::new(2.0, 1.0, 0.5, 0.0);
        assert_eq!(found.weight, expected);
        assert_eq!((found.wi, found.pdf.to_bits()), (Vec3::Z, 0.5f32.to_bits()));
        assert_eq!((found.eta.to_bits(), found.lobe), (1.0f32.to_bits(), Lobe::NONE));
        for pdf in [0.0, -1.0, f32::NAN] {
            assert_eq!(Sample::of(Vec3::Z, Eval { f, pdf }), None);
        }
    }
}
