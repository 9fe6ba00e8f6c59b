//! Truths about whole renders, listed in `truths.txt`.

use std::f64::consts::PI;

use glam::{DVec3, UVec2};
use luxel_core::film::{Film, Pixel, Rect};
use luxel_core::render::{Control, Options, Outcome, render};
use luxel_sdk::color::RgbSpace;

use super::Row;
use crate::disk::{OnDisk, root, text};
use crate::load::stage_of;

/// A line of the list.
#[derive(Clone, Debug)]
pub(super) struct Case {
    pub(super) id: String,
    scene: String,
    set: Vec<(String, String)>,
    region: Region,
    quantity: Quantity,
    expected: f64,
    tolerance: (f64, f64),
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Region {
    Flat,
    Whole,
    Patch(UVec2),
}

#[derive(Clone, Copy, Debug)]
enum Quantity {
    /// Mean luminance times a factor.
    Luminance(f64),
    /// Variance of one sample's luminance.
    Variance,
}

/// Side of a patch, pixels.
const PATCH: u32 = 8;

pub(super) fn cases() -> Vec<Case> {
    let list = text(&root().join("tests/truths/truths.txt"));
    let lines = list.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines.map(|line| case(line).unwrap_or_else(|| panic!("not a case: {line}"))).collect()
}

fn case(line: &str) -> Option<Case> {
    let fields: Vec<&str> = line.split('|').map(str::trim).collect();
    let [id, scene, set, region, quantity, expected, rel, abs] = fields.try_into().ok()?;
    let region = match region {
        "flat" => Region::Flat,
        "whole" => Region::Whole,
        at => {
            let (x, y) = at.split_once(',')?;
            Region::Patch(UVec2::new(x.parse().ok()?, y.parse().ok()?))
        }
    };
    let quantity = match quantity.split_once(' ') {
        Some(("pi", "Y")) => Quantity::Luminance(PI),
        Some((factor, "Y")) => Quantity::Luminance(factor.parse().ok()?),
        None if quantity == "Y" => Quantity::Luminance(1.0),
        None if quantity == "variance" => Quantity::Variance,
        _ => return None,
    };
    Some(Case {
        id: id.to_owned(),
        scene: scene.to_owned(),
        set: settings(set)?,
        region,
        quantity,
        expected: expected.parse().ok()?,
        tolerance: (rel.parse().ok()?, abs.parse().ok()?),
    })
}

/// `a=1 b="x y"`: names and values; quantities with a unit stand in quotes to hold their blank.
fn settings(mut text: &str) -> Option<Vec<(String, String)>> {
    let mut out = vec![];
    while !text.is_empty() {
        let (name, rest) = text.split_once('=')?;
        let quoted = rest.starts_with('"');
        let end =
            if quoted { rest[1..].find('"')? + 2 } else { rest.find(' ').unwrap_or(rest.len()) };
        let value = &rest[..end];
        // A length or an angle is no text.
        let is_quantity = quoted && value[1..].starts_with(|c: char| c.is_ascii_digit());
        let value = if is_quantity { value.trim_matches('"') } else { value };
        out.push((name.to_owned(), value.to_owned()));
        text = rest[end..].trim_start();
    }
    Some(out)
}

pub(super) fn rows() -> Vec<Row> {
    let mut rows = vec![];
    let mut last: Option<(Case, Film)> = None;
    for case in cases() {
        // Several quantities of one picture need it once.
        let again = last.as_ref().is_some_and(|(before, _)| {
            (&before.scene, &before.set, before.region) == (&case.scene, &case.set, case.region)
        });
        if !again {
            last = Some((case.clone(), picture(&case)));
        }
        let film = &last.as_ref().unwrap().1;
        let (measured, error) = measure(film, &case);
        let (rel, abs) = case.tolerance;
        rows.push(Row {
            id: case.id.clone(),
            case: case.set.iter().map(|(n, v)| format!("{n}={v}")).collect::<Vec<_>>().join(" "),
            expected: case.expected,
            measured,
            error,
            tolerance: abs.max(rel * case.expected.abs()),
        });
    }
    rows
}

/// The film of one of the scenes beside this file.
pub(super) fn film(name: &str, set: &[(String, String)], crop: Option<Rect>) -> Film {
    let path = root().join(format!("tests/truths/{name}.scene"));
    let stage = stage_of(&path, &OnDisk, set, None)
        .unwrap_or_else(|said| panic!("{name} {set:?}: {}", told(&said)));
    let options = Options { crop, ..Options::default() };
    let (film, outcome) = render(&stage, &options, &Control::default());
    assert_eq!((outcome, film.bad_samples()), (Outcome::Complete, 0), "{name} {set:?}");
    film
}

fn told(said: &[luxel_core::diag::Diagnostic]) -> String {
    said.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

fn picture(case: &Case) -> Film {
    let crop = match case.region {
        Region::Patch(at) => Some(Rect::new(at - UVec2::splat(PATCH / 2), UVec2::splat(PATCH))),
        _ => None,
    };
    film(&case.scene, &case.set, crop)
}

fn luminance(rgb: DVec3) -> f64 {
    rgb.dot(RgbSpace::default().luminance_weights())
}

/// The value and its standard error. All truths here are grey: channels rise and fall together.
fn measure(film: &Film, case: &Case) -> (f64, f64) {
    let (value, factor): (fn(&Pixel) -> f64, f64) = match case.quantity {
        Quantity::Luminance(factor) => (|pixel| luminance(pixel.mean), factor),
        Quantity::Variance => (|pixel| pixel.variance().y, 1.0),
    };
    if case.region == Region::Whole {
        let (mean, error) = film.mean();
        return (luminance(mean) * factor, luminance(error) * factor);
    }
    let (mean, error) = spread(film.pixels().map(|(_, pixel)| value(pixel)));
    (mean * factor, error * factor)
}

/// Mean and standard error of independent values with the same expectation.
pub(super) fn spread(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let values: Vec<f64> = values.collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x - mean) * (x - mean)).sum();
    (mean, (squares / (n - 1.0) / n).sqrt())
}

#[test]
fn settings_hold_words_texts_and_quantities() {
    let pair = |n: &str, v: &str| (n.to_owned(), v.to_owned());
    let read = settings("a=1 form=\"box\" away=\"1e6 m\"").unwrap();
    assert_eq!(read, [pair("a", "1"), pair("form", "\"box\""), pair("away", "1e6 m")]);
}
