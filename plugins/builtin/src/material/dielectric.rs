//! Glass, water and other clear matter, smooth and rough.

use glam::Vec3;
use luxel_sdk::Params;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample};
use luxel_sdk::scattering::{Ggx, SMOOTH_ALPHA, dielectric_reflectance, refract};

use super::conductor::upright;

/// Glass, water, crystal: reflects and refracts by Fresnel's equations. The shape's inside has this
/// index, its outside that of the shape it lies in, or of a vacuum. Rough, it is frosted glass
/// (Walter et al. 2007).
///
/// ```scene
/// let bk7     = material dielectric { ior = glass("N-BK7") }
/// let frosted = bk7 with { roughness = 0.15 }
/// ```
///
/// Where `ior` depends on the wavelength, colours part: refraction then carries one wavelength.
/// Light that bounces between the facets of a rough surface is left out.
#[derive(Params, Clone, Copy)]
#[repr(C)]
pub(crate) struct Dielectric {
    /// Index of refraction: a number, or measured as `glass("N-BK7")`. 1 is invisible.
    #[param(default = 1.5, role = ior, min = 0.1, max = 10, textured)]
    pub(crate) ior: Spectrum,
    /// GGX roughness alpha; below 1e-4, and where the index is so near 1 that it hardly bends light,
    /// perfectly smooth.
    #[param(default = 0.0, min = 0, max = 1, textured)]
    pub(crate) roughness: f32,
}

/// The boundary as light meets it from one side.
struct Boundary {
    /// Index beyond over index here, per lane; the first decides directions.
    eta: Spectrum,
    dispersive: bool,
    facets: Ggx,
}

impl Dielectric {
    fn boundary(&self, wo: Vec3) -> Boundary {
        let eta = if wo.z > 0.0 { self.ior } else { 1.0 / self.ior };
        let lanes = self.ior.0;
        let dispersive = lanes.min_element() < lanes.max_element();
        Boundary { eta, dispersive, facets: Ggx::anisotropic(self.roughness, 0.0) }
    }

    /// Refraction turns a facet's slope α into one of α·|η − 1|: below what f32 directions tell.
    fn is_smooth(&self) -> bool {
        let bend = (self.ior.lane(0) - 1.0).abs().min(1.0);
        self.roughness * bend < SMOOTH_ALPHA
    }
}

impl Boundary {
    /// Reflectance per lane of a facet seen at the cosine `cos` ≥ 0.
    fn reflectance(&self, cos: f32) -> Spectrum {
        if self.dispersive {
            return Spectrum::from_array(
                self.eta.to_array().map(|eta| dielectric_reflectance(cos, eta)),
            );
        }
        Spectrum::splat(dielectric_reflectance(cos, self.eta.lane(0)))
    }

    /// A direction off one facet with normal `wm`, `wo` above: which way, `choice` in [0, 1) says.
    /// The weight is that of the facet alone, the density the probability of the choice.
    fn off_facet(&self, wo: Vec3, wm: Vec3, choice: f32) -> Option<Sample> {
        let reflected = self.reflectance(wo.dot(wm));
        let chance = reflected.lane(0);
        if choice < chance {
            let wi = (2.0 * wo.dot(wm) * wm - wo).normalize();
            let weight = reflected / chance;
            return Some(Sample { weight, wi, pdf: chance, eta: 1.0, lobe: Lobe::NONE });
        }
        let eta = self.eta.lane(0);
        let wi = refract(wo, wm, eta)?;
        let mut lobe = Lobe::TRANSMISSION;
        if self.dispersive {
            lobe = lobe.with(Lobe::DISPERSIVE);
        }
        let weight = Spectrum::splat((eta * eta).recip());
        Some(Sample { weight, wi, pdf: 1.0 - chance, eta, lobe })
    }

    /// Reflection by rough facets; both directions above.
    fn eval_reflection(&self, wo: Vec3, wi: Vec3) -> Eval {
        let wm = (wo + wi).normalize();
        let reflected = self.reflectance(wo.dot(wm));
        let scale = 0.25 * self.facets.d(wm) * self.facets.g2_over_cos_o(wo, wi);
        let pdf = 0.25 * self.facets.visible_over_cos(wo, wm) * reflected.lane(0);
        Eval { f: reflected * scale, pdf }
    }

