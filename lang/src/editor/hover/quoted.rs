//! What is told of strings: files, names of catalogues, words of parameters, libraries.

use std::path::Path;

use luxel_core::files::FileError;

use super::super::define::beside;
use super::super::schema::Given;
use super::super::swatch;
use super::super::texts::{Said, said};
use super::{Asked, Hover};
use crate::eval::readable::number;
use crate::syntax::tokens;

impl Asked<'_> {
    /// What is told of the string that begins at a byte.
    pub(super) fn quoted(&self, start: usize) -> Option<Hover> {
        let text = self.around.document.text();
        let token = tokens(text, start..text.len()).next()?;
        let content = token.text.trim_matches('"');
        let told = |code: String, text: String| Some(Hover::new(start..token.end(), code, text));
        match said(self.around, self.here) {
            Said::File(_) => {
                let path = beside(self.around.path, content);
                told(token.text.to_owned(), file(&path, self.around.project.size(&path)))
            }
            Said::Named(function) => {
                let value = swatch::named(function, content)?;
                let told = told(format!("{function}({})", token.text), String::new())?;
                Some(Hover { value: Some(value), ..told })
            }
            Said::Word(param, of) => {
                let given = Given::Param(param, of);
                told(format!("{}: {}", given.name(), given.facts()), given.doc().to_owned())
            }
            Said::Library => {
                let mut loaded = self.around.registry.libraries();
                let found = loaded.find(|(name, _)| *name == content);
                let state = |(name, version)| format!("`{name}` {version} is loaded.");
                let none = || "No library of that name is loaded.".to_owned();
                told(format!("use plugin {}", token.text), found.map_or_else(none, state))
            }
            Said::Version(_) | Said::Other => None,
        }
    }
}

/// Where a file is and how large, or why it cannot be read.
fn file(path: &Path, size: Result<u64, FileError>) -> String {
    let path = path.display();
    match size {
        Ok(size) => format!("`{path}`, {}", bytes(size)),
        Err(why) => format!("`{path}`: {why}"),
    }
}

/// A number of bytes in words.
fn bytes(n: u64) -> String {
    const UNITS: [(&str, u64); 3] = [("GB", 1_000_000_000), ("MB", 1_000_000), ("kB", 1000)];
    match UNITS.iter().find(|(_, unit)| n >= *unit) {
        Some((name, unit)) => format!("{} {name}", number((n / (unit / 10)) as f64 / 10.0)),
        None => format!("{n} byte{}", if n == 1 { "" } else { "s" }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_told_in_few_digits() {
        let told = [1, 999, 1000, 12_345, 999_999, 2_500_000_000].map(bytes);
        assert_eq!(told, ["1 byte", "999 bytes", "1 kB", "12.3 kB", "999.9 kB", "2.5 GB"]);
    }
}
