//! Materials: finite, reciprocal, no energy out of nothing, and sampled as they say.

use std::f32::consts::TAU;

use glam::Vec3;
use luxel_sdk::kind::{Eval, Lobe, Material, Needs, Sample};
use luxel_sdk::num::Moments;
use luxel_sdk::sampling::{Rng, uniform_sphere};

use crate::lobes::{Drawn, Lobes, SHARES};
use crate::report::Judge;
use crate::reversal::is_reversible;
use crate::statistics::{deviation, mean_error};
use crate::subject::Subject;

/// Cosines of the viewer for statistics; the last is inside.
const VIEWS: [f32; 4] = [0.97, 0.6, 0.15, -0.5];

/// Steps by which a direction may be off through rounding, in f32's: those of a half vector, its
/// length, and the frame.
const STEPS: f32 = 6.0;

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    for (set, mut rng) in subject.all() {
        set.ask(|resolved| {
            let m = resolved.material();
            let at = || set.label.clone();
            stays_finite(m, judge, &at);
            keeps_its_needs(m, &mut rng, judge, &at);
        });
    }
    let (mut dense, mut views) = (0.0, 0.0);
    for (set, mut rng) in subject.usual() {
        set.ask(|resolved| {
            let m = resolved.material();
            let at = || set.label.clone();
            is_reciprocal(m, &mut rng, judge, &at);
            is_reversible(m, &mut rng, judge, &at);
            for cos in VIEWS {
                if let Some(z) = scatters(m, cos, &mut rng, subject.options.samples, judge, &at) {
                    (dense, views) = (dense + z, views + 1.0);
                }
            }
        });
    }
    if views > 0.0 {
        let z = f64::abs(dense) / f64::sqrt(views);
        judge.statistic(SHARES, z, || format!("over {views} directions"));
    }
    subject.concurrent(judge, |resolved| {
        let (m, mut rng) = (resolved.material(), Rng::new(7));
        let mut bits = vec![];
        for _ in 0..200 {
            let (wo, wi) = (uniform_sphere(rng.pair()), uniform_sphere(rng.pair()));
            let eval = m.eval(wo, wi);
            bits.extend(eval.f.to_array().map(f32::to_bits));
            bits.push(eval.pdf.to_bits());
            let sample = m.sample(wo, [0.1, rng.f32(), rng.f32()]);
            bits.extend(sample.map_or([0; 3], |s| s.wi.to_array().map(f32::to_bits)));
        }
        bits
    });
}

fn view(cos: f32, phi: f32) -> Vec3 {
    let r = (1.0 - cos * cos).max(0.0).sqrt();
    Vec3::new(r * phi.cos(), r * phi.sin(), cos)
}

fn is_legal(eval: Eval) -> bool {
    let f = eval.f.is_finite() && eval.f.0.min_element() >= 0.0;
    f && eval.pdf >= 0.0 && eval.pdf.is_finite()
}

/// Finite and not negative down to cosines of 1e-6 and at 0, above and below the horizon, in every
/// lane; samples are legal.
fn stays_finite(m: &dyn Material, judge: &mut Judge, at: &dyn Fn() -> String) {
    const COSINES: [f32; 10] = [1.0, 0.5, 0.05, 1e-3, 1e-6, 0.0, -1e-6, -1e-3, -0.5, -1.0];
    let directions: Vec<Vec3> =
        COSINES.iter().flat_map(|cos| [0.0, 1.0, 3.0, 4.0].map(|phi| view(*cos, phi))).collect();
    let ends = [0.0, 0.5, 1.0f32.next_down()];
    for &wo in &directions {
        let mirror = luxel_sdk::kind::reflect(wo);
        for &wi in directions.iter().chain([&mirror, &-wo]) {
            let eval = m.eval(wo, wi);
            judge.holds("finite and not negative", is_legal(eval), || {
                format!("{}: wo {wo} wi {wi}: {eval:?}", at())
            });
        }
        for i in 0..27 {
            let u = [ends[i % 3], ends[i / 3 % 3], ends[i / 9]];
            if let Some(sample) = m.sample(wo, u) {
                is_legal_sample(wo, &sample, judge, &|| format!("{}: wo {wo} u {u:?}", at()));
            }
        }
    }
    let nan = Vec3::splat(f32::NAN);
    let ends = is_legal(m.eval(nan, Vec3::Z)) && is_legal(m.eval(Vec3::Z, nan));
    let none = m.sample(nan, [0.5; 3]).is_none_or(|s| s.weight.is_finite() && s.wi.is_finite());
    judge.holds("NaN stops at the material", ends && none, at);
}

