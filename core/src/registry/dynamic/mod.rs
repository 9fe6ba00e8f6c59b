//! Plugins from dynamic libraries: opened once, verified, never unloaded.
//!
//! A library's bytes are trusted before they come here: its constructors run when it is opened.

use std::fmt;
use std::path::Path;

use luxel_sdk::abi::Class;

/// A library that was opened and found sound. It stays in memory as long as the process lives.
#[derive(Clone, Debug)]
pub struct Library {
    /// The name it gives itself.
    pub name: String,
    /// Its version, as `1.2.3`.
    pub version: String,
    /// Major and minor version of the boundary that it was built for.
    pub abi: (u32, u32),
    /// What compiled it: information for people.
    pub compiler: String,
    /// How many libraries of this stem were opened before it in this process.
    pub generation: u32,
    /// What it offers.
    pub classes: Vec<Class>,
}

/// Why a library cannot be used.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LoadError {
    /// What was found and what would be right, lower case, no full stop.
    pub message: String,
}

impl fmt::Display for LoadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for LoadError {}

impl Library {
    /// Opens a private copy of a library and verifies what it offers. `stem` is the file's name
    /// without folder, `lib` and extension: the table's symbol is `luxel_plugin_v1_<stem>`.
    ///
    /// Code of the library runs: whoever calls has made sure that it is trusted.
    ///
    /// # Errors
    /// What is wrong with the library, with the first class at fault.
    pub fn open(_copy: &Path, stem: &str, _generation: u32) -> Result<Self, LoadError> {
        Err(LoadError { message: format!("`{stem}` cannot be opened yet") })
    }
}
