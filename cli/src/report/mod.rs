//! The only printing. A reader who has gone away (a closed pipe) is no error.

mod plain;
mod snippet;
mod window;

use std::io::{self, IsTerminal, Write};

use luxel_core::diag::{Diagnostic, Sources};

use crate::exit::Failure;

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
pub(crate) fn out(text: &str) {
    put(Stream::Out, text);
}

/// Prints a remark for people.
pub(crate) fn note(text: &str) {
    put(Stream::Error, &format!("{}\n", plain::clean(text)));
}

/// Prints a warning that belongs to no place in a file.
pub(crate) fn warning(message: &str) {
    put(Stream::Error, &format!("warning: {}\n", plain::clean(message)));
}

/// Prints why a command stopped.
pub(crate) fn failure(failure: &Failure) {
    let mut text = format!("error: {}\n", plain::clean(&failure.message));
    if let Some(help) = &failure.help {
        text.extend(["  help: ", &plain::clean(help), "\n"]);
    }
    put(Stream::Error, &text);
}

/// Prints what clap has to say: help, version or a mistake of the command line.
pub(crate) fn usage(error: &clap::Error) {
    let _ = error.print();
}

/// Redraws the line of progress on standard error; an empty one is wiped.
pub(crate) fn progress(line: &str) {
    put(Stream::Error, &format!("\r{line}\x1b[K"));
}

/// Prints diagnostics, then how many there are.
pub(crate) fn diagnostics(found: &[Diagnostic], sources: &Sources, form: Form, stream: Stream) {
    match form {
        Form::Json => {
            for diagnostic in found {
                put(stream, &format!("{}\n", plain::json(diagnostic, sources)));
            }
        }
        Form::Text => {
            let coloured = match stream {
                Stream::Out => io::stdout().is_terminal(),
                Stream::Error => io::stderr().is_terminal(),
            };
            for diagnostic in found {
                let text = snippet::render(diagnostic, sources, coloured);
                put(stream, &format!("{text}\n\n"));
            }
            if !found.is_empty() {
                put(stream, &format!("{}\n", plain::count(found)));
            }
        }
    }
}

fn put(stream: Stream, text: &str) {
    let _ = match stream {
        Stream::Out => {
            let mut out = io::stdout().lock();
            out.write_all(text.as_bytes()).and_then(|()| out.flush())
        }
        Stream::Error => io::stderr().lock().write_all(text.as_bytes()),
    };
}
