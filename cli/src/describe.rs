//! `luxel describe`: the manual page of one plugin, word or function.

use luxel_core::registry::{Entry, Registry, common_params};
use luxel_lang::manual::{Function, default, facts, function, functions, what};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::Param;
use serde_json::{Value, json};

use crate::args::PluginArgs;
use crate::exit::{Exit, Failure};
use crate::list::{kinds, unknown};
use crate::report::{Form, Stream};
use crate::{load, report, words};

/// Show the manual page of a plugin: what it is, and each parameter; or of a function
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel describe shape sphere
  luxel describe group
  luxel describe look_at
  luxel describe material diffuse --json")]
pub(crate) struct Args {
    /// Its kind, as `luxel list` shows it; or a function that every scene has
    kind: String,
    /// Its name; none for the language's own words, such as `group`, and for functions
    name: Option<String>,
    /// A JSON object
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    plugins: PluginArgs,
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let plugins = load::registry(&args.plugins)?;
    plugins.notes.tell(Form::Text, Stream::Error)?;
    let page = match (of_language(&args.kind), &args.name) {
        (Some((_, object)), None) if args.json => format!("{object}\n"),
        (Some((page, _)), None) => page,
        (Some(_), Some(name)) => {
            let message = format!("`{}` has no kinds: there is no `{name}`", args.kind);
            let help = format!("luxel describe {}", args.kind);
            return Err(Failure::new(Exit::Input, message).help(help));
        }
        (None, name) => {
            let entry = entry(&plugins.registry, kind(&args.kind)?, name.as_deref())?;
            if args.json { format!("{}\n", object(entry)) } else { text(entry) }
        }
    };
    report::out(&page)?;
    Ok(Exit::Fine)
}

/// The manual page of what belongs to the language, as text and for programs.
fn of_language(name: &str) -> Option<(String, Value)> {
    let word = words::find(name).map(|word| (words::page(word), words::object(word)));
    word.or_else(|| function(name).map(|it| (page_of(&it), object_of(&it))))
}

fn page_of(function: &Function) -> String {
    let Function { usage, subject, doc, example, .. } = function;
    let subject = subject.to_lowercase();
    format!("{usage} (language: {subject})\n\n{}\n\n{example}\n", wrapped(doc))
}

/// Characters of a line of text.
const WIDTH: usize = 100;

/// A paragraph in lines.
fn wrapped(paragraph: &str) -> String {
    let (mut out, mut column) = (String::new(), 0);
    for word in paragraph.split_whitespace() {
        let length = word.chars().count();
        let fits = column == 0 || column + 1 + length <= WIDTH;
        let before = if column == 0 {
            ""
        } else if fits {
            " "
        } else {
            "\n"
        };
        column = if fits { column + before.len() + length } else { length };
        out.extend([before, word]);
    }
    out
}

fn object_of(function: &Function) -> Value {
    let parameters = function.arguments.iter().map(|name| json!({ "name": name }));
    json!({
        "kind": function.name,
        "name": "",
        "origin": "language",
        "subject": function.subject,
        "usage": function.usage,
        "doc": function.doc,
        "example": function.example,
        "parameters": parameters.collect::<Vec<_>>(),
    })
}

/// The kind of a word that is no function either.
///
/// # Errors
/// An unknown word, with the nearest or the known ones.
fn kind(word: &str) -> Result<Kind, Failure> {
    Kind::of_word(word).ok_or_else(|| {
        let known: Vec<_> = kinds().into_iter().chain(functions().map(|it| it.name)).collect();
        unknown("kind or function", word, &known)
    })
}

fn entry<'r>(registry: &'r Registry, kind: Kind, name: Option<&str>) -> Result<&'r Entry, Failure> {
    let names: Vec<_> = registry.of_kind(kind).map(|entry| entry.class.name).collect();
    let Some(name) = name else {
        let message = format!("which {kind}? its name is missing after `{kind}`");
        let known = format!("known: {}", names.join(", "));
        return Err(Failure::new(Exit::Usage, message).help(known));
    };
    registry.entry(kind, name).ok_or_else(|| unknown(kind.word(), name, &names))
}

fn text(entry: &Entry) -> String {
    let class = &entry.class;
    let mut page = format!("{} {} ({})\n\n", class.kind, class.name, entry.origin);
    for line in class.doc.trim().lines() {
        if !line.trim_start().starts_with("```") {
            page.extend([line, "\n"]);
        }
    }
    section(&mut page, "Parameters", class.params);
    let (own, common) = (words::fields_of(class.kind), common_params(class.kind));
    section(&mut page, COMMON, common);
    if common.is_empty() && !own.is_empty() {
        page.extend(["\n", COMMON, ":\n"]);
    }
    words::describe(&mut page, own);
    page
}

