//! Cameras of every class, moved and pasted back.

use std::path::Path;

use luxel_core::files::MemoryFiles;
use luxel_core::registry::Registry;
use luxel_core::stage;

use super::*;

const LOOK: &str = "look_at(from = (0, 1, 5) m, to = (0, 1, 0) m, up = (0, 1, 0))";
const REST: &str = "film rgb { resolution = (8, 6) }\nlight constant { scale = 1 }\n\
                    shape sphere { radius = 1 m, material = material diffuse { reflectance = 0.5 } }\n";

fn registry() -> Registry {
    let mut registry = Registry::new();
    for classes in luxel_builtin::CLASSES {
        registry.add("builtin", classes).unwrap();
    }
    registry
}

fn read(camera: &str, registry: &Registry) -> (Scene, Sources) {
    let text = format!("scene 1\n{camera}\n{REST}");
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let settings = luxel_lang::Settings::default();
    let read = luxel_lang::load(Path::new("a.scene"), &files, registry, &settings);
    let scene = read.scene.unwrap_or_else(|| panic!("{text}\n{:?}", read.diagnostics));
    (scene, read.sources)
}

fn built(scene: &Scene, registry: &Registry) -> Stage {
    stage::build(scene, registry, &MemoryFiles::default(), None).unwrap().stage
}

fn moved() -> Wished {
    let (from, to) = ([3.123456789, 0.1, 4.0], [0.2, 0.3, -0.7]);
    view(&View { from, to, up: [0.0, 1.0, 0.0], zoom: None }).unwrap()
}

/// Cameras whose other parameters are odd, with what is said of their place.
const CAMERAS: [&str; 7] = [
    "perspective { look = LOOK, fov = 39.7 deg, shift = (0.1, -0.2), fov_axis = \"x\" }",
    "perspective \"a \\\"b\" { look = LOOK, focal_length = 35.3 mm, sensor = (23.7, 15.6) mm }",
    "thin_lens { look = LOOK, fov = 1 / 3 * 1 rad, aperture = 3.1 mm, focus = 7 / 3 * 1 m }",
    "orthographic { look = LOOK, height = 6.6 m }",
    "perspective { look = LOOK, fov = 30 deg, transform = [rotate((1, 2, 3), 77 deg), move((0, 1, 0) m)] }",
    "orthographic { look = LOOK, height = 6 m, transform = scale(0.3) }",
    "perspective { look = LOOK, fov = 30 deg, transform = scale((-1, 1, 2)) }",
];

#[test]
fn the_text_of_a_camera_gives_the_same_camera_moved_or_not() {
    let registry = registry();
    for camera in CAMERAS {
        let camera = format!("camera {}", camera.replace("LOOK", LOOK));
        let (mut scene, sources) = read(&camera, &registry);
        let stage = built(&scene, &registry);
        let told = |stage: &Stage| told(stage, (&registry, &sources), Some(moved())).unwrap();
        stand(&mut scene, Some(&stage), &moved());
        let stage = built(&scene, &registry);
        let Camera { text, from, .. } = told(&stage);
        let off = (DVec3::from_array(from) - moved().look.from).length();
        // A dozen roundings of numbers below ten, and as many of the inverse.
        assert!(off < 1e-13, "{camera}: {off}");
        let (again, _) = read(&text, &registry);
        let told_again = told(&built(&again, &registry));
        assert_eq!(told_again.text, text, "{camera}");
        if !camera.contains("scale") {
            assert_eq!(again.hash(), scene.hash(), "{camera} gave\n{text}");
        }
        let ray = |stage: &Stage| stage.opening().camera_ray(DVec2::new(1.0, 2.0), [0.5; 2]);
        let [a, b] = [&stage, &built(&again, &registry)].map(|stage| ray(stage).unwrap().ray);
        assert!((a.o - b.o).length() < 1e-13 && (a.d - b.d).length() < 1e-14, "{camera}: {text}");
    }
}

