//! Ctrl-C: the first one asks for an orderly end, the second one ends at once.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::exit::{Exit, Failure};

/// Calls `first` at the first interrupt; the second ends the program. Termination counts as one.
///
/// # Errors
/// If the system refuses the handler.
pub(crate) fn on_ctrl_c(first: impl Fn() + Send + 'static) -> Result<(), Failure> {
    let asked = AtomicBool::new(false);
    ctrlc::set_handler(move || {
        if asked.swap(true, Ordering::Relaxed) {
            #[expect(clippy::exit, clippy::disallowed_methods, reason = "asked for twice")]
            std::process::exit(Exit::Incomplete as i32);
        }
        first();
    })
    .map_err(|error| Failure::new(Exit::Ours, format!("cannot listen for Ctrl-C: {error}")))
}
