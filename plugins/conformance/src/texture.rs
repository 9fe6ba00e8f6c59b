//! Textures: finite everywhere, the same each time, and no brighter than what they are made of.

use std::sync::Arc;

use glam::{DVec3, Vec2};
use luxel_core::object::{ColorMode, Object, Scratch, Site};
use luxel_core::scene::{Color, Value};
use luxel_sdk::color::{Palette, Spectrum, Wavelengths};
use luxel_sdk::kind::{Output, Texture, TexturePoint};
use luxel_sdk::params::{Dimension, Type};
use luxel_sdk::sampling::Rng;

use crate::report::Judge;
use crate::subject::Subject;
use crate::sweep::{Given, Set, own};

/// Coordinates far out and on edges, and next to whole numbers on either side: what is left of the
/// floor of the smallest below 0 rounds to 1.
const EXTREME: [f32; 20] = [
    0.0,
    -0.0,
    f32::MIN_POSITIVE,
    -f32::MIN_POSITIVE,
    -3e-8,
    1.0,
    1.0 + f32::EPSILON,
    -1.0,
    -1.0 + 0.5 * f32::EPSILON,
    -1.0 - f32::EPSILON,
    0.5,
    -0.5,
    1e-30,
    -1e-7,
    0.999_999_94,
    1e3,
    -1e6,
    16_777_216.0,
    1e30,
    f32::MAX,
];

/// What f32 rounds in a blend of four values of at most 1.
const ROUNDING: f64 = 2e-6;

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    for (set, mut rng) in subject.all() {
        set.ask(|resolved| {
            let texture = resolved.texture();
            is_finite(texture, &mut rng, set, judge);
            forgets(texture, &mut rng, set, judge);
            let output = set.object.fixed().texture().output();
            judge.holds("says what its lanes mean once", output == texture.output(), || {
                set.label.clone()
            });
            if output == Output::Value {
                keeps_lanes(texture, &mut rng, set, judge);
            }
        });
    }
    let nominal = Colours::of(subject);
    if let Some(colours) = &nominal {
        for (white, limits) in [(0.0, [0.0, 0.0]), (1.0, [0.0, 1.0]), (0.25, [0.0, 1.0])] {
            honours_bounds(colours, &|_| white, limits, judge);
        }
        // Between two colours a blend shows what it adds to either.
        let below_one = [f64::NEG_INFINITY, 1.0];
        honours_bounds(colours, &|i| [0.0, 1.0][i % 2], below_one, judge);
        honours_bounds(colours, &|i| [1.0, 0.0][i % 2], below_one, judge);
        keeps_colours(colours, judge);
        looks_at_wavelengths(colours, judge);
    }
    subject.concurrent(judge, |resolved| {
        let (texture, mut rng) = (resolved.texture(), Rng::new(7));
        (0..200).flat_map(|_| bits(texture.eval(&point(&mut rng)))).collect()
    });
}

fn bits(value: Spectrum) -> [u32; 4] {
    value.to_array().map(f32::to_bits)
}

fn point(rng: &mut Rng) -> TexturePoint {
    let uv = Vec2::from_array(rng.pair()) * 6.0 - 3.0;
    let p = DVec3::new(rng.f64(), rng.f64(), rng.f64()) * 6.0 - 3.0;
    TexturePoint { p, uv, lambda: Wavelengths::sample(rng.f32()) }
}

fn is_finite(texture: &dyn Texture, rng: &mut Rng, set: &Set, judge: &mut Judge) {
    let mut ask = |at: &TexturePoint| {
        let value = texture.eval(at);
        judge.holds("finite", value.is_finite(), || format!("{}: {at:?}", set.label));
        let same = bits(texture.eval(at)) == bits(value);
        judge.holds("the same each time", same, || format!("{}: {at:?}", set.label));
    };
    for u in EXTREME {
        for v in EXTREME {
            let p = DVec3::new(f64::from(u), f64::from(v), 0.0);
            ask(&TexturePoint { p, uv: Vec2::new(u, v), lambda: Wavelengths::sample(0.5) });
        }
    }
    for _ in 0..500 {
        ask(&point(rng));
    }
}

