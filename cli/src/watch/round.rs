//! One picture of a watch: measured once, and shown in whatever way is wanted by then.

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use luxel_core::diag::Sources;
use luxel_core::film::Film;
use luxel_core::render::{Control, Look, Options, Outcome, Reached};
use luxel_core::stage::Stage;

use super::Args;
use super::edit::Edit;
use crate::exit::Failure;
use crate::files::DiskFiles;
use crate::interrupt::Guard;
use crate::isolate::{Beat, Phase};
use crate::measure::{self, Measured};
use crate::origin::Origin;
use crate::output::Output;
use crate::picture;
use crate::report::{self, Stream};
use crate::summary::{Summary, Took};

/// What a scene's last load left for messages and for what decides where pictures go.
pub(super) struct Read {
    pub(super) files: DiskFiles,
    pub(super) sources: Sources,
    pub(super) origin: Origin,
}

/// How a render is ended from outside, and what is told of it.
pub(super) struct Course<'a> {
    pub(super) control: &'a Arc<Control>,
    pub(super) guard: &'a Guard,
    pub(super) beat: &'a Beat,
}

/// With more samples than this, a PNG of the first comes before the picture, unless a page shows that
/// sooner: the next picture would have to wait while the file is written.
const COARSE: u32 = 4;

/// A scene of which a picture is made. While it is measured, and afterwards, another exposure may be
/// wanted, or another file.
pub(super) struct Sitting(Mutex<Shown>);

struct Shown {
    stage: Arc<Stage>,
    read: Arc<Read>,
    /// What has not been told yet.
    edit: Option<Edit>,
    /// The picture, with the samples that it took.
    done: Option<Arc<(Measured, u64)>>,
    ink: Ink,
    /// Whether nothing more comes of the render.
    ended: bool,
    /// What a picture of fewer samples of the same left, to go on with.
    first: Option<Film>,
    /// What was measured before another picture took its place: some samples of every pixel.
    left: Option<Film>,
    /// Whether another picture has taken its place.
    past: bool,
}

/// How far the finished picture has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ink {
    /// It could not be written, or there is nothing to write yet.
    None,
    /// It is to be written.
    Due,
    /// It is being written as it is to be shown.
    Wet,
    /// It is on the disk as it is to be shown.
    Dry,
}

/// A picture as it is to be written.
pub(super) struct Print {
    stage: Arc<Stage>,
    read: Arc<Read>,
    edit: Option<Edit>,
    done: Arc<(Measured, u64)>,
}

impl Sitting {
    pub(super) fn new(stage: Arc<Stage>, read: Arc<Read>, edit: Option<Edit>) -> Self {
        let (ended, past) = (false, false);
        let (done, ink, first, left) = (None, Ink::None, None, None);
        Self(Mutex::new(Shown { stage, read, edit, done, ink, ended, first, left, past }))
    }

    fn lock(&self) -> MutexGuard<'_, Shown> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How the picture is shown now.
    fn subject(&self) -> (Arc<Stage>, Arc<Read>) {
        let shown = self.lock();
        (shown.stage.clone(), shown.read.clone())
    }

    /// Whether there is a picture on the disk, all of its samples taken.
    pub(super) fn is_written(&self) -> bool {
        let shown = self.lock();
        shown.ink == Ink::Dry && shown.done.as_ref().is_some_and(|done| done.0.is_whole())
    }

    /// Whether the picture is still to be written, or being written.
    pub(super) fn is_in_press(&self) -> bool {
        matches!(self.lock().ink, Ink::Due | Ink::Wet)
    }

    /// Whether the render has ended without a picture.
    pub(super) fn is_lost(&self) -> bool {
        let shown = self.lock();
        shown.ended && shown.done.is_none()
    }

    /// Goes on with what another one has measured, whose render has ended.
    pub(super) fn go_on_from(&self, other: &Self) {
        let before = {
            let mut other = other.lock();
            let done = other.done.as_ref().map(|done| done.0.film.clone());
            done.or_else(|| other.left.take())
        };
        self.lock().first = before;
    }

    /// Another picture takes its place.
    pub(super) fn pass(&self) {
        self.lock().past = true;
    }

    /// Whether another picture has taken its place.
    pub(super) fn is_past(&self) -> bool {
        self.lock().past
    }

    /// Renders the picture, which `look` sees grow. Returns whether there is one to be written: one
    /// that was cancelled or failed is not, and the last stays; but what was measured until the end of
    /// the program is, where a PNG of its first samples has been.
    ///
    /// # Errors
    /// What stands in the way; a panic in the renderer.
    pub(super) fn render(
        &self,
        args: &Args,
        course: &Course<'_>,
        look: &mut Look<'_>,
    ) -> Result<bool, Failure> {
        let rendered = self.measure(args, course, look);
        self.lock().ended = true;
        rendered
    }

