//! `luxel lsp` as an editor hears it.

mod client;
mod protocol;

use serde_json::{Value, json};

use self::client::{Client, at, codes, span, uri};
use super::program::{Folder, SCENE};

/// The scene with a named material, whose lines and columns the tests count.
fn scene() -> String {
    format!("{SCENE}let grey = material diffuse {{ reflectance = 0.5 }}\n")
}

/// Its last line.
const LINE: u64 = 9;

fn params(uri: &str, position: Value) -> Value {
    let mut out = json!({ "textDocument": { "uri": uri } });
    out["position"] = position;
    out
}

#[test]
fn mistakes_are_told_as_they_are_typed_and_taken_back() {
    let folder = Folder::new("lsp-typed");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    let told = client.open(&uri, &scene());
    assert_eq!((codes(&told), &told["version"]), (vec![], &json!(1)));
    // A name that nothing defines, in columns of UTF-16: `é𝄞` takes three.
    let told = client.edit(&uri, 2, span(LINE, 0, 0), "let t = \"é𝄞\" + gld\n");
    assert_eq!((codes(&told), &told["version"]), (vec!["E0101"], &json!(2)));
    assert_eq!(told["diagnostics"][0]["range"], span(LINE, 16, 19));
    assert_eq!(told["diagnostics"][0]["severity"], 1);
    let told = client.edit(&uri, 3, span(LINE, 13, 19), "");
    assert_eq!(codes(&told), Vec::<&str>::new());
    // What only evaluation finds is told after a pause.
    let told = client.edit(&uri, 4, span(LINE, 0, 13), "shape sphere { radius = 5 }");
    assert_eq!(codes(&told), Vec::<&str>::new());
    let told = client.until(&uri, &["E0201"]);
    assert_eq!(told["version"], 4);
    // An edit elsewhere moves it; one that mends it takes it back at once.
    let told = client.edit(&uri, 5, span(0, 7, 7), "\n// a line\n");
    assert_eq!(told["diagnostics"][0]["range"], span(LINE + 2, 24, 25));
    let told = client.edit(&uri, 6, span(LINE + 2, 25, 25), " cm");
    assert_eq!(codes(&told), Vec::<&str>::new());
}

#[test]
fn more_mistakes_than_are_shown_are_forgotten_once_they_are_mended() {
    let folder = Folder::new("lsp-many");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    let uses = "shape sphere { radius = big }\n".repeat(150);
    let told = client.open(&uri, &format!("{}let bigg = 1 m\n{uses}", scene()));
    assert_eq!(codes(&told).iter().filter(|code| **code == "E0508").count(), 1);
    // Once more after the scene has been evaluated.
    client.told(&uri);
    let line = scene().lines().count() as u64;
    let told = client.edit(&uri, 2, span(line, 4, 8), "big");
    assert_eq!(codes(&told), Vec::<&str>::new());
}

#[test]
fn mistakes_of_included_files_are_told_of_them_and_open_ones_are_read() {
    let folder = Folder::new("lsp in 100%")
        .with("lib a.scene", "scene 1\nshape sphere { radus = 1 m }\n")
        .with("a.scene", "");
    let (mut client, main, lib) =
        (Client::new(&folder), uri(&folder, "a.scene"), uri(&folder, "lib a.scene"));
    client.open(&main, &format!("{SCENE}include \"lib a.scene\"\n"));
    let told = client.until(&lib, &["E0402"]);
    assert_eq!(told.get("version"), None, "it is not open");
    let told = client.open(&lib, "scene 1\nshape sphere { radius = 1 m }\n");
    assert_eq!(told["version"], 1);
    client.until(&lib, &[]);
    let found = client.ask("textDocument/definition", params(&main, at(9, 12))).unwrap();
    assert_eq!(found["uri"], lib.as_str());
}

#[test]
fn a_file_that_no_other_reads_any_more_is_a_scene_of_its_own() {
    let folder = Folder::new("lsp-own");
    let (mut client, main, lib) =
        (Client::new(&folder), uri(&folder, "a.scene"), uri(&folder, "lib.scene"));
    client.open(&main, &format!("{SCENE}include \"lib.scene\"\n"));
    client.open(&lib, "scene 1\nshape sphere { radius = 5 }\n");
    client.until(&lib, &["E0201"]);
    client.edit(&main, 2, json!({ "start": at(9, 0), "end": at(10, 0) }), "");
    assert_eq!(codes(&client.told(&lib)), ["E0201", "E0409"]);
}

