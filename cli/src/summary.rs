//! What a render came to, for people and as JSON.

use glam::{DVec3, UVec2};
use luxel_core::film::Film;
use luxel_core::render::{Options, Outcome};
use luxel_core::stage::Stage;
use serde_json::{Value, json};

use crate::errors::Errors;
use crate::files::DiskFiles;
use crate::output::Output;
use crate::picture::Notes;
use crate::progress::duration;

/// What was asked, what it cost and how wrong the picture may be.
#[derive(Clone, Debug)]
pub(crate) struct Summary {
    size: UVec2,
    window: [u32; 4],
    exposure: Option<f64>,
    display: String,
    spp: u32,
    seed: u32,
    mode: String,
    integrator: String,
    outcome: Outcome,
    seconds: f64,
    samples: u64,
    mean: DVec3,
    error: Option<Errors>,
    scene: String,
    files: String,
    /// Samples that were not finite.
    pub(crate) bad: u64,
}

impl Summary {
    pub(crate) fn new(
        (stage, files): (&Stage, &DiskFiles),
        options: &Options,
        (film, outcome): (&Film, Outcome),
        (seconds, samples): (f64, u64),
    ) -> Self {
        let hex = |hash| blake3::Hash::from_bytes(hash).to_hex().to_string();
        let integrator = stage.scene.integrator.map(|id| stage.scene.node(id).class.to_string());
        let window = film.window;
        Self {
            size: film.size,
            window: [window.min.x, window.min.y, window.size.x, window.size.y],
            exposure: stage.film.exposure,
            display: format!("{:?}", stage.film.display).to_lowercase(),
            spp: options.samples(stage),
            seed: options.seed(stage),
            mode: format!("{:?}", stage.mode).to_lowercase(),
            integrator: integrator.unwrap_or_else(|| "path".into()),
            outcome,
            seconds,
            samples,
            mean: film.mean().0,
            error: Errors::of_film(film),
            scene: hex(stage.scene.hash()),
            files: files.hash().to_hex().to_string(),
            bad: film.bad_samples(),
        }
    }

    fn settings(&self) -> Value {
        json!({
            "luxel": env!("CARGO_PKG_VERSION"),
            "scene_hash": self.scene,
            "files_hash": self.files,
            "size": self.size.to_array(),
            "window": self.window,
            "exposure": self.exposure,
            "display": self.display,
            "spp": self.spp,
            "seed": self.seed,
            "color": self.mode,
            "integrator": self.integrator,
            "complete": self.outcome == Outcome::Complete,
        })
    }

    /// What the EXR says about itself: nothing that depends on the machine or the clock.
    pub(crate) fn notes(&self) -> Notes {
        Notes { json: self.settings().to_string() }
    }

    /// One object with everything, and the files that were written.
    pub(crate) fn json(&self, output: &Output) -> Value {
        let mut all = self.settings();
        all["seconds"] = json!(self.seconds);
        all["samples"] = json!(self.samples);
        all["samples_per_second"] = json!(self.rate());
        all["mean_radiance"] = json!(self.mean.to_array());
        all["median_relative_error"] = json!(self.error.map(|error| error.median));
        all["p95_relative_error"] = json!(self.error.map(|error| error.p95));
        all["bad_samples"] = json!(self.bad);
        all["exr"] = json!(output.exr);
        all["png"] = json!(output.png);
        all
    }

    /// A few lines.
    pub(crate) fn text(&self, output: &Output) -> String {
        let Self { spp, mean, .. } = self;
        let error = match self.error {
            Some(Errors { median, p95 }) => {
                format!("median {:.2} %, 95th percentile {:.2} %", median * 100.0, p95 * 100.0)
            }
            None => "unknown: it takes two samples per pixel".into(),
        };
        let percent = self.samples as f64 * 100.0 / self.wanted().max(1) as f64;
        let done = match self.outcome {
            Outcome::Complete => String::new(),
            Outcome::Cancelled | Outcome::Failed => {
                format!(", interrupted after {percent:.1} % of the samples")
            }
        };
        format!(
            "wrote {exr} and {png}{done}\n\
             {size}, {spp} spp, {mode}, {time}, {rate:.2} Msamples/s\n\
             mean radiance ({:.4}, {:.4}, {:.4}) W/m²/sr\n\
             relative standard error per pixel: {error}\n",
            mean.x,
            mean.y,
            mean.z,
            exr = output.exr.display(),
            png = output.png.display(),
            size = self.place(),
            mode = self.mode,
            time = duration(self.seconds),
            rate = self.rate() / 1e6,
        )
    }

    /// `640 x 480`, or of a crop `64 x 64 at (100, 50) of 640 x 480`.
    fn place(&self) -> String {
        let [x, y, w, h] = self.window;
        let whole = format!("{} x {}", self.size.x, self.size.y);
        if [w, h] == self.size.to_array() {
            whole
        } else {
            format!("{w} x {h} at ({x}, {y}) of {whole}")
        }
    }

    fn wanted(&self) -> u64 {
        u64::from(self.window[2]) * u64::from(self.window[3]) * u64::from(self.spp)
    }

    fn rate(&self) -> f64 {
        self.samples as f64 / self.seconds.max(f64::MIN_POSITIVE)
    }
}
