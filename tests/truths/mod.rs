//! Closed-form truths, as the program tests them: `luxel verify`.

use std::collections::BTreeSet;
use std::path::PathBuf;

use serde_json::Value;

use crate::cli::program::{Done, Folder};
use crate::disk::{files_below, root, text};
use crate::dynamic;
use crate::generated::{part, replaced};
use crate::load::takes_loaded_builtins;

/// Where the table stands.
const PUBLISHED: &str = "docs/accuracy.md";

/// Runs `luxel verify` with the built-ins that the tests take.
fn verify(folder: &Folder, args: &[&str]) -> Done {
    let library = dynamic::library("builtins");
    let mut all = [&["verify"], args].concat();
    if takes_loaded_builtins() {
        all.extend(["--builtins", library.to_str().unwrap()]);
    }
    folder.luxel(&all)
}

/// What was measured, row by row.
fn rows(done: &Done) -> Vec<Value> {
    done.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Name and case of the truths that were tried, every one of which holds.
fn held(done: &Done) -> BTreeSet<[String; 2]> {
    let rows = rows(done);
    let wrong: Vec<_> = rows.iter().filter(|row| row["verdict"] != "ok").collect();
    assert!(wrong.is_empty(), "truths that do not hold: {wrong:#?}");
    assert!(done.code == 0 && done.err.is_empty(), "{done:?}");
    let text = |value: &Value| value.as_str().unwrap().to_owned();
    rows.iter().map(|row| [text(&row["id"]), text(&row["case"])]).collect()
}

/// The first cells of each row of a document's table: name, case, expected value.
fn published<const N: usize>(document: &str) -> BTreeSet<[String; N]> {
    let rows = part(document, "truths").unwrap().trim().lines().skip(2);
    let cell = |row: &str, i: usize| row.split('|').nth(i + 1).unwrap().trim().to_owned();
    rows.map(|row| std::array::from_fn(|i| cell(row, i))).collect()
}

#[test]
fn truths_hold_and_every_one_is_published_and_no_other() {
    let document = text(&root().join(PUBLISHED));
    let folder = Folder::new("truths").with("a.md", &document);
    let done = verify(&folder, &["--json", "--write", "a.md"]);
    assert_eq!(published(&document), held(&done), "luxel verify --write {PUBLISHED}");
    let rows = rows(&done);
    assert!(rows.len() > 200, "only {} truths were tried", rows.len());
    let ids: BTreeSet<&str> = rows.iter().filter_map(|row| row["id"].as_str()).collect();
    let all = format!("{} closed-form truths in {} cases", ids.len(), rows.len());
    let told = text(&root().join("README.md")).matches(&all).count();
    assert_eq!(told, 2, "README.md tells how many truths there are, twice: {all}");
    // What is written is what was measured, and the rest of the document stays.
    let written = String::from_utf8(folder.read("a.md")).unwrap();
    assert_eq!(published::<3>(&written), published(&document), "luxel verify --write {PUBLISHED}");
    let table = part(&written, "truths").unwrap();
    assert_eq!(table.trim().lines().count(), 2 + rows.len());
    assert_eq!(written, replaced(&document, "truths", table).unwrap());
}

#[test]
fn truths_hold_in_every_precision() {
    let all = published(&text(&root().join(PUBLISHED)));
    for precision in ["fast", "exact"] {
        let done = verify(&Folder::new("truths-precision"), &["--json", "--precision", precision]);
        assert_eq!(held(&done), all, "{precision}");
    }
}

#[test]
fn scenes_of_truths_hold_to_what_they_say_themselves() {
    let scenes = files_below(&root().join("cli/src/verify/truths"), "scene");
    let says = |path: &PathBuf| text(path).contains("expect ");
    let scenes: Vec<String> =
        scenes.into_iter().filter(says).map(|path| path.display().to_string()).collect();
    assert!(scenes.len() >= 8, "{scenes:?}");
    let args: Vec<&str> = scenes.iter().map(String::as_str).chain(["--json"]).collect();
    let done = verify(&Folder::new("truths-said"), &args);
    assert!(done.code == 0 && done.err.is_empty(), "{done:?}");
    let rows = rows(&done);
    assert!(rows.len() > 30 && rows.iter().all(|row| row["verdict"] == "ok"), "{rows:#?}");
    // Of each scene something was tested.
    let of = |scene: &String| rows.iter().any(|row| row["id"].as_str().unwrap().starts_with(scene));
    assert!(scenes.iter().all(of));
}

#[test]
fn some_truths_can_be_tested_alone_and_under_any_precision() {
    let folder = Folder::new("truths-only");
    for precision in ["fast", "standard", "exact"] {
        let args = ["--json", "--only", "furnace.convex", "--precision", precision];
        let rows = rows(&verify(&folder, &args));
        assert!(rows.len() > 5 && rows.iter().all(|row| row["id"] == "furnace.convex.lambert"));
        assert!(rows.iter().all(|row| row["verdict"] == "ok"), "{precision}: {rows:#?}");
    }
    let units = verify(&folder, &["--only", "fresnel.conductor"]);
    assert!(units.code == 0 && units.out.ends_with("\nall 3 hold\n"), "{units:?}");
}

#[test]
fn truths_that_are_too_noisy_to_tell_are_counted() {
    // Paths that end by chance, few of them: their mean errs by more than 2 %.
    let folder = Folder::new("truths-noisy");
    let done = verify(&folder, &["--spp", "4", "--only", "stat.rr_furnace"]);
    assert!(done.code == 1 && done.out.contains("NOISY"), "{done:?}");
    assert!(done.out.contains("\n2 of 2 are too noisy to tell; "), "{done:?}");
    assert!(done.out.ends_with(" times the samples would (--spp)\n"), "{done:?}");
}

#[test]
fn what_cannot_be_verified_is_told_before_anything_is_measured() {
    let folder = Folder::new("truths-told").with("a.md", "nothing\n").with("a.scene", "");
    for (args, code, told) in [
        (&["--write", "a.md"][..], 1, "cannot write into `a.md`: no line `<!-- begin: truths -->`"),
        (&["--write", "b.md"], 1, "cannot write into `b.md`: "),
        (&["--only", "nothing"], 2, "no truth has a name that begins with `nothing`"),
        (&["--set", "a=1"], 2, "--set and --allow-path are for a scene, and none is given"),
        (&["--only", "a", "a.scene"], 2, "cannot be used with"),
        (&["--write", "a.md", "--seed", "1"], 2, "cannot be used with"),
    ] {
        let done = verify(&folder, args);
        assert!(done.code == code && done.err.contains(told), "{args:?}: {done:?}");
        assert_eq!(done.out, "");
    }
    assert_eq!(folder.read("a.md"), b"nothing\n");
}

#[test]
fn curves_of_errors_stand_where_the_bench_writes_them() {
    let document = text(&root().join(PUBLISHED));
    let curves = part(&document, "errors").unwrap();
    // Of each of three tables a head, a line, and four rows of each of four shapes.
    assert_eq!(curves.lines().filter(|line| line.starts_with('|')).count(), 3 * (2 + 4 * 4));
}
