//! How a picture came about, in the words of its scene and of the command line. It names no folder of
//! the machine.

use std::collections::BTreeMap;

use luxel_core::diag::Sources;
use luxel_core::registry::Registry;
use luxel_core::scene::{Argument, Node, Scene, Setting, Value};
use serde_json::{Value as Json, json};

use crate::written::{self, quoted};

/// Characters of a value or of a setting that are kept: what is longer, nobody reads.
const MOST: usize = 1000;

/// What decides how a picture is measured, beside what `stage::Film` and `render::Options` say.
const SETTINGS: [Setting; 3] = [Setting::Integrator, Setting::Sampler, Setting::Filter];

/// What was set, which settings the scene gives, and which libraries it takes classes from.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Origin {
    /// Values of `param`s that the scene's own gave way to, by name.
    set: BTreeMap<String, String>,
    /// As the scene could say them: `path { max_depth = 8 }`.
    settings: BTreeMap<&'static str, String>,
    /// Versions of libraries, by name.
    plugins: BTreeMap<String, String>,
}

impl Origin {
    /// Of a scene with its assets, into which `set` went.
    pub(crate) fn of(
        set: &[(String, String)],
        scene: &Scene,
        registry: &Registry,
        sources: &Sources,
    ) -> Self {
        // Of what is set twice, the last counts.
        let set = set.iter().map(|(name, value)| (name.clone(), short(&nameless(value.trim()))));
        let told = |setting: Setting| {
            let text = match scene.setting(setting) {
                Some(node) => as_written(node, registry, sources),
                None => format!("{} {{}}", setting.default_class()),
            };
            (setting.kind().word(), short(&text))
        };
        Self {
            set: set.collect(),
            settings: SETTINGS.map(told).into(),
            plugins: libraries(scene, registry),
        }
    }

    /// Says it among the rest.
    pub(crate) fn say(&self, all: &mut Json) {
        all["set"] = json!(self.set);
        all["settings"] = json!(self.settings);
        all["plugins"] = json!(self.plugins);
    }
}

/// Those that the scene takes classes from. What else is loaded changes no bit, so the picture does not
/// tell of it.
fn libraries(scene: &Scene, registry: &Registry) -> BTreeMap<String, String> {
    let versions: BTreeMap<&str, &str> = registry.libraries().collect();
    let of = |node: &Node| {
        let origin = &*registry.entry(node.kind, node.class)?.origin;
        versions.get(origin).map(|version| (origin.to_owned(), (*version).to_owned()))
    };
    scene.nodes.iter().filter_map(of).collect()
}

fn as_written(node: &Node, registry: &Registry, sources: &Sources) -> String {
    let value = |argument: &Argument| match &argument.value {
        Value::Path(path) => quoted(last(&path.to_string_lossy())),
        _ => nameless(&written::value(argument, node, registry, sources)),
    };
    written::node(node, value)
}

/// The same without the folders of a path of the machine, which it may be or hold between quotes.
fn nameless(text: &str) -> String {
    if is_place(text) {
        return last(text).to_owned();
    }
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, behind)) = rest.split_once('"') {
        let end = end_of_quote(behind);
        let (inside, after) = behind.split_at(end);
        out.extend([before, "\"", if is_place(inside) { last(inside) } else { inside }]);
        rest = after.strip_prefix('"').inspect(|_| out.push('"')).unwrap_or(after);
    }
    out + rest
}

/// Where a text ends that has begun: before a mark that no backslash stands before.
fn end_of_quote(text: &str) -> usize {
    let mut escaped = false;
    let is_end = |c: char| {
        let is_end = c == '"' && !escaped;
        escaped = c == '\\' && !escaped;
        is_end
    };
    text.find(is_end).unwrap_or(text.len())
}

/// Whether a text begins at a root, of any system, or goes up from where it stands.
fn is_place(text: &str) -> bool {
    let mut chars = text.chars();
    let has_drive = chars.next().is_some_and(|c| c.is_ascii_alphabetic())
        && chars.next() == Some(':')
        && matches!(chars.next(), Some('/' | '\\'));
    has_drive
        || text.starts_with(['/', '\\'])
        || text.starts_with("../")
        || text.starts_with("..\\")
}

/// The last part of a path.
fn last(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or_default()
}

fn short(text: &str) -> String {
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use luxel_core::files::MemoryFiles;

    use super::*;
    use crate::libraries::builtins;

    fn origin(text: &str, set: &[(&str, &str)]) -> Origin {
        let files = MemoryFiles::default().with("a.scene", text.as_bytes());
        let set: Vec<_> = set.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
        let settings = luxel_lang::Settings { set: set.clone(), ..Default::default() };
        let registry = builtins();
        let read = luxel_lang::load(Path::new("a.scene"), &files, &registry, &settings);
        let scene = read.scene.unwrap_or_else(|| panic!("{:?}", read.diagnostics));
        Origin::of(&set, &scene, &registry, &read.sources)
    }

    /// Without what is said of the picture alone.
    const REST: &str = "scene 1\nlight constant { scale = 1 }\nfilm rgb {}\n\
        camera perspective { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)), \
        fov = 40 deg }\n";

    #[test]
    fn settings_are_told_with_their_values_and_what_was_set_by_its_last_value() {
        let scene = format!(
            "{REST}param n: int = 3\nparam name: string = \"oak\"\n\
             integrator path {{ max_depth = 2 * n }}\nfilter gaussian {{ sigma = 0.75 }}\n"
        );
        let set = [("n", "9"), ("name", "pine"), ("n", " 2 + 2 ")];
        let Origin { set, settings, plugins } = origin(&scene, &set);
        assert_eq!((set["n"].as_str(), set["name"].as_str(), set.len()), ("2 + 2", "pine", 2));
        assert_eq!(settings["integrator"], "path { max_depth = 8 }");
        assert_eq!(settings["filter"], "gaussian { sigma = 0.75 }");
        assert_eq!(settings["sampler"], "sobol {}");
        assert!(plugins.is_empty());
    }

    #[test]
    fn the_folders_of_a_path_are_left_out_and_nothing_else() {
        for (text, told) in [
            ("/home/me/oak.png", "oak.png"),
            ("C:\\me\\oak.png", "oak.png"),
            ("c:/me/oak.png", "oak.png"),
            ("\"/home/me/my oak.png\"", "\"my oak.png\""),
            ("../../me/oak.png", "oak.png"),
            ("oak.png", "oak.png"),
            ("wood/oak.png", "wood/oak.png"),
            (
                "[\"/a/b.png\", \"c \\\"/d\\\" e\", \"/f/g\"]",
                "[\"b.png\", \"c \\\"/d\\\" e\", \"g\"]",
            ),
            ("3 / (1 m)", "3 / (1 m)"),
            ("a \"left /open", "a \"left /open"),
            ("", ""),
        ] {
            assert_eq!(nameless(text), told, "{text}");
        }
    }

    #[test]
    fn what_is_too_long_to_read_is_cut() {
        assert_eq!(short(&"é".repeat(MOST)), "é".repeat(MOST));
        assert_eq!(short(&"é".repeat(MOST + 1)), "é".repeat(MOST) + "…");
    }
}
