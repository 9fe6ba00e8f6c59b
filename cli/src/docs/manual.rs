//! The page of a class, of a word of the language, and of all messages.

use luxel_core::registry::{Entry, common_params};
use luxel_lang::manual::{Field, facts};
use luxel_lang::{CATALOGUE, Example, page};
use luxel_sdk::params::Param;

use super::markdown::{self, Part, escaped};
use super::page::{GUIDE, Page};
use super::thumb::{SNIPPET, Shown};
use crate::describe::COMMON;
use crate::list::summary;
use crate::words::{self, Word};

/// The manual of a class, with its parameters and the pictures of what it shows, as far as there are any.
pub(super) fn class(entry: &Entry, drawn: &[Shown<'_>]) -> Page {
    let class = &entry.class;
    let (kind, name) = (class.kind.word(), class.name);
    let title = title_of(entry);
    let [own, common, read] =
        [rows(class.params), rows(common_params(class.kind)), fields(words::fields_of(class.kind))];
    let file = format!("{kind}-{name}");
    let body = format!(
        "<h1>{title}</h1>\n<p class=\"origin\">{}</p>\n{}{}{}{}",
        escaped(&entry.origin),
        illustrated(class.doc.trim(), drawn),
        table("Parameters", &own),
        table(COMMON, &common),
        table("Read by the language", &read),
    );
    let all = own.into_iter().chain(common).chain(read).collect::<Vec<_>>();
    let params: Vec<&str> = class.params.iter().map(|param| param.name).collect();
    Page {
        summary: summary(class.doc),
        section: kind.to_owned(),
        words: format!("{} {}", params.join(" "), class.doc.trim()),
        name: file,
        title,
        body,
        picture: drawn.first().map(Shown::file),
        parts: all.into_iter().map(|row| part(&title_of(entry), row)).collect(),
    }
}

/// A manual with its pictures: the first stands above it, each other one above what it is of.
fn illustrated(doc: &str, drawn: &[Shown<'_>]) -> String {
    let of = |number| drawn.iter().find(|shown| shown.number == number).map(figure);
    let mut parts = doc.split(SNIPPET);
    let mut page = of(0).unwrap_or_default();
    page += &markdown::html(parts.next().unwrap_or_default());
    for (number, part) in parts.enumerate() {
        page.extend(of(number).filter(|_| number > 0));
        page += &markdown::html(&format!("{SNIPPET}{part}"));
    }
    page
}

/// What a class is called.
fn title_of(entry: &Entry) -> String {
    format!("{} {}", entry.class.kind.word(), entry.class.name)
}

/// A parameter or field of something, to be found by its name.
fn part(of: &str, [name, facts, doc]: [String; 3]) -> Part {
    Part { anchor: name.clone(), title: format!("{name} · {of}"), words: format!("{facts} {doc}") }
}

/// The picture of what a manual shows, and for which files others stand in it.
fn figure(drawn: &Shown<'_>) -> String {
    let stand_ins = drawn.stand_ins();
    let told = stand_ins.iter().map(|name| {
        format!(
            "<figcaption>In the picture, a file that this program made stands for <code>{}</code>.</figcaption>\n",
            escaped(name)
        )
    });
    format!(
        "<figure><img src=\"{}\" alt=\"What the scene below shows\">\n{}</figure>\n",
        drawn.file(),
        told.collect::<String>(),
    )
}

/// The manual of a word of the language that names no class.
pub(super) fn word(word: &Word, drawn: Option<&Shown<'_>>) -> Page {
    let (text, example) = word.parts();
    let body = format!(
        "<h1>{}</h1>\n<p class=\"origin\">language</p>\n{}{}<pre><code>{}</code></pre>\n{}",
        word.name,
        drawn.map_or(String::new(), figure),
        markdown::html(text),
        escaped(example),
        table("Fields", &fields(word.fields)),
    );
    Page {
        name: word.name.to_owned(),
        title: word.name.to_owned(),
        section: GUIDE.to_owned(),
        summary: summary(word.doc),
        words: text.to_owned(),
        body,
        picture: drawn.map(Shown::file),
        parts: fields(word.fields).into_iter().map(|row| part(word.name, row)).collect(),
    }
}

/// Every message, by its code.
pub(super) fn messages() -> Page {
    let part = |(code, title): &(&str, &str)| Part {
        anchor: (*code).to_owned(),
        title: format!("{code} {title}"),
        words: String::new(),
    };
    let sections: String = CATALOGUE.iter().map(|(code, title)| message(code, title)).collect();
    Page {
        name: "messages".to_owned(),
        title: "Messages".to_owned(),
        section: GUIDE.to_owned(),
        summary: "What each code of a message means, and the mend.".to_owned(),
        words: String::new(),
        body: format!("<h1>Messages</h1>\n{sections}"),
        picture: None,
        parts: CATALOGUE.iter().map(part).collect(),
    }
}

/// What a code means, a scene that tells it, and the mend.
fn message(code: &str, title: &str) -> String {
    let mut out =
        format!("<h2 id=\"{code}\"><code>{code}</code> {}</h2>\n", markdown::inline(title));
    let Some(page) = page(code) else { return out };
    out += &markdown::html(page.meaning);
    let Example { wrong, mend, right } = page.example;
    let block = |scene: &str| format!("<pre><code>{}</code></pre>\n", escaped(scene.trim()));
    out.extend([block(wrong), markdown::html(mend), block(right)]);
    out
}

/// Name, facts and manual of parameters.
fn rows(params: &[Param]) -> Vec<[String; 3]> {
    let row = |param: &Param| {
        [param.name.to_owned(), facts(param, params).join(", "), param.doc.trim().to_owned()]
    };
    params.iter().map(row).collect()
}

fn fields(fields: &[Field]) -> Vec<[String; 3]> {
    fields.iter().map(|(name, facts, doc)| [*name, *facts, *doc].map(str::to_owned)).collect()
}

fn table(title: &str, rows: &[[String; 3]]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let row = |[name, facts, doc]: &[String; 3]| {
        format!(
            "<tr id=\"{name}\"><td><code>{name}</code></td><td>{}<br><span class=\"facts\">{}</span></td></tr>\n",
            markdown::inline(doc),
            escaped(facts),
        )
    };
    let rows: String = rows.iter().map(row).collect();
    format!("<h2>{title}</h2>\n<table>\n{rows}</table>\n")
}
