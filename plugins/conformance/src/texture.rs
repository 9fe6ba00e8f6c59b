//! Textures: finite everywhere, the same each time, and no brighter than what they are made of.

use glam::{DVec3, Vec2};
use luxel_core::object::ColorMode;
use luxel_core::scene::{Color, Value};
use luxel_sdk::color::{Spectrum, Wavelengths};
use luxel_sdk::kind::{Output, Texture, TexturePoint};
use luxel_sdk::params::{Dimension, Type};
use luxel_sdk::sampling::Rng;

use crate::report::Judge;
use crate::subject::Subject;
use crate::sweep::{Set, own};

/// Coordinates far out and on edges.
const EXTREME: [f32; 14] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
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
            let output = set.object.fixed().texture().output();
            judge.holds("says what its lanes mean once", output == texture.output(), || {
                set.label.clone()
            });
            if output == Output::Value {
                keeps_lanes(texture, &mut rng, set, judge);
            }
        });
    }
    for (white, limits) in [(0.0, [0.0, 0.0]), (1.0, [0.0, 1.0]), (0.25, [0.0, 1.0])] {
        honours_bounds(subject, white, limits, judge);
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

/// With every colour at one value and all else as by default, nothing leaves the range of what it
/// is made of.
fn honours_bounds(subject: &Subject<'_>, white: f64, limits: [f64; 2], judge: &mut Judge) {
    let Some(nominal) = subject.sets.first() else { return };
    let mut given = nominal.given.clone();
    let mut colours = 0;
    for param in own(&subject.class).filter(|param| param.ty == Type::Spectrum) {
        given.retain(|(name, _)| *name != param.name);
        let value = Value::Color(Color::Constant(white), Dimension::NONE);
        given.push((param.name, value));
        colours += 1;
    }
    // Without colours of its own, what it shows comes from a file between 0 and 1.
    let limits = if colours == 0 { [0.0, 1.0] } else { limits };
    let Ok(object) = subject.bench.build(&subject.class, &given, ColorMode::Rgb) else { return };
    let texture = object.fixed().texture();
    let mut rng = Rng::new(subject.options.seed);
    for _ in 0..2000 {
        let at = point(&mut rng);
        let value = texture.eval(&at);
        let lanes = if texture.output() == Output::Rgb { 3 } else { 4 };
        for lane in value.to_array().into_iter().take(lanes).map(f64::from) {
            let off = (limits[0] - lane).max(lane - limits[1]);
            judge.within("within what it is made of", off.max(0.0), ROUNDING, || {
                format!("colours of {white}: {lane} at {at:?}")
            });
        }
    }
}
