//! `--exec`: a command after each finished picture.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::mailbox::Mailbox;
use crate::isolate;
use crate::output::Output;
use crate::report;

/// Runs a command for the latest finished picture, one after another.
pub(super) struct After(Mailbox<Output>);

impl After {
    /// The shell's command, for pictures of this scene.
    pub(super) fn new(command: OsString, scene: PathBuf) -> Self {
        Self(Mailbox::new(move |output| run(&command, &scene, &output)))
    }

    /// Begins nothing more.
    pub(super) fn end(&self) {
        self.0.clear();
    }

    /// There is a picture.
    pub(super) fn picture(&self, output: Output) {
        self.0.put(output);
    }
}

/// Runs it to its end; what it prints goes to standard error.
fn run(command: &OsString, scene: &Path, Output { exr, png }: &Output) {
    let (shell, takes) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
    let mut process = Command::new(shell);
    isolate::as_outside(&mut process);
    process
        .arg(takes)
        .arg(command)
        .envs([("LUXEL_SCENE", scene), ("LUXEL_EXR", exr), ("LUXEL_PNG", png)])
        .stdin(Stdio::null())
        .stdout(std::io::stderr());
    let told = match process.status() {
        Ok(status) if status.success() => return,
        Ok(status) => status.to_string(),
        Err(error) => error.to_string(),
    };
    report::warning(&format!("`{}`: {told}", command.display()));
}