fn is_legal_sample(wo: Vec3, s: &Sample, judge: &mut Judge, at: &dyn Fn() -> String) {
    let finite = s.weight.is_finite() && s.weight.0.min_element() >= 0.0;
    let density = s.pdf > 0.0 && s.pdf.is_finite() && s.eta > 0.0 && s.eta.is_finite();
    judge.holds("samples are finite", finite && density, || format!("{}: {s:?}", at()));
    // Two dozen roundings of f32.
    let off = f64::from((s.wi.length() - 1.0).abs());
    judge.within("|wi| = 1", off, 1.5e-6, || format!("{}: {s:?}", at()));
    let crosses = wo.z * s.wi.z < 0.0;
    let told = s.lobe.has(Lobe::TRANSMISSION);
    let grazing = wo.z.abs() < 1e-5 || s.wi.z.abs() < 1e-5;
    judge.holds("flags say which side", crosses == told || grazing, || format!("{}: {s:?}", at()));
    let plain = (s.eta - 1.0).abs() <= 0.0 || told;
    judge.holds("eta is 1 in reflection", plain, || format!("{}: {s:?}", at()));
    let unit = !s.lobe.has(Lobe::DELTA) || (s.pdf - 1.0).abs() <= 0.0;
    judge.holds("a delta has pdf 1", unit, || format!("{}: {s:?}", at()));
}

/// What it says that it does not look at makes no difference.
fn keeps_its_needs(m: &dyn Material, rng: &mut Rng, judge: &mut Judge, at: &dyn Fn() -> String) {
    let needs = m.needs();
    let mut turned = 0;
    for _ in 0..200 {
        let (wo, wi) = (uniform_sphere(rng.pair()), uniform_sphere(rng.pair()));
        let ([u, v], choice) = (rng.pair(), rng.f32());
        let eval = m.eval(wo, wi);
        if !needs.has(Needs::LIGHT) {
            let dark = eval.f.is_black() && eval.pdf <= 0.0;
            judge.holds("eval is 0 without LIGHT", dark, || {
                format!("{}: wo {wo} wi {wi}: {eval:?}; add `Needs::LIGHT` to `needs`", at())
            });
        }
        if !needs.has(Needs::CHOICE) {
            let same = m.sample(wo, [u, v, choice]) == m.sample(wo, [u, v, 0.0]);
            judge.holds("no choice without CHOICE", same, || {
                let told = "sample looks at u[2]; add `Needs::CHOICE` to `needs`";
                format!("{}: wo {wo}: {told}", at())
            });
        }
        if !needs.has(Needs::TANGENT) {
            let turn = glam::Quat::from_rotation_z(TAU * choice);
            let (wo2, wi2) = (turn * wo, turn * wi);
            let off = (m.eval(wo2, wi2).f - eval.f).0.abs().max_element();
            let allowed = 1e-5 * eval.f.max_element() + spread(m, wo, wi).0;
            turned += u32::from(!(off <= allowed));
        }
    }
    // At the edge of a lobe a rounding decides, but that is rare.
    if !needs.has(Needs::TANGENT) {
        judge.within("isotropic without TANGENT", f64::from(turned), 10.0, || {
            let told =
                "of 200 pairs of directions change when both are turned: eval looks at dp/du";
            format!("{}: {turned} {told}; add `Needs::TANGENT` to `needs`", at())
        });
    }
}

/// How far value and density change when a direction is off by what rounding may do.
fn spread(m: &dyn Material, wo: Vec3, wi: Vec3) -> (f32, f32) {
    let here = m.eval(wo, wi);
    let (mut f, mut pdf) = (0.0f32, 0.0f32);
    for axis in 0..6 {
        let mut step = Vec3::ZERO;
        step[axis % 3] = STEPS * f32::EPSILON * if axis < 3 { 1.0 } else { -1.0 };
        for (wo, wi) in [(wo, (wi + step).normalize()), ((wo + step).normalize(), wi)] {
            let there = m.eval(wo, wi);
            f = f.max((there.f - here.f).0.abs().max_element());
            pdf = pdf.max((there.pdf - here.pdf).abs());
        }
    }
    (2.0 * f, 2.0 * pdf)
}

/// f(wo, wi) = f(wi, wo), for refraction but for the squared relative index.
fn is_reciprocal(m: &dyn Material, rng: &mut Rng, judge: &mut Judge, at: &dyn Fn() -> String) {
    for i in 0..600 {
        let wo = uniform_sphere(rng.pair());
        let ([u, v], choice) = (rng.pair(), rng.f32());
        let (wi, eta) = if i % 3 == 0 {
            let wi = uniform_sphere([u, v]);
            (Vec3::new(wi.x, wi.y, wi.z.copysign(wo.z)), 1.0)
        } else {
            let Some(s) = m.sample(wo, [u, v, choice]) else { continue };
            if s.lobe.has(Lobe::DELTA) {
                continue;
            }
            (s.wi, s.eta)
        };
        if wo.z.abs().min(wi.z.abs()) < 1e-3 {
            continue;
        }
        let there = m.eval(wo, wi).f * (eta * eta * wo.z.abs());
        let back = m.eval(wi, wo).f * wi.z.abs();
        let off = f64::from((there - back).0.abs().max_element());
        // A few dozen roundings, and what directions are off.
        let loose = spread(m, wo, wi).0 * eta * eta + spread(m, wi, wo).0;
        let allowed = 2e-5 * there.max_element().max(back.max_element()) + loose + 1e-30;
        judge.within("reciprocity", off / f64::from(allowed), 1.0, || {
            format!("{}: wo {wo} wi {wi}: {there:?} {back:?}", at())
        });
    }
}

