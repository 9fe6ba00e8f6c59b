//! Watching and rendering in one process.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use luxel_core::render::Control;
use luxel_core::stage::Stage;

use super::Args;
use super::changes::{Changes, Wake};
use super::round::{self, Course, Read};
use crate::args::PluginArgs;
use crate::exit::{Exit, Failure};
use crate::files::look;
use crate::interrupt::Guard;
use crate::isolate::Beat;
use crate::libraries::{Plugins, Session, Surroundings};
use crate::load::{self, Loaded};
use crate::report::{self, Form, Stream};

/// The render in flight, so that Ctrl-C and saves can end it.
type Current = Arc<Mutex<Arc<Control>>>;

pub(super) fn watch(args: &Args) -> Result<Exit, Failure> {
    let (mut session, surroundings) = (Session::new(), Surroundings::of_process());
    let mut plugins = session.refresh(&args.plugins, &surroundings)?;
    plugins.notes.tell(args.form(), Stream::Error)?;
    let (mut changes, waker) = Changes::new()?;
    let current = Current::default();
    let stopped = current.clone();
    let course = load::Course { line: !args.quiet, ..load::Course::default() };
    let loading = course.watch.clone();
    let guard = Guard::default();
    guard.on_ctrl_c(move || {
        let _ = waker.send(Wake::Stop);
        loading.cancel();
        stopped.lock().unwrap_or_else(PoisonError::into_inner).cancel();
    })?;
    let mut last_good: Option<Stage> = None;
    changes.arm([args.file.as_path()])?;
    loop {
        let read = match load::load(
            &args.file,
            &args.load,
            args.render.size,
            &plugins,
            last_good.as_ref(),
            &course,
        ) {
            Ok(loaded) => take(loaded, &plugins, &mut last_good, &mut changes, args.form())?,
            Err(_) if course.watch.is_cancelled() => None,
            // A panic in a plugin ends this attempt, not the watch.
            Err(failure) => {
                report::failure(&failure);
                let libraries = plugins.watched.keys().map(PathBuf::as_path);
                changes.expect_news(libraries.chain([args.file.as_path()]))?;
                None
            }
        };
        let go_on = match (&last_good, &read) {
            (Some(stage), Some(read)) => one(args, (stage, read), (&current, &guard), &mut changes),
            _ => changes.wait(),
        };
        if !go_on {
            report::note("watching has ended");
            return Ok(Exit::Fine);
        }
        renew(&mut plugins, &mut session, (&args.plugins, &surroundings), args.form())?;
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
    form: Form,
) -> Result<(), Failure> {
    if plugins.watched.iter().all(|(path, seen)| look(path) == *seen) {
        return Ok(());
    }
    match session.refresh(args, surroundings) {
        Ok(renewed) => {
            *plugins = renewed;
            plugins.notes.tell(form, Stream::Error)
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

/// Tells what was found and watches what was asked for. What was read, if there is a new stage.
fn take(
    loaded: Loaded,
    plugins: &Plugins,
    last_good: &mut Option<Stage>,
    changes: &mut Changes,
    form: Form,
) -> Result<Option<Read>, Failure> {
    let mut watched = loaded.files.asked();
    watched.extend(plugins.watched.clone());
    changes.expect(watched)?;
    report::diagnostics(&loaded.diagnostics, &loaded.sources, form, Stream::Error)?;
    let Loaded { stage: Some(stage), files, sources, .. } = loaded else { return Ok(None) };
    *last_good = Some(stage);
    Ok(Some(Read { files, sources }))
}

/// Renders until done, or until a save or Ctrl-C; then waits for the next one. False at the end.
fn one(
    args: &Args,
    scene: (&Stage, &Read),
    (current, guard): (&Current, &Guard),
    changes: &mut Changes,
) -> bool {
    let control = Arc::new(Control::default());
    current.lock().unwrap_or_else(PoisonError::into_inner).clone_from(&control);
    std::thread::scope(|scope| {
        let rendering = scope.spawn(|| {
            let course = Course { control: &control, guard, beat: &Beat::silent() };
            if let Err(failure) = round::render(args, scene, &course) {
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
