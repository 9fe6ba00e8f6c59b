//! What every registered class must say about itself.

use std::path::Path;

use luxel_core::diag::Diagnostic;
use luxel_core::files::MemoryFiles;
use luxel_core::registry::{Entry, Registry};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Preset, Unit};

use crate::load::registry;

/// Every class, checked; all complaints at once.
fn check(rule: impl Fn(&Entry) -> Vec<String>) {
    let registry = registry();
    let mut n = 0;
    let mut wrong = vec![];
    for entry in registry.all() {
        n += 1;
        wrong.extend(rule(entry).into_iter().map(|text| format!("{:?}: {text}", entry.class)));
    }
    assert!(n > 10, "only {n} classes are registered");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The blocks of scene text in a manual page.
fn snippets(doc: &str) -> Vec<String> {
    let blocks = doc.split("```scene").skip(1);
    blocks.filter_map(|rest| rest.split("```").next()).map(str::to_owned).collect()
}

/// A snippet as a whole scene: names that it uses and does not make, and a camera.
fn whole(snippet: &str) -> String {
    let mut text = String::from("scene 1\n");
    for name in ["white", "wood", "steel", "red", "gold", "paint"] {
        let uses = snippet.contains(&format!("= {name}"));
        if uses && !snippet.contains(&format!("let {name} ")) {
            text += &["let ", name, " = material diffuse {}\n"].concat();
        }
    }
    text += snippet;
    if !snippet.contains("camera ") {
        text += "\ncamera perspective {
            look = look_at(from = (0, 0, 1) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }\n";
    }
    text
}

fn load(text: &str, registry: &Registry) -> Vec<Diagnostic> {
    let files = MemoryFiles::default().with("manual.scene", text.as_bytes());
    let settings = luxel_lang::Settings::default();
    luxel_lang::load(Path::new("manual.scene"), &files, registry, &settings).diagnostics
}

#[test]
fn every_manual_page_shows_a_short_scene_that_loads() {
    let registry = registry();
    check(|entry| {
        let found = snippets(entry.class.doc);
        let mut wrong = vec![];
        if found.is_empty() {
            wrong.push("no scene in the manual".to_owned());
        }
        for snippet in &found {
            let text = whole(snippet);
            let said = load(&text, &registry);
            wrong.extend(said.iter().filter(|d| d.is_error()).map(|d| format!("{d} in{snippet}")));
            if snippet.trim().lines().count() > 10 {
                wrong.push("a snippet of more than ten lines".to_owned());
            }
            let name = format!("{} {}", entry.class.kind, entry.class.name);
            // The film's classes share one manual.
            if !snippet.contains(&name) && entry.class.kind != Kind::Film {
                wrong.push(format!("a snippet without `{name}`"));
            }
        }
        wrong
    });
}

#[test]
fn every_parameter_is_documented_and_its_unit_is_known() {
    check(|entry| {
        let mut wrong = vec![];
        if entry.class.doc.trim().is_empty() {
            wrong.push("no manual".to_owned());
        }
        for param in Registry::params(&entry.class) {
            if param.doc.trim().is_empty() {
                wrong.push(format!("`{}` is not documented", param.name));
            }
            let units = param.unit.split('|').filter(|unit| !unit.is_empty());
            let unknown = units.filter_map(|unit| Unit::parse(unit).err());
            wrong.extend(unknown.map(|part| format!("`{}`: unknown unit {part}", param.name)));
        }
        wrong
    });
}

#[test]
fn every_name_is_in_snake_case() {
    let snake = |name: &str| {
        let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        name.starts_with(|c: char| c.is_ascii_lowercase()) && name.chars().all(legal)
    };
    check(|entry| {
        let mut names = vec![entry.class.name];
        for param in Registry::params(&entry.class) {
            names.push(param.name);
            names.extend(param.words());
        }
        names.into_iter().filter(|name| !snake(name)).map(str::to_owned).collect()
    });
}

#[test]
fn every_preset_is_a_legal_value() {
    check(|entry| {
        let mut wrong = vec![];
        for param in Registry::params(&entry.class) {
            let legal = match param.default {
                Preset::Numbers([x, ..]) => param.min <= x && x <= param.max,
                Preset::Index(i) => (i as usize) < param.choices.len(),
                Preset::Absent | Preset::Text(_) => true,
            };
            if !legal || param.min > param.max {
                wrong.push(format!("`{}`: its preset is out of its range", param.name));
            }
            if param.required && param.default != Preset::Absent {
                wrong.push(format!("`{}` is required and has a preset", param.name));
            }
        }
        wrong
    });
}

#[test]
fn every_kind_has_a_class() {
    let registry = registry();
    let empty = Kind::ALL.iter().filter(|(kind, _)| registry.of_kind(*kind).next().is_none());
    assert_eq!(empty.map(|(_, word)| *word).collect::<Vec<_>>(), Vec::<&str>::new());
}
