//! Every table of docs/accuracy.md that Luxel alone can measure, written where it stands.

mod asked;
mod denoised;
mod studied;

use std::path::Path;
use std::process::Command;

use crate::process::{Luxel, here};
use crate::{document, errors};

/// The document, below the project's folder.
const DOCUMENT: &str = "docs/accuracy.md";

/// Writes them all; what takes long last.
///
/// # Errors
/// What a command or the disk says.
pub(crate) fn run(luxel: &Luxel) -> Result<(), String> {
    let root = here().parent().ok_or("the benches lie in the project's folder")?;
    let place = root.join(DOCUMENT);
    let write = |name: &str, body: &str| {
        println!("{name}\n{body}");
        document::write(&place, name, body)
    };
    told(Command::new(&luxel.program).args(["verify", "--write"]).arg(&place))?;
    errors::run(Some(&place))?;
    let tests = ["test", "-p", "luxel-tests", "intervals_hold_the_truth"];
    told(Command::new("cargo").args(tests).env("LUXEL_WRITE_DOCS", "1").current_dir(root))?;
    write("asked", &asked::table(root)?)?;
    write("denoised", &denoised::table(luxel, root)?)?;
    for study in studied::STUDIES {
        write(&study.name(), &study.run(luxel, root)?)?;
    }
    Ok(())
}

/// What a command prints, if it ends well.
fn told(command: &mut Command) -> Result<String, String> {
    answer(command, &[0])
}

/// What a command prints, if it ends with one of these codes.
fn answer(command: &mut Command, fine: &[i32]) -> Result<String, String> {
    let output = command.output().map_err(|error| format!("{command:?}: {error}"))?;
    if !output.status.code().is_some_and(|code| fine.contains(&code)) {
        return Err(format!("{command:?}: {}", String::from_utf8_lossy(&output.stderr)));
    }
    String::from_utf8(output.stdout).map_err(|_| format!("{command:?}: no text"))
}

/// Runs the program in a folder.
fn luxel(luxel: &Luxel, folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(&luxel.program);
    command.args(words).current_dir(folder);
    command
}
