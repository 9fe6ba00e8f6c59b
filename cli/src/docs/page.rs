//! Pages, and what stands around them: the list of all, the search, the look.

use serde_json::json;

use super::markdown::{self, Part, escaped};

/// A page of the reference.
pub(super) struct Page {
    /// Its file without the extension.
    pub(super) name: String,
    pub(super) title: String,
    /// What it is listed under.
    pub(super) section: String,
    /// A sentence of what it is.
    pub(super) summary: String,
    /// What it says, in HTML.
    pub(super) body: String,
    /// Words that it is found by, beside title and summary.
    pub(super) words: String,
    /// The picture that the list shows.
    pub(super) picture: Option<String>,
    /// What in it is found by itself.
    pub(super) parts: Vec<Part>,
}

/// A file of the folder.
pub(super) struct File {
    pub(super) name: String,
    pub(super) bytes: Vec<u8>,
}

/// The section of pages that are no class.
pub(super) const GUIDE: &str = "guide";

/// A document of the project.
pub(super) fn document(name: &str, text: &str) -> Page {
    let title = text.lines().next().unwrap_or_default().trim_start_matches("# ").to_owned();
    Page {
        name: name.to_owned(),
        summary: String::new(),
        section: GUIDE.to_owned(),
        body: markdown::html(text),
        words: text.to_owned(),
        parts: markdown::headings(text).into_iter().skip(1).collect(),
        title,
        picture: None,
    }
}

/// Every file but the pictures.
pub(super) fn site(pages: &[Page]) -> Vec<File> {
    let list = list(pages);
    let mut files: Vec<File> =
        pages.iter().map(|page| file(&page.name, &whole(&page.title, &list, &page.body))).collect();
    files.push(file("index", &whole("Luxel", &list, &front(pages))));
    let style = include_str!("style.css").as_bytes().to_vec();
    files.push(File { name: "style.css".to_owned(), bytes: style });
    files.push(File { name: "search.js".to_owned(), bytes: search(pages).into_bytes() });
    files
}

fn file(name: &str, text: &str) -> File {
    File { name: format!("{name}.html"), bytes: text.as_bytes().to_vec() }
}

fn whole(title: &str, list: &str, body: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{} · Luxel</title>\n<link rel=\"stylesheet\" href=\"style.css\">\n</head>\n<body>\n\
         <nav>\n<a class=\"home\" href=\"index.html\">Luxel {}</a>\n\
         <input id=\"search\" type=\"search\" placeholder=\"search ( / )\" aria-label=\"search\">\n\
         <ul id=\"found\" hidden></ul>\n{list}</nav>\n<main>\n{body}\n</main>\n\
         <script src=\"search.js\"></script>\n</body>\n</html>\n",
        escaped(title),
        env!("CARGO_PKG_VERSION"),
    )
}

/// The sections in the order in which they first appear.
fn sections(pages: &[Page]) -> Vec<&str> {
    let mut found: Vec<&str> = vec![];
    for page in pages {
        if !found.contains(&&*page.section) {
            found.push(&page.section);
        }
    }
    found
}

fn list(pages: &[Page]) -> String {
    let section = |section: &str| {
        let of_section = pages.iter().filter(|page| page.section == section);
        let links = of_section.map(|page| {
            let short = page.title.strip_prefix(section).unwrap_or(&page.title).trim();
            format!("<li><a href=\"{}.html\">{}</a></li>\n", page.name, escaped(short))
        });
        let links: String = links.collect();
        format!(
            "<details open><summary>{}</summary>\n<ul>\n{links}</ul></details>\n",
            escaped(section)
        )
    };
    sections(pages).into_iter().map(section).collect()
}

fn front(pages: &[Page]) -> String {
    let card = |page: &Page| {
        let picture = page.picture.as_ref().map_or(String::new(), |picture| {
            format!("<img src=\"{picture}\" alt=\"\" loading=\"lazy\">")
        });
        format!(
            "<a class=\"card\" href=\"{}.html\">{picture}<b>{}</b> <span>{}</span></a>\n",
            page.name,
            escaped(&page.title),
            markdown::inline(&page.summary),
        )
    };
    let section = |section: &str| {
        let cards: String = pages.iter().filter(|page| page.section == section).map(card).collect();
        format!("<h2>{}</h2>\n<div class=\"cards\">\n{cards}</div>\n", escaped(section))
    };
    let sections: String = sections(pages).into_iter().map(section).collect();
    format!(
        "<h1>Luxel</h1>\n<p>A scene that you write as text becomes a picture that obeys physics and says \
         how wrong it may be. This is what a scene may say: the language, and every class that this \
         program knows.</p>\n{sections}"
    )
}

/// What is typed is looked for in titles first, then in everything else.
fn search(pages: &[Page]) -> String {
    let whole = pages.iter().map(|page| {
        json!({
            "page": format!("{}.html", page.name),
            "title": page.title,
            "summary": page.summary,
            "words": page.words,
        })
    });
    let parts = pages.iter().flat_map(|page| page.parts.iter().map(move |part| (page, part)));
    let parts = parts.map(|(page, Part { anchor, title, words })| {
        json!({
            "page": format!("{}.html#{anchor}", page.name),
            "title": title,
            "summary": page.title,
            "words": words,
        })
    });
    let entries: serde_json::Value = whole.chain(parts).collect();
    format!("const PAGES = {entries};\n{}", include_str!("search.js"))
}
