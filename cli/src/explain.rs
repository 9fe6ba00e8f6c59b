//! `luxel explain`: what a scene requires of a render, who requires it, and what is left out.

use std::fmt::Write as _;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use luxel_core::diag::{Sources, Span};
use luxel_core::render::Options;
use luxel_core::scene::{Feature, NodeId, called};
use luxel_core::stage::{ColorChoice, Stage};
use serde_json::{Value, json};

use crate::args::{self, LoadArgs, PluginArgs};
use crate::codes;
use crate::exit::{Exit, Failure};
use crate::load::{self, Course, Loaded};
use crate::report::{self, Form, Stream};
use crate::study::{self, Price};
use crate::verify::Run;

/// Tell what a scene requires of a render, which lines require it, and what is left out
///
/// Only what a scene requires is modelled. Each feature that chooses code is listed: required, with
/// the places that require it, or left out, with the reason; and what --require and --drop change.
/// --cost measures the time of each, with the quartiles of nine rounds: of one that is required, over the
/// time without it; of another, if its code ran for nothing.
/// A code of a message, as E0402, is explained as well: what it means, an example, and the mend.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel explain scenes/fog.scene
  luxel explain scenes/motion.scene --drop motion
  luxel explain scenes/cornell.scene --json
  luxel explain scenes/fog.scene --cost
  luxel explain E0402")]
pub(crate) struct Args {
    /// The scene, or the code of a message
    #[arg(value_name = "SCENE|CODE")]
    file: PathBuf,
    /// Measure what each feature costs here: small pictures with it and without, in turns
    #[arg(long)]
    cost: bool,
    /// Threads that --cost renders with [default: as many as there are cores]
    #[arg(long, value_name = "N", requires = "cost", value_parser = args::threads)]
    threads: Option<NonZeroUsize>,
    /// One JSON object on standard output
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    load: LoadArgs,
    #[command(flatten)]
    plugins: PluginArgs,
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    if let Some(page) = codes::asked(&args.file)? {
        report::out(&if args.json { codes::json(&page) } else { codes::text(&page) })?;
        return Ok(Exit::Fine);
    }
    let plugins = load::registry(&args.plugins)?;
    let form = if args.json { Form::Json } else { Form::Text };
    plugins.notes.tell(form, Stream::Error)?;
    let loaded = load::load(&args.file, &args.load, None, &plugins, &Course::default())?;
    report::diagnostics(&loaded.diagnostics, &loaded.sources, form, Stream::Error)?;
    let Loaded { stage: Some(stage), scene: Some(scene), sources, .. } = &loaded else {
        return Ok(Exit::Input);
    };
    let mut prices = None;
    if args.cost {
        let options = Options { threads: args.threads, ..Options::default() };
        let run = Run::new(plugins, options)?.silent();
        prices = Some(study::prices((&args.file, scene), stage, &loaded, &run)?);
    }
    let told = Told { file: &args.file, stage, sources, prices };
    report::out(&if args.json { format!("{}\n", told.object()) } else { told.text() })?;
    Ok(Exit::Fine)
}

/// Places that are shown of one feature.
const MOST: usize = 8;

/// What is told of a scene.
struct Told<'a> {
    file: &'a Path,
    stage: &'a Stage,
    sources: &'a Sources,
    /// What was measured, if that was asked for.
    prices: Option<Vec<Price>>,
}

