//! `luxel explain`, `--require` and `--drop` as a person meets them.

use super::program::{Folder, SCENE};
use crate::disk::{root, text};

const GHOST: &str = "shape sphere \"ghost\" { radius = 2 m, interior = medium homogeneous { sigma_t = 0.1 / (1 m), albedo = 0.5 } }\n";

fn foggy() -> String {
    format!("{SCENE}{GHOST}")
}

#[test]
fn a_page_tells_who_requires_what_and_why_the_rest_is_left_out() {
    let folder = Folder::new("explain").with("a.scene", &foggy());
    let done = folder.luxel(&["explain", "a.scene"]);
    assert_eq!(done.code, 0, "{done:?}");
    let line = SCENE.lines().count() + 1;
    for part in [
        "  media\n      a.scene:",
        &format!("  open_surfaces\n      a.scene:{line}:1  sphere \"ghost\"\n"),
        "  spectral      the film asks for RGB\n",
        "  motion        nothing moves while the shutter is open\n",
        "2 shapes in their places, 1 materials, 1 lights, 1 media\n",
    ] {
        assert!(done.out.contains(part), "{part} in {}", done.out);
    }
    let plain = Folder::new("explain-plain").with("a.scene", SCENE);
    let done = plain.luxel(&["explain", "a.scene", "--require", "motion"]);
    assert!(done.out.contains("none of the features below"), "{done:?}");
    assert!(done.out.contains("shutter is open; its code runs all the same"), "{done:?}");
}

#[test]
fn json_tells_the_same_with_lines_and_what_was_dropped() {
    let folder = Folder::new("explain-json").with("a.scene", &foggy());
    let done = folder.luxel(&["explain", "a.scene", "--json", "--aov", "depth", "--drop", "media"]);
    assert_eq!(done.code, 0, "{done:?}");
    let told: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    let of = |name: &str| {
        let features = told["features"].as_array().unwrap();
        features.iter().find(|it| it["name"] == name).unwrap().clone()
    };
    assert_eq!(of("media")["required"], false);
    assert_eq!(of("media")["why_not"], "dropped: there is vacuum between surfaces");
    assert_eq!((&of("open_surfaces")["compiled_in"], &told["shapes"]), (&false.into(), &1.into()));
    assert_eq!(
        (&of("layers")["required"], &of("layers")["by"][0]["line"]),
        (&true.into(), &serde_json::Value::Null)
    );
    let whole = folder.luxel(&["explain", "a.scene", "--json"]);
    let told: serde_json::Value = serde_json::from_str(&whole.out).unwrap();
    let by = &told["features"][2]["by"][0];
    assert_eq!((&by["file"], &by["node"]), (&"a.scene".into(), &"sphere \"ghost\"".into()));
    assert_eq!(by["line"], SCENE.lines().count() + 1);
}

#[test]
fn costs_are_measured_of_what_can_be_left_out_and_of_what_could_run_for_nothing() {
    let folder = Folder::new("explain-cost").with("a.scene", &foggy());
    let done = folder.luxel(&["explain", "a.scene", "--cost", "--json"]);
    assert_eq!((done.code, &*done.err), (0, ""), "{done:?}");
    let told: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    let mut measured = vec![];
    for feature in told["features"].as_array().unwrap() {
        let Some(ratio) = feature["time_ratio_quartiles"].as_array() else { continue };
        let ratio: Vec<f64> = ratio.iter().map(|it| it.as_f64().unwrap()).collect();
        assert!(ratio[0] > 0.0 && ratio.is_sorted() && ratio.len() == 3, "{ratio:?}");
        measured.push(feature["name"].as_str().unwrap());
    }
    // RGB and layers cannot be required.
    assert_eq!(measured, ["media", "open_surfaces", "nested", "motion", "light_choice"]);
    let text = folder.luxel(&["explain", "a.scene", "--cost"]).out;
    let open = text.lines().find(|line| line.starts_with("  open_surfaces: ")).unwrap();
    assert!(open.ends_with(") the time if shadow rays did not look for them"), "{text}");
    assert!(text.contains("no cost is known, as it cannot be required"), "{text}");
}

