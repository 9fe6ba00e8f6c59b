//! Values as an editor shows them.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use arrayvec::ArrayVec;
use glam::Vec3;
use luxel_core::diag::{SourceId, Span};
use luxel_core::scene::Color;
use luxel_sdk::color::{
    Curve, Outside, blackbody, emission_rgb, glass, illuminant, metal, reflectance_rgb, srgb_encode,
};
use luxel_sdk::params::Dimension;

use super::Evaluator;
use super::readable::{number, readable};
use super::value::Value;
use crate::syntax::{Form, Name};
use crate::values::{Elsewhere, Layer, Shown, Unsaid, Values};

/// Values that are kept of one load, at most.
pub(super) const KEPT: usize = 100_000;

/// The statement that is being evaluated, where its names are noted apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Noting {
    pub(super) id: SourceId,
    pub(super) span: Span,
}

/// The values that were noted so far.
#[derive(Debug)]
pub(super) struct Noted {
    of: Option<Noting>,
    /// Names in that statement.
    own: BTreeMap<u32, Arc<str>>,
    /// Names in the statements before.
    pub(super) layer: Layer,
    pub(super) others: Elsewhere,
    /// How many more are noted.
    room: usize,
}

impl Default for Noted {
    fn default() -> Self {
        let (own, layer, others) = Default::default();
        Self { of: None, own, layer, others, room: KEPT }
    }
}

impl Noted {
    /// All of them, by places in files.
    pub(super) fn values(self) -> Values {
        let mut others = self.others;
        for (id, notes) in self.layer {
            let notes = notes.iter().map(|(at, value)| ((SourceId(0), *at), (id, value.clone())));
            others.extend(notes);
        }
        Values { others: Arc::new(others), ..Values::default() }
    }

    fn note(&mut self, span: Span, value: impl FnOnce() -> String) {
        let is_own = |of: &Noting| {
            of.span.source == span.source && of.span.range().contains(&span.range().start)
        };
        if self.room == 0 {
            return;
        }
        if self.of.as_ref().is_some_and(is_own) {
            if let Entry::Vacant(place) = self.own.entry(span.start) {
                place.insert(value().into());
                self.room -= 1;
            }
        } else if let Entry::Vacant(place) = self.others.entry((span.source, span.start)) {
            place.insert((self.of.map_or(span.source, |of| of.id), value().into()));
            self.room -= 1;
        }
    }
}

impl Evaluator<'_> {
    /// At most so many more values are noted.
    pub(super) fn note_at_most(&mut self, room: usize) {
        self.noted.iter_mut().for_each(|noted| noted.room = room);
    }

    /// A statement is about to be evaluated whose names are noted apart.
    pub(super) fn begin_noting(&mut self, of: Noting) {
        self.noted.iter_mut().for_each(|noted| noted.of = Some(of));
    }

    /// It has been evaluated; how many more values are noted.
    pub(super) fn end_noting(&mut self) -> usize {
        let Some(noted) = &mut self.noted else { return 0 };
        if let Some(Noting { id, .. }) = noted.of.take() {
            noted.layer.insert(id, std::mem::take(&mut noted.own).into_iter().collect());
        }
        noted.room
    }

    /// Keeps the first value of a name, if values are wanted.
    pub(super) fn note(&mut self, name: &Name, value: &Value) {
        let Some(noted) = &mut self.noted else { return };
        if is_shown(value) {
            noted.note(name.span, || as_shown(value));
        }
    }

    /// How a value is shown that a name may have, if values are wanted.
    pub(super) fn shown(&self, value: &Value) -> Option<String> {
        (self.noted.is_some() && is_shown(value)).then(|| as_shown(value))
    }

    /// The same, of a number once it is looked at.
    pub(super) fn shown_later(&self, value: &Value) -> Option<Shown> {
        match value {
            Value::Number(x, measure) if self.noted.is_some() => Some(number_later(*x, *measure)),
            _ => self.shown(value).map(|text| Shown::Text(text.into())),
        }
    }
}

/// How a number is shown, in SI units, once it is looked at.
pub(super) fn number_later(x: f64, measure: Dimension) -> Shown {
    let say = |numbers: &[f64], measure| as_shown(&Value::Number(numbers[0], measure));
    Shown::Later(Unsaid { numbers: ArrayVec::from_iter([x]), measure, say })
}

/// Of an object or a function, the text says more.
fn is_shown(value: &Value) -> bool {
    use Value::{Builtin, Function, Module, Object, Poison};
    !matches!(value, Poison | Object(_) | Module(_) | Function(_) | Builtin(_))
}

/// How an editor shows a vector of numbers of a dimension, in SI units.
pub(super) fn shown_vector(numbers: &[f64], dimension: Dimension) -> String {
    as_shown(&Value::numbers(numbers.to_vec(), dimension, Form::Tuple))
}

