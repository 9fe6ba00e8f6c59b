//! `luxel docs`: the reference of the language and of every plugin as a folder of web pages.

mod functions;
mod link;
mod manual;
mod markdown;
mod page;
mod scene;
mod thumb;

use std::io::Write;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use luxel_core::registry::Entry;
use luxel_core::render::Options;
use serde_json::json;

use self::page::{File, Page};
use crate::args::{self, PluginArgs};
use crate::exit::{Exit, Failure};
use crate::output::{Draft, unwritable};
use crate::progress::Steps;
use crate::report::{self, Form, Stream};
use crate::verify::Run;
use crate::{load, words};

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
    let has_picture = |file: &str| pictures.iter().any(|picture| picture.name == file);
    let entries = run.plugins.registry.all();
    let mut pages: Vec<Page> = DOCUMENTS.map(|(name, text)| page::document(name, text)).into();
    pages.extend([functions::page(), manual::messages()]);
    pages.extend(entries.map(|entry| manual::class(entry, has_picture(&picture_of(entry)))));
    pages.extend(words::WORDS.iter().map(manual::word));
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

/// A picture of what each manual shows, where it can be drawn without files.
fn pictures(run: &Run) -> Result<Vec<File>, Failure> {
    let entries: Vec<&Entry> = run.plugins.registry.all().collect();
    let steps = Steps::new();
    let mut drawn = vec![];
    for (done, entry) in entries.iter().enumerate() {
        steps.next(done, entries.len(), &format!("{} {}", entry.class.kind, entry.class.name));
        let bytes = thumb::png(entry, run)?;
        drawn.extend(bytes.map(|bytes| File { name: picture_of(entry), bytes }));
    }
    Ok(drawn)
}

/// The picture's place in the folder.
fn picture_of(entry: &Entry) -> String {
    format!("{}-{}.png", entry.class.kind, entry.class.name)
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
