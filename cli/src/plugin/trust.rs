//! `luxel plugin trust` and `distrust`: whose code may run.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::json;

use crate::exit::{Exit, Failure};
use crate::libraries::{Entry, Lock, Surroundings, is_searched, open_file, stem_of};
use crate::{list, report};

/// Let plugin libraries run as you
///
/// Opens each library, which runs its code, verifies what it offers, and writes its SHA-256 into
/// plugins.lock in your configuration folder: `$XDG_CONFIG_HOME/luxel`, else `~/.config/luxel` (macOS
/// `~/Library/Application Support/luxel`, Windows `%APPDATA%\luxel`). A library is native code: it can do
/// whatever you can. Its folder must be searched as well: see luxel plugin list --help.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel plugin trust target/release/libvelvet.so
  luxel plugin trust ~/plugins/*.so --json")]
pub(super) struct Args {
    /// The libraries
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// A JSON object for each
    #[arg(long)]
    json: bool,
}

/// Let plugin libraries no longer run
///
/// Removes every entry of that name from plugins.lock; opens nothing.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel plugin distrust velvet")]
pub(super) struct DistrustArgs {
    /// The library's name, or its file's without `lib` and extension
    name: String,
}

/// Where the lock is.
///
/// # Errors
/// An environment without a home.
fn home(surroundings: &Surroundings) -> Result<PathBuf, Failure> {
    surroundings.folder.clone().ok_or_else(|| {
        Failure::new(Exit::Input, "there is no configuration folder for plugins.lock")
            .help("set HOME or XDG_CONFIG_HOME to an absolute path")
    })
}

pub(super) fn run(args: &Args) -> Result<Exit, Failure> {
    let surroundings = Surroundings::of_process();
    let home = home(&surroundings)?;
    // One that cannot be understood is told before any code runs.
    Lock::read(Some(&home))?;
    let (mut exit, mut unsearched) = (Exit::Fine, BTreeSet::new());
    for file in &args.files {
        if let Err(failure) = trust(file, &home, args.json) {
            report::failure(&failure);
            exit = Exit::Input;
        } else if !is_searched(file, &surroundings)? {
            let file = std::path::absolute(file).unwrap_or_else(|_| file.clone());
            unsearched.extend(file.parent().map(Path::to_path_buf));
        }
    }
    for folder in unsearched {
        report::note(&format!(
            "`{}` is not searched: give --plugin-dir, or name it in `plugin_dirs` of config.toml or \
             in LUXEL_PLUGIN_PATH",
            folder.display()
        ));
    }
    Ok(exit)
}

fn trust(file: &Path, home: &Path, as_json: bool) -> Result<(), Failure> {
    let place = fs::canonicalize(file).map_err(|error| {
        Failure::new(Exit::Input, format!("cannot use the library `{}`: {error}", file.display()))
    })?;
    // The name that was given counts: a link's own may be that of a version.
    let stem = stem_of(file).map_err(|why| {
        Failure::new(Exit::Input, format!("cannot use the library `{}`: {why}", file.display()))
    })?;
    report::note(&format!("`{}` is opened: its code runs now", file.display()));
    let (opened, sha256) = open_file(file)?;
    let entry = Entry {
        stem,
        name: opened.name,
        version: opened.version,
        abi: opened.abi,
        sha256,
        path: place,
    };
    // Read again: another process, or the library, may have changed it.
    let mut lock = Lock::read(Some(home))?;
    let old = lock.put(entry.clone());
    lock.write(home)?;
    let Entry { name, version, abi, sha256, path, .. } = &entry;
    let replaced = old.as_ref().filter(|old| *old != &entry);
    if as_json {
        let object = json!({
            "name": name,
            "version": version,
            "abi": abi,
            "sha256": sha256,
            "path": path.to_string_lossy(),
            "replaced": replaced.map(|old| &old.sha256),
        });
        return report::out(&format!("{object}\n"));
    }
    let mut text = format!("trusted {name} {version}, ABI {abi}\n  sha256 {sha256}\n");
    if let Some(old) = replaced {
        let Entry { name, version, sha256, .. } = old;
        let _ = writeln!(text, "  in place of {name} {version}, sha256 {sha256}");
    }
    report::out(&text)
}

pub(super) fn distrust(args: &DistrustArgs) -> Result<Exit, Failure> {
    let home = home(&Surroundings::of_process())?;
    let mut lock = Lock::read(Some(&home))?;
    let is_meant = |entry: &Entry| entry.name == args.name || entry.stem == args.name;
    let (out, kept): (Vec<_>, Vec<_>) = lock.entries.into_iter().partition(is_meant);
    lock.entries = kept;
    if out.is_empty() {
        let known: Vec<_> = lock.entries.iter().map(|entry| entry.name.as_str()).collect();
        if known.is_empty() {
            return Err(Failure::new(Exit::Input, "no plugin library is trusted"));
        }
        return Err(list::unknown("trusted library", &args.name, &known));
    }
    lock.write(&home)?;
    for Entry { name, version, path, .. } in out {
        report::out(&format!("no longer trusted: {name} {version}, {}\n", path.display()))?;
    }
    Ok(Exit::Fine)
}
