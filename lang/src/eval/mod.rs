//! Tree to scene graph, through the registry.
//!
//! Every mistake is told at its place and leaves `Value::Poison`, which no later step speaks of
//! again. Evaluation is total: functions see only what stands before them, loops run over finite
//! lists, and budgets bound steps, lists, nodes, files and nesting.

pub(crate) mod again;
mod arithmetic;
pub(crate) mod builtins;
mod by_name;
mod call;
mod elsewhere;
mod emit;
mod env;
mod exec;
mod expect;
mod expr;
mod finish;
mod given;
mod include;
mod kind;
mod lacking;
mod mention;
pub(crate) mod names;
pub(crate) mod note;
mod numbered;
mod object;
mod ops;
mod params;
mod quotes;
pub(crate) mod readable;
mod require;
mod resolve;
mod stray;
mod turns;
mod unitless;
mod unknown;
mod unseen;
mod untaken;
pub(crate) mod types;
mod value;

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

use luxel_core::diag::{Diagnostic, SourceId, Sources, Span};
use luxel_core::files::{FileError, Files};
use luxel_core::registry::Registry;
use luxel_core::scene::{Color, Group, NodeId, Scene};
use luxel_sdk::kind::Kind;

pub use self::include::unreadable;
#[cfg(test)]
pub(crate) use self::resolve::resolve;

use self::builtins::SpectrumFile;
use self::emit::Labels;
use self::include::ReadFile;
use self::unseen::Unseen;
use self::value::{Held, Module, Value};
use crate::budgets::Budgets;
use crate::sink::Sink;
use crate::{Loaded, ParamInfo, Settings, Unloaded};

/// Evaluates the scene at `path`.
pub(crate) fn load(
    path: &Path,
    files: &dyn Files,
    registry: &Registry,
    settings: &Settings,
) -> Loaded {
    load_in_turns(path, files, registry, settings, turns::TURN)
}

/// The same; a root file of so many bytes is read in turns of so many.
fn load_in_turns(
    path: &Path,
    files: &dyn Files,
    registry: &Registry,
    settings: &Settings,
    turn: usize,
) -> Loaded {
    let mut evaluator = Evaluator::new(files, registry, settings, turn);
    evaluator.root(path, &settings.set);
    evaluator.finish()
}

/// The state of one load.
struct Evaluator<'a> {
    files: &'a dyn Files,
    registry: &'a Registry,
    unloaded: &'a [Unloaded],
    budgets: Budgets,
    sources: Sources,
    sink: Sink,
    scene: Scene,
    /// Groups that are being filled, the world first, each with its depth and instances.
    open_groups: Vec<OpenGroup>,
    /// Bytes of a large file that are read before they are evaluated.
    turn: usize,
    /// Above zero while a file is imported: its camera, film, … are not the scene's.
    quiet: usize,
    steps: u64,
    depth: usize,
    placements: usize,
    /// Everything winds up: a budget is spent, or too much was told.
    stopped: bool,
    /// Where a budget was spent, if one was.
    spent: Option<Span>,
    /// Bytes of lists and records that were made so far, and of objects that can still be named.
    held: Rc<Cell<usize>>,
    /// How often a mistake was made that had been told.
    repeats: usize,
    bytes_read: usize,
    /// Files included or imported so far.
    includes: usize,
    /// Where statements of the root file begin whose places count from there.
    begun: BTreeMap<SourceId, usize>,
    /// How often a file was asked for.
    n_reads: usize,
    /// Texts that stand among `sources` before they are read.
    n_foreseen: usize,
    /// Files that were read, by canonical path.
    read: BTreeMap<PathBuf, Rc<ReadFile>>,
    imported: BTreeMap<PathBuf, Rc<Module>>,
    /// Spectra that were read from files.
    spectra: BTreeMap<SpectrumFile, Color>,
    /// The files that are being evaluated, and where each was asked for.
    chain: Vec<(PathBuf, Option<Span>)>,
    /// The loops that are running.
    loops: Vec<Span>,
    /// The call whose body is being evaluated, the innermost.
    called: Option<Span>,
    labels: Labels,
    /// The label that a node was given last.
    last_label: Arc<str>,
    /// Where the camera, film, … were given.
    slots: Vec<(Kind, Span)>,
    has_asset: bool,
    /// Some statement could not be read: what is missing may stand there.
    damaged: bool,
    unseen: Unseen,
    /// Names that stand for nothing, of which that is told.
    unknown: BTreeSet<Span>,
    /// Objects that are right by themselves and stand nowhere: their place or their material is not known.
    orphans: Vec<NodeId>,
    /// Plugins that the scene asks for and that are not there.
    n_unmet: usize,
    params: Vec<ParamInfo>,
    /// Values for editors, if they are wanted.
    noted: Option<note::Noted>,
    /// What each statement of a large root file came to, if that is wanted.
    record: Option<again::Record>,
}

/// What is said of a call in whose body a mistake was found.
pub(crate) const CALLED: &str = "in this call";

/// What is said of the place where a name is defined.
pub(crate) const DEFINED: &str = "defined here";

/// What is said of numbers in one vector that measure different things.
pub(crate) const OF_KINDS: &str = "of different kinds";

/// What is said of pixels that another picture may have.
pub(crate) const OUTSIDE: &str = "is outside the picture";

/// What is said of a unit after brackets in which values have units of their own.
pub(crate) const BARE: &str = "a unit after brackets wants bare numbers";

/// Steps that a mistake counts that had been told: it is put into words all the same.
const TOLD: u64 = 50;

/// How often a loop may make mistakes that had been told.
const REPEATS: usize = 1000;

/// A group that is being filled.
#[derive(Clone, Default)]
struct OpenGroup {
    group: Group,
    depth: usize,
    instances: u64,
}

