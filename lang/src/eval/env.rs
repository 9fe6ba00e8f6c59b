//! Names in sight while a file is evaluated.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;

use luxel_core::diag::Span;
use luxel_sdk::params::Dimension;

use super::value::Value;

/// What is the same in all of a file.
#[derive(Debug)]
pub(crate) struct File {
    /// The folder that its paths are relative to.
    pub(crate) folder: PathBuf,
    /// What bare numbers count, by dimension: `units { length = mm }`.
    pub(crate) units: BTreeMap<Dimension, f64>,
    /// Values for its parameters, from `with` or from `--set`.
    pub(crate) overrides: BTreeMap<Arc<str>, Override>,
    /// Whether it is the file that was asked for.
    pub(crate) is_root: bool,
}

/// A value given to a parameter from outside its file.
#[derive(Clone, Debug)]
pub(crate) struct Override {
    pub(crate) value: Value,
    pub(crate) span: Span,
}

/// The names of one block.
#[derive(Debug, Default)]
struct Frame {
    parent: Option<Env>,
    names: RefCell<BTreeMap<Arc<str>, (usize, Value)>>,
}

/// The names that are in sight at one place. A function keeps the ones that stood before it, so that
/// it cannot see itself or what comes later.
#[derive(Clone, Debug)]
pub(crate) struct Env {
    frame: Rc<Frame>,
    /// How many names of the innermost block are in sight.
    visible: usize,
    pub(crate) file: Rc<File>,
}

impl Env {
    /// Nothing is in sight.
    pub(crate) fn new(file: Rc<File>) -> Self {
        Self { frame: Rc::new(Frame::default()), visible: usize::MAX, file }
    }

    /// A block inside this one.
    pub(crate) fn inner(&self) -> Self {
        let frame = Frame { parent: Some(self.clone()), names: RefCell::default() };
        Self { frame: Rc::new(frame), visible: usize::MAX, file: self.file.clone() }
    }

    /// The names that are in sight now, and none that come later.
    pub(crate) fn frozen(&self) -> Self {
        let visible = self.frame.names.borrow().len();
        Self { visible, ..self.clone() }
    }

    /// Defines a name in the innermost block. The first definition stays: a second one is a mistake
    /// that was told.
    pub(crate) fn define(&self, name: &Arc<str>, value: Value) {
        let mut names = self.frame.names.borrow_mut();
        let index = names.len();
        names.entry(name.clone()).or_insert((index, value));
    }

    /// The value of a name.
    pub(crate) fn get(&self, name: &str) -> Option<Value> {
        let mut env = self;
        loop {
            if let Some((index, value)) = env.frame.names.borrow().get(name)
                && *index < env.visible
            {
                return Some(value.clone());
            }
            env = env.frame.parent.as_ref()?;
        }
    }

    /// Every name of the innermost block.
    pub(crate) fn names(&self) -> BTreeMap<Arc<str>, Value> {
        let names = self.frame.names.borrow();
        names.iter().map(|(name, (_, value))| (name.clone(), value.clone())).collect()
    }
}
