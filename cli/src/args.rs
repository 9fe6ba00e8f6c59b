//! Arguments that several commands share.

use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use clap::Args;
use glam::UVec2;
use luxel_core::accel::Precision;
use luxel_core::film::{Layer, Rect};
use luxel_core::render::Options;
use luxel_core::scene::{Feature, Scene};
use luxel_lang::Budgets;

use crate::exit::{Exit, Failure};

/// How a scene is read.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct LoadArgs {
    /// Give a `param` of the scene another value
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = assignment)]
    pub(crate) set: Vec<(String, String)>,
    /// Let the scene read files below this folder too (its own folder is always allowed)
    #[arg(long, value_name = "DIR")]
    pub(crate) allow_path: Vec<PathBuf>,
    /// How rays meet the triangles of meshes: fast, standard or exact [default: as the film says]
    #[arg(long, value_name = "HOW", value_parser = precision)]
    pub(crate) precision: Option<Precision>,
    /// Record this beside colour, as the film's parameters of these names do: `albedo`, `normal`,
    /// `position`, `depth`, `material_id`, `object_id`, `motion`, `cost`
    #[arg(long = "aov", value_name = "LAYER,…", value_delimiter = ',', value_parser = layer)]
    pub(crate) layers: Vec<Layer>,
    /// Have the code of a feature run though the scene may not require it, which changes no bit:
    /// `media`, `open_surfaces`, `nested`, `motion`, `light_choice`
    #[arg(long = "require", value_name = "FEATURE,…", value_delimiter = ',', value_parser = requirable)]
    pub(crate) required: Vec<Feature>,
    /// Model less than the scene requires: `spectral`, `media`, `nested`, `motion`, `layers`
    #[arg(long = "drop", value_name = "FEATURE,…", value_delimiter = ',', value_parser = droppable)]
    pub(crate) dropped: Vec<Feature>,
    #[command(flatten)]
    pub(crate) budgets: BudgetArgs,
}

/// What reading a scene may cost.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct BudgetArgs {
    /// Let a scene cost more or less than usual, as in `nodes=3e6,steps=1e9`: `nodes`, `instances`, `steps`,
    /// `value_bytes`, `list`, `names`, `string`, `statements`, `pieces`, `file_bytes`, `total_bytes`, `includes`,
    /// `include_depth`, `diagnostics`, `brackets`, `operators`, `nesting`
    #[arg(long = "budget", value_name = "NAME=N,…", value_delimiter = ',', value_parser = budget)]
    amounts: Vec<(String, f64)>,
}

impl BudgetArgs {
    /// The same with another budget, unless it is given.
    pub(crate) fn or(mut self, name: &str, amount: f64) -> Self {
        self.amounts.insert(0, (name.to_owned(), amount));
        self
    }

    /// All budgets, those that are given changed.
    pub(crate) fn budgets(&self) -> Budgets {
        let changed = |budgets: Budgets, (name, amount): &(String, f64)| {
            budgets.with(name, *amount).unwrap_or(budgets)
        };
        self.amounts.iter().fold(Budgets::default(), changed)
    }
}

impl LoadArgs {
    /// Changes what a scene requires and what is left out of it.
    ///
    /// # Errors
    /// A feature that is both required and dropped.
    pub(crate) fn change_features(&self, scene: &mut Scene) -> Result<(), Failure> {
        for feature in &self.required {
            scene.require(*feature).map_err(|why| refused(*feature, why))?;
        }
        for feature in &self.dropped {
            scene.leave_out(*feature).map_err(|why| refused(*feature, why))?;
        }
        Ok(())
    }
}

fn refused(feature: Feature, why: &str) -> Failure {
    Failure::new(Exit::Usage, format!("`{}`: {why}", feature.name()))
}