    fn measure(
        &self,
        args: &Args,
        course: &Course<'_>,
        look: &mut Look<'_>,
    ) -> Result<bool, Failure> {
        let Course { control, guard, beat } = course;
        let (stage, read) = self.subject();
        output((&stage, &read), args)?;
        guard.measuring();
        beat.phase(Phase::Rendering);
        let options =
            Options { coarse: args.preview, courteous: args.preview, ..args.render.options() };
        let of_samples = options.samples(&stage);
        let mut first = !args.preview && of_samples > COARSE;
        let begun = self.lock().first.take();
        let mut has_all = begun.is_some();
        let (mut refused, mut replaced) = (None, false);
        let mut seen = |film: &Film, now: Reached| {
            look(film, now);
            let has_now = now.step == 1 && now.is_whole;
            has_all |= has_now;
            let is_some = has_now && now.samples < of_samples;
            // The picture before may still be on its way to the same file: it comes first.
            if first && is_some && !guard.is_saving() && !control.is_cancelled() {
                first = false;
                refused = self.coarse(args, film, course).err();
                replaced = refused.is_none();
                if refused.is_some() {
                    // What cannot be written is not worth more samples.
                    control.cancel();
                }
            }
        };
        let of = (args.file.as_path(), &*stage);
        let measured = measure::measure(
            of,
            begun.map_or_else(|| measure::empty(&stage, &options), Ok)?,
            &options,
            control,
            !args.quiet,
            &mut seen,
        )?;
        if let Some(failure) = refused {
            return Err(failure);
        }
        let mut shown = self.lock();
        match measured.outcome {
            // The PNG of the first samples has taken the place of the last picture's.
            Outcome::Cancelled if replaced && guard.is_interrupted() => {}
            Outcome::Cancelled => {
                // Coarse steps leave samples that nothing else counts.
                shown.left = has_all.then_some(measured.film);
                return Ok(false);
            }
            // A library's code failed: what was measured may be wrong.
            Outcome::Failed => {
                let (found, sources) = (stage.failures(), &shown.read.sources);
                report::diagnostics(&found, sources, args.form(), Stream::Error)?;
                return Ok(false);
            }
            Outcome::Complete => {}
        }
        (shown.done, shown.ink) = (Some(Arc::new((measured, control.samples_done()))), Ink::Due);
        Ok(true)
    }

    /// Writes the PNG of the first samples; whoever waits for a picture has one.
    fn coarse(
        &self,
        args: &Args,
        film: &Film,
        Course { guard, beat, .. }: &Course<'_>,
    ) -> Result<(), Failure> {
        let (stage, read) = self.subject();
        let output = output((&stage, &read), args)?;
        let whole = guard.saving();
        beat.phase(Phase::Saving);
        let written = picture::preview(&output, film, &stage.film);
        drop(whole);
        guard.measuring();
        beat.phase(Phase::Rendering);
        written
    }

    /// Shows what is or will be measured in another way. Returns whether it has to be brought to
    /// whoever writes it: whoever has it, or comes to have it, sees this.
    pub(super) fn show_as(&self, (stage, read): (Arc<Stage>, Arc<Read>), edit: Edit) -> bool {
        let mut shown = self.lock();
        let edit = match shown.edit.take() {
            Some(before) => before.then(edit),
            None => edit,
        };
        (shown.stage, shown.read, shown.edit) = (stage, read, Some(edit));
        let at_rest = matches!(shown.ink, Ink::None | Ink::Dry);
        if shown.done.is_some() {
            shown.ink = Ink::Due;
        }
        shown.done.is_some() && at_rest
    }

    /// What is to be written, if it is not on the disk by now.
    pub(super) fn to_print(&self) -> Option<Print> {
        let mut shown = self.lock();
        let done = shown.done.clone().filter(|_| shown.ink == Ink::Due)?;
        shown.ink = Ink::Wet;
        let edit = shown.edit.take();
        Some(Print { stage: shown.stage.clone(), read: shown.read.clone(), edit, done })
    }

    /// Wants a picture once more that could not be written; returns whether there is one.
    pub(super) fn wants_again(&self) -> bool {
        let mut shown = self.lock();
        let is_unwritten = shown.done.is_some() && shown.ink == Ink::None;
        if is_unwritten {
            shown.ink = Ink::Due;
        }
        is_unwritten
    }

    /// What was to be written is on the disk, or cannot be.
    pub(super) fn printed(&self, well: bool) {
        let mut shown = self.lock();
        if shown.ink == Ink::Wet {
            shown.ink = if well { Ink::Dry } else { Ink::None };
        }
    }
}

/// Where the picture goes, if it can go there.
fn output((stage, read): (&Stage, &Read), args: &Args) -> Result<Output, Failure> {
    let file = stage.film.file.as_deref();
    let output = Output::choose(args.render.output.as_deref(), file, &args.file)?;
    output.check(&read.files)?;
    Ok(output)
}

impl Print {
    /// Whether all of its samples were taken.
    pub(super) fn is_whole(&self) -> bool {
        self.done.0.is_whole()
    }

    /// Writes the picture and tells of it. Returns where it is.
    ///
    /// # Errors
    /// A picture that cannot be written; the one before stays.
    pub(super) fn write(&self, args: &Args, beat: &Beat) -> Result<Output, Failure> {
        let Self { stage, read, edit, done } = self;
        let (Measured { film, outcome, seconds }, samples) = &**done;
        let output = output((stage, read), args)?;
        beat.phase(Phase::Saving);
        let of = (&**stage, &read.files, &read.origin);
        let took = Took { seconds: *seconds, before: 0.0, samples: *samples };
        let summary = Summary::new(of, &args.render.options(), (film, *outcome), took);
        picture::write(&output, film, &stage.film, &summary.notes())?;
        if args.json {
            let mut told = summary.json(&output);
            told["edit"] = edit.as_ref().map(Edit::json).into();
            report::out(&format!("{told}\n"))?;
        } else if !args.quiet {
            report::out(&summary.text(&output))?;
        }
        Ok(output)
    }
}

#[cfg(test)]
mod tests;
