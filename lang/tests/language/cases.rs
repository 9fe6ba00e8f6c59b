//! Cases: a snippet, then the mistakes that must be told of it, all of them and nothing else.
//!
//! `--- name ---` begins a case. Lines of the form `// error: E0402 3:5-3:10 fragment` (or
//! `// warning: …`) at its end say code, place and a part of the message or its help. A place in another text
//! than the snippet begins with its name: `--set:1:1-1:6`; `-` is no place. `// set: a=b` gives a
//! value on the command line, `// file: name` begins another file.

use std::fmt::Display;
use std::path::Path;

use luxel_core::diag::{Diagnostic, Severity, Sources};
use luxel_core::files::MemoryFiles;
use luxel_lang::{Settings, load};

use crate::registry::registry;

const CASES: [&str; 6] = [
    include_str!("../cases/syntax.txt"),
    include_str!("../cases/names.txt"),
    include_str!("../cases/units.txt"),
    include_str!("../cases/schema.txt"),
    include_str!("../cases/plugins.txt"),
    include_str!("../cases/expect.txt"),
];

/// What `CAMERA` in a case stands for.
const CAMERA: &str =
    "camera perspective { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)) }";

/// Where a diagnostic stands, as the cases write it.
fn place(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let Some(span) = diagnostic.span() else { return "-".to_owned() };
    let (start, end) = (span.range().start, span.range().end);
    let (a, b) = (sources.line_column(span.source, start), sources.line_column(span.source, end));
    let name = match sources.name(span.source) {
        "case.scene" => String::new(),
        other => format!("{other}:"),
    };
    format!("{name}{}:{}-{}:{}", a.line, a.column, b.line, b.column)
}

struct Case<'a> {
    name: &'a str,
    files: MemoryFiles,
    set: Vec<(String, String)>,
    /// Head (`error: E0402 3:5-3:10`) and fragment.
    expected: Vec<(String, &'a str)>,
}

fn parse(name: &'static str, body: &'static str) -> Case<'static> {
    let (mut set, mut expected) = (vec![], vec![]);
    let mut files = vec![("case.scene".to_owned(), String::new())];
    for line in body.lines() {
        if let Some(setting) = line.strip_prefix("// set: ") {
            let (name, value) = setting.split_once('=').expect("`name=value`");
            set.push((name.to_owned(), value.to_owned()));
        } else if let Some(file) = line.strip_prefix("// file: ") {
            files.push((file.to_owned(), String::new()));
        } else if line.starts_with("// error: ") || line.starts_with("// warning: ") {
            let mut words = line[3..].splitn(4, ' ');
            let head: Vec<&str> = words.by_ref().take(3).collect();
            expected.push((head.join(" "), words.next().unwrap_or("")));
        } else {
            let text = &mut files.last_mut().expect("there is always one").1;
            text.push_str(line);
            text.push('\n');
        }
    }
    let memory = files.into_iter().fold(MemoryFiles::default(), |memory, (path, text)| {
        let text = text.replace("\\0", "\0").replace("CAMERA", CAMERA);
        memory.with(path, text.trim_end_matches('\n').as_bytes())
    });
    Case { name, files: memory, set, expected }
}

/// What is wrong with a case; empty when all is as it says.
fn check(case: &Case<'_>) -> String {
    let settings = Settings { set: case.set.clone(), ..Settings::default() };
    let loaded = load(Path::new("case.scene"), &case.files, &registry(), &settings);
    let mut told: Vec<(String, String)> = vec![];
    for diagnostic in &loaded.diagnostics {
        let severity = match diagnostic.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        let place = place(diagnostic, &loaded.sources);
        let words = format!("{}; {}", diagnostic.message, diagnostic.help.join("; "));
        told.push((format!("{severity}: {} {place}", diagnostic.code), words));
        let known = luxel_lang::CATALOGUE.iter().any(|(code, _)| *code == diagnostic.code);
        assert!(known, "{} is not in the catalogue", diagnostic.code);
    }
    let mut expected = case.expected.clone();
    told.sort();
    expected.sort();
    let alike = told.len() == expected.len()
        && told.iter().zip(&expected).all(|(t, e)| t.0 == e.0 && t.1.contains(e.1));
    if alike {
        return String::new();
    }
    let (told, expected) = (show(&told), show(&expected));
    format!("--- {} ---\n told:\n{told}\n expected:\n{expected}\n", case.name)
}

fn show<T: Display>(list: &[(String, T)]) -> String {
    let lines: Vec<_> = list.iter().map(|(head, words)| format!("  // {head} {words}")).collect();
    lines.join("\n")
}

#[test]
fn every_case_tells_exactly_its_mistakes() {
    let mut failures = String::new();
    let mut codes = std::collections::BTreeSet::new();
    for file in CASES {
        for part in file.split("\n--- ").skip(1) {
            let (name, body) = part.split_once(" ---\n").expect("a case has a name");
            let case = parse(name, body);
            codes.extend(case.expected.iter().map(|(head, _)| head[7..].trim()[..5].to_owned()));
            failures.push_str(&check(&case));
        }
    }
    assert!(failures.is_empty(), "{failures}");
    assert!(codes.len() >= 60, "{} codes are tested", codes.len());
}
