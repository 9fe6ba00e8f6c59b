//! Opening: the step at which code of a library runs.

use std::path::Path;

use luxel_core::registry::dynamic::Library;
use luxel_sdk::abi::Class;

use super::copy::PrivateCopy;
use super::search;
use crate::exit::{Exit, Failure, blaming};

/// A library that was opened and found sound; it stays in memory.
#[derive(Clone, Debug)]
pub(crate) struct Opened {
    /// The name it gives itself.
    pub(crate) name: String,
    /// Its version.
    pub(crate) version: String,
    /// The version of the boundary that it was built for, as `1.0`.
    pub(crate) abi: String,
    /// How many of its stem were opened before it.
    pub(crate) generation: u32,
    /// What it offers.
    pub(crate) classes: Vec<Class>,
}

/// Opens a copy of the given stem and generation, or says why not.
pub(super) type Opener = dyn FnMut(&Path, &str, u32) -> Result<Opened, String>;

/// The one opener that opens anything.
pub(super) fn really(copy: &Path, stem: &str, generation: u32) -> Result<Opened, String> {
    let opened = blaming("", || Library::open(copy, stem, generation));
    let library = opened.map_err(|failure| failure.message)?.map_err(|error| error.to_string())?;
    let (major, minor) = library.abi;
    Ok(Opened {
        name: library.name,
        version: library.version,
        abi: format!("{major}.{minor}"),
        generation,
        classes: library.classes,
    })
}

/// Opens a file that the person at the keyboard has named, and gives its hash.
///
/// # Errors
/// What is wrong with it, naming the file.
pub(crate) fn open_file(file: &Path) -> Result<(Opened, String), Failure> {
    let wrong = |why: String| {
        Failure::new(Exit::Input, format!("cannot use the library `{}`: {why}", file.display()))
    };
    let stem = search::stem_of(file).map_err(wrong)?;
    let copy = PrivateCopy::take(file, &stem, 0).map_err(wrong)?;
    let opened = really(&copy.path, &stem, 0).map_err(wrong)?;
    Ok((opened, copy.sha256.clone()))
}
