//! What two scenes differ in, in words.

use std::path::Path;

use luxel_core::files::MemoryFiles;
use luxel_core::scene::{Scene, diff};

use crate::load::registry;

const SCENE: &str = "scene 1
camera perspective { look = look_at(from = (0, 1, 4) m, to = (0, 0.5, 0) m, up = (0, 1, 0)), fov = 40 deg }
film rgb { resolution = (8, 8) }
light constant { scale = 1 }
let grey = material diffuse \"grey\" { reflectance = 0.5 }
shape sphere \"ball\" { radius = 1 m, material = grey }
shape sphere { radius = 2 m, material = grey }
shape box { size = (1, 1, 1) m }
let pair = group { shape disk { radius = 1 m } light point { position = (0, 1, 0) m, intensity = 1 W/sr } }
place pair
place pair { transform = move((1, 0, 0) m) }
";

fn scene(text: &str) -> Scene {
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let settings = luxel_lang::Settings::default();
    let read = luxel_lang::load(Path::new("a.scene"), &files, &registry(), &settings);
    read.scene.unwrap_or_else(|| panic!("{:?}", read.diagnostics))
}

/// What is told of a scene in which some words were replaced by others.
fn told(edits: &[(&str, &str)]) -> Vec<String> {
    let edited = edits.iter().fold(SCENE.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replacen(from, to, 1)
    });
    diff(&scene(SCENE), &scene(&edited)).iter().map(ToString::to_string).collect()
}

#[test]
fn scenes_that_show_the_same_do_not_differ() {
    assert!(told(&[]).is_empty());
    assert!(told(&[("light constant", "// a light\nlight constant")]).is_empty());
    let (ball, bare) = ("\"ball\" { radius = 1 m", "\"egg\" { radius = 1 m");
    assert!(told(&[(ball, bare)]).is_empty());
    let reordered = [
        ("shape box { size = (1, 1, 1) m }\n", ""),
        ("let pair", "shape box { size = (1, 1, 1) m }\nlet pair"),
    ];
    assert!(told(&reordered).is_empty());
}

#[test]
fn parameters_are_told_where_they_stand() {
    assert_eq!(told(&[("fov = 40", "fov = 41")]), ["camera perspective: fov"]);
    assert_eq!(told(&[("(8, 8)", "(9, 8)")]), ["film rgb: resolution"]);
    assert_eq!(
        told(&[("\"ball\" { radius = 1 m", "\"ball\" { radius = 3 m")]),
        ["sphere \"ball\": radius"]
    );
    assert_eq!(told(&[("radius = 2 m", "radius = 2.5 m")]), ["shape sphere: radius"]);
    assert_eq!(
        told(&[("reflectance = 0.5", "reflectance = 0.6")]),
        ["diffuse \"grey\": reflectance"]
    );
    assert_eq!(told(&[("disk { radius = 1 m", "disk { radius = 2 m")]), ["shape disk: radius"]);
    assert_eq!(told(&[("move((1, 0, 0) m)", "move((2, 0, 0) m)")]), ["group: place"]);
}

#[test]
fn what_came_and_went_is_told() {
    assert_eq!(told(&[("shape box { size = (1, 1, 1) m }\n", "")]), ["shape box removed"]);
    assert_eq!(
        told(&[("film rgb", "sampler sobol { samples = 4 }\nfilm rgb")]),
        ["sampler sobol added"]
    );
    let other = told(&[(
        "shape box { size = (1, 1, 1) m }",
        "shape capsule \"pill\" { radius = 1 m, height = 2 m }",
    )]);
    assert_eq!(other, ["shape box removed", "capsule \"pill\" added"]);
    let class = told(&[(
        "light constant { scale = 1 }",
        "light point { position = (0, 3, 0) m, intensity = 1 W/sr }",
    )]);
    assert_eq!(class, ["light constant removed", "light point added"]);
}

#[test]
fn an_edit_among_alike_items_is_told_wherever_it_stands() {
    const LINES: [&str; 6] = [
        "shape sphere { radius = 1 m }\n",
        "shape sphere { radius = 1 m }\n",
        "shape sphere { radius = 2 m }\n",
        "shape sphere { radius = 1 m }\n",
        "shape sphere { radius = 2 m }\n",
        "shape sphere { radius = 2 m }\n",
    ];
    let (head, _) = SCENE.split_once("let grey").unwrap();
    let of = |lines: &[&str]| scene(&format!("{head}{}", lines.concat()));
    let told = |lines: &[&str]| -> Vec<String> {
        diff(&of(&LINES), &of(lines)).iter().map(ToString::to_string).collect()
    };
    for at in 0..LINES.len() {
        let mut lines = LINES.to_vec();
        lines.remove(at);
        assert_eq!(told(&lines), ["shape sphere removed"], "{at}");
        lines.rotate_left(at);
        assert_eq!(told(&lines), ["shape sphere removed"], "{at}, in another order");
        let mut lines = LINES.to_vec();
        lines.insert(at, LINES[0]);
        assert_eq!(told(&lines), ["shape sphere added"], "{at}");
        let mut lines = LINES.to_vec();
        lines[at] = "shape sphere { radius = 3 m }\n";
        assert_eq!(told(&lines), ["shape sphere: radius"], "{at}");
    }
}
