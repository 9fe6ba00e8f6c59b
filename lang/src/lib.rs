//! The scene language: text to syntax to scene graph, with every mistake told at its place.
//!
//! `pest` is used here and nowhere else. This crate reads nothing itself (bytes come through
//! `Files`), prints nothing, and knows no plugin: it meets them as entries of a `Registry`.
#![forbid(unsafe_code)]

#[cfg(any(test, feature = "fuzz"))]
pub mod check;
pub mod editor;
pub mod manual;
pub mod prescan;

mod budgets;
mod catalogue;
#[cfg(test)]
mod chance;
mod consequences;
mod eval;
mod fmt;
mod shares;
mod sink;
mod syntax;
mod values;
mod words;

pub use budgets::Budgets;
pub use catalogue::{CATALOGUE, Example, Page, Setup, page, setup};
pub use eval::unreadable;
pub use fmt::format;
#[doc(hidden)]
pub use syntax::{Agreement, agree};
pub use values::Values;

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use luxel_core::diag::{Diagnostic, SourceId, Sources, Span};
use luxel_core::files::Files;
use luxel_core::registry::Registry;
use luxel_core::scene::Scene;

/// What a load is told beside the file.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// Values for the parameters that the root file declares, as text: `--set name=value`.
    pub set: Vec<(String, String)>,
    /// What the load may cost.
    pub budgets: Budgets,
    /// Plugin libraries that are not loaded: what a scene misses may be in one of them.
    pub unloaded: Vec<Unloaded>,
    /// Whether values are noted, for editors.
    pub noting: bool,
    /// Whether the scene itself is not wanted: [`Kept::load`] may give none, though there is no error.
    pub without_scene: bool,
    /// Ends the load soon after it is set; what it then gives is of no use.
    pub stop: Option<Arc<AtomicBool>>,
}

/// A plugin library that was found but not loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unloaded {
    /// Its file's name without `lib` and extension: often that of its class.
    pub stem: String,
    /// Which library it is, why it is not loaded, and what to do.
    pub advice: String,
}

/// A `param` that the root file declares.
#[derive(Clone, Debug, PartialEq)]
pub struct ParamInfo {
    /// Its name.
    pub name: String,
    /// Its type as it is written: `length`.
    pub ty: String,
    /// The SI unit of its type, or of the numbers of a vector; empty for plain numbers and for what is no
    /// number.
    pub unit: String,
    /// Its doc comment, lines joined by newlines.
    pub doc: String,
    /// Its default as it is written.
    pub default: String,
    /// Its range as it is written, if it has one.
    pub range: Option<String>,
    /// What it is in this load: its default, or what was set.
    pub value: ParamValue,
    /// Its range, if it has one of numbers.
    pub limits: Option<ParamLimits>,
    /// The unit in which its default or its range is written, and what it is of the SI unit.
    pub written: Option<(String, f64)>,
    /// Where its name stands.
    pub span: Span,
}

/// The value of a `param`.
#[derive(Clone, Debug, PartialEq)]
pub enum ParamValue {
    /// A number, in SI units.
    Number(f64),
    /// True or false.
    Bool(bool),
    /// Text.
    Text(String),
    /// A vector or a list of a few numbers.
    Numbers {
        /// In SI units.
        values: Vec<f64>,
        /// Whether it is written `[1, 2]` and not `(1, 2)`.
        is_list: bool,
    },
    /// A colour that is given by linear sRGB.
    Color([f64; 3]),
    /// A longer list or one of other things, a spectrum, or what a mistake has left.
    Other,
}

/// The range of a `param`, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParamLimits {
    /// The least that it may be.
    pub low: f64,
    /// The most that it may be, or what it is to stay below.
    pub high: f64,
    /// Whether it may be `high`.
    pub inclusive: bool,
}

/// What a load gives.
#[derive(Debug)]
pub struct Loaded {
    /// The scene; `None` if there is an error.
    pub scene: Option<Scene>,
    /// If there is an error, what could be made all the same, for more mistakes to be found in its
    /// objects: nothing is to be rendered of it. `None` of a very large scene too.
    pub rest: Option<Scene>,
    /// Every mistake and warning, in the order in which they were found.
    pub diagnostics: Vec<Diagnostic>,
    /// The texts that the diagnostics point into; each `--set` is one.
    pub sources: Sources,
    /// The parameters that the root file declares.
    pub params: Vec<ParamInfo>,
    /// What was noted of values, if that was asked for: the first of each `let`, `param`, field, member
    /// and call that makes a colour, and what each loop runs over, by the name's place, as text.
    pub values: Values,
}

/// Reads and evaluates the scene at `path`: everything it names comes from `files`, every class from
/// `registry`.
///
/// Never panics and never runs for ever, whatever the bytes: budgets bound time, memory and stack
/// (2 MiB suffice at the default budgets).
pub fn load(path: &Path, files: &dyn Files, registry: &Registry, settings: &Settings) -> Loaded {
    sifted(eval::load(path, files, registry, settings))
}

/// Without what follows from other mistakes.
fn sifted(mut loaded: Loaded) -> Loaded {
    consequences::sift(&mut loaded.diagnostics, &loaded.sources);
    loaded
}

/// What is kept of a load, so that the next one of the same file goes on from it.
///
/// Of a file of 256 KiB or more, only the statements that an edit concerns are read and evaluated again,
/// if nothing is wrong with it. What a load gives is what [`load`] gives, to the last place in the file;
/// only how long that takes differs, and the memory that a second copy of the scene holds.
#[derive(Debug, Default)]
pub struct Kept(Option<Box<eval::again::State>>);

impl Kept {
    /// As [`load`]. `registry` has the same classes at every call: where they change, a new `Kept` begins.
    pub fn load(
        &mut self,
        path: &Path,
        files: &dyn Files,
        registry: &Registry,
        settings: &Settings,
    ) -> Loaded {
        sifted(eval::again::load(&mut self.0, path, files, registry, settings))
    }

    /// How many statements of the file the last load evaluated, if it gave something to go on from.
    pub fn n_evaluated(&self) -> Option<usize> {
        self.0.as_ref().and_then(|state| state.n_evaluated())
    }
}

/// Reads a text without evaluating it; gives how many statements stand at its top level and what is
/// wrong with it. For measuring the parser alone.
pub fn parse_only(text: &str, budgets: &Budgets) -> (usize, Vec<Diagnostic>) {
    let mut sink = sink::Sink::new(budgets.diagnostics);
    let tree = syntax::parse(text, SourceId(0), budgets, &mut sink);
    (tree.stmts.len(), sink.finish())
}

/// The same by the grammar of record alone, without the reader that is many times as fast.
#[doc(hidden)]
pub fn parse_by_pest(text: &str, budgets: &Budgets) -> (usize, Vec<Diagnostic>) {
    let mut sink = sink::Sink::new(budgets.diagnostics);
    let tree = syntax::parse_by_pest(text, SourceId(0), budgets, &mut sink);
    (tree.stmts.len(), sink.finish())
}
