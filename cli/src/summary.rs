//! What a render came to, for people and as JSON.

use glam::{DVec3, UVec2};
use luxel_core::film::{Film, Layer};
use luxel_core::render::{Goal, Options, Outcome};
use luxel_core::scene::{Feature, NodeId, called};
use luxel_core::stage::Stage;
use serde_json::{Value, json};

use crate::files::DiskFiles;
use crate::origin::Origin;
use crate::output::Output;
use crate::picture::{Exposed, Notes};
use crate::progress::duration;
use crate::reached::Reached;

/// What was asked, what it cost and how wrong the picture may be.
#[derive(Clone, Debug)]
pub(crate) struct Summary {
    size: UVec2,
    window: [u32; 4],
    exposure: Option<f64>,
    display: String,
    /// Samples that were asked for, or, with a goal, the most of a pixel.
    spp: u32,
    /// The fewest and the most samples of a pixel.
    counts: [u32; 2],
    goal: Goal,
    seed: u32,
    mode: String,
    integrator: String,
    precision: &'static str,
    sampler: String,
    filter: String,
    outcome: Outcome,
    took: Took,
    /// Of this run and those that it went on from.
    samples_in_all: u64,
    mean: DVec3,
    exposed: Exposed,
    reached: Reached,
    scene: String,
    files: String,
    origin: Origin,
    /// What the scene requires and was not modelled.
    dropped: Vec<Feature>,
    /// What the numbers of layers mean, by layer: names, the first of which is number 1.
    names: Value,
    /// Samples that were not finite.
    pub(crate) bad: u64,
    bad_places: BadPlaces,
}

/// What it cost.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Took {
    /// Seconds of this run.
    pub(crate) seconds: f64,
    /// Seconds of the runs that it went on from.
    pub(crate) before: f64,
    /// Samples of this run.
    pub(crate) samples: u64,
}

impl Took {
    /// `12 s`, or `12 s (48 s in all)`.
    fn words(self) -> String {
        let now = duration(self.seconds);
        let in_all = duration(self.before + self.seconds);
        if self.before > 0.0 { format!("{now} ({in_all} in all)") } else { now }
    }

    fn rate(self) -> f64 {
        self.samples as f64 / self.seconds.max(f64::MIN_POSITIVE)
    }
}

impl Summary {
    pub(crate) fn new(
        (stage, files, origin): (&Stage, &DiskFiles, &Origin),
        options: &Options,
        (film, outcome): (&Film, Outcome),
        took: Took,
    ) -> Self {
        let hex = |hash| blake3::Hash::from_bytes(hash).to_hex().to_string();
        let integrator = stage.scene.integrator.map(|id| stage.scene.node(id).class.to_string());
        let window = film.window;
        let goal = options.goal;
        let counts = counts(film);
        let spp = if goal.is_some() { counts[1] } else { options.samples(stage) };
        Self {
            size: film.size,
            window: [window.min.x, window.min.y, window.size.x, window.size.y],
            exposure: stage.film.exposure,
            display: format!("{:?}", stage.film.display).to_lowercase(),
            spp,
            counts,
            goal,
            seed: options.seed(stage),
            mode: format!("{:?}", stage.mode).to_lowercase(),
            integrator: integrator.unwrap_or_else(|| "path".into()),
            precision: stage.film.precision.word(),
            sampler: stage.sampler.class().name.to_string(),
            filter: stage.filter.class().name.to_string(),
            outcome,
            took,
            samples_in_all: film.samples().max(took.samples),
            mean: film.mean().0,
            exposed: Exposed::of(film, &stage.film),
            reached: Reached::of(film, goal),
            scene: hex(stage.scene.hash()),
            files: files.hash().to_hex().to_string(),
            origin: origin.clone(),
            dropped: stage.scene.left_out().collect(),
            names: names(stage, film),
            bad: film.bad_samples(),
            bad_places: BadPlaces::of(film.pixels().map(|(at, pixel)| (at, pixel.bad))),
        }
    }

    /// Whether every tile has the error that was asked for, if one was.
    pub(crate) fn is_reached(&self) -> bool {
        self.reached.is_whole()
    }

