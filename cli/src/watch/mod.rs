//! `luxel watch`: render again whenever a file that the scene reads is saved.

mod changes;

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use luxel_core::render::{Control, Options, Outcome};
use luxel_core::stage::Stage;

use crate::args::{LoadArgs, PluginArgs, RenderArgs};
use crate::exit::{Exit, Failure};
use crate::files::{DiskFiles, look};
use crate::interrupt::Guard;
use crate::libraries::{Plugins, Session, Surroundings};
use crate::load::{self, Loaded};
use crate::measure::{self, Measured};
use crate::output::Output;
use crate::picture;
use crate::report::{self, Form, Stream};
use crate::summary::Summary;
use changes::{Changes, Wake};

/// Render a scene again whenever it, or a file that it reads, is saved
///
/// A save during a render ends that render. A save that changes no byte does nothing. After a
/// mistake the last good picture stays. Ctrl-C ends with code 0.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel watch scenes/cornell.scene
  luxel watch scenes/cornell.scene -o small --size 320x320 --spp 16")]
pub(crate) struct Args {
    /// The scene
    file: PathBuf,
    #[command(flatten)]
    render: RenderArgs,
    #[command(flatten)]
    load: LoadArgs,
    #[command(flatten)]
    plugins: PluginArgs,
    /// Say nothing but errors
    #[arg(short, long)]
    quiet: bool,
}

/// The render in flight, so that Ctrl-C and saves can end it.
type Current = Arc<Mutex<Arc<Control>>>;

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let (mut session, surroundings) = (Session::new(), Surroundings::of_process());
    let mut plugins = session.refresh(&args.plugins, &surroundings)?;
    plugins.notes.tell(Form::Text, Stream::Error)?;
    let (mut changes, waker) = Changes::new()?;
    let current = Current::default();
    let stopped = current.clone();
    let guard = Guard::default();
    guard.on_ctrl_c(move || {
        let _ = waker.send(Wake::Stop);
        stopped.lock().unwrap_or_else(PoisonError::into_inner).cancel();
    })?;
    let mut last_good: Option<Stage> = None;
    changes.arm([args.file.as_path()])?;
    loop {
        let files = match load::load(
            &args.file,
            &args.load,
            args.render.size,
            &plugins,
            last_good.as_ref(),
        ) {
            Ok(loaded) => take(loaded, &plugins, &mut last_good, &mut changes)?,
            // A panic in a plugin ends this attempt, not the watch.
            Err(failure) => {
                report::failure(&failure);
                let libraries = plugins.watched.keys().map(PathBuf::as_path);
                changes.expect_news(libraries.chain([args.file.as_path()]))?;
                None
            }
        };
        let go_on = match (&last_good, &files) {
            (Some(stage), Some(files)) => {
                one(args, (stage, files), (&current, &guard), &mut changes)
            }
            _ => changes.wait(),
        };
        if !go_on {
            report::note("watching has ended");
            return Ok(Exit::Fine);
        }
        renew(&mut plugins, &mut session, (&args.plugins, &surroundings))?;
    }
}

/// Opens libraries anew if one has changed, or what is trusted has.
///
/// # Errors
/// If standard error cannot be written.
fn renew(
    plugins: &mut Plugins,
    session: &mut Session,
    (args, surroundings): (&PluginArgs, &Surroundings),
) -> Result<(), Failure> {
    if plugins.watched.iter().all(|(path, seen)| look(path) == *seen) {
        return Ok(());
    }
    match session.refresh(args, surroundings) {
        Ok(renewed) => {
            *plugins = renewed;
            plugins.notes.tell(Form::Text, Stream::Error)
        }
        // A lock or configuration that cannot be understood leaves everything as it was.
        Err(failure) => {
            report::failure(&failure);
            let seen = |path: &PathBuf| (path.clone(), look(path));
            plugins.watched = plugins.watched.keys().map(seen).collect();
            Ok(())
        }
    }
}

/// Tells what was found and watches what was asked for. The files, if there is a new stage.
fn take(
    loaded: Loaded,
    plugins: &Plugins,
    last_good: &mut Option<Stage>,
    changes: &mut Changes,
) -> Result<Option<DiskFiles>, Failure> {
    let mut watched = loaded.files.asked();
    watched.extend(plugins.watched.clone());
    changes.expect(watched)?;
    report::diagnostics(&loaded.diagnostics, &loaded.sources, Form::Text, Stream::Error)?;
    let Loaded { stage: Some(stage), files, .. } = loaded else { return Ok(None) };
    *last_good = Some(stage);
    Ok(Some(files))
}

/// Renders until done, or until a save or Ctrl-C; then waits for the next one. False at the end.
fn one(
    args: &Args,
    scene: (&Stage, &DiskFiles),
    (current, guard): (&Current, &Guard),
    changes: &mut Changes,
) -> bool {
    let control = Arc::new(Control::default());
    current.lock().unwrap_or_else(PoisonError::into_inner).clone_from(&control);
    std::thread::scope(|scope| {
        let rendering = scope.spawn(|| {
            if let Err(failure) = render(args, scene, (&control, guard)) {
                report::failure(&failure);
            }
        });
        let go_on = changes.wait();
        control.cancel();
        // What it has to say it has said; a panic was caught and told inside.
        let _ = rendering.join();
        go_on
    })
}

fn render(
    args: &Args,
    scene: (&Stage, &DiskFiles),
    (control, guard): (&Control, &Guard),
) -> Result<(), Failure> {
    let (stage, files) = scene;
    let film_file = stage.film.file.as_deref();
    let output = Output::choose(args.render.output.as_deref(), film_file, &args.file)?;
    output.check(files)?;
    guard.measuring();
    let options = args.render.options();
    let of = (args.file.as_path(), stage);
    if options.samples(stage) > COARSE {
        let coarse = Options { spp: Some(1), ..options.clone() };
        let first = measure::measure(of, &coarse, control, false)?;
        if first.outcome == Outcome::Complete {
            let _whole = guard.saving();
            picture::preview(&output, &first.film, &stage.film)?;
        }
    }
    // The coarse picture's samples are already counted.
    guard.measuring();
    let before = control.samples_done();
    let Measured { film, outcome, seconds } = measure::measure(of, &options, control, !args.quiet)?;
    if outcome == Outcome::Cancelled {
        return Ok(());
    }
    let _whole = guard.saving();
    let samples = control.samples_done() - before;
    let summary = Summary::new(scene, &options, (&film, outcome), (seconds, samples));
    picture::write(&output, &film, &stage.film, &summary.notes())?;
    if !args.quiet {
        report::out(&summary.text(&output))?;
    }
    Ok(())
}

/// With more samples than this, a PNG of one sample per pixel comes first.
const COARSE: u32 = 4;
