//! `luxel describe`: the manual page of one plugin.

use luxel_core::registry::{Entry, Registry, common_params};
use luxel_core::scene::{number_words, range_words};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Param, Preset, Type};
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
        (Some(word), None) if args.json => format!("{}\n", word.object()),
        (Some(word), None) => word.page(),
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

/// Type, unit, range, default and the like, each in a few words.
pub(crate) fn facts(param: &Param) -> Vec<String> {
    let mut facts = vec![what(param)];
    if !param.unit.is_empty() {
        facts.push(format!("in {}", param.unit.replace('|', " or ")));
    }
    facts.extend(range_words(param));
    if !param.choices.is_empty() {
        facts.push(format!("one of {}", param.words().collect::<Vec<_>>().join(", ")));
    }
    if param.textured {
        let number = param.ty == Type::Float;
        let what = if number {
            "may be a texture (of a colour its luminance)"
        } else {
            "may be a texture"
        };
        facts.push(what.into());
    }
    if !param.group.is_empty() {
        facts.push(format!("exactly one `{}` is given", param.group));
    }
    match default(param) {
        _ if param.required => facts.push("required".into()),
        Some(default) => facts.push(format!("default {default}")),
        None if param.group.is_empty() => facts.push("optional".into()),
        None => {}
    }
    if !param.deprecated.is_empty() {
        facts.push(format!("old name, now `{}`", param.deprecated));
    }
    facts
}

fn what(param: &Param) -> String {
    match param.ty {
        // The spectrum itself stands in no group; its amounts do.
        Type::Emission if param.group.is_empty() => "spectrum".into(),
        Type::Emission | Type::Float | Type::Double | Type::MaybeFloat => "number".into(),
        Type::Int => "whole number".into(),
        Type::Bool => "true or false".into(),
        Type::Vec2 => "two numbers".into(),
        Type::Vec3 | Type::DVec3 => "three numbers".into(),
        Type::Spectrum => "colour or spectrum".into(),
        Type::ComplexIor => "metal, or complex index of refraction".into(),
        Type::Choice => "word".into(),
        Type::Text => "text".into(),
        Type::File => "file".into(),
        Type::Table => "list of numbers".into(),
        Type::Look => "look_at(from, to, up)".into(),
        Type::Object(kind) => kind.word().into(),
        Type::Part => "shape".into(),
    }
}

fn default(param: &Param) -> Option<String> {
    match param.default {
        Preset::Absent => None,
        Preset::Numbers(numbers) => Some(numbers_of(param.ty, numbers)),
        Preset::Index(i) => Some(param.words().nth(i as usize).unwrap_or("?").into()),
        Preset::Text(text) => Some(format!("{text:?}")),
    }
}

fn numbers_of(ty: Type, numbers: [f64; 4]) -> String {
    let n = match ty {
        Type::Vec2 => 2,
        Type::Vec3 | Type::DVec3 => 3,
        Type::Bool => return (numbers[0] > 0.0).to_string(),
        _ => return number_words(numbers[0]),
    };
    format!("({})", numbers[..n].iter().map(|x| number_words(*x)).collect::<Vec<_>>().join(", "))
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
