//! `luxel docs` and `luxel describe` as a person meets them.

use super::program::Folder;

#[test]
fn the_reference_has_a_page_for_each_class_and_every_link_leads_somewhere() {
    let folder = Folder::new("docs");
    let done = folder.luxel(&["docs", "-o", "out", "--no-pictures", "--json"]);
    assert_eq!((done.code, &*done.err), (0, ""), "{done:?}");
    let told: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    assert_eq!(told["broken"].as_array().map(Vec::len), Some(0));
    let page = |name: &str| String::from_utf8(folder.read(&format!("out/{name}"))).unwrap();
    let sphere = page("shape-sphere.html");
    assert!(sphere.contains("<h1>shape sphere</h1>") && sphere.contains("<tr id=\"radius\">"));
    assert!(page("language.html").contains("<h2 id=\"objects\">"));
    assert!(page("search.js").contains("\"title\":\"material conductor\""));
    let search = page("search.js");
    // Parameters and headings are found too, and what stands under a heading.
    assert!(search.contains("\"page\":\"shape-sphere.html#radius\""));
    let laid_out = search
        .split("{\"page\":")
        .find(|it| it.starts_with("\"language.html#how-scenes-are-laid-out"));
    assert!(laid_out.is_some_and(|it| it.contains("luxel fmt")), "{laid_out:?}");
    for text in [page("functions.html"), page("index.html")] {
        assert!(text.contains("href=\"functions.html\""));
    }
    for function in luxel_lang::manual::functions() {
        let name = function.name;
        assert!(page("functions.html").contains(&format!("<h3 id=\"{name}\">")), "{name}");
        assert!(search.contains(&format!("\"page\":\"functions.html#{name}\"")), "{name}");
    }
    let listed = folder.luxel(&["list", "--json"]).out;
    let listed: serde_json::Value = serde_json::from_str(&listed).unwrap();
    let index = page("index.html");
    for class in listed.as_array().unwrap() {
        let [kind, name] = ["kind", "name"].map(|field| class[field].as_str().unwrap_or_default());
        let file = if name.is_empty() { kind.to_owned() } else { format!("{kind}-{name}") };
        assert!(index.contains(&format!("href=\"{file}.html\"")), "{file}");
    }
}

#[test]
fn a_function_is_described_and_has_no_kinds() {
    let folder = Folder::new("describe");
    let done = folder.luxel(&["describe", "look_at"]);
    assert_eq!((done.code, &*done.err), (0, ""), "{done:?}");
    assert!(done.out.starts_with("look_at(from, to, up) (language: "), "{}", done.out);
    let done = folder.luxel(&["describe", "spectrum.file", "--json"]);
    let told: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    assert_eq!(told["example"], "spectrum.file(\"leaf.csv\", column = \"upper\")");
    for (word, near) in [("glas", "glass"), ("shap", "shape")] {
        let done = folder.luxel(&["describe", word]);
        assert!(done.err.contains(&format!("did you mean `{near}`?")), "{done:?}");
        assert_eq!(done.code, 1);
    }
    for word in ["sin", "group"] {
        let done = folder.luxel(&["describe", word, "big"]);
        let message = format!("`{word}` has no kinds: there is no `big`");
        assert!(done.code == 1 && done.err.contains(&message), "{done:?}");
        assert!(done.err.contains(&format!("luxel describe {word}")), "{done:?}");
    }
}

#[cfg(unix)]
#[test]
fn what_a_library_of_others_brings_has_its_page_and_is_found() {
    let folder = Folder::new("docs-library");
    super::faulty::build(&folder, super::faulty::NOTHING);
    let docs = [&["docs", "-o", "out", "--no-pictures"][..], &super::faulty::OPEN].concat();
    let done = folder.luxel(&docs);
    assert_eq!(done.code, 0, "{done:?}");
    let page = |name: &str| String::from_utf8(folder.read(&format!("out/{name}"))).unwrap();
    let faulty = page("material-faulty.html");
    for part in ["<h1>material faulty</h1>", "Goes wrong.", "<tr id=\"reflectance\">", "0.1.0"] {
        assert!(faulty.contains(part), "{part} in {faulty}");
    }
    assert!(page("index.html").contains("href=\"material-faulty.html\""));
    assert!(page("search.js").contains("\"title\":\"material faulty\""));
}