impl<'a> Evaluator<'a> {
    /// Nothing is evaluated yet; root files from `turn` bytes on are read in turns of so many.
    fn new(
        files: &'a dyn Files,
        registry: &'a Registry,
        settings: &'a Settings,
        turn: usize,
    ) -> Self {
        Self {
            files,
            registry,
            unloaded: &settings.unloaded,
            budgets: settings.budgets,
            sources: Sources::default(),
            sink: Sink::new(settings.budgets.diagnostics).until(settings.stop.clone()),
            scene: Scene::default(),
            open_groups: vec![],
            turn,
            quiet: 0,
            steps: 0,
            depth: 0,
            placements: 0,
            stopped: false,
            spent: None,
            held: Rc::default(),
            repeats: 0,
            bytes_read: 0,
            includes: 0,
            begun: BTreeMap::new(),
            n_reads: 0,
            n_foreseen: 0,
            read: BTreeMap::new(),
            imported: BTreeMap::new(),
            spectra: BTreeMap::new(),
            chain: vec![],
            loops: vec![],
            called: None,
            labels: Labels::default(),
            last_label: Arc::default(),
            slots: vec![],
            has_asset: false,
            damaged: false,
            unknown: BTreeSet::new(),
            unseen: Unseen::default(),
            orphans: vec![],
            n_unmet: 0,
            params: vec![],
            noted: settings.noting.then(note::Noted::default),
            record: None,
        }
    }

    /// What is written in a place; empty when unknown.
    fn written(&self, span: Span) -> &str {
        let (source, start) = match self.begun.get(&span.source) {
            Some(start) => (SourceId(0), *start),
            None => (span.source, 0),
        };
        let range = span.range();
        self.sources.text(source).get(start + range.start..start + range.end).unwrap_or("")
    }

    /// The bytes of a file.
    fn bytes(&mut self, path: &Path) -> Result<Arc<[u8]>, FileError> {
        self.n_reads += 1;
        self.files.read(path)
    }

    /// Keeps a diagnostic, with the call in whose body it was found; too many end the evaluation.
    fn tell(&mut self, mut diagnostic: Diagnostic) {
        let is_error = diagnostic.is_error();
        if let Some(call) = self.called {
            diagnostic = diagnostic.label(call, CALLED);
        }
        if !self.sink.push(diagnostic) {
            self.repeats += usize::from(is_error);
            self.steps = self.steps.saturating_add(TOLD);
        }
        self.stopped |= self.sink.is_full();
    }

    /// How many mistakes were made so far, told or not.
    fn mistakes(&self) -> usize {
        self.sink.errors() + self.repeats
    }

    /// Tells an error and gives poison.
    fn poison(&mut self, code: &'static str, span: Span, message: impl Into<String>) -> Value {
        self.tell(Diagnostic::error(code, span, message));
        Value::Poison
    }

    /// Counts work; `false` when there may be no more.
    fn tick(&mut self, work: u64, span: Span) -> bool {
        self.steps = self.steps.saturating_add(work);
        if self.steps > self.budgets.steps && !self.stopped {
            let message = format!("evaluation takes more than {} steps", self.budgets.steps);
            self.over_budget("E0502", span, message, "steps");
        }
        self.stopped |= self.sink.is_stopped();
        !self.stopped
    }

    /// Counts memory that a value will hold; `false` when there may be no more.
    fn hold(&mut self, bytes: usize, span: Span) -> bool {
        self.held.set(self.held.get().saturating_add(bytes));
        if self.held.get() > self.budgets.value_bytes && !self.stopped {
            let limit = self.budgets.value_bytes;
            let message = format!("lists, records and objects hold more than {limit} bytes");
            self.over_budget("E0503", span, message, "value_bytes");
        }
        !self.stopped
    }

    /// The memory of an object with so many fields, counted as long as it can be named.
    fn hold_object(&mut self, n_fields: usize, span: Span) -> Held {
        let held = Held::of(n_fields, &self.held);
        self.hold(0, span);
        held
    }

    /// Tells that a budget is spent, with the loops that are running, and stops.
    fn over_budget(&mut self, code: &'static str, span: Span, message: String, budget: &str) {
        let place = self.loops.last().copied().unwrap_or(span);
        let mut diagnostic = Diagnostic::error(code, place, message);
        for outer in self.loops.iter().rev().skip(1).take(4) {
            diagnostic = diagnostic.label(*outer, "inside this loop");
        }
        self.tell(diagnostic.help(self.budgets.allows(budget)));
        (self.stopped, self.spent) = (true, Some(span));
    }

    /// Whether a loop goes on after a turn, of which nothing more is told if each makes the mistakes of
    /// the one before.
    fn goes_on(&mut self, repeats: usize, work: u64, span: Span) -> bool {
        let is_told = self.repeats - repeats >= REPEATS;
        self.damaged |= is_told;
        self.tick(work, span) && !is_told
    }

    /// Goes one level deeper; `false` when that is too deep, which is told.
    fn enter(&mut self, span: Span) -> bool {
        self.depth += 1;
        if self.depth <= self.budgets.nesting {
            return true;
        }
        if !self.stopped {
            let message = format!("evaluation nests more than {} deep", self.budgets.nesting);
            self.tell(Diagnostic::error("E0507", span, message));
            (self.stopped, self.spent) = (true, Some(span));
        }
        false
    }

    /// A value, unless others stand in it too deep, which is told.
    fn shallow(&mut self, value: Value, span: Span) -> Value {
        if value.depth() <= self.budgets.nesting {
            return value;
        }
        let message =
            format!("values stand in one another more than {} deep", self.budgets.nesting);
        self.over_budget("E0507", span, message, "nesting");
        Value::Poison
    }

    fn leave(&mut self) {
        self.depth -= 1;
    }
}
