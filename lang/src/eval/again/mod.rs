//! A large file again: after an edit only the statements that it concerns are evaluated.
//!
//! Of each statement is kept what it put into the scene. A statement is evaluated again if its text has
//! changed, or if it uses a name whose statement is; with it those that define the names it uses, whose
//! own nodes are known. All others are as they were: places in the root file count from the first byte
//! of their statement, so that they are right wherever it moves.
//!
//! With a mistake in what an edit concerns, that is told, and what is kept stays what it was before.
//!
//! Whatever this does not know how to go on from is loaded anew, as a whole: other mistakes, a `set` of what
//! stands in a block, other files that have changed, a changed `units` or `param`, a changed statement
//! that other files come into. `docs/decisions/0042` says why.

mod asked;
mod edit;
mod formula;
mod handed;
mod handing;
mod made;
mod plan;
mod put;
mod reckoned;
mod record;
mod sets;
mod slice;
mod steps;
mod told;
mod values;
mod vector;
mod warn;

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use luxel_core::diag::{SourceId, Sources, Span};
use luxel_core::files::Files;
use luxel_core::registry::Registry;
use luxel_core::scene::{Order, Pose, Scene};
use luxel_sdk::params::leave;

use self::asked::{Questions, Remembering};
use self::handing::{Handing, Hands};
use self::made::{Cost, Made};
pub(super) use self::record::Record;
use self::values::KeptValues;
use self::warn::warnings;
use super::Evaluator;
use super::names::{Known, Numbered};
use super::numbered::Tables;
use crate::{Loaded, ParamInfo, Settings};

/// Bytes from which on a file is read in turns, so that what its statements came to is kept: smaller
/// ones are loaded anew as soon.
const KEPT: usize = 1 << 18;

/// Which part of a scene mistakes may hide for it to be gone on from: with what is kept from before, less
/// is evaluated once they are mended.
const HIDDEN: usize = 8;

/// Sources from here on are statements of the root file, by their `id`.
const STATEMENTS: u32 = 1 << 31;

/// The source of places that count from the first byte of a statement.
fn source_of(id: u32) -> SourceId {
    SourceId(STATEMENTS.saturating_add(id))
}

/// A statement of the root file.
#[derive(Debug)]
struct Statement {
    /// Its own for as long as it is the same.
    id: u32,
    /// Its bytes, up to the next one.
    range: Range<usize>,
    names: Numbered,
    made: Made,
    /// The label of which it sets something, by number.
    set: Option<u32>,
    /// It is about the whole file: units, a parameter.
    declares: bool,
    /// It defines a name that every scene has.
    shadows: bool,
    /// Where it hands a value on, its objects need not be made anew.
    is_plain: bool,
    /// Which values it hands on, and where.
    hands: Hands,
}

/// What is kept of a load.
#[derive(Debug)]
pub(crate) struct State {
    path: PathBuf,
    settings: Settings,
    text: Arc<str>,
    /// Where statements may begin.
    from: usize,
    names: Known,
    tables: Tables,
    /// How many names the file defines, and how many statements define one that every scene has.
    n_names: usize,
    n_shadows: usize,
    /// Labels of which something is set: each stands for one object, of the statement that bears it itself.
    set_labels: BTreeSet<u32>,
    stmts: Vec<Statement>,
    n_ids: usize,
    /// All nodes and groups of all statements, those that are gone too; hashed, in no order.
    scene: Scene,
    /// In which order it is given, if what stands in it is what it was when that was found.
    order: Option<Order>,
    /// What of it is handed on, by nodes of that scene.
    handing: Handing,
    /// Nodes and groups when nothing was gone.
    n_kept: usize,
    sources: Sources,
    params: Vec<ParamInfo>,
    asked: Questions,
    /// It was given up while it changed, and is of no use any more.
    is_broken: bool,
    /// A mistake is told of a statement, so that nothing takes the place of anything before it is mended.
    is_wrong: bool,
    /// Something is wrong with the names of one.
    has_odd_names: bool,
    /// What was spent.
    spent: Cost,
    /// Bytes of other files.
    other_bytes: usize,
    /// How many statements were evaluated the last time.
    n_evaluated: usize,
    values: KeptValues,
}

/// Evaluates the scene at `path`, going on from `kept` if that is possible.
pub(crate) fn load(
    kept: &mut Option<Box<State>>,
    path: &Path,
    files: &dyn Files,
    registry: &Registry,
    settings: &Settings,
) -> Loaded {
    load_in_turns(kept, (path, files), registry, settings, KEPT)
}

