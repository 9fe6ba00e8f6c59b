//! `luxel describe`: the manual page of one plugin.

use luxel_core::registry::{Entry, Registry, common_params};
use luxel_lang::manual::{default, facts, what};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::Param;
use serde_json::{Value, json};

use crate::args::PluginArgs;
use crate::exit::{Exit, Failure};
use crate::list::{kind, unknown};
use crate::report::{Form, Stream};
use crate::{load, report, words};

/// Show the manual page of a plugin: what it is, and each parameter
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel describe shape sphere
  luxel describe group
  luxel describe material diffuse --json")]
pub(crate) struct Args {
    /// Its kind, as `luxel list` shows it
    kind: String,
    /// Its name; none for the language's own words, such as `group`
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
    let page = match (words::find(&args.kind), &args.name) {
        (Some(word), None) if args.json => format!("{}\n", words::object(word)),
        (Some(word), None) => words::page(word),
        (Some(word), Some(name)) => {
            let message = format!("a `{}` has no kinds: there is no `{name}`", word.name);
            let help = format!("luxel describe {}", word.name);
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
        page.extend(["  ", param.name, ": ", &facts(param).join(", "), "\n"]);
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
    fn the_films_size_and_choices_are_shown() {
        let page = text(builtins().entry(Kind::Film, "auto").unwrap());
        assert!(page.contains("resolution: two numbers, from 1 to 65536, default (640, 480)"));
        assert!(page.contains("one of srgb, linear, filmic, default srgb"), "{page}");
    }
}
