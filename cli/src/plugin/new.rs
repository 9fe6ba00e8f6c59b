//! `luxel plugin new`: a small crate to begin with.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use luxel_sdk::kind::Kind;

use super::template::{self, MANIFEST, README, Template};
use crate::exit::{Exit, Failure};
use crate::libraries::builtins;
use crate::output::unwritable;
use crate::{list, report};

/// Begin a plugin: a small crate that builds, with a scene that uses it
///
/// Writes NAME/Cargo.toml, NAME/src/lib.rs, NAME/NAME.scene and NAME/README.md: a plugin of that kind
/// that does something simple and keeps what its kind promises. Nothing is overwritten.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel plugin new material velvet
  luxel plugin new integrator photons --whole-picture
  luxel plugin new shape gyroid --dir ~/plugins/gyroid")]
pub(super) struct Args {
    /// Its kind, as `luxel list` shows it
    kind: String,
    /// Its name in scenes: a to z, 0 to 9 and _
    name: String,
    /// The folder of the crate [default: NAME]
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
    /// An integrator that makes the whole picture, not one path of it: for photons and the like
    #[arg(long)]
    whole_picture: bool,
}

pub(super) fn run(args: &Args) -> Result<Exit, Failure> {
    let sdk = sdk();
    let folder = begin(args, sdk.as_deref())?;
    report::out(&format!("wrote {}: its README.md says how to go on\n", folder.display()))?;
    if sdk.is_none() {
        report::warning(
            "this luxel does not know its source: give the path of luxel-sdk in Cargo.toml",
        );
    }
    Ok(Exit::Fine)
}

/// Writes the crate and gives its folder.
fn begin(args: &Args, sdk: Option<&Path>) -> Result<PathBuf, Failure> {
    let name = args.name.as_str();
    let usage = |message: String| Failure::new(Exit::Usage, message);
    // A class of this kind is an importer to the SDK and an asset to scenes.
    let word = if args.kind == "importer" { "asset" } else { &args.kind };
    let kind = list::kind(word).map_err(|failure| Failure { exit: Exit::Usage, ..failure })?;
    let Some(mut template) = template::of(kind) else {
        return Err(usage(format!("a {kind} is Luxel's own: no plugin can be one")));
    };
    if args.whole_picture {
        if kind != Kind::Integrator {
            let message = format!("no {kind} makes pictures: --whole-picture is for integrators");
            return Err(usage(message));
        }
        template = template::of_picture();
    }
    if let Some(why) = template::fault(name) {
        return Err(usage(format!("`{name}` cannot be the name of a plugin: {why}")));
    }
    if let Some(entry) = builtins().entry(kind, name) {
        let message = format!("there is a {kind} `{name}` already ({})", entry.origin);
        return Err(usage(message).help("another name, so that scenes can tell them apart"));
    }
    let folder = args.dir.clone().unwrap_or_else(|| name.into());
    let files = files(kind, name, &template, sdk);
    if let Some((file, _)) = files.iter().find(|(file, _)| folder.join(file).exists()) {
        let message = format!("`{}` is there already", folder.join(file).display());
        return Err(Failure::new(Exit::Input, message).help("another folder: --dir DIR"));
    }
    for (file, text) in &files {
        write_new(&folder.join(file), text)?;
    }
    Ok(folder)
}

/// The SDK that this program was built with, if its source is still there.
fn sdk() -> Option<PathBuf> {
    let place = Path::new(env!("CARGO_MANIFEST_DIR")).join("../plugins/sdk");
    fs::canonicalize(place).ok().filter(|sdk| sdk.join("Cargo.toml").is_file())
}

