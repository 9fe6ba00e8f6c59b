//! `luxel plugin list`: every plugin library that there is.

use std::fmt::Write;

use luxel_sdk::abi::Class;
use serde_json::{Value, json};

use crate::args::PluginArgs;
use crate::exit::{Exit, Failure};
use crate::libraries::{Found, State};
use crate::report::{Form, Stream};
use crate::{load, report};

/// List the plugin libraries that are found, and what came of each
///
/// Libraries are looked for in the folders of --plugin-dir, of `LUXEL_PLUGIN_PATH` and of `plugin_dirs`
/// in config.toml, and opened only if plugins.lock lists their SHA-256. Those that are trusted but
/// not found are listed too. Both files are in your configuration folder: see luxel plugin trust --help.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Exit codes: 0 fine, 1 a trusted library cannot be used.

Examples:
  luxel plugin list
  luxel plugin list --plugin-dir target/release --json")]
pub(super) struct Args {
    /// A JSON array
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    plugins: PluginArgs,
}

pub(super) fn run(args: &Args) -> Result<Exit, Failure> {
    let plugins = load::registry(&args.plugins)?;
    let form = if args.json { Form::Json } else { Form::Text };
    plugins.notes.tell(form, Stream::Error)?;
    let libraries = &plugins.libraries;
    if args.json {
        let all: Value = libraries.iter().map(object).collect();
        report::out(&format!("{all}\n"))?;
    } else if libraries.is_empty() {
        report::note("no plugin library was found: see luxel plugin list --help");
    } else {
        report::out(&libraries.iter().map(text).collect::<String>())?;
    }
    let refused = libraries.iter().any(|found| matches!(found.state, State::Refused(_)));
    Ok(if refused { Exit::Input } else { Exit::Fine })
}

fn text(found: &Found) -> String {
    let (state, why) = found.state.words();
    let mut text = format!("{:<20} {state}", found.stem);
    if !why.is_empty() {
        text.extend([": ", why]);
    }
    if let State::Loaded(opened) = &found.state {
        let (name, version, abi) = (&opened.name, &opened.version, &opened.abi);
        let generation = opened.generation;
        let _ = write!(text, ": {name} {version}, ABI {abi}, generation {generation}\n    ");
        text.push_str(&opened.classes.iter().map(words).collect::<Vec<_>>().join(", "));
    }
    format!("{text}\n    {}\n", found.path.display())
}

/// As a scene writes it: `material velvet`.
fn words(class: &Class) -> String {
    format!("{} {}", class.kind.word(), class.name)
}

fn object(found: &Found) -> Value {
    let (state, why) = found.state.words();
    let opened = match &found.state {
        State::Loaded(opened) => Some(opened),
        _ => None,
    };
    let class = |class: &Class| json!({ "kind": class.kind.word(), "name": class.name });
    json!({
        "stem": found.stem,
        "path": found.path.to_string_lossy(),
        "state": state,
        "why": why,
        "name": opened.map(|opened| &opened.name),
        "version": opened.map(|opened| &opened.version),
        "abi": opened.map(|opened| &opened.abi),
        "generation": opened.map(|opened| opened.generation),
        "classes": opened.map(|opened| opened.classes.iter().map(class).collect::<Value>()),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::libraries::Opened;

    #[test]
    fn a_library_is_told_with_its_state_and_as_json() {
        let refused = Found {
            stem: "velvet".into(),
            path: "/p/libvelvet.so".into(),
            state: State::Refused("no table".into()),
        };
        assert_eq!(text(&refused), "velvet               refused: no table\n    /p/libvelvet.so\n");
        assert_eq!(
            (&object(&refused)["why"], &object(&refused)["name"]),
            (&json!("no table"), &Value::Null)
        );
        let [name, version, abi] = ["Velvet", "1.0.0", "1.2"].map(str::to_owned);
        let classes = luxel_builtin::CLASSES[0][..1].to_vec();
        let opened = Opened { name, version, abi, generation: 3, classes };
        let loaded = Found { state: State::Loaded(opened), ..refused };
        let told = text(&loaded);
        assert!(told.contains("loaded: Velvet 1.0.0, ABI 1.2, generation 3\n    shape "), "{told}");
        assert_eq!(object(&loaded)["classes"][0]["kind"], "shape");
    }
}
