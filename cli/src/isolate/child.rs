//! The process that works, as its parent sees it.

use std::ffi::OsString;
use std::io::Write;
use std::path::PathBuf;
use std::process::{ChildStdin, ChildStdout, Command, Stdio};
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::VARIABLE;
use super::beat::{self, Phase, Told};
use super::ending::{End, Ending};
use crate::exit::{Exit, Failure};
use crate::files::Watched;

/// A process of this program; killed when dropped.
pub(crate) struct Child {
    process: std::process::Child,
    /// A byte asks it to stop; closed, it leaves.
    pipe: Option<ChildStdin>,
    /// Where it tells how far it is; also its place for temporary files, whatever becomes of it.
    folder: TempDir,
    told: Told,
    /// When something moved last.
    moved: Instant,
    looked: Instant,
    /// When it was asked to stop.
    asked: Option<Instant>,
    patience: Duration,
}

/// How long a child may take to stop when it is asked to.
const GRACE: Duration = Duration::from_secs(2);

/// Between two looks at what it tells.
const PERIOD: Duration = Duration::from_millis(50);

impl Child {
    /// Starts this program with these arguments.
    ///
    /// # Errors
    /// If the system refuses.
    pub(crate) fn start(
        args: impl IntoIterator<Item = OsString>,
        patience: Duration,
        out: Stdio,
    ) -> Result<Self, Failure> {
        let begin = || {
            let folder = tempfile::tempdir()?;
            let mut command = Command::new(std::env::current_exe()?);
            command.args(args).env(VARIABLE, folder.path()).stdin(Stdio::piped()).stdout(out);
            for variable in ["TMPDIR", "TMP", "TEMP"] {
                command.env(variable, folder.path());
            }
            Ok((command.spawn()?, folder))
        };
        let (mut process, folder) = begin().map_err(|error: std::io::Error| {
            Failure::new(Exit::Ours, format!("cannot start a process: {error}"))
        })?;
        let (pipe, now) = (process.stdin.take(), Instant::now());
        let told = Told::default();
        Ok(Self { process, pipe, folder, told, moved: now, looked: now, asked: None, patience })
    }

    /// What it prints, if that is not for the terminal.
    pub(crate) fn output(&mut self) -> Option<ChildStdout> {
        self.process.stdout.take()
    }

    /// How it ended, if it has: by itself, or because it exceeds a limit.
    pub(crate) fn poll(&mut self) -> Option<Ending> {
        if let Ok(Some(status)) = self.process.try_wait() {
            self.look();
            return Some(self.ending(End::of(status, self.told.phase)));
        }
        if self.looked.elapsed() >= PERIOD {
            self.look();
        }
        let end = match self.told.phase {
            // It will be whole soon, and no plugin can stand in the way.
            Phase::Saving => return None,
            _ if self.asked.is_some_and(|asked| asked.elapsed() > GRACE) => End::Stubborn,
            _ if self.moved.elapsed() > self.patience => End::Stuck(self.patience),
            _ => return None,
        };
        self.kill();
        Some(self.ending(end))
    }

    /// Asks it to stop; it is ended if it does not.
    pub(crate) fn stop(&mut self) {
        if self.asked.is_none() {
            self.asked = Some(Instant::now());
            // One that is gone already hears nothing.
            let _ = self.pipe.as_mut().map(|pipe| pipe.write_all(b"s").and_then(|()| pipe.flush()));
        }
    }

    /// The files that it has asked for.
    pub(crate) fn files(&self) -> Watched {
        let one = |(path, seen): &(String, Option<String>)| {
            let hash = seen.as_ref().and_then(|hex| blake3::Hash::from_hex(hex).ok());
            (PathBuf::from(path), hash)
        };
        self.told.files.iter().map(one).collect()
    }

    fn look(&mut self) {
        self.looked = Instant::now();
        if let Some(told) = beat::read(self.folder.path())
            && told != self.told
        {
            self.told = told;
            self.moved = self.looked;
        }
    }

    fn ending(&self, end: End) -> Ending {
        Ending { end, phase: self.told.phase, libraries: self.told.libraries.clone() }
    }

    fn kill(&mut self) {
        // One that has ended cannot be killed.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        self.kill();
    }
}
