//! How a child ended, in words.

use std::path::Path;
use std::process::ExitStatus;
use std::time::Duration;

use super::beat::Phase;
use crate::exit::{Exit, Failure};

/// How a child ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// In order, with a code; it has said why.
    InOrder(Exit),
    /// Something in it ended the process, with this code.
    Left(i32),
    /// The system ended it.
    Killed(i32),
    /// Nothing moved for so long, and it was ended.
    Stuck(Duration),
    /// It was asked to stop, did not, and was ended.
    Stubborn,
}

/// How a child ended, when, and what may have done it.
#[derive(Clone, Debug)]
pub(crate) struct Ending {
    pub(crate) end: End,
    pub(crate) phase: Phase,
    pub(crate) libraries: Vec<String>,
}

impl End {
    pub(super) fn of(status: ExitStatus, phase: Phase) -> Self {
        #[cfg(unix)]
        if let Some(signal) = std::os::unix::process::ExitStatusExt::signal(&status) {
            return Self::Killed(signal);
        }
        let code = status.code().unwrap_or(-1);
        match Exit::of(code) {
            Some(exit) if phase == Phase::Ended => Self::InOrder(exit),
            _ => Self::Left(code),
        }
    }

    /// As in "it …".
    pub(crate) fn words(self) -> String {
        match self {
            Self::InOrder(exit) => format!("ended with code {}", exit as i32),
            Self::Left(code) => format!("ended the process, with code {code}"),
            Self::Killed(signal) => format!("was killed by signal {}", named(signal)),
            Self::Stuck(patience) => {
                format!("never ends: nothing moved for {} s", patience.as_secs_f64())
            }
            Self::Stubborn => "did not stop when it was asked to".to_owned(),
        }
    }
}

impl Ending {
    /// What a person is told; nothing of an orderly end.
    pub(crate) fn failure(&self, what: &Path) -> Option<Failure> {
        if let End::InOrder(_) = self.end {
            return None;
        }
        let (what, phase) = (what.display(), self.phase.words());
        let message = format!("the process of `{what}` {} while {phase}", self.end.words());
        let help = if self.libraries.is_empty() {
            "no plugin library was open: please report this".to_owned()
        } else {
            let of = self.libraries.join(", ");
            format!("native code of plugins may do that; open were {of}")
        };
        let failure = Failure::new(Exit::Input, message).help(help);
        Some(failure)
    }
}

/// `11 (SIGSEGV)`
fn named(signal: i32) -> String {
    let bus = if cfg!(target_os = "linux") { 7 } else { 10 };
    let name = match signal {
        2 => "SIGINT",
        4 => "SIGILL",
        5 => "SIGTRAP",
        6 => "SIGABRT",
        8 => "SIGFPE",
        9 => "SIGKILL: perhaps memory ran out",
        11 => "SIGSEGV",
        13 => "SIGPIPE",
        15 => "SIGTERM",
        24 if cfg!(target_os = "linux") => "SIGXCPU",
        other if other == bus => "SIGBUS",
        _ => return signal.to_string(),
    };
    format!("{signal} ({name})")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_end_names_scene_phase_signal_and_libraries() {
        let libraries = vec!["crash 0.1.0 (`/p/libcrash.so`)".to_owned()];
        let ending = Ending { end: End::Killed(11), phase: Phase::Building, libraries };
        let failure = ending.failure(Path::new("a.scene")).unwrap();
        let told = "the process of `a.scene` was killed by signal 11 (SIGSEGV) while building the \
                    scene";
        assert_eq!((failure.exit, failure.message.as_str()), (Exit::Input, told));
        assert!(failure.help.unwrap().contains("crash 0.1.0"));
        let fine = Ending { end: End::InOrder(Exit::Fine), ..ending };
        assert!(fine.failure(Path::new("a.scene")).is_none());
    }

    #[cfg(unix)]
    #[test]
    fn only_a_code_after_the_end_was_told_is_an_orderly_end() {
        use std::os::unix::process::ExitStatusExt;
        let end = |raw, phase| End::of(ExitStatus::from_raw(raw), phase);
        assert_eq!(end(0, Phase::Ended), End::InOrder(Exit::Fine));
        assert_eq!(end(0, Phase::Rendering), End::Left(0));
        assert_eq!(end(77 << 8, Phase::Ended), End::Left(77));
        assert_eq!(end(6, Phase::Ended), End::Killed(6));
    }
}