#[test]
fn a_missing_picture_is_told_until_it_is_looked_for_again() {
    let folder = Folder::new("lsp-whole");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    let image = "let t = texture image { file = \"none.png\" }\n";
    let used = "shape sphere { radius = 1 m, material = material diffuse { reflectance = t } }\n";
    client.open(&uri, &format!("{SCENE}{image}{used}"));
    let told = client.told(&uri);
    let missing = codes(&told);
    assert_eq!(missing.len(), 1, "{told}");
    client.edit(&uri, 2, span(0, 7, 7), "\nshape sphere { radius = 5 }\n");
    let both = [vec!["E0201"], missing].concat();
    let told = client.until(&uri, &both);
    assert_eq!(told["diagnostics"][1]["range"]["start"]["line"], 11);
}

#[test]
fn a_file_that_is_no_text_is_told_of_at_its_start() {
    let folder = Folder::new("lsp-bytes");
    folder.write_bytes("lib.scene", b"scene 1\n\xff\n");
    let (mut client, main, lib) =
        (Client::new(&folder), uri(&folder, "a.scene"), uri(&folder, "lib.scene"));
    client.open(&main, &format!("{SCENE}include \"lib.scene\"\n"));
    let told = client.until(&lib, &["E0003"]);
    assert_eq!(told["diagnostics"][0]["range"], span(0, 0, 0));
}

#[test]
fn services_answer_where_they_are_asked() {
    let folder = Folder::new("lsp-services");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    let text = format!("{}shape sphere \"b\" {{\n  radius = 1 m\n  material = grey\n}}\n", scene());
    client.open(&uri, &text);
    let place = params(&uri, at(LINE + 3, 14));
    let found = client.ask("textDocument/definition", place.clone()).unwrap();
    assert_eq!(found, json!({ "uri": uri, "range": span(LINE, 4, 8) }));
    let hover = client.ask("textDocument/hover", params(&uri, at(LINE, 36))).unwrap();
    let words = hover["contents"]["value"].as_str().unwrap();
    assert!(
        words.contains("reflectance: colour or spectrum") && hover["range"] == span(LINE, 30, 41)
    );
    let mut asked = place.clone();
    asked["context"] = json!({ "includeDeclaration": false });
    let found = client.ask("textDocument/references", asked).unwrap();
    assert_eq!(found, json!([{ "uri": uri, "range": span(LINE + 3, 13, 17) }]));
    let mut asked = place.clone();
    asked["newName"] = json!("gray");
    let edits = client.ask("textDocument/rename", asked.clone()).unwrap();
    assert_eq!(edits["changes"][&uri].as_array().unwrap().len(), 2);
    asked["newName"] = json!("m");
    assert_eq!(client.ask("textDocument/rename", asked).unwrap_err().0, -32803);
    let list = client.ask("textDocument/completion", params(&uri, at(LINE + 3, 13))).unwrap();
    let labels: Vec<_> = list["items"].as_array().unwrap().iter().map(|i| &i["label"]).collect();
    assert_eq!(labels, ["grey", "material"]);
    let document = json!({ "textDocument": { "uri": uri } });
    let symbols = client.ask("textDocument/documentSymbol", document.clone()).unwrap();
    let names: Vec<_> = symbols.as_array().unwrap().iter().map(|s| &s["name"]).collect();
    assert_eq!(names.last().unwrap(), &"b");
    let folds = client.ask("textDocument/foldingRange", document.clone()).unwrap();
    assert_eq!(folds[1], json!({ "startLine": LINE + 1, "endLine": LINE + 3 }));
    let tokens = client.ask("textDocument/semanticTokens/full", document).unwrap();
    let data = tokens["data"].as_array().unwrap();
    assert_eq!(
        (&data[..5], data.len() % 5),
        (&[json!(0), json!(0), json!(5), json!(0), json!(0)][..], 0)
    );
}

