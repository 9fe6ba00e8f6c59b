//! Plugins from `luxel plugin new`, through everything that happens to one.
#![expect(clippy::disallowed_methods, reason = "tests prepare and read files")]

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::program::{Folder, below_target};

const KINDS: [&str; 12] = [
    "shape",
    "material",
    "texture",
    "light",
    "medium",
    "phase",
    "camera",
    "sampler",
    "filter",
    "integrator",
    "asset",
    PICTURE,
];

/// An integrator by another trait, and what asks for it.
const PICTURE: &str = "picture";

/// Builds a crate of the folder; its dependencies are built once for all tests.
fn build(folder: &Folder, name: &str) -> PathBuf {
    let target = below_target("plugins");
    let mut cargo = Command::new(option_env!("CARGO").unwrap_or("cargo"));
    cargo.args(["build", "--quiet", "--target-dir"]).arg(&target);
    cargo.current_dir(folder.path(name)).env_remove("RUSTFLAGS");
    // The versions of this workspace, which are there already.
    let lock = Path::new(env!("CARGO_MANIFEST_DIR")).join("../Cargo.lock");
    fs::copy(lock, folder.path(name).join("Cargo.lock")).unwrap();
    assert!(cargo.status().unwrap().success(), "{name} builds");
    let file = format!("{DLL_PREFIX}{name}{DLL_SUFFIX}");
    let place = folder.path("plugins");
    fs::create_dir_all(&place).unwrap();
    fs::copy(target.join("debug").join(&file), place.join(&file)).unwrap();
    place.join(file)
}

#[test]
fn a_new_plugin_of_every_kind_builds_is_trusted_and_renders() {
    let folder = Folder::new("grown");
    for kind in KINDS {
        let name = format!("own_{kind}");
        let (kind, more) = match kind {
            PICTURE => ("integrator", &["--whole-picture"][..]),
            kind => (kind, &[][..]),
        };
        let made = folder.luxel(&[&["plugin", "new", kind, &name], more].concat());
        assert_eq!(made.code, 0, "{made:?}");
        let library = build(&folder, &name).display().to_string();
        let scene = format!("{name}/{name}.scene");
        let search = ["--plugin-dir", "plugins"];

        let before = folder.luxel(&[&["check", &scene][..], &search].concat());
        assert!(before.code == 1 && before.err.contains("E0414"), "{before:?}");
        let trust = folder.luxel(&["plugin", "trust", &library]);
        assert!(
            trust.code == 0 && trust.out.contains(&format!("trusted {name} 0.1.0")),
            "{trust:?}"
        );
        let small = ["--size", "16x12", "--spp", "2", "-o", &name];
        let done = folder.luxel(&[&["render", &scene][..], &search, &small].concat());
        assert_eq!((done.code, done.err.as_str()), (0, ""), "{done:?}");
        if more.len() == 1 {
            let on = folder.luxel(&[&["render", &scene, "--resume"][..], &search, &small].concat());
            assert!(on.code == 1 && on.err.contains("and cannot go on with one"), "{on:?}");
        }
        let page = folder.luxel(&[&["describe", kind, &name][..], &search].concat());
        assert!(page.out.starts_with(&format!("{kind} {name} ({name})")), "{page:?}");
    }
    let list = folder.luxel(&["plugin", "list", "--plugin-dir", "plugins", "--json"]);
    assert_eq!(list.out.matches(r#""state":"loaded""#).count(), KINDS.len(), "{list:?}");
    let gone = folder.luxel(&["plugin", "distrust", "own_shape"]);
    assert_eq!(gone.code, 0, "{gone:?}");
    let scene = "own_shape/own_shape.scene";
    let after = folder.luxel(&["check", scene, "--plugin-dir", "plugins"]);
    assert!(after.code == 1 && after.err.contains("is not trusted"), "{after:?}");
}

#[test]
fn a_library_is_judged_alone_and_without_trust() {
    let folder = Folder::new("judged");
    assert_eq!(folder.luxel(&["plugin", "new", "filter", "judged_tent"]).code, 0);
    let library = build(&folder, "judged_tent").display().to_string();
    let done = folder.luxel(&["plugin", "test", &library]);
    assert!(done.code == 0 && done.out.contains("\n1 class in "), "{done:?}");
    assert!(done.out.contains("filter     judged_tent "), "{done:?}");
    let named = folder.luxel(&["plugin", "test", &library, "filter", "box"]);
    assert!(named.code == 2 && named.err.contains("no filter `box`"), "{named:?}");
    assert!(!folder.path("config").exists());
}

#[cfg(unix)]
#[test]
fn a_watch_shows_a_new_build_and_keeps_the_last_one_that_opened() {
    use super::until;
    let folder = Folder::new("reloaded");
    assert_eq!(folder.luxel(&["plugin", "new", "material", "reloaded"]).code, 0);
    let library = build(&folder, "reloaded");
    let scene = "reloaded/reloaded.scene";
    let open = ["--plugin-dir", "plugins", "--allow-unlocked-plugins"];
    let small = ["--size", "16x12", "--spp", "2", "-o", "out"];
    let mut watching = folder.start(&[&["watch", scene, "--json"][..], &open, &small].concat());
    until("the first picture", || !folder.read("out.exr").is_empty());
    let first = folder.read("out.exr");

    let bytes = fs::read(&library).unwrap();
    folder.write("plugins/broken", "not a library");
    fs::rename(folder.path("plugins/broken"), &library).unwrap();
    std::thread::sleep(std::time::Duration::from_millis(400));
    assert_eq!(folder.read("out.exr"), first);

    let source = String::from_utf8(folder.read("reloaded/src/lib.rs")).unwrap();
    let darker = source.replace("f: self.reflectance * pdf", "f: self.reflectance * (0.5 * pdf)");
    assert_ne!(darker, source);
    folder.write("reloaded/src/lib.rs", &darker);
    build(&folder, "reloaded");
    until("the picture of the new build", || folder.read("out.exr") != first);

    fs::write(folder.path("old"), bytes).unwrap();
    fs::rename(folder.path("old"), &library).unwrap();
    until("the first picture again", || folder.read("out.exr") == first);
    watching.interrupt();
    let done = watching.end();
    assert_eq!(done.code, 0, "{done:?}");
    assert!(done.err.contains("stays in use"), "{done:?}");
    let told = done.out.lines().map(|line| serde_json::from_str(line).unwrap());
    let told: Vec<serde_json::Value> = told.collect();
    let made = told.iter().map(|it| {
        ["objects_made", "shapes_made", "trees_made"].map(|name| it["edit"][name].clone())
    });
    // What is made of the library, and nothing beside it.
    for made in made.skip(1).filter(|[objects, ..]| *objects != 0) {
        assert_eq!(made, [1, 0, 0].map(serde_json::Value::from), "{done:?}");
    }
    assert!(told.len() > 2 && told[0]["edit"]["shapes_made"] == 2, "{done:?}");
}
