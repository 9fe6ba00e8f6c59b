//! `luxel docs`: the reference of the language and of every plugin as a folder of web pages.

mod functions;
mod link;
mod manual;
mod markdown;
mod page;
mod scene;
mod stand_in;
mod thumb;

use std::io::Write;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use luxel_core::render::Options;
use serde_json::json;

use self::page::{File, Page};
use self::thumb::Shown;
use crate::args::{self, PluginArgs};
use crate::exit::{Exit, Failure};
use crate::load;
use crate::output::{Draft, unwritable};
use crate::progress::Steps;
use crate::report::{self, Form, Stream};
use crate::verify::Run;
use crate::words::WORDS;

/// Write the reference of the language and of every plugin as web pages
///
/// A folder that needs no server and nothing from elsewhere: open index.html. A page for each class of
/// the registry, of libraries too, with its manual, its parameters and a picture of the scene that its
/// manual shows; the language; every function; every message. All of it is searched by typing, and its links are
/// checked (exit code 1 if one leads nowhere).
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel docs
  luxel docs -o reference --plugin-dir target/release
  luxel docs --no-pictures --json")]
pub(crate) struct Args {
    /// The folder to write
    #[arg(short, long, value_name = "FOLDER", default_value = "luxel-docs")]
    output: PathBuf,
    /// Leave the pictures out
    #[arg(long)]
    no_pictures: bool,
    /// Threads [default: as many as there are cores]
    #[arg(long, value_name = "N", value_parser = args::threads)]
    threads: Option<NonZeroUsize>,
    /// What was written, as one JSON object on standard output
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    plugins: PluginArgs,
}

/// Documents that have a page of their own.
const DOCUMENTS: [(&str, &str); 3] = [
    ("tutorial", include_str!("../../../docs/tutorial.md")),
    ("language", include_str!("../../../docs/language.md")),
    ("plugins", include_str!("../../../docs/plugins.md")),
];

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let plugins = load::registry(&args.plugins)?;
    let form = if args.json { Form::Json } else { Form::Text };
    plugins.notes.tell(form, Stream::Error)?;
    let options = Options { threads: args.threads, ..Options::default() };
    let run = Run::new(plugins, options)?.silent();
    let pictures = if args.no_pictures { vec![] } else { pictures(&run)? };
    let is_drawn = |shown: &Shown<'_>| pictures.iter().any(|file| file.name == shown.file());
    let mut pages: Vec<Page> = DOCUMENTS.map(|(name, text)| page::document(name, text)).into();
    pages.extend([functions::page(), manual::messages()]);
    pages.extend(run.plugins.registry.all().map(|entry| {
        manual::class(entry, &Shown::of_class(entry).filter(is_drawn).collect::<Vec<_>>())
    }));
    pages.extend(WORDS.iter().map(|word| {
        let drawn = Some(Shown::of_word(word)).filter(is_drawn);
        manual::word(word, drawn.as_ref())
    }));
    let n_pictures = pictures.len();
    let mut files = page::site(&pages);
    let broken = link::broken(&files, &pictures);
    files.extend(pictures);
    for file in &files {
        write(&args.output, file)?;
    }
    tell(args, (pages.len() + 1, n_pictures), &broken)?;
    Ok(if broken.is_empty() { Exit::Fine } else { Exit::Input })
}

/// Pictures of all that manuals show, where they can be drawn.
fn pictures(run: &Run) -> Result<Vec<File>, Failure> {
    let of_classes = run.plugins.registry.all().flat_map(Shown::of_class);
    let all: Vec<_> = of_classes.chain(WORDS.iter().map(Shown::of_word)).collect();
    let steps = Steps::new();
    let mut drawn = vec![];
    for (done, shown) in all.iter().enumerate() {
        steps.next(done, all.len(), &shown.of);
        let bytes = thumb::png(shown, run)?;
        drawn.extend(bytes.map(|bytes| File { name: shown.file(), bytes }));
    }
    Ok(drawn)
}

fn write(folder: &Path, file: &File) -> Result<(), Failure> {
    let path = folder.join(&file.name);
    let written = std::fs::create_dir_all(folder).and_then(|()| {
        let mut draft = Draft::begin(&path)?;
        draft.file.write_all(&file.bytes)?;
        draft.finish()
    });
    written.map_err(|error| unwritable(&path, &error))
}

fn tell(args: &Args, (pages, pictures): (usize, usize), broken: &[String]) -> Result<(), Failure> {
    let index = args.output.join("index.html");
    for link in broken {
        report::warning(link);
    }
    report::out(&if args.json {
        let told =
            json!({ "index": index, "pages": pages, "pictures": pictures, "broken": broken });
        format!("{told}\n")
    } else {
        format!("{}: {pages} pages, {pictures} pictures\n", index.display())
    })
}
