//! `luxel watch`: render again whenever a file that the scene reads is saved.

mod after;
mod apart;
mod attempt;
mod audience;
mod begin;
mod camera;
mod changes;
mod edit;
mod facts;
mod here;
mod mailbox;
mod page;
mod params;
mod press;
mod reading;
mod round;
mod shown;
mod tev;
mod wishes;

use std::ffi::OsString;
use std::path::PathBuf;

use crate::args::{LoadArgs, PluginArgs, RenderArgs};
use crate::exit::{Exit, Failure};
use crate::isolate::IsolateArgs;
use crate::preview::{EditorArgs, PageArgs};
use crate::report::Form;

pub(crate) use self::tev::with_address;

/// Render a scene again whenever it, or a file that it reads, is saved
///
/// A save during a render ends that render. A save that changes no byte does nothing. After a
/// mistake the last good picture stays. Ctrl-C ends with code 0.
#[derive(clap::Args, Debug)]
#[command(mut_args(|arg| if is_of_page(&arg) { arg.requires("preview") } else { arg }))]
#[command(after_help = "\
Examples:
  luxel watch scenes/cornell.scene
  luxel watch scenes/cornell.scene --preview
  luxel watch scenes/cornell.scene --tev 127.0.0.1:14158
  luxel watch scenes/cornell.scene --exec 'cp $LUXEL_PNG last.png'
  luxel watch scenes/cornell.scene --preview --editor 'vscode://file/{file}:{line}:{column}'
  luxel watch scenes/cornell.scene -o small --size 320x320 --spp 16
  luxel watch scenes/cornell.scene --plugin-dir target/release --isolate --preview")]
pub(crate) struct Args {
    /// The scene
    file: PathBuf,
    #[command(flatten)]
    render: RenderArgs,
    #[command(flatten)]
    load: LoadArgs,
    #[command(flatten)]
    plugins: PluginArgs,
    #[command(flatten)]
    isolate: IsolateArgs,
    /// Serve a page that shows the picture as it grows, and print its address
    #[arg(long)]
    preview: bool,
    #[command(flatten)]
    page: PageArgs,
    #[command(flatten)]
    editor: EditorArgs,
    #[command(flatten)]
    then: ThenArgs,
    /// Say nothing but errors
    #[arg(short, long, conflicts_with = "json")]
    quiet: bool,
    /// Of each picture the summary as one JSON object on a line of standard output, diagnostics and
    /// failures as JSON lines on standard error
    #[arg(long)]
    json: bool,
}

/// Whether a flag says something of the page, which there is only if it is asked for.
fn is_of_page(arg: &clap::Arg) -> bool {
    <PageArgs as clap::Args>::augment_args(clap::Command::new("page"))
        .get_arguments()
        .any(|it| it.get_id() == arg.get_id())
}

/// What is done with pictures beside writing them.
#[derive(clap::Args, Debug)]
struct ThenArgs {
    /// Run this command of the shell after each finished picture, with `LUXEL_SCENE`,
    /// `LUXEL_EXR` and `LUXEL_PNG` in its environment
    #[arg(long, value_name = "COMMAND")]
    exec: Option<OsString>,
    /// Show every picture in tev too, which listens at this address: 127.0.0.1:14158 unless HOST:PORT
    /// follows
    #[arg(
        long,
        value_name = "HOST:PORT",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = tev::ADDRESS
    )]
    tev: Option<String>,
    /// Wait until there is a scene without mistakes and nothing is saved any more, and end with its
    /// picture
    #[arg(long)]
    once_stable: bool,
}

impl Args {
    fn form(&self) -> Form {
        if self.json { Form::Json } else { Form::Text }
    }
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    match args.isolate.beat() {
        None => apart::watch(args),
        Some(beat) => {
            let _end = beat.until_the_end();
            here::watch(args, &beat)
        }
    }
}
