//! What a picture says of how it came about, and what it keeps to itself.
#![cfg(unix)]

use serde_json::{Value, json};

use super::faulty;
use super::program::Folder;

/// The ball of what a library offers, with something to set, and settings that say something.
fn scene() -> String {
    let params = "scene 1\nparam depth: int = 3\nparam wood: string = \"oak.png\"\n";
    faulty::scene().replace("scene 1\n", params)
        + "integrator path { max_depth = 2 * depth, russian_roulette_from = 7 }\n"
}

/// Renders it in a folder of its own, and gives the summary and the EXR.
fn rendered(name: &str) -> (Folder, Value, Vec<u8>) {
    let folder = Folder::new(name).with("a.scene", &scene());
    faulty::build(&folder, faulty::NOTHING);
    let (wood, plugins) = (folder.path("wood/pine.png"), folder.path("plugins"));
    let wood = format!("wood={}", wood.display());
    let words = ["render", "a.scene", "--json", "--set", &wood, "--set", "depth=4"];
    let open = ["--allow-unlocked-plugins", "--plugin-dir", plugins.to_str().unwrap()];
    let done = folder.luxel(&[&words[..], &open].concat());
    assert_eq!(done.code, 0, "{done:?}");
    let (told, exr) = (serde_json::from_str(&done.out).unwrap(), folder.read("a.exr"));
    (folder, told, exr)
}

/// The attribute `luxel` of an EXR.
pub(super) fn attribute(exr: &[u8]) -> Value {
    let begin = b"luxel\0string\0";
    let at = exr.windows(begin.len()).position(|part| part == begin).unwrap() + begin.len();
    let (length, text) = exr[at..].split_first_chunk().unwrap();
    serde_json::from_slice(&text[..u32::from_le_bytes(*length) as usize]).unwrap()
}

#[test]
fn a_picture_says_what_was_set_its_settings_and_its_libraries_and_names_no_folder() {
    let (folder, told, exr) = rendered("origin");
    for about in [&attribute(&exr), &told] {
        assert_eq!(about["set"], json!({ "depth": "4", "wood": "pine.png" }));
        let settings = json!({
            "integrator": "path { max_depth = 8, russian_roulette_from = 7 }",
            "sampler": "sobol { samples = 4 }",
            "filter": "blackman_harris {}",
        });
        assert_eq!(about["settings"], settings);
        assert_eq!(about["plugins"], json!({ "faulty": "0.1.0" }));
    }
    let place = folder.path("").display().to_string();
    let home = place.trim_end_matches('/').rsplit('/').next().unwrap();
    assert!(!exr.windows(home.len()).any(|part| part == home.as_bytes()), "{home} is in the EXR");
}

#[test]
fn a_picture_says_which_build_made_it_as_the_program_does() {
    let (folder, told, exr) = rendered("built");
    let version = folder.luxel(&["--version"]).out;
    let build = told["build"].as_str().unwrap();
    assert_eq!(version, format!("luxel {} (build {build})\n", env!("CARGO_PKG_VERSION")));
    assert!(build.len() == 16 && build.chars().all(|c| c.is_ascii_hexdigit()), "{build}");
    assert_eq!(attribute(&exr)["build"], build);
}

#[test]
fn the_same_in_another_folder_has_the_same_bytes() {
    let [(one, _, first), (other, _, second)] = ["origin", "elsewhere"].map(rendered);
    assert_ne!(one.path(""), other.path(""));
    assert!(first == second, "{} and {}", attribute(&first), attribute(&second));
}

#[test]
fn a_library_that_the_scene_takes_nothing_from_is_not_told() {
    let folder = Folder::new("unused").with("a.scene", super::program::SCENE);
    let without = folder.luxel(&["render", "a.scene", "-q"]);
    let plain = folder.read("a.exr");
    faulty::build(&folder, faulty::NOTHING);
    let with = folder.luxel(&[&["render", "a.scene", "-q"][..], &faulty::OPEN].concat());
    assert_eq!((without.code, with.code), (0, 0), "{without:?} {with:?}");
    assert_eq!(attribute(&plain)["plugins"], json!({}));
    assert!(plain == folder.read("a.exr"));
}
