//! Watching and rendering in one process: what is saved is read while the last picture goes on, and
//! ends it only if it shows something else.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::Scope;
use std::time::Duration;

use luxel_core::accel::Watch;
use luxel_core::render::{Control, Look};

use super::Args;
use super::changes::{Changes, Noticed, Wake};
use super::page::{self, Page};
use super::reading;
use super::round::{self, Course, Read};
use super::shown::{Shown, Subject};
use super::wishes::Wishes;
use crate::args::PluginArgs;
use crate::exit::{Exit, Failure};
use crate::files::{Asked, look};
use crate::interrupt::Guard;
use crate::isolate::Beat;
use crate::libraries::{Plugins, Session, Surroundings};
use crate::load::{self, Loaded, Text};
use crate::report::{self, Stream};

/// Between two looks at whether a scene is ready.
const TICK: Duration = Duration::from_millis(1);

/// What Ctrl-C ends: the render and the build in hand.
#[derive(Clone, Default)]
struct InHand(Arc<Mutex<(Arc<Control>, Arc<Watch>)>>);

impl InHand {
    fn get(&self) -> MutexGuard<'_, (Arc<Control>, Arc<Watch>)> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// What to do after a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// Wait for a save.
    Wait,
    /// There has been one.
    Read,
    /// The end is asked for.
    End,
}

pub(super) fn watch(args: &Args) -> Result<Exit, Failure> {
    let (mut session, surroundings) = (Session::new(), Surroundings::of_process());
    let plugins = session.refresh(&args.plugins, &surroundings)?;
    plugins.notes.tell(args.form(), Stream::Error)?;
    let (mut changes, waker) = Changes::new();
    let wishes = Wishes::new(changes.wished(), waker.clone());
    let in_hand = InHand::default();
    let stopped = in_hand.clone();
    let guard = Guard::default();
    guard.on_ctrl_c(move || {
        let _ = waker.send(Wake::Stop);
        let (render, build) = &*stopped.get();
        render.cancel();
        build.cancel();
    })?;
    changes.arm([args.file.as_path()]);
    let page = args.preview.then(|| Page::start(&args.file, &args.page, wishes)).transpose()?;
    std::thread::scope(|scope| {
        let mut watching = Watching {
            args,
            scope,
            guard: &guard,
            page: page.as_ref(),
            in_hand,
            plugins,
            changes,
            asked: Asked::default(),
            shown: None,
            impatient: true,
        };
        let ended = watching.rounds(&mut session, &surroundings);
        watching.end();
        ended
    })?;
    report::note("watching has ended");
    Ok(Exit::Fine)
}

struct Watching<'scope, 'env> {
    args: &'env Args,
    scope: &'scope Scope<'scope, 'env>,
    guard: &'env Guard,
    page: Option<&'env Page>,
    in_hand: InHand,
    plugins: Plugins,
    changes: Changes,
    /// What the last load has asked for so far.
    asked: Asked,
    /// The last good scene.
    shown: Option<Shown<'scope>>,
    /// Whether a save ends the making ready of a scene. Not twice in a row: however fast saves come,
    /// pictures follow.
    impatient: bool,
}

impl Watching<'_, '_> {
    /// Reads and renders at every save, until the end is asked for.
    ///
    /// # Errors
    /// If standard error cannot be written.
    fn rounds(&mut self, session: &mut Session, around: &Surroundings) -> Result<(), Failure> {
        loop {
            let next = match self.round()? {
                Next::Wait if self.changes.wait() => Next::Read,
                Next::Wait => Next::End,
                next => next,
            };
            if next == Next::End {
                return Ok(());
            }
            self.renew(session, (&self.args.plugins, around))?;
        }
    }

    /// Reads the scene, and renders it if it shows something else than before.
    ///
    /// # Errors
    /// If standard error cannot be written.
    fn round(&mut self) -> Result<Next, Failure> {
        match self.load() {
            // A panic in a plugin ends this attempt, not the watch.
            Err(failure) if failure.exit == Exit::Ours => {
                report::failure(&failure);
                self.page.inspect(|page| page.failed(&failure));
                let libraries = self.plugins.watched.keys().map(PathBuf::as_path);
                let told = self.asked.lock().unwrap_or_else(PoisonError::into_inner).clone();
                let also = libraries.chain([self.args.file.as_path()]);
                self.changes.expect_more_than(told, also);
                Ok(Next::Wait)
            }
            // Ctrl-C has ended it, which the wait is told too.
            Err(failure) if failure.exit == Exit::Incomplete => Ok(Next::Wait),
            ended => ended,
        }
    }