    fn settings(&self) -> Value {
        let mut settings = self.common_settings();
        self.origin.say(&mut settings);
        settings["least_samples"] = json!(self.counts[0]);
        settings["most_samples"] = json!(self.counts[1]);
        self.reached.say(&mut settings);
        if self.names.as_object().is_some_and(|names| !names.is_empty()) {
            settings["names"] = self.names.clone();
        }
        if !self.dropped.is_empty() {
            settings["dropped"] = self.dropped.iter().map(|it| it.name()).collect();
        }
        self.bad_places.say(&mut settings);
        settings
    }

    fn common_settings(&self) -> Value {
        json!({
            "luxel": env!("CARGO_PKG_VERSION"),
            "build": env!("LUXEL_BUILD"),
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
            "precision": self.precision,
            "sampler": self.sampler,
            "filter": self.filter,
            "bad_samples": self.bad,
            "time_asked": self.goal.time.map(|time| time.as_secs_f64()),
            "complete": self.outcome == Outcome::Complete && self.is_reached(),
        })
    }

    /// What the EXR says about itself: nothing that depends on the machine or the clock.
    pub(crate) fn notes(&self) -> Notes {
        Notes { json: self.settings().to_string() }
    }

    /// One object with everything, and the files that were written.
    pub(crate) fn json(&self, output: &Output) -> Value {
        let mut all = self.settings();
        all["seconds"] = json!(self.took.seconds);
        all["seconds_in_all"] = json!(self.took.before + self.took.seconds);
        all["samples"] = json!(self.took.samples);
        all["samples_in_all"] = json!(self.samples_in_all);
        all["samples_per_second"] = json!(self.took.rate());
        all["mean_radiance"] = json!(self.mean.to_array());
        all["exr"] = json!(output.exr);
        all["png"] = json!(output.png);
        all
    }

    /// A few lines.
    pub(crate) fn text(&self, output: &Output) -> String {
        let Self { mean, .. } = self;
        let percent = self.samples_in_all as f64 * 100.0 / self.wanted().max(1) as f64;
        let done = match self.outcome {
            Outcome::Complete => String::new(),
            _ if self.goal.is_some() => ", interrupted".into(),
            Outcome::Cancelled | Outcome::Failed => {
                format!(", interrupted after {percent:.1} % of the samples")
            }
        };
        format!(
            "wrote {exr} and {png}{done}\n\
             {size}, {spp} spp, {mode}, {time}, {rate:.2} Msamples/s\n\
             mean radiance ({:.4}, {:.4}, {:.4}) W/m²/sr\n\
             {exposed}{reached}{bad}{dropped}",
            mean.x,
            mean.y,
            mean.z,
            exr = output.exr.display(),
            png = output.png.display(),
            size = self.place(),
            spp = self.spp_words(),
            mode = self.mode,
            time = self.took.words(),
            rate = self.took.rate() / 1e6,
            exposed = self.exposed.words(),
            reached = self.reached.words(),
            bad = self.bad_places.words(),
            dropped = self.dropped_words(),
        )
    }

    /// `64`, `64 to 1024`, or of a picture that was interrupted `8 of 64`.
    fn spp_words(&self) -> String {
        let [least, most] = self.counts;
        let has_goal = self.goal.is_some();
        let taken = if least == most { least.to_string() } else { format!("{least} to {most}") };
        match self.outcome {
            Outcome::Cancelled | Outcome::Failed if !has_goal => format!("{taken} of {}", self.spp),
            _ if least == most || !has_goal => self.spp.to_string(),
            _ => taken,
        }
    }

