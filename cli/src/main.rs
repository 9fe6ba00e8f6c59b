//! The program: scenes in, pictures out. One file per command; `report` alone prints.
#![forbid(unsafe_code)]

mod args;
mod check;
mod checkpoint;
mod codes;
mod compare;
mod denoise;
mod describe;
mod diff;
mod docs;
mod exit;
mod explain;
mod files;
mod fmt;
mod generated;
#[cfg(test)]
mod generated_tests;
mod goal;
mod interrupt;
mod isolate;
mod libraries;
mod list;
mod load;
mod lsp;
mod measure;
mod origin;
mod output;
mod picture;
mod plugin;
mod preview;
mod progress;
mod reached;
mod render;
mod report;
mod study;
mod summary;
#[cfg(test)]
mod testing;
mod verify;
mod view;
mod watch;
mod words;
mod written;

use std::process::ExitCode;

use clap::{ArgMatches, CommandFactory, FromArgMatches, Parser, Subcommand};
use luxel_core::memory::Memory;

use crate::exit::{Exit, Failure};
use crate::report::Form;

/// What large scenes take is given back sooner.
#[global_allocator]
static MEMORY: Memory = Memory::new();

/// A scene written as text becomes a picture that obeys physics and says how wrong it may be.
#[derive(Parser)]
#[command(name = "luxel", version = VERSION, after_help = EXIT_CODES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

/// Two builds of one version may make different pictures.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), " (build ", env!("LUXEL_BUILD"), ")");

const EXIT_CODES: &str = "\
Exit codes: 0 fine, 1 the input is at fault, 2 usage, 3 incomplete (interrupted), 4 our fault.

Examples:
  luxel render scenes/cornell.scene
  luxel watch scenes/cornell.scene --spp 16
  luxel view cornell.exr
  luxel compare cornell.exr reference.exr
  luxel describe material diffuse";

#[derive(Subcommand)]
enum Command {
    Render(render::Args),
    Watch(watch::Args),
    View(view::Args),
    Compare(compare::Args),
    Denoise(denoise::Args),
    Check(check::Args),
    Fmt(fmt::Args),
    Diff(diff::Args),
    Explain(explain::Args),
    Verify(verify::Args),
    Study(study::Args),
    List(list::Args),
    Describe(describe::Args),
    Docs(docs::Args),
    Plugin(plugin::Args),
    Lsp(lsp::Args),
}

fn main() -> ExitCode {
    MEMORY.begin();
    let words = watch::with_address(std::env::args_os());
    let matches = Cli::command().try_get_matches_from(words);
    let parsed = matches.and_then(|all| Ok((Cli::from_arg_matches(&all)?, wants_json(&all))));
    let cli = match parsed {
        Ok((cli, wants_json)) => {
            report::speak(if wants_json { Form::Json } else { Form::Text });
            cli
        }
        Err(error) => {
            // Help and version are errors to clap; they go to stdout with code 0.
            let told = if error.use_stderr() { Exit::Usage } else { Exit::Fine };
            return match report::usage(&error) {
                Ok(()) => told.into(),
                Err(failure) => failed(&failure).into(),
            };
        }
    };
    let done = exit::guarded(|| match &cli.command {
        Command::Render(args) => render::run(args),
        Command::Watch(args) => watch::run(args),
        Command::View(args) => view::run(args),
        Command::Compare(args) => compare::run(args),
        Command::Denoise(args) => denoise::run(args),
        Command::Check(args) => check::run(args),
        Command::Fmt(args) => fmt::run(args),
        Command::Diff(args) => diff::run(args),
        Command::Explain(args) => explain::run(args),
        Command::Verify(args) => verify::run(args),
        Command::Study(args) => study::run(args),
        Command::List(args) => list::run(args),
        Command::Describe(args) => describe::run(args),
        Command::Docs(args) => docs::run(args),
        Command::Plugin(args) => plugin::run(args),
        Command::Lsp(args) => lsp::run(args),
    });
    done.unwrap_or_else(|failure| failed(&failure)).into()
}

/// Whether a program reads what is told.
fn wants_json(matches: &ArgMatches) -> bool {
    matches!(matches.try_get_one("json"), Ok(Some(true)))
        || matches.subcommand().is_some_and(|(_, of)| wants_json(of))
}

fn failed(failure: &Failure) -> Exit {
    report::failure(failure);
    failure.exit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent_and_every_command_shows_examples() {
        let mut command = Cli::command();
        command.build();
        command.clone().debug_assert();
        shows_examples(&command);
    }

    fn shows_examples(command: &clap::Command) {
        let help = command.clone().render_long_help().to_string();
        assert!(help.contains("Examples:"), "{help}");
        command.get_subcommands().filter(|sub| sub.get_name() != "help").for_each(shows_examples);
    }
}
