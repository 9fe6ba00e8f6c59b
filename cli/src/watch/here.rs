//! Watching and rendering in one process: what is saved is read while the last picture goes on, and
//! ends it only if it shows something else.

use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::Scope;
use std::time::{Duration, Instant};

use luxel_core::accel::Watch;
use luxel_core::film::Film;
use luxel_core::render::{Control, Courtesy, Reached};
use luxel_core::scene::Scene;
use luxel_core::stage::Anew;
use luxel_lang::Kept;
use serde_json::json;

use super::Args;
use super::attempt::{Attempts, Ended};
use super::audience::Audience;
use super::begin::{is_saved_after, open};
use super::changes::{Changes, Noticed, Wake};
use super::edit::{self, Edit};
use super::press::Press;
use super::reading;
use super::round::{Course, Read, Sitting};
use super::shown::{Shown, Subject};
use super::wishes::Wishes;
use crate::args::PluginArgs;
use crate::exit::{Exit, Failure};
use crate::files::{Asked, Watched, look};
use crate::interrupt::Guard;
use crate::isolate::{Again, Beat, Phase};
use crate::libraries::{Plugins, Session, Surroundings};
use crate::load::{self, Loaded, Text};
use crate::report::{self, Stream};

/// Between two looks at whether a scene is ready.
const TICK: Duration = Duration::from_millis(1);

/// So long nothing is looked for while a scene is read: most are read by then.
const SHORT: Duration = Duration::from_millis(5);

/// Between two looks at whether such a scene is read.
const STEP: Duration = Duration::from_micros(200);

/// So long nothing is saved when a scene is called stable.
const STILL: Duration = Duration::from_millis(120);

/// What is told at the end.
const ENDED: &str = "watching has ended";

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

pub(super) fn watch(args: &Args, beat: &Beat) -> Result<Exit, Failure> {
    let (mut session, surroundings) = (Session::new(), Surroundings::of_process());
    let again = beat.again();
    // What crashed is not opened again before something is saved.
    let failure = again.as_ref().and_then(Again::failure);
    let mut open = || open(&mut session, args, &surroundings, beat);
    let opened = failure.is_none().then(&mut open).transpose()?;
    let (mut changes, waker) = Changes::new();
    let wishes = Wishes::new(changes.wished(), waker.clone());
    let in_hand = InHand::default();
    let stopped = in_hand.clone();
    let guard = Guard::default();
    let interrupt = guard.on_ctrl_c(move || {
        let _ = waker.send(Wake::Stop);
        let (render, build) = &*stopped.get();
        render.cancel();
        build.cancel();
    })?;
    beat.on_stop(interrupt.clone());
    changes.arm([args.file.as_path()]);
    let audience = Audience::new(args, wishes, beat, again.as_ref())?;
    if let (Some(failure), Some(again)) = (&failure, &again)
        && !is_saved_after(failure, again.watched(), args, (&audience, &mut changes, beat))
    {
        report::note(ENDED);
        return Ok(Exit::Fine);
    }
    let plugins = opened.map_or_else(open, Ok)?;
    std::thread::scope(|scope| {
        let mut watching = Watching {
            args,
            scope,
            guard: &guard,
            beat,
            audience: &audience,
            attempts: Attempts::new(scope, beat.clone(), args.preview.then_some(Courtesy::Ready)),
            in_hand,
            libraries: plugins.watched.clone(),
            plugins: Arc::new(plugins),
            changes,
            asked: Asked::default(),
            kept: Arc::default(),
            shown: None,
            impatient: true,
            is_good: false,
            has_told: false,
            press: Press::start(scope, args, &audience, interrupt),
        };
        let ended = watching.rounds(&mut session, &surroundings);
        let has_picture = watching.end();
        ended.map(|()| has_picture)
    })
    .map(|has_picture| {
        if args.then.once_stable && !guard.is_interrupted() {
            return if has_picture { Exit::Fine } else { Exit::Input };
        }
        audience.end();
        report::note(ENDED);
        if args.then.once_stable && !has_picture { Exit::Incomplete } else { Exit::Fine }
    })
}

/// What to do after something else was noticed.
fn after(noticed: Noticed) -> Next {
    if noticed == Noticed::Stop { Next::End } else { Next::Read }
}