#[test]
fn the_middle_of_the_picture_is_where_one_looks_and_the_rest_stays() {
    let registry = registry();
    for camera in &CAMERAS[1..] {
        let camera = format!("camera {}", camera.replace("LOOK", LOOK));
        let (mut scene, _) = read(&camera, &registry);
        let first = built(&scene, &registry);
        let before = first.scene.node(first.scene.camera.unwrap()).clone();
        stand(&mut scene, Some(&first), &moved());
        let stage = built(&scene, &registry);
        let ray = stage.opening().camera_ray(DVec2::new(4.0, 3.0), [0.5; 2]).unwrap().ray;
        let Look { from, to, .. } = moved().look;
        let off = (ray.d - (to - from).normalize()).length();
        assert!(off < 1e-14, "{camera}: {off}");
        let after = stage.scene.node(stage.scene.camera.unwrap());
        assert_eq!((&before.class, &before.label), (&after.class, &after.label));
        let rest = |node: &Node| {
            let rest = node.params.iter().filter(|argument| argument.name != "look");
            rest.map(|argument| argument.value.clone()).collect::<Vec<_>>()
        };
        assert_eq!(rest(&before), rest(after), "{camera}");
    }
}

#[test]
fn a_camera_whose_rays_are_parallel_shows_less_and_no_other_does() {
    let registry = registry();
    for camera in CAMERAS {
        let camera = format!("camera {}", camera.replace("LOOK", LOOK));
        let (mut scene, sources) = read(&camera, &registry);
        let first = built(&scene, &registry);
        let wished = Wished { zoom: Some(0.75), ..moved() };
        let before = told(&first, (&registry, &sources), None).unwrap();
        stand(&mut scene, Some(&first), &wished);
        let after = told(&built(&scene, &registry), (&registry, &sources), Some(wished)).unwrap();
        let is_parallel = camera.contains("orthographic");
        assert_eq!(
            [before.zoom, after.zoom],
            [1.0, 0.75].map(|x| is_parallel.then_some(x)),
            "{camera}"
        );
        // The height of a pixel, where rays begin.
        let [a, b] = [&before, &after].map(|camera| camera.spread[0]);
        assert!((b - 0.75 * a).abs() <= 1e-6 * a, "{camera}: {a}, {b}");
        assert!(!is_parallel || after.text.contains("height = 4."), "{}", after.text);
    }
}

#[test]
fn to_see_as_much_is_to_leave_the_height_as_it_is() {
    let wished = View { from: [1.0; 3], to: [0.0; 3], up: [0.0, 1.0, 0.0], zoom: Some(1.0) };
    assert_eq!(view(&wished), view(&View { zoom: None, ..wished }));
}

#[test]
fn it_is_turned_first_about_what_the_middle_shows() {
    let registry = registry();
    let camera = format!("camera perspective {{ look = {LOOK}, fov = 40 deg }}");
    let (scene, sources) = read(&camera.replace("1,", "0.001,"), &registry);
    let found = told(&built(&scene, &registry), (&registry, &sources), None).unwrap();
    // The sphere's near side, 4 m away. The middle pixel of an even picture is half a pixel off both
    // ways, 0.34 m there, where the sphere lies 0.06 m further back.
    assert!((found.to[2] - 1.0).abs() < 0.07 && !found.moved, "{found:?}");
    // Half the picture's height, 3 pixels, is tan 20 deg at 1 m; in the middle rays lie densest.
    assert!((found.spread[1] - 20f64.to_radians().tan() / 3.0).abs() < 2e-3, "{found:?}");
    assert_eq!((found.spread[0], found.up), (0.0, [0.0, 1.0, 0.0]));
}

/// A camera alone.
const ASSET: &str = r#"{ "asset": { "version": "2.0" },
    "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }],
    "nodes": [{ "camera": 0, "translation": [0.25, 0.5, 3] }],
    "scenes": [{ "nodes": [0] }] }"#;

