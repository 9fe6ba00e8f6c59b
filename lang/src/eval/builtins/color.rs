//! Colours and spectra.

use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use luxel_core::diag::{Diagnostic, Span, near};
use luxel_core::scene::Color;
use luxel_sdk::color as catalogue;
use luxel_sdk::color::RgbSpace;
use luxel_sdk::params::Dimension;

use super::{Call, Evaluator, Value, spectrum_file};
use crate::syntax::Form;

/// Which function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Make {
    /// `rgb(…)`: a mistake, for it names no space.
    Bare,
    LinearSrgb,
    Srgb,
    AcesCg,
    Rec2020,
    Xyz,
    Blackbody,
    Spectrum,
    File,
    Constant,
    Illuminant,
    Metal,
    Glass,
}

/// Steps of looking a file up that was read before, by its path.
const KNOWN: u64 = 10;

/// A component of a screen's colour beyond which it is none: brighter ones are made by a factor.
const SCREEN: f64 = 16.0;

/// A file of spectra and the column that is wanted of it.
pub(in crate::eval) type SpectrumFile = (PathBuf, Option<Arc<str>>);

impl Evaluator<'_> {
    /// Makes a colour or spectrum.
    pub(super) fn color(&mut self, make: Make, call: &mut Call<'_>) -> Value {
        let made = match make {
            Make::Bare => None,
            Make::LinearSrgb | Make::Srgb | Make::AcesCg | Make::Rec2020 | Make::Xyz => {
                self.tristimulus(make, call)
            }
            Make::Blackbody => self.blackbody(call),
            Make::Spectrum => self.spectrum(call),
            Make::File => self.spectrum_file(call),
            Make::Constant => self.number_arg(call, 0, Dimension::NONE).map(Color::Constant),
            Make::Illuminant => {
                let names = catalogue::illuminant_names();
                self.named(call, "illuminant", names, catalogue::is_illuminant)
                    .map(Color::Illuminant)
            }
            Make::Metal => self
                .named(call, "metal", catalogue::metal_names(), catalogue::is_metal)
                .map(Color::Metal),
            Make::Glass => {
                let names = catalogue::GLASSES.iter().flat_map(|glass| {
                    std::iter::once(glass.name).chain(glass.aliases.iter().copied())
                });
                let known = |name: &str| catalogue::glass(name).is_some();
                self.named(call, "glass", names, known).map(Color::Glass)
            }
        };
        made.map_or(Value::Poison, |color| Value::Color(color, Dimension::NONE))
    }

    /// `rgb(1, 0, 0)`: which red is meant differs between spaces.
    pub(super) fn bare_rgb(&mut self, span: Span) -> Value {
        let word = Span { end: span.start + 3, ..span };
        self.tell(
            Diagnostic::error("E0206", span, "`rgb` does not say in which space its numbers are")
                .help("rgb.linear_srgb for measured values, rgb.srgb for values from a screen, or rgb.acescg, rgb.rec2020")
                .guess(word, "rgb.linear_srgb")
                .guess(word, "rgb.srgb"),
        );
        Value::Poison
    }

    fn tristimulus(&mut self, make: Make, call: &Call<'_>) -> Option<Color> {
        let [r, g, b] = [0, 1, 2].map(|i| self.number_arg(call, i, Dimension::NONE));
        let c = [r?, g?, b?];
        if make == Make::Srgb && c.iter().any(|x| *x > SCREEN) {
            self.of_bytes(call);
            return None;
        }
        let rgb = linear_srgb(make, c);
        if rgb.iter().all(|x| x.is_finite()) {
            return Some(Color::Rgb(rgb));
        }
        self.poison("E0209", call.span, "the colour is not finite");
        None
    }

    /// `rgb.srgb(255, 128, 0)`
    fn of_bytes(&mut self, call: &Call<'_>) {
        let message = "the components of `rgb.srgb` are from 0 to 1, not to 255";
        let mut found = Diagnostic::error("E0210", call.span, message);
        let args: Vec<Span> = (0..3).filter_map(|i| call.arg(i)).map(|arg| arg.span).collect();
        if let [first, .., last] = args[..] {
            let text = self.sources.text(first.source);
            let parts = args.iter().map(|span| text.get(span.range()).unwrap_or_default());
            let is_number = |part: &str| part.bytes().all(|b| b.is_ascii_digit() || b == b'.');
            let parts: Vec<String> =
                parts.filter(|p| is_number(p)).map(|p| format!("{p} / 255")).collect();
            if parts.len() == args.len() {
                found = found.guess(first.to(last), parts.join(", "));
            }
        }
        self.tell(found.help("divide what a screen or a style sheet gives by 255"));
    }

    fn blackbody(&mut self, call: &Call<'_>) -> Option<Color> {
        let kelvin = self.number_arg(call, 0, Dimension::TEMPERATURE)?;
        if catalogue::is_blackbody(kelvin) {
            return Some(Color::Blackbody(kelvin));
        }
        let span = call.arg(0).map_or(call.span, |arg| arg.span);
        let message = format!("a black body of {kelvin} K gives no light; at least 1 K is wanted");
        self.poison("E0211", span, message);
        None
    }

    /// A name of a catalogue.
    fn named<'n>(
        &mut self,
        call: &Call<'_>,
        what: &str,
        names: impl Iterator<Item = &'n str>,
        known: impl Fn(&str) -> bool,
    ) -> Option<Arc<str>> {
        let (name, span) = self.text_arg(call, 0)?;
        if known(&name) {
            return Some(name);
        }
        let names: Vec<&str> = names.collect();
        let found = Diagnostic::error("E0407", span, format!("there is no {what} \"{name}\""))
            .meant_text(span, near(&name, names.iter().copied()));
        self.tell(found.help(format!("known are {}", names.join(", "))));
        None
    }

    /// `spectrum([(400 nm, 0.1), …])`.
    fn spectrum(&mut self, call: &Call<'_>) -> Option<Color> {
        let arg = call.arg(0)?;
        let shape = "a spectrum is a list of pairs: `[(400 nm, 0.1), (700 nm, 0.8)]`";
        let Value::Items(items) = &arg.value else {
            self.poison("E0214", arg.span, shape);
            return None;
        };
        if !self.tick(items.items.len() as u64, arg.span) {
            return None;
        }
        let mut points: Vec<(f64, f64)> = Vec::with_capacity(items.items.len());
        for item in &items.items {
            let (wavelength, value) = match item {
                Value::Items(pair) if pair.form == Form::Tuple && pair.items.len() == 2 => {
                    (pair.items[0].clone(), pair.items[1].clone())
                }
                Value::Numbers(n) if n.form == Form::Tuple && n.data.len() == 2 => {
                    (Value::Number(n.data[0], n.dimension), Value::Number(n.data[1], n.dimension))
                }
                _ => {
                    self.poison("E0214", arg.span, shape);
                    return None;
                }
            };
            let (Value::Number(metres, found), Value::Number(y, Dimension::NONE)) =
                (wavelength, value)
            else {
                self.poison("E0214", arg.span, shape);
                return None;
            };
            if found.is_none() && !call.env.file.units.contains_key(&Dimension::LENGTH) {
                let message = "`spectrum` wants wavelengths, a length each; these have no unit";
                let found = Diagnostic::error("E0201", arg.span, message);
                self.tell(found.help("give each its unit, as in `(400 nm, 0.1)`"));
                return None;
            }
            let scale = self.unit_scale(call, found, Dimension::LENGTH, arg.span)?;
            points.push((nanometres(metres * scale), y));
        }
        self.curve(points, arg.span)
    }

    /// A curve through points whose wavelengths increase.
    fn curve(&mut self, points: Vec<(f64, f64)>, span: Span) -> Option<Color> {
        use catalogue::{Curve, CurveError, Outside};
        match Curve::from_points(&points, Outside::Constant) {
            Ok(_) => {
                let is_within = self.hold(points.len() * size_of::<(f64, f64)>(), span);
                return is_within.then(|| Color::Curve(points.into()));
            }
            Err(CurveError::NotIncreasing(i)) => {
                let message = format!(
                    "wavelengths must increase: {} nm stands after {} nm",
                    points[i].0,
                    points[i - 1].0
                );
                self.poison("E0212", span, message);
            }
            Err(error) => {
                self.poison("E0209", span, error.to_string());
            }
        }
        None
    }

    /// `spectrum.file("x.spd")`: two columns, or a named one of several.
    fn spectrum_file(&mut self, call: &Call<'_>) -> Option<Color> {
        let name = self.text_arg(call, 0);
        let column = match call.arg(1) {
            Some(_) => Some(self.text_arg(call, 1)?),
            None => None,
        };
        let (name, span) = name?;
        let path = call.env.file.folder.join(&*name);
        let asked = (path, column.map(|(name, _)| name));
        if let Some(read) = self.spectra.get(&asked).cloned() {
            self.n_reads += 1;
            self.tick(KNOWN, span);
            return Some(read);
        }
        let read = self.spectrum_read(&name, &asked, span)?;
        self.spectra.insert(asked, read.clone());
        Some(read)
    }

    /// A spectrum of a file, the first time that it is asked for; `None` after a mistake.
    fn spectrum_read(&mut self, name: &str, asked: &SpectrumFile, span: Span) -> Option<Color> {
        let (path, column) = asked;
        let bytes = match self.bytes(path) {
            Ok(bytes) => bytes,
            Err(error) => {
                let message = format!("\"{name}\": {error}");
                let found = Diagnostic::error("E0413", span, message);
                self.tell(found.help(format!("looked for {}", path.display())));
                return None;
            }
        };
        if !self.tick(bytes.len() as u64 / 4, span) {
            return None;
        }
        match spectrum_file::read(&bytes, column.as_deref(), self.budgets.list) {
            Ok(points) => self.curve(points, span),
            Err(why) => {
                self.poison("E0413", span, format!("\"{name}\": {why}"));
                None
            }
        }
    }
}

