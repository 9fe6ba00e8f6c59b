//! Lights: what is sampled is what rays find, and as bright as the scene said.

use std::f64::consts::{PI, TAU};

use glam::{DVec3, Vec2};
use luxel_core::scene::Value;
use luxel_sdk::abi::Class;
use luxel_sdk::color::{RgbSpace, Spectrum};
use luxel_sdk::kind::{Kind, Light, LightForm, LightQuery, LightSample};
use luxel_sdk::num::Moments;
use luxel_sdk::params::{Quantity, Type, Unit};
use luxel_sdk::sampling::{Rng, uniform_sphere};

use crate::lobes::{Drawn, Lobes};
use crate::report::Judge;
use crate::statistics::{deviation, mean_error};
use crate::subject::Subject;
use crate::sweep::Set;

/// By which factor `power` may be off: it guides the choice between lights, no more, but a light
/// that is looked for half as often as it should be is noise.
const POWER: f64 = 1.75;

/// What f32 rounds in a product of a dozen factors.
const ROUNDING: f64 = 4e-6;

/// Radius of the scene, metres, and area of the shape, m².
const SCENE: f64 = 3.0;
const AREA: f64 = 0.7;

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    for (set, mut rng) in subject.usual() {
        set.ask(|resolved| {
            let light = resolved.light();
            let power = f64::from(light.power(AREA, SCENE));
            judge.holds("power is finite", power >= 0.0 && power.is_finite(), || set.label.clone());
            let view = View { light, set, n: subject.options.samples };
            match light.form() {
                LightForm::Surface => {
                    judge.holds("a surface has a `shape`", takes_shape(&subject.class), || {
                        "its class lacks the parameter".to_owned()
                    });
                    view.surface(&mut rng, judge);
                }
                LightForm::Point => view.point(&mut rng, judge),
                LightForm::Infinite | LightForm::Everywhere => view.infinite(&mut rng, judge),
            }
        });
    }
    subject.concurrent(judge, |resolved| {
        let (light, mut rng) = (resolved.light(), Rng::new(7));
        let mut bits = vec![light.power(AREA, SCENE).to_bits()];
        for _ in 0..200 {
            let query = LightQuery { p: DVec3::new(0.5, -4.0, 1.0), u: rng.pair() };
            bits.extend(light.sample(&query).map_or([0; 4], |s| s.le.to_array().map(f32::to_bits)));
            let d = uniform_sphere(rng.pair()).as_dvec3().normalize();
            bits.push(light.escaped(d).pdf.to_bits());
        }
        bits
    });
}

/// Whether a scene can say which shape shines.
fn takes_shape(class: &Class) -> bool {
    let shape = Type::Object(Kind::Shape);
    class.params.iter().any(|param| param.name == "shape" && param.ty == shape)
}

/// A light and how it was made.
struct View<'a> {
    light: &'a dyn Light,
    set: &'a Set,
    n: u32,
}

/// Luminance of linear sRGB: that of a grey spectrum is its value.
fn luminance(le: Spectrum) -> f64 {
    RgbSpace::LinearSrgb.luminance_weights().dot(le.rgb().as_dvec3())
}

/// A cosine and a place on a surface.
fn corner(rng: &mut Rng) -> (f32, Vec2) {
    (2.0 * rng.f32() - 1.0, Vec2::from_array(rng.pair()))
}

