//! The pages of the codes that messages have, as `luxel explain E0402` tells them.

use std::path::Path;

use luxel_lang::{Example, Page, page};
use serde_json::json;

use crate::exit::{Exit, Failure};

/// The page that is meant, if what was given is no file but looks like a code.
///
/// # Errors
/// A code that no message has.
pub(crate) fn asked(given: &Path) -> Result<Option<Page>, Failure> {
    let word = given.to_str().unwrap_or_default().to_uppercase();
    let digits = word.strip_prefix('E').unwrap_or(&word);
    if !(3..=4).contains(&digits.len())
        || !digits.bytes().all(|byte| byte.is_ascii_digit())
        || given.exists()
    {
        return Ok(None);
    }
    let word = format!("E{digits:0>4}");
    let unknown = || Failure::new(Exit::Input, format!("no message has the code {word}"));
    page(&word).map(Some).ok_or_else(unknown)
}

/// The page for a terminal of a hundred columns.
pub(crate) fn text(page: &Page) -> String {
    let Page { code, title, meaning, example } = page;
    let Example { wrong, mend, right } = example;
    let (wrong, right) = (indented(wrong), indented(right));
    format!("{code}: {title}\n\n{meaning}\n\n{wrong}\n{mend}\n\n{right}")
}

fn indented(scene: &str) -> String {
    scene.lines().fold(String::new(), |page, line| page + "    " + line + "\n")
}

/// One object: `code, title, meaning, example, mend, mended`.
pub(crate) fn json(page: &Page) -> String {
    let Page { code, title, meaning, example } = page;
    let told = json!({
        "code": code,
        "title": title,
        "meaning": meaning.replace('\n', " ").replace("  ", "\n"),
        "example": example.wrong,
        "mend": example.mend,
        "mended": example.right,
    });
    format!("{told}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_told_from_files_and_unknown_ones_are_refused() {
        let found = |word: &str| asked(Path::new(word)).map_err(|failure| failure.message);
        assert_eq!(found("e0402").unwrap().map(|page| page.title), Some("an unknown parameter"));
        for word in ["E402", "402", "0402"] {
            assert_eq!(found(word).unwrap().map(|page| page.code), Some("E0402"), "{word}");
        }
        assert_eq!(found("E9999"), Err("no message has the code E9999".to_owned()));
        for file in ["a.scene", "E0402.scene", "E04", "fog", "E040é"] {
            assert_eq!(found(file), Ok(None), "{file}");
        }
    }

    #[test]
    fn a_page_fits_a_hundred_columns_and_its_json_has_paragraphs_as_lines() {
        for (code, _) in luxel_lang::CATALOGUE {
            let page = page(code).unwrap();
            let lines = text(&page);
            assert!(lines.lines().all(|line| line.chars().count() <= 104), "{code}");
            assert!(lines.starts_with(&format!("{code}: {}\n\n", page.title)), "{lines}");
        }
        let told: serde_json::Value = serde_json::from_str(&json(&page("E0421").unwrap())).unwrap();
        assert!(told["meaning"].as_str().unwrap().contains("finds it.\nIn the example"), "{told}");
        let scenes = ["example", "mended"].map(|name| told[name].as_str().unwrap());
        assert!(scenes.iter().all(|scene| scene.starts_with("scene 1\n")), "{told}");
        assert!(told["mend"].as_str().unwrap().ends_with("(E0401)."), "{told}");
    }
}
