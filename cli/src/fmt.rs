//! `luxel fmt`: scenes written as everyone writes them.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use luxel_core::diag::{Diagnostic, Sources, Span};
use luxel_core::files::FileError;
use serde_json::json;

use crate::args::BudgetArgs;
use crate::exit::{Exit, Failure};
use crate::files::read_limited;
use crate::interrupt::Guard;
use crate::output::{replace, unwritable};
use crate::report::{self, Form, Stream};

/// Lay scenes out: the same tree, every comment, one way to write them
///
/// Writes each file anew if its layout is another; a file that cannot be read is not touched, and told.
/// docs/language.md has the rules. Exit code 1 if a file has a mistake or, with --check, if one would
/// change.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel fmt scenes/*.scene
  luxel fmt --check scenes/*.scene
  luxel fmt - < scenes/cornell.scene")]
pub(crate) struct Args {
    /// The scenes; `-` is standard input, laid out on standard output
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Write nothing; name the files that would change
    #[arg(long)]
    check: bool,
    /// JSON lines on standard output: diagnostics, and each file with whether it changes
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    budgets: BudgetArgs,
}

/// A text before and after.
struct Pair {
    before: String,
    after: String,
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let streams = args.files.iter().filter(|file| is_stream(file)).count();
    if streams > 1 || streams == 1 && args.json && !args.check {
        let message = "standard input is laid out once, and without --json";
        return Err(Failure::new(Exit::Usage, message));
    }
    let guard = Guard::of_files()?;
    let mut exit = Exit::Fine;
    for file in &args.files {
        guard.next_file()?;
        match one(file, args, &guard) {
            Ok(Exit::Fine) => {}
            Ok(other) => exit = other,
            Err(failure) if failure.exit == Exit::Input => {
                report::failure(&failure);
                exit = Exit::Input;
            }
            Err(failure) => return Err(failure),
        }
    }
    Ok(exit)
}

fn one(file: &Path, args: &Args, guard: &Guard) -> Result<Exit, Failure> {
    let Some(Pair { before, after }) = laid_out(file, args)? else { return Ok(Exit::Input) };
    let (changes, name) = (before != after, name(file));
    if args.json {
        report::out(&format!("{}\n", json!({ "file": name, "changes": changes })))?;
    }
    if args.check {
        if changes && !args.json {
            report::out(&format!("{name}: not laid out\n"))?;
        }
        return Ok(if changes { Exit::Input } else { Exit::Fine });
    }
    if is_stream(file) {
        report::out(&after)?;
    } else if changes {
        let _whole = guard.saving();
        replace(file, &after).map_err(|error| unwritable(file, &error))?;
    }
    Ok(Exit::Fine)
}

/// A file's text before and after; none if it has a mistake, which is told.
fn laid_out(file: &Path, args: &Args) -> Result<Option<Pair>, Failure> {
    let budgets = args.budgets.budgets();
    let mut sources = Sources::default();
    let found = match read(file, budgets.file_bytes as u64).map(String::from_utf8) {
        Ok(Ok(before)) => match luxel_lang::format(&before, &budgets) {
            Ok(after) => return Ok(Some(Pair { before, after })),
            Err(found) => {
                sources.add(name(file), before);
                found
            }
        },
        Err(error) => {
            sources.add(name(file), "");
            vec![luxel_lang::unreadable(file, &error)]
        }
        Ok(Err(error)) => {
            let at = error.utf8_error().valid_up_to();
            let text = String::from_utf8_lossy(&error.as_bytes()[..at]).into_owned();
            let span = Span::new(sources.add(name(file), text), at, at);
            let message = format!("byte {at} of the file is not UTF-8");
            vec![Diagnostic::error("E0003", span, message)]
        }
    };
    let (form, stream) =
        if args.json { (Form::Json, Stream::Out) } else { (Form::Text, Stream::Error) };
    report::diagnostics(&found, &sources, form, stream)?;
    Ok(None)
}

fn is_stream(file: &Path) -> bool {
    file == Path::new("-")
}

fn name(file: &Path) -> String {
    if is_stream(file) { "standard input".to_owned() } else { file.display().to_string() }
}

/// The bytes of a file, or of standard input, of which there may be so many.
fn read(file: &Path, limit: u64) -> Result<Vec<u8>, FileError> {
    if !is_stream(file) {
        return read_limited(file, limit);
    }
    let mut bytes = vec![];
    let read = io::stdin().lock().take(limit + 1).read_to_end(&mut bytes);
    read.map_err(|error| FileError::Unreadable(error.to_string()))?;
    if bytes.len() as u64 > limit { Err(FileError::TooLarge(limit)) } else { Ok(bytes) }
}