/// Where plugin libraries come from.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct PluginArgs {
    /// Look for plugin libraries in this folder first; then in those of `LUXEL_PLUGIN_PATH` and of
    /// the configuration
    #[arg(long = "plugin-dir", value_name = "DIR")]
    pub(crate) dirs: Vec<PathBuf>,
    /// Open libraries that plugins.lock does not list: for those who write plugins
    #[arg(long)]
    pub(crate) allow_unlocked_plugins: bool,
    /// Take the built-in classes from this library: for tests and benchmarks
    #[arg(long, hide = true, value_name = "FILE")]
    pub(crate) builtins: Option<PathBuf>,
}

impl PluginArgs {
    /// The same, as it is written on a command line.
    pub(crate) fn words(&self) -> Vec<OsString> {
        let option = |name: &str, path: &PathBuf| [name.into(), path.into()];
        let mut words: Vec<OsString> =
            self.dirs.iter().flat_map(|dir| option("--plugin-dir", dir)).collect();
        words.extend(self.allow_unlocked_plugins.then(|| "--allow-unlocked-plugins".into()));
        words.extend(self.builtins.iter().flat_map(|file| option("--builtins", file)));
        words
    }
}

/// What is rendered and where it goes.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct RenderArgs {
    /// Where the pictures go: OUT.exr and OUT.png [default: the film's `file`, else the scene's
    /// name, in the current folder]
    #[arg(short, long = "output", value_name = "OUT")]
    pub(crate) output: Option<PathBuf>,
    /// Another size, in pixels
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<UVec2>,
    /// Samples per pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..),
        allow_hyphen_values = true)]
    pub(crate) spp: Option<u32>,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub(crate) seed: Option<u32>,
    /// Threads [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = threads)]
    pub(crate) threads: Option<NonZeroUsize>,
    /// Only this part of the picture, in pixels from the upper left
    #[arg(long, value_name = "X,Y,W,H", value_parser = crop)]
    pub(crate) crop: Option<Rect>,
}

impl RenderArgs {
    pub(crate) fn options(&self) -> Options {
        let Self { spp, seed, crop, threads, .. } = *self;
        Options { spp, seed, crop, threads, ..Options::default() }
    }
}

fn budget(text: &str) -> Result<(String, f64), String> {
    let (name, amount) = text.trim().split_once('=').ok_or("expected NAME=N, as in nodes=3e6")?;
    let amount = amount.trim().parse().unwrap_or(f64::NAN);
    Budgets::default().with(name.trim(), amount)?;
    Ok((name.trim().to_owned(), amount))
}

fn assignment(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or("expected NAME=VALUE")?;
    if name.is_empty() {
        return Err("the name is missing before `=`".into());
    }
    Ok((name.to_owned(), value.to_owned()))
}

/// More seconds than a year has are as good as no limit.
pub(crate) const MOST_SECONDS: f64 = 4e7;

/// Side of the largest picture; as the film's schema says.
const MAX_SIDE: u32 = 65536;

pub(crate) fn size(text: &str) -> Result<UVec2, String> {
    let sides = text.split_once(['x', 'X']).map(|(w, h)| (w.parse(), h.parse()));
    match sides {
        Some((Ok(w @ 1..=MAX_SIDE), Ok(h @ 1..=MAX_SIDE))) => Ok(UVec2::new(w, h)),
        _ => Err(format!("expected WIDTHxHEIGHT, each from 1 to {MAX_SIDE}, as in 640x480")),
    }
}

fn layer(text: &str) -> Result<Layer, String> {
    let names = || Layer::ALL.map(Layer::name).join(", ");
    Layer::of_name(text.trim()).ok_or_else(|| format!("expected some of {}", names()))
}

fn feature(text: &str) -> Result<Feature, String> {
    let names = || Feature::ALL.map(Feature::name).join(", ");
    Feature::of_name(text.trim()).ok_or_else(|| format!("expected some of {}", names()))
}

fn requirable(text: &str) -> Result<Feature, String> {
    let feature = feature(text)?;
    feature.unrequirable().map_or(Ok(feature), |why| Err(why.to_owned()))
}

