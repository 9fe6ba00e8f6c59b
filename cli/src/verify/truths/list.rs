//! The list of truths about whole pictures, `truths.txt`.

use std::f64::consts::PI;

use glam::UVec2;

use super::texts::LIST;

/// A line of the list.
#[derive(Clone, Debug)]
pub(super) struct Case {
    pub(super) id: String,
    pub(super) scene: String,
    pub(super) set: Vec<(String, String)>,
    pub(super) region: Region,
    pub(super) quantity: Quantity,
    pub(super) expected: f64,
    /// As a share and as an amount.
    pub(super) tolerance: (f64, f64),
}

/// Which pixels are measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Region {
    /// Every pixel sees the same.
    Flat,
    /// The mean of the picture.
    Whole,
    /// A patch about a place, whose pixels see the same.
    Patch(UVec2),
}

/// What is measured of them.
#[derive(Clone, Copy, Debug)]
pub(super) enum Quantity {
    /// Mean luminance times a factor.
    Luminance(f64),
    /// Variance of one sample's luminance.
    Variance,
}

/// Every case.
pub(super) fn cases() -> Vec<Case> {
    let lines = LIST.lines().filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines.map(|line| case(line).expect("the list of this program has cases alone")).collect()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_hold_words_texts_and_quantities() {
        let pair = |n: &str, v: &str| (n.to_owned(), v.to_owned());
        let read = settings("a=1 form=\"box\" away=\"1e6 m\"").unwrap();
        assert_eq!(read, [pair("a", "1"), pair("form", "\"box\""), pair("away", "1e6 m")]);
    }
}
