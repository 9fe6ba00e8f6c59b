//! The page beside a watch: every picture as it grows, mistakes, and what a pixel shows.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::RecvTimeoutError;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use glam::UVec2;
use luxel_core::diag::{Diagnostic, Sources, in_order};
use luxel_core::film::Film;
use luxel_core::registry::Registry;
use luxel_core::render::Reached;
use luxel_core::stage::Stage;

use super::camera;
use super::facts::{Facts, facts};
use super::round::Read;
use super::wishes::Wishes;
use crate::exit::{Failure, blaming};
use crate::isolate::Address;
use crate::preview::{
    Command, Editor, Exact, Frame, PACE, PageArgs, Param, PixelReply, Preview, Problem, Screen,
};
use crate::report;

/// Between two looks at whether the watch has ended.
const LOOK: Duration = Duration::from_millis(100);

/// What is asked about: the scene on the page.
type About = Arc<Mutex<Option<(Arc<Stage>, Arc<Read>)>>>;

/// The values of the picture on the page.
type Values = Arc<Mutex<Option<Exact>>>;

/// A page that shows what is watched. Dropped, it is served no more.
pub(super) struct Page {
    address: Address,
    screen: Screen,
    about: About,
    values: Values,
    wishes: Arc<Wishes>,
    generation: AtomicU64,
    /// How far the picture is.
    standing: Arc<Mutex<Standing>>,
    /// Why the picture of the scene is not what it should be.
    broken: Mutex<Vec<Problem>>,
    ended: Arc<AtomicBool>,
    answering: Option<JoinHandle<()>>,
}

impl Page {
    /// Serves it, and tells where, unless it takes the place of another one; what it asks for beyond the
    /// file is wished for.
    ///
    /// # Errors
    /// A port that is taken.
    pub(super) fn start(
        file: &Path,
        args: &PageArgs,
        editor: Option<Editor>,
        (wishes, again): (Wishes, Option<&Address>),
    ) -> Result<Self, Failure> {
        let title = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy().into_owned();
        let mut preview = Preview::start(args, &title, again)?;
        if again.is_none() {
            report::note(&format!("preview: {}", preview.url()));
            if !args.no_open && std::io::stderr().is_terminal() {
                preview.open();
            }
        }
        let address = preview.address().clone();
        let (screen, wishes) = (preview.screen().clone(), Arc::new(wishes));
        let answering = Answering {
            editor,
            wishes: wishes.clone(),
            about: About::default(),
            values: Values::default(),
        };
        let (about, values) = (answering.about.clone(), answering.values.clone());
        let ended = Arc::new(AtomicBool::new(false));
        let over = ended.clone();
        let answering = Some(std::thread::spawn(move || answering.answer(&preview, &over)));
        Ok(Self {
            address,
            screen,
            about,
            values,
            wishes,
            generation: AtomicU64::new(0),
            standing: Arc::default(),
            broken: Mutex::default(),
            ended,
            answering,
        })
    }

    /// Where it is served.
    pub(super) fn address(&self) -> &Address {
        &self.address
    }

    /// Tells that a save has been noticed, until it is known what it shows.
    pub(super) fn reading(&self) {
        self.screen.expect();
        self.screen.status("reading");
    }

    /// Tells what the last save changed.
    pub(super) fn changed(&self, words: String) {
        lock(&self.standing).changed = words;
    }

    /// Tells how far the picture is.
    pub(super) fn has_read(&self) {
        self.screen.status(&lock(&self.standing).line());
    }

    /// What the page asks for beyond the file.
    pub(super) fn wishes(&self) -> &Wishes {
        &self.wishes
    }

    /// Offers what may be set, and says how a command line sets what is set now.
    pub(super) fn params(&self, params: &[Param], line: &str) {
        self.screen.params(params, line);
    }

    /// Tells where the camera of a scene stands that is shown from now on.
    pub(super) fn stands_at(&self, stage: &Stage, registry: &Registry, read: &Read) {
        let told = || camera::told(stage, (registry, &read.sources), self.wishes.wished());
        // Shapes are asked what the middle shows; one that panics is told of by the render.
        self.screen.camera(blaming("", told).ok().flatten().as_ref());
    }

    /// Lays messages over the last good picture, each list with the texts that it is about; none
    /// takes them away, but not what is told of the picture itself.
    pub(super) fn problems(&self, found: &[(&Vec<Diagnostic>, &Sources)]) {
        let told = found.iter().flat_map(|(found, sources)| problems(found, sources));
        let broken = self.broken.lock().unwrap_or_else(PoisonError::into_inner).clone();
        self.screen.problems(&told.chain(broken).collect::<Vec<_>>());
    }

    /// There is a scene whose picture is still to be written: what was told of the one before is over.
    pub(super) fn begins(&self) {
        lock(&self.broken).clear();
    }

    /// Why something could not be done, over the last good picture.
    pub(super) fn failed(&self, failure: &Failure) {
        self.screen.problems(&[Problem::of_failure(failure)]);
    }

    /// Why there is no picture of the scene, until there is another scene.
    pub(super) fn lost(&self, failure: &Failure) {
        self.stands(vec![Problem::of_failure(failure)]);
    }

