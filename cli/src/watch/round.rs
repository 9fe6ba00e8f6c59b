//! One picture of a watch, shown as it grows.

use std::sync::Arc;

use luxel_core::diag::Sources;
use luxel_core::film::Film;
use luxel_core::render::{Control, Look, Options, Outcome, Reached};
use luxel_core::stage::Stage;

use super::Args;
use crate::exit::Failure;
use crate::files::DiskFiles;
use crate::interrupt::Guard;
use crate::isolate::{Beat, Phase};
use crate::measure::{self, Measured};
use crate::output::Output;
use crate::picture;
use crate::report::{self, Stream};
use crate::summary::Summary;

/// What a scene's last load left for messages and for what decides where pictures go.
pub(super) struct Read {
    pub(super) files: DiskFiles,
    pub(super) sources: Sources,
}

/// How a render is ended from outside, and what is told of it.
pub(super) struct Course<'a> {
    pub(super) control: &'a Arc<Control>,
    pub(super) guard: &'a Guard,
    pub(super) beat: &'a Beat,
}

/// With more samples than this, a PNG of one sample per pixel comes first.
const COARSE: u32 = 4;

/// Renders and writes the picture, which `look` sees grow; one that was cancelled or failed is not
/// written, and the last stays.
///
/// # Errors
/// What stands in the way; a panic in the renderer.
pub(super) fn render(
    args: &Args,
    (stage, read): (&Stage, &Read),
    course: &Course<'_>,
    look: &mut Look<'_>,
) -> Result<(), Failure> {
    let Course { control, guard, beat } = course;
    let film_file = stage.film.file.as_deref();
    let output = Output::choose(args.render.output.as_deref(), film_file, &args.file)?;
    output.check(&read.files)?;
    guard.measuring();
    beat.phase(Phase::Rendering);
    let options = Options { coarse: args.preview, ..args.render.options() };
    let first = options.samples(stage) > COARSE;
    let mut refused = None;
    let mut seen = |film: &Film, now: Reached| {
        look(film, now);
        if first && now == ONE_SAMPLE && !control.is_cancelled() {
            refused = coarse((&output, film, stage), course).err();
            if refused.is_some() {
                // What cannot be written is not worth more samples.
                control.cancel();
            }
        }
    };
    let of = (args.file.as_path(), stage);
    let measured = measure::measure(of, &options, control, !args.quiet, &mut seen)?;
    if let Some(failure) = refused {
        return Err(failure);
    }
    let Measured { film, outcome, seconds } = measured;
    match outcome {
        Outcome::Cancelled => return Ok(()),
        Outcome::Failed => return failed(args, stage, read),
        Outcome::Complete => {}
    }
    let _whole = guard.saving();
    beat.phase(Phase::Saving);
    let of = (stage, &read.files);
    let took = (seconds, control.samples_done());
    let summary = Summary::new(of, &options, (&film, outcome), took);
    picture::write(&output, &film, &stage.film, &summary.notes())?;
    if args.json {
        report::out(&format!("{}\n", summary.json(&output)))
    } else if args.quiet {
        Ok(())
    } else {
        report::out(&summary.text(&output))
    }
}

/// When every pixel has one sample.
const ONE_SAMPLE: Reached = Reached { step: 1, samples: 1 };

/// Writes the PNG of one sample per pixel; whoever waits for a picture has one.
fn coarse(
    (output, film, stage): (&Output, &Film, &Stage),
    Course { guard, beat, .. }: &Course<'_>,
) -> Result<(), Failure> {
    let whole = guard.saving();
    beat.phase(Phase::Saving);
    let written = picture::preview(output, film, &stage.film);
    drop(whole);
    guard.measuring();
    beat.phase(Phase::Rendering);
    written
}

/// A library's code failed: what was measured may be wrong.
fn failed(args: &Args, stage: &Stage, read: &Read) -> Result<(), Failure> {
    report::diagnostics(&stage.failures(), &read.sources, args.form(), Stream::Error)
}
