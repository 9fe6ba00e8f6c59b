//! `luxel check --fix` and the pages of codes, as a person meets them.

use crate::disk::{files_below, root};
use crate::seeded::planted;

use super::program::{Folder, SCENE};

fn text(folder: &Folder, name: &str) -> String {
    String::from_utf8(folder.read(name)).unwrap()
}

#[test]
fn what_is_sure_is_mended_in_the_file_where_it_stands() {
    let wrong = SCENE.replace("radius = 1 m", "radus = 1 m").replace("samples = 4", "samples: 4");
    let folder = Folder::new("fix")
        .with("a.scene", &format!("{wrong}include \"parts/b.scene\"\n"))
        .with("parts/b.scene", "scene 1\nshape sphere { radius 5 cm }\nlet a = (0, 1 0)\n");
    let done = folder.luxel(&["check", "a.scene", "--fix"]);
    assert_eq!((done.code, &*done.out), (0, "a.scene: fine\n"), "{done:?}");
    for part in [
        "a.scene:7:24: E0017: `:` → `=`\n",
        "a.scene:9:16: E0402: `radus` → `radius`\n",
        "parts/b.scene:2:22: E0012: `=` added\n",
        "parts/b.scene:3:14: E0014: `,` added\n",
    ] {
        assert!(done.err.contains(part), "{part} in {}", done.err);
    }
    let mended = "scene 1\nshape sphere { radius = 5 cm }\nlet a = (0, 1, 0)\n";
    assert_eq!(text(&folder, "parts/b.scene"), mended);
    assert!(text(&folder, "a.scene").starts_with(SCENE));
    assert_eq!(folder.names(), ["a.scene", "parts"]);
}

#[test]
fn what_is_guessed_set_or_outside_is_left_and_told() {
    let wrong = SCENE.replace("radius = 1 m", "radius = 1");
    let folder =
        Folder::new("fix-not").with("in/a.scene", &wrong).with("b.scene", "scene 1\nx = 3");
    let done = folder.luxel(&["check", "in/a.scene", "--fix", "--set", "nobody=1"]);
    assert!(done.code == 1 && done.out.is_empty(), "{done:?}");
    assert!(done.err.contains("E0201") && done.err.contains("E0111"), "{done:?}");
    assert_eq!(text(&folder, "in/a.scene"), wrong);
    // A file outside the scene's folder is changed only where it may be read.
    folder.write("in/a.scene", &format!("{SCENE}include \"../b.scene\"\n"));
    let done = folder.luxel(&["check", "in/a.scene", "--fix"]);
    assert!(done.code == 1 && done.err.contains("E0108"), "{done:?}");
    assert_eq!(text(&folder, "b.scene"), "scene 1\nx = 3");
    folder.write("b.scene", "scene 1\nlet x = (0, 1 0)");
    let done = folder.luxel(&["check", "in/a.scene", "--fix", "--allow-path", ".", "--json"]);
    assert_eq!(done.code, 0, "{done:?}");
    let told: serde_json::Value = serde_json::from_str(done.out.lines().next().unwrap()).unwrap();
    assert_eq!((&told["fixed"], &told["after"]), (&"E0014".into(), &",".into()));
    assert_eq!((&told["line"], &told["before"]), (&2.into(), &"".into()));
    assert_eq!(text(&folder, "b.scene"), "scene 1\nlet x = (0, 1, 0)");
}

#[test]
fn several_scenes_are_mended_in_one_run() {
    let wrong = SCENE.replace("radius = 1 m", "radius: 1 m");
    let folder = Folder::new("fix-several").with("a.scene", &wrong).with("b.scene", &wrong);
    let done = folder.luxel(&["check", "a.scene", "b.scene", "--fix"]);
    assert_eq!(done.code, 0, "{done:?}");
    assert_eq!([text(&folder, "a.scene"), text(&folder, "b.scene")], [SCENE, SCENE]);
}

#[test]
fn names_are_mended_beside_what_cannot_be_read() {
    let wrong = format!("{}let a = 5 +\n", SCENE.replace("radius", "radis"));
    let folder = Folder::new("fix-beside").with("a.scene", &wrong);
    let done = folder.luxel(&["check", "a.scene", "--fix"]);
    assert!(done.code == 1 && done.err.contains("E0015"), "{done:?}");
    assert_eq!(text(&folder, "a.scene"), wrong.replace("radis", "radius"));
}

#[test]
fn more_mistakes_than_are_told_at_once_are_mended_in_one_run() {
    let wrong = format!("{SCENE}{}", "shape sphre { radius = 1 m }\n".repeat(1700));
    let folder = Folder::new("fix-many").with("a.scene", &wrong);
    let done = folder.luxel(&["check", "a.scene", "--fix"]);
    assert_eq!((done.code, &*done.out), (0, "a.scene: fine\n"));
    assert_eq!(text(&folder, "a.scene"), wrong.replace("sphre", "sphere"));
}

#[test]
fn mends_that_come_one_after_another_end_and_may_be_gone_on_with() {
    // Of several missing commas in a statement of more than 64 KiB the first is told.
    let (blanks, numbers) = (" ".repeat(1 << 16), " 1".repeat(300));
    let wrong = format!("{SCENE}let a = [1{blanks}{numbers}]\n");
    let folder = Folder::new("fix-rounds").with("a.scene", &wrong);
    let done = folder.luxel(&["check", "a.scene", "--fix"]);
    assert!(done.code == 1 && done.err.contains("a.scene: mended 256 times over; run it again"));
    let done = folder.luxel(&["check", "a.scene", "--fix"]);
    assert_eq!((done.code, &*done.out), (0, "a.scene: fine\n"));
}

