//! A case: a snippet with files beside it, and what must be told of it. Shared with the tests of what the
//! stage tells, as a file that they take in.

use std::fmt::{Display, Write as _};
use std::path::Path;

use luxel_core::diag::{Diagnostic, Severity, Sources};
use luxel_core::files::MemoryFiles;
use luxel_core::registry::Registry;
use luxel_lang::{Loaded, Settings, load};

use crate::fenced::{Fenced, SMALL};

/// What `CAMERA` in a case stands for.
const CAMERA: &str =
    "camera perspective { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)) }";

#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) name: &'static str,
    /// Names and bytes; the first is the scene.
    pub(crate) files: Vec<(String, Vec<u8>)>,
    pub(crate) settings: Settings,
    /// Head (`error: E0402 3:5-3:10`) and fragments.
    pub(crate) expected: Vec<(String, &'static str)>,
}

impl Case {
    pub(crate) fn parse(name: &'static str, body: &'static str) -> Self {
        let (mut settings, mut expected) = (Settings::default(), vec![]);
        let mut files = vec![("case.scene".to_owned(), String::new())];
        for line in body.lines() {
            if let Some(setting) = line.strip_prefix("// set: ") {
                let (name, value) = setting.split_once('=').expect("`name=value`");
                settings.set.push((name.to_owned(), value.to_owned()));
            } else if let Some(file) = line.strip_prefix("// file: ") {
                files.push((file.to_owned(), String::new()));
            } else if line == "// small" {
                settings.budgets = SMALL;
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
        let files = files.into_iter().map(|(path, text)| {
            let text = text.replace("\\0", "\0").replace("\\BOM", "\u{FEFF}");
            let text = text.replace("CAMERA", CAMERA);
            (path, bytes(text.trim_end_matches('\n')))
        });
        Self { name, files: files.collect(), settings, expected }
    }
    /// The snippet and what lies beside it.
    pub(crate) fn fenced(&self) -> Fenced {
        Fenced(self.files.iter().fold(MemoryFiles::default(), |files, (path, bytes)| {
            files.with(path, bytes.as_slice())
        }))
    }

    /// The snippet, read with these classes.
    pub(crate) fn load_with(&self, registry: &Registry) -> Loaded {
        load(Path::new("case.scene"), &self.fenced(), registry, &self.settings)
    }
}

/// Each case of a file: its name and its text.
pub(crate) fn cases_of(file: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    let parts = file.split("\n--- ").skip(1);
    parts.map(|part| part.split_once(" ---\n").expect("a case has a name"))
}

/// What is wrong with what was told of a case; empty when it is as the case says.
pub(crate) fn differences(case: &Case, mut told: Vec<(String, String)>) -> String {
    let mut expected = case.expected.clone();
    told.sort();
    expected.sort();
    let says = |told: &str, parts: &str| parts.split(" & ").all(|part| told.contains(part));
    let alike = told.len() == expected.len()
        && told.iter().zip(&expected).all(|(t, e)| t.0 == e.0 && says(&t.1, e.1));
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

/// The bytes of a text in which `\xFF` is the byte 255.
fn bytes(text: &str) -> Vec<u8> {
    let mut parts = text.split("\\x");
    let mut out = parts.next().unwrap_or_default().as_bytes().to_vec();
    for part in parts {
        out.push(u8::from_str_radix(&part[..2], 16).expect("two digits follow \\x"));
        out.extend_from_slice(&part.as_bytes()[2..]);
    }
    out
}

/// Severity, code and place of a diagnostic, as the cases write them.
pub(crate) fn head(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let severity = match diagnostic.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
    };
    let place = diagnostic.span().map_or("-".to_owned(), |span| {
        let at = |byte: u32| sources.line_column(span.source, byte as usize);
        let (a, b) = (at(span.start), at(span.end));
        let name = match sources.name(span.source) {
            "case.scene" => String::new(),
            other => format!("{other}:"),
        };
        format!("{name}{}:{}-{}:{}", a.line, a.column, b.line, b.column)
    });
    format!("{severity}: {} {place}", diagnostic.code)
}

/// What a diagnostic says: its message, advice, further places and mends.
pub(crate) fn words(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let mut out = format!("{}; {}", diagnostic.message, diagnostic.help.join("; "));
    for label in diagnostic.labels.iter().skip(1) {
        let at = sources.line_column(label.span.source, label.span.start as usize);
        let _ = write!(out, "; see {}:{} {}", at.line, at.column, label.text);
    }
    for fix in &diagnostic.fixes {
        let old = &sources.text(fix.span.source)[fix.span.range()];
        let grade = format!("{:?}", fix.grade).to_lowercase();
        let new = fix.replacement.trim_end_matches('\n');
        let _ = write!(out, "; {grade} `{old}` → `{new}`");
    }
    out
}