    /// Refraction by rough facets; `wo` above, `wi` below. Walter et al. 2007, eq. 21, and PBR4
    /// §9.7, for radiance.
    fn eval_refraction(&self, wo: Vec3, wi: Vec3) -> Eval {
        let eta = self.eta.lane(0);
        let across = eta * wi + wo;
        // The facet's normal is on the side of `wo` whichever side is denser.
        let wm = across.normalize() * 1.0f32.copysign(across.z);
        let (cos_o, cos_i) = (wo.dot(wm), wi.dot(wm));
        if !(cos_o > 0.0 && cos_i < 0.0) {
            return Eval::ZERO;
        }
        let passed = 1.0 - self.reflectance(cos_o).lane(0);
        // cos_o·|cos_i|/(η cos_i + cos_o)²: the Jacobian, but for η².
        let span = across.dot(wm);
        let bend = passed * cos_o * -cos_i / (span * span);
        let f = bend * self.facets.d(wm) * self.facets.g2_over_cos_o(wo, wi);
        let pdf = eta * eta * bend * self.facets.visible_over_cos(wo, wm);
        Eval { f: Spectrum::splat(f), pdf }
    }
}

impl Material for Dielectric {
    fn eval(&self, wo: Vec3, wi: Vec3) -> Eval {
        if self.is_smooth() || !(wo.z * wi.z).is_finite() {
            return Eval::ZERO;
        }
        let boundary = self.boundary(wo);
        let (wo, wi) = upright(wo, wi);
        if wo.z > 0.0 && wi.z > 0.0 {
            return boundary.eval_reflection(wo, wi);
        }
        // Each wavelength has its own directions: only sampling finds them.
        let never = boundary.dispersive || !(wo.z > 0.0 && wi.z < 0.0);
        if never { Eval::ZERO } else { boundary.eval_refraction(wo, wi) }
    }

    fn sample(&self, wo: Vec3, u: [f32; 3]) -> Option<Sample> {
        if !(wo.z.abs() > 0.0) {
            return None;
        }
        let boundary = self.boundary(wo);
        let (up, _) = upright(wo, wo);
        let smooth = self.is_smooth();
        let wm = if smooth { Vec3::Z } else { boundary.facets.sample(up, [u[0], u[1]]) };
        if !(up.dot(wm) > 0.0) {
            return None;
        }
        let mut sample = boundary.off_facet(up, wm, u[2])?;
        let refracted = sample.lobe.has(Lobe::TRANSMISSION);
        if refracted != (sample.wi.z < 0.0) {
            return None;
        }
        if smooth || (refracted && boundary.dispersive) {
            sample.lobe = sample.lobe.with(Lobe::DELTA);
            sample.pdf = 1.0;
        } else if refracted {
            sample.pdf = boundary.eval_refraction(up, sample.wi).pdf;
        } else {
            sample.pdf *= 0.25 * boundary.facets.visible_over_cos(up, wm);
        }
        if !smooth {
            sample.weight *= boundary.facets.shadowing(up, sample.wi);
        }
        if wo.z < 0.0 {
            sample.wi = -sample.wi;
        }
        (sample.pdf > 0.0).then_some(sample)
    }

    fn needs(&self) -> Needs {
        if self.is_smooth() { Needs::CHOICE } else { Needs::LIGHT.with(Needs::CHOICE) }
    }
}

#[cfg(test)]
mod tests {
    use super::super::check::{self, Side, check_all};
    use super::*;

    fn glass(ior: f32, roughness: f32) -> Dielectric {
        Dielectric { ior: Spectrum::splat(ior), roughness }
    }

    #[test]
    fn frosted_glass_scatters_as_it_claims_from_both_sides() {
        // Rougher facets end abruptly at their horizon, where a quadrature is off by half a row.
        for (ior, roughness) in [(1.5, 0.2), (0.7, 0.3)] {
            check_all(&glass(ior, roughness));
            check::scatters_as_it_claims(&glass(ior, roughness), Side::Inside);
        }
    }