impl Told<'_> {
    fn text(&self) -> String {
        let Self { stage, .. } = self;
        let mut page = format!("{} requires\n", self.file.display());
        let (needed, rest): (Vec<_>, Vec<_>) =
            Feature::ALL.into_iter().partition(|feature| stage.needs(*feature));
        if needed.is_empty() {
            page.push_str("  none of the features below\n");
        }
        for feature in needed {
            let cost = self.cost(feature, without(feature));
            let cost = cost.map(|cost| format!(": {cost}"));
            page.extend(["  ", feature.name(), &cost.unwrap_or_default(), "\n"]);
            self.reasons(feature, &mut page);
        }
        page.push_str("left out\n");
        for feature in rest {
            let cost = self.cost(feature, "the time if it ran");
            let cost = cost.map(|cost| format!("; {cost}"));
            let why = absence(stage, feature) + &cost.unwrap_or_default();
            let _ = writeln!(page, "  {:14}{why}", feature.name());
        }
        let [shapes, materials, lights, media] = counts(stage);
        let _ = writeln!(
            page,
            "{shapes} shapes in their places, {materials} materials, {lights} lights, {media} media"
        );
        page
    }

    /// The places that require a feature.
    fn reasons(&self, feature: Feature, page: &mut String) {
        let reasons: Vec<_> = self.stage.reasons.of(feature).collect();
        for (id, span) in reasons.iter().take(MOST) {
            let name = called(self.stage.scene.node(*id));
            page.extend(["      ", &place(*span, self.sources), "  ", &name, "\n"]);
        }
        if reasons.len() > MOST {
            page.extend(["      and ", &(reasons.len() - MOST).to_string(), " more\n"]);
        }
        if reasons.is_empty() {
            page.extend(["      ", UNTOLD, "\n"]);
        }
    }

    fn price(&self, feature: Feature) -> Option<[f64; 3]> {
        let mut prices = self.prices.iter().flatten();
        prices.find(|price| price.feature == feature).map(|price| price.ratio)
    }

    /// `1.93 × (1.90–1.97) the time without it`, or why that is not known; nothing if nobody asked.
    fn cost(&self, feature: Feature, of: &str) -> Option<String> {
        let Some([low, median, high]) = self.price(feature) else {
            return self.unpriced(feature).map(|why| format!("no cost is known, as {why}"));
        };
        Some(format!("{median:.2} × ({low:.2}–{high:.2}) {of}"))
    }

    /// Why a cost that was asked for is not known, and what comes nearest to it.
    fn unpriced(&self, feature: Feature) -> Option<String> {
        self.prices.as_ref().filter(|_| self.price(feature).is_none())?;
        if !self.stage.needs(feature) {
            return feature.unrequirable().map(|_| "it cannot be required".to_owned());
        }
        let why = feature.dropped().err()?;
        Some(format!("it cannot be dropped ({why}); {ALIKE}"))
    }

    fn object(&self) -> Value {
        let Self { file, stage, sources, .. } = self;
        let by = |(id, span): (NodeId, Span)| {
            let is_written = !span.range().is_empty();
            let at = is_written.then(|| sources.line_column(span.source, span.start as usize));
            json!({
                "node": called(stage.scene.node(id)),
                "file": is_written.then(|| sources.name(span.source)),
                "line": at.map(|at| at.line),
                "column": at.map(|at| at.column),
            })
        };
        let feature = |feature: Feature| {
            let is_needed = stage.needs(feature);
            json!({
                "name": feature.name(),
                "required": is_needed,
                "compiled_in": stage.has(feature),
                "dropped": stage.scene.leaves_out(feature),
                "by": stage.reasons.of(feature).filter(|_| is_needed).map(by).collect::<Vec<_>>(),
                "time_ratio_quartiles": self.price(feature),
                "why_no_cost": self.unpriced(feature),
                "why_not": (!is_needed).then(|| absence(stage, feature)),
            })
        };
        let [shapes, materials, lights, media] = counts(stage);
        json!({
            "scene": file,
            "features": Feature::ALL.map(feature),
            "shapes": shapes,
            "materials": materials,
            "lights": lights,
            "media": media,
        })
    }
}

/// What a cost is over. What cannot be dropped stands where it is, and its code alone is left out.
fn without(feature: Feature) -> &'static str {
    match feature {
        Feature::OpenSurfaces => "the time if shadow rays did not look for them",
        Feature::LightChoice => "the time if one light alone were looked for",
        _ => "the time without it",
    }
}

/// What is said where nothing of the scene itself can be measured.
const ALIKE: &str =
    "scenes that look alike with it and without are measured in docs/performance.md";

/// What is said where shapes are too many to tell which of them lie within each other.
const UNTOLD: &str = "refracting shapes are too many to tell whether they overlap";

/// Why a feature is left out, and whether its code runs all the same.
fn absence(stage: &Stage, feature: Feature) -> String {
    if stage.scene.leaves_out(feature) {
        return format!("dropped: {}", feature.dropped().unwrap_or_default());
    }
    let why = match (feature, stage.film.color) {
        (Feature::Spectral, ColorChoice::Rgb) => "the film asks for RGB",
        _ => feature.absent(),
    };
    if stage.has(feature) { format!("{why}; its code runs all the same") } else { why.to_owned() }
}

/// `a.scene:3:5`, or where else it was asked for.
fn place(span: Span, sources: &Sources) -> String {
    if span.range().is_empty() {
        return "the command line".to_owned();
    }
    let at = sources.line_column(span.source, span.start as usize);
    format!("{}:{}:{}", sources.name(span.source), at.line, at.column)
}

/// Shapes in their places, materials, lights and media.
fn counts(stage: &Stage) -> [usize; 4] {
    let lights = stage.lights.len();
    [stage.placements.len(), stage.materials.len(), lights, stage.media.len()]
}
