//! The house rules that no compiler keeps: who may know whom, who may touch what, how long a file
//! may be.

mod modules;
mod source;

use crate::disk::{files_below, root, text};
use source::Source;

/// Packages by folder, each with the packages of the workspace that it may depend on.
const ARROWS: [(&str, &[&str]); 14] = [
    ("cli", &["luxel-lang", "luxel-builtin", "luxel-conformance", "luxel-core", "luxel-sdk"]),
    ("lang", &["luxel-core", "luxel-sdk"]),
    ("core", &["luxel-sdk"]),
    ("plugins/builtin", &["luxel-sdk"]),
    ("plugins/builtin/library", &["luxel-builtin", "luxel-sdk"]),
    ("plugins/examples/bounces", &["luxel-sdk"]),
    ("plugins/examples/gyroid", &["luxel-sdk"]),
    ("plugins/examples/light_tracer", &["luxel-sdk"]),
    ("plugins/examples/noise", &["luxel-sdk"]),
    ("plugins/examples/pleats", &["luxel-sdk"]),
    ("plugins/examples/velvet", &["luxel-sdk"]),
    // The built-ins are for its tests alone.
    ("plugins/conformance", &["luxel-core", "luxel-sdk", "luxel-builtin"]),
    ("plugins/sdk", &["luxel-sdk-derive"]),
    ("plugins/sdk-derive", &[]),
];

/// External packages, each with the folders of the only packages that may depend on them.
const DEPENDENCIES: [(&str, &[&str]); 24] = [
    ("pest", &["lang"]),
    ("pest_derive", &["lang"]),
    ("tobj", &["plugins/builtin"]),
    ("gltf", &["plugins/builtin"]),
    ("image", &["plugins/builtin", "cli"]),
    ("zune-jpeg", &["plugins/builtin"]),
    ("exr", &["plugins/builtin", "cli"]),
    ("obvhs", &["core", "benches"]),
    ("rayon", &["core"]),
    ("libloading", &["core", "benches"]),
    ("object", &["core"]),
    ("notify", &["cli"]),
    ("clap", &["cli"]),
    ("ctrlc", &["cli"]),
    ("annotate-snippets", &["cli"]),
    ("toml", &["cli"]),
    ("sha2", &["cli"]),
    ("tempfile", &["cli"]),
    ("axum", &["cli"]),
    ("tokio", &["cli"]),
    ("hyper", &["cli"]),
    ("hyper-util", &["cli"]),
    ("getrandom", &["cli"]),
    ("subtle", &["cli"]),
];

/// Words of the source, each with the only places where they may stand.
const ROOMS: [(&str, &[&str]); 17] = [
    ("std::fs", &["cli/src/", "cli/build.rs"]),
    ("std::env", &["cli/src/", "cli/build.rs"]),
    ("std::net", &["cli/src/"]),
    ("std::process", &["cli/src/", "cli/build.rs"]),
    ("println!", &["cli/src/", "cli/build.rs"]),
    ("print!", &["cli/src/"]),
    ("pest::", &["lang/src/"]),
    ("tobj::", &["plugins/builtin/src/"]),
    ("obvhs::", &["core/src/accel/"]),
    ("std::arch", &["core/src/accel/", "plugins/sdk/src/sampling/sobol/"]),
    ("core::arch", &["core/src/accel/"]),
    ("is_x86_feature_detected", &["core/src/accel/", "plugins/sdk/src/sampling/sobol/"]),
    ("target_feature", &["core/src/accel/", "plugins/sdk/src/sampling/sobol/"]),
    ("rayon::", &["core/src/accel/", "core/src/render/"]),
    ("libloading", &["core/src/registry/dynamic"]),
    (
        "unsafe",
        &[
            "plugins/sdk/src/abi/",
            "plugins/sdk/src/kind/table/",
            "plugins/sdk/src/wire/",
            "plugins/sdk/src/params/",
            // Points with what the processor has.
            "plugins/sdk/src/sampling/sobol/",
            // It writes the unsafe implementation that `params` asks for.
            "plugins/sdk-derive/src/",
            "core/src/object/",
            "core/src/accel/",
            "core/src/registry/dynamic",
            // An allocator.
            "core/src/memory.rs",
        ],
    ),
    ("static mut", &[]),
];

