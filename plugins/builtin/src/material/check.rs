//! What every material of this folder must satisfy; the conformance suite asks more.

use std::f32::consts::{PI, TAU};

use glam::Vec3;
use luxel_sdk::kind::{Lobe, Material};
use luxel_sdk::sampling::Rng;

/// Where the viewer is.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Side {
    Outside,
    Inside,
}

/// All checks of a reciprocal material, from outside.
pub(super) fn check_all(material: &dyn Material) {
    scatters_as_it_claims(material, Side::Outside);
    is_reciprocal(material);
    stays_finite(material);
}

const N: u32 = 20_000;
/// Means over directions that tell lobes apart: 1, z, x, z².
fn features(w: Vec3) -> [f64; 4] {
    let w = w.as_dvec3();
    [1.0, w.z, w.x, w.z * w.z]
}

/// Sums of values and squares of the four features.
#[derive(Default)]
struct Means {
    sum: [f64; 4],
    square: [f64; 4],
}

impl Means {
    fn add(&mut self, w: Vec3, weight: f32) {
        for (i, h) in features(w).into_iter().enumerate() {
            let value = h * f64::from(weight);
            self.sum[i] += value;
            self.square[i] += value * value;
        }
    }

    /// Five standard errors, and 2e-3 for the quadrature.
    fn check(&self, expected: [f64; 4], what: &str) {
        let n = f64::from(N);
        for (i, expected) in expected.into_iter().enumerate() {
            let mean = self.sum[i] / n;
            let error = ((self.square[i] / n - mean * mean).max(0.0) / n).sqrt();
            let off = (mean - expected).abs();
            assert!(off <= 5.0 * error + 2e-3, "{what} {i}: {mean} is not {expected} ± {error}");
        }
    }
}

/// Samples against `eval` and `pdf` integrated over the sphere; energy; weight = eval / pdf.
pub(super) fn scatters_as_it_claims(material: &dyn Material, side: Side) {
    let mut rng = Rng::new(11);
    for cos in [1.0f32, 0.6, 0.15] {
        let wo = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
        let wo = if side == Side::Inside { -wo } else { wo };
        let (mut found, mut carried, mut energy) = (Means::default(), Means::default(), 0.0);
        for _ in 0..N {
            let [a, b] = rng.pair();
            let Some(sample) = material.sample(wo, [a, b, rng.f32()]) else { continue };
            energy += f64::from(sample.weight.max_element() * sample.eta * sample.eta);
            if sample.lobe.has(Lobe::DELTA) {
                continue;
            }
            let eval = material.eval(wo, sample.wi);
            // Rounding of the half vector, 6e-8 over the least roughness tested, times 4, and more
            // where refraction bends little.
            assert!((sample.pdf / eval.pdf - 1.0).abs() < 2e-3, "{} {}", sample.pdf, eval.pdf);
            let weight = eval.f.lane(0) / eval.pdf;
            assert!((sample.weight.lane(0) - weight).abs() <= 2e-3 * weight);
            found.add(sample.wi, 1.0);
            carried.add(sample.wi, weight);
        }
        assert!(energy <= f64::from(N) * (1.0 + 1e-6), "albedo {}", energy / f64::from(N));
        let (pdf, f) = integrals(material, wo);
        found.check(pdf, "pdf");
        carried.check(f, "eval");
    }
}

/// ∫ pdf and ∫ f·cos of the first lane, times the features, by the midpoint rule in polar angles,
/// which sees the narrow lobes around the poles.
fn integrals(material: &dyn Material, wo: Vec3) -> ([f64; 4], [f64; 4]) {
    let (rows, columns) = (720_u16, 500_u16);
    let (mut pdf, mut f) = ([0.0; 4], [0.0; 4]);
    for i in 0..rows {
        let (r, z) = ((f32::from(i) + 0.5) / f32::from(rows) * PI).sin_cos();
        for j in 0..columns {
            let (sin, cos) = ((f32::from(j) + 0.5) / f32::from(columns) * TAU).sin_cos();
            let wi = Vec3::new(r * cos, r * sin, z);
            let eval = material.eval(wo, wi);
            for (k, h) in features(wi).into_iter().enumerate() {
                pdf[k] += h * f64::from(eval.pdf * r);
                f[k] += h * f64::from(eval.f.lane(0) * r);
            }
        }
    }
    let cell = f64::from(TAU * PI) / f64::from(rows) / f64::from(columns);
    (pdf.map(|x| x * cell), f.map(|x| x * cell))
}

/// f(wo, wi) = f(wi, wo) for reflection.
pub(super) fn is_reciprocal(material: &dyn Material) {
    let mut rng = Rng::new(3);
    for _ in 0..100 {
        let a = luxel_sdk::sampling::uniform_hemisphere(rng.pair());
        let b = luxel_sdk::sampling::uniform_hemisphere(rng.pair());
        let there = material.eval(a, b).f / b.z;
        let back = material.eval(b, a).f / a.z;
        // A few dozen roundings.
        let off = (there - back).0.abs().max_element();
        assert!(off <= 1e-5 * there.max_element() + 1e-30, "{a} {b}: {there:?} {back:?}");
    }
}

/// Nothing that is not a number, negative or infinite, down to cosines of 1e-6 and at 0.
pub(super) fn stays_finite(material: &dyn Material) {
    let cosines = [1.0f32, 0.5, 1e-3, 1e-6, 0.0, -1e-6, -0.5, -1.0];
    let directions: Vec<Vec3> = cosines
        .into_iter()
        .flat_map(|z| {
            let r = (1.0 - z * z).sqrt();
            [0.0f32, 1.0, 3.0].map(|phi| Vec3::new(r * phi.cos(), r * phi.sin(), z))
        })
        .collect();
    let ends = [0.0, 0.5, 1.0f32.next_down()];
    for &wo in &directions {
        for &wi in &directions {
            let eval = material.eval(wo, wi);
            let legal = eval.f.is_finite() && eval.f.0.min_element() >= 0.0;
            assert!(legal && eval.pdf >= 0.0 && eval.pdf.is_finite(), "{wo} {wi} {eval:?}");
        }
        for i in 0..27 {
            let u = [ends[i % 3], ends[i / 3 % 3], ends[i / 9]];
            let Some(s) = material.sample(wo, u) else { continue };
            let legal = s.weight.is_finite() && s.weight.0.min_element() >= 0.0;
            assert!(legal && s.pdf > 0.0 && s.pdf.is_finite(), "{wo} {u:?} {s:?}");
            assert!((s.wi.length() - 1.0).abs() < 1e-5 && s.eta > 0.0, "{wo} {u:?} {s:?}");
        }
    }
    let nan = Vec3::splat(f32::NAN);
    assert!(material.eval(nan, Vec3::Z).f.is_finite() && material.sample(nan, [0.5; 3]).is_none());
}
