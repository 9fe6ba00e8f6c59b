//! Same, different, or not known.

use serde::Serialize;

use super::judge::{Judged, POWER, family};
use super::numbers::Numbers;
use super::pair::{self, Doubt, LEAST_SAMPLES, Pair};

/// What a comparison comes to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum Word {
    /// No difference was found, and a bias of the asked size would have been.
    Same,
    /// They differ by more than chance allows.
    Different,
    /// No difference was found, and noise may hide one.
    Inconclusive,
}

/// A word and why.
#[derive(Clone, Debug)]
pub(super) struct Verdict {
    pub(super) word: Word,
    pub(super) why: Vec<String>,
}

/// What may be wrong, and what must be seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Probability of calling two equal pictures different.
    pub(super) alpha: f64,
    /// Relative bias of the whole picture that `same` excludes.
    pub(super) bias: f64,
}

impl Verdict {
    fn new(word: Word, why: Vec<String>) -> Self {
        Self { word, why }
    }

    pub(super) fn of(pair: &Pair, numbers: &Numbers, judged: &Judged, limits: Limits) -> Self {
        if pair.is_identical() {
            return Self::new(Word::Same, vec!["identical, bit by bit".into()]);
        }
        let different = differences(numbers, judged, limits.alpha);
        if !different.is_empty() {
            return Self::new(Word::Different, different);
        }
        let unknown = unknown(pair, judged, limits.bias);
        if !unknown.is_empty() {
            return Self::new(Word::Inconclusive, unknown);
        }
        let (seen, power) = (percent(judged.detectable.whole), percent(POWER));
        let why = format!(
            "no difference was found; a bias of {seen} of the mean would have been with {power} \
             probability"
        );
        Self::new(Word::Same, vec![why])
    }
}

/// The tests that fail.
fn differences(numbers: &Numbers, judged: &Judged, alpha: f64) -> Vec<String> {
    let limit = family(alpha);
    let mut why = vec![];
    if numbers.finite_in_one > 0 {
        why.push(format!("{} pixels are finite in one picture alone", numbers.finite_in_one));
    }
    if judged.whole_p < limit {
        why.push(format!("the means differ: corrected p = {}", chance(judged.whole_p)));
    }
    if let Some(least) = judged.least.filter(|least| least.p < limit) {
        let at = least.tile.rect.min;
        why.push(format!(
            "the tile at ({}, {}) differs: corrected p = {:.2e}",
            at.x, at.y, least.p
        ));
    }
    if judged.histogram_p < limit {
        let p = chance(judged.histogram_p);
        why.push(format!("small p values of tiles are too many: p = {p}"));
    }
    why
}

/// Why nothing can be said.
fn unknown(pair: &Pair, judged: &Judged, bias: f64) -> Vec<String> {
    let mut why = vec![];
    for (name, picture) in [("A", &pair.a), ("B", &pair.b)] {
        if picture.is_denoised() {
            why.push(format!(
                "{name} is denoised: its standard errors are those of the picture before"
            ));
        } else if picture.se.is_empty() || picture.n.is_empty() {
            why.push(format!("{name} does not say how wrong it is (SE.R, SE.G, SE.B and N)"));
        }
    }
    if !why.is_empty() {
        return why;
    }
    why.extend(left_out(pair));
    let seen = judged.detectable.whole;
    if !seen.is_finite() {
        why.push(
            "no difference was found, and no bias is relative to a mean that is not known or 0"
                .into(),
        );
    } else if seen > bias {
        let (seen, power, bias) = (percent(seen), percent(POWER), percent(bias));
        why.push(format!(
            "no difference was found, but a bias below {seen} of the mean would not have been with \
             {power} probability; {bias} was asked for: take more samples, or ask for less"
        ));
    }
    why
}

/// The pixels that no test takes in, by the reason.
fn left_out(pair: &Pair) -> Vec<String> {
    let few = format!("have too few samples: it takes {LEAST_SAMPLES} to know how wrong they are");
    let doubts = [
        (Doubt::NotFinite, "are finite in neither picture"),
        (Doubt::FewSamples, &few),
        (Doubt::NoError, "do not say how wrong they are"),
    ];
    let told = |(doubt, what): (Doubt, &str)| {
        let n = pair.pixels().filter(|pixel| pair::doubt(pixel) == Some(doubt)).count();
        (n > 0).then(|| format!("{n} pixels {what}"))
    };
    doubts.into_iter().filter_map(told).collect()
}

/// A probability.
pub(super) fn chance(p: f64) -> String {
    if p >= 1e-3 { format!("{p:.3}") } else { format!("{p:.1e}") }
}

/// Three digits, or a dash for what is not known.
pub(super) fn percent(x: f64) -> String {
    let x = x * 100.0;
    match x.abs() {
        a if !a.is_finite() => "–".into(),
        a if a >= 100.0 => format!("{x:.0} %"),
        a if a >= 10.0 => format!("{x:.1} %"),
        a if a >= 1.0 || a <= 0.0 => format!("{x:.2} %"),
        a if a >= 1e-3 => format!("{x:.4} %"),
        _ => format!("{x:.1e} %"),
    }
}

