//! Two pictures compared, as a person does.

use super::program::{Done, Folder, SCENE};

/// A folder with a scene and pictures of it: two seeds, and one of a brighter ball.
fn pictures(name: &str) -> Folder {
    let folder = Folder::new(name).with("a.scene", SCENE);
    let brighter = SCENE.replace("reflectance = 0.5", "reflectance = 0.55");
    folder.write("b.scene", &brighter);
    for (scene, seed, out) in [("a", "1", "one"), ("a", "2", "two"), ("b", "3", "brighter")] {
        let scene = format!("{scene}.scene");
        let done =
            folder.luxel(&["render", &scene, "-q", "--spp", "64", "--seed", seed, "-o", out]);
        assert_eq!(done.code, 0, "{done:?}");
    }
    folder
}

fn json(done: &Done) -> serde_json::Value {
    serde_json::from_str(&done.out).unwrap_or_else(|wrong| panic!("{wrong}: {done:?}"))
}

#[test]
fn the_exit_code_says_same_different_or_inconclusive() {
    let folder = pictures("compare");
    let same = folder.luxel(&["compare", "one.exr", "two.exr"]);
    assert!(same.code == 0 && same.out.starts_with("same: no difference"), "{same:?}");
    let identical = folder.luxel(&["compare", "one.exr", "one.exr"]);
    assert!(identical.code == 0 && identical.out.contains("bit by bit"), "{identical:?}");
    let different = folder.luxel(&["compare", "brighter.exr", "one.exr"]);
    assert!(different.code == 1 && different.out.starts_with("different: "), "{different:?}");
    let open = folder.luxel(&["compare", "one.exr", "two.exr", "--bias", "0.00001%"]);
    assert!(open.code == 3 && open.out.contains("take more samples"), "{open:?}");
    let wrong = folder.luxel(&["compare", "one.exr", "two.exr", "--alpha", "2"]);
    assert!(wrong.code == 2 && wrong.err.contains("expected a share"), "{wrong:?}");
}

#[test]
fn json_tells_the_verdict_the_numbers_and_what_would_have_been_seen() {
    let folder = pictures("compare-json");
    let told = json(&folder.luxel(&["compare", "brighter.exr", "one.exr", "--json"]));
    assert_eq!(told["verdict"], "different");
    assert_eq!(told["tiles"], 16);
    let tenths = told["histogram"].as_array().unwrap();
    assert_eq!(tenths.len(), 10);
    assert_eq!(tenths.iter().map(|n| n.as_u64().unwrap()).sum::<u64>(), 16, "{told}");
    let whole = &told["whole"][0];
    assert_eq!(whole["lane"], "luminance");
    assert!(whole["difference"].as_f64().unwrap() > 0.0, "{told}");
    for key in ["mse", "expected_mse", "rel_mse", "flip"] {
        assert!(told[key].as_f64().unwrap() > 0.0, "{key} in {told}");
    }
    let seen = &told["smallest_detectable_bias"];
    let size = |key: &str| seen[key].as_f64().unwrap();
    assert!(size("whole") < size("median_tile") && size("median_tile") <= size("worst_tile"));
}

#[test]
fn a_picture_of_the_difference_takes_no_place_of_what_is_read() {
    let folder = pictures("compare-picture");
    let done = folder.luxel(&["compare", "brighter.exr", "one.exr", "--picture", "where"]);
    assert!(done.code == 1 && done.out.contains("red: A is brighter"), "{done:?}");
    assert!(folder.read("where.png").starts_with(b"\x89PNG"));
    // The difference is a picture that can be looked at and compared.
    let again = folder.luxel(&["compare", "where.exr", "where.exr"]);
    assert_eq!(again.code, 0, "{again:?}");
    let one = folder.read("one.exr");
    let over = folder.luxel(&["compare", "brighter.exr", "one.exr", "--picture", "one"]);
    assert!(over.code == 2 && over.err.contains("would take the place"), "{over:?}");
    assert_eq!(folder.read("one.exr"), one);
}

#[test]
fn files_that_do_not_go_together_are_told() {
    let folder = pictures("compare-wrong").with("text.exr", "no picture");
    let small = ["render", "a.scene", "-q", "--size", "8x8", "-o", "small"];
    assert_eq!(folder.luxel(&small).code, 0);
    for (other, told) in [
        ("small.exr", "different sizes: 32 x 32, 8 x 8"),
        ("none.exr", "cannot read the picture none.exr"),
        ("text.exr", "cannot read the picture text.exr"),
    ] {
        let done = folder.luxel(&["compare", "one.exr", other]);
        assert!(done.code == 1 && done.err.contains(told) && done.out.is_empty(), "{done:?}");
    }
}
