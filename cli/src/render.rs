//! `luxel render`: a scene to a picture.

use std::path::PathBuf;
use std::sync::Arc;

use luxel_core::render::{Control, Outcome};

use crate::args::{LoadArgs, PluginArgs, RenderArgs};
use crate::exit::{Exit, Failure};
use crate::isolate::{self, Beat, IsolateArgs, Phase};
use crate::load::{self, Course, Loaded};
use crate::measure::{self, Measured};
use crate::output::Output;
use crate::report::{self, Form, Stream};
use crate::summary::Summary;
use crate::{interrupt, picture};

/// Render a scene to OUT.exr and OUT.png
///
/// The EXR holds linear sRGB radiance (R, G, B), its standard error (SE.R, SE.G, SE.B) and the
/// number of samples (N) of each pixel, with the settings as an attribute. The PNG shows it exposed.
/// Ctrl-C ends early with a valid picture of what was measured and exit code 3; once more, two
/// seconds later, gives up what has not been saved by then. No file is ever left half written.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel render scenes/cornell.scene
  luxel render scenes/cornell.scene -o small --size 256x256 --spp 64
  luxel render scenes/cornell.scene --crop 100,100,64,64 --json
  luxel render scenes/cornell.scene --isolate")]
pub(crate) struct Args {
    /// The scene
    file: PathBuf,
    #[command(flatten)]
    render: RenderArgs,
    #[command(flatten)]
    load: LoadArgs,
    #[command(flatten)]
    plugins: PluginArgs,
    #[command(flatten)]
    isolate: IsolateArgs,
    /// Say nothing but errors
    #[arg(short, long, conflicts_with = "json")]
    quiet: bool,
    /// The summary as one JSON object on standard output, diagnostics as JSON lines on standard error
    #[arg(long)]
    json: bool,
    /// Exit with 4 if a sample is not finite
    #[arg(long)]
    strict: bool,
}

impl Args {
    fn form(&self) -> Form {
        if self.json { Form::Json } else { Form::Text }
    }
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let Some(beat) = args.isolate.beat() else {
        let open = || load::look_at_libraries(&args.plugins).map_or(vec![], |p| p.refused());
        return isolate::supervise(&args.file, &args.isolate, args.form(), open);
    };
    let _end = beat.until_the_end();
    render(args, &beat)
}

fn render(args: &Args, beat: &Beat) -> Result<Exit, Failure> {
    let (plugins, form) = (load::registry_telling(&args.plugins, beat)?, args.form());
    plugins.notes.tell(form, Stream::Error)?;
    let control = Arc::new(Control::default());
    let stop = control.clone();
    let guard = interrupt::Guard::default();
    let course = Course { beat: beat.clone(), line: !args.quiet, ..Course::default() };
    guard.loading(&course.watch);
    let interrupt = guard.on_ctrl_c(move || {
        stop.cancel();
        report::aside("interrupted: what was measured will be written; Ctrl-C again gives it up");
    })?;
    let loaded = load::load(&args.file, &args.load, args.render.size, &plugins, &course)?;
    report::diagnostics(&loaded.diagnostics, &loaded.sources, form, Stream::Error)?;
    let Loaded { stage: Some(stage), files, sources, .. } = loaded else {
        return Ok(Exit::Input);
    };

    let options = args.render.options();
    measure::window(&stage, &options)?;
    let film_file = stage.film.file.as_deref();
    let output = Output::choose(args.render.output.as_deref(), film_file, &args.file)?;
    guard.measuring();
    beat.rendering(&control, interrupt);
    output.check(&files)?;
    beat.phase(Phase::Rendering);
    let line = !args.quiet;
    let of = (args.file.as_path(), &stage);
    let measured = measure::measure(of, &options, &control, line, &mut |_, _| {})?;
    let Measured { film, outcome, seconds } = measured;
    if outcome == Outcome::Failed {
        // What was measured may be wrong: there is no picture of it.
        report::diagnostics(&stage.failures(), &sources, form, Stream::Error)?;
        return Ok(Exit::Input);
    }
    let saving = guard.saving();
    beat.phase(Phase::Saving);
    let samples = control.samples_done();
    if samples == 0 {
        let message = "interrupted before anything was measured: no picture was written";
        return Err(Failure::new(Exit::Incomplete, message));
    }
    let summary = Summary::new((&stage, &files), &options, (&film, outcome), (seconds, samples));
    picture::write(&output, &film, &stage.film, &summary.notes())?;
    drop(saving);
    tell(args, &summary, &output)?;
    Ok(match outcome {
        _ if args.strict && summary.bad > 0 => Exit::Ours,
        Outcome::Cancelled | Outcome::Failed => Exit::Incomplete,
        Outcome::Complete => Exit::Fine,
    })
}

fn tell(args: &Args, summary: &Summary, output: &Output) -> Result<(), Failure> {
    if summary.bad > 0 {
        let message = format!("{} samples were not finite and were left out", summary.bad);
        report::warning(&message);
    }
    if args.json {
        report::out(&format!("{}\n", summary.json(output)))
    } else if args.quiet {
        Ok(())
    } else {
        report::out(&summary.text(output))
    }
}
