//! One picture of a watch, the coarse one before it included.

use std::sync::Arc;

use luxel_core::diag::Sources;
use luxel_core::render::{Control, Options, Outcome};
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

/// Renders and writes the picture; one that was cancelled or failed is not written, and the last
/// stays.
///
/// # Errors
/// What stands in the way; a panic in the renderer.
pub(super) fn render(
    args: &Args,
    (stage, read): (&Stage, &Read),
    course: &Course<'_>,
) -> Result<(), Failure> {
    let Course { control, guard, beat } = course;
    let film_file = stage.film.file.as_deref();
    let output = Output::choose(args.render.output.as_deref(), film_file, &args.file)?;
    output.check(&read.files)?;
    guard.measuring();
    beat.phase(Phase::Rendering);
    let options = args.render.options();
    let of = (args.file.as_path(), stage);
    if options.samples(stage) > COARSE {
        let coarse = Options { spp: Some(1), ..options.clone() };
        let first = measure::measure(of, &coarse, control, false)?;
        if first.outcome == Outcome::Failed {
            return failed(args, stage, read);
        }
        if first.outcome == Outcome::Complete {
            let _whole = guard.saving();
            beat.phase(Phase::Saving);
            picture::preview(&output, &first.film, &stage.film)?;
        }
    }
    // The coarse picture's samples are already counted.
    guard.measuring();
    beat.phase(Phase::Rendering);
    let before = control.samples_done();
    let Measured { film, outcome, seconds } = measure::measure(of, &options, control, !args.quiet)?;
    match outcome {
        Outcome::Cancelled => return Ok(()),
        Outcome::Failed => return failed(args, stage, read),
        Outcome::Complete => {}
    }
    let _whole = guard.saving();
    beat.phase(Phase::Saving);
    let samples = control.samples_done() - before;
    let of = (stage, &read.files);
    let summary = Summary::new(of, &options, (&film, outcome), (seconds, samples));
    picture::write(&output, &film, &stage.film, &summary.notes())?;
    if args.json {
        report::out(&format!("{}\n", summary.json(&output)))
    } else if args.quiet {
        Ok(())
    } else {
        report::out(&summary.text(&output))
    }
}

/// A library's code failed: what was measured may be wrong.
fn failed(args: &Args, stage: &Stage, read: &Read) -> Result<(), Failure> {
    report::diagnostics(&stage.failures(), &read.sources, args.form(), Stream::Error)
}