/// What stands nowhere, tests included.
const NOWHERE: [&str; 5] = ["#[allow(", "#![allow(", "#[ignore", "todo!(", "unimplemented!("];

const MAX_LINES: usize = 500;

/// Every Rust file of the project by its path from the root.
fn sources() -> Vec<Source> {
    let root = root();
    let files = files_below(&root, "rs");
    let sources: Vec<_> = files.iter().map(|path| Source::new(&root, path, &text(path))).collect();
    assert!(sources.len() > 100, "the sources were not found below {}", root.display());
    sources
}

/// The names in the dependency tables of a package.
fn dependencies(folder: &str) -> Vec<String> {
    let manifest = text(&root().join(folder).join("Cargo.toml"));
    let mut found = vec![];
    let mut inside = false;
    for line in manifest.lines() {
        if line.starts_with('[') {
            inside = line.ends_with("dependencies]");
        } else if inside && line.starts_with(|c: char| c.is_ascii_alphabetic()) {
            let name = line.split(['.', '=', ' ']).next().unwrap_or_default();
            found.push(name.to_owned());
        }
    }
    found
}

fn packages() -> impl Iterator<Item = (&'static str, &'static [&'static str])> {
    let exists = |folder: &str| root().join(folder).join("Cargo.toml").exists();
    ARROWS.into_iter().filter(move |(folder, _)| exists(folder))
}

#[test]
fn the_arrows_between_packages_point_down() {
    let mut wrong = vec![];
    for (folder, allowed) in packages() {
        let own = dependencies(folder).into_iter().filter(|name| name.starts_with("luxel"));
        wrong.extend(own.filter(|name| !allowed.contains(&name.as_str())).map(|n| (folder, n)));
    }
    assert!(wrong.is_empty(), "packages that know what they must not: {wrong:?}");
    assert!(dependencies("cli").contains(&"luxel-core".to_owned()), "nothing was read");
}

#[test]
fn each_library_is_known_to_its_room_alone() {
    let mut wrong = vec![];
    for (folder, _) in packages() {
        for name in dependencies(folder) {
            let rule = DEPENDENCIES.iter().find(|(known, _)| *known == name);
            if rule.is_some_and(|(_, allowed)| !allowed.contains(&folder)) {
                wrong.push((folder, name));
            }
        }
    }
    assert!(wrong.is_empty(), "dependencies in the wrong room: {wrong:?}");
}

#[test]
fn each_dangerous_word_stands_in_its_room_alone() {
    let mut wrong = vec![];
    for source in sources().iter().filter(|source| source.is_product()) {
        for (word, allowed) in ROOMS {
            if !allowed.iter().any(|room| source.path.starts_with(room)) {
                wrong
                    .extend(source.lines_with(word).map(|n| format!("{word} {}:{n}", source.path)));
            }
        }
    }
    assert!(wrong.is_empty(), "out of their rooms:\n{}", wrong.join("\n"));
}

#[test]
fn nothing_is_silenced_skipped_or_left_to_do() {
    let mut wrong = vec![];
    for source in &sources() {
        for word in NOWHERE {
            wrong
                .extend(source.all_lines_with(word).map(|n| format!("{word} {}:{n}", source.path)));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_file_is_longer_than_a_person_reads() {
    let sources = sources();
    let long = sources.iter().filter(|s| s.n_lines > MAX_LINES && !s.path.contains("/data/"));
    let long: Vec<_> = long.map(|s| format!("{}: {} lines", s.path, s.n_lines)).collect();
    assert!(long.is_empty(), "{}", long.join("\n"));
}

#[test]
fn no_two_modules_of_a_package_know_each_other() {
    let sources = sources();
    let mut wrong = vec![];
    for (folder, _) in packages() {
        let prefix = format!("{folder}/src/");
        let own: Vec<_> = sources.iter().filter(|s| s.path.starts_with(&prefix)).collect();
        wrong.extend(modules::cycles(&prefix, &own).iter().map(|c| format!("{folder}: {c}")));
    }
    assert!(wrong.is_empty(), "cycles between modules:\n{}", wrong.join("\n"));
}
