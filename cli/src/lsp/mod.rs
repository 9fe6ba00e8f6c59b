//! `luxel lsp`: what the language knows, for editors, by the Language Server Protocol 3.17 over
//! standard input and output.
//!
//! Three threads: one reads messages and cancels requests that wait, one answers, one evaluates.
//! Outlines, which may be long, are put into words in threads of their own.

mod actions;
mod answer;
mod convert;
mod files;
mod format;
mod judge;
mod lists;
mod names;
mod outline;
mod publish;
mod queue;
mod server;
mod session;
mod shape;
mod wire;

use std::io::BufReader;
use std::path::PathBuf;
use std::sync::Arc;

use luxel_lang::Budgets;

use crate::args::{BudgetArgs, PluginArgs};
use crate::exit::{Exit, Failure};
use crate::load;
use crate::report::{Form, Stream};

use self::queue::Queue;

/// Serve editors: mistakes as you type, completion, manual, definitions, renaming
///
/// Speaks the Language Server Protocol over standard input and output; an editor starts it. Exit
/// code 0 after an orderly shutdown, 1 without one.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel lsp
  luxel lsp --allow-path ../assets
  luxel lsp --budget nodes=3e6,steps=1e9")]
pub(crate) struct Args {
    /// Let scenes read files below this folder too (their own folder is always allowed)
    #[arg(long, value_name = "DIR")]
    allow_path: Vec<PathBuf>,
    /// Nothing: it is spoken over standard input and output anyway
    #[arg(long, hide = true)]
    stdio: bool,
    #[command(flatten)]
    plugins: PluginArgs,
    #[command(flatten)]
    budgets: BudgetArgs,
}

/// What scenes may read and cost.
#[derive(Clone, Debug)]
struct Limits {
    /// Folders that scenes may read from beside their own.
    allow: Vec<PathBuf>,
    budgets: Budgets,
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let plugins = load::registry(&args.plugins)?;
    plugins.notes.tell(Form::Text, Stream::Error)?;
    let queue = Arc::new(Queue::default());
    let reading = queue.clone();
    let reader = std::thread::Builder::new().name("reader".to_owned());
    let ours = |error| Failure::new(Exit::Ours, format!("no thread can be had: {error}"));
    reader.spawn(move || wire::read(BufReader::new(std::io::stdin()), &reading)).map_err(ours)?;
    let limits = Limits { allow: args.allow_path.clone(), budgets: args.budgets.budgets() };
    let mut session = session::Session::new(queue, Arc::new(plugins), limits);
    session.run()
}
