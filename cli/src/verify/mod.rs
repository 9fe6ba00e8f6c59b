//! `luxel verify`: whether the renderer is right, and whether what is said of scenes is so.

mod mean;
mod published;
mod row;
mod run;
mod said;
mod same;
mod truths;

use std::num::NonZeroUsize;
use std::path::PathBuf;

use luxel_core::render::Options;
use luxel_core::stage::Stage;

use self::row::{Row, Verdict};
pub(crate) use self::run::Run;
use crate::args::{self, LoadArgs, PluginArgs};
use crate::exit::{Exit, Failure};
use crate::load;
use crate::report::{self, Form, Stream};

/// Test the renderer against mathematics, and scenes against what they say of their pictures
///
/// Without a scene, tests every closed-form truth that the program carries: pictures, and functions of
/// light and colour. Of a scene, renders it as its own sampler says, and holds each `expect` against
/// the picture. A value passes within four standard errors and its tolerance, unless the standard
/// errors are so large that it could hardly have failed (NOISY). z is how many standard errors it is off;
/// beyond four, only by how many beyond the tolerance, and nothing where that lets it pass. Exit code 0
/// if everything holds, 1 if something does not or no scene expects anything. Ctrl-C ends early with
/// what was tested and exit code 3.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel verify
  luxel verify --precision exact --only furnace
  luxel verify --write docs/accuracy.md
  luxel verify my.scene
  luxel verify scenes/*.scene --spp 256 --json")]
pub(crate) struct Args {
    /// The scenes [default: the program's own truths]
    files: Vec<PathBuf>,
    /// Of the program's own truths, those alone whose name begins so
    #[arg(long, value_name = "PREFIX", conflicts_with = "files")]
    only: Option<String>,
    /// Write the table of the program's own truths into a document, between the lines
    /// `<!-- begin: truths -->` and `<!-- end: truths -->`
    #[arg(long, value_name = "DOCUMENT", conflicts_with_all = ["files", "only", "precision"])]
    #[arg(conflicts_with_all = ["spp", "seed"])]
    write: Option<PathBuf>,
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
    if args.files.is_empty() && !(args.load.set.is_empty() && args.load.allow_path.is_empty()) {
        let message = "--set and --allow-path are for a scene, and none is given";
        return Err(Failure::new(Exit::Usage, message).help("luxel verify --help"));
    }
    args.write.as_deref().map_or(Ok(()), published::check)?;
    let plugins = load::registry(&args.plugins)?;
    plugins.notes.tell(args.form(), Stream::Error)?;
    let Args { spp, seed, threads, .. } = *args;
    let options = Options { spp, seed, threads, ..Options::default() };
    let run = Run::new(plugins, options)?;
    let mut rows = vec![];
    let done = match args.files.as_slice() {
        [] => own_truths(args, &run, &mut rows).map(|()| 0),
        files => scenes(files, args, &run, &mut rows),
    };
    tell(args, &rows, done.as_ref().map_or(0, |untested| *untested))?;
    if let (Some(path), Ok(_)) = (&args.write, &done) {
        let _whole = run.guard.saving();
        published::write(path, &rows)?;
    }
    let holds = rows.iter().all(|row| row.verdict == Verdict::Holds);
    Ok(if done? == 0 && holds { Exit::Fine } else { Exit::Input })
}

/// One of the program's own scenes with some parameters set, ready.
///
/// # Errors
/// A scene that the classes at hand cannot make.
pub(crate) fn own_scene(name: &str, set: &[(String, String)], run: &Run) -> Result<Stage, Failure> {
    truths::stage(name, set, run)
}

fn own_truths(args: &Args, run: &Run, rows: &mut Vec<Row>) -> Result<(), Failure> {
    let only = args.only.as_deref().unwrap_or_default();
    truths::test(only, args.load.precision, run, rows)?;
    if rows.is_empty() {
        let message = format!("no truth has a name that begins with `{only}`");
        return Err(Failure::new(Exit::Usage, message).help("`luxel verify` shows them all"));
    }
    Ok(())
}

/// How many scenes could not be tested.
fn scenes(
    files: &[PathBuf],
    args: &Args,
    run: &Run,
    rows: &mut Vec<Row>,
) -> Result<usize, Failure> {
    let (mut untested, mut silent) = (0, 0);
    for file in files {
        match said::test(file, &args.load, run, args.form(), rows) {
            Ok(true) => {}
            Ok(false) => silent += 1,
            // One scene's mistake keeps no other from being tested.
            Err(failure) if failure.exit == Exit::Input => {
                report::failure(&failure);
                untested += 1;
            }
            Err(failure) => return Err(failure),
        }
    }
    if silent == files.len() {
        let message = "no scene expects anything of its picture";
        return Err(Failure::new(Exit::Input, message)
            .help("say what is true of it, as in `expect mean = 0.5 ± 0.01`"));
    }
    Ok(untested)
}

fn tell(args: &Args, rows: &[Row], untested: usize) -> Result<(), Failure> {
    if args.json {
        return rows.iter().try_for_each(|row| report::out(&format!("{}\n", row.json())));
    }
    if rows.is_empty() {
        return Ok(());
    }
    let of = |verdict| rows.iter().filter(|row| row.verdict == verdict).count();
    let noisy = of(Verdict::Noisy);
    let off = rows.len() - of(Verdict::Holds) - noisy;
    let verdict = match (off, noisy) {
        (0, 0) => format!("all {} hold", rows.len()),
        (_, 0) => format!("{off} of {} do not hold", rows.len()),
        (0, _) => format!("{noisy} of {} are too noisy to tell", rows.len()),
        _ => format!("{off} of {} do not hold, {noisy} are too noisy to tell", rows.len()),
    };
    let times = rows.iter().filter(|row| row.verdict == Verdict::Noisy).map(Row::times);
    let more = match times.fold(0.0, f64::max) {
        times if times.is_finite() && times > 0.0 => {
            format!("; {:.0} times the samples would (--spp)", times.ceil())
        }
        _ => String::new(),
    };
    let rest = match untested {
        0 => String::new(),
        _ => format!("; {untested} of {} scenes could not be tested", args.files.len()),
    };
    report::out(&format!("{}\n{verdict}{more}{rest}\n", row::columns(rows)))
}
