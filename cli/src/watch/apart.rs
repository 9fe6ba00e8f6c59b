//! Watching here, and each picture in a process of its own.

use std::path::PathBuf;
use std::process::Stdio;
use std::sync::Arc;
use std::time::Duration;

use luxel_core::render::Control;

use super::Args;
use super::changes::{self, Changes, Noticed, Wake};
use super::round::{Course, Read, Sitting};
use crate::exit::{Exit, Failure};
use crate::files::Watched;
use crate::interrupt::{self, Guard};
use crate::isolate::{self, Beat, Child, End};
use crate::load::{self, Loaded};
use crate::report::{self, Stream};

/// Between two looks at the child.
const TICK: Duration = Duration::from_millis(10);

/// So long a render may stand still.
const PATIENCE: Duration = Duration::from_secs(60);

/// The child's part: one load, one picture.
pub(super) fn one(args: &Args, beat: &Beat) -> Result<Exit, Failure> {
    let plugins = load::registry_telling(&args.plugins, beat)?;
    plugins.notes.tell(args.form(), Stream::Error)?;
    let size = args.render.size;
    let course = load::Course { beat: beat.clone(), line: !args.quiet, ..Default::default() };
    let loaded = load::load(&args.file, &args.load, size, &plugins, &course)?;
    // Half a save looks like a mistake; who watches comes to know of the other half.
    if loaded.stage.is_none() && changes::change_soon(&loaded.files.asked()) {
        return Ok(Exit::Fine);
    }
    report::diagnostics(&loaded.diagnostics, &loaded.sources, args.form(), Stream::Error)?;
    let Loaded { stage: Some(stage), files, sources, origin, .. } = loaded else {
        return Ok(Exit::Input);
    };
    let (control, guard) = (Arc::new(Control::default()), Guard::default());
    let stop = control.clone();
    let interrupt = guard.on_ctrl_c(move || stop.cancel())?;
    beat.rendering(&control, interrupt);
    let course = Course { control: &control, guard: &guard, beat };
    let read = Arc::new(Read { files, sources, origin });
    let sitting = Sitting::new(Arc::new(stage), read, None);
    sitting.render(args, &course, &mut |_, _| {})?;
    let _whole = guard.saving();
    sitting.to_print().map(|print| print.write(args, beat)).transpose()?;
    Ok(Exit::Fine)
}

/// The parent's part.
pub(super) fn watch(args: &Args) -> Result<Exit, Failure> {
    let (mut changes, waker) = Changes::new();
    interrupt::on_each(move || {
        let _ = waker.send(Wake::Stop);
    })?;
    loop {
        // Watched before anything is read, so that no save is missed.
        expect_more_than(Watched::new(), args, &mut changes);
        if !round(args, &mut changes)? {
            report::note("watching has ended");
            return Ok(Exit::Fine);
        }
    }
}

/// One child, and then the wait for a save. False when the end is asked for.
fn round(args: &Args, changes: &mut Changes) -> Result<bool, Failure> {
    let own = std::env::args_os().skip(1);
    let mut child = Child::start(own, args.isolate.patience(PATIENCE), Stdio::inherit())?;
    let mut expected = None;
    let mut next = None;
    let ending = loop {
        if let Some(ending) = child.poll() {
            break ending;
        }
        expect(&child, &mut expected, changes);
        match changes.within(TICK) {
            Noticed::Nothing => {}
            noticed => {
                child.stop();
                // Whoever asks for the end means it.
                next = next.filter(|earlier| *earlier == Noticed::Stop).or(Some(noticed));
            }
        }
    };
    expect(&child, &mut expected, changes);
    match next {
        // It was asked to end, and how it did so is of no interest.
        Some(noticed) => return Ok(noticed == Noticed::Save),
        None if matches!(ending.end, End::InOrder(_)) && expected.is_some() => {}
        None => {
            isolate::tell(&ending, &args.file, args.form())?;
            // What it did not come to ask for may be what has to change.
            expect_more_than(expected.unwrap_or_default(), args, changes);
        }
    }
    Ok(changes.wait())
}

/// Watches what was told of, the scene, and what decides which libraries are opened.
fn expect_more_than(told: Watched, args: &Args, changes: &mut Changes) {
    let plugins = load::look_at_libraries(&args.plugins);
    let libraries = plugins.map_or_else(|_| Watched::new(), |plugins| plugins.watched);
    let also = libraries.keys().map(PathBuf::as_path).chain([args.file.as_path()]);
    changes.expect_more_than(told, also);
}

/// Watches what the child has asked for so far.
fn expect(child: &Child, expected: &mut Option<Watched>, changes: &mut Changes) {
    let files = child.files();
    if files.is_empty() || expected.as_ref() == Some(&files) {
        return;
    }
    *expected = Some(files.clone());
    changes.expect(files);
}
