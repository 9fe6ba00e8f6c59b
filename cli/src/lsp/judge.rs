//! Evaluation apart from answering: after a pause, and given up for a newer text.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use luxel_core::accel::Watch;
use luxel_core::diag::{Diagnostic, Grade, Severity, SourceId, Sources, Span};
use luxel_core::files::normalise;
use luxel_core::stage::{self, Unbuilt};
use luxel_lang::{Kept, Values};

use super::Limits;
use super::files::Overlay;
use super::queue::{Event, Queue};
use crate::exit::blaming;
use crate::libraries::Plugins;

/// How long nothing must change before scenes are evaluated of which that takes long.
const PAUSE: Duration = Duration::from_millis(200);
/// What is no longer than that is done at every letter.
const SHORT: Duration = Duration::from_millis(50);
/// The stack of an evaluation: several times what the budgets allow.
const STACK: usize = 16 << 20;

/// Scenes to evaluate.
pub(super) struct Job {
    /// Counts the edits.
    pub(super) serial: u64,
    /// The scenes, and whether their meshes and textures are read too.
    pub(super) roots: BTreeMap<PathBuf, bool>,
    /// The texts that are open.
    pub(super) texts: Arc<BTreeMap<PathBuf, Arc<[u8]>>>,
}

/// What came of a job.
pub(super) struct Verdict {
    pub(super) serial: u64,
    pub(super) roots: Vec<Judged>,
}

/// What came of a scene.
#[derive(Default)]
pub(super) struct Judged {
    pub(super) root: PathBuf,
    pub(super) told: Vec<Told>,
    /// What is wrong with meshes and textures; `None` if they were not read.
    pub(super) built: Option<Vec<Told>>,
    pub(super) values: Valued,
}

/// Bytes of a file.
pub(super) type Bytes = (PathBuf, Range<usize>);

/// A diagnostic whose places are in files by name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Told {
    pub(super) code: &'static str,
    pub(super) severity: Severity,
    pub(super) message: String,
    pub(super) help: Vec<String>,
    /// Where; nowhere in particular of the root if there are no bytes.
    pub(super) place: Bytes,
    pub(super) is_placed: bool,
    pub(super) labels: Vec<(Bytes, String)>,
    pub(super) fixes: Vec<Mend>,
}

/// A new text for a place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mend {
    pub(super) place: Bytes,
    pub(super) text: String,
    pub(super) grade: Grade,
}

impl Told {
    /// A diagnostic of a load whose root is a file.
    pub(super) fn new(found: Diagnostic, root: &Path, path_of: &dyn Fn(Span) -> PathBuf) -> Self {
        let bytes = |span: Span| (path_of(span), span.range());
        let is_placed = found.span().is_some();
        let place = found.span().map_or_else(|| (root.to_owned(), 0..0), bytes);
        let labels = found.labels.into_iter().skip(1);
        let fixes = found.fixes.into_iter().map(|fix| {
            let (place, text, grade) = (bytes(fix.span), fix.replacement, fix.grade);
            Mend { place, text, grade }
        });
        Self {
            code: found.code,
            severity: found.severity,
            message: found.message,
            help: found.help,
            place,
            is_placed,
            labels: labels.map(|label| (bytes(label.span), label.text)).collect(),
            fixes: fixes.collect(),
        }
    }
}

/// What names of a scene have for values.
#[derive(Default)]
pub(super) struct Valued {
    values: Values,
    /// The files that were read.
    texts: Vec<PathBuf>,
    /// What has been edited since: the bytes of a file, and how many came in their place.
    edits: Vec<(PathBuf, Range<usize>, usize)>,
}

impl Valued {
    /// The value of the name whose first byte stands there now.
    pub(super) fn at(&self, path: &Path, mut byte: usize) -> Option<Cow<'_, str>> {
        for (_, range, length) in self.edits.iter().rev().filter(|edit| edit.0 == path) {
            let end = range.start + length;
            if byte > end {
                byte = byte - end + range.end;
            } else if byte >= range.start {
                return None;
            }
        }
        let texts = (0..).map(SourceId).zip(&self.texts);
        texts.filter(|(_, text)| *text == path).find_map(|(source, _)| self.values.at(source, byte))
    }

    /// A file has been edited.
    pub(super) fn edit(&mut self, path: &Path, range: &Range<usize>, length: usize) {
        if self.texts.iter().any(|text| text == path) {
            self.edits.push((path.to_owned(), range.clone(), length));
        }
    }
}

/// The thread that evaluates.
pub(super) struct Judge(Arc<Desk>);

#[derive(Default)]
struct Desk {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    job: Option<Job>,
    /// Ends what is being evaluated.
    watch: Arc<Watch>,
}