/// The same of files from so many bytes on.
fn load_in_turns(
    kept: &mut Option<Box<State>>,
    (path, files): (&Path, &dyn Files),
    registry: &Registry,
    settings: &Settings,
    turn: usize,
) -> Loaded {
    let is_of = |state: &&mut Box<State>| state.path == path && state.is_set(settings);
    let again = kept.as_mut().filter(is_of);
    if let Some(loaded) = again.and_then(|state| state.again(files, registry, settings)) {
        return loaded;
    }
    if let Some(broken) = kept.take_if(|state| state.is_broken) {
        leave(broken);
    }
    let plain = files;
    let files = Remembering::new(files);
    let mut evaluator = Evaluator::new(&files, registry, settings, turn);
    if evaluator.sink.is_stopped() {
        return evaluator.finish();
    }
    evaluator.record = Some(Record::default());
    evaluator.root(path, &settings.set);
    // How much is told where a budget is spent depends on how much was read by then.
    if evaluator.spent.is_some() {
        if let Some(state) = kept {
            state.n_evaluated = 0;
        }
        return super::load(path, plain, registry, settings);
    }
    let (loaded, state) = evaluator.finish_recorded(path, settings);
    let before = kept.as_ref().filter(|state| state.path == path && state.is_set(settings));
    let is_better = |state: &State| before.is_none_or(|before| state.is_as_whole_as(before));
    if let Some(state) = state.filter(is_better) {
        leave(kept.replace(Box::new(State { asked: files.beside(path), ..state })));
    } else if let Some(state) = kept {
        state.n_evaluated = 0;
    }
    loaded
}

impl State {
    /// How many statements the last load evaluated, if it went on from another one or can be gone on from.
    pub(crate) fn n_evaluated(&self) -> Option<usize> {
        Some(self.n_evaluated).filter(|n| *n > 0)
    }

    fn is_set(&self, now: &Settings) -> bool {
        let Settings { set, budgets, unloaded, noting, without_scene: _, stop: _ } = now;
        let before = &self.settings;
        *set == before.set
            && *budgets == before.budgets
            && *unloaded == before.unloaded
            && *noting == before.noting
    }

    /// Whether its mistakes hide little of what stands in another state of the file.
    fn is_as_whole_as(&self, other: &Self) -> bool {
        !self.is_wrong || self.n_kept >= other.n_kept - other.n_kept / HIDDEN
    }

    /// The scene of all statements, with what was told of it as a whole in `evaluator`. `None` if that is a
    /// mistake, there are too many warnings, or a setting is given twice.
    fn gathered(&mut self, evaluator: &mut Evaluator<'_>, settings: &Settings) -> Option<Loaded> {
        let mut starts = vec![0; self.n_ids];
        let mut rare = vec![];
        for stmt in &self.stmts {
            starts[stmt.id as usize] = stmt.range.start;
            rare.extend(stmt.made.rare.as_deref());
        }
        let scene = &mut self.scene;
        (scene.camera, scene.film, scene.integrator) = (None, None, None);
        (scene.sampler, scene.filter, scene.medium) = (None, None, None);
        scene.camera_pose = Pose::Here;
        for slot in rare.iter().flat_map(|rare| &rare.slots) {
            if scene.slot_mut(slot.kind)?.replace(slot.id).is_some() {
                return None;
            }
            if slot.kind == luxel_sdk::kind::Kind::Camera {
                scene.camera_pose = slot.pose.clone();
            }
        }
        let said = rare.iter().flat_map(|rare| &rare.expectations);
        scene.expectations = said.cloned().collect();
        evaluator.has_asset = rare.iter().any(|rare| rare.has_asset);
        let place = |span: Span| in_file(span, &starts);
        let is_wanted = !settings.without_scene || !self.scene.expectations.is_empty();
        if is_wanted {
            let order = self.order.get_or_insert_with(|| self.scene.order());
            evaluator.scene = self.scene.gathered(order, &place, &evaluator.sink.over())?;
        } else {
            evaluator.scene.camera = self.scene.camera;
        }
        evaluator.lacks();
        let diagnostics = warnings(&rare, &starts);
        if evaluator.sink.errors() > 0 || diagnostics.len() > self.settings.budgets.diagnostics {
            return None;
        }
        let param = |param: &ParamInfo| ParamInfo { span: place(param.span), ..param.clone() };
        Some(Loaded {
            scene: is_wanted.then(|| std::mem::take(&mut evaluator.scene)),
            rest: None,
            diagnostics,
            sources: self.sources.clone(),
            params: self.params.iter().map(param).collect(),
            values: self.values(),
        })
    }
}

/// A place in a statement as one in the root file.
fn in_file(span: Span, starts: &[usize]) -> Span {
    let Some(id) = span.source.0.checked_sub(STATEMENTS) else { return span };
    let (start, at) = (starts[id as usize], span.range());
    Span::new(SourceId(0), start + at.start, start + at.end)
}