/// Each file of the crate with its text.
fn files(kind: Kind, name: &str, template: &Template, sdk: Option<&Path>) -> Vec<(String, String)> {
    let type_name = template::type_name(name, template.source);
    let word = kind.word();
    let article = if word.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    let file = format!("{}{name}{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let sdk = sdk.map_or("path/to/luxel/plugins/sdk".into(), Path::to_string_lossy);
    let sdk = toml::Value::String(sdk.into_owned()).to_string();
    let filled = |text: &str| {
        text.replace("template_name", name)
            .replace("TemplateName", &type_name)
            .replace("template_kind", word)
            .replace("template_article", article)
            .replace("template_file", &file)
            .replace("template_sdk", &sdk)
    };
    let mut files = vec![
        ("Cargo.toml".to_owned(), filled(MANIFEST)),
        ("src/lib.rs".to_owned(), filled(template.source)),
        (format!("{name}.scene"), filled(template.scene)),
        ("README.md".to_owned(), filled(README)),
    ];
    files.extend(template.data.map(|data| (format!("{name}.txt"), data.to_owned())));
    files
}

fn write_new(path: &Path, text: &str) -> Result<(), Failure> {
    let written = || {
        fs::create_dir_all(path.parent().unwrap_or(Path::new(".")))?;
        let mut file = fs::OpenOptions::new().write(true).create_new(true).open(path)?;
        file.write_all(text.as_bytes())
    };
    written().map_err(|error| unwritable(path, &error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::args::{LoadArgs, PluginArgs};
    use crate::libraries::{Session, Surroundings};
    use crate::load;
    use crate::testing::Folder;

    fn args(kind: &str, name: &str, dir: PathBuf) -> Args {
        Args { kind: kind.into(), name: name.into(), dir: Some(dir), whole_picture: false }
    }

    #[test]
    fn a_crate_is_written_once_and_has_no_placeholder_left() {
        let folder = Folder::new("new");
        let (args_of_none, nowhere) = (PluginArgs::default(), Surroundings::default());
        let plugins = Session::new().refresh(&args_of_none, &nowhere).unwrap();
        let kinds = Kind::ALL.iter().filter(|(kind, _)| *kind != Kind::Film);
        let all = kinds.map(|(_, word)| (*word, false)).chain([("integrator", true)]);
        for (word, whole_picture) in all {
            let dir = folder.path(&format!("{word}-{whole_picture}"));
            let wanted = || Args { whole_picture, ..args(word, "my_own", dir.clone()) };
            assert_eq!(begin(&wanted(), None).unwrap(), dir);
            let again = begin(&wanted(), None).unwrap_err();
            assert!(again.exit == Exit::Input && again.message.contains("Cargo.toml"));
            for file in ["Cargo.toml", "src/lib.rs", "my_own.scene", "README.md"] {
                let bytes = crate::files::read_regular(&dir.join(file)).unwrap();
                let text = String::from_utf8(bytes).unwrap();
                assert!(!text.to_lowercase().contains("template"), "{word} {file}:\n{text}");
                assert!(text.contains("my_own"), "{word} {file}");
            }
            // Nothing but its own class is missing.
            let scene = dir.join("my_own.scene");
            let loaded =
                load::load(&scene, &LoadArgs::default(), None, &plugins, &load::Course::default());
            let told = loaded.unwrap().diagnostics;
            let one = matches!(&told[..], [only] if only.message.contains("`my_own`"));
            assert!(one, "{word}: {told:?}");
        }
    }

    #[test]
    fn a_name_that_is_taken_and_a_kind_that_is_not_open_are_refused() {
        let folder = Folder::new("new-refused");
        for (kind, name, told) in [
            ("material", "diffuse", "already"),
            ("film", "mine", "Luxel's own"),
            ("materail", "mine", "no kind"),
            ("shape", "Mine", "a to z"),
            ("shape", "loop", "Rust"),
        ] {
            let failure = begin(&args(kind, name, folder.path("x")), None).unwrap_err();
            assert!(failure.exit == Exit::Usage && failure.message.contains(told), "{failure:?}");
        }
        let paths = Args { whole_picture: true, ..args("material", "mine", folder.path("x")) };
        let failure = begin(&paths, None).unwrap_err();
        let told = failure.message.contains("--whole-picture is for integrators");
        assert!(failure.exit == Exit::Usage && told, "{failure:?}");
        assert!(folder.names().is_empty());
    }

    #[test]
    fn this_source_tree_has_the_sdk_and_its_path_is_quoted() {
        let template = template::of(Kind::Filter).unwrap();
        let sdk = Path::new("C:\\a \"b\"\\sdk");
        let files = files(Kind::Filter, "mine", &template, Some(sdk));
        let manifest: toml::Table = files[0].1.parse().unwrap();
        assert_eq!(manifest["dependencies"]["luxel-sdk"]["path"].as_str(), sdk.to_str());
        // Vectors of another version of glam would be other types.
        let own = crate::files::read_regular(&super::sdk().unwrap().join("Cargo.toml")).unwrap();
        let own: toml::Table = String::from_utf8(own).unwrap().parse().unwrap();
        assert_eq!(manifest["dependencies"]["glam"], own["dependencies"]["glam"]);
    }
}