    fn dropped_words(&self) -> String {
        let line = |feature: &Feature| {
            let instead = feature.dropped().unwrap_or_default();
            format!("`{}` was dropped: {instead}\n", feature.name())
        };
        self.dropped.iter().map(line).collect()
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
}

/// Pixels that samples were left out of, as they were not finite.
#[derive(Clone, Debug, Default)]
struct BadPlaces {
    /// How many there are.
    pixels: u64,
    /// The first of them, row by row, and how many samples were left out of each.
    first: Vec<(UVec2, u32)>,
}

/// So many pixels are named.
const NAMED: usize = 5;

impl BadPlaces {
    /// Of pixels with as many such samples as stand beside them.
    fn of(pixels: impl Iterator<Item = (UVec2, u32)>) -> Self {
        let mut found = Self::default();
        for (at, bad) in pixels.filter(|(_, bad)| *bad > 0) {
            found.pixels += 1;
            if found.first.len() < NAMED {
                found.first.push((at, bad));
            }
        }
        found
    }

    fn say(&self, all: &mut Value) {
        let place = |(at, n): &(UVec2, u32)| json!({ "x": at.x, "y": at.y, "samples": n });
        all["bad_pixels"] = json!(self.pixels);
        all["first_bad_pixels"] = self.first.iter().map(place).collect();
    }

    /// Nothing if there are none.
    fn words(&self) -> String {
        let place = |(at, n): &(UVec2, u32)| format!("{n} at ({}, {})", at.x, at.y);
        let places: Vec<_> = self.first.iter().map(place).collect();
        let others = match self.pixels - self.first.len() as u64 {
            0 if places.is_empty() => return String::new(),
            0 => String::new(),
            1 => ", and more at another pixel".into(),
            n => format!(", and more at {n} other pixels"),
        };
        format!("samples that were not finite: {}{others}\n", places.join(", "))
    }
}

/// Most names that a picture carries: those of a forest help nobody.
const MOST_NAMES: usize = 10_000;

/// What the numbers of layers mean.
fn names(stage: &Stage, film: &Film) -> Value {
    let called = |id: &NodeId| stage.scene.nodes.get(id.0 as usize).map(called);
    let listed = |layer: Layer, nodes: &mut dyn Iterator<Item = &NodeId>| {
        let names: Vec<_> = nodes.take(MOST_NAMES).map(called).collect();
        film.holds.layers.contains(&layer).then(|| (layer.name().to_owned(), json!(names)))
    };
    let materials = listed(Layer::Material, &mut stage.material_nodes.iter());
    let shapes = &mut stage.placements.iter().map(|placement| &placement.node);
    let objects = listed(Layer::Object, shapes);
    Value::Object(materials.into_iter().chain(objects).collect())
}

/// The fewest and the most samples of a pixel.
fn counts(film: &Film) -> [u32; 2] {
    let of = film.pixels().map(|(_, pixel)| pixel.n + pixel.bad);
    let most = of.fold([u32::MAX, 0], |[least, most], n| [least.min(n), most.max(n)]);
    if most[0] == u32::MAX { [0, 0] } else { most }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_pixels_with_samples_that_were_not_finite_are_named() {
        // Every other pixel of a row has one more than the one before.
        let bad = |n: u32| {
            BadPlaces::of(
                (0..2 * n).map(|x| (UVec2::new(x, 3), if x % 2 == 0 { 0 } else { x / 2 + 1 })),
            )
        };
        assert_eq!(bad(0).words(), "");
        assert_eq!(bad(2).words(), "samples that were not finite: 1 at (1, 3), 2 at (3, 3)\n");
        assert!(bad(6).words().ends_with("5 at (9, 3), and more at another pixel\n"));
        assert!(bad(7).words().ends_with("5 at (9, 3), and more at 2 other pixels\n"));
        let mut told = json!({});
        bad(6).say(&mut told);
        assert_eq!(told["bad_pixels"], 6);
        assert_eq!(told["first_bad_pixels"][4], json!({ "x": 9, "y": 3, "samples": 5 }));
        assert_eq!(told["first_bad_pixels"].as_array().map(Vec::len), Some(NAMED));
    }

    #[test]
    fn the_time_of_this_run_stands_beside_that_of_all() {
        let took = Took { seconds: 12.0, before: 0.0, samples: 24 };
        assert_eq!(took.words(), "12 s");
        assert!((took.rate() - 2.0).abs() < 1e-12);
        assert_eq!(Took { before: 53.0, ..took }.words(), "12 s (1 min 05 s in all)");
    }
}