impl Desk {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Judge {
    /// Starts the thread.
    pub(super) fn start(queue: Arc<Queue>, plugins: Arc<Plugins>, limits: Limits) -> Self {
        let desk = Arc::new(Desk::default());
        let own = desk.clone();
        let thread = std::thread::Builder::new().name("judge".to_owned()).stack_size(STACK);
        // Without it, what is written and named is told all the same.
        let _ = thread.spawn(move || {
            let (mut all, mut pause) = (BTreeMap::<PathBuf, Kept>::new(), PAUSE);
            loop {
                let (job, watch) = next(&own, pause);
                all.retain(|root, _| job.texts.contains_key(root));
                let mut is_short = true;
                let mut one = |(root, whole): (&PathBuf, &bool)| {
                    let kept = all.entry(root.clone()).or_default();
                    let course = (&job, &*watch, *whole);
                    let (judged, took) = judged(root, kept, course, (&plugins, &limits));
                    is_short &= took < SHORT || kept.n_evaluated().is_some();
                    judged
                };
                let roots = job.roots.iter().map(&mut one).collect();
                pause = if is_short { Duration::ZERO } else { PAUSE };
                if !watch.is_cancelled() {
                    queue.put(Event::Judged(Verdict { serial: job.serial, roots }));
                }
            }
        });
        Self(desk)
    }

    /// Gives up what waits and what is being evaluated for a newer job.
    pub(super) fn put(&self, job: Job) {
        let mut state = self.0.lock();
        state.watch.cancel();
        state.job = Some(job);
        self.0.changed.notify_one();
    }
}

/// Waits for a job, and until it has not changed for a while.
fn next(desk: &Desk, pause: Duration) -> (Job, Arc<Watch>) {
    let mut state = desk.lock();
    loop {
        let Some(serial) = state.job.as_ref().map(|job| job.serial) else {
            state = desk.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
            continue;
        };
        let waited = desk.changed.wait_timeout(state, pause);
        state = waited.unwrap_or_else(PoisonError::into_inner).0;
        if let Some(job) = state.job.take_if(|job| job.serial == serial) {
            state.watch = Arc::default();
            return (job, state.watch.clone());
        }
    }
}

/// What came of a scene, and how long reading and evaluating it took.
fn judged(
    root: &Path,
    kept: &mut Kept,
    (job, watch, whole): (&Job, &Watch, bool),
    (plugins, limits): (&Plugins, &Limits),
) -> (Judged, Duration) {
    let (start, mut took) = (Instant::now(), Duration::ZERO);
    let run = || {
        let files = Overlay::new(root, &limits.allow, &job.texts);
        let settings = luxel_lang::Settings {
            unloaded: plugins.unloaded(),
            noting: true,
            without_scene: !whole,
            stop: Some(watch.flag()),
            budgets: limits.budgets,
            ..Default::default()
        };
        let mut loaded = kept.load(root, &files, &plugins.registry, &settings);
        let most = usize::try_from(limits.budgets.instances).unwrap_or(usize::MAX);
        loaded.scene.iter_mut().for_each(|scene| scene.allow_instances(most));
        took = start.elapsed();
        let build =
            |scene| match stage::build_watched(scene, &plugins.registry, &files, None, watch) {
                Ok(built) => built.warnings,
                Err(Unbuilt::Faulty(faults)) => faults,
                Err(Unbuilt::Cancelled) => vec![],
            };
        let look = |rest| stage::faults(rest, &plugins.registry, &files, None, watch);
        let built = || loaded.scene.as_ref().map(build).or_else(|| loaded.rest.as_ref().map(look));
        let built = whole.then(|| built().unwrap_or_default());
        of_sources(root, (loaded.diagnostics, built), &loaded.sources, loaded.values)
    };
    let judged = blaming(&root.display().to_string(), run).unwrap_or_else(|failure| {
        // A panic may have left half of it.
        *kept = Kept::default();
        let found = Diagnostic::unplaced("E0421", failure.message);
        let told = vec![Told::new(found, root, &|_| root.into())];
        Judged { root: root.to_owned(), told, ..Judged::default() }
    });
    (judged, took)
}

fn of_sources(
    root: &Path,
    (found, built): (Vec<Diagnostic>, Option<Vec<Diagnostic>>),
    sources: &Sources,
    values: Values,
) -> Judged {
    let path_of = |span: Span| normalise(Path::new(sources.name(span.source)));
    let all = |found: Vec<Diagnostic>| -> Vec<Told> {
        found.into_iter().map(|found| Told::new(found, root, &path_of)).collect()
    };
    let n_texts = u32::try_from(sources.n_texts()).unwrap_or(u32::MAX);
    let texts = (0..n_texts).map(|i| normalise(Path::new(sources.name(SourceId(i))))).collect();
    let values = Valued { values, texts, edits: vec![] };
    Judged { root: root.to_owned(), told: all(found), built: built.map(all), values }
}
