//! How a line of a file is opened in an editor: an address of the editor's own scheme, which the
//! page makes a link of.

use std::fmt::Write;
use std::path::{Path, absolute};

/// Schemes that open no editor: they run code, or show what they are given, in the browser.
const REFUSED: [&str; 16] = [
    "javascript",
    "data",
    "vbscript",
    "http",
    "https",
    "ws",
    "wss",
    "ftp",
    "file",
    "blob",
    "about",
    "filesystem",
    "view-source",
    "chrome",
    "resource",
    "intent",
];

/// An address with `{file}`, `{line}` and `{column}` in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Editor(String);

impl Editor {
    /// Reads a template.
    ///
    /// # Errors
    /// Another scheme than an editor's; no `{file}`; what stands in no address.
    pub(crate) fn of(template: &str) -> Result<Self, String> {
        let form = "expected an address as vscode://file/{file}:{line}:{column}";
        let (scheme, rest) = template.split_once("://").ok_or(form)?;
        let known = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "+.-".contains(c);
        if !scheme.starts_with(|c: char| c.is_ascii_lowercase()) || !scheme.chars().all(known) {
            return Err(format!("{form}; `{scheme}` is no scheme"));
        }
        if REFUSED.contains(&scheme) {
            return Err(format!("{form}; `{scheme}` opens no editor"));
        }
        if !rest.contains("{file}") {
            return Err(format!("{form}; `{{file}}` is missing"));
        }
        let odd = |c: char| !c.is_ascii_graphic() || "\"<>\\^`|".contains(c);
        if let Some(odd) = template.chars().find(|c| odd(*c)) {
            return Err(format!("{form}; {odd:?} stands in no address"));
        }
        Ok(Self(template.to_owned()))
    }

    /// The address of a place; none where the file's path cannot be made absolute.
    pub(crate) fn address(&self, file: &Path, line: &str, column: &str) -> Option<String> {
        let path = absolute(file).ok()?;
        let mut path = path.to_str()?.to_owned();
        if cfg!(windows) {
            path = path.replace('\\', "/");
        }
        // `file/{file}`: one of the two slashes is enough, except behind `://`.
        let (before, _) = self.0.split_once("{file}")?;
        if before.ends_with('/') && !before.ends_with("//") {
            path = path.trim_start_matches('/').to_owned();
        }
        // First what cannot stand in an encoded path.
        let address = self.0.replace("{line}", line).replace("{column}", column);
        Some(address.replace("{file}", &encoded(&path)))
    }
}

/// Percent-encoded but for what means nothing in any part of an address, and slashes.
fn encoded(path: &str) -> String {
    let mut out = String::with_capacity(path.len());
    for (i, byte) in path.bytes().enumerate() {
        let drive = cfg!(windows) && byte == b':' && i < 3;
        if byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte) || drive {
            out.push(char::from(byte));
        } else {
            let _ = write!(out, "%{byte:02X}");
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn a_place_becomes_an_address_in_which_the_file_cannot_say_more_than_its_path() {
        let of = |template: &str, file: &str| {
            Editor::of(template).unwrap().address(Path::new(file), "7", "3").unwrap()
        };
        let code = "vscode://file/{file}:{line}:{column}";
        assert_eq!(of(code, "/a/b.scene"), "vscode://file/a/b.scene:7:3");
        let idea = "idea://open?file={file}&line={line}";
        assert_eq!(
            of(idea, "/a/b&line=1#ü .scene"),
            "idea://open?file=/a/b%26line%3D1%23%C3%BC%20.scene&line=7"
        );
        assert_eq!(of("txmt://open?url=file://{file}", "/a"), "txmt://open?url=file:///a");
        assert_eq!(of("e://{file}", "/{line}"), "e:///%7Bline%7D");
    }

    #[test]
    fn only_an_editors_own_scheme_is_taken() {
        for bad in [
            "javascript://{file}",
            "data://{file}",
            "http://127.0.0.1/{file}",
            "file://{file}",
            "JavaScript://{file}",
            "java script://{file}",
            "vscode:{file}",
            "://{file}",
            "1a://{file}",
            "vscode://file/x",
            "vscode://\"{file}",
            "vscode://{file}\n",
            "",
        ] {
            assert!(Editor::of(bad).is_err(), "{bad}");
        }
    }
}
