//! `luxel plugin`: what concerns those who write plugins, and those who use them.

mod list;
mod trust;
mod new;
mod test;
mod apart;
mod course;
mod mutants;
mod template;

use crate::exit::{Exit, Failure};

/// Begin, judge, trust and list plugins
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel plugin new material velvet
  luxel plugin trust target/release/libvelvet.so
  luxel plugin list --plugin-dir target/release
  luxel plugin test filter")]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(clap::Subcommand, Debug)]
enum Command {
    New(new::Args),
    Test(test::Args),
    Trust(trust::Args),
    Distrust(trust::DistrustArgs),
    List(list::Args),
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    match &args.command {
        Command::New(args) => new::run(args),
        Command::Test(args) => test::run(args),
        Command::Trust(args) => trust::run(args),
        Command::Distrust(args) => trust::distrust(args),
        Command::List(args) => list::run(args),
    }
}
