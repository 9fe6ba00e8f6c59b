//! The page beside a watch: every picture as it grows, mistakes, and what a pixel shows.

use std::io::IsTerminal;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::RecvTimeoutError;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use glam::UVec2;
use luxel_core::diag::{Diagnostic, Sources, Span};
use luxel_core::film::Film;
use luxel_core::render::Reached;
use luxel_core::scene::{Node, NodeId};
use luxel_core::stage::{Skin, Stage};

use super::round::Read;
use crate::exit::Failure;
use crate::preview::{Command, Frame, PACE, PageArgs, PixelReply, Preview, Problem, Screen};
use crate::report;

/// Between two looks at whether the watch has ended.
const LOOK: Duration = Duration::from_millis(100);

/// What is asked about: the scene on the page.
type About = Arc<Mutex<Option<(Arc<Stage>, Arc<Read>)>>>;

/// A page that shows what is watched. Dropped, it is served no more.
pub(super) struct Page {
    screen: Screen,
    about: About,
    generation: AtomicU64,
    /// How far the picture is.
    standing: Arc<Mutex<String>>,
    /// Why the picture of the scene is not what it should be.
    broken: Mutex<Vec<Problem>>,
    ended: Arc<AtomicBool>,
    answering: Option<JoinHandle<()>>,
}

impl Page {
    /// Serves it, and tells where.
    ///
    /// # Errors
    /// A port that is taken.
    pub(super) fn start(file: &Path, args: &PageArgs) -> Result<Self, Failure> {
        let title = file.file_name().unwrap_or(file.as_os_str()).to_string_lossy().into_owned();
        let mut preview = Preview::start(args, &title)?;
        report::note(&format!("preview: {}", preview.url()));
        if !args.no_open && std::io::stderr().is_terminal() {
            preview.open();
        }
        let (screen, about) = (preview.screen().clone(), About::default());
        let ended = Arc::new(AtomicBool::new(false));
        let (subject, over) = (about.clone(), ended.clone());
        let answering = std::thread::spawn(move || answer(&preview, &subject, &over));
        let (generation, broken, answering) =
            (AtomicU64::new(0), Mutex::default(), Some(answering));
        let standing = Arc::default();
        Ok(Self { screen, about, generation, standing, broken, ended, answering })
    }

    /// Tells that a save has been noticed, until it is known what it shows.
    pub(super) fn reading(&self) {
        self.screen.status("reading");
    }

    /// Tells how far the picture is.
    pub(super) fn has_read(&self) {
        self.screen.status(&lock(&self.standing));
    }

    /// Lays messages over the last good picture, each list with the texts that it is about; none
    /// takes them away, but not what is told of the picture itself.
    pub(super) fn problems(&self, found: &[(&Vec<Diagnostic>, &Sources)]) {
        let told = found.iter().flat_map(|(found, sources)| problems(found, sources));
        let broken = self.broken.lock().unwrap_or_else(PoisonError::into_inner).clone();
        self.screen.problems(&told.chain(broken).collect::<Vec<_>>());
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
        *lock(&self.about) = Some((stage.clone(), read.clone()));
        self.screen.shown_as(&stage.film);
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
        let (screen, about) = (self.screen.clone(), self.about.clone());
        let (standing, settings) = (self.standing.clone(), stage.film.clone());
        "rendering".clone_into(&mut lock(&standing));
        let mut last = None;
        move |film: &Film, now: Reached| {
            let is_last = now.step == 1 && now.samples >= of_samples;
            let is_soon = now.samples > 1 && last.is_some_and(|at: Instant| at.elapsed() < PACE);
            if !is_last && (is_soon || !screen.is_watched()) {
                return;
            }
            let shown = lock(&about).as_ref().map(|(stage, _)| stage.film.clone());
            let settings = shown.as_ref().unwrap_or(&settings);
            let frame = Frame::of_film(film, settings, (now, of_samples));
            screen.show(&Frame { generation, ..frame });
            let status = status(now, of_samples);
            screen.status(&status);
            *lock(&standing) = status;
            last = Some(Instant::now());
        }
    }
}

impl Drop for Page {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        let _ = self.answering.take().map(JoinHandle::join);
    }
}

fn problems(found: &[Diagnostic], sources: &Sources) -> impl Iterator<Item = Problem> {
    found.iter().map(move |found| Problem::of_diagnostic(found, sources))
}