#[test]
fn a_mend_is_offered_and_a_colour_is_shown() {
    let folder = Folder::new("lsp-mends");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    client.open(&uri, "scene 1\nlet gold = rgb.srgb(1, 0.5, 0)\nlet b = gld\n");
    let asked = json!({
        "textDocument": { "uri": uri },
        "range": span(2, 8, 8),
        "context": { "diagnostics": [], "only": ["quickfix"] },
    });
    let found = client.ask("textDocument/codeAction", asked).unwrap();
    assert_eq!(found[0]["title"], "replace `gld` by `gold`");
    assert_eq!(
        found[0]["edit"]["changes"][&uri],
        json!([{ "range": span(2, 8, 11), "newText": "gold" }])
    );
    assert_eq!(found[0]["isPreferred"], true);
    // Another is the only one too, but a guess.
    let guessed = client::uri(&folder, "b.scene");
    client.open(&guessed, "scene\n");
    let asked =
        json!({ "textDocument": { "uri": guessed }, "range": span(0, 0, 0), "context": {} });
    let found = client.ask("textDocument/codeAction", asked).unwrap();
    assert_eq!(
        (&found[0]["title"], &found[0]["isPreferred"]),
        (&json!("insert `1`"), &json!(false))
    );
    let document = json!({ "textDocument": { "uri": uri } });
    let colours = client.ask("textDocument/documentColor", document).unwrap();
    assert_eq!(
        (&colours[0]["range"], &colours[0]["color"]["red"]),
        (&span(1, 11, 30), &json!(1.0))
    );
    let mut asked = json!({ "textDocument": { "uri": uri }, "range": span(1, 11, 30) });
    asked["color"] = json!({ "red": 1.0, "green": 0.0, "blue": 0.25, "alpha": 1.0 });
    let forms = client.ask("textDocument/colorPresentation", asked.clone()).unwrap();
    assert_eq!(forms, json!([{ "label": "rgb.srgb(1, 0, 0.25)" }]));
    // What is no colour of numbers is not written over.
    asked["range"] = span(2, 8, 11);
    assert_eq!(client.ask("textDocument/colorPresentation", asked.clone()), Ok(json!([])));
    asked["range"] = Value::Null;
    assert_eq!(client.ask("textDocument/colorPresentation", asked).unwrap_err().0, -32602);
}

/// What is told of a place, once the file has been evaluated.
fn told(client: &mut Client, uri: &str, place: Value) -> String {
    let hover = client.ask("textDocument/hover", params(uri, place)).unwrap();
    hover["contents"]["value"].as_str().unwrap_or_default().to_owned()
}

#[test]
fn values_of_an_evaluation_are_told_in_units_that_people_say() {
    let folder = Folder::new("lsp-values").with("pic.png", "four");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    let lines = "let v = (0.1 + 0.2, 0, 1) * 1 cm\nlet w = v.x\nlet t = 3000 K\n\
                 light point { spectrum = blackbody(t), power = 1 W }\n\
                 for i, x in [1, 2] { shape sphere { radius = x * 1 mm } }\n\
                 let p = texture image { file = \"pic.png\" }\n";
    client.open(&uri, &format!("{SCENE}{lines}"));
    // What evaluation finds is told after what is told at once.
    client.told(&uri);
    let mut has = |line: u64, column: u64, words: &str| {
        let found = told(&mut client, &uri, at(LINE + line, column));
        assert!(found.contains(words), "{words} in {found}");
    };
    has(0, 4, "value: (0.3, 0, 1) cm = (0.003, 0, 0.01) m");
    has(1, 10, "value: 3 mm = 0.003 m");
    has(3, 27, "█");
    has(4, 4, "one of: 0..2");
    has(4, 7, "one of: [1, 2]");
    has(4, 37, "value: 1 mm = 0.001 m");
    has(5, 36, "pic.png`, 4 bytes");
}

#[test]
fn files_are_offered_where_a_path_is_written() {
    let folder = Folder::new("lsp-paths").with("sub/l$0.scene", "").with("sub/x.txt", "");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    client.open(&uri, "scene 1\ninclude \"sub/l\"\n");
    let list = client.ask("textDocument/completion", params(&uri, at(1, 14))).unwrap();
    let items = list["items"].as_array().unwrap();
    assert_eq!((items.len(), &items[0]["label"]), (1, &json!("l$0.scene")));
    let edit = json!({ "range": span(1, 13, 14), "newText": "l$0.scene" });
    assert_eq!(items[0]["textEdit"], edit);
}

