//! `luxel diff`: what objects and parameters differ between two scenes.

use std::path::{Path, PathBuf};

use luxel_core::diag::{Diagnostic, Span};
use luxel_core::registry::Registry;
use luxel_core::scene::{Change, Difference, How, Node, Scene, diff_in};
use serde_json::{Value, json};

use crate::args::{LoadArgs, PluginArgs};
use crate::exit::{Exit, Failure};
use crate::libraries::Plugins;
use crate::load::{self, Course, Text};
use crate::report::{self, Form, Stream};

/// Tell which objects and parameters differ between two scenes
///
/// What two scenes come to is compared, not how they are written: names, order, comments, units and
/// defaults that are written out do not count, nor does what is in meshes and textures in files of their own: of these the paths are
/// compared, from the scene's folder on. Objects are taken for the same by what they are, then by label,
/// then by class. What is told is what `luxel watch` tells of a save.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Exit codes: 0 same, 1 different (or a scene is at fault), 2 usage.

Examples:
  luxel diff old.scene new.scene
  luxel diff old.scene new.scene --set steps=48
  luxel diff old.scene new.scene --json")]
pub(crate) struct Args {
    /// The scene
    a: PathBuf,
    /// What it became
    b: PathBuf,
    /// One JSON object on standard output
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    load: LoadArgs,
    #[command(flatten)]
    plugins: PluginArgs,
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let plugins = load::registry(&args.plugins)?;
    plugins.notes.tell(Form::Text, Stream::Error)?;
    let (a, b) = (read(&args.a, args, &plugins)?, read(&args.b, args, &plugins)?);
    let (Some((a, first)), Some((b, second))) = (a, b) else { return Ok(Exit::Input) };
    let folders = [&args.a, &args.b].map(|file| file.parent().unwrap_or(Path::new("")));
    let known = |node: &Node, name: &str| {
        let class = plugins.registry.class(node.kind, node.class)?;
        Registry::params(class).find(|param| param.name == name)
    };
    let (found, texts) = (diff_in([&first, &second], folders, &known), [a, b]);
    if args.json {
        let differences: Vec<_> = found.iter().map(|it| told(it, &texts)).collect();
        let all = json!({ "same": found.is_empty(), "differences": differences });
        report::out(&format!("{all}\n"))?;
    } else {
        let words: String = found.iter().map(|it| words(it, &texts)).collect();
        report::out(if found.is_empty() { "same\n" } else { &words })?;
    }
    Ok(if found.is_empty() { Exit::Fine } else { Exit::Input })
}

/// A scene with its texts; none if it has a mistake, which is told.
fn read(path: &Path, args: &Args, plugins: &Plugins) -> Result<Option<(Text, Scene)>, Failure> {
    let mut text = load::read(path, &args.load, None, plugins, &Course::default())?;
    let form = if args.json { Form::Json } else { Form::Text };
    report::diagnostics(&text.diagnostics, &text.sources, form, Stream::Error)?;
    let scene = text.scene.take().filter(|_| !text.diagnostics.iter().any(Diagnostic::is_error));
    Ok(scene.map(|scene| (text, scene)))
}

/// `sphere "ball"  a.scene:6 b.scene:7`, then `  radius: 1 m → 3 m`.
fn words(difference: &Difference, texts: &[Text; 2]) -> String {
    let how = match difference.how {
        How::Added => " added",
        How::Removed => " removed",
        How::Changed(_) => "",
    };
    let places = both(difference.spans, texts, place).into_iter().flatten();
    let (what, places) = (difference.counted(), places.collect::<Vec<_>>().join(" "));
    let mut out = format!("{what}{how}  {places}\n");
    for change in changes(difference) {
        let values = match values(change, texts) {
            [Some(a), Some(b)] if a != b => format!(": {a} → {b}"),
            [Some(a), None] => format!(": {a} → default"),
            [None, Some(b)] => format!(": default → {b}"),
            // What it is made of differs.
            _ => String::new(),
        };
        out.extend(["  ", &change.name, &values, "\n"]);
    }
    out
}

/// The same for programs.
fn told(difference: &Difference, texts: &[Text; 2]) -> Value {
    let how = match difference.how {
        How::Added => "added",
        How::Removed => "removed",
        How::Changed(_) => "changed",
    };
    let parameter = |change: &Change| {
        let [a, b] = values(change, texts);
        json!({ "name": change.name, "a": a, "b": b })
    };
    let [a, b] = both(difference.spans, texts, place);
    let parameters: Vec<_> = changes(difference).iter().map(parameter).collect();
    let Difference { what, n, .. } = difference;
    json!({ "what": what, "n": n, "how": how, "a": a, "b": b, "parameters": parameters })
}

/// The values of a parameter as their authors have them, or as what they come to.
fn values(change: &Change, texts: &[Text; 2]) -> [Option<String>; 2] {
    let written = both(change.spans, texts, written);
    let is_alike = written[0] == written[1] && change.values[0] != change.values[1];
    if is_alike && change.values.iter().all(Option::is_some) {
        change.values.clone()
    } else {
        written
    }
}

fn changes(difference: &Difference) -> &[Change] {
    match &difference.how {
        How::Changed(changes) => changes,
        How::Added | How::Removed => &[],
    }
}

/// What is to be said of a place in the first text and of one in the second.
fn both(
    spans: [Option<Span>; 2],
    texts: &[Text; 2],
    say: fn(Span, &Text) -> String,
) -> [Option<String>; 2] {
    [0, 1].map(|i| spans[i].map(|span| say(span, &texts[i])))
}

/// `a.scene:6`
fn place(span: Span, text: &Text) -> String {
    let line = text.sources.line_column(span.source, span.range().start).line;
    format!("{}:{line}", text.sources.name(span.source))
}

/// So many characters of a value are shown.
const MOST: usize = 60;

/// A value as its author has it, on one line.
fn written(span: Span, text: &Text) -> String {
    let value = text.sources.text(span.source).get(span.range()).unwrap_or_default();
    let line = value.split_whitespace().collect::<Vec<_>>().join(" ");
    if line.chars().count() <= MOST {
        return line;
    }
    line.chars().take(MOST - 1).chain(['…']).collect()
}
