//! From a save to what a browser shows of it, by the script of the browser tests.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::process::{Luxel, here};

/// Runs the script, which prints its own rows, where what it needs is there; else says what that is.
///
/// # Errors
/// The system's words; the script failed.
pub(super) fn run(luxel: &Luxel) -> Result<(), String> {
    let folder = folder();
    if let Some(missing) = missing(&folder, has_node()) {
        println!("save to drawn in a browser: left out, {missing}");
        return Ok(());
    }
    let program = std::path::absolute(&luxel.program).map_err(|error| error.to_string())?;
    let mut command = Command::new("node");
    command.arg("latency.mjs").current_dir(folder).env("LUXEL", program);
    let status = command.status().map_err(|error| format!("node: {error}"))?;
    if status.success() { Ok(()) } else { Err("tests/browser/latency.mjs failed".to_owned()) }
}

fn folder() -> PathBuf {
    here().join("../tests/browser")
}

/// What there has to be and is not, as the end of a sentence.
fn missing(folder: &Path, has_node: bool) -> Option<&'static str> {
    if !has_node {
        return Some("as there is no `node`");
    }
    let is_there = folder.join("node_modules/playwright-core").is_dir();
    (!is_there)
        .then_some("until `npm ci` has been run in tests/browser, which wants a chromium too")
}

fn has_node() -> bool {
    let version = Command::new("node").arg("--version").output();
    version.is_ok_and(|told| told.status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_missing_is_said_with_the_way_to_get_it() {
        assert_eq!(missing(&folder(), false), Some("as there is no `node`"));
        assert!(missing(Path::new("nowhere"), true).is_some_and(|told| told.contains("npm ci")));
        assert!(folder().join("latency.mjs").is_file());
    }
}
