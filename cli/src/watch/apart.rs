//! Watching in a process of its own, and in another one when that comes to a bad end.

use std::process::Stdio;
use std::sync::atomic::Ordering;

use super::Args;
use crate::exit::{Exit, Failure};
use crate::interrupt;
use crate::isolate::{self, Child, End, PATIENCE, Phase};
use crate::report;

/// Has the watch done by a child, and after a crash by another one, which waits for a save first.
///
/// # Errors
/// If there can be no child.
pub(super) fn watch(args: &Args) -> Result<Exit, Failure> {
    let pressed = interrupt::pressed()?;
    let mut again = None;
    loop {
        let own = std::env::args_os().skip(1);
        let patience = args.isolate.patience(PATIENCE);
        let mut child = Child::start(own, patience, Stdio::inherit(), again.as_ref())?;
        let ending = child.ending(&pressed);
        if let End::InOrder(exit) = ending.end {
            return Ok(exit);
        }
        if pressed.load(Ordering::Relaxed) {
            report::note("watching has ended");
            return Ok(Exit::Fine);
        }
        isolate::tell(&ending, &args.file, args.form())?;
        // Neither a plugin nor the scene has done that: the next one would end so too.
        if ending.phase == Phase::Starting {
            return Ok(Exit::Ours);
        }
        // What did not stop for a save makes room for what was saved.
        let failure = ending.failure(&args.file).filter(|_| ending.end != End::Stubborn);
        again = Some(child.leaves(failure));
    }
}
