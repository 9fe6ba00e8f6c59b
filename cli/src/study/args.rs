//! The command line of `luxel study`.

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

use glam::UVec2;

use super::plan::LEAST_SEEDS;
use super::sweep::{Change, Sweep, sweep};
use crate::args::{self, LoadArgs, PluginArgs};
use crate::goal;
use crate::report::Form;

/// What is swept unless the command line says it.
const USUAL: &str = "spp,depth,rr,sampler,integrator,precision,color";

/// Measure what speed costs in accuracy, for this scene
///
/// Renders the scene small, with one setting after another changed, several times with independent
/// random numbers, and takes apart what scatters and what is wrong however many samples there are.
/// Tells how the error falls, what each setting costs, which reaches the target soonest, renders that 16
/// to 128 times to verify it, and prints the lines to paste. Errors are of luminance, relative to the pixel or to a
/// tenth of the picture's mean, root mean square. They are against the scene as it is with 64 times the
/// samples, or against --truth; what the scene as it is gets wrong by itself only the latter tells, or,
/// of its mean, the scene's own `expect mean`.
///
/// `--drop FEATURE` measures what leaving a feature out adds to the error and saves of the time.
///
/// Begins by measuring two scenes whose variance and bias are known exactly. Ctrl-C keeps what has been
/// measured (exit code 3); an error that is not for certain within 10 % of its target or below it, by two
/// standard errors, also ends with 3.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel study scenes/cornell.scene
  luxel study scenes/cornell.scene --sweep sampler,depth=2,4,8,spp=16,64 --target 1% -o study
  luxel study scenes/caustic.scene --time 2min --json
  luxel study scenes/fog.scene --drop media
  luxel study furnace.scene --truth 2
  luxel study --calibrate")]
pub(crate) struct Args {
    /// The scene
    #[arg(required_unless_present = "calibrate")]
    pub(super) file: Option<PathBuf>,
    /// What is varied, one thing at a time, each perhaps with its values: spp, depth, rr (the event from
    /// which Russian roulette ends paths), sampler, integrator, precision, color, filter, drop (features
    /// that are left out) [default: spp,depth,rr,sampler,integrator,precision,color; with --drop: spp]
    #[arg(long = "sweep", value_name = "WHAT", value_parser = sweep)]
    given: Option<Sweep>,
    /// The error to be reached, as in 1% or relrmse=1%
    #[arg(long, value_name = "SHARE", value_parser = target, default_value = "2%")]
    pub(super) target: f64,
    /// Size of the pictures [default: the scene's shape, the longer side 64 pixels]
    #[arg(long, value_name = "WxH", value_parser = args::size)]
    pub(super) size: Option<UVec2>,
    /// Pictures of each kind, each with random numbers of its own
    #[arg(long, value_name = "K", default_value_t = 16)]
    #[arg(value_parser = clap::value_parser!(u32).range(i64::from(LEAST_SEEDS)..=1024))]
    pub(super) seeds: u32,
    /// Seed of the first picture
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub(super) seed: u32,
    /// Keep all of it within this time, as in 60s or 5min, by fewer samples, then by leaving out what was
    /// named last, and only then by fewer than 16 seeds
    #[arg(long, value_name = "DURATION", value_parser = goal::duration)]
    pub(super) time: Option<Duration>,
    /// The luminance that every pixel truly has, instead of a measured reference
    #[arg(long, value_name = "Y", value_parser = luminance)]
    pub(super) truth: Option<f64>,
    /// Write OUT.csv, OUT.json and the plot OUT.svg
    #[arg(short, long = "output", value_name = "OUT")]
    pub(super) output: Option<PathBuf>,
    /// Only measure the scenes of which everything is known
    #[arg(long, conflicts_with = "file")]
    pub(super) calibrate: bool,
    /// Threads [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = args::threads)]
    pub(super) threads: Option<NonZeroUsize>,
    /// Everything as one JSON object on standard output
    #[arg(long)]
    pub(super) json: bool,
    #[command(flatten)]
    load: LoadArgs,
    #[command(flatten)]
    pub(super) plugins: PluginArgs,
}

impl Args {
    /// What is varied: what is said or usual, and what is dropped.
    pub(super) fn sweep(&self) -> Sweep {
        let usual = if self.load.dropped.is_empty() { USUAL } else { "spp" };
        let usual = || sweep(usual).expect("what is usual can be swept");
        let mut found = self.given.clone().unwrap_or_else(usual);
        found.changes.extend(self.load.dropped.iter().copied().map(Change::dropping));
        found
    }

    /// How the scene is read: as it is, with all that it requires.
    pub(super) fn load(&self) -> LoadArgs {
        LoadArgs { dropped: vec![], ..self.load.clone() }
    }

    pub(super) fn form(&self) -> Form {
        if self.json { Form::Json } else { Form::Text }
    }
}

fn target(text: &str) -> Result<f64, String> {
    goal::share(text.strip_prefix("relrmse=").unwrap_or(text))
}

fn luminance(text: &str) -> Result<f64, String> {
    let found = text.parse().ok().filter(|y: &f64| *y > 0.0 && y.is_finite());
    found.ok_or_else(|| "expected a luminance above 0, as in 0.5".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_and_truths_are_read_or_refused() {
        assert_eq!((target("relrmse=1%"), target("0.02")), (Ok(0.01), Ok(0.02)));
        assert!(target("mse=1%").is_err() && target("0").is_err());
        assert_eq!(luminance("0.5"), Ok(0.5));
        for bad in ["0", "-1", "inf", "NaN", "bright"] {
            assert!(luminance(bad).unwrap_err().contains("above 0"), "{bad}");
        }
    }
}