    #[test]
    fn refraction_is_reciprocal_but_for_the_squared_index() {
        let glass = glass(1.5, 0.4);
        let (wo, wi) =
            (Vec3::new(0.3, 0.2, 0.9).normalize(), Vec3::new(-0.4, 0.0, -0.7).normalize());
        let there = glass.eval(wo, wi).f.lane(0) / wi.z.abs() * 2.25;
        let back = glass.eval(wi, wo).f.lane(0) / wo.z.abs();
        // Two dozen f32 roundings, amplified by the slope of D: 4/alpha.
        assert!((there / back - 1.0).abs() < 1e-4, "{there} {back}");
    }

    #[test]
    fn smooth_glass_loses_nothing_and_obeys_snell() {
        let glass = glass(1.5, 0.0);
        for z in [1.0f32, 0.7, 0.1, 1e-3] {
            for wo in [z, -z].map(|z| Vec3::new((1.0 - z * z).sqrt(), 0.0, z)) {
                let eta = if z > 0.0 && wo.z > 0.0 { 1.5f32 } else { 1.0 / 1.5 };
                let reflected = dielectric_reflectance(z, eta);
                let mirror = glass.sample(wo, [0.5, 0.5, 0.0]).unwrap();
                assert!((mirror.wi - reflect_up(wo)).length() < 1e-6);
                assert!((mirror.weight.lane(0) - 1.0).abs() < 1e-6);
                let last = glass.sample(wo, [0.5, 0.5, 1.0f32.next_down()]).unwrap();
                assert!(last.lobe.has(Lobe::DELTA));
                if reflected < 1.0 {
                    assert!((last.weight.lane(0) * eta * eta - 1.0).abs() < 1e-6);
                    assert!((last.wi.x * eta + wo.x).abs() < 1e-6 && last.wi.z * wo.z < 0.0);
                } else {
                    assert!(!last.lobe.has(Lobe::TRANSMISSION));
                }
            }
        }
    }

    fn reflect_up(wo: Vec3) -> Vec3 {
        luxel_sdk::kind::reflect(wo)
    }

    #[test]
    fn an_index_of_one_is_invisible() {
        let nothing = glass(1.0, 0.5);
        let wo = Vec3::new(0.6, 0.0, 0.8);
        let sample = nothing.sample(wo, [0.2, 0.3, 0.0]).unwrap();
        assert!((sample.wi + wo).length() < 1e-6 && !nothing.needs().has(Needs::LIGHT));
        assert_eq!(
            (sample.weight.to_array(), sample.lobe.has(Lobe::TRANSMISSION)),
            ([1.0; 4], true)
        );
    }

    #[test]
    fn dispersion_is_flagged_where_light_is_bent_and_never_found_by_eval() {
        let ior = Spectrum::new(1.53, 1.52, 1.51, 1.5);
        let wo = Vec3::new(0.6, 0.0, 0.8);
        for roughness in [0.0, 0.3] {
            let prism = Dielectric { ior, roughness };
            let mirror = prism.sample(wo, [0.1, 0.3, 0.0]).unwrap();
            assert!(!mirror.lobe.has(Lobe::DISPERSIVE));
            assert!(mirror.weight.lane(0) > mirror.weight.lane(3));
            let bent = prism.sample(wo, [0.1, 0.3, 0.9]).unwrap();
            assert!(bent.lobe.has(Lobe::DISPERSIVE.with(Lobe::TRANSMISSION).with(Lobe::DELTA)));
            assert!(prism.eval(wo, bent.wi) == Eval::ZERO);
        }
    }

    #[test]
    fn glass_stays_finite_at_grazing_angles() {
        for ior in [0.1, 1.0 + 1e-6, 1.001, 1.5, 10.0] {
            for roughness in [0.0, 2e-4, 0.05, 1.0] {
                check::stays_finite(&glass(ior, roughness));
            }
        }
    }
}
