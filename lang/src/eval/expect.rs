//! `expect mean = 0.5 ± 0.01`: what a file says of its picture. Nothing here measures it.

use luxel_core::diag::{Diagnostic, Span, near};
use luxel_core::film::Rect;
use luxel_core::scene::{Area, Claim, Color, Expectation, Expected};
use luxel_core::stage::Film;

use super::env::Env;
use super::exec::Place;
use super::value::Value;
use super::{Evaluator, OUTSIDE};
use crate::syntax::{Arg, Expect, Expr, Field, Name};

/// What can be expected, and how it is written.
const FORMS: [(&str, &str); 4] = [
    ("mean", "expect mean = 0.5 ± 0.01"),
    ("pixel", "expect pixel (x, y) = 0.5 ± 0.01"),
    ("region", "expect region (x, y, width, height) = 0.5 ± 0.01"),
    ("same_as", "expect same_as \"other.scene\""),
];

/// Pixels are counted up to here; as the film's schema says.
const MAX_SIDE: f64 = 65536.0;

impl Evaluator<'_> {
    /// Keeps what the file that was asked for says; what an included file says is of its own picture.
    pub(super) fn expectation(&mut self, said: &Expect, place: Place, env: &Env) {
        if !env.file.is_root {
            return;
        }
        let (claim, given) = (self.claim(said, env), self.given_where(&said.given, env));
        if place != Place::File {
            let message = "an expectation is of the whole picture and stands in no object";
            self.tell(Diagnostic::error("E0602", said.what.span, message));
            return;
        }
        let (Some(claim), Some(given)) = (claim, given) else { return };
        self.scene.expectations.push(Expectation { claim, given, span: said.what.span });
    }

    fn claim(&mut self, said: &Expect, env: &Env) -> Option<Claim> {
        let name = &said.what;
        let Some((word, form)) = FORMS.iter().find(|(word, _)| *word == &*name.text) else {
            self.unknown_claim(name);
            return None;
        };
        match (*word, &said.path, &said.at) {
            ("same_as", Some(path), _) => self.same_as(path, env),
            ("mean", None, None) => self.mean(Area::Whole, &said.values, env),
            ("pixel", None, Some((span, args))) if args.len() == 2 => {
                let [x, y] = self.pixels(args, env)?;
                let area = self.area([x, y, 1.0, 1.0], *span)?;
                self.mean(area, &said.values, env)
            }
            ("region", None, Some((span, args))) if args.len() == 4 => {
                let area = self.pixels(args, env)?;
                let area = self.area(area, *span)?;
                self.mean(area, &said.values, env)
            }
            _ => {
                let message = format!("this is not how `expect {word}` is written");
                let found = Diagnostic::error("E0602", name.span, message);
                self.tell(found.help(format!("write `{form}`")));
                None
            }
        }
    }

    fn unknown_claim(&mut self, name: &Name) {
        let message = format!("nothing called `{}` can be expected", name.text);
        let found = Diagnostic::error("E0602", name.span, message)
            .meant(name.span, near(&name.text, FORMS.iter().map(|(word, _)| *word)));
        self.tell(found.help("known are mean, pixel, region and same_as"));
    }

    /// Another scene's file, which must be there.
    fn same_as(&mut self, name: &Name, env: &Env) -> Option<Claim> {
        let path = env.file.folder.join(&*name.text);
        if let Err(error) = self.bytes(&path) {
            self.unreadable(name, &path, &error);
            return None;
        }
        Some(Claim::SameAs { name: name.text.clone(), path })
    }

    /// Whole numbers of pixels.
    fn pixels<const N: usize>(&mut self, args: &[Arg], env: &Env) -> Option<[f64; N]> {
        let found: Vec<_> = args.iter().map(|arg| self.pixel(arg, env)).collect();
        found.into_iter().collect::<Option<Vec<f64>>>()?.try_into().ok()
    }

    fn pixel(&mut self, arg: &Arg, env: &Env) -> Option<f64> {
        let value = self.eval(&arg.value, env);
        let span = arg.value.span;
        if let Some(name) = &arg.name {
            let message = "pixels are given by their place alone, without a name";
            self.tell(Diagnostic::error("E0602", name.span, message));
            return None;
        }
        let x = self.unitless(&value, span, "a number of pixels")?;
        if x.fract().abs() > 0.0 {
            self.poison("E0208", span, format!("a whole number of pixels is wanted, not {x}"));
            return None;
        }
        Some(x)
    }

    fn area(&mut self, [x, y, width, height]: [f64; 4], span: Span) -> Option<Area> {
        let fits = [x, y].iter().all(|x| (0.0..MAX_SIDE).contains(x))
            && [width, height].iter().all(|side| (1.0..=MAX_SIDE).contains(side));
        if !fits {
            let message = "no picture has these pixels";
            let found = Diagnostic::error("E0603", span, message);
            self.tell(found.help("pixels are counted from (0, 0) at the upper left"));
            return None;
        }
        let vector = |x: f64, y: f64| glam::DVec2::new(x, y).as_uvec2();
        Some(Area::Region(Rect::new(vector(x, y), vector(width, height))))
    }

    fn mean(&mut self, of: Area, values: &[Expr], env: &Env) -> Option<Claim> {
        let found: Vec<Value> = values.iter().map(|value| self.eval(value, env)).collect();
        let value = self.expected(&found[0], values[0].span);
        let mut tolerance = None;
        if let (Some(found), Some(expr)) = (found.get(1), values.get(1)) {
            let x = self.unitless(found, expr.span, "a tolerance")?;
            if x < 0.0 {
                self.poison("E0405", expr.span, format!("a tolerance is from 0 on, this is {x}"));
                return None;
            }
            tolerance = Some(x);
        }
        Some(Claim::Mean { of, value: value?, tolerance })
    }

    /// A luminance, or three channels.
    fn expected(&mut self, value: &Value, span: Span) -> Option<Expected> {
        match value {
            Value::Numbers(n) if n.dimension.is_none() => {
                if let Ok(rgb) = <[f64; 3]>::try_from(&*n.data) {
                    return Some(Expected::Rgb(rgb));
                }
                let message = format!("3 channels are wanted, {} are given", n.data.len());
                self.poison("E0207", span, message);
                None
            }
            Value::Color(Color::Rgb(rgb), dimension) if dimension.is_none() => {
                Some(Expected::Rgb(*rgb))
            }
            _ => self
                .unitless(value, span, "a luminance, three channels or an rgb colour")
                .map(Expected::Luminance),
        }
    }

    /// A plain number.
    fn unitless(&mut self, value: &Value, span: Span, wanted: &str) -> Option<f64> {
        match value {
            Value::Number(x, dimension) if dimension.is_none() => return Some(*x),
            Value::Poison => {}
            Value::Number(_, dimension) => {
                let message =
                    format!("{wanted} is wanted, without a unit, not {}", dimension.name());
                self.poison("E0202", span, message);
            }
            other => {
                let message = format!("{wanted} is wanted, not {}", other.describe());
                self.poison("E0214", span, message);
            }
        }
        None
    }

    /// Values of parameters as text, as `--set` takes them; `None` after a mistake.
    fn given_where(&mut self, fields: &[Field], env: &Env) -> Option<Vec<(String, String)>> {
        let mut out = Some(vec![]);
        for field in fields {
            let value = self.eval(&field.value, env);
            let text = self.as_setting(&value, field);
            let known = self.declares(&field.name);
            match (text, &mut out) {
                (Some(text), Some(out)) if known => out.push((field.name.text.to_string(), text)),
                _ => out = None,
            }
        }
        out
    }

    fn as_setting(&mut self, value: &Value, field: &Field) -> Option<String> {
        match value {
            Value::Poison => None,
            Value::Number(..) | Value::Bool(_) => Some(match value {
                Value::Bool(value) => value.to_string(),
                number => number.show(),
            }),
            Value::Text(text) => {
                let text = text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n");
                Some(format!("\"{text}\""))
            }
            other => {
                let message =
                    format!("`where` takes numbers, texts and bools, not {}", other.describe());
                self.poison("E0214", field.value.span, message);
                None
            }
        }
    }

    /// Whether the file declares a parameter before; told if not.
    fn declares(&mut self, name: &Name) -> bool {
        let known: Vec<String> = self.params.iter().map(|param| param.name.clone()).collect();
        // What could not be read may have declared it.
        if self.damaged || known.iter().any(|known| **known == *name.text) {
            return true;
        }
        let message = format!("no parameter `{}` is declared before", name.text);
        let found = Diagnostic::error("E0111", name.span, message)
            .meant(name.span, near(&name.text, known.iter().map(String::as_str)));
        self.tell(found);
        false
    }

    /// Tells of expectations of pixels that the picture does not have.
    pub(super) fn expectations_fit(&mut self) {
        let size = Film::of_node(self.scene.film.map(|id| self.scene.node(id))).resolution;
        let outside = |said: &Expectation| match said.claim {
            Claim::Mean { of: of @ Area::Region(rect), .. } => {
                let end = rect.min.saturating_add(rect.size);
                end.cmpgt(size).any().then_some((said.span, of))
            }
            _ => None,
        };
        let found: Vec<_> = self.scene.expectations.iter().filter_map(outside).collect();
        for (span, area) in found {
            let message = format!("{area} {OUTSIDE}");
            let help =
                format!("the picture has {} x {} pixels, counted from (0, 0)", size.x, size.y);
            self.tell(Diagnostic::error("E0603", span, message).help(help));
        }
    }
}