/// A value at each wavelength depends on that wavelength alone: exchanging two exchanges the lanes.
/// Fixed colours of the path's lanes do not follow, so that only grey sets are asked.
fn keeps_lanes(texture: &dyn Texture, rng: &mut Rng, set: &Set, judge: &mut Judge) {
    let coloured = |value: &Value| matches!(value, Value::Color(Color::Rgb(_), _));
    if set.given.iter().any(|(_, value)| coloured(value)) || set.mode != ColorMode::Rgb {
        return;
    }
    for _ in 0..100 {
        let mut at = point(rng);
        at.lambda.lambda = Spectrum::splat(at.lambda.lambda.lane(1));
        let value = texture.eval(&at);
        let off = (value - Spectrum::splat(value.lane(0))).0.abs().max_element();
        judge.within("equal wavelengths, equal lanes", f64::from(off), ROUNDING, || {
            format!("{}: {at:?}", set.label)
        });
    }
    for _ in 0..100 {
        let at = point(rng);
        let mut other = at;
        let [a, b, c, d] = at.lambda.lambda.to_array();
        other.lambda.lambda = Spectrum::from_array([b, a, d, c]);
        let [a, b, c, d] = texture.eval(&at).to_array();
        let swapped = texture.eval(&other);
        let off = (swapped - Spectrum::from_array([b, a, d, c])).0.abs().max_element();
        judge.within("lanes keep to themselves", f64::from(off), ROUNDING, || {
            format!("{}: {at:?}", set.label)
        });
    }
}

/// The same at each point whatever was asked before: points that share a coordinate with the one
/// before, in three orders.
fn forgets(texture: &dyn Texture, rng: &mut Rng, set: &Set, judge: &mut Judge) {
    const SIDE: usize = 12;
    let u: [f32; SIDE] = std::array::from_fn(|_| 2.0 * rng.f32() - 1.0);
    let v: [f32; SIDE] = std::array::from_fn(|_| 2.0 * rng.f32() - 1.0);
    let ask = |i: usize, j: usize| {
        let uv = Vec2::new(u[i], v[j]);
        let p = DVec3::new(f64::from(u[i]), f64::from(v[j]), 0.5);
        bits(texture.eval(&TexturePoint { p, uv, lambda: Wavelengths::sample(0.5) }))
    };
    let cells = || (0..SIDE * SIDE).map(|k| (k / SIDE, k % SIDE));
    let first: Vec<_> = cells().map(|(i, j)| ask(i, j)).collect();
    let same = |(i, j): (usize, usize)| ask(i, j) == first[i * SIDE + j];
    let across = cells().all(|(i, j)| same((j, i)));
    let back = cells().rev().all(same);
    judge.holds("the same in any order", across && back, || set.label.clone());
}

/// What a texture is made of: the parameters of its nominal set but for its colours.
struct Colours<'a> {
    subject: &'a Subject<'a>,
    rest: Given,
    names: Vec<&'static str>,
}

impl<'a> Colours<'a> {
    fn of(subject: &'a Subject<'a>) -> Option<Self> {
        let params = own(&subject.class).filter(|param| param.ty == Type::Spectrum);
        let names: Vec<_> = params.map(|param| param.name).collect();
        let mut rest = subject.sets.first()?.given.clone();
        rest.retain(|(name, _)| !names.contains(name));
        Some(Self { subject, rest, names })
    }

    /// The texture with the given colours, by their order.
    fn build(&self, colour: &dyn Fn(usize) -> Color, mode: ColorMode) -> Option<Arc<Object>> {
        let colours = self.names.iter().enumerate();
        let mut given = self.rest.clone();
        given.extend(colours.map(|(i, name)| (*name, Value::Color(colour(i), Dimension::NONE))));
        self.subject.bench.build(&self.subject.class, &given, mode).ok()
    }
}

