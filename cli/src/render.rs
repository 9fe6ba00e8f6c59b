//! `luxel render`: a scene to a picture.

use std::path::PathBuf;
use std::sync::Arc;

use luxel_core::film::Film;
use luxel_core::render::{Control, Options, Outcome, Reached, can_go_on};
use luxel_core::stage::Stage;

use crate::args::{LoadArgs, PluginArgs, RenderArgs};
use crate::checkpoint::{Checkpoint, CheckpointArgs};
use crate::exit::{Exit, Failure};
use crate::goal::GoalArgs;
use crate::interrupt::Guard;
use crate::isolate::{self, Beat, IsolateArgs, Phase};
use crate::load::{self, Course, Loaded};
use crate::measure::{self, Measured};
use crate::output::Output;
use crate::picture;
use crate::report::{self, Form, Stream};
use crate::summary::Summary;

/// Render a scene to OUT.exr and OUT.png
///
/// The EXR holds linear sRGB radiance (R, G, B), its standard error (SE.R, SE.G, SE.B) and the
/// number of samples (N) of each pixel, with the settings as an attribute. The PNG shows it exposed.
/// Ctrl-C ends early with a valid picture of what was measured and exit code 3; once more, two
/// seconds later, gives up what has not been saved by then. No file is ever left half written.
///
/// What has been measured is kept in OUT.checkpoint every minute and after Ctrl-C; --resume goes on
/// with it, to the same bits as if nothing had come between. With --error or --time the samples go
/// where they are needed; an error that is not reached ends with exit code 3.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel render scenes/cornell.scene
  luxel render scenes/cornell.scene -o small --size 256x256 --spp 64
  luxel render scenes/cornell.scene --error 1%
  luxel render scenes/cornell.scene --time 30s
  luxel render scenes/cornell.scene --resume
  luxel render scenes/cornell.scene --aov albedo,normal,depth
  luxel render scenes/motion.scene --drop motion
  luxel render scenes/cornell.scene --crop 100,100,64,64 --json
  luxel render scenes/cornell.scene --isolate")]
pub(crate) struct Args {
    /// The scene
    file: PathBuf,
    #[command(flatten)]
    render: RenderArgs,
    #[command(flatten)]
    goal: GoalArgs,
    #[command(flatten)]
    checkpoint: CheckpointArgs,
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

    fn options(&self) -> Options {
        Options { goal: self.goal.goal(), ..self.render.options() }
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
    let guard = Guard::default();
    let course = Course { beat: beat.clone(), line: !args.quiet, ..Course::default() };
    guard.loading(&course.watch);
    let interrupt = guard.on_ctrl_c(move || {
        stop.cancel();
        report::aside("interrupted: what was measured will be written; Ctrl-C again gives it up");
    })?;
    let loaded = load::load(&args.file, &args.load, args.render.size, &plugins, &course)?;
    report::diagnostics(&loaded.diagnostics, &loaded.sources, form, Stream::Error)?;
    let Some(stage) = &loaded.stage else { return Ok(Exit::Input) };

    let options = args.options();
    let empty = measure::empty(stage, &options)?;
    let film_file = stage.film.file.as_deref();
    let output = Output::choose(args.render.output.as_deref(), film_file, &args.file)?;
    guard.measuring();
    beat.rendering(&control, interrupt);
    output.check(&loaded.files)?;
    let (of, libraries) = ((stage, &loaded), plugins.hash());
    let how = (&options, empty.window);
    let mut kept = Checkpoint::new(args.checkpoint, &output, of, &libraries, how);
    let film = begin(args, stage, empty, &kept)?;
    beat.phase(Phase::Rendering);
    let of = (args.file.as_path(), stage);
    let mut look = |film: &Film, _: Reached| keep_sometimes(&mut kept, film, (&guard, beat));
    let measured = measure::measure(of, film, &options, &control, !args.quiet, &mut look)?;
    if measured.outcome == Outcome::Failed {
        // What was measured may be wrong: there is no picture of it.
        report::diagnostics(&stage.failures(), &loaded.sources, form, Stream::Error)?;
        return Ok(Exit::Input);
    }
    let _whole = guard.saving();
    beat.phase(Phase::Saving);
    save(args, (stage, &loaded), (&measured, control.samples_done()), &output, &mut kept)
}

/// Writes the picture, and what is needed to go on with it if it is not whole.
fn save(
    args: &Args,
    (stage, loaded): (&Stage, &Loaded),
    (measured, samples): (&Measured, u64),
    output: &Output,
    kept: &mut Checkpoint,
) -> Result<Exit, Failure> {
    let Measured { film, outcome, seconds } = measured;
    if film.samples() == 0 && samples == 0 {
        let message = "interrupted before anything was measured: no picture was written";
        return Err(Failure::new(Exit::Incomplete, message));
    }
    let (of, options) = ((stage, &loaded.files), args.options());
    let summary = Summary::new(of, &options, (film, *outcome), (*seconds, samples));
    picture::write(output, film, &stage.film, &summary.notes())?;
    let is_whole = *outcome == Outcome::Complete && summary.is_reached();
    if is_whole {
        kept.remove();
    } else if kept.keep(film)? {
        report::aside("--resume goes on from here");
    }
    tell(args, &summary, output)?;
    Ok(match is_whole {
        _ if args.strict && summary.bad > 0 => Exit::Ours,
        true => Exit::Fine,
        false => Exit::Incomplete,
    })
}

/// The film to render on: one that was left, if that is wanted.
fn begin(args: &Args, stage: &Stage, empty: Film, kept: &Checkpoint) -> Result<Film, Failure> {
    let place = kept.place().display();
    if !args.checkpoint.resume {
        if kept.exists() {
            report::aside(&format!(
                "`{place}` is of a picture that was left: --resume goes on with it"
            ));
        }
        return Ok(empty);
    }
    if !can_go_on(stage) {
        let message = "an integrator that owns the whole picture cannot go on with one";
        return Err(Failure::new(Exit::Input, message).help("render without --resume"));
    }
    let left = kept.read()?;
    if left.is_none() {
        report::warning(&format!("there is no `{place}`: the render begins anew"));
    }
    Ok(left.unwrap_or(empty))
}

/// Keeps the film if it is time for it. What cannot be kept is told, and nothing else is lost.
fn keep_sometimes(kept: &mut Checkpoint, film: &Film, (guard, beat): (&Guard, &Beat)) {
    if !kept.is_due() {
        return;
    }
    let whole = guard.saving();
    beat.phase(Phase::Saving);
    if let Err(failure) = kept.keep(film) {
        report::warning(&failure.message);
    }
    drop(whole);
    guard.measuring();
    beat.phase(Phase::Rendering);
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
