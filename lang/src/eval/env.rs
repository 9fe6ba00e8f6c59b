//! Names in sight while a file is evaluated.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;

use luxel_core::diag::Span;
use luxel_sdk::params::Dimension;

use super::by_name::ByName;
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
    names: RefCell<Names>,
}

/// From how many names on they are found by a table.
const MANY: usize = 8;

/// Names and their values, in the order of their definition.
#[derive(Debug, Default)]
struct Names {
    list: Vec<(Arc<str>, Value)>,
    /// Where in the list each stands, if they are many.
    places: ByName<usize>,
}

impl Names {
    fn clear(&mut self) {
        self.list.clear();
        self.places.clear();
    }

    /// Where in the list a name stands.
    fn place(&self, name: &str) -> Option<usize> {
        if self.list.len() < MANY {
            return self.list.iter().position(|(known, _)| **known == *name);
        }
        self.places.get(name).copied()
    }

    /// Puts in a name, unless it is there.
    fn define(&mut self, name: &Arc<str>, value: Value) {
        if self.place(name).is_some() {
            return;
        }
        self.list.push((name.clone(), value));
        let added = match self.list.len() {
            MANY => 0..MANY,
            n if n > MANY => n - 1..n,
            _ => return,
        };
        let names = added.map(|i| (self.list[i].0.clone(), i));
        self.places.extend(names);
    }
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

    /// Forgets the names of the innermost block: as a new one, whose room is the old one's if nothing
    /// keeps that.
    pub(crate) fn renew(&mut self) {
        if let Some(frame) = Rc::get_mut(&mut self.frame) {
            frame.names.get_mut().clear();
        } else {
            let parent = self.frame.parent.clone();
            self.frame = Rc::new(Frame { parent, names: RefCell::default() });
        }
    }

    /// The names that are in sight now, and none that come later.
    pub(crate) fn frozen(&self) -> Self {
        let visible = self.frame.names.borrow().list.len();
        Self { visible, ..self.clone() }
    }

    /// Defines a name in the innermost block. The first definition stays: a second one is a mistake
    /// that was told. Gives how many names the block has.
    pub(crate) fn define(&self, name: &Arc<str>, value: Value) -> usize {
        let mut names = self.frame.names.borrow_mut();
        names.define(name, value);
        names.list.len()
    }

    /// The value of a name.
    pub(crate) fn get(&self, name: &str) -> Option<Value> {
        let mut env = self;
        loop {
            let names = env.frame.names.borrow();
            if let Some(place) = names.place(name).filter(|place| *place < env.visible) {
                return Some(names.list[place].1.clone());
            }
            env = env.frame.parent.as_ref()?;
        }
    }

    /// Every name of the innermost block.
    pub(crate) fn names(&self) -> BTreeMap<Arc<str>, Value> {
        let names = self.frame.names.borrow();
        names.list.iter().cloned().collect()
    }
}