fn as_shown(value: &Value) -> String {
    match value {
        Value::Color(color, dimension) if dimension.is_none() => shown(color),
        other => readable(other),
    }
}

/// A colour in words: what a screen shows of it, and its spectrum from 380 to 730 nm.
pub(crate) fn shown(color: &Color) -> String {
    match color {
        Color::Rgb(rgb) => hex(*rgb),
        Color::Constant(x) => format!("{} at every wavelength", number(*x)),
        Color::Waves(length) => format!("{} m, in waves of each wavelength", number(*length)),
        Color::Glass(name) => glass(name).map_or_else(String::new, |glass| {
            format!("n_d = {:.4}, Abbe number {:.1}", glass.eta_d(), glass.abbe())
        }),
        Color::Scaled(color, factor) => format!("{} × {}", number(*factor), shown(color)),
        curve => match of_curve(curve) {
            Some((curve, rgb)) => spectrum(&curve, rgb),
            None => "a spectrum".to_owned(),
        },
    }
}

/// What a screen shows of a colour, of light at full brightness: sRGB, each in [0, 1]. `None` of what has
/// no colour.
pub(crate) fn on_screen(color: &Color) -> Option<[f64; 3]> {
    let linear = match color {
        Color::Rgb(rgb) => *rgb,
        Color::Constant(x) => [*x; 3],
        Color::Waves(_) | Color::Glass(_) | Color::Scaled(..) => return None,
        curve => of_curve(curve)?.1.to_array().map(f64::from),
    };
    Some(linear.map(|x| srgb_encode(x).clamp(0.0, 1.0)))
}

/// A spectrum and what it is in linear sRGB; of a metal the fraction of light that a polished surface
/// reflects straight back.
fn of_curve(color: &Color) -> Option<(Curve, Vec3)> {
    let curve = match color {
        Color::Curve(points) => Curve::from_points(points, Outside::Constant).ok()?,
        Color::Metal(name) => {
            let metal = metal(name)?;
            metal.eta.map(|nm, eta| {
                let k = f64::from(metal.k.at(narrow(nm)));
                ((eta - 1.0).powi(2) + k * k) / ((eta + 1.0).powi(2) + k * k)
            })
        }
        Color::Blackbody(kelvin) => return blackbody(*kelvin).map(of_light),
        Color::Illuminant(name) => return illuminant(name).map(of_light),
        _ => return None,
    };
    let rgb = reflectance_rgb(&curve);
    Some((curve, rgb))
}

/// Light as bright as a screen can show it.
fn of_light(curve: Curve) -> (Curve, Vec3) {
    let rgb = emission_rgb(&curve);
    (curve, rgb / rgb.max_element().max(f32::MIN_POSITIVE))
}

fn spectrum(curve: &Curve, rgb: Vec3) -> String {
    const BARS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
    let values: Vec<f32> = (0_u8..=14).map(|i| curve.at(380.0 + 25.0 * f32::from(i))).collect();
    let most = values.iter().copied().fold(f32::MIN_POSITIVE, f32::max);
    let bar = |x: &f32| {
        let level = (x / most * 7.0).round().clamp(0.0, 7.0);
        BARS.iter().zip(0_u8..).find(|(_, i)| f32::from(*i) >= level).map_or('█', |(bar, _)| *bar)
    };
    let bars: String = values.iter().map(bar).collect();
    format!("{bars} {}", hex(rgb.to_array().map(f64::from)))
}

/// `#rrggbb` of a screen.
fn hex(linear: [f64; 3]) -> String {
    let [r, g, b] = linear.map(|x| (srgb_encode(x).clamp(0.0, 1.0) * 255.0).round());
    format!("#{r:02x}{g:02x}{b:02x}", r = byte(r), g = byte(g), b = byte(b))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "it lies in [0, 255]; a NaN is shown as 0"
)]
fn byte(x: f64) -> u8 {
    x as u8
}

#[expect(clippy::cast_possible_truncation, reason = "wavelengths in nanometres fit")]
fn narrow(nm: f64) -> f32 {
    nm as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_shown_as_on_a_screen_with_their_spectrum() {
        assert_eq!(shown(&Color::Rgb([1.0, 0.0, 0.0])), "#ff0000");
        let gold = shown(&Color::Metal("Au".into()));
        let bars: Vec<char> = gold.chars().take(15).collect();
        assert!(bars[0] < bars[14] && bars[14] == '█', "{gold}");
        let white = shown(&Color::Illuminant("D65".into()));
        let [r, g, b]: [u8; 3] = std::array::from_fn(|i| {
            let at = white.find('#').unwrap() + 1 + 2 * i;
            u8::from_str_radix(&white[at..at + 2], 16).unwrap()
        });
        assert!(r > 240 && g > 240 && b > 240, "{white}");
        assert_eq!(shown(&Color::Glass("N-BK7".into())), "n_d = 1.5168, Abbe number 64.2");
    }
}
