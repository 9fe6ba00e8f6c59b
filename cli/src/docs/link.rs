//! Whether every link of the reference leads somewhere in it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::page::File;

/// Links that lead nowhere, in words.
pub(super) fn broken(files: &[File], pictures: &[File]) -> Vec<String> {
    let texts = files
        .iter()
        .filter(|file| Path::new(&file.name).extension().is_some_and(|it| it == "html"));
    let texts: BTreeMap<&str, String> = texts
        .map(|file| (&*file.name, String::from_utf8_lossy(&file.bytes).into_owned()))
        .collect();
    let others: BTreeSet<&str> = files.iter().chain(pictures).map(|file| &*file.name).collect();
    let mut broken = vec![];
    for (name, text) in &texts {
        for to in attributes(text, "href").chain(attributes(text, "src")) {
            if to.starts_with("https://") {
                continue;
            }
            let (file, anchor) = to.split_once('#').map_or((to, None), |(f, a)| (f, Some(a)));
            let file = if file.is_empty() { name } else { file };
            let has = |anchor| {
                texts.get(file).is_some_and(|text| attributes(text, "id").any(|id| id == anchor))
            };
            if !others.contains(file) || !anchor.is_none_or(has) {
                broken.push(format!("{name}: the link to `{to}` leads nowhere"));
            }
        }
    }
    broken
}

/// The values of an attribute; text of a page has no quotes that are not escaped.
fn attributes<'t>(text: &'t str, name: &str) -> impl Iterator<Item = &'t str> {
    let begins = format!(" {name}=\"");
    let mut rest = text;
    std::iter::from_fn(move || {
        let (_, after) = rest.split_once(&begins)?;
        let (value, after) = after.split_once('"')?;
        rest = after;
        Some(value)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_leads_nowhere_is_told_with_its_page() {
        let file = |name: &str, text: &str| File { name: name.to_owned(), bytes: text.into() };
        let page = "<h1 id=\"a\"></h1><a href=\"#a\"></a><a href=\"#b\"></a><img src=\"p.png\"><a href=\"q.html\"></a>";
        let files = [file("x.html", page)];
        let told = broken(&files, &[file("p.png", "")]);
        assert_eq!(
            told,
            [
                "x.html: the link to `#b` leads nowhere",
                "x.html: the link to `q.html` leads nowhere"
            ]
        );
        assert_eq!(broken(&files, &[]).len(), 3);
    }
}