struct Watching<'scope, 'env> {
    args: &'env Args,
    scope: &'scope Scope<'scope, 'env>,
    guard: &'env Guard,
    beat: &'env Beat,
    audience: &'env Audience,
    attempts: Attempts<'scope, 'env>,
    in_hand: InHand,
    plugins: Arc<Plugins>,
    /// What decides which libraries are opened, as it was last looked at.
    libraries: Watched,
    changes: Changes,
    /// What the last load has asked for so far.
    asked: Asked,
    /// What the last load has left for the next one.
    kept: Arc<Mutex<Kept>>,
    /// The last good scene.
    shown: Option<Shown<'scope>>,
    /// Whether a save ends the reading or the making ready of a scene. Not twice in a row: however fast
    /// saves come, pictures follow.
    impatient: bool,
    /// Whether the last load gave a scene.
    is_good: bool,
    /// Whether mistakes were told for which there is no scene yet.
    has_told: bool,
    press: Press<'scope, 'env>,
}

impl<'scope> Watching<'scope, '_> {
    /// Reads and renders at every save, until the end is asked for.
    ///
    /// # Errors
    /// If standard error cannot be written.
    fn rounds(&mut self, session: &mut Session, around: &Surroundings) -> Result<(), Failure> {
        loop {
            let next = self.round();
            // What is saved may leave the picture as it is.
            self.shown.as_ref().inspect(|shown| shown.control.release());
            let next = next?;
            self.audience.page().inspect(|page| page.has_read());
            let next = match next {
                Next::Wait => self.wait(),
                next => next,
            };
            if next == Next::End {
                return Ok(());
            }
            self.shown.as_ref().inspect(|shown| shown.hold(self.args.preview));
            self.audience.page().inspect(|page| page.reading());
            self.renew(session, (&self.args.plugins, around))?;
        }
    }

    /// Waits for a save, or for the picture if that is the end.
    fn wait(&mut self) -> Next {
        loop {
            let (shown, is_seen) = (self.shown.as_ref(), self.args.preview);
            let hold = || _ = shown.inspect(|shown| shown.hold(is_seen));
            let noticed = self.changes.within_then(STILL, hold);
            let is_done = || shown.is_some_and(Shown::is_done);
            if noticed == Noticed::Nothing {
                shown.inspect(|shown| shown.control.release());
                if shown.is_none() || is_done() {
                    self.beat.phase(Phase::Waiting);
                }
            }
            match noticed {
                Noticed::Save => return Next::Read,
                Noticed::Stop => return Next::End,
                Noticed::Nothing if self.args.then.once_stable && self.is_good && is_done() => {
                    return Next::End;
                }
                Noticed::Nothing => {}
            }
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
                self.audience.failed(&failure);
                self.has_told = true;
                let mut told = self.asked.lock().unwrap_or_else(PoisonError::into_inner).clone();
                told.extend(self.libraries.clone());
                self.changes.expect_more_than(told, [self.args.file.as_path()]);
                self.impatient = true;
                Ok(Next::Wait)
            }
            // Ctrl-C has ended it, which the wait is told too.
            Err(failure) if failure.exit == Exit::Incomplete => Ok(Next::Wait),
            ended => ended,
        }
    }

    fn load(&mut self) -> Result<Next, Failure> {
        let (form, begun) = (self.args.form(), Instant::now());
        let (line, known) = (!self.args.quiet, self.changes.known().clone());
        let kept = Some(self.kept.clone());
        let beat = self.beat.clone();
        let course = load::Course { beat, known, line, kept, ..load::Course::default() };
        self.is_good = false;
        self.asked = course.asked.clone();
        let text = match self.read(&course)? {
            Ended::Done(text) => text,
            Ended::Left(noticed) => return Ok(after(noticed)),
        };
        let hashes = text.scene.as_ref().map(Scene::hashes);
        if let (Some(Shown { subject, .. }), Some(hashes)) = (&mut self.shown, &hashes)
            && subject.is_of(hashes, self.changes.known())
        {
            (self.is_good, self.impatient) = (true, true);
            subject.read_again(&text);
            self.changes.expect(subject.files.clone());
            report::diagnostics(&text.diagnostics, &text.sources, form, Stream::Error)?;
            let Subject { warnings, read, .. } = &*subject;
            let told = [(&text.diagnostics, &text.sources), (warnings, &read.sources)];
            self.audience.page().inspect(|page| page.problems(&told));
            self.as_before(begun)?;
            return Ok(Next::Wait);
        }
        let (texts, n_told) = (text.files.asked().into_keys().collect(), text.diagnostics.len());
        let loaded = match self.build(text, &course)? {
            Ended::Done(loaded) => loaded,
            Ended::Left(noticed) => return Ok(after(noticed)),
        };
        self.impatient = true;
        let mut watched = loaded.files.asked();
        watched.extend(self.libraries.clone());
        self.changes.expect(watched.clone());
        // Half a save looks like a mistake: the wait tells at once of the other half.
        if loaded.stage.is_some() || !self.changes.more_to_come() {
            report::diagnostics(&loaded.diagnostics, &loaded.sources, form, Stream::Error)?;
            let told = [(&loaded.diagnostics, &loaded.sources)];
            if loaded.stage.is_some() {
                self.audience.page().inspect(|page| page.begins());
            }
            self.audience.page().inspect(|page| page.problems(&told));
            self.has_told = loaded.stage.is_none();
        }
        let Loaded { scene, stage, files, sources, mut diagnostics, anew, origin } = loaded;
        if let (Some(stage), Some(scene), Some(hashes)) = (stage, scene, hashes) {
            self.is_good = true;
            let before = self.shown.as_ref().map(|Shown { subject, .. }| subject);
            let changes = before.map_or(vec![], |before| {
                edit::changes((&before.scene, &before.files), (&scene, &watched), &texts)
            });
            let edit = Edit::new(changes, anew, begun.elapsed().as_secs_f64());
            self.tell(&edit.words(), report::aside);
            self.audience.page().inspect(|page| page.changed(edit.words()));
            let (scene, stage) = (Arc::new(scene), Arc::new(stage));
            let read = Arc::new(Read { files, sources, origin });
            let warnings = diagnostics.split_off(n_told.min(diagnostics.len()));
            let files = watched;
            self.turn_to(Subject { scene, hashes, stage, read, files, texts, warnings }, edit);
        }
        Ok(Next::Wait)
    }

    /// What stood in the way of the picture may stand there no more.
    fn try_again(&mut self) {
        let Some(Shown { subject, sitting, .. }) = &self.shown else { return };
        if sitting.wants_again() {
            self.press.tray().put(sitting.clone(), self.guard.saving());
        } else if sitting.is_lost() {
            let (subject, edit) = (subject.clone(), Edit::new(vec![], Anew::default(), 0.0));
            self.show(subject, edit);
        }
    }

    /// The scene is as before: a mistake that was told since is gone, which is told too.
    fn as_before(&mut self, begun: Instant) -> Result<(), Failure> {
        self.try_again();
        if !std::mem::take(&mut self.has_told) {
            return Ok(());
        }
        let edit = Edit::new(vec![], Anew::default(), begun.elapsed().as_secs_f64());
        self.tell(&format!("as before · {}", edit.words()), report::note);
        if !self.args.json {
            return Ok(());
        }
        report::out(&format!("{}\n", json!({ "edit": edit.json() })))
    }

    /// Says what a save came to, to people.
    fn tell(&self, words: &str, say: fn(&str)) {
        if !self.args.quiet && !self.args.json {
            say(words);
        }
    }

    /// Does a part of making a scene ready, unless `look` notices something.
    fn attempt<T: Send + 'scope>(
        &mut self,
        work: impl FnOnce() -> Result<T, Failure> + Send + 'scope,
        course: &load::Course,
        look: &mut dyn FnMut(&mut Changes) -> Noticed,
    ) -> Result<Ended<T>, Failure> {
        self.in_hand.get().1 = course.watch.clone();
        let (changes, impatient) = (&mut self.changes, self.impatient);
        let look = || match look(changes) {
            Noticed::Save if !impatient => {
                std::thread::sleep(TICK);
                Noticed::Nothing
            }
            noticed => noticed,
        };
        let ended = self.attempts.run(work, look, || course.watch.cancel());
        self.impatient &= !matches!(ended, Ok(Ended::Left(_)));
        ended
    }

    /// Reads the scene, unless a save comes between.
    fn read(&mut self, course: &load::Course) -> Result<Ended<Text>, Failure> {
        let (args, page, plugins) = (self.args, self.audience.page(), self.plugins.clone());
        let own = course.clone();
        let (mut expected, begun) = (Watched::new(), Instant::now());
        let ended = self.attempt(
            move || reading::read(args, &plugins, page, &own),
            course,
            &mut |changes| {
                if begun.elapsed() < SHORT {
                    std::thread::sleep(STEP);
                    return Noticed::Nothing;
                }
                let now = course.asked.lock().unwrap_or_else(PoisonError::into_inner).clone();
                if now != expected {
                    changes.expect_more_than(now.clone(), []);
                    expected = now;
                }
                if expected.is_empty() { Noticed::Nothing } else { changes.within(TICK) }
            },
        )?;
        let before = self.shown.as_ref().map(|shown| &*shown.subject.stage);
        Ok(match ended {
            Ended::Left(noticed) => Ended::Left(noticed),
            Ended::Done(wished) => {
                Ended::Done(reading::settle(wished, args, page, before, &course.known))
            }
        })
    }

    /// Makes a scene ready, unless a save comes between.
    fn build(&mut self, text: Text, course: &load::Course) -> Result<Ended<Loaded>, Failure> {
        let mut now = text.files.asked();
        now.extend(self.libraries.clone());
        self.changes.expect(now);
        let before = self.shown.as_ref().map(|shown| shown.subject.stage.clone());
        let (file, plugins, own) = (&self.args.file, self.plugins.clone(), course.clone());
        self.attempt(
            move || load::build(file, text, &plugins, before.as_deref(), &own),
            course,
            &mut |changes| changes.within(TICK),
        )
    }
    /// Goes on with the picture before if only how it is shown has changed, else begins one.
    fn turn_to(&mut self, subject: Subject, edit: Edit) {
        let Some(shown) = &mut self.shown else { return self.show(subject, edit) };
        if shown.sitting.is_lost() || !subject.is_measured_by(&shown.subject) {
            return self.show(subject, edit);
        }
        let of = (subject.stage.clone(), subject.read.clone());
        if shown.sitting.show_as(of, edit) {
            self.press.tray().put(shown.sitting.clone(), self.guard.saving());
        }
        shown.subject = subject;
        self.audience.page().inspect(|page| page.shows(&shown.subject.stage, &shown.subject.read));
    }

    /// Ends the render before, but not the writing of its picture, and begins one.
    fn show(&mut self, subject: Subject, edit: Edit) {
        let options = self.args.render.options();
        let more = |it: &Shown<'_>| subject.goes_on_from(&it.subject, &options);
        let goes_on = self.shown.as_ref().is_some_and(more);
        let mut before = self.shown.take().map(|before| {
            before.control.supersede();
            before.sitting.pass();
            let _waits = self.beat.overtaken();
            before.ended()
        });
        let control = Arc::new(Control::default());
        self.beat.rendering(&control);
        self.in_hand.get().0.clone_from(&control);
        let (args, guard, audience, beat) = (self.args, self.guard, self.audience, self.beat);
        let (Subject { stage, read, .. }, ends) = (subject.clone(), control.clone());
        self.audience.page().inspect(|page| page.stands_at(&stage, &self.plugins.registry, &read));
        let of_samples = args.render.options().samples(&stage);
        let mut look = audience.follow(&stage, &read, of_samples);
        let sitting = Arc::new(Sitting::new(stage.clone(), read.clone(), Some(edit)));
        let (sits, tray) = (sitting.clone(), self.press.tray().clone());
        let thread = self.scope.spawn(move || {
            let course = Course { control: &ends, guard, beat };
            before.as_ref().filter(|_| goes_on).inspect(|before| sits.go_on_from(before));
            // Until it is seen, the coarse picture of a page has hardly any room of its own.
            before = before.filter(|_| args.preview);
            let mut look = |film: &Film, now: Reached| {
                look(film, now);
                // To give back the room of a picture takes as long as to make the first of another.
                before = None;
            };
            match sits.render(args, &course, &mut look) {
                Ok(true) => tray.put(sits, guard.saving()),
                Ok(false) => {}
                Err(failure) => audience.lost(&failure),
            }
            if let Some(page) = audience.page().filter(|_| stage.has_failed()) {
                page.broke(&stage.failures(), &read.sources);
            }
        });
        self.shown = Some(Shown { subject, sitting, control, thread });
    }

    /// Ends the picture in hand, and what is still to be written: whether it was whole.
    fn end(self) -> bool {
        let sitting = self.shown.map(|shown| {
            shown.control.cancel();
            shown.ended()
        });
        self.press.end();
        sitting.is_some_and(|sitting| sitting.is_written())
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
        let known = self.changes.known();
        if self.libraries.iter().all(|(path, seen)| known.look(path) == *seen) {
            return Ok(());
        }
        self.beat.phase(Phase::Opening);
        match session.refresh(args, surroundings) {
            Ok(renewed) => {
                self.beat.opened(renewed.open(), &renewed.watched);
                self.libraries.clone_from(&renewed.watched);
                self.plugins = Arc::new(renewed);
                self.kept = Arc::default();
                self.plugins.notes.tell(self.args.form(), Stream::Error)
            }
            // A lock or configuration that cannot be understood leaves everything as it was.
            Err(failure) => {
                self.audience.failed(&failure);
                let seen = |path: &PathBuf| (path.clone(), look(path));
                self.libraries = self.libraries.keys().map(seen).collect();
                Ok(())
            }
        }
    }
}
