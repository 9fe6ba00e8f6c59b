//! `luxel render`: a scene to a picture.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use luxel_core::film::Film;
use luxel_core::render::{Control, Options, Outcome, Reached, can_go_on, is_owned};
use luxel_core::stage::Stage;

use crate::args::{LoadArgs, PluginArgs, RenderArgs};
use crate::checkpoint::{Asked, Before, Checkpoint, CheckpointArgs, Left};
use crate::exit::{Exit, Failure};
use crate::goal::GoalArgs;
use crate::interrupt::Guard;
use crate::isolate::{self, Beat, IsolateArgs, Phase};
use crate::load::{self, Course};
use crate::measure::{self, Measured};
use crate::output::Output;
use crate::picture;
use crate::report::{self, Form, Stream};
use crate::summary::{Summary, Took};

/// Render a scene to OUT.exr and OUT.png
///
/// The EXR holds linear sRGB radiance (R, G, B), its standard error (SE.R, SE.G, SE.B) and the
/// number of samples (N) of each pixel, with the settings as an attribute. The PNG shows it exposed.
/// Ctrl-C ends early with a valid picture of what was measured and exit code 3; once more, two
/// seconds later, gives up what has not been saved by then. No file is ever left half written.
///
/// What has been measured is kept in OUT.checkpoint about every minute and after Ctrl-C; --resume goes
/// on with it, to the same bits as if nothing had come between. With --error or --time the samples go
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
  luxel render scenes/cornell.scene --budget nodes=3e6,steps=1e9
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
    /// The summary as one JSON object on standard output, diagnostics and failures as JSON lines on
    /// standard error
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

    let empty = measure::empty(stage, &args.options())?;
    let film_file = stage.film.file.as_deref();
    let output = Output::choose(args.render.output.as_deref(), film_file, &args.file)?;
    guard.measuring();
    beat.on_stop(interrupt);
    beat.rendering(&control);
    output.check(&loaded.files)?;
    let (of, libraries) = ((stage, &loaded), plugins.hash());
    let how = (&args.options(), empty.window);
    let mut kept = Checkpoint::new(args.checkpoint, &output, of, &libraries, how)?;
    let (film, options) = begin(args, stage, empty, &mut kept)?;
    beat.phase(Phase::Rendering);
    let of = (args.file.as_path(), stage);
    let start = Instant::now();
    let mut look =
        |film: &Film, _: Reached| keep_sometimes(&mut kept, (film, start), (&guard, beat));
    let measured = measure::measure(of, film, &options, &control, !args.quiet, &mut look)?;
    if measured.outcome == Outcome::Failed {
        // What was measured may be wrong: there is no picture of it.
        report::diagnostics(&stage.failures(), &loaded.sources, form, Stream::Error)?;
        return Ok(Exit::Input);
    }
    let _whole = guard.saving();
    beat.phase(Phase::Saving);
    let Measured { film, outcome, seconds } = &measured;
    let of = (stage, &loaded.files, &loaded.origin);
    let took = Took { seconds: *seconds, before: kept.before(), samples: control.samples_done() };
    let summary = Summary::new(of, &options, (film, *outcome), took);
    save(args, (stage, &summary), &measured, &output, &mut kept)
}

/// Writes the picture, and what is needed to go on with it if it is not whole.
fn save(
    args: &Args,
    (stage, summary): (&Stage, &Summary),
    Measured { film, outcome, seconds }: &Measured,
    output: &Output,
    kept: &mut Checkpoint,
) -> Result<Exit, Failure> {
    if film.pixels().all(|(_, pixel)| pixel.n + pixel.bad == 0) {
        let message = "interrupted before anything was measured: no picture was written";
        return Err(Failure::new(Exit::Incomplete, message));
    }
    let written = picture::write(output, film, &stage.film, &summary.notes());
    let is_whole = *outcome == Outcome::Complete && summary.is_reached();
    if is_whole && written.is_ok() {
        kept.remove();
    } else {
        match kept.keep(film, *seconds) {
            Ok(true) => report::aside("--resume goes on from here"),
            Ok(false) => {}
            Err(failure) => report::warning(&failure.message),
        }
    }
    written?;
    tell(args, summary, output)?;
    Ok(match is_whole {
        _ if args.strict && summary.bad > 0 => Exit::Ours,
        true => Exit::Fine,
        false => Exit::Incomplete,
    })
}

/// The film to render on, one that was left if that is wanted, and what it is to become.
fn begin(
    args: &Args,
    stage: &Stage,
    empty: Film,
    kept: &mut Checkpoint,
) -> Result<(Film, Options), Failure> {
    let options = args.options();
    if is_owned(stage) && !(stage.film.layers.is_empty() && stage.lights.groups.is_empty()) {
        let message = "an integrator that owns the whole picture records nothing beside colour";
        report::warning(message);
    }
    if !can_go_on(stage) && args.checkpoint.are_missed(options.goal) {
        let message = "this integrator owns the whole picture, and its passes depend on each other: nothing is \
                       kept to go on with, also not after Ctrl-C";
        report::warning(message);
    }
    if !args.checkpoint.resume {
        if kept.left()? == Left::Same {
            let place = kept.place().display();
            let message = format!("`{place}` is of this picture, left unfinished: it begins anew");
            report::warning(&format!("{message}; --resume would go on with it"));
        }
        return Ok((empty, options));
    }
    if !can_go_on(stage) {
        let message = "this integrator owns the whole picture, and cannot go on with one";
        return Err(Failure::new(Exit::Input, message).help("render without --resume"));
    }
    if let Some(before) = kept.read()? {
        return go_on(before, &empty, (stage, options), kept);
    }
    report::warning(&format!("there is no `{}`: it begins anew", kept.place().display()));
    Ok((empty, options))
}

/// A film that was left, and what it is to become: what it was to be, unless something is asked for.
fn go_on(
    Before { mut film, asked: before, seconds }: Before,
    empty: &Film,
    (stage, mut options): (&Stage, Options),
    kept: &mut Checkpoint,
) -> Result<(Film, Options), Failure> {
    let place = kept.place().display().to_string();
    let fits = film.size == empty.size && film.window == empty.window && film.holds == empty.holds;
    if !fits {
        let message = format!("cannot go on with `{place}`: it is damaged");
        return Err(Failure::new(Exit::Input, message));
    }
    if options.spp.is_none() && !options.goal.is_some() {
        before.ask(&mut options);
    }
    let (has, asked) = (film.most_samples(), options.samples(stage));
    if has > asked {
        let message =
            format!("`{place}` has {has} samples of a pixel, more than the {asked} asked for");
        return Err(Failure::new(Exit::Input, message).help(format!("--spp {has}, or more")));
    }
    if Asked::of(&options) != before || options.goal.time.is_some() {
        film.ask_anew();
    }
    kept.asks(Asked::of(&options), seconds);
    Ok((film, options))
}

/// Keeps the film if it is time for it. What cannot be kept is told, and nothing else is lost.
fn keep_sometimes(
    kept: &mut Checkpoint,
    (film, start): (&Film, Instant),
    (guard, beat): (&Guard, &Beat),
) {
    if !kept.is_due() {
        return;
    }
    let whole = guard.saving();
    beat.phase(Phase::Saving);
    if let Err(failure) = kept.keep(film, start.elapsed().as_secs_f64()) {
        report::warning(&failure.message);
    }
    guard.measuring();
    drop(whole);
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
