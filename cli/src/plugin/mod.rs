//! `luxel plugin`: what concerns those who write plugins.

mod course;
mod mutants;
mod test;

use crate::exit::{Exit, Failure};

/// Judge plugins
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel plugin test filter
  luxel plugin test --help")]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand, Debug)]
enum Command {
    Test(test::Args),
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    match &args.command {
        Command::Test(args) => test::run(args),
    }
}