/// Heads what every object of a kind may be given.
pub(crate) const COMMON: &str = "Of every object of this kind";

fn section(page: &mut String, title: &str, params: &[Param]) {
    if params.is_empty() {
        return;
    }
    page.extend(["\n", title, ":\n"]);
    for param in params {
        page.extend(["  ", param.name, ": ", &facts(param, params).join(", "), "\n"]);
        for line in param.doc.trim().lines() {
            page.extend(["      ", line.trim(), "\n"]);
        }
    }
}

fn object(entry: &Entry) -> Value {
    let class = &entry.class;
    let own = Registry::params(class).map(parameter);
    let parameters: Vec<_> = own.chain(words::parameters(words::fields_of(class.kind))).collect();
    json!({
        "kind": class.kind.word(),
        "name": class.name,
        "origin": entry.origin,
        "doc": class.doc.trim(),
        "parameters": parameters,
    })
}

fn parameter(param: &Param) -> Value {
    let finite = |x: f64| x.is_finite().then_some(x);
    json!({
        "name": param.name,
        "doc": param.doc.trim(),
        "type": what(param),
        "unit": param.unit,
        "min": finite(param.min),
        "max": finite(param.max),
        "default": default(param),
        "choices": param.words().collect::<Vec<_>>(),
        "group": param.group,
        "required": param.required,
        "textured": param.textured,
        "deprecated": param.deprecated,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::libraries::builtins;

    #[test]
    fn a_page_tells_type_unit_range_default_snippet_and_common_parameters() {
        let registry = builtins();
        let page = text(registry.entry(Kind::Shape, "sphere").unwrap());
        for part in [
            "shape sphere (builtin)",
            "shape sphere \"ball\"",
            "radius: number, in m, more than 0, required",
            "center: three numbers, in m, default (0, 0, 0)",
            "material: material, optional",
            "transform: list of rotate",
        ] {
            assert!(page.contains(part), "{part} in\n{page}");
        }
        assert!(!page.contains("```"));
    }

    #[test]
    fn every_plugin_has_a_page_and_every_parameter_a_text() {
        for entry in builtins().all() {
            assert!(!entry.class.doc.trim().is_empty(), "{:?}", entry.class);
            let page = object(entry);
            for parameter in page["parameters"].as_array().unwrap() {
                assert_ne!(parameter["doc"], "", "{:?} {parameter}", entry.class);
            }
        }
    }

    #[test]
    fn a_function_has_a_page_with_its_use_its_manual_and_its_example() {
        let (page, object) = of_language("rotate").unwrap();
        assert!(page.starts_with("rotate(axis, angle) (language: transforms"), "{page}");
        assert!(page.lines().all(|line| line.chars().count() <= WIDTH), "{page}");
        assert!(page.lines().nth(2).unwrap().len() > 80, "{page}");
        assert!(page.contains("counter-clockwise") && page.ends_with("30 deg)\n"), "{page}");
        assert_eq!(object["usage"], "rotate(axis, angle)");
        assert_eq!(object["parameters"][1]["name"], "angle");
        assert_eq!(of_language("tau").unwrap().1["parameters"], json!([]));
        assert!(of_language("group").is_some() && of_language("shape").is_none());
    }

    #[test]
    fn an_unknown_word_names_the_nearest_kind_or_function_or_all() {
        let help = |word| kind(word).unwrap_err().help.unwrap();
        assert_eq!(help("rgb.sgrb"), "did you mean `rgb.srgb`?");
        assert_eq!(help("materail"), "did you mean `material`?");
        assert!(help("xyzzy-plugh").contains("place, pi, tau, sin"));
    }

    #[test]
    fn sizes_choices_and_what_excludes_what_are_shown() {
        let page = text(builtins().entry(Kind::Camera, "perspective").unwrap());
        assert!(
            page.contains("in m, more than 0, exactly one of fov, focal_length is given"),
            "{page}"
        );
        let page = text(builtins().entry(Kind::Film, "auto").unwrap());
        assert!(
            page.contains("resolution: two whole numbers, from 1 to 65536, default (640, 480)")
        );
        assert!(page.contains("one of srgb, linear, filmic, default srgb"), "{page}");
    }
}
