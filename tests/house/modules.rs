//! Which top-level module of a package uses which, and the cycles among them.

use std::collections::{BTreeMap, BTreeSet};

use super::source::Source;

type Edges = BTreeMap<String, BTreeSet<String>>;

/// The cycles between the modules below `prefix` (`core/src/`), each as `a -> b -> a`.
pub(super) fn cycles(prefix: &str, sources: &[&Source]) -> Vec<String> {
    let mut edges = Edges::new();
    for source in sources {
        let path = module_path(&source.path[prefix.len()..]);
        // The root sees everything, and test files may.
        let Some(own) = path.first().filter(|_| source.is_product()) else { continue };
        let uses = edges.entry(own.clone()).or_default();
        let code: String = source.code().collect::<Vec<_>>().join("\n");
        uses.extend(named(&code, &path).into_iter().filter(|used| used != own));
    }
    let known: BTreeSet<_> = edges.keys().cloned().collect();
    for uses in edges.values_mut() {
        uses.retain(|used| known.contains(used));
    }
    let mut found: Vec<String> = known.iter().filter_map(|from| cycle(&edges, from)).collect();
    found.dedup();
    found
}

/// `kind/light.rs` is the module `[kind, light]`, `kind/mod.rs` is `[kind]`, `lib.rs` the root.
fn module_path(file: &str) -> Vec<String> {
    let stem = file.trim_end_matches(".rs");
    let parts = stem.split('/').filter(|part| !["mod", "lib", "main"].contains(part));
    parts.map(str::to_owned).collect()
}

/// The top-level modules that the code names, from `crate::` or by climbing with `super::`.
fn named(code: &str, path: &[String]) -> Vec<String> {
    let mut found = vec![];
    for (at, _) in code.match_indices("crate::") {
        found.extend(heads(&code[at + "crate::".len()..]));
    }
    for (at, word) in code.match_indices("super::") {
        // Only the first of a chain of `super::` starts a climb.
        if code[..at].ends_with(word) {
            continue;
        }
        let mut rest = &code[at..];
        let mut climbed = 0;
        while let Some(next) = rest.strip_prefix(word) {
            (rest, climbed) = (next, climbed + 1);
        }
        if climbed == path.len() {
            found.extend(heads(rest));
        }
    }
    found
}

/// The first name of a path, or of each path in a brace.
fn heads(rest: &str) -> Vec<String> {
    let name = |text: &str| -> String {
        let text = text.trim_start();
        text.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect()
    };
    let Some(inner) = rest.strip_prefix('{') else { return vec![name(rest)] };
    let mut depth = 0;
    let mut out = vec![name(inner)];
    for (at, c) in inner.char_indices() {
        match c {
            '{' => depth += 1,
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            ',' if depth == 0 => out.push(name(&inner[at + 1..])),
            _ => {}
        }
    }
    out
}

/// A shortest way from a module back to itself, told from the least name of the cycle.
fn cycle(edges: &Edges, from: &str) -> Option<String> {
    let mut ways: Vec<Vec<&str>> = vec![vec![from]];
    let mut seen = BTreeSet::new();
    let mut next = 0;
    while next < ways.len() {
        let way = ways[next].clone();
        next += 1;
        for used in &edges[*way.last()?] {
            if used == from {
                let least = way.iter().min() == Some(&from);
                return least.then(|| format!("{} -> {from}", way.join(" -> ")));
            }
            if seen.insert(used) {
                ways.push([way.as_slice(), &[used]].concat());
            }
        }
    }
    None
}

#[test]
fn a_cycle_is_found_through_braces_and_climbs() {
    let root = std::path::Path::new("/p");
    let source = |path: &str, text: &str| Source::new(root, &root.join(path), text);
    let a = source("x/src/a/deep.rs", "use crate::{b::{C, D}, e};");
    let b = source("x/src/b.rs", "use super::c::Y;");
    let c = source("x/src/c/mod.rs", "use super::a::Z;");
    assert_eq!(cycles("x/src/", &[&a, &b, &c]), ["a -> b -> c -> a"]);
    assert_eq!(cycles("x/src/", &[&a, &b]), Vec::<String>::new());
}
