//! The mean that a scene expects of its picture, which every configuration is held against.
//!
//! It tells what no reference made of the scene itself can: what the scene as it is gets wrong.

use luxel_core::scene::{Area, Claim, Expected as Value, Scene};
use luxel_sdk::color::RgbSpace;
use serde_json::json;

use super::estimate::{Number, SIGMAS};
use super::outcome::Outcome;
use super::table::{percent, signed};

/// What the mean luminance of the whole picture is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Expected {
    luminance: f64,
    /// A part of it.
    tolerance: f64,
}

impl Expected {
    /// What the scene says without `where`; nothing where it says nothing, or black.
    pub(super) fn of(scene: &Scene) -> Option<Self> {
        let said = scene.expectations.iter().filter(|said| said.given.is_empty());
        let mut found = said.filter_map(|said| match said.claim {
            Claim::Mean { of: Area::Whole, value, tolerance } => Some((value, tolerance)),
            _ => None,
        });
        let (value, tolerance) = found.next_back()?;
        let luminance = match value {
            Value::Luminance(luminance) => luminance,
            Value::Rgb(rgb) => RgbSpace::default().luminance_weights().dot(rgb.into()),
        };
        let tolerance = tolerance.unwrap_or(0.0) / luminance;
        (luminance > 0.0).then_some(Self { luminance, tolerance })
    }

    /// How far a configuration's mean is off, as a share.
    pub(super) fn off(&self, outcome: &Outcome) -> Number {
        let Number { value, error } = outcome.mean;
        Number { value: value / self.luminance - 1.0, error: error / self.luminance }
    }

    /// What would not have been seen.
    fn unseen(&self, outcome: &Outcome) -> f64 {
        SIGMAS * self.off(outcome).error + self.tolerance
    }

    fn is_off(&self, outcome: &Outcome) -> bool {
        self.off(outcome).value.abs() > self.unseen(outcome)
    }

    /// Every configuration whose mean is wrong, and what would not have been seen of the others.
    pub(super) fn note(&self, outcomes: &[Outcome]) -> String {
        let (wrong, right): (Vec<_>, Vec<_>) =
            outcomes.iter().partition(|outcome| self.is_off(outcome));
        let told = |outcome: &&Outcome| format!("{} {}", outcome.name, signed(self.off(outcome)));
        let mut told: Vec<String> = wrong.iter().map(told).collect();
        let unseen = right.iter().map(|outcome| self.unseen(outcome)).fold(0.0, f64::max);
        if !right.is_empty() {
            let which = if wrong.is_empty() { "all" } else { "all others" };
            told.push(format!("{which} none > {}", percent(unseen)));
        }
        let told = told.join(", ");
        format!("bias of the mean, against the {} that the scene expects: {told}", self.luminance)
    }

    pub(super) fn json(&self) -> serde_json::Value {
        json!({ "luminance": self.luminance, "tolerance": self.tolerance * self.luminance })
    }
}
