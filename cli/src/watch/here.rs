//! Watching and rendering in one process: what is saved is read while the last picture goes on, and
//! ends it only if it shows something else.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{Scope, ScopedJoinHandle};

use luxel_core::render::Control;
use luxel_core::scene::Hash;
use luxel_core::stage::Stage;

use super::Args;
use super::changes::{Changes, Wake};
use super::round::{self, Course, Read};
use crate::args::PluginArgs;
use crate::exit::{Exit, Failure};
use crate::files::{Seen, Watched, look};
use crate::interrupt::Guard;
use crate::isolate::Beat;
use crate::libraries::{Plugins, Session, Surroundings};
use crate::load::{self, Loaded, Text};
use crate::report::{self, Form, Stream};

/// The render in flight, so that Ctrl-C can end it.
type Current = Arc<Mutex<Arc<Control>>>;

pub(super) fn watch(args: &Args) -> Result<Exit, Failure> {
    let (mut session, surroundings) = (Session::new(), Surroundings::of_process());
    let plugins = session.refresh(&args.plugins, &surroundings)?;
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
    changes.arm([args.file.as_path()])?;
    std::thread::scope(|scope| {
        let shown = None;
        let mut watching =
            Watching { args, scope, guard: &guard, current, course, plugins, changes, shown };
        loop {
            watching.round()?;
            if !watching.changes.wait() {
                watching.end();
                report::note("watching has ended");
                return Ok(Exit::Fine);
            }
            watching.renew(&mut session, (&args.plugins, &surroundings))?;
        }
    })
}

struct Watching<'scope, 'env> {
    args: &'env Args,
    scope: &'scope Scope<'scope, 'env>,
    guard: &'env Guard,
    current: Current,
    course: load::Course,
    plugins: Plugins,
    changes: Changes,
    /// The last good scene.
    shown: Option<Shown<'scope>>,
}

/// A scene whose picture is rendered, or was.
struct Shown<'scope> {
    hash: Hash,
    scene: Arc<(Stage, Read)>,
    /// Everything that it was made of, and which of that is text that the hash speaks for.
    files: Watched,
    texts: BTreeSet<PathBuf>,
    control: Arc<Control>,
    thread: Option<ScopedJoinHandle<'scope, ()>>,
}

impl Shown<'_> {
    /// Ends its render, if that still runs, once there is something to see.
    fn supersede(&self) {
        if self.thread.as_ref().is_some_and(|thread| !thread.is_finished()) {
            self.control.supersede();
        }
    }

    /// Whether a text that was read shows the same scene, of files that have not changed.
    fn is_of(&self, text: &Text) -> bool {
        let same =
            |(path, seen): (&PathBuf, &Seen)| self.texts.contains(path) || look(path) == *seen;
        text.scene.as_ref().is_some_and(|scene| scene.hash() == self.hash)
            && !self.scene.0.has_failed()
            && self.files.iter().all(same)
    }
}

impl<'scope> Watching<'scope, '_> {
    /// Reads the scene, and renders it if it shows something else than before.
    ///
    /// # Errors
    /// If standard error cannot be written or the system watches no more files.
    fn round(&mut self) -> Result<(), Failure> {
        match self.load() {
            Ok(()) => Ok(()),
            Err(_) if self.course.watch.is_cancelled() => Ok(()),
            // A panic in a plugin ends this attempt, not the watch.
            Err(failure) => {
                report::failure(&failure);
                let libraries = self.plugins.watched.keys().map(PathBuf::as_path);
                self.changes.expect_news(libraries.chain([self.args.file.as_path()]))
            }
        }
    }

    fn load(&mut self) -> Result<(), Failure> {
        let Args { file, load, render, .. } = self.args;
        let text = load::read(file, load, render.size, &self.plugins, &self.course.beat)?;
        if let Some(shown) = &mut self.shown
            && shown.is_of(&text)
        {
            shown.files.extend(text.files.asked());
            return self.changes.expect(shown.files.clone());
        }
        let texts = text.files.asked().into_keys().collect();
        let hash = text.scene.as_ref().map(luxel_core::scene::Scene::hash);
        if let (Some(_), Some(shown)) = (hash, &self.shown) {
            shown.supersede();
        }
        let before = self.shown.as_ref().map(|shown| &shown.scene.0);
        let loaded = load::build(file, text, &self.plugins, before, &self.course)?;
        let mut watched = loaded.files.asked();
        watched.extend(self.plugins.watched.clone());
        self.changes.expect(watched.clone())?;
        report::diagnostics(&loaded.diagnostics, &loaded.sources, self.form(), Stream::Error)?;
        let Loaded { stage, files, sources, .. } = loaded;
        match (stage, hash) {
            (Some(stage), Some(hash)) => {
                let scene = Arc::new((stage, Read { files, sources }));
                self.show((hash, scene), watched, texts);
            }
            // The last good one goes on from its beginning if it was ended for this one.
            _ => self.show_again(),
        }
        Ok(())
    }

    fn form(&self) -> Form {
        self.args.form()
    }

    /// Ends the picture before, and begins one.
    fn show(
        &mut self,
        (hash, scene): (Hash, Arc<(Stage, Read)>),
        files: Watched,
        texts: BTreeSet<PathBuf>,
    ) {
        if let Some(thread) = self.shown.take().and_then(|shown| shown.thread) {
            // What it has to say it has said; a panic was caught and told inside.
            let _ = thread.join();
        }
        let control = Arc::new(Control::default());
        self.current.lock().unwrap_or_else(PoisonError::into_inner).clone_from(&control);
        let thread = Some(self.render(scene.clone(), control.clone()));
        self.shown = Some(Shown { hash, scene, files, texts, control, thread });
    }

    fn show_again(&mut self) {
        let Some(shown) = self.shown.take_if(|shown| shown.control.is_superseded()) else { return };
        let (scene, files, texts) = (shown.scene.clone(), shown.files.clone(), shown.texts.clone());
        let hash = shown.hash;
        self.shown = Some(shown);
        self.show((hash, scene), files, texts);
    }

    fn render(
        &self,
        scene: Arc<(Stage, Read)>,
        control: Arc<Control>,
    ) -> ScopedJoinHandle<'scope, ()> {
        let (args, guard) = (self.args, self.guard);
        self.scope.spawn(move || {
            let course = Course { control: &control, guard, beat: &Beat::silent() };
            let (stage, read) = &*scene;
            if let Err(failure) = round::render(args, (stage, read), &course, &mut |_, _| {}) {
                report::failure(&failure);
            }
        })
    }

    /// Ends the picture in hand.
    fn end(&mut self) {
        if let Some(shown) = self.shown.take() {
            shown.control.cancel();
            let _ = shown.thread.map(ScopedJoinHandle::join);
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
                self.plugins.notes.tell(self.form(), Stream::Error)
            }
            // A lock or configuration that cannot be understood leaves everything as it was.
            Err(failure) => {
                report::failure(&failure);
                let seen = |path: &PathBuf| (path.clone(), look(path));
                self.plugins.watched = self.plugins.watched.keys().map(seen).collect();
                Ok(())
            }
        }
    }
}
