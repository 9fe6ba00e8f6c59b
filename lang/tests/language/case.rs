//! A case: a snippet with files beside it, how it is loaded, and what must be told of it.

use std::fmt::Write as _;
use std::path::Path;

use luxel_core::diag::{Diagnostic, Severity, Sources};
use luxel_core::files::MemoryFiles;
use luxel_lang::{Loaded, Settings, load};

use crate::fenced::{Fenced, SMALL};
use crate::registry::registry;

/// What `CAMERA` in a case stands for.
const CAMERA: &str =
    "camera perspective { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)) }";

/// Every case: its name and its text.
pub(crate) fn all() -> impl Iterator<Item = (&'static str, &'static str)> {
    const CASES: [&str; 8] = [
        include_str!("../cases/catalogue.txt"),
        include_str!("../cases/syntax.txt"),
        include_str!("../cases/names.txt"),
        include_str!("../cases/habits.txt"),
        include_str!("../cases/units.txt"),
        include_str!("../cases/schema.txt"),
        include_str!("../cases/plugins.txt"),
        include_str!("../cases/expect.txt"),
    ];
    let parts = CASES.into_iter().flat_map(|file| file.split("\n--- ").skip(1));
    parts.map(|part| part.split_once(" ---\n").expect("a case has a name"))
}

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

    pub(crate) fn load(&self) -> Loaded {
        let files = self.files.iter().fold(MemoryFiles::default(), |files, (path, bytes)| {
            files.with(path, bytes.as_slice())
        });
        load(Path::new("case.scene"), &Fenced(files), &registry(), &self.settings)
    }
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
