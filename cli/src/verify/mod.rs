//! `luxel verify`: whether what is said of scenes is so.

mod mean;
mod row;
mod run;
mod said;
mod same;

use std::num::NonZeroUsize;
use std::path::PathBuf;

use luxel_core::render::Options;

use self::row::{Row, Verdict};
use self::run::Run;
use crate::args::{self, LoadArgs, PluginArgs};
use crate::exit::{Exit, Failure};
use crate::load;
use crate::report::{self, Form, Stream};

/// Test what scenes say of their pictures
///
/// Renders each scene, as its own sampler says, and holds each `expect` against the picture: a value
/// passes within four standard errors and its tolerance, unless the standard errors are so large that
/// it could hardly have failed (NOISY). Exit code 0 if everything holds, 1 if something does not or
/// a scene expects nothing. Ctrl-C ends early with what was tested and exit code 3.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel verify my.scene
  luxel verify scenes/*.scene --spp 256 --json")]
pub(crate) struct Args {
    /// The scenes
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Samples per pixel
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    spp: Option<u32>,
    /// Seed of the random numbers
    #[arg(long, value_name = "N")]
    seed: Option<u32>,
    /// Threads [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = args::threads)]
    threads: Option<NonZeroUsize>,
    /// A JSON object per line: for each value what is expected, what was measured, and the verdict
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    load: LoadArgs,
    #[command(flatten)]
    plugins: PluginArgs,
}

impl Args {
    fn form(&self) -> Form {
        if self.json { Form::Json } else { Form::Text }
    }
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let plugins = load::registry(&args.plugins)?;
    plugins.notes.tell(args.form(), Stream::Error)?;
    let Args { spp, seed, threads, .. } = *args;
    let options = Options { spp, seed, threads, ..Options::default() };
    let run = Run::new(plugins, options)?;
    let mut rows = vec![];
    let done = files(args, &run, &mut rows);
    tell(args, &rows)?;
    let holds = rows.iter().all(|row| row.verdict == Verdict::Holds);
    Ok(if done? && holds { Exit::Fine } else { Exit::Input })
}

/// Whether every scene could be tested.
fn files(args: &Args, run: &Run, rows: &mut Vec<Row>) -> Result<bool, Failure> {
    let mut fine = true;
    for file in &args.files {
        match said::test(file, &args.load, run, args.form(), rows) {
            Ok(()) => {}
            // One scene's mistake keeps no other from being tested.
            Err(failure) if failure.exit == Exit::Input => {
                report::failure(&failure);
                fine = false;
            }
            Err(failure) => return Err(failure),
        }
    }
    Ok(fine)
}

fn tell(args: &Args, rows: &[Row]) -> Result<(), Failure> {
    if args.json {
        return rows.iter().try_for_each(|row| report::out(&format!("{}\n", row.json())));
    }
    if rows.is_empty() {
        return Ok(());
    }
    let off = rows.iter().filter(|row| row.verdict != Verdict::Holds).count();
    let verdict = match off {
        0 => format!("all {} hold", rows.len()),
        _ => format!("{off} of {} do not hold", rows.len()),
    };
    report::out(&format!("{}\n{verdict}\n", row::columns(rows)))
}