/// The labels that are offered at a place.
fn offered(client: &mut Client, uri: &str, place: Value) -> Vec<String> {
    let list = client.ask("textDocument/completion", params(uri, place)).unwrap();
    let items = list["items"].as_array().unwrap();
    items.iter().map(|item| item["label"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn files_that_a_parameter_does_not_read_are_not_offered() {
    let mut folder = Folder::new("lsp-formats").with("sub/x", "");
    for name in ["a.png", "B.JPG", "c.exr", "d.obj", "e.ply", "f.glb", "g.txt", "h.scene"] {
        folder = folder.with(name, "");
    }
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    let text = "scene 1\nlet a = texture image { file = \"\" }\nshape mesh { file = \"\" }\n\
                let b = asset gltf { file = \"\" }\nshape heightfield { file = \"\" }\n";
    client.open(&uri, text);
    let pictures = ["B.JPG", "a.png", "c.exr", "sub/"];
    assert_eq!(offered(&mut client, &uri, at(1, 32)), pictures);
    assert_eq!(offered(&mut client, &uri, at(2, 21)), ["d.obj", "e.ply", "sub/"]);
    assert_eq!(offered(&mut client, &uri, at(3, 29)), ["f.glb", "sub/"]);
    assert_eq!(offered(&mut client, &uri, at(4, 28)), pictures);
}

#[test]
fn libraries_that_are_not_loaded_are_offered_too() {
    let folder = Folder::new("lsp-libraries");
    let name =
        format!("plugins/{}felt{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    folder.write(&name, "no library");
    let mut client =
        Client::ready(Client::raw_with(&folder, &["--plugin-dir", "plugins"]), &folder);
    let uri = uri(&folder, "a.scene");
    client.open(&uri, "scene 1\nuse plugin \"\"\n");
    let list = client.ask("textDocument/completion", params(&uri, at(1, 12))).unwrap();
    let items = list["items"].as_array().unwrap();
    let found = (items.len(), &items[0]["label"], &items[0]["detail"]);
    assert_eq!(found, (1, &json!("felt"), &json!("not trusted")));
}

#[test]
fn a_file_is_laid_out_by_the_lines_that_change() {
    let folder = Folder::new("lsp-format");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    client.open(&uri, "scene 1\nlet a = 1\nlet   b=2\nlet c = 3\n");
    let document = json!({ "textDocument": { "uri": uri }, "options": {} });
    let edits = client.ask("textDocument/formatting", document.clone()).unwrap();
    let range = json!({ "start": at(2, 0), "end": at(3, 0) });
    assert_eq!(edits, json!([{ "range": range, "newText": "let b = 2\n" }]));
    client.edit(&uri, 2, range, "let b = 2\n");
    assert_eq!(client.ask("textDocument/formatting", document.clone()), Ok(json!([])));
    client.edit(&uri, 3, span(2, 8, 9), "");
    assert_eq!(client.ask("textDocument/formatting", document).unwrap_err().0, -32803);
}

/// A scene of which statements are kept, since it is long enough.
fn large() -> String {
    let more =
        "shape sphere { center = (1.5, 0, 0) m, radius = r, material = grey }\n".repeat(4000);
    format!("{}let r = 5 cm\nfn pair(x: float) {{ let d = 2 * x }}\n{more}", scene())
}

/// The value that is told of a place.
fn value(client: &mut Client, uri: &str, place: Value) -> String {
    let hover = client.ask("textDocument/hover", params(uri, place)).unwrap();
    let text = hover["contents"]["value"].as_str().unwrap_or_default();
    let value = text.split("\n\n").find_map(|part| part.strip_prefix("value: "));
    value.unwrap_or_default().to_owned()
}

#[test]
fn values_are_those_of_the_text_after_each_edit_of_a_large_file() {
    let folder = Folder::new("lsp-values");
    let (mut client, uri) = (Client::new(&folder), uri(&folder, "a.scene"));
    client.open(&uri, &large());
    client.told(&uri);
    let (r, first, far) = (LINE + 1, LINE + 3, LINE + 3003);
    assert_eq!(value(&mut client, &uri, at(far, 16)), "(1.5, 0, 0) m");
    // Another one in its statement; those behind it move.
    client.edit(&uri, 2, span(first, 25, 28), "22.25");
    client.told(&uri);
    assert_eq!(value(&mut client, &uri, at(first, 16)), "(22.25, 0, 0) m");
    assert_eq!(value(&mut client, &uri, at(far, 16)), "(1.5, 0, 0) m");
    // A mistake: what else is in the statement is known, and so is all else.
    client.edit(&uri, 3, span(first, 25, 30), "7 deg");
    let told = client.until(&uri, &["E0203"]);
    assert_eq!(told["diagnostics"][0]["range"]["start"]["line"], first);
    assert_eq!(value(&mut client, &uri, at(first, 44)), "5 cm = 0.05 m");
    assert_eq!(value(&mut client, &uri, at(far, 16)), "(1.5, 0, 0) m");
    // A line before it, and its mend; the name that all use; a function that is used first.
    client.edit(&uri, 4, span(first, 25, 30), "3");
    assert_eq!(codes(&client.told(&uri)), Vec::<&str>::new());
    client.edit(&uri, 5, span(r, 8, 9), "8");
    client.told(&uri);
    assert_eq!(value(&mut client, &uri, at(r, 4)), "8 cm = 0.08 m");
    assert_eq!(value(&mut client, &uri, at(far, 42)), "8 cm = 0.08 m");
    client.edit(&uri, 6, span(first, 0, 0), "pair(3)\npair(4)\n");
    client.told(&uri);
    assert_eq!(value(&mut client, &uri, at(r + 1, 25)), "6");
    client.edit(&uri, 7, json!({ "start": at(first, 0), "end": at(first + 1, 0) }), "");
    client.told(&uri);
    assert_eq!(value(&mut client, &uri, at(r + 1, 25)), "8");
    assert_eq!(value(&mut client, &uri, at(far + 1, 16)), "(1.5, 0, 0) m");
}
