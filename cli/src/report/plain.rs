//! Text that no terminal takes for a command, counts, and diagnostics as JSON.

use luxel_core::diag::{Diagnostic, LineColumn, Severity, Sources, Span};
use serde_json::{Value, json};

/// Replaces control characters, which a file may hold and a terminal would obey.
pub(super) fn clean(text: &str) -> String {
    let harmless = |c: char| if c.is_control() && c != '\n' { '\u{fffd}' } else { c };
    text.chars().map(harmless).collect()
}

/// `2 errors, 1 warning`
pub(super) fn count(found: &[Diagnostic]) -> String {
    let errors = found.iter().filter(|diagnostic| diagnostic.is_error()).count();
    let told = |n: usize, word: &str| match n {
        0 => None,
        1 => Some(format!("1 {word}")),
        n => Some(format!("{n} {word}s")),
    };
    let parts = [told(errors, "error"), told(found.len() - errors, "warning")];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// How many there are, and where to read more of the first error, or of the first warning.
pub(super) fn closing(found: &[Diagnostic]) -> String {
    let first = found.iter().find(|diagnostic| diagnostic.is_error()).or(found.first());
    let more = first.map(|first| format!("; more: luxel explain {}", first.code));
    format!("{}{}", count(found), more.unwrap_or_default())
}

/// One object: `code, severity, message, file, line, column, end_line, end_column, start_byte, end_byte,
/// label, labels, help, fixes`. Lines and columns count from 1, columns in characters; `null` where no
/// place is at fault, for which the file is the scene.
pub(super) fn json(diagnostic: &Diagnostic, sources: &Sources) -> Value {
    let Diagnostic { code, severity, message, labels, help, fixes } = diagnostic;
    let nowhere = || place_of_nothing(sources);
    let mut object = diagnostic.span().map_or_else(nowhere, |span| place(span, sources));
    let labels = labels.iter().skip(1).map(|label| {
        let mut object = place(label.span, sources);
        object["text"] = json!(label.text);
        object
    });
    let fixes = fixes.iter().map(|fix| {
        let mut object = place(fix.span, sources);
        object["replacement"] = json!(fix.replacement);
        object["grade"] = json!(fix.grade);
        object
    });
    object["label"] = json!(diagnostic.labels.first().map(|label| &label.text));
    object["labels"] = labels.collect();
    object["fixes"] = fixes.collect();
    object["code"] = json!(code);
    object["severity"] = json!(word(*severity));
    object["message"] = json!(message);
    object["help"] = json!(help);
    object
}

fn place(span: Span, sources: &Sources) -> Value {
    let at = |byte: u32| (sources.line_column(span.source, byte as usize), byte);
    place_of(Some(sources.name(span.source)), Some((at(span.start), at(span.end))))
}

/// The scene that was read, and no place in it.
fn place_of_nothing(sources: &Sources) -> Value {
    place_of(sources.first(), None)
}

/// A file, and where in it something begins and ends.
fn place_of(file: Option<&str>, at: Option<((LineColumn, u32), (LineColumn, u32))>) -> Value {
    let (start, end) = at.unzip();
    json!({
        "file": file,
        "line": start.map(|(at, _)| at.line),
        "column": start.map(|(at, _)| at.column),
        "end_line": end.map(|(at, _)| at.line),
        "end_column": end.map(|(at, _)| at.column),
        "start_byte": start.map(|(_, byte)| byte),
        "end_byte": end.map(|(_, byte)| byte),
    })
}

/// The same object of what has no code and is of no scene.
pub(super) fn remark(severity: Severity, message: &str, help: Option<&str>) -> Value {
    let mut told = Diagnostic { severity, ..Diagnostic::unplaced("", message) };
    told.help.extend(help.map(str::to_owned));
    let mut object = json(&told, &Sources::default());
    object["code"] = Value::Null;
    object
}

/// How severe something is.
pub(super) fn word(severity: Severity) -> &'static str {
    match severity {
        Severity::Warning => "warning",
        Severity::Error => "error",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_names_file_line_and_column_of_place_labels_and_fixes() {
        let mut sources = Sources::default();
        let id = sources.add("a.scene", "scene 1\né = gld\n");
        let span = Span::new(id, 13, 16);
        let found = Diagnostic::error("E0101", span, "there is no `gld`")
            .saying("not known")
            .label(Span::new(id, 0, 5), "see")
            .help("did you mean `gold`?")
            .fix(span, "gold");
        let value = json(&found, &sources);
        assert_eq!((&value["file"], &value["line"]), (&json!("a.scene"), &json!(2)));
        assert_eq!((&value["column"], &value["end_column"]), (&json!(5), &json!(8)));
        assert_eq!(value["labels"][0]["line"], 1);
        assert_eq!(value["fixes"][0]["replacement"], "gold");
        assert_eq!(value["fixes"][0]["grade"], "sure");
        assert_eq!(value["severity"], "error");
        let nowhere = json(&Diagnostic::unplaced("E0409", "no camera"), &sources);
        assert_eq!((&nowhere["line"], &nowhere["code"]), (&Value::Null, &json!("E0409")));
        assert_eq!(nowhere["file"], "a.scene");
        let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
        assert_eq!(keys(&nowhere), keys(&value));
    }

    #[test]
    fn what_has_no_code_is_told_in_the_same_way() {
        let told = remark(Severity::Warning, "late", Some("hurry"));
        assert_eq!((&told["severity"], &told["message"]), (&json!("warning"), &json!("late")));
        assert_eq!((&told["help"], &told["code"]), (&json!(["hurry"]), &Value::Null));
        assert_eq!(remark(Severity::Error, "late", None)["help"], json!([]));
    }

    #[test]
    fn counts_use_singular_and_plural_and_escapes_are_made_harmless() {
        let error = Diagnostic::unplaced("E0001", "x");
        let warning = Diagnostic { severity: Severity::Warning, ..error.clone() };
        assert_eq!(count(&[error.clone(), error.clone(), warning]), "2 errors, 1 warning");
        assert_eq!(count(std::slice::from_ref(&error)), "1 error");
        let warning = Diagnostic { severity: Severity::Warning, code: "E0022", ..error.clone() };
        let all = [warning.clone(), error];
        assert_eq!(closing(&all), "1 error, 1 warning; more: luxel explain E0001");
        assert_eq!(closing(&[warning]), "1 warning; more: luxel explain E0022");
        assert_eq!(clean("a\x1b[31m\nb"), "a\u{fffd}[31m\nb");
    }
}