    /// What broke while the picture was made, until there is another scene.
    pub(super) fn broke(&self, found: &[Diagnostic], sources: &Sources) {
        self.stands(problems(found, sources).collect());
    }

    fn stands(&self, told: Vec<Problem>) {
        self.screen.problems(&told);
        *self.broken.lock().unwrap_or_else(PoisonError::into_inner) = told;
    }

    /// The picture shows this from now on, which differs only in how it is shown.
    pub(super) fn shows(&self, stage: &Arc<Stage>, read: &Arc<Read>) {
        let mut about = lock(&self.about);
        *about = Some((stage.clone(), read.clone()));
        self.screen.shown_as(&stage.film);
        drop(about);
        self.has_read();
    }

    /// Shows pictures of a scene from now on, of so many samples in the end.
    pub(super) fn follow(
        &self,
        stage: &Arc<Stage>,
        read: &Arc<Read>,
        of_samples: u32,
    ) -> impl FnMut(&Film, Reached) + Send + use<> {
        *lock(&self.about) = Some((stage.clone(), read.clone()));
        self.broken.lock().unwrap_or_else(PoisonError::into_inner).clear();
        let generation = self.generation.fetch_add(1, Ordering::Relaxed) + 1;
        let (screen, about, values) =
            (self.screen.clone(), self.about.clone(), self.values.clone());
        let (standing, settings) = (self.standing.clone(), stage.film.clone());
        "rendering".clone_into(&mut lock(&standing).reached);
        self.has_read();
        let mut last = None;
        move |film: &Film, now: Reached| {
            let is_last = now.step == 1 && now.samples >= of_samples;
            let is_soon = now.samples > 1 && last.is_some_and(|at: Instant| at.elapsed() < PACE);
            if !now.is_whole || !is_last && (is_soon || !screen.is_watched()) {
                return;
            }
            // Held until it is shown, so that another exposure comes after it and not in between.
            let about = lock(&about);
            let settings = about.as_ref().map_or(&settings, |(stage, _)| &stage.film);
            let exact = Exact::of_film(film, now.step);
            let frame = Frame::of_exact(&exact, settings, (now, of_samples));
            let mut values = lock(&values);
            screen.show(&Frame { generation, ..frame });
            *values = Some(exact);
            drop((about, values));
            let mut standing = lock(&standing);
            standing.reached = status(now, of_samples);
            screen.status(&standing.line());
            last = Some(Instant::now());
        }
    }
}

/// How far the picture is, and what it shows that the one before did not.
#[derive(Default)]
struct Standing {
    reached: String,
    changed: String,
}

impl Standing {
    fn line(&self) -> String {
        let parts = [&*self.reached, &self.changed];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(" · ")
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        let _ = self.answering.take().map(JoinHandle::join);
    }
}

fn problems(found: &[Diagnostic], sources: &Sources) -> impl Iterator<Item = Problem> {
    in_order(found).into_iter().map(move |found| Problem::of_diagnostic(&found, sources))
}

fn status(now: Reached, of_samples: u32) -> String {
    match now {
        Reached { step: 1, samples, .. } if samples >= of_samples => {
            format!("{samples} samples, done")
        }
        Reached { step: 1, samples, .. } => format!("{samples} of {of_samples} samples"),
        Reached { step, .. } => format!("coarse: one pixel of {}", step * step),
    }
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Whoever answers what the page asks.
struct Answering {
    editor: Option<Editor>,
    wishes: Arc<Wishes>,
    about: About,
    values: Values,
}

impl Answering {
    /// Until the watch has ended.
    fn answer(&self, preview: &Preview, ended: &AtomicBool) {
        while !ended.load(Ordering::Relaxed) {
            let (at, side) = match preview.commands().recv_timeout(LOOK) {
                Ok(Command::Pixel { at, side }) => (UVec2::from(at), side),
                Ok(Command::Set { name, value }) => {
                    self.wishes.change(|wish| wish.set(name, value));
                    continue;
                }
                Ok(Command::Camera { view }) => {
                    let to = view.as_ref().map(camera::view);
                    // What is no view changes nothing.
                    if to != Some(None) {
                        self.wishes.change(|wish| wish.view = to.flatten());
                    }
                    continue;
                }
                Ok(Command::ResetParams) => {
                    self.wishes.change(|wish| wish.set.clear());
                    continue;
                }
                // Layers are those of files.
                Ok(Command::Layer { .. }) | Err(RecvTimeoutError::Timeout) => continue,
                Err(RecvTimeoutError::Disconnected) => return,
            };
            let scene = lock(&self.about).clone();
            let told = |(stage, read): (Arc<Stage>, Arc<Read>)| {
                let told = || facts(&stage, &read.sources, self.editor.as_ref(), at);
                // A shape that panics is told of by the render.
                blaming("", told).unwrap_or_default()
            };
            let Facts { told, places } = scene.map(told).unwrap_or_default();
            let mut facts = lock(&self.values).as_ref().map_or(vec![], |values| values.facts(at));
            facts.extend(told);
            preview.screen().pixel(&PixelReply { at, side, facts, places });
        }
    }
}
