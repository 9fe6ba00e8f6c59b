//! The table of a document, written anew.

use std::io::Write;
use std::path::Path;

use super::row::{self, Row};
use crate::exit::{Exit, Failure};
use crate::generated::{part, replaced};
use crate::output::{Draft, unwritable};

/// The name of its part.
const PART: &str = "truths";

/// Whether a document has a place for the table.
///
/// # Errors
/// One that cannot be read, or has none.
pub(super) fn check(path: &Path) -> Result<(), Failure> {
    part(&text(path)?, PART).map(|_| ()).map_err(|message| unfit(path, &message))
}

/// Puts the table into a document: all of it or nothing.
///
/// # Errors
/// As `check`; what the disk says.
pub(super) fn write(path: &Path, rows: &[Row]) -> Result<(), Failure> {
    let new = replaced(&text(path)?, PART, &row::document(rows));
    let new = new.map_err(|message| unfit(path, &message))?;
    let mut draft = Draft::begin(path).map_err(|error| unwritable(path, &error))?;
    let written = draft.file.write_all(new.as_bytes()).and_then(|()| draft.finish());
    written.map_err(|error| unwritable(path, &error))
}

#[expect(clippy::disallowed_methods, reason = "the command line names the document")]
fn text(path: &Path) -> Result<String, Failure> {
    std::fs::read_to_string(path).map_err(|error| unfit(path, &error.to_string()))
}

fn unfit(path: &Path, message: &str) -> Failure {
    Failure::new(Exit::Input, format!("cannot write into `{}`: {message}", path.display()))
}
