//! `luxel list`: what a scene may name.

use luxel_core::diag::nearest;
use luxel_sdk::kind::Kind;
use serde_json::json;

use crate::args::PluginArgs;
use crate::exit::{Exit, Failure};
use crate::report::{Form, Stream};
use crate::words::{self, WORDS, Word};
use crate::{load, report};

/// List the plugins that a scene may name
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel list
  luxel list material
  luxel list --json")]
pub(crate) struct Args {
    /// Only this kind: shape, material, texture, light, medium, phase, camera, sampler, filter,
    /// integrator, asset, film; group, place
    kind: Option<String>,
    /// A JSON array
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    plugins: PluginArgs,
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let word = args.kind.as_deref().and_then(words::find);
    let only = args.kind.as_deref().filter(|_| word.is_none()).map(kind).transpose()?;
    let told: &[Word] = match word {
        Some(word) => std::slice::from_ref(word),
        None if only.is_none() => &WORDS,
        None => &[],
    };
    let plugins = load::registry(&args.plugins)?;
    plugins.notes.tell(Form::Text, Stream::Error)?;
    let entries = plugins
        .registry
        .all()
        .filter(|entry| word.is_none() && only.is_none_or(|kind| entry.class.kind == kind));
    if args.json {
        let all = entries.map(|entry| {
            let class = &entry.class;
            json!({
                "kind": class.kind.word(),
                "name": class.name,
                "origin": entry.origin,
                "summary": summary(class.doc),
            })
        });
        let words = told.iter().map(|word| {
            json!({
                "kind": word.name,
                "name": "",
                "origin": "language",
                "summary": summary(word.doc),
            })
        });
        report::out(&format!("{}\n", all.chain(words).collect::<serde_json::Value>()))?;
    } else {
        for entry in entries {
            let class = &entry.class;
            let (kind, summary) = (class.kind.word(), summary(class.doc));
            let origin = match entry.origin.as_str() {
                "builtin" | "host" => String::new(),
                library => format!(" ({library})"),
            };
            report::out(&format!("{kind:<11}{:<20} {summary}{origin}\n", class.name))?;
        }
        for word in told {
            report::out(&format!("{:<11}{:<20} {}\n", word.name, "", summary(word.doc)))?;
        }
    }
    Ok(Exit::Fine)
}

/// The kind of a word.
///
/// # Errors
/// An unknown word, with the nearest and the known ones.
pub(crate) fn kind(word: &str) -> Result<Kind, Failure> {
    Kind::of_word(word).ok_or_else(|| unknown("kind", word, &kinds()))
}

/// The words of all kinds, and those of the language that are used as one.
pub(crate) fn kinds() -> Vec<&'static str> {
    let own = WORDS.iter().map(|word| word.name);
    Kind::ALL.iter().map(|(_, word)| *word).chain(own).collect()
}

/// The failure of a name that nobody knows.
pub(crate) fn unknown(what: &str, found: &str, known: &[&str]) -> Failure {
    let help = match nearest(found, known.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("known: {}", known.join(", ")),
    };
    Failure::new(Exit::Input, format!("there is no {what} `{found}`")).help(help)
}

/// The first sentence of a manual page, on one line.
pub(crate) fn summary(doc: &str) -> String {
    let paragraph = doc.trim().split("\n\n").next().unwrap_or_default();
    let line = paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    match line.find(". ") {
        Some(end) => line[..=end].to_owned(),
        None => line,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_kinds_name_the_nearest_or_all() {
        let help = |word| kind(word).unwrap_err().help.unwrap();
        assert_eq!(help("materail"), "did you mean `material`?");
        assert!(help("xyzzy-plugh").contains("shape, material"));
        assert_eq!(kind("asset").unwrap(), Kind::Importer);
    }

    #[test]
    fn a_summary_is_one_sentence_on_one_line() {
        assert_eq!(summary(" A sphere:\n round. And more.\n\n Much."), "A sphere: round.");
    }
}
