//! Plugin libraries: where they are looked for, which are trusted, and what came of opening them.
//!
//! A library's constructors run before any check can, so nothing is opened that the person at the
//! keyboard has not trusted. A scene says nothing about any of this: it names classes.

mod config;
mod copy;
mod lock;
mod note;
mod open;
mod search;
mod session;
mod surroundings;

use std::path::PathBuf;

use luxel_core::registry::Registry;
use luxel_lang::Unloaded;

use crate::files::Watched;

pub(crate) use lock::{Entry, Lock};
pub(crate) use note::Notes;
pub(crate) use open::{Opened, open_file};
pub(crate) use search::{is_library, is_searched, stem_of};
pub(crate) use session::{Session, builtins};
pub(crate) use surroundings::Surroundings;

/// Every class there is, and the libraries that were found.
pub(crate) struct Plugins {
    /// The built-in classes and those of the libraries that were opened.
    pub(crate) registry: Registry,
    /// What was found on the search path, by stem; then what the lock lists beside it.
    pub(crate) libraries: Vec<Found>,
    /// What was odd.
    pub(crate) notes: Notes,
    /// Everything whose change could change the above.
    pub(crate) watched: Watched,
}

impl Plugins {
    /// The libraries whose classes a scene may miss, for the language to tell.
    pub(crate) fn unloaded(&self) -> Vec<Unloaded> {
        let one =
            |found: &Found| Some(Unloaded { stem: found.stem.clone(), advice: found.advice()? });
        self.libraries.iter().filter_map(one).collect()
    }

    /// One hash over everything whose change could change the classes.
    pub(crate) fn hash(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        for seen in self.watched.values().flatten() {
            hasher.update(seen.as_bytes());
        }
        hasher.finalize().to_hex().to_string()
    }

    /// The libraries that are open, for people.
    pub(crate) fn open(&self) -> Vec<String> {
        let one = |found: &Found| match &found.state {
            State::Loaded(Opened { name, version, .. }) => {
                Some(format!("{name} {version} (`{}`)", found.path.display()))
            }
            _ => None,
        };
        self.libraries.iter().filter_map(one).collect()
    }

    /// The libraries that were refused, for people.
    pub(crate) fn refused(&self) -> Vec<String> {
        let refused = |found: &&Found| matches!(found.state, State::Refused(_));
        let path = |found: &Found| format!("`{}`", found.path.display());
        self.libraries.iter().filter(refused).map(path).collect()
    }
}

/// A library that was found, or that the lock lists.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    /// Its file's name without `lib` and extension.
    pub(crate) stem: String,
    /// Its file.
    pub(crate) path: PathBuf,
    /// What came of it.
    pub(crate) state: State,
}

/// What came of a library.
#[derive(Clone, Debug)]
pub(crate) enum State {
    /// Its classes can be named.
    Loaded(Opened),
    /// Nobody has said that it may be opened.
    Untrusted,
    /// The lock lists other bytes at its place.
    Changed,
    /// It is trusted and cannot be used, for this reason.
    Refused(String),
    /// The lock lists it, but it is not on the search path.
    Elsewhere,
    /// The lock lists it, and it is not there any more.
    Missing,
}

impl State {
    /// In a word or two, and why where that is not all.
    pub(crate) fn words(&self) -> (&'static str, &str) {
        match self {
            Self::Loaded(_) => ("loaded", ""),
            Self::Untrusted => ("not trusted", ""),
            Self::Changed => ("changed since it was trusted", ""),
            Self::Refused(why) => ("refused", why),
            Self::Elsewhere => ("trusted, but its folder is not searched", ""),
            Self::Missing => ("trusted, but missing", ""),
        }
    }
}

impl Found {
    /// What there is to say to someone who misses a class; nothing of a library that is loaded.
    pub(crate) fn advice(&self) -> Option<String> {
        let path = self.path.display();
        let folder = self.path.parent().unwrap_or(&self.path).display();
        Some(match &self.state {
            State::Loaded(_) => return None,
            State::Untrusted => {
                let name = search::file_name(&self.stem);
                format!(
                    "plugin library `{name}` in `{folder}` is not trusted: luxel plugin trust {path}"
                )
            }
            State::Changed => {
                format!("`{path}` has changed since it was trusted: luxel plugin trust {path}")
            }
            State::Refused(why) => format!("plugin library `{path}` is not loaded: {why}"),
            State::Elsewhere => {
                format!(
                    "`{path}` is trusted, but its folder is not searched: --plugin-dir {folder}"
                )
            }
            State::Missing => format!("`{path}` is trusted, but it is missing"),
        })
    }
}
