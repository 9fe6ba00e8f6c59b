//! `luxel check --fix`: mends that are sure, written into the files that they stand in.

use std::io::{self, Write as _};
use std::path::Path;

use luxel_core::diag::{Fix, Mended, Sources, mend};
use luxel_core::files::Files as _;
use serde_json::json;

use crate::args::LoadArgs;
use crate::exit::Failure;
use crate::files::DiskFiles;
use crate::libraries::Plugins;
use crate::load::{self, Course, Text};
use crate::output::{Draft, unwritable};
use crate::report::{self, Form};

/// How often a scene is read again: what one mend uncovers the next may mend.
const ROUNDS: usize = 16;

/// Mends a scene and the files that it includes, and tells what was changed.
///
/// # Errors
/// A file that cannot be written; as `load::read`.
pub(super) fn mended(
    scene: &Path,
    args: &LoadArgs,
    plugins: &Plugins,
    form: Form,
) -> Result<(), Failure> {
    for _ in 0..ROUNDS {
        let text = load::read(scene, args, None, plugins, &Course::default())?;
        let Text { diagnostics, sources, files, .. } = &text;
        let found =
            mend(diagnostics, sources, |id| is_file(files, sources.name(id), sources.text(id)));
        if found.is_empty() {
            break;
        }
        for mended in &found {
            let path = Path::new(sources.name(mended.source));
            write(path, &mended.text).map_err(|error| unwritable(path, &error))?;
            tell(mended, sources, form)?;
        }
    }
    Ok(())
}

/// Whether a text is that of a file which the scene may read: what was set on the command line is
/// none, and neither is what has changed since it was read.
fn is_file(files: &DiskFiles, name: &str, text: &str) -> bool {
    files.read(Path::new(name)).is_ok_and(|bytes| *bytes == *text.as_bytes())
}

fn write(path: &Path, text: &str) -> io::Result<()> {
    let mut draft = Draft::begin(path)?;
    draft.file.write_all(text.as_bytes())?;
    draft.finish()
}

fn tell(mended: &Mended, sources: &Sources, form: Form) -> Result<(), Failure> {
    for (code, fix) in &mended.changes {
        let file = sources.name(mended.source);
        let at = sources.line_column(mended.source, fix.span.range().start);
        let old = &sources.text(mended.source)[fix.span.range()];
        match form {
            Form::Text => {
                let change = change(old, fix);
                report::note(&format!("{file}:{}:{}: {code}: {change}", at.line, at.column));
            }
            Form::Json => {
                let told = json!({
                    "fixed": code,
                    "file": file,
                    "line": at.line,
                    "column": at.column,
                    "before": old,
                    "after": fix.replacement,
                });
                report::out(&format!("{told}\n"))?;
            }
        }
    }
    Ok(())
}

/// What a mend did, in words.
fn change(old: &str, fix: &Fix) -> String {
    let new = fix.replacement.trim();
    match (old, new) {
        ("", new) => format!("`{new}` added"),
        (old, "") => format!("`{old}` taken out"),
        (old, new) => format!("`{old}` → `{new}`"),
    }
}
