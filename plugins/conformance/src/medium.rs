//! Media: what flies through and what is scattered against transmittance.

use glam::DVec3;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{FreeFlight, Medium, Phase, SampleAt, Sampler, Samples};
use luxel_sdk::num::{Moments, Ray};
use luxel_sdk::params::Role;
use luxel_sdk::sampling::Rng;

use crate::reference::Numbers;
use crate::report::Judge;
use crate::statistics::{deviation, mean_error};
use crate::subject::Subject;
use crate::sweep::Set;

/// Distances in metres to which media are judged.
const DISTANCES: [f64; 4] = [0.01, 0.7, 3.0, 40.0];

/// Flights are cheap: with so many more of them, 5 % of a coefficient show.
const MORE: u32 = 4;

/// What f32 rounds in a fraction.
const ROUNDING: f64 = 4e-6;

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    for (set, _) in subject.all() {
        set.ask(|resolved| stays_finite(resolved.medium(), set, judge));
    }
    for (set, mut rng) in subject.usual() {
        set.ask(|resolved| {
            let medium = resolved.medium();
            passes(medium, set, &mut rng, judge);
            glows(medium, set, &mut rng, judge);
            for t_max in DISTANCES {
                flies(medium, set, t_max, MORE * subject.options.samples, judge);
            }
            let eval = medium.phase().eval(glam::Vec3::Z, glam::Vec3::X);
            judge.holds("has a phase function", eval.pdf.is_finite(), || set.label.clone());
        });
    }
    subject.concurrent(judge, |resolved| {
        let medium = resolved.medium();
        let (numbers, ray) = (Numbers { samples: 1, seed: 0 }, ray(DVec3::ZERO, 2.0));
        (0..200)
            .flat_map(|i| medium.sample(&ray, &mut samples(&numbers, i)).weight.to_array())
            .map(f32::to_bits)
            .collect()
    });
}

fn ray(o: DVec3, t_max: f64) -> Ray {
    Ray { o, d: DVec3::new(0.48, 0.6, 0.64), t_max }
}

fn samples(source: &dyn Sampler, index: u32) -> Samples<'_> {
    Samples::new(source, SampleAt { stream: 9, index, dimension: 0 })
}