#[cfg(test)]
mod tests {
    use glam::UVec2;
    use luxel_core::film::Rect;

    use super::*;
    use crate::compare::judge::judge;
    use crate::compare::pair::tests::flat;

    const LIMITS: Limits = Limits { alpha: 0.01, bias: 0.01 };

    fn verdict(pair: &Pair) -> (Word, String) {
        let found = Verdict::of(pair, &Numbers::of(pair), &judge(pair, LIMITS.alpha), LIMITS);
        (found.word, found.why.join("; "))
    }

    /// 32 × 32 pixels: 1024 of them, so that a standard error of a pixel is 32 of the whole's.
    fn pair(value: f32, se: f32) -> Pair {
        let size = UVec2::splat(32);
        let window = Rect::new(UVec2::ZERO, size);
        Pair::new(flat(size, window, value, se), flat(size, window, 1.0, se)).unwrap()
    }

    #[test]
    fn noise_does_not_buy_a_pass() {
        // The mean is off by 0.01 ± 0.0044·√2; no test sees that, and it could not.
        assert_eq!(verdict(&pair(1.001, 0.02)).0, Word::Same);
        let (word, why) = verdict(&pair(1.01, 0.14));
        assert_eq!(word, Word::Inconclusive);
        assert!(why.contains("take more samples"), "{why}");
        let (word, why) = verdict(&pair(1.01, 0.02));
        assert_eq!(word, Word::Different);
        assert!(why.contains("the means differ"), "{why}");
    }

    #[test]
    fn two_black_pictures_have_no_mean_to_be_relative_to() {
        let mut black = pair(0.0, 0.0);
        black.b.rgb.fill(0.0);
        black.a.rgb[0] = -0.0;
        let (word, why) = verdict(&black);
        assert_eq!(word, Word::Inconclusive);
        assert!(why.contains("not known or 0"), "{why}");
        let judged = judge(&black, LIMITS.alpha);
        assert!(judged.whole_p >= 1.0 && judged.least.is_none());
    }

    #[test]
    fn one_tile_is_enough_to_differ() {
        let mut pair = pair(1.0, 0.02);
        for at in Rect::new(UVec2::new(8, 16), UVec2::splat(8)).points() {
            let i = pair.a.index(at).unwrap() * 3;
            pair.a.rgb[i..i + 3].fill(1.03);
        }
        let (word, why) = verdict(&pair);
        assert_eq!(word, Word::Different);
        assert!(why.contains("the tile at (8, 16) differs"), "{why}");
    }

    #[test]
    fn pictures_that_say_nothing_of_their_error_are_the_same_only_to_the_bit() {
        let mut pair = pair(1.0, 0.02);
        (pair.a.se, pair.a.n) = (vec![], vec![]);
        assert_eq!(verdict(&pair).0, Word::Same);
        pair.a.rgb[0] += f32::EPSILON;
        let (word, why) = verdict(&pair);
        assert!(word == Word::Inconclusive && why.contains("A does not say"), "{why}");
        pair.a.rgb[0] = f32::NAN;
        let (word, why) = verdict(&pair);
        assert!(word == Word::Different && why.contains("1 pixels are finite in one"), "{why}");
    }

    #[test]
    fn a_denoised_picture_and_pixels_of_few_samples_leave_it_open() {
        let Pair { a, mut b, .. } = pair(1.0001, 0.02);
        b.notes = serde_json::json!({ "denoised": true });
        let denoised = Pair::new(a, b).unwrap();
        let (word, why) = verdict(&denoised);
        assert!(word == Word::Inconclusive && why.contains("B is denoised"), "{why}");
        let mut early = pair(1.0001, 0.02);
        (early.b.n[7], early.a.n[8]) = (15, 1);
        let (word, why) = verdict(&early);
        assert!(word == Word::Inconclusive && why.contains("2 pixels have too few"), "{why}");
        assert!(!why.contains("finite") && !why.contains("do not say"), "{why}");
    }

    #[test]
    fn pixels_that_no_test_takes_in_are_told_by_the_reason() {
        let mut pair = pair(1.0001, 0.02);
        (pair.a.rgb[0], pair.b.rgb[1]) = (f32::NAN, f32::INFINITY);
        pair.a.se[30] = f32::INFINITY;
        let (word, why) = verdict(&pair);
        assert!(word == Word::Inconclusive && !why.contains("samples:"), "{why}");
        assert!(why.contains("1 pixels are finite in neither"), "{why}");
        assert!(why.contains("1 pixels do not say how wrong"), "{why}");
    }

    #[test]
    fn shares_are_written_with_three_digits() {
        let told = [2.5, 0.12345, 0.0123, 0.000123, 1e-9, 0.0, f64::INFINITY].map(percent);
        let expected = ["250 %", "12.3 %", "1.23 %", "0.0123 %", "1.0e-7 %", "0.00 %"];
        assert_eq!(told[..6], expected);
        assert_eq!(told[6], "–");
    }
}
