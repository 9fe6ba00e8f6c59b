//! Manuals and documents are written in Markdown; pages are HTML.

use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd, html as render};

use super::DOCUMENTS;

/// What stands under a heading of a page.
pub(super) struct Part {
    pub(super) anchor: String,
    pub(super) title: String,
    /// Words that it is found by, beside its title.
    pub(super) words: String,
}

/// The HTML of a text: headings can be linked to, links lead to pages of this reference or are left out,
/// and HTML within it is text.
pub(super) fn html(text: &str) -> String {
    let mut events: Vec<Event<'_>> = Parser::new_ext(text, Options::ENABLE_TABLES).collect();
    name_headings(&mut events);
    let (mut kept_links, mut in_comment) = (vec![], false);
    let events = events.into_iter().filter_map(|event| match event {
        Event::Html(raw) => {
            in_comment |= raw.trim_start().starts_with("<!--");
            let is_left_out = in_comment;
            in_comment &= !raw.contains("-->");
            (!is_left_out).then(|| quoted(&raw))
        }
        Event::InlineHtml(raw) | Event::Text(raw) => Some(quoted(&raw)),
        Event::Code(code) => {
            Some(Event::InlineHtml(format!("<code>{}</code>", escaped(&code)).into()))
        }
        Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
            let to = target(&dest_url);
            kept_links.push(to.is_some());
            to.map(|to| Event::Start(Tag::Link { link_type, dest_url: to.into(), title, id }))
        }
        Event::End(TagEnd::Link) => kept_links.pop()?.then_some(Event::End(TagEnd::Link)),
        // Pictures of the project's documents are not part of the reference.
        Event::Start(Tag::Image { .. }) | Event::End(TagEnd::Image) => None,
        other => Some(other),
    });
    let mut out = String::new();
    render::push_html(&mut out, events);
    out
}

/// Text whose quotes are escaped too, so that none is taken for that of an attribute.
fn quoted(text: &str) -> Event<'static> {
    Event::InlineHtml(escaped(text).into())
}

/// The HTML of one paragraph, without the paragraph.
pub(super) fn inline(text: &str) -> String {
    let out = html(text);
    let out = out.trim();
    out.strip_prefix("<p>").and_then(|it| it.strip_suffix("</p>")).unwrap_or(out).to_owned()
}

/// The headings of a text, with what stands under each up to the next one.
pub(super) fn headings(text: &str) -> Vec<Part> {
    let events: Vec<Event<'_>> = Parser::new_ext(text, Options::ENABLE_TABLES).collect();
    let is_start = |event: &Event<'_>| matches!(event, Event::Start(Tag::Heading { .. }));
    let part = |i: usize| {
        let (title, inside) = (heading(&events[i + 1..]), events[i + 1..].iter());
        let words = inside.take_while(|event| !is_start(event)).filter_map(words);
        Part { anchor: anchor(&title), title, words: words.collect::<Vec<_>>().join(" ") }
    };
    (0..events.len()).filter(|i| is_start(&events[*i])).map(part).collect()
}

/// The text of what is text or code.
fn words<'e>(event: &'e Event<'_>) -> Option<&'e str> {
    match event {
        Event::Text(text) | Event::Code(text) => Some(text),
        _ => None,
    }
}

/// Text as it stands in HTML.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Where a link leads from a page; `None` where it leaves the reference for a file of the project.
fn target(to: &str) -> Option<String> {
    if to.starts_with('#') || to.starts_with("https://") {
        return Some(to.to_owned());
    }
    let (file, anchor) = to.split_once('#').map_or((to, None), |(file, at)| (file, Some(at)));
    let document = file.strip_suffix(".md");
    let is_page = document.is_none_or(|name| DOCUMENTS.iter().any(|(known, _)| *known == name));
    let name = document.or_else(|| file.strip_suffix(".html"))?;
    let anchor = anchor.map_or(String::new(), |at| format!("#{at}"));
    is_page.then(|| format!("{name}.html{anchor}"))
}

/// Gives each heading the name that links call it by: its words, joined by hyphens.
fn name_headings(events: &mut [Event<'_>]) {
    for i in 0..events.len() {
        if !matches!(events[i], Event::Start(Tag::Heading { .. })) {
            continue;
        }
        let name = anchor(&heading(&events[i + 1..]));
        if let Event::Start(Tag::Heading { id, .. }) = &mut events[i] {
            *id = Some(CowStr::from(name));
        }
    }
}

/// What links call a heading by.
fn anchor(title: &str) -> String {
    let title = title.to_lowercase();
    let kept = title.chars().filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

/// The words of the heading that has just begun.
fn heading(events: &[Event<'_>]) -> String {
    let inside = events.iter().take_while(|it| !matches!(it, Event::End(TagEnd::Heading(_))));
    inside.filter_map(words).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_to_pages_or_nowhere_and_html_is_text() {
        let told = html(
            "## What `is` it?\n[a](language.md#units) [b](decisions/0001.md) <b>x</b>\n\n<!-- c -->\n",
        );
        assert_eq!(
            told,
            "<h2 id=\"what-is-it\">What <code>is</code> it?</h2>\n\
             <p><a href=\"language.html#units\">a</a> b &lt;b&gt;x&lt;/b&gt;</p>\n"
        );
        let found = headings("# One\ntext\n## Two `b`\n");
        let found: Vec<_> = found.iter().map(|part| (&*part.anchor, &*part.title)).collect();
        assert_eq!(found, [("one", "One"), ("two-b", "Two b")]);
        let under: Vec<_> =
            headings("# One\na `set`\n## Two\nb\n").into_iter().map(|it| it.words).collect();
        assert_eq!(under, ["One a  set", "Two b"]);
        assert_eq!(inline("a *b* < c"), "a <em>b</em> &lt; c");
        assert_eq!(inline("`id=\"b\"`"), "<code>id=&quot;b&quot;</code>");
        assert_eq!(html("<!--\nto do\n-->\n\nb\n"), "<p>b</p>\n");
    }
}