impl View<'_> {
    fn at(&self) -> String {
        self.set.label.clone()
    }

    /// The amount that was given in radiometric units.
    fn amount(&self) -> Option<(Quantity, f64)> {
        let (quantity, value, dimension) =
            Quantity::ALL.iter().find_map(|(quantity, name, _)| {
                let (_, value) = self.set.given.iter().find(|(given, _)| given == name)?;
                match value {
                    Value::Number(x, dimension) => Some((*quantity, *x, *dimension)),
                    _ => None,
                }
            })?;
        let unit = Quantity::ALL.iter().find(|(known, ..)| *known == quantity)?.2;
        let radiometric =
            Unit::parse(unit.split('|').next()?).is_ok_and(|u| u.dimension == dimension);
        (radiometric && quantity != Quantity::Scale).then_some((quantity, value))
    }

    /// Whether its light is the same everywhere and at all wavelengths: then amounts are exact. D65
    /// white, and textures, are not.
    fn is_grey(&self) -> bool {
        self.set.given.iter().any(|(name, value)| {
            let grey = matches!(value, Value::Color(luxel_core::scene::Color::Constant(_), _));
            *name == "spectrum" && grey
        })
    }

    fn amount_is(&self, quantity: Quantity, found: &Moments, judge: &mut Judge) {
        let Some((given, value)) = self.amount() else { return };
        if given == quantity && self.is_grey() {
            let sigma = mean_error(found).max(value / f64::from(self.n));
            let z = deviation(found.mean - value, 2e-5 * value, sigma);
            judge.statistic("gives the amount that was asked", z, || {
                format!("{}: {quantity:?} {value} is {}", self.at(), found.mean)
            });
        }
    }

    /// The radiance that was asked is found; of a light that is not equally bright everywhere, it
    /// is somewhere between its darkest and its brightest place.
    fn radiance_is(&self, found: impl Iterator<Item = f64>, judge: &mut Judge) {
        let Some((Quantity::Radiance, value)) = self.amount().filter(|_| self.is_grey()) else {
            return;
        };
        let (mut low, mut high) = (f64::INFINITY, 0.0f64);
        for lit in found.filter(|le| *le > 0.0) {
            (low, high) = (low.min(lit), high.max(lit));
        }
        if high > 0.0 {
            let off = (low / value - 1.0).max(1.0 - high / value).max(0.0);
            judge.within("radiance is what was asked", off, ROUNDING, || {
                format!("{}: {value} is {low} to {high}", self.at())
            });
        }
    }

    fn power_is(&self, found: &Moments, judge: &mut Judge) {
        let claimed = f64::from(self.light.power(AREA, SCENE));
        let noise = 6.0 * mean_error(found) / found.mean.max(f64::MIN_POSITIVE);
        if noise > 0.25 || !(found.mean > 0.0) {
            return;
        }
        let off = (claimed / found.mean).max(found.mean / claimed) * (1.0 - noise);
        judge.within("power is about what it gives", off, POWER, || {
            format!("{}: {claimed} is {}", self.at(), found.mean)
        });
    }

    fn surface(&self, rng: &mut Rng, judge: &mut Judge) {
        let mut power = Moments::default();
        for i in 0..self.n {
            let (mut cos, uv) = corner(rng);
            if i < 8 {
                cos = [0.0, 1e-6, -1e-6, 1.0, -1.0, -0.0, 1e-30, -1e-30][i as usize];
            }
            let le = self.light.le(cos, uv, AREA);
            let legal = le.is_finite() && le.0.min_element() >= 0.0;
            judge.holds("finite and not negative", legal, || format!("{}: {cos} {uv}", self.at()));
            // Both sides: the cosine is uniform in [−1, 1].
            power.push(luminance(le) * f64::from(cos.abs()) * 2.0 * TAU * AREA);
        }
        for cos in [f32::NAN, 0.5] {
            let none = self.light.le(cos, Vec2::splat(0.5), 0.0).is_finite();
            judge.holds("finite without area or angle", none, || self.at());
        }
        self.amount_is(Quantity::Power, &power, judge);
        let found = (0..1000).map(|_| {
            let (cos, uv) = corner(rng);
            luminance(self.light.le(cos, uv, AREA))
        });
        self.radiance_is(found, judge);
        self.power_is(&power, judge);
    }

    fn is_legal(&self, s: &LightSample, judge: &mut Judge) {
        let at = || format!("{}: {s:?}", self.at());
        let legal = s.le.is_finite() && s.le.0.min_element() >= 0.0;
        judge.holds("finite and not negative", legal, at);
        let off = (s.wi.length() - 1.0).abs();
        // Directions may have been made in f32.
        judge.within("|wi| = 1", off, 1e-6, at);
        let density = s.pdf > 0.0 && s.pdf.is_finite() && s.distance > 0.0;
        judge.holds("density and distance exceed 0", density, at);
        let unit = !s.delta || (s.pdf - 1.0).abs() <= 0.0;
        judge.holds("a delta has pdf 1", unit, at);
    }

    /// A point: found in one place from everywhere, by the inverse square.
    fn point(&self, rng: &mut Rng, judge: &mut Judge) {
        let ask = |p: DVec3| self.light.sample(&LightQuery { p, u: [0.3, 0.7] });
        let Some(place) = (0..256).find_map(|_| {
            let p = uniform_sphere(rng.pair()).as_dvec3() * (10.0 * rng.f64());
            ask(p).filter(|s| s.distance.is_finite()).map(|s| p + s.wi * s.distance)
        }) else {
            if self.light.power(AREA, SCENE) > 0.0 {
                judge.skip("all checks of a point", "it lights no place that was tried");
            }
            return;
        };
        let (mut power, mut peak) = (Moments::default(), 0.0f64);
        for i in 0..self.n {
            let d = uniform_sphere(rng.pair()).as_dvec3().normalize();
            let sample = ask(place + d * 2.0);
            if let Some(s) = &sample
                && i < 1000
            {
                self.is_legal(s, judge);
                judge.holds("a point is a delta", s.delta, || self.at());
                self.falls(place, d, s, judge);
            }
            // Irradiance times the squared distance.
            let intensity = sample.map_or(0.0, |s| 4.0 * luminance(s.le));
            peak = peak.max(intensity);
            power.push(intensity * 2.0 * TAU);
        }
        let none = ask(place).is_none_or(|s| s.le.is_finite() && s.wi.is_finite());
        judge.holds("finite at its own place", none, || self.at());
        let largest = peak * 2.0 * TAU / (power.mean * f64::from(self.n));
        if largest < 0.005 {
            self.amount_is(Quantity::Power, &power, judge);
            self.power_is(&power, judge);
        }
        if let Some((Quantity::Intensity, value)) = self.amount().filter(|_| self.is_grey())
            && largest < 0.005
        {
            let off = (peak / value - 1.0).abs();
            // The brightest direction may have been missed by a little.
            judge.within("intensity is what was asked", off, 0.02, || self.at());
        }
    }

    /// The same point and intensity from other distances, near and far.
    fn falls(&self, place: DVec3, d: DVec3, near: &LightSample, judge: &mut Judge) {
        let p = place + d * 2.0;
        let off = (p + near.wi * near.distance - place).length();
        let rounds = 1e-6 * (place.length() + 2.0);
        judge.within("a point stays in its place", off / rounds, 1.0, || self.at());
        // At the edge of a cone, rounding decides.
        let dim = !(luminance(near.le) > 1e-3 * f64::from(self.light.power(AREA, SCENE)));
        for distance in [0.02, 0.2, 6.0, 20.0, 200.0] {
            let query = LightQuery { p: place + d * distance, u: [0.9, 0.1] };
            let Some(other) = self.light.sample(&query).filter(|_| !dim) else { continue };
            let ratio = luminance(other.le) * (0.25 * distance * distance) / luminance(near.le);
            // The place is known to within what it may be off, on the way there and back.
            let limit = 1e-4 + 4.0 * rounds / distance;
            judge.within("falls with the square", (ratio - 1.0).abs() / limit, 1.0, || {
                format!("{}: along {d}: {ratio} at {distance} m", self.at())
            });
        }
    }

    fn infinite(&self, rng: &mut Rng, judge: &mut Judge) {
        let ask = |u: [f32; 2]| self.light.sample(&LightQuery { p: DVec3::new(1.0, 2.0, -3.0), u });
        let (mut deltas, mut irradiance) = (0, Moments::default());
        let mut first = None;
        for i in 0..self.n {
            let Some(s) = ask(rng.pair()) else {
                irradiance.push(0.0);
                continue;
            };
            irradiance.push(luminance(s.le) / f64::from(s.pdf));
            deltas += u32::from(s.delta);
            let to = *first.get_or_insert(s.wi);
            if i < 1000 {
                self.is_legal(&s, judge);
                self.agrees(&s, to, judge);
            }
        }
        for _ in 0..500 {
            let found = self.light.escaped(uniform_sphere(rng.pair()).as_dvec3().normalize());
            let legal = found.le.is_finite() && found.le.0.min_element() >= 0.0;
            let density = found.pdf >= 0.0 && found.pdf.is_finite();
            judge.holds("finite and not negative", legal && density, || self.at());
        }
        self.facing(rng, judge);
        if deltas > 0 {
            self.amount_is(Quantity::Illuminance, &irradiance, judge);
        } else {
            let sample = |[u, v, _]: [f32; 3]| {
                let s = ask([u, v]).filter(|s| !s.le.is_black())?;
                Some(Drawn { wi: s.wi, weight: luminance(s.le) / f64::from(s.pdf) })
            };
            let eval = |wi: DVec3| {
                let found = self.light.escaped(wi);
                // What is black need not be found, whatever its density.
                let lit = if found.le.is_black() { 0.0 } else { 1.0 };
                [f64::from(found.pdf) * lit, luminance(found.le)]
            };
            Lobes { sample: &sample, eval: &eval }.judge(judge, rng, self.n, &|| self.at());
        }
        // Through a disk of the scene's radius.
        let mut power = irradiance;
        let disk = PI * SCENE * SCENE;
        (power.mean, power.m2) = (power.mean * disk, power.m2 * disk * disk);
        self.power_is(&power, judge);
    }

    /// Irradiance of a surface that faces the light, and radiance, against what the scene said.
    fn facing(&self, rng: &mut Rng, judge: &mut Judge) {
        let mut ask = || self.light.sample(&LightQuery { p: DVec3::ZERO, u: rng.pair() });
        let found: Vec<LightSample> = (0..self.n).filter_map(|_| ask()).collect();
        let flow = |s: &LightSample| luminance(s.le) / f64::from(s.pdf);
        let to: DVec3 = found.iter().map(|s| s.wi * flow(s)).sum();
        let to = to.normalize_or_zero();
        let mut irradiance = Moments::default();
        for s in &found {
            irradiance.push(flow(s) * s.wi.dot(to).max(0.0));
        }
        // The direction is that of the samples' mean: off by an angle whose cosine is second order.
        if irradiance.standard_error() < 0.01 * irradiance.mean {
            self.amount_is(Quantity::Illuminance, &irradiance, judge);
        }
        let found = found.iter().filter(|s| !s.delta).map(|s| luminance(s.le));
        self.radiance_is(found, judge);
    }

    /// A sample against what a ray along it finds.
    fn agrees(&self, s: &LightSample, to: DVec3, judge: &mut Judge) {
        let at = || format!("{}: {s:?}", self.at());
        judge.holds("far away", s.distance.is_infinite(), at);
        let found = self.light.escaped(s.wi);
        if s.delta {
            judge.holds("no ray finds a delta", found.le.is_black() && found.pdf <= 0.0, at);
            judge.holds("a delta has one direction", (s.wi - to).length() < 1e-6, at);
            return;
        }
        // At the edge of a disk in the sky a rounding decides: nearby rays find it.
        let (x, y) = s.wi.any_orthonormal_pair();
        let near = [x, -x, y, -y].map(|d| self.light.escaped((s.wi + d * 1e-7).normalize()));
        let best = |f: &dyn Fn(&luxel_sdk::kind::Escaped) -> f64| {
            near.iter().chain([&found]).map(f).fold(f64::INFINITY, f64::min)
        };
        let largest = f64::from(s.le.max_element());
        let le = best(&|e| f64::from((e.le - s.le).0.abs().max_element()) / largest.max(1e-30));
        judge.within("sampled radiance is what rays find", le, 1e-4, at);
        let pdf = best(&|e| f64::from((e.pdf / s.pdf - 1.0).abs()));
        judge.within("pdf of sample is that of rays", pdf, 1e-4, at);
    }
}
