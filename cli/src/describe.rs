//! `luxel describe`: the manual page of one plugin.

use luxel_core::registry::{Entry, Registry, common_params};
use luxel_core::scene::{number_words, range_words};
use luxel_sdk::params::{Param, Preset, Type};
use serde_json::{Value, json};

use crate::exit::{Exit, Failure};
use crate::list::{kind, unknown};
use crate::{load, report};

/// Show the manual page of a plugin: what it is, and each parameter
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel describe shape sphere
  luxel describe material diffuse --json")]
pub(crate) struct Args {
    /// Its kind, as `luxel list` shows it
    kind: String,
    /// Its name
    name: String,
    /// A JSON object
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let registry = load::registry();
    let kind = kind(&args.kind)?;
    let Some(entry) = registry.entry(kind, &args.name) else {
        let names: Vec<_> = registry.of_kind(kind).map(|entry| entry.class.name).collect();
        return Err(unknown(kind.word(), &args.name, &names));
    };
    let page = if args.json { format!("{}\n", object(entry)) } else { text(entry) };
    report::out(&page)?;
    Ok(Exit::Fine)
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
    section(&mut page, "Of every object of this kind", common_params(class.kind));
    page
}

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
fn facts(param: &Param) -> Vec<String> {
    let mut facts = vec![what(param)];
    if !param.unit.is_empty() {
        facts.push(format!("in {}", param.unit.replace('|', " or ")));
    }
    facts.extend(range_words(param));
    if !param.choices.is_empty() {
        facts.push(format!("one of {}", param.choices.join(", ")));
    }
    if param.textured {
        facts.push("may be a texture".into());
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
    }
}

fn default(param: &Param) -> Option<String> {
    match param.default {
        Preset::Absent => None,
        Preset::Numbers(numbers) => Some(numbers_of(param.ty, numbers)),
        Preset::Index(i) => Some(param.choices.get(i as usize).map_or("?", |word| word).into()),
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
    json!({
        "kind": class.kind.word(),
        "name": class.name,
        "origin": entry.origin,
        "doc": class.doc.trim(),
        "parameters": Registry::params(class).map(parameter).collect::<Vec<_>>(),
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
        "choices": param.choices,
        "group": param.group,
        "required": param.required,
        "textured": param.textured,
        "deprecated": param.deprecated,
    })
}

#[cfg(test)]
mod tests {
    use luxel_sdk::kind::Kind;

    use super::*;

    #[test]
    fn a_page_tells_type_unit_range_default_snippet_and_common_parameters() {
        let registry = load::registry();
        let page = text(registry.entry(Kind::Shape, "sphere").unwrap());
        for part in [
            "shape sphere (builtin)",
            "shape sphere \"ball\"",
            "radius: number, in m, more than 0, required",
            "center: three numbers, in m, default (0, 0, 0)",
            "material: material, optional",
        ] {
            assert!(page.contains(part), "{part} in\n{page}");
        }
        assert!(!page.contains("```"));
    }

    #[test]
    fn every_plugin_has_a_page_and_every_parameter_a_text() {
        for entry in load::registry().all() {
            assert!(!entry.class.doc.trim().is_empty(), "{:?}", entry.class);
            let page = object(entry);
            for parameter in page["parameters"].as_array().unwrap() {
                assert_ne!(parameter["doc"], "", "{:?} {parameter}", entry.class);
            }
        }
    }

    #[test]
    fn the_films_size_and_choices_are_shown() {
        let page = text(load::registry().entry(Kind::Film, "auto").unwrap());
        assert!(page.contains("resolution: two numbers, from 1 to 65536, default (640, 480)"));
        assert!(page.contains("one of srgb, linear, filmic, default srgb"), "{page}");
    }
}