#[test]
fn thousands_of_mistakes_are_mended_at_once_and_not_all_told() {
    let n = 5000;
    let wrong = format!("{SCENE}{}", "shape sphere { radius 1 m }\n".repeat(n));
    let folder = Folder::new("fix-thousands").with("a.scene", &wrong);
    let done = folder.luxel(&["check", "a.scene", "--fix"]);
    assert_eq!((done.code, &*done.out), (0, "a.scene: fine\n"));
    assert_eq!(text(&folder, "a.scene"), wrong.replace("radius 1", "radius = 1"));
    // Of the first round, in which 4096 mistakes are told, and of the second.
    let told = done.err.lines().filter(|line| line.contains("E0012")).count();
    assert_eq!(told, 400);
    assert!(done.err.contains("a.scene: 3896 mends more") && done.err.contains(": 704 mends more"));
}

#[test]
fn statements_on_one_line_are_put_on_their_own() {
    let folder = Folder::new("fix-lines").with("a.scene", &format!("{SCENE}let a = 1 let b = 2\n"));
    let done = folder.luxel(&["check", "a.scene", "--fix"]);
    assert!(done.code == 0 && done.err.contains(": E0023: a line begun"), "{done:?}");
    assert_eq!(text(&folder, "a.scene"), format!("{SCENE}let a = 1\nlet b = 2\n"));
    // As the file ends its lines.
    let dos = |text: &str| text.replace('\n', "\r\n");
    let folder = folder.with("b.scene", &dos(&format!("{SCENE}let a = 1 let b = 2\n")));
    assert_eq!(folder.luxel(&["check", "b.scene", "--fix"]).code, 0);
    assert_eq!(text(&folder, "b.scene"), dos(&format!("{SCENE}let a = 1\nlet b = 2\n")));
}

/// Mends that are sure and alone, of what is told of a scene.
fn sure(folder: &Folder) -> Vec<String> {
    let done = folder.luxel(&["check", "a.scene", "--json"]);
    let told =
        done.out.lines().map(|line| serde_json::from_str::<serde_json::Value>(line).unwrap());
    let is_sure = |told: &serde_json::Value| {
        let fixes = told["fixes"].as_array().unwrap();
        fixes.iter().filter(|fix| fix["grade"] == "sure").count() == 1
    };
    told.filter(is_sure).map(|told| told.to_string()).collect()
}

#[test]
fn a_mend_beside_another_mistake_is_applied() {
    let object = "shape sphere { radius 1m center (0 1 0) m }";
    let folder = Folder::new("fix-several-of-one")
        .with("a.scene", &format!("{SCENE}{object}\nlet a = 5 +\n"));
    let done = folder.luxel(&["check", "a.scene", "--fix"]);
    assert!(done.code == 1 && done.err.contains("E0015"), "{done:?}");
    let mended = "shape sphere { radius = 1m, center = (0, 1, 0) m }";
    assert_eq!(text(&folder, "a.scene"), format!("{SCENE}{mended}\nlet a = 5 +\n"));
    assert_eq!(sure(&folder), [""; 0]);
}

#[test]
fn no_mend_that_is_sure_is_left() {
    let seeded = root().join("tests/seeded");
    let scenes = files_below(&seeded, "scene");
    for path in scenes.iter().filter(|path| path.parent() == Some(&seeded)) {
        let folder = Folder::new("fix-seeded").with("a.scene", &planted(path));
        folder.luxel(&["check", "a.scene", "--fix"]);
        assert_eq!(sure(&folder), [""; 0], "{}", path.display());
    }
}

#[test]
fn what_is_no_scene_is_never_changed() {
    let mesh = "# a mesh\nv 0.1 0.2 0.3\nv 1 2 3\n";
    let scene = format!("{SCENE}include \"m.obj\"\n");
    let folder = Folder::new("fix-foreign").with("a.scene", &scene).with("m.obj", mesh);
    for file in ["a.scene", "m.obj"] {
        let done = folder.luxel(&["check", file, "--fix"]);
        assert!(done.code == 1 && done.err.contains("E0001"), "{done:?}");
        assert_eq!(
            (text(&folder, "m.obj"), text(&folder, "a.scene")),
            (mesh.to_owned(), scene.clone())
        );
    }
}

#[test]
fn what_a_mend_uncovers_is_mended_too() {
    let wrong = SCENE.replace("{ radius = 1 m,", "{ radus: 1 m,");
    let folder = Folder::new("fix-again").with("a.scene", &wrong);
    let done = folder.luxel(&["check", "a.scene", "--fix"]);
    assert_eq!((done.code, text(&folder, "a.scene")), (0, SCENE.to_owned()));
    let again = folder.luxel(&["check", "a.scene", "--fix"]);
    assert_eq!((again.code, &*again.err), (0, ""), "{again:?}");
}

#[test]
fn a_code_is_explained_with_an_example_and_its_mend() {
    let folder =
        Folder::new("explain-page").with("a.scene", "scene 1\nshape spher { radius = 1 m }\n");
    let done = folder.luxel(&["explain", "e0402"]);
    assert!(done.code == 0 && done.out.starts_with("E0402: an unknown parameter\n\n"), "{done:?}");
    assert!(done.out.contains("\n    shape sphere { radus = 5 cm }\n"), "{done:?}");
    assert!(done.out.contains("\n    shape sphere { radius = 5 cm }\n"), "{done:?}");
    let done = folder.luxel(&["explain", "E0402", "--json"]);
    let told: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    assert_eq!(told["example"], "scene 1\nshape sphere { radus = 5 cm }\n");
    let done = folder.luxel(&["check", "a.scene"]);
    assert!(done.err.ends_with("2 errors; more: luxel explain E0401\n"), "{done:?}");
}
