//! Everything that a study found, as text, as data and as files.

use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};

use glam::UVec2;
use serde_json::{Value, json};

use super::calibrate::Reading;
use super::expected::Expected;
use super::outcome::Outcome;
use super::svg::{Marks, svg};
use super::verify::{Verdict, Verified};
use super::{data, table};
use crate::exit::Failure;
use crate::output::{Draft, unwritable};
use crate::progress::duration;

/// What is recommended.
pub(super) struct Advice {
    /// The configuration.
    pub(super) of: usize,
    pub(super) samples: u32,
    /// Lines to paste.
    pub(super) lines: String,
    /// `None` where the verifying render was left out or did not end.
    pub(super) verified: Option<Verified>,
}

/// All of it.
pub(super) struct Found {
    pub(super) scene: PathBuf,
    pub(super) hash: String,
    pub(super) size: UVec2,
    /// Size of the scene's own picture.
    pub(super) whole: UVec2,
    pub(super) target: f64,
    pub(super) seeds: usize,
    pub(super) first_seed: u32,
    /// What errors are against, in words.
    pub(super) against: String,
    pub(super) reference_error: f64,
    /// What the scene says of its mean.
    pub(super) expected: Option<Expected>,
    pub(super) readings: [Reading; 2],
    pub(super) notes: Vec<String>,
    pub(super) outcomes: Vec<Outcome>,
    pub(super) advice: Option<Advice>,
    pub(super) is_interrupted: bool,
}

impl Found {
    /// Whether the recommended settings were shown to keep what they promise.
    pub(super) fn is_met(&self) -> bool {
        let verified = self.advice.as_ref().and_then(|advice| advice.verified);
        verified.is_some_and(|verified| verified.is_met(self.target))
    }

    pub(super) fn text(&self) -> String {
        let Self { size, against, .. } = self;
        let mut lines: Vec<String> = self.readings.iter().map(Reading::text).collect();
        let own = match self.reference_error {
            error if error > 0.0 => {
                format!(", whose own error of {} is taken off", table::percent(error))
            }
            _ => String::new(),
        };
        let scene = self.scene.display();
        lines.push(format!(
            "{scene}, {} x {} pixels; errors against {against}{own}",
            size.x, size.y
        ));
        lines.push(String::new());
        lines.push(table::table(&self.outcomes, self.target, self.seeds));
        lines.extend(self.notes.iter().map(|note| format!("note: {note}")));
        let bad: u64 = self.outcomes.iter().map(|outcome| outcome.bad).sum();
        if bad > 0 {
            lines.push(format!("note: {bad} samples were not finite and were left out"));
        }
        lines.push(self.advice_text());
        lines.join("\n")
    }

    fn advice_text(&self) -> String {
        let target = table::percent(self.target);
        let Some(Advice { of, samples, lines, verified }) = &self.advice else {
            return format!("nothing that was swept reaches {target}\n");
        };
        let outcome = &self.outcomes[*of];
        let pixels = |size: UVec2| f64::from(size.x) * f64::from(size.y);
        let larger = pixels(self.whole) / pixels(self.size);
        let seconds = f64::from(*samples) * outcome.cost;
        let mut out = format!(
            "for {target} ({}), about {} at {} x {}:\n\n{lines}\n\n",
            outcome.name,
            duration(seconds * larger),
            self.whole.x,
            self.whole.y,
        );
        out += &match verified {
            Some(verified) => table::verdict(verified, self.target),
            None => "not verified by a render".to_owned(),
        };
        out + "\n"
    }

    pub(super) fn json(&self) -> Value {
        let advice = self.advice.as_ref().map(|advice| {
            let verified = advice.verified.map(|verified| {
                json!({
                    "rmse": data::number(verified.rmse),
                    "off": data::number(verified.off(self.target)),
                    "off_bounds": verified.bounds(self.target),
                    "samples": verified.samples,
                    "pictures": verified.pictures,
                    "seen_at": verified.seen_at,
                    "seconds": verified.seconds,
                    "is_within_tenth": verified.verdict(self.target) == Verdict::Near,
                })
            });
            json!({
                "configuration": self.outcomes[advice.of].name,
                "samples": advice.samples,
                "settings": advice.lines,
                "verified": verified,
            })
        });
        json!({
            "version": env!("CARGO_PKG_VERSION"),
            "build": env!("LUXEL_BUILD"),
            "machine": {
                "os": std::env::consts::OS,
                "arch": std::env::consts::ARCH,
                "cores": std::thread::available_parallelism().map_or(1, usize::from),
            },
            "scene": self.scene.display().to_string(),
            "scene_hash": self.hash,
            "size": [self.size.x, self.size.y],
            "target": self.target,
            "seeds": self.seeds,
            "first_seed": self.first_seed,
            "reference": { "what": self.against, "rmse": self.reference_error },
            "calibration": self.readings.map(|reading| reading.json()),
            "configurations": data::json(&self.outcomes, self.target, self.expected),
            "expected_mean": self.expected.map(|expected| expected.json()),
            "recommended": advice,
            "notes": self.notes,
            "is_interrupted": self.is_interrupted,
        })
    }

    /// Writes OUT.csv, OUT.json and OUT.svg.
    ///
    /// # Errors
    /// What the disk says.
    pub(super) fn write(&self, out: &Path) -> Result<(), Failure> {
        let verified = self.advice.as_ref().and_then(|advice| advice.verified);
        let name = self.scene.file_stem().unwrap_or_default().to_string_lossy();
        let marks = Marks { title: &name, size: self.size, target: self.target, verified };
        let files = [
            (".csv", data::csv(&self.outcomes)),
            (".json", format!("{:#}\n", self.json())),
            (".svg", svg(&self.outcomes, &marks)),
        ];
        for (suffix, text) in files {
            let path = place(out, suffix);
            let mut draft = Draft::begin(&path).map_err(|error| unwritable(&path, &error))?;
            let written = draft.file.write_all(text.as_bytes()).and_then(|()| draft.finish());
            written.map_err(|error| unwritable(&path, &error))?;
        }
        Ok(())
    }
}

/// Whether the files can be written, asked before the work begins.
///
/// # Errors
/// What stands in the way.
pub(super) fn check(out: &Path) -> Result<(), Failure> {
    [".csv", ".json", ".svg"].into_iter().map(|suffix| place(out, suffix)).try_for_each(|path| {
        Draft::begin(&path).map(|_| ()).map_err(|error| unwritable(&path, &error))
    })
}

fn place(out: &Path, suffix: &str) -> PathBuf {
    let mut name: OsString = out.into();
    name.push(suffix);
    name.into()
}