pub(crate) fn droppable(text: &str) -> Result<Feature, String> {
    let feature = feature(text)?;
    feature.dropped()?;
    Ok(feature)
}

fn precision(text: &str) -> Result<Precision, String> {
    Precision::of_word(text).ok_or_else(|| "expected fast, standard or exact".to_owned())
}

fn crop(text: &str) -> Result<Rect, String> {
    let numbers: Result<Vec<u32>, _> = text.split(',').map(|part| part.trim().parse()).collect();
    match numbers.as_deref() {
        Ok(&[x, y, w, h]) if w > 0 && h > 0 => Ok(Rect::new(UVec2::new(x, y), UVec2::new(w, h))),
        _ => Err("expected X,Y,WIDTH,HEIGHT in pixels, as in 100,50,64,64".into()),
    }
}

/// More threads than any machine has cost memory and gain nothing.
const MAX_THREADS: usize = 4096;

/// Reads a number of threads.
pub(crate) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let found = text.parse().ok().filter(|n: &NonZeroUsize| n.get() <= MAX_THREADS);
    found.ok_or_else(|| format!("expected a whole number from 1 to {MAX_THREADS}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn features_are_read_or_refused_with_the_reason() {
        assert_eq!(requirable(" media"), Ok(Feature::Media));
        assert_eq!(droppable("spectral"), Ok(Feature::Spectral));
        assert!(requirable("fog").unwrap_err().contains("light_choice, layers"));
        assert!(requirable("spectral").unwrap_err().contains("film spectral"));
        assert!(droppable("open_surfaces").unwrap_err().contains("drop `media`"));
        let both = vec![Feature::Motion];
        let args = LoadArgs { required: both.clone(), dropped: both, ..LoadArgs::default() };
        let refused = args.change_features(&mut Scene::default()).unwrap_err();
        assert_eq!(refused.message, "`motion`: it is both required and dropped");
        assert_eq!(refused.exit, Exit::Usage);
    }

    #[test]
    fn budgets_are_read_or_refused_with_what_is_known() {
        let amounts = ["nodes=3e6", " steps = 1000000000"].map(|text| budget(text).unwrap());
        let budgets = BudgetArgs { amounts: amounts.to_vec() }.budgets();
        let wanted = Budgets { nodes: 3_000_000, steps: 1_000_000_000, ..Budgets::default() };
        assert_eq!(budgets, wanted);
        assert!(budget("node=3").unwrap_err().contains("did you mean `nodes`?"));
        for bad in ["nodes", "nodes=", "nodes=many", "nodes=0.5", "brackets=1e6"] {
            assert!(budget(bad).is_err(), "{bad}");
        }
        let help = <BudgetArgs as Args>::augment_args(clap::Command::new("a")).render_long_help();
        let help = help.to_string();
        assert!(Budgets::NAMES.iter().all(|name| help.contains(&format!("`{name}`"))), "{help}");
    }

    #[test]
    fn sizes_crops_and_assignments_are_read_or_refused() {
        assert_eq!(size("64x48"), Ok(UVec2::new(64, 48)));
        for bad in ["64", "0x4", "65537x1", "-1x4", "4x", "ax4", ""] {
            assert!(size(bad).is_err(), "{bad}");
        }
        assert_eq!(crop("1, 2,3,4"), Ok(Rect::new(UVec2::new(1, 2), UVec2::new(3, 4))));
        for bad in ["1,2,3", "1,2,0,4", "1,2,3,4,5", "a,b,c,d", "-1,0,4,4"] {
            assert!(crop(bad).is_err(), "{bad}");
        }
        assert_eq!(assignment("a=b=c"), Ok(("a".into(), "b=c".into())));
        assert!(assignment("a").is_err() && assignment("=b").is_err());
        assert!(threads("0").is_err() && threads("5000").is_err() && threads("2").is_ok());
    }
}