    fn load(&mut self) -> Result<Next, Failure> {
        let form = self.args.form();
        let before = self.shown.as_ref().map(|shown| &*shown.subject.stage);
        let text = reading::read(self.args, &self.plugins, self.page, before)?;
        self.asked = text.files.shared().clone();
        if let Some(Shown { subject, .. }) = &mut self.shown
            && subject.is_of(&text)
        {
            subject.read_again(&text);
            self.changes.expect(subject.files.clone());
            report::diagnostics(&text.diagnostics, &text.sources, form, Stream::Error)?;
            let Subject { warnings, read, .. } = &*subject;
            let told = [(&text.diagnostics, &text.sources), (warnings, &read.sources)];
            self.page.inspect(|page| page.problems(&told));
            return Ok(Next::Wait);
        }
        let hash = text.scene.as_ref().map(luxel_core::scene::Scene::hash);
        let (texts, n_told) = (text.files.asked().into_keys().collect(), text.diagnostics.len());
        let (loaded, noticed) = self.build(text);
        let loaded = match noticed {
            Noticed::Save => return Ok(Next::Read),
            Noticed::Stop => return Ok(Next::End),
            Noticed::Nothing => loaded?,
        };
        let mut watched = loaded.files.asked();
        watched.extend(self.plugins.watched.clone());
        self.changes.expect(watched.clone());
        // Half a save looks like a mistake: the wait tells at once of the other half.
        if loaded.stage.is_some() || !self.changes.more_to_come() {
            report::diagnostics(&loaded.diagnostics, &loaded.sources, form, Stream::Error)?;
            let told = [(&loaded.diagnostics, &loaded.sources)];
            self.page.inspect(|page| page.problems(&told));
        }
        let Loaded { stage, files, sources, mut diagnostics, .. } = loaded;
        if let (Some(stage), Some(hash)) = (stage, hash) {
            let (stage, read) = (Arc::new(stage), Arc::new(Read { files, sources }));
            let warnings = diagnostics.split_off(n_told.min(diagnostics.len()));
            self.show(Subject { hash, stage, read, files: watched, texts, warnings });
        }
        Ok(Next::Wait)
    }

    /// Makes a scene ready, unless a save comes between.
    fn build(&mut self, text: Text) -> (Result<Loaded, Failure>, Noticed) {
        let course = load::Course { line: !self.args.quiet, ..load::Course::default() };
        self.in_hand.get().1 = course.watch.clone();
        let mut now = text.files.asked();
        now.extend(self.plugins.watched.clone());
        let before = self.shown.as_ref().map(|shown| &*shown.subject.stage);
        let (file, plugins, changes) = (&self.args.file, &self.plugins, &mut self.changes);
        let patient = !self.impatient;
        changes.expect(now);
        let (built, noticed) = std::thread::scope(|scope| {
            let building = scope.spawn(|| load::build(file, text, plugins, before, &course));
            let mut noticed = Noticed::Nothing;
            while !building.is_finished() && noticed == Noticed::Nothing {
                noticed = match changes.within(TICK) {
                    Noticed::Save if patient => break,
                    noticed => noticed,
                };
            }
            if noticed != Noticed::Nothing {
                course.watch.cancel();
            }
            (building.join(), noticed)
        });
        self.impatient = noticed == Noticed::Nothing;
        let lost = |_| Failure::new(Exit::Ours, "the scene could not be made ready");
        (built.unwrap_or_else(|payload| Err(lost(payload))), noticed)
    }

    /// Ends the picture before, and begins one.
    fn show(&mut self, subject: Subject) {
        if let Some(before) = self.shown.take() {
            before.control.supersede();
            before.ended();
        }
        let control = Arc::new(Control::default());
        self.in_hand.get().0.clone_from(&control);
        let (args, guard, page) = (self.args, self.guard, self.page);
        let (Subject { stage, read, .. }, ends) = (subject.clone(), control.clone());
        self.page.inspect(|page| page.stands_at(&stage, &self.plugins.registry, &read));
        let of_samples = args.render.options().samples(&stage);
        let follow =
            |page: &Page| -> Box<Look<'_>> { Box::new(page.follow(&stage, &read, of_samples)) };
        let mut look = page.map_or_else(page::unseen, follow);
        let thread = self.scope.spawn(move || {
            let course = Course { control: &ends, guard, beat: &Beat::silent() };
            if let Err(failure) = round::render(args, (&stage, &read), &course, &mut *look) {
                report::failure(&failure);
                page.inspect(|page| page.lost(&failure));
            } else if stage.has_failed() {
                page.inspect(|page| page.broke(&stage.failures(), &read.sources));
            }
        });
        self.shown = Some(Shown { subject, control, thread });
    }

    /// Ends the picture in hand.
    fn end(&mut self) {
        if let Some(shown) = self.shown.take() {
            shown.control.cancel();
            shown.ended();
        }
    }

    /// Opens libraries anew if one has changed, or what is trusted has.
    ///
    /// # Errors
    /// If standard error cannot be written.
    fn renew(
        &mut self,
        session: &mut Session,
        (args, surroundings): (&PluginArgs, &Surroundings),
    ) -> Result<(), Failure> {
        if self.plugins.watched.iter().all(|(path, seen)| look(path) == *seen) {
            return Ok(());
        }
        match session.refresh(args, surroundings) {
            Ok(renewed) => {
                self.plugins = renewed;
                self.plugins.notes.tell(self.args.form(), Stream::Error)
            }
            // A lock or configuration that cannot be understood leaves everything as it was.
            Err(failure) => {
                report::failure(&failure);
                self.page.inspect(|page| page.failed(&failure));
                let seen = |path: &PathBuf| (path.clone(), look(path));
                self.plugins.watched = self.plugins.watched.keys().map(seen).collect();
                Ok(())
            }
        }
    }
}
