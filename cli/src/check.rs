//! `luxel check`: everything that is wrong with scenes, without rendering.

mod fix;

use std::path::PathBuf;

use luxel_core::diag::Diagnostic;

use crate::args::{LoadArgs, PluginArgs};
use crate::exit::{Exit, Failure};
use crate::interrupt::Guard;
use crate::load::{self, Course};
use crate::report::{self, Form, Stream};

/// Tell everything that is wrong with scenes
///
/// Reads each scene with its meshes and textures and makes it ready to trace. Exit code 1 if any
/// has an error; warnings alone are fine. --fix first writes the mends that can only be meant so, as
/// a misspelt name with one known name near: each is told with its place, before and after. What is
/// likely, or one of several, is left to a person.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel check scenes/*.scene
  luxel check scenes/cornell.scene --print
  luxel check scenes/cornell.scene --fix
  luxel check scenes/cornell.scene --budget nodes=3e6,steps=1e9
  luxel check scenes/cornell.scene --json")]
pub(crate) struct Args {
    /// The scenes
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Print the scene graph that each file evaluates to
    #[arg(long, conflicts_with = "json")]
    print: bool,
    /// Diagnostics as JSON lines on standard output
    #[arg(long)]
    json: bool,
    /// Apply the mends that are sure to the scene's files, then tell what is left
    #[arg(long)]
    fix: bool,
    #[command(flatten)]
    load: LoadArgs,
    #[command(flatten)]
    plugins: PluginArgs,
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let plugins = load::registry(&args.plugins)?;
    let form = if args.json { Form::Json } else { Form::Text };
    let stream = if args.json { Stream::Out } else { Stream::Error };
    plugins.notes.tell(form, stream)?;
    let guard = args.fix.then(Guard::of_files).transpose()?;
    let mut exit = Exit::Fine;
    for file in &args.files {
        if let Some(guard) = &guard {
            fix::mended(file, &args.load, &plugins, form, guard)?;
        }
        let loaded = load::load(file, &args.load, None, &plugins, &Course::default())?;
        report::diagnostics(&loaded.diagnostics, &loaded.sources, form, stream)?;
        if loaded.stage.is_none() || loaded.diagnostics.iter().any(Diagnostic::is_error) {
            exit = Exit::Input;
        } else if !args.json && !args.print {
            report::out(&format!("{}: fine\n", file.display()))?;
        }
        if let (true, Some(scene)) = (args.print, &loaded.scene) {
            report::out(&luxel_core::scene::print(scene))?;
        }
    }
    Ok(exit)
}
