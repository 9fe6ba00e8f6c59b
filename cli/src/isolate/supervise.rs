//! One child from its start to its end.

use std::path::Path;
use std::process::Stdio;
use std::sync::atomic::Ordering;
use std::time::Duration;

use luxel_core::diag::{Diagnostic, Sources};

use super::IsolateArgs;
use super::child::Child;
use super::ending::{End, Ending};
use crate::exit::{Exit, Failure};
use crate::interrupt;
use crate::report::{self, Form, Stream};

/// So long a render may stand still.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

/// Has this program's arguments carried out by a child. Ctrl-C is passed on.
///
/// # Errors
/// If there can be no child.
pub(crate) fn supervise(
    scene: &Path,
    args: &IsolateArgs,
    form: Form,
    open: impl FnOnce() -> Vec<String>,
) -> Result<Exit, Failure> {
    let pressed = interrupt::pressed()?;
    let own = std::env::args_os().skip(1);
    let mut child = Child::start(own, args.patience(PATIENCE), Stdio::inherit(), None)?;
    let mut ending = child.ending(&pressed);
    if let End::InOrder(exit) = ending.end {
        return Ok(exit);
    }
    if pressed.load(Ordering::Relaxed) {
        let how = match ending.end {
            End::Stubborn => ": it did not stop when it was asked to",
            _ => "",
        };
        let when = ending.phase.words();
        let message = format!("interrupted while {when}{how}; no picture was written");
        return Err(Failure::new(Exit::Incomplete, message));
    }
    if ending.libraries.is_empty() {
        ending.libraries = open();
    }
    tell(&ending, scene, form)?;
    Ok(Exit::Input)
}

/// Tells how a child ended, unless it ended in order.
///
/// # Errors
/// As `report::diagnostics`.
pub(crate) fn tell(ending: &Ending, scene: &Path, form: Form) -> Result<(), Failure> {
    let Some(failure) = ending.failure(scene) else { return Ok(()) };
    let found = Diagnostic::unplaced("E0421", failure.message);
    let found = failure.help.into_iter().fold(found, Diagnostic::help);
    report::end_of_progress();
    report::diagnostics(&[found], &Sources::default(), form, Stream::Error)
}
