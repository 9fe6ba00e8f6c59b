//! Kind and name to class: a plain value, built by explicit calls.

mod common;
pub mod dynamic;
mod film;

use std::collections::BTreeMap;
use std::fmt;

use luxel_sdk::abi::Class;
use luxel_sdk::kind::Kind;
use luxel_sdk::params::Param;

pub use common::common_params;
pub use film::{Display, FilmSettings};

/// Every class that a scene may name.
#[derive(Clone, Debug, Default)]
pub struct Registry {
    classes: BTreeMap<Kind, BTreeMap<&'static str, Entry>>,
    /// Libraries' versions, by name.
    libraries: BTreeMap<String, String>,
}

/// A class and where it comes from.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The class.
    pub class: Class,
    /// `builtin`, or the library's name.
    pub origin: String,
}

/// Two origins offer a class of the same kind and name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Conflict {
    /// Kind and name.
    pub class: String,
    /// Who has it already.
    pub first: String,
    /// Who offers it again.
    pub second: String,
}

impl fmt::Display for Conflict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` comes from both `{}` and `{}`", self.class, self.first, self.second)
    }
}

impl std::error::Error for Conflict {}

impl Registry {
    /// A registry that holds what the host itself provides: the film.
    ///
    /// # Panics
    /// Never: the host offers each class once.
    pub fn new() -> Self {
        let mut registry = Self::default();
        registry.add("host", film::CLASSES).expect("the host offers each class once");
        registry
    }

    /// Adds the classes of one origin.
    ///
    /// # Errors
    /// The first class that another origin has already added.
    pub fn add(&mut self, origin: &str, classes: &[Class]) -> Result<(), Conflict> {
        for class in classes {
            if let Some(first) = self.entry(class.kind, class.name) {
                return Err(Conflict {
                    class: format!("{} {}", class.kind, class.name),
                    first: first.origin.clone(),
                    second: origin.to_owned(),
                });
            }
            let entry = Entry { class: *class, origin: origin.to_owned() };
            self.classes.entry(class.kind).or_default().insert(class.name, entry);
        }
        Ok(())
    }

    /// Adds the classes of a library and remembers its version.
    ///
    /// # Errors
    /// As [`Registry::add`].
    pub fn add_library(
        &mut self,
        name: &str,
        version: &str,
        classes: &[Class],
    ) -> Result<(), Conflict> {
        self.add(name, classes)?;
        self.libraries.insert(name.to_owned(), version.to_owned());
        Ok(())
    }

    /// Name and version of every library, by name.
    pub fn libraries(&self) -> impl Iterator<Item = (&str, &str)> {
        self.libraries.iter().map(|(name, version)| (name.as_str(), version.as_str()))
    }

    /// The class of that kind and name.
    pub fn class(&self, kind: Kind, name: &str) -> Option<&Class> {
        self.entry(kind, name).map(|entry| &entry.class)
    }

    /// The class and its origin.
    pub fn entry(&self, kind: Kind, name: &str) -> Option<&Entry> {
        self.classes.get(&kind)?.get(name)
    }

    /// Every class of a kind, by name.
    pub fn of_kind(&self, kind: Kind) -> impl Iterator<Item = &Entry> {
        self.classes.get(&kind).into_iter().flat_map(BTreeMap::values)
    }

    /// Every class, by kind and name.
    pub fn all(&self) -> impl Iterator<Item = &Entry> {
        self.classes.values().flat_map(BTreeMap::values)
    }

    /// The parameters that a scene may give an object of this class: its own, then those that the
    /// host adds to every object of the kind.
    pub fn params(class: &Class) -> impl Iterator<Item = &'static Param> {
        class.params.iter().chain(common_params(class.kind))
    }
}
