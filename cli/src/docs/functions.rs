//! The page of the functions and constants that every scene has.

use luxel_lang::manual::{Function, functions};

use super::markdown::{self, Part, escaped};
use super::page::{GUIDE, Page};

/// Each with its use, its manual and an example, by what it is about.
pub(super) fn page() -> Page {
    let all: Vec<Function> = functions().collect();
    let summary = "The functions and constants that every scene has.";
    let shadowed = "A definition in a scene takes the place of one of its name.";
    let mut body = format!("<h1>Functions</h1>\n<p>{summary} {shadowed}</p>\n");
    for alike in all.chunk_by(|a, b| a.subject == b.subject) {
        body += &markdown::html(&format!("## {}\n", alike[0].subject));
        let links = alike.iter().map(|it| format!("<a href=\"#{0}\">{0}</a>\n", it.name));
        body.extend(["<p>".to_owned(), links.collect(), "</p>\n".to_owned()]);
        body.extend(alike.iter().map(section));
    }
    Page {
        name: "functions".to_owned(),
        title: "Functions".to_owned(),
        section: GUIDE.to_owned(),
        summary: summary.to_owned(),
        words: String::new(),
        body,
        picture: None,
        parts: all.iter().map(part).collect(),
    }
}

fn section(function: &Function) -> String {
    format!(
        "<h3 id=\"{}\"><code>{}</code></h3>\n{}",
        function.name,
        escaped(&function.usage),
        markdown::html(&function.text()),
    )
}

fn part(function: &Function) -> Part {
    Part {
        anchor: function.name.to_owned(),
        title: function.name.to_owned(),
        words: format!("{} {}", function.subject, function.doc),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_is_on_the_page_with_its_use_its_manual_and_its_example() {
        let page = page();
        for function in functions() {
            let section = section(&function);
            assert!(page.body.contains(&section), "{function:?}");
            assert!(page.body.contains(&format!("href=\"#{}\"", function.name)), "{function:?}");
            assert!(section.contains(&escaped(&function.usage)), "{section}");
            assert!(section.contains(&escaped(function.example)), "{section}");
            assert!(page.parts.iter().any(|part| part.anchor == function.name), "{function:?}");
        }
        let subjects = page.body.matches("<h2 id=").count();
        assert_eq!(subjects, 5, "those of one subject stand together");
    }
}
