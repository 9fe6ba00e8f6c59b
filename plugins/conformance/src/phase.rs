//! Phase functions: normalised, symmetric, sampled as they say, and turned by `g`.

use glam::{DVec3, Vec3};
use luxel_sdk::kind::Phase;
use luxel_sdk::num::Moments;
use luxel_sdk::sampling::{Rng, uniform_sphere};

use crate::lobes::{Drawn, Lobes};
use crate::report::Judge;
use crate::statistics::{deviation, mean_error};
use crate::subject::Subject;

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    for (set, mut rng) in subject.usual() {
        set.ask(|resolved| {
            let phase = resolved.phase();
            let at = || set.label.clone();
            is_legal(phase, &mut rng, judge, &at);
            for wo in [Vec3::Z, Vec3::NEG_X, uniform_sphere(rng.pair())] {
                scatters(phase, wo, &mut rng, subject.options.samples, judge, &at);
            }
            // Of a needle's cosines the mean is not normal: few samples leave it, and decide.
            let g = set.number("g").filter(|g| takes_g(subject) && g.abs() < 0.97);
            if let Some(g) = g {
                mean_cosine(phase, g, &mut rng, subject.options.samples, judge, &at);
            }
        });
    }
    subject.concurrent(judge, |resolved| {
        let (phase, mut rng) = (resolved.phase(), Rng::new(7));
        let mut bits = vec![];
        for _ in 0..200 {
            let wo = uniform_sphere(rng.pair());
            bits.push(phase.eval(wo, uniform_sphere(rng.pair())).pdf.to_bits());
            let sample = phase.sample(wo, rng.pair());
            bits.extend(sample.map_or([0; 3], |s| s.wi.to_array().map(f32::to_bits)));
        }
        bits
    });
}

/// The field's name for the mean cosine.
fn takes_g(subject: &Subject<'_>) -> bool {
    subject.class.params.iter().any(|p| p.name == "g" && p.min >= -1.0 && p.max <= 1.0)
}

/// The rounding that a direction may be off by changes the value by so much.
fn spread(phase: &dyn Phase, wo: Vec3, wi: Vec3) -> f32 {
    let here = phase.eval(wo, wi).pdf;
    let steps = (0..3).map(|axis| {
        let mut step = Vec3::ZERO;
        step[axis] = 6.0 * f32::EPSILON;
        let there = [wi + step, wi - step].map(|wi| phase.eval(wo, wi.normalize()).pdf - here);
        there[0].abs().max(there[1].abs())
    });
    2.0 * steps.fold(0.0, f32::max)
}

fn is_legal(phase: &dyn Phase, rng: &mut Rng, judge: &mut Judge, at: &dyn Fn() -> String) {
    for i in 0..600 {
        let wo = uniform_sphere(rng.pair());
        let wi = match i % 4 {
            0 => wo,
            1 => -wo,
            _ => uniform_sphere(rng.pair()),
        };
        let eval = phase.eval(wo, wi);
        let legal = eval.f.is_finite() && eval.f.0.min_element() >= 0.0 && eval.pdf >= 0.0;
        judge.holds("finite and not negative", legal && eval.pdf.is_finite(), || {
            format!("{}: wo {wo} wi {wi}: {eval:?}", at())
        });
        let off = (phase.eval(wi, wo).f - eval.f).0.abs().max_element();
        let allowed = 2e-5 * eval.f.max_element() + spread(phase, wo, wi) + 1e-30;
        judge.within("reciprocity", f64::from(off / allowed), 1.0, || {
            format!("{}: wo {wo} wi {wi}", at())
        });
        let u = if i < 4 { [0.0, 1.0f32.next_down()] } else { rng.pair() };
        let Some(s) = phase.sample(wo, u) else { continue };
        let finite = s.weight.is_finite() && s.pdf > 0.0 && s.pdf.is_finite();
        judge.holds("samples are finite", finite, || format!("{}: wo {wo}: {s:?}", at()));
        let off = f64::from((s.wi.length() - 1.0).abs());
        judge.within("|wi| = 1", off, 1.5e-6, || format!("{}: {s:?}", at()));
        let eval = phase.eval(wo, s.wi);
        let loose = spread(phase, wo, s.wi);
        let allowed = 4e-5 * s.pdf + loose;
        let off = (eval.pdf - s.pdf).abs();
        judge.within("pdf of sample is that of eval", f64::from(off / allowed), 1.0, || {
            format!("{}: wo {wo}: {s:?} {eval:?}", at())
        });
        let off = (s.weight * s.pdf - eval.f).0.abs().max_element();
        let allowed = 4e-5 * eval.f.max_element() + loose * (1.0 + s.weight.max_element());
        judge.within("weight = eval / pdf", f64::from(off / allowed), 1.0, || {
            format!("{}: wo {wo}: {s:?} {eval:?}", at())
        });
    }
}

fn scatters(
    phase: &dyn Phase,
    wo: Vec3,
    rng: &mut Rng,
    n: u32,
    judge: &mut Judge,
    at: &dyn Fn() -> String,
) {
    let at = || format!("{}: wo {wo}", at());
    let sample = |[u, v, _]: [f32; 3]| {
        let s = phase.sample(wo, [u, v])?;
        Some(Drawn { wi: s.wi.as_dvec3(), weight: f64::from(s.weight.mean()) })
    };
    let eval = |wi: DVec3| {
        let eval = phase.eval(wo, wi.as_vec3());
        [f64::from(eval.pdf), f64::from(eval.f.mean())]
    };
    let found = Lobes { sample: &sample, eval: &eval }.judge(judge, rng, n, &at);
    let total = found.total;
    let off = (total.value[1] - 1.0).abs() - total.error[1];
    judge.within("phase function integrates to 1", off, 1e-3, || {
        format!("{}: {}", at(), total.value[1])
    });
}

fn mean_cosine(
    phase: &dyn Phase,
    g: f64,
    rng: &mut Rng,
    n: u32,
    judge: &mut Judge,
    at: &dyn Fn() -> String,
) {
    let wo = uniform_sphere(rng.pair());
    let mut cosine = Moments::default();
    for _ in 0..n {
        if let Some(s) = phase.sample(wo, rng.pair()) {
            // Light travels along −wi and leaves along wo.
            cosine.push(f64::from(-wo.dot(s.wi)) * f64::from(s.weight.mean()));
        }
    }
    let z = deviation(cosine.mean - g, 1e-6, mean_error(&cosine));
    judge.statistic("mean cosine is g", z, || format!("{}: {}", at(), cosine.mean));
}