/// Three numbers of a space as linear sRGB.
pub(super) fn linear_srgb(make: Make, c: [f64; 3]) -> [f64; 3] {
    let v = DVec3::from_array(c);
    let srgb = RgbSpace::LinearSrgb;
    match make {
        Make::Srgb => c.map(decode),
        Make::AcesCg => RgbSpace::AcesCg.convert_to(srgb).mul_vec3(v).to_array(),
        Make::Rec2020 => RgbSpace::Rec2020.convert_to(srgb).mul_vec3(v).to_array(),
        Make::Xyz => srgb.from_xyz().mul_vec3(v).to_array(),
        _ => c,
    }
}

/// The numbers of a space that make a colour of a screen, sRGB; `None` if they are not what is given.
pub(super) fn of_screen(make: Make, srgb: [f64; 3]) -> Option<[f64; 3]> {
    let linear = DVec3::from_array(srgb.map(decode));
    let from = RgbSpace::LinearSrgb;
    let out = match make {
        Make::LinearSrgb => linear,
        Make::Srgb => return Some(srgb),
        Make::AcesCg => from.convert_to(RgbSpace::AcesCg).mul_vec3(linear),
        Make::Rec2020 => from.convert_to(RgbSpace::Rec2020).mul_vec3(linear),
        Make::Xyz => from.to_xyz().mul_vec3(linear),
        _ => return None,
    };
    Some(out.to_array())
}

/// The linear value of an sRGB component; beyond [0, 1] the curve goes on, odd about zero.
fn decode(x: f64) -> f64 {
    let magnitude = x.abs();
    let linear = if magnitude <= 0.04045 {
        magnitude / 12.92
    } else {
        ((magnitude + 0.055) / 1.055).powf(2.4)
    };
    linear.copysign(x)
}

/// Metres as nanometres, to the attometre: `400 nm` is 400, whatever the rounding of its unit.
pub(super) fn nanometres(metres: f64) -> f64 {
    let nm = metres * 1e9;
    let rounded = (nm * 1e9).round() / 1e9;
    if rounded.is_finite() { rounded } else { nm }
}
