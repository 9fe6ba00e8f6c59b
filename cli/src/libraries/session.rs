//! One run of the program: which libraries it has opened, and what became of each.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use luxel_core::registry::Registry;

use super::config::Config;
use super::copy::PrivateCopy;
use super::lock::Lock;
use super::note::Notes;
use super::open::{Opened, Opener, open_file, really};
use super::surroundings::Surroundings;
use super::{Found, Plugins, State, search};
use crate::args::PluginArgs;
use crate::exit::{Exit, Failure};
use crate::files::{Watched, look};

/// Nothing is ever unloaded: so many generations of one library are told.
const MANY: u32 = 200;

/// The libraries that are in memory.
pub(crate) struct Session {
    open: Box<Opener>,
    /// By stem: the last that opened, with its bytes' hash.
    kept: BTreeMap<String, (String, Opened)>,
    /// By stem: the last bytes that did not open, and why; not tried twice.
    refused: BTreeMap<String, (String, String)>,
    /// By stem: how often one was opened.
    generations: BTreeMap<String, u32>,
    /// The built-in classes' library, once it is open.
    builtins: Option<Opened>,
}

impl Session {
    /// Nothing is open.
    pub(crate) fn new() -> Self {
        Self::opening_with(Box::new(really))
    }

    /// Looks at what there is and refuses to open any of it.
    pub(crate) fn looking() -> Self {
        Self::opening_with(Box::new(|_, _, _| Err("it was only looked at".to_owned())))
    }

    pub(super) fn opening_with(open: Box<Opener>) -> Self {
        let (kept, refused, generations) = Default::default();
        Self { open, kept, refused, generations, builtins: None }
    }

    /// Looks at everything anew: opens what is trusted and new, keeps what has not changed.
    ///
    /// # Errors
    /// A configuration or lock that cannot be understood; built-in classes that cannot be had.
    /// What is wrong with a library is in its state and in the notes.
    pub(crate) fn refresh(
        &mut self,
        args: &PluginArgs,
        surroundings: &Surroundings,
    ) -> Result<Plugins, Failure> {
        let home = surroundings.folder.as_deref();
        let (config, lock) = (Config::read(home)?, Lock::read(home)?);
        let (mut notes, mut watched) = (Notes::default(), Watched::new());
        for file in home.iter().flat_map(|home| [home.join("config.toml"), Lock::file(home)]) {
            watched.insert(file.clone(), look(&file));
        }
        let folders = search::folders(args, surroundings, &config, &mut notes);
        watched.extend(folders.iter().map(|folder| (folder.clone(), look(folder))));
        let mut libraries = vec![];
        for (stem, path) in search::candidates(&folders, &mut notes) {
            let trust = Trust { lock: &lock, all: args.allow_unlocked_plugins };
            let found = self.consider(stem, path, trust, &mut watched, &mut notes);
            libraries.push(found);
        }
        self.gone(&mut libraries, args.allow_unlocked_plugins, &lock, &mut notes);
        let mut registry = self.builtins(args.builtins.as_deref())?;
        for found in &mut libraries {
            add(&mut registry, found);
        }
        for Found { path, state, .. } in &libraries {
            if let State::Refused(why) = state {
                notes.warn(format!("plugin library `{}` is not loaded: {why}", path.display()));
            }
        }
        libraries.extend(beside(&lock, &libraries, &folders));
        Ok(Plugins { registry, libraries, notes, watched })
    }

    /// What comes of a candidate.
    fn consider(
        &mut self,
        stem: String,
        path: PathBuf,
        trust: Trust<'_>,
        watched: &mut Watched,
        notes: &mut Notes,
    ) -> Found {
        if !trust.all && trust.lock.of_stem(&stem).next().is_none() {
            // Its bytes do not matter, so that nobody looks at them.
            self.kept.remove(&stem);
            return Found { stem, path, state: State::Untrusted };
        }
        let next = self.generations.get(&stem).copied().unwrap_or(0);
        let copy = PrivateCopy::take(&path, &stem, next);
        watched.insert(path.clone(), copy.as_ref().ok().map(|copy| copy.seen));
        let state = match copy {
            Err(why) => State::Refused(why),
            Ok(copy) if trust.all || trust.lock.trusts(&stem, &copy.sha256) => {
                self.opened(&stem, &copy, notes)
            }
            Ok(_) if trust.lock.of_stem(&stem).any(|entry| search::is_same(&entry.path, &path)) => {
                State::Changed
            }
            Ok(_) => State::Untrusted,
        };
        let found = Found { stem, path, state };
        match (found.advice(), self.kept.get(&found.stem)) {
            (Some(why), Some((_, before))) => {
                notes.warn(format!("{why}; the one from before stays in use"));
                Found { state: State::Loaded(before.clone()), ..found }
            }
            _ => found,
        }
    }

