//! The only printing. A reader who has gone away (a closed pipe) is no error; standard output that
//! cannot be written (a full disk) is one. What cannot be told on standard error is lost.

mod plain;
mod snippet;
mod window;

use std::io::{self, IsTerminal, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use luxel_core::diag::{Diagnostic, Severity, Sources, in_order};

use crate::exit::{Exit, Failure};

/// How diagnostics are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    /// With an excerpt of the source, for people.
    Text,
    /// A JSON object per line, for programs.
    Json,
}

/// Where something is printed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stream {
    /// Standard output: what was asked for.
    Out,
    /// Standard error: everything else.
    Error,
}

/// Prints what was asked for.
///
/// # Errors
/// If standard output cannot be written.
pub(crate) fn out(text: &str) -> Result<(), Failure> {
    put(Stream::Out, text)
}

/// Prints a remark for people.
pub(crate) fn note(text: &str) {
    tell(&format!("{}\n", plain::clean(text)));
}

/// Tells a person at the terminal, and nobody else, what is going on; takes the place of the line of
/// progress.
pub(crate) fn aside(text: &str) {
    if io::stderr().is_terminal() {
        tell(&format!("\r\x1b[K{}\n", plain::clean(text)));
    }
}

/// How warnings and failures that belong to no place in a file are told from now on: as text, unless
/// something else is said before anything is told.
static FORM: OnceLock<Form> = OnceLock::new();

/// Tells warnings and failures in this form.
pub(crate) fn speak(form: Form) {
    FORM.get_or_init(|| form);
}

/// Prints a warning that belongs to no place in a file.
pub(crate) fn warning(message: &str) {
    remark(Severity::Warning, message, None);
}

/// Prints why a command stopped.
pub(crate) fn failure(failure: &Failure) {
    remark(Severity::Error, &failure.message, failure.help.as_deref());
}

fn remark(severity: Severity, message: &str, help: Option<&str>) {
    if FORM.get() == Some(&Form::Json) {
        tell(&format!("{}\n", plain::remark(severity, message, help)));
        return;
    }
    let mut text = format!("{}: {}\n", plain::word(severity), plain::clean(message));
    if let Some(help) = help {
        text.extend(["  help: ", &plain::clean(help), "\n"]);
    }
    tell(&text);
}

/// Prints what clap has to say: help and version on standard output, a mistake of the command line
/// on standard error.
///
/// # Errors
/// As `out`.
pub(crate) fn usage(error: &clap::Error) -> Result<(), Failure> {
    let printed = error.print().and_then(|()| io::stdout().lock().flush());
    if error.use_stderr() { Ok(()) } else { written(printed) }
}

/// Redraws the line of progress on standard error; an empty one is wiped.
pub(crate) fn progress(line: &str) {
    tell(&format!("\r{line}\x1b[K"));
}

/// Wipes a line of progress that another process has left.
pub(crate) fn end_of_progress() {
    if io::stderr().is_terminal() {
        progress("");
    }
}

/// Prints diagnostics in the order of their places, then how many there are.
///
/// # Errors
/// As `out`, where they go there.
pub(crate) fn diagnostics(
    found: &[Diagnostic],
    sources: &Sources,
    form: Form,
    stream: Stream,
) -> Result<(), Failure> {
    let found = &in_order(found);
    match form {
        Form::Json => {
            for diagnostic in found {
                put(stream, &format!("{}\n", plain::json(diagnostic, sources)))?;
            }
        }
        Form::Text => {
            let coloured = match stream {
                Stream::Out => io::stdout().is_terminal(),
                Stream::Error => io::stderr().is_terminal(),
            };
            for diagnostic in found {
                let text = snippet::render(diagnostic, sources, coloured);
                put(stream, &format!("{text}\n\n"))?;
            }
            if !found.is_empty() {
                put(stream, &format!("{}\n", plain::closing(found)))?;
            }
        }
    }
    Ok(())
}

/// A diagnostic with its excerpt, as for people, without colours.
pub(crate) fn excerpt(diagnostic: &Diagnostic, sources: &Sources) -> String {
    snippet::render(diagnostic, sources, false)
}

fn put(stream: Stream, text: &str) -> Result<(), Failure> {
    match stream {
        Stream::Out => {
            let mut out = io::stdout().lock();
            written(out.write_all(text.as_bytes()).and_then(|()| out.flush()))
        }
        Stream::Error => {
            tell(text);
            Ok(())
        }
    }
}

/// To standard error, beside which there is no other place to complain.
fn tell(text: &str) {
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

/// What `is_unheard` tells.
static UNHEARD: AtomicBool = AtomicBool::new(false);

/// Whether whoever read standard output has gone: nobody is told anything any more.
pub(crate) fn is_unheard() -> bool {
    UNHEARD.load(Ordering::Relaxed)
}

fn written(done: io::Result<()>) -> Result<(), Failure> {
    match done {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => {
            UNHEARD.store(true, Ordering::Relaxed);
            Ok(())
        }
        Err(error) => {
            let message = format!("cannot write to standard output: {error}");
            Err(Failure::new(Exit::Input, message))
        }
        Ok(()) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reader_who_has_gone_is_no_error_and_a_full_device_is_one() {
        let end = |kind: io::ErrorKind| written(Err(kind.into())).map_err(|f| f.exit);
        assert_eq!(end(io::ErrorKind::BrokenPipe), Ok(()));
        assert_eq!(end(io::ErrorKind::StorageFull), Err(Exit::Input));
    }
}
