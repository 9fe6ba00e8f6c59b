//! How the program ends: codes, failures, and panics turned into failures.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

/// The program's exit codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Exit {
    /// All was done.
    Fine = 0,
    /// A scene, a file or the place of the output is at fault.
    Input = 1,
    /// The command line is at fault.
    Usage = 2,
    /// Interrupted: what was measured is there.
    Incomplete = 3,
    /// The program or a plugin is at fault.
    Ours = 4,
}

impl Exit {
    /// The exit with this code.
    pub(crate) fn of(code: i32) -> Option<Self> {
        let all = [Self::Fine, Self::Input, Self::Usage, Self::Incomplete, Self::Ours];
        all.into_iter().find(|exit| *exit as i32 == code)
    }
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> Self {
        Self::from(exit as u8)
    }
}

/// Why a command stopped, in words for people.
#[derive(Clone, Debug)]
pub(crate) struct Failure {
    /// The code.
    pub(crate) exit: Exit,
    /// Lower case, no full stop.
    pub(crate) message: String,
    /// What would be right.
    pub(crate) help: Option<String>,
}

impl Failure {
    pub(crate) fn new(exit: Exit, message: impl Into<String>) -> Self {
        Self { exit, message: message.into(), help: None }
    }

    pub(crate) fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

/// Runs a command; a panic is told as ours.
pub(crate) fn guarded(run: impl FnOnce() -> Result<Exit, Failure>) -> Result<Exit, Failure> {
    blaming("", run)?
}

/// Runs a step; a panic becomes a failure that names the scene.
///
/// Whatever the step was changing is dropped with it, so that no half-made value is seen.
pub(crate) fn blaming<T>(scene: &str, run: impl FnOnce() -> T) -> Result<T, Failure> {
    catch_unwind(AssertUnwindSafe(run)).map_err(|payload| {
        let words = payload
            .downcast_ref::<String>()
            .map(String::as_str)
            .or_else(|| payload.downcast_ref::<&str>().copied())
            .unwrap_or("no reason given");
        let at = if scene.is_empty() { String::new() } else { format!(" on `{scene}`") };
        Failure::new(Exit::Ours, format!("luxel failed{at}: {words}"))
            .help("this is a mistake in luxel or in a plugin, not in the scene; please report it")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_our_fault_and_names_the_scene() {
        let failure = blaming("a.scene", || -> u8 { panic!("broken {}", 7) }).unwrap_err();
        assert_eq!(failure.exit, Exit::Ours);
        assert!(failure.message.contains("a.scene") && failure.message.contains("broken 7"));
    }
}