/// Samples against `eval`: weight, density, energy, and where they fall. Gives back how lobes are
/// shared, where they have a density.
fn scatters(
    m: &dyn Material,
    cos: f32,
    rng: &mut Rng,
    n: u32,
    judge: &mut Judge,
    at: &dyn Fn() -> String,
) -> Option<f64> {
    let wo = view(cos, TAU * rng.f32());
    let at = || format!("{}: wo {wo}", at());
    let mut energy = [Moments::default(); 4];
    let (mut deltas, mut lossless) = (0u32, 0.0f64);
    for i in 0..n {
        let [u, v] = rng.pair();
        let sample = m.sample(wo, [u, v, rng.f32()]);
        let carried = sample.map_or([0.0; 4], |s| carried(&s));
        for (lane, carried) in energy.iter_mut().zip(carried) {
            lane.push(f64::from(carried));
            lossless = lossless.max(f64::from(carried));
        }
        let Some(s) = sample else { continue };
        if s.lobe.has(Lobe::DELTA) {
            deltas += 1;
        } else if i < 1000 {
            is_legal_sample(wo, &s, judge, &at);
            agrees_with_eval(m, wo, &s, judge, &at);
        }
    }
    for (lane, moments) in energy.iter().enumerate() {
        // Rounding of a weight, a dozen of f32.
        let above = (moments.mean - 1.0 - 2e-6).max(0.0);
        let sigma = mean_error(moments);
        judge.statistic("albedo is at most 1", deviation(above, 0.0, sigma), || {
            format!("{}: lane {lane}: {}", at(), moments.mean)
        });
    }
    if !m.needs().has(Needs::LIGHT) {
        refracts(m, wo, rng, judge, &at);
    }
    if deltas == n {
        let black = (0..200).all(|_| m.eval(wo, uniform_sphere(rng.pair())) == Eval::ZERO);
        judge.holds("eval is 0 for a delta", black, at);
        return None;
    }
    let sample = |u: [f32; 3]| {
        let s = m.sample(wo, u).filter(|s| !s.lobe.has(Lobe::DELTA))?;
        Some(Drawn { wi: s.wi.as_dvec3(), weight: f64::from(s.weight.mean()) })
    };
    // Quadrature looks into every corner: what it sees there must be legal too.
    let illegal = std::cell::Cell::new(None);
    let eval = |wi: glam::DVec3| {
        let eval = m.eval(wo, wi.as_vec3());
        if !is_legal(eval) {
            illegal.set(Some((wi, eval)));
        }
        [f64::from(eval.pdf), f64::from(eval.f.mean())]
    };
    let found = Lobes { sample: &sample, eval: &eval }.judge(judge, rng, n, &at);
    judge.holds("finite and not negative", illegal.get().is_none(), || {
        format!("{}: {:?}", at(), illegal.get())
    });
    Some(found.dense)
}

/// A specular surface bends light by the relative index that it states (Snell's law).
fn refracts(m: &dyn Material, wo: Vec3, rng: &mut Rng, judge: &mut Judge, at: &dyn Fn() -> String) {
    for _ in 0..64 {
        let [u, v] = rng.pair();
        let Some(s) = m.sample(wo, [u, v, rng.f32()]) else { continue };
        let off = f64::from((wo.truncate() + s.wi.truncate() * s.eta).length());
        // A dozen roundings of lengths up to eta. Reflection and straight passage fulfil it as well.
        let mirror = f64::from((wo + s.wi).truncate().length());
        let off = if s.lobe.has(Lobe::TRANSMISSION) { off } else { mirror };
        judge.within("Snell's law", off / f64::from(s.eta.max(1.0)), 4e-6, || {
            format!("{}: {s:?}", at())
        });
    }
}

/// Energy over energy per lane; where the direction holds for the first lane alone, only that counts.
fn carried(s: &Sample) -> [f32; 4] {
    let all = (s.weight * (s.eta * s.eta)).to_array();
    if s.lobe.has(Lobe::DISPERSIVE) { [all[0], 0.0, 0.0, 0.0] } else { all }
}

/// `pdf` is that of `eval`, and the weight is the quotient.
fn agrees_with_eval(
    m: &dyn Material,
    wo: Vec3,
    s: &Sample,
    judge: &mut Judge,
    at: &dyn Fn() -> String,
) {
    let eval = m.eval(wo, s.wi);
    let (f_spread, pdf_spread) = spread(m, wo, s.wi);
    let allowed = 2e-5 * s.pdf + pdf_spread;
    let off = (s.pdf - eval.pdf).abs();
    judge.within("pdf of sample is that of eval", f64::from(off / allowed), 1.0, || {
        format!("{}: {s:?} {eval:?}", at())
    });
    let value = s.weight * s.pdf;
    let off = (value - eval.f).0.abs().max_element();
    let largest = value.max_element().max(eval.f.max_element());
    let relative = pdf_spread / s.pdf;
    let allowed = 4e-5 * largest + f_spread + relative * largest + 1e-30;
    judge.within("weight = eval / pdf", f64::from(off / allowed), 1.0, || {
        format!("{}: {s:?} {eval:?}", at())
    });
}