    /// Opens trusted bytes, unless they were tried before.
    fn opened(&mut self, stem: &str, copy: &PrivateCopy, notes: &mut Notes) -> State {
        if let Some((_, opened)) = self.kept.get(stem).filter(|(hash, _)| *hash == copy.sha256) {
            return State::Loaded(opened.clone());
        }
        if let Some((_, why)) = self.refused.get(stem).filter(|(hash, _)| *hash == copy.sha256) {
            return State::Refused(why.clone());
        }
        let generation = self.generations.entry(stem.to_owned()).or_default();
        let opened = (self.open)(&copy.path, stem, *generation);
        *generation += 1;
        if generation.is_multiple_of(MANY) {
            notes.warn(format!(
                "{generation} generations of `{stem}` are in memory: starting again frees them"
            ));
        }
        let hash = copy.sha256.clone();
        match opened {
            Ok(opened) => {
                self.refused.remove(stem);
                self.kept.insert(stem.to_owned(), (hash, opened.clone()));
                State::Loaded(opened)
            }
            Err(why) => {
                self.refused.insert(stem.to_owned(), (hash, why.clone()));
                State::Refused(why)
            }
        }
    }

    /// Libraries whose files have gone since they were opened: a build may be writing them.
    fn gone(&self, libraries: &mut Vec<Found>, all: bool, lock: &Lock, notes: &mut Notes) {
        for (stem, (hash, opened)) in &self.kept {
            let here = libraries.iter().any(|found| found.stem == *stem);
            if here || !(all || lock.trusts(stem, hash)) {
                continue;
            }
            notes.warn(format!(
                "the library of `{}` is gone; the one from before stays in use",
                opened.name
            ));
            let path = search::file_name(stem).into();
            let state = State::Loaded(opened.clone());
            libraries.push(Found { stem: stem.clone(), path, state });
        }
    }

    /// A registry with the built-in classes: those of the program, or of a library in their place.
    fn builtins(&mut self, file: Option<&Path>) -> Result<Registry, Failure> {
        let Some(file) = file else { return Ok(builtins()) };
        let mut registry = Registry::new();
        let opened = match &self.builtins {
            Some(opened) => opened,
            None => self.builtins.insert(open_file(file)?.0),
        };
        registry.add(&opened.name, &opened.classes).map_err(|conflict| {
            Failure::new(Exit::Input, format!("`{}`: {conflict}", file.display()))
        })?;
        Ok(registry)
    }
}

/// The built-in classes of the program.
pub(crate) fn builtins() -> Registry {
    let mut registry = Registry::new();
    for classes in luxel_builtin::CLASSES {
        registry.add("builtin", classes).expect("built-in classes have distinct names");
    }
    registry
}

/// Which bytes may be opened.
#[derive(Clone, Copy)]
struct Trust<'a> {
    lock: &'a Lock,
    all: bool,
}

/// Adds all classes of a library, or none: a half would hide what is wrong.
fn add(registry: &mut Registry, found: &mut Found) {
    let State::Loaded(opened) = &found.state else { return };
    let mut with = registry.clone();
    match with.add_library(&opened.name, &opened.version, &opened.classes) {
        Ok(()) => *registry = with,
        Err(conflict) => found.state = State::Refused(conflict.to_string()),
    }
}

/// What the lock lists and no searched folder holds.
fn beside(lock: &Lock, libraries: &[Found], folders: &[PathBuf]) -> Vec<Found> {
    let listed =
        lock.entries.iter().filter(|entry| !libraries.iter().any(|found| found.stem == entry.stem));
    let found = listed.map(|entry| {
        let searched =
            |folder: &PathBuf| entry.path.parent().is_some_and(|own| search::is_same(own, folder));
        let elsewhere = entry.path.is_file() && !folders.iter().any(searched);
        let state = if elsewhere { State::Elsewhere } else { State::Missing };
        Found { stem: entry.stem.clone(), path: entry.path.clone(), state }
    });
    found.collect()
}

#[cfg(test)]
mod tests;
