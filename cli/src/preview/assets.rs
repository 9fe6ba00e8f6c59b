//! The page's files, which are part of the program. Each is asked for with the token, which is
//! written into the addresses by which they name one another.

use axum::body::Bytes;

const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";

macro_rules! script {
    ($name:literal) => {
        (concat!("/", $name, ".js"), SCRIPT, include_str!(concat!("page/", $name, ".js")))
    };
}

/// Path, type and text of each file.
const FILES: [(&str, &str, &str); 17] = [
    ("/", HTML, include_str!("page/index.html")),
    ("/page.css", CSS, include_str!("page/page.css")),
    script!("bar"),
    script!("camera"),
    script!("copy"),
    script!("flat"),
    script!("gl"),
    script!("keys"),
    script!("main"),
    script!("maps"),
    script!("pan"),
    script!("panels"),
    script!("params"),
    script!("picture"),
    script!("shade"),
    script!("shader"),
    script!("wire"),
];

/// A file as it is sent.
#[derive(Clone)]
pub(super) struct Asset {
    pub(super) path: &'static str,
    pub(super) kind: &'static str,
    pub(super) body: Bytes,
}

/// Every file, with the token where one names another.
pub(super) fn assets(token: &str) -> Vec<Asset> {
    let asset = |&(path, kind, text): &(&'static str, &'static str, &str)| {
        let body = [".js\"", ".css\""].iter().fold(text.to_owned(), |text, end| {
            let name = end.trim_end_matches('"');
            text.replace(end, &format!("{name}?token={token}\""))
        });
        Asset { path, kind, body: body.into() }
    };
    FILES.iter().map(asset).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_file_that_a_file_names_is_there_and_asked_for_with_the_token() {
        let assets = assets("abc");
        let mut named = 0;
        for asset in &assets {
            let text = std::str::from_utf8(&asset.body).unwrap();
            for part in text.split("\"./").skip(1) {
                let (address, _) = part.split_once('"').unwrap();
                let (path, query) = address.split_once('?').expect(address);
                assert_eq!(query, "token=abc", "{address} in {}", asset.path);
                assert!(assets.iter().any(|a| a.path[1..] == *path), "{path} in {}", asset.path);
                named += 1;
            }
        }
        assert!(named >= FILES.len() - 1, "{named}");
    }

    #[test]
    fn the_page_names_no_other_place() {
        for (path, _, text) in FILES {
            let known = "http://www.w3.org/2000/svg";
            let text = text.replace(known, "");
            assert!(!text.contains("http://") && !text.contains("https://"), "{path}");
        }
    }
}