#[test]
fn a_camera_that_an_asset_brings_is_stood_elsewhere_too() {
    let registry = registry();
    for place in ["place a", "place a { transform = [rotate((1, 2, 3), 50 deg), scale(3)] }"] {
        let text = format!(
            "scene 1\nlet a = asset gltf {{ file = \"a.gltf\", unit = 1 m }}\n{place}\n{REST}"
        );
        let files = MemoryFiles::default().with("a.scene", text.as_bytes());
        let files = files.with("a.gltf", ASSET.as_bytes());
        let settings = luxel_lang::Settings::default();
        let read = luxel_lang::load(Path::new("a.scene"), &files, &registry, &settings);
        let mut scene = read.scene.unwrap();
        let built = |scene: &Scene| stage::build(scene, &registry, &files, None).unwrap().stage;
        let first = built(&scene);
        stand(&mut scene, Some(&first), &moved());
        let stage = built(&scene);
        let found = told(&stage, (&registry, &read.sources), Some(moved())).unwrap();
        let Look { from, to, .. } = moved().look;
        let ray = |stage: &Stage| stage.opening().camera_ray(DVec2::new(4.0, 3.0), [0.5; 2]);
        let middle = ray(&stage).unwrap().ray;
        // As above, and what the frame three times as large rounds.
        assert!((middle.o - from).length() < 1e-13, "{place}: {}", middle.o);
        assert!((middle.d - (to - from).normalize()).length() < 1e-14, "{place}: {}", middle.d);
        let again = self::built(&self::read(&found.text, &registry).0, &registry);
        let corner =
            |stage: &Stage| stage.opening().camera_ray(DVec2::ZERO, [0.5; 2]).unwrap().ray.d;
        assert!((corner(&stage) - corner(&again)).length() < 1e-14, "{place}: {}", found.text);
    }
}

#[test]
fn a_camera_with_parallel_rays_that_an_asset_brings_shows_as_much_as_it_says() {
    let registry = registry();
    let parallel = r#"{ "type": "orthographic",
        "orthographic": { "xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 9 } }"#;
    let perspective = r#"{ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }"#;
    let text =
        format!("scene 1\nlet a = asset gltf {{ file = \"a.gltf\", unit = 1 m }}\nplace a\n{REST}");
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let files = files.with("a.gltf", ASSET.replace(perspective, parallel).as_bytes());
    let settings = luxel_lang::Settings::default();
    let read = luxel_lang::load(Path::new("a.scene"), &files, &registry, &settings);
    let scene = read.scene.unwrap_or_else(|| panic!("{:?}", read.diagnostics));
    let built = |scene: &Scene| stage::build(scene, &registry, &files, None).unwrap().stage;
    let wished = Wished { zoom: Some(0.5), ..moved() };
    let mut stage = built(&scene);
    let before = spread(&stage);
    assert!(before[0] > 0.0 && before[1] == 0.0, "{before:?}");
    for _ in 0..3 {
        let mut again = scene.clone();
        stand(&mut again, Some(&stage), &wished);
        stage = built(&again);
        let found = told(&stage, (&registry, &read.sources), Some(wished)).unwrap();
        assert_eq!(found.zoom, None);
        assert!((found.spread[0] - before[0]).abs() < 1e-12, "{:?}", found.spread);
    }
}

#[test]
fn what_is_no_view_is_refused_and_a_view_is_rounded_to_what_is_seen() {
    let [x, y, o] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]];
    let of = |from, to, up| view(&View { from, to, up, zoom: None }).map(|wished| wished.look);
    for (zoom, is_view) in
        [(0.5, true), (1e9, true), (0.0, false), (-1.0, false), (f64::NAN, false)]
    {
        let view = view(&View { from: o, to: x, up: y, zoom: Some(zoom) });
        assert_eq!(view.and_then(|wished| wished.zoom), is_view.then_some(zoom), "{zoom}");
    }
    assert_eq!(of(o, o, y), None);
    assert_eq!(of(o, y, y), None);
    assert_eq!(of(o, x, o), None);
    assert_eq!(of([f64::NAN, 0.0, 0.0], x, y), None);
    assert_eq!(of([f64::INFINITY, 0.0, 0.0], x, y), None);
    assert_eq!(of([1e200, 0.0, 0.0], x, y), None);
    let found = of([0.123456789, 0.0, -0.0], [5.0, 0.0, 0.0], y).unwrap();
    assert_eq!(found.from.to_array().map(f64::to_bits), [0.123457, 0.0, 0.0].map(f64::to_bits));
    for tiny in [1e-9, 1e-30, 1e30] {
        assert!(of(o, [tiny, 0.0, 0.0], y).is_some(), "{tiny}");
    }
}
