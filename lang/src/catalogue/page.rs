//! The pages of the catalogue: what a mistake means, a scene that makes it, and the mend.

use super::CATALOGUE;

/// What is said of one code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Page {
    /// `E0402`.
    pub code: &'static str,
    /// The mistake in a few words.
    pub title: &'static str,
    /// What it means and where it comes from, in paragraphs.
    pub meaning: &'static str,
    /// A scene that tells it, with what mends it.
    pub example: Example,
}

/// A scene with a mistake and the same without. A line `// file: name` begins another file beside it,
/// `// set: a=b` stands for `--set a=b`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Example {
    /// With the mistake.
    pub wrong: &'static str,
    /// What mends it, in words.
    pub mend: &'static str,
    /// Without the mistake.
    pub right: &'static str,
}

const GROUPS: [&str; 5] = [
    include_str!("text.md"),
    include_str!("names.md"),
    include_str!("units.md"),
    include_str!("objects.md"),
    include_str!("limits.md"),
];

/// The page of a code, `None` if no message has it.
pub fn page(code: &str) -> Option<Page> {
    let (code, title) = CATALOGUE.iter().copied().find(|(known, _)| *known == code)?;
    let mut sections = GROUPS.into_iter().flat_map(|group| group.split("\n# "));
    let text = sections.find_map(|section| section.strip_prefix(code))?;
    Some(Page {
        code,
        title,
        meaning: text.split("```").next().unwrap_or_default().trim(),
        example: example(text)?,
    })
}

/// What stands in the two blocks of a page and between them.
fn example(text: &'static str) -> Option<Example> {
    let mut parts = text.split("```");
    let scene = |part: &'static str| part.strip_prefix("scene\n");
    let wrong = parts.nth(1).and_then(scene)?;
    let mend = parts.next()?.trim();
    Some(Example { wrong, mend, right: parts.next().and_then(scene)? })
}

/// The files of an example, and how they are loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setup {
    /// Names and texts; the scene is the first, `example.scene`.
    pub files: Vec<(&'static str, String)>,
    /// What is set on the command line.
    pub set: Vec<(String, String)>,
}

/// What one scene of an example stands for.
pub fn setup(scene: &'static str) -> Setup {
    let (mut files, mut set) = (vec![("example.scene", String::new())], vec![]);
    for line in scene.lines() {
        if let Some(name) = line.strip_prefix("// file: ") {
            files.push((name, String::new()));
        } else if let Some((name, value)) =
            line.strip_prefix("// set: ").and_then(|given| given.split_once('='))
        {
            set.push((name.to_owned(), value.to_owned()));
        } else if let Some((_, text)) = files.last_mut() {
            text.extend([line, "\n"]);
        }
    }
    Setup { files, set }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_has_a_page_and_every_page_a_code() {
        let sections: usize = GROUPS.iter().map(|group| group.matches("\n# ").count()).sum();
        assert_eq!(sections, CATALOGUE.len());
        for (code, _) in CATALOGUE {
            let page = page(code).unwrap_or_else(|| panic!("{code} has no page"));
            assert!(page.meaning.len() > 40 && page.meaning.ends_with('.'), "{code}");
            let Example { wrong, mend, right } = page.example;
            assert!(mend.ends_with('.') && wrong != right, "{code}");
        }
        assert_eq!(page("E9999"), None);
    }

    #[test]
    fn files_and_settings_stand_beside_a_scene() {
        let Setup { files, set } = setup("scene 1\n// set: a=b=c\n// file: x\ny\n");
        assert_eq!(files, [("example.scene", "scene 1\n".into()), ("x", "y\n".into())]);
        assert_eq!(set, [("a".to_owned(), "b=c".to_owned())]);
    }
}
