//! Documents that a measurement writes a part of.

use std::path::Path;

use crate::generated;

/// Puts `body` between the comments of that name in a file: all of it or nothing, through a file
/// beside it.
///
/// # Errors
/// As `generated::part`, and what the disk says, with the file's name.
#[expect(clippy::disallowed_methods, reason = "a document of the project is written anew")]
pub(crate) fn write(path: &Path, name: &str, body: &str) -> Result<(), String> {
    let told = |message: String| format!("{}: {message}", path.display());
    let text = std::fs::read_to_string(path).map_err(|error| told(error.to_string()))?;
    let text = generated::replaced(&text, name, body).map_err(told)?;
    let beside = path.with_extension("part");
    let written = std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, path));
    written.map_err(|error| told(error.to_string()))
}