#[test]
fn the_choice_among_lights_has_a_cost_where_its_code_can_be_left_out() {
    let lamp = |x: u32| format!("light point {{ position = ({x}, 3, 0) m, intensity = 1 W/sr }}\n");
    let scene = format!("{SCENE}{}{}", lamp(0), lamp(1));
    let folder = Folder::new("explain-lights").with("a.scene", &scene);
    let text = folder.luxel(&["explain", "a.scene", "--cost"]).out;
    let line = text.lines().find(|line| line.starts_with("  light_choice: ")).unwrap();
    assert!(line.ends_with(") the time if one light alone were looked for"), "{text}");
    let ratio: f64 = line.split([' ', '×']).nth(3).unwrap().parse().unwrap();
    // Another number is drawn, and no more rays.
    assert!((0.5..2.0).contains(&ratio), "{text}");
}

#[test]
fn of_what_cannot_be_dropped_the_nearest_measurement_is_told() {
    let lamp = "light point { position = (0, 3, 0) m, intensity = 1 W/sr }\n";
    let folder = Folder::new("explain-nearest").with("a.scene", &(foggy() + lamp));
    let done = folder.luxel(&["explain", "a.scene", "--cost", "--json"]);
    let told: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    let of = |name: &str| {
        let features = told["features"].as_array().unwrap();
        features.iter().find(|it| it["name"] == name).unwrap().clone()
    };
    let why = |name: &str| of(name)["why_no_cost"].as_str().map(str::to_owned);
    assert!(why("light_choice").is_some_and(|why| why.contains("docs/performance.md")), "{done:?}");
    assert_eq!((why("media"), why("open_surfaces"), why("nested")), (None, None, None));
    // What is said holds: the rows are there.
    let rows = text(&root().join("docs/performance.md"));
    assert!(rows.contains("| `light_choice` | used / alike without |"));
    let unasked = folder.luxel(&["explain", "a.scene", "--json"]).out;
    assert!(unasked.contains(r#""why_no_cost":null"#) && !unasked.contains("look alike"));
}

#[test]
fn what_is_neither_scene_nor_code_is_refused() {
    let folder = Folder::new("explain-code");
    let unknown = folder.luxel(&["explain", "E9999"]);
    assert_eq!(unknown.code, 1, "{unknown:?}");
    assert!(unknown.err.contains("no message has the code E9999"), "{unknown:?}");
    assert_eq!(folder.luxel(&["explain", "none.scene"]).code, 1);
}

#[test]
fn required_features_change_no_byte_and_dropped_ones_are_told() {
    let folder = Folder::new("require-drop").with("a.scene", &foggy());
    let all = "media,open_surfaces,nested,motion,light_choice";
    for (name, more) in [("plain", vec![]), ("all", vec!["--require", all])] {
        let done = folder.luxel(&[&["render", "a.scene", "-q", "-o", name][..], &more].concat());
        assert_eq!((done.code, &*done.out), (0, ""), "{done:?}");
    }
    assert_eq!(folder.read("plain.exr"), folder.read("all.exr"));
    let done = folder.luxel(&["render", "a.scene", "--drop", "media", "-o", "less"]);
    let told = "`media` was dropped: there is vacuum between surfaces\n";
    assert!(done.code == 0 && done.out.ends_with(told), "{done:?}");
    let note = br#""dropped":["media"]"#;
    let says = |name: &str| folder.read(name).windows(note.len()).any(|part| part == note);
    assert!(says("less.exr") && !says("plain.exr"));
    for (words, why) in [
        (vec!["--drop", "light_choice"], "the light of the others would be missing"),
        (vec!["--require", "spectral"], "film spectral"),
        (vec!["--require", "fog"], "expected some of spectral, media"),
        (vec!["--require", "motion", "--drop", "motion"], "both required and dropped"),
    ] {
        let done = folder.luxel(&[&["render", "a.scene"][..], &words].concat());
        assert_eq!(done.code, 2, "{done:?}");
        assert!(done.err.contains(why), "{why}: {done:?}");
    }
}
