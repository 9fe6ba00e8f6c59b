//! `--isolate`: the work runs in a process of its own, so that a plugin that crashes, leaves or never
//! ends costs a message.
//!
//! The child of a watch is the whole watch; where it comes to a bad end another one takes its place.
//! The child is this program with the same arguments; a variable of its environment names the folder
//! in which it tells how far it has come. Its standard input is a pipe: a byte asks it to stop, the
//! end of the pipe says that the parent is gone. Output, progress and pictures are its own.

mod again;
mod beat;
mod child;
mod ending;
mod supervise;

use std::process::Command;
use std::time::Duration;

use crate::args::MOST_SECONDS;

pub(crate) use again::{Address, Again};
pub(crate) use beat::{Beat, Phase};
pub(crate) use child::Child;
pub(crate) use ending::{End, Ending};
pub(crate) use supervise::{PATIENCE, supervise, tell};

/// Names the folder of the child's reports.
const VARIABLE: &str = "LUXEL_ISOLATED";

/// What names the folder for temporary files, which is the child's own in a child.
const TEMPORARY: [&str; 3] = ["TMPDIR", "TMP", "TEMP"];

/// Begins the names under which a child finds what those are outside.
const OUTER: &str = "LUXEL_OUTER_";

/// Lets a command that outlives this process run as if it had been started outside.
pub(crate) fn as_outside(command: &mut Command) {
    if std::env::var_os(VARIABLE).is_none() {
        return;
    }
    command.env_remove(VARIABLE);
    for variable in TEMPORARY {
        let outer = format!("{OUTER}{variable}");
        match std::env::var_os(&outer) {
            Some(value) => command.env(variable, value),
            None => command.env_remove(variable),
        };
        command.env_remove(outer);
    }
}

/// Whether the work gets a process of its own.
#[derive(clap::Args, Clone, Debug)]
pub(crate) struct IsolateArgs {
    /// Work in a process of its own, so that a plugin that crashes or never ends costs a message
    #[arg(long)]
    isolate: bool,
    /// With --isolate: how long nothing may move before that process is ended [default: 60; 300 for
    /// each class that `plugin test` judges]
    #[arg(
        long,
        value_name = "SECONDS",
        requires = "isolate",
        hide_short_help = true,
        value_parser = seconds
    )]
    patience: Option<Duration>,
}

impl IsolateArgs {
    /// What the work tells how far it has come; `None` if another process is to do it.
    pub(crate) fn beat(&self) -> Option<Beat> {
        match std::env::var_os(VARIABLE) {
            _ if !self.isolate => Some(Beat::silent()),
            Some(folder) => Some(Beat::to_parent(folder.into())),
            None => None,
        }
    }

    /// The same, as it is written on a command line.
    pub(crate) fn words(&self) -> Vec<String> {
        let mut words = vec![];
        words.extend(self.isolate.then(|| "--isolate".to_owned()));
        let seconds = self.patience.map(|patience| patience.as_secs_f64().to_string());
        words.extend(seconds.into_iter().flat_map(|n| ["--patience".to_owned(), n]));
        words
    }

    /// How long nothing may move.
    pub(crate) fn patience(&self, usual: Duration) -> Duration {
        self.patience.unwrap_or(usual)
    }
}

fn seconds(text: &str) -> Result<Duration, String> {
    let found = text.parse().ok().filter(|s: &f64| *s > 0.0 && *s <= MOST_SECONDS);
    found.map(Duration::from_secs_f64).ok_or_else(|| "expected seconds, as in 60".into())
}
