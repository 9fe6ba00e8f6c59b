//! The process that works, as its parent sees it.

use std::ffi::OsString;
use std::io::Write;
use std::process::{ChildStdin, ChildStdout, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use tempfile::TempDir;

use super::again::Again;
use super::beat::{self, Phase, Told};
use super::ending::{End, Ending};
use super::{OUTER, TEMPORARY, VARIABLE};
use crate::exit::{Exit, Failure};

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

/// Between two looks at whether it has ended.
const TICK: Duration = Duration::from_millis(5);

/// Between two looks at what it tells.
const PERIOD: Duration = Duration::from_millis(50);

impl Child {
    /// Starts this program with these arguments, perhaps in the place of another one.
    ///
    /// # Errors
    /// If the system refuses.
    pub(crate) fn start(
        args: impl IntoIterator<Item = OsString>,
        patience: Duration,
        out: Stdio,
        again: Option<&Again>,
    ) -> Result<Self, Failure> {
        let begin = || {
            let folder = tempfile::tempdir()?;
            again.map(|again| beat::leave_to(folder.path(), again)).transpose()?;
            let mut command = Command::new(std::env::current_exe()?);
            command.args(args).env(VARIABLE, folder.path()).stdin(Stdio::piped()).stdout(out);
            for variable in TEMPORARY {
                let own = std::env::var_os(variable);
                command.envs(own.map(|own| (format!("{OUTER}{variable}"), own)));
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
            return Some(self.ended(End::of(status, self.told.phase)));
        }
        if self.looked.elapsed() >= PERIOD {
            self.look();
        }
        let end = match self.told.phase {
            // It will be whole soon, and no plugin can stand in the way.
            Phase::Saving => return None,
            _ if self.asked.is_some_and(|asked| asked.elapsed() > GRACE) => End::Stubborn,
            Phase::Waiting => return None,
            _ if self.told.is_overtaken && self.moved.elapsed() > GRACE => End::Stubborn,
            _ if self.moved.elapsed() > self.patience => End::Stuck(self.patience),
            _ => return None,
        };
        self.kill();
        Some(self.ended(end))
    }

    /// Asks it to stop; it is ended if it does not.
    pub(crate) fn stop(&mut self) {
        if self.asked.is_none() {
            self.asked = Some(Instant::now());
            // One that is gone already hears nothing.
            let _ = self.pipe.as_mut().map(|pipe| pipe.write_all(b"s").and_then(|()| pipe.flush()));
        }
    }

    /// What it leaves to one that takes its place, which waits for a save first if `failure` says why.
    pub(crate) fn leaves(&self, failure: Option<Failure>) -> Again {
        Again::after(&self.told, failure)
    }

    /// Waits for its end. Ctrl-C is passed on.
    pub(crate) fn ending(&mut self, pressed: &AtomicBool) -> Ending {
        loop {
            if let Some(ending) = self.poll() {
                return ending;
            }
            if pressed.load(Ordering::Relaxed) {
                self.stop();
            }
            std::thread::sleep(TICK);
        }
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

    fn ended(&self, end: End) -> Ending {
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