/// Points that are spread evenly over four periods, and those next to whole numbers.
fn grid(rng: &mut Rng) -> impl Iterator<Item = TexturePoint> {
    const SIDE: usize = 64;
    let near = EXTREME.into_iter().filter(|x| x.abs() < 2.0);
    let mut edges: Vec<_> = near.clone().flat_map(|u| near.clone().map(move |v| [u, v])).collect();
    edges.extend((0..SIDE * SIDE).map(|k| {
        let [u, v] = rng.pair();
        [((k / SIDE) as f32 + u), ((k % SIDE) as f32 + v)].map(|x| x * (2.0 / SIDE as f32) - 1.0)
    }));
    edges.into_iter().map(|[u, v]| {
        let p = DVec3::new(f64::from(u), f64::from(v), f64::from(u + v));
        TexturePoint { p, uv: Vec2::new(u, v), lambda: Wavelengths::sample(0.5) }
    })
}

/// With each colour at a value and all else as by default, nothing leaves the range of what it is
/// made of.
fn honours_bounds(
    colours: &Colours<'_>,
    white: &dyn Fn(usize) -> f64,
    limits: [f64; 2],
    judge: &mut Judge,
) {
    // Without colours of its own, what it shows comes from a file between 0 and 1.
    let limits = if colours.names.is_empty() { [0.0, 1.0] } else { limits };
    let grey = |i| Color::Constant(white(i));
    let Some(object) = colours.build(&grey, ColorMode::Rgb) else { return };
    let texture = object.fixed().texture();
    let mut rng = Rng::new(colours.subject.options.seed);
    for at in grid(&mut rng) {
        let value = texture.eval(&at);
        let lanes = if texture.output() == Output::Value { 4 } else { 3 };
        for lane in value.to_array().into_iter().take(lanes).map(f64::from) {
            let off = (limits[0] - lane).max(lane - limits[1]);
            judge.within("within what it is made of", off.max(0.0), ROUNDING, || {
                format!("colours of {}, {}: {lane} at {at:?}", white(0), white(1))
            });
        }
    }
}

/// What colours the two checks of colours give.
fn vivid(i: usize) -> [f64; 3] {
    [[0.8, 0.3, 0.1], [0.2, 0.6, 0.9]][i % 2]
}

/// Values stay in the lane of the colours they are made of: as if each lane were grey.
fn keeps_colours(colours: &Colours<'_>, judge: &mut Judge) {
    let vivid_ones = |i| Color::Rgb(vivid(i));
    let Some(object) = colours.build(&vivid_ones, ColorMode::Rgb) else { return };
    let texture = object.fixed().texture();
    if texture.output() != Output::Value || colours.names.is_empty() {
        return;
    }
    for lane in 0..3 {
        let grey = |i| Color::Constant(vivid(i)[lane]);
        let Some(object) = colours.build(&grey, ColorMode::Rgb) else { return };
        let grey = object.fixed().texture();
        for at in grid(&mut Rng::new(colours.subject.options.seed)).take(1000) {
            let (found, alone) = (texture.eval(&at).lane(lane), grey.eval(&at).lane(lane));
            let off = f64::from((found - alone).abs());
            judge.within("lanes keep to themselves", off, ROUNDING, || {
                format!("lane {lane}: {found} instead of {alone} at {at:?}")
            });
        }
    }
}

/// Linear sRGB is the same on every path: it depends on no wavelength.
fn looks_at_wavelengths(colours: &Colours<'_>, judge: &mut Judge) {
    let vivid_ones = |i| Color::Rgb(vivid(i));
    let Some(object) = colours.build(&vivid_ones, ColorMode::Spectral) else { return };
    let mut rng = Rng::new(colours.subject.options.seed);
    for at in grid(&mut rng).take(500) {
        let [one, two] = [0.2, 0.7].map(|u| {
            let lambda = Wavelengths::sample(u);
            let (palette, scratch) = (Palette::new(lambda), Scratch::default());
            let site = Site { p: at.p, uv: at.uv, palette: &palette, color: None };
            let texture = object.resolve(&site, &scratch).texture();
            let rgb = texture.output() != Output::Value;
            rgb.then(|| bits(texture.eval(&TexturePoint { lambda, ..at })))
        });
        judge.holds("RGB depends on no wavelength", one == two, || format!("{at:?}"));
    }
}