fn status(now: Reached, of_samples: u32) -> String {
    match now {
        Reached { step: 1, samples } if samples >= of_samples => format!("{samples} samples, done"),
        Reached { step: 1, samples } => format!("{samples} of {of_samples} samples"),
        Reached { step, .. } => format!("coarse: one pixel of {}", step * step),
    }
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Answers what the page asks, until the watch has ended.
fn answer(preview: &Preview, about: &About, ended: &AtomicBool) {
    while !ended.load(Ordering::Relaxed) {
        let (at, side) = match preview.commands().recv_timeout(LOOK) {
            Ok(Command::Pixel { at, side }) => (UVec2::from(at), side),
            Err(RecvTimeoutError::Timeout) => continue,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        let scene = lock(about).clone();
        let facts = scene.map_or(vec![], |(stage, read)| facts(&stage, &read.sources, at));
        preview.screen().pixel(&PixelReply { at, side, facts });
    }
}

/// What the middle of a pixel shows, as names and values.
fn facts(stage: &Stage, sources: &Sources, at: UVec2) -> Vec<(String, String)> {
    let inside = at.cmplt(stage.film.resolution).all();
    let Some((first, placement)) = inside.then(|| stage.probe(at)).flatten() else {
        return vec![("shape".into(), "none: the light of the sky".into())];
    };
    let about = |id: NodeId| {
        let node = stage.scene.nodes.get(id.0 as usize)?;
        Some((name(node), place(node.span, sources)))
    };
    let mut facts = vec![];
    if let Some((name, place)) = about(placement.node) {
        facts.push(("shape".to_owned(), name));
        facts.push(("written at".to_owned(), place));
    }
    if let Skin::Material(material) = placement.skin
        && let Some((name, place)) = about(stage.material_nodes[material as usize])
    {
        facts.push(("material".to_owned(), format!("{name}, {place}")));
    }
    let (p, n) = (first.surface.p, first.surface.ns);
    facts.push(("depth".to_owned(), format!("{:.6} m", first.t)));
    facts.push(("point".to_owned(), format!("({:.6}, {:.6}, {:.6}) m", p.x, p.y, p.z)));
    facts.push(("normal".to_owned(), format!("({:.4}, {:.4}, {:.4})", n.x, n.y, n.z)));
    facts
}

/// What people call an object: its class, and its name if it has one.
fn name(node: &Node) -> String {
    match &node.label {
        Some(label) => format!("{} \"{label}\"", node.class),
        None => node.class.to_string(),
    }
}

fn place(span: Span, sources: &Sources) -> String {
    let at = sources.line_column(span.source, span.start as usize);
    format!("{}:{}:{}", sources.name(span.source), at.line, at.column)
}

#[cfg(test)]
mod tests {
    use luxel_core::files::MemoryFiles;
    use luxel_core::registry::Registry;

    use super::*;

    #[test]
    fn a_pixel_tells_its_shape_its_material_and_where_they_are_written() {
        let text = "scene 1\n\
            camera perspective { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }\n\
            film rgb { resolution = (9, 9) }\n\
            light constant { scale = 1 }\n\
            let grey = material diffuse { reflectance = 0.5 }\n\
            shape sphere \"ball\" { radius = 1 m, material = grey }\n";
        let mut registry = Registry::new();
        for classes in luxel_builtin::CLASSES {
            registry.add("builtin", classes).unwrap();
        }
        let files = MemoryFiles::default().with("a.scene", text.as_bytes());
        let settings = luxel_lang::Settings::default();
        let read = luxel_lang::load(Path::new("a.scene"), &files, &registry, &settings);
        let scene = read.scene.unwrap();
        let stage = luxel_core::stage::build(&scene, &registry, &files, None).unwrap().stage;
        let told = facts(&stage, &read.sources, UVec2::splat(4));
        let of = |name: &str| told.iter().find(|fact| fact.0 == name).map(|fact| fact.1.as_str());
        assert_eq!(of("shape"), Some("sphere \"ball\""));
        assert_eq!(of("written at"), Some("a.scene:6:1"));
        assert_eq!(of("depth"), Some("4.000000 m"));
        assert!(of("material").unwrap().starts_with("diffuse, a.scene:5:"), "{told:?}");
        for at in [UVec2::ZERO, UVec2::splat(9), UVec2::MAX] {
            assert_eq!(facts(&stage, &read.sources, at).len(), 1, "{at}");
        }
    }
}