/// Mean per lane, and its standard error, over estimates that may be random.
fn means(first: u32, estimate: impl Fn(&mut Samples<'_>) -> Spectrum) -> [Moments; 4] {
    let numbers = Numbers { samples: 1, seed: 0 };
    let mut lanes = [Moments::default(); 4];
    for i in 0..64 {
        let found = estimate(&mut samples(&numbers, first + i));
        for (lane, found) in lanes.iter_mut().zip(found.to_array()) {
            lane.push(f64::from(found));
        }
    }
    lanes
}

/// Mean transmittance per lane.
fn transmittance(medium: &dyn Medium, ray: &Ray, first: u32) -> [Moments; 4] {
    means(first, |samples| medium.transmittance(ray, samples))
}

/// Mean glow per lane.
fn glow(medium: &dyn Medium, ray: &Ray, first: u32) -> [Moments; 4] {
    means(first, |samples| medium.glow(ray, samples))
}

/// Legal at any distance and any coefficients: a lane that nothing is in times no end, thick fog.
fn stays_finite(medium: &dyn Medium, set: &Set, judge: &mut Judge) {
    let numbers = Numbers { samples: 1, seed: 3 };
    for t_max in [0.0, f64::MIN_POSITIVE, 1e-3, 1.0, 1e3, 1e12, f64::INFINITY] {
        let ray = ray(DVec3::ZERO, t_max);
        for i in 0..64 {
            let at = || format!("{}: to {t_max} m", set.label);
            let left = medium.transmittance(&ray, &mut samples(&numbers, i)).to_array();
            let legal = left.iter().all(|left| (0.0..=1.0 + ROUNDING).contains(&f64::from(*left)));
            judge.holds("finite and in [0, 1]", legal, || format!("{}: {left:?}", at()));
            let glow = medium.glow(&ray, &mut samples(&numbers, i));
            let legal = glow.is_finite() && glow.0.min_element() >= 0.0;
            judge.holds("glows are finite", legal, || format!("{}: {glow:?}", at()));
            let flight = medium.sample(&ray, &mut samples(&numbers, i));
            let weight = flight.weight.is_finite() && flight.weight.0.min_element() >= 0.0;
            let inside = flight.t.get().is_none_or(|t| t >= 0.0 && t <= t_max && t.is_finite());
            let shown = || format!("{}: {flight:?}", at());
            judge.holds("flights are finite", weight && inside, shown);
        }
    }
}

/// Transmittance: 1 at no distance, falling, a product over pieces, and as the coefficients say.
fn passes(medium: &dyn Medium, set: &Set, rng: &mut Rng, judge: &mut Judge) {
    let at = |t: f64| format!("{}: to {t} m", set.label);
    let none = transmittance(medium, &ray(DVec3::ZERO, 0.0), 0);
    let off = none.iter().map(|lane| (lane.mean - 1.0).abs()).fold(0.0, f64::max);
    judge.within("nothing is lost at once", off, ROUNDING, || at(0.0));
    let numbers = Numbers { samples: 1, seed: 0 };
    let far = medium.transmittance(&ray(DVec3::ZERO, f64::INFINITY), &mut samples(&numbers, 0));
    judge.holds("finite and in [0, 1]", far.is_finite(), || at(f64::INFINITY));
    for _ in 0..8 {
        let (a, b) = (rng.f64() * 3.0, rng.f64() * 3.0);
        let whole_ray = ray(DVec3::ZERO, a + b);
        let whole = transmittance(medium, &whole_ray, 0);
        let first = transmittance(medium, &ray(DVec3::ZERO, a), 64);
        let second = transmittance(medium, &ray(whole_ray.at(a), b), 128);
        for lane in 0..4 {
            let (w, f, s) = (whole[lane], first[lane], second[lane]);
            let legal = (0.0..=1.0 + ROUNDING).contains(&w.mean);
            judge.holds("finite and in [0, 1]", legal, || at(a + b));
            let sigma = w.standard_error() + f.standard_error() + s.standard_error();
            let z = deviation(w.mean - f.mean * s.mean, ROUNDING, sigma);
            judge.statistic("transmittance multiplies", z, || at(a + b));
        }
        if let Some(sigma_t) = extinction(set) {
            let truth = (-sigma_t * (a + b)).exp();
            let z = deviation(whole[0].mean - truth, 1e-5, whole[0].standard_error());
            judge.statistic("transmittance is exp(−σt)", z, || at(a + b));
        }
    }
}

/// The light of a medium: none at no distance; of two pieces that of the first, and that of the second as
/// far as the first lets it through.
fn glows(medium: &dyn Medium, set: &Set, rng: &mut Rng, judge: &mut Judge) {
    let at = |t: f64| format!("{}: to {t} m", set.label);
    let none = glow(medium, &ray(DVec3::ZERO, 0.0), 0);
    let most = none.iter().map(|lane| lane.mean.abs()).fold(0.0, f64::max);
    judge.within("nothing glows at once", most, 0.0, || at(0.0));
    for _ in 0..8 {
        let (a, b) = (rng.f64() * 3.0, rng.f64() * 3.0);
        let whole_ray = ray(DVec3::ZERO, a + b);
        let whole = glow(medium, &whole_ray, 0);
        let first = glow(medium, &ray(DVec3::ZERO, a), 64);
        let second = glow(medium, &ray(whole_ray.at(a), b), 128);
        let through = transmittance(medium, &ray(DVec3::ZERO, a), 192);
        for lane in 0..4 {
            let (w, f, s, t) = (whole[lane], first[lane], second[lane], through[lane]);
            let sigma = w.standard_error()
                + f.standard_error()
                + s.standard_error()
                + s.mean * t.standard_error();
            let off = w.mean - (f.mean + t.mean * s.mean);
            let z = deviation(off, ROUNDING * w.mean, sigma);
            judge.statistic("glows add up", z, || at(a + b));
        }
    }
}

/// The extinction where the class has the field's names for grey coefficients, m⁻¹.
fn extinction(set: &Set) -> Option<f64> {
    let params = set.object.class().params;
    let has = |name: &str| params.iter().any(|p| p.name == name && p.role == Role::Coefficient);
    let given = |name: &str| set.given.iter().any(|(given, _)| *given == name);
    let known = ["sigma_t", "sigma_a", "sigma_s"].into_iter().filter(|name| has(name));
    let mut sum = 0.0;
    for name in known {
        // What is not given is as by default, or absent.
        sum += if given(name) { set.number(name)? } else { set.number(name).unwrap_or(0.0) };
    }
    (has("sigma_t") || has("sigma_a")).then_some(sum)
}

/// The share of extinction that scatters, where it is stated and grey.
fn albedo(set: &Set) -> Option<f64> {
    let given = |name: &str| set.given.iter().any(|(given, _)| *given == name);
    if given("sigma_a") || given("sigma_s") {
        let part = |name: &str| if given(name) { set.number(name) } else { Some(0.0) };
        let (a, s) = (part("sigma_a")?, part("sigma_s")?);
        return (a + s > 0.0).then_some(s / (a + s));
    }
    let params = set.object.class().params;
    let stated = params.iter().any(|p| p.name == "albedo" && p.role == Role::Reflectance);
    stated.then(|| set.number("albedo")).flatten()
}

/// Free flight: what passes is the transmittance; what meets the medium in a piece of the ray is no
/// more than was lost there, and the stated share of it.
fn flies(medium: &dyn Medium, set: &Set, t_max: f64, n: u32, judge: &mut Judge) {
    const PIECES: usize = 4;
    let at = || format!("{}: to {t_max} m", set.label);
    let numbers = Numbers { samples: 1, seed: 5 };
    let ray_to = |t| ray(DVec3::ZERO, t);
    let mut passed = [Moments::default(); 4];
    let mut met = [[Moments::default(); 4]; PIECES];
    for i in 0..n {
        let FreeFlight { t, weight } = medium.sample(&ray_to(t_max), &mut samples(&numbers, i));
        let t = t.get();
        let weight = weight.to_array().map(f64::from);
        let legal = weight.iter().all(|w| w.is_finite() && *w >= 0.0);
        let inside = t.is_none_or(|t| t >= 0.0 && t <= t_max);
        judge.holds("flights are finite", legal && inside, || format!("{}: {t:?}", at()));
        // Several flights may end in one piece; each adds to its mean, the others add nothing.
        let piece = t.map(|t| (0..PIECES).find(|k| t <= piece_end(t_max, *k)).unwrap_or(0));
        for lane in 0..4 {
            passed[lane].push(if t.is_none() { weight[lane] } else { 0.0 });
            for (k, met) in met.iter_mut().enumerate() {
                met[lane].push(if piece == Some(k) { weight[lane] } else { 0.0 });
            }
        }
    }
    let through = transmittance(medium, &ray_to(t_max), 0);
    // One flight more or less.
    let least = 1.0 / f64::from(n);
    for lane in 0..4 {
        let sigma = mean_error(&passed[lane]) + through[lane].standard_error() + least;
        let off = passed[lane].mean - through[lane].mean;
        if is_normal(&passed[lane]) {
            let z = deviation(off, ROUNDING, sigma);
            judge.statistic("what passes is transmittance", z, at);
        }
        let mut before = 1.0;
        for (k, met) in met.iter().enumerate() {
            let end = transmittance(medium, &ray_to(piece_end(t_max, k)), 0)[lane];
            let lost = before - end.mean;
            before = end.mean;
            let sigma = mean_error(&met[lane]) + 2.0 * end.standard_error() + least;
            if !is_normal(&met[lane]) {
                continue;
            }
            let above = (met[lane].mean - lost).max(0.0);
            let z = deviation(above, ROUNDING, sigma);
            judge.statistic("scatters no more than is lost", z, at);
            if let Some(albedo) = albedo(set) {
                let z = deviation(met[lane].mean - albedo * lost, ROUNDING, sigma);
                judge.statistic("scatters its albedo of what is lost", z, at);
            }
        }
    }
}

fn piece_end(t_max: f64, k: usize) -> f64 {
    t_max * [0.1, 0.3, 0.6, 1.0][k]
}

/// Whether so many samples have a mean that is nearly normal: those that count are not too few.
fn is_normal(m: &Moments) -> bool {
    // A mean whose error is 1/14 of it or less stands on about 200 samples.
    m.mean <= 0.0 || m.standard_error() < m.mean / 14.0
}
