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

/// With more samples than this, a PNG of one sample per pixel comes first, unless a page shows that
/// sooner: the next picture would have to wait while the file is written.
const COARSE: u32 = 4;

/// A scene of which a picture is made. While it is measured, and afterwards, another exposure may be
/// wanted, or another file.
pub(super) struct Sitting(Mutex<Shown>);

struct Shown {
    stage: Arc<Stage>,
    read: Arc<Read>,
    edit: Option<Edit>,
    /// The picture, with the samples that it took.
    done: Option<(Measured, u64)>,
    /// Whether it is on the disk as it is shown now.
    written: bool,
    /// Whether nothing more comes of the render.
    ended: bool,
}

impl Sitting {
    pub(super) fn new(stage: Arc<Stage>, read: Arc<Read>, edit: Option<Edit>) -> Self {
        Self(Mutex::new(Shown { stage, read, edit, done: None, written: false, ended: false }))
    }

    fn lock(&self) -> MutexGuard<'_, Shown> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// How the picture is shown now.
    pub(super) fn stage(&self) -> Arc<Stage> {
        self.lock().stage.clone()
    }

    /// Whether there is a picture on the disk, all of its samples taken.
    pub(super) fn is_written(&self) -> bool {
        self.lock().written
    }

    /// Whether the render has ended without a picture.
    pub(super) fn is_lost(&self) -> bool {
        let shown = self.lock();
        shown.ended && shown.done.is_none()
    }

    /// Renders and writes the picture, which `look` sees grow; one that was cancelled or failed is not
    /// written, and the last stays. Returns where it is, if it is there.
    ///
    /// # Errors
    /// What stands in the way; a panic in the renderer.
    pub(super) fn render(
        &self,
        args: &Args,
        course: &Course<'_>,
        look: &mut Look<'_>,
    ) -> Result<Option<Output>, Failure> {
        let rendered = self.measure(args, course, look);
        self.lock().ended = true;
        rendered
    }

    fn measure(
        &self,
        args: &Args,
        course: &Course<'_>,
        look: &mut Look<'_>,
    ) -> Result<Option<Output>, Failure> {
        let Course { control, guard, beat } = course;
        let stage = self.stage();
        self.lock().output(args)?;
        guard.measuring();
        beat.phase(Phase::Rendering);
        let options =
            Options { coarse: args.preview, courteous: args.preview, ..args.render.options() };
        let first = !args.preview && options.samples(&stage) > COARSE;
        let mut refused = None;
        let mut seen = |film: &Film, now: Reached| {
            look(film, now);
            if first && (now.step, now.samples) == ONE_SAMPLE && !control.is_cancelled() {
                refused = self.lock().coarse(args, film, course).err();
                if refused.is_some() {
                    // What cannot be written is not worth more samples.
                    control.cancel();
                }
            }
        };
        let of = (args.file.as_path(), &*stage);
        let film = measure::empty(&stage, &options)?;
        let measured = measure::measure(of, film, &options, control, !args.quiet, &mut seen)?;
        if let Some(failure) = refused {
            return Err(failure);
        }
        let mut shown = self.lock();
        match measured.outcome {
            Outcome::Cancelled => return Ok(None),
            // A library's code failed: what was measured may be wrong.
            Outcome::Failed => {
                let (found, sources) = (stage.failures(), &shown.read.sources);
                report::diagnostics(&found, sources, args.form(), Stream::Error)?;
                return Ok(None);
            }
            Outcome::Complete => {}
        }
        shown.done = Some((measured, control.samples_done()));
        shown.write(args, course).map(Some)
    }

    /// Shows what is or will be measured in another way. Returns where the picture is, if it is there.
    ///
    /// # Errors
    /// A picture that cannot be written; the one before stays.
    pub(super) fn show_as(
        &self,
        (stage, read): (Arc<Stage>, Arc<Read>),
        edit: Edit,
        args: &Args,
        course: &Course<'_>,
    ) -> Result<Option<Output>, Failure> {
        let mut shown = self.lock();
        let told_of = shown.edit.take().filter(|_| shown.done.is_none());
        let edit = match told_of {
            Some(before) => before.then(edit),
            None => edit,
        };
        (shown.stage, shown.read, shown.edit) = (stage, read, Some(edit));
        if shown.done.is_none() {
            return Ok(None);
        }
        shown.write(args, course).map(Some)
    }
}

/// When every pixel has one sample: pixels from one that has some to the next, and those.
const ONE_SAMPLE: (u32, u32) = (1, 1);

impl Shown {
    /// Where the picture goes, if it can go there.
    fn output(&self, args: &Args) -> Result<Output, Failure> {
        let file = self.stage.film.file.as_deref();
        let output = Output::choose(args.render.output.as_deref(), file, &args.file)?;
        output.check(&self.read.files)?;
        Ok(output)
    }

    /// Writes the PNG of one sample per pixel; whoever waits for a picture has one.
    fn coarse(
        &self,
        args: &Args,
        film: &Film,
        Course { guard, beat, .. }: &Course<'_>,
    ) -> Result<(), Failure> {
        let output = self.output(args)?;
        let whole = guard.saving();
        beat.phase(Phase::Saving);
        let written = picture::preview(&output, film, &self.stage.film);
        drop(whole);
        guard.measuring();
        beat.phase(Phase::Rendering);
        written
    }

    /// Writes the picture and tells of it.
    fn write(
        &mut self,
        args: &Args,
        Course { guard, beat, .. }: &Course<'_>,
    ) -> Result<Output, Failure> {
        self.written = false;
        let output = self.output(args)?;
        let Some((Measured { film, outcome, seconds }, samples)) = &self.done else {
            return Ok(output);
        };
        let _whole = guard.saving();
        beat.phase(Phase::Saving);
        let (of, took) = ((&*self.stage, &self.read.files), (*seconds, *samples));
        let summary = Summary::new(of, &args.render.options(), (film, *outcome), took);
        picture::write(&output, film, &self.stage.film, &summary.notes())?;
        self.written = true;
        if args.json {
            let mut told = summary.json(&output);
            told["edit"] = self.edit.as_ref().map(Edit::json).into();
            report::out(&format!("{told}\n"))?;
        } else if !args.quiet {
            report::out(&summary.text(&output))?;
        }
        Ok(output)
    }
}
