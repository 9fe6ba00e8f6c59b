//! The manual pages of the language's own words, as text and for programs.

use luxel_lang::manual::Field;
use serde_json::{Value, json};

pub(crate) use luxel_lang::manual::{WORDS, Word, fields_of, find};

/// The manual page.
pub(crate) fn page(word: &Word) -> String {
    let mut page = format!("{} (language)\n\n{}\nFields:\n", word.name, word.doc);
    describe(&mut page, word.fields);
    page
}

/// The manual page for programs, in the form of a plugin's.
pub(crate) fn object(word: &Word) -> Value {
    json!({
        "kind": word.name,
        "name": "",
        "origin": "language",
        "doc": word.doc.trim(),
        "parameters": parameters(word.fields),
    })
}

/// Fields as lines of a page.
pub(crate) fn describe(page: &mut String, fields: &[Field]) {
    for (name, facts, doc) in fields {
        page.extend(["  ", name, ": ", facts, "\n      ", doc, "\n"]);
    }
}

/// Fields as JSON.
pub(crate) fn parameters(fields: &[Field]) -> Vec<Value> {
    let one = |(name, facts, doc): &Field| json!({ "name": name, "type": facts, "doc": doc });
    fields.iter().map(one).collect()
}
