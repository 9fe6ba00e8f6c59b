//! Plugin libraries as a person meets them.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};

use super::program::{Folder, SCENE};

fn library(stem: &str) -> String {
    format!("{DLL_PREFIX}{stem}{DLL_SUFFIX}")
}

#[test]
fn a_class_that_a_library_without_trust_may_have_is_answered_with_how_to_trust_it() {
    let scene = format!("{SCENE}shape gyroid {{}}\n");
    let folder = Folder::new("missed").with("a.scene", &scene).with("plain.scene", SCENE);
    let folder = folder.with(&format!("plugins/{}", library("gyroid")), "not a library");
    let done = folder.luxel(&["check", "a.scene", "--plugin-dir", "plugins"]);
    assert_eq!(done.code, 1, "{done:?}");
    for part in ["E0414", "there is no shape `gyroid`", &library("gyroid"), "luxel plugin trust"] {
        assert!(done.err.contains(part), "{part} in {done:?}");
    }
    // Without the library it is a mistake of the scene; without the mistake nobody hears of it.
    let without = folder.luxel(&["check", "a.scene"]);
    assert!(without.err.contains("E0401") && !without.err.contains("trust"), "{without:?}");
    let plain = folder.luxel(&["check", "plain.scene", "--plugin-dir", "plugins"]);
    assert_eq!((plain.code, plain.err.as_str()), (0, ""), "{plain:?}");
}

#[test]
fn a_requirement_is_met_by_what_is_loaded_and_loads_nothing() {
    let scene = |what: &str| format!("{SCENE}use plugin {what}\n");
    let folder = Folder::new("required").with("a.scene", &scene("\"gyroid\" version \"^1\""));
    let folder = folder.with(&format!("plugins/{}", library("gyroid")), "not a library");
    let done = folder.luxel(&["check", "a.scene", "--plugin-dir", "plugins"]);
    for part in ["E0414", "`gyroid` version `^1`", "no plugin library is loaded", "plugin trust"] {
        assert!(done.code == 1 && done.err.contains(part), "{part}: {done:?}");
    }
    #[cfg(unix)]
    {
        super::faulty::build(&folder, super::faulty::NOTHING);
        let check = [&["check", "a.scene"][..], &super::faulty::OPEN].concat();
        folder.write("a.scene", &scene("\"faulty\" version \"^0.1\""));
        let met = folder.luxel(&check);
        assert!(met.code == 0, "{met:?}");
        folder.write("a.scene", &scene("\"faulty\" version \"^0.2\""));
        let other = folder.luxel(&check);
        assert!(other.code == 1 && other.err.contains("loaded is `faulty` 0.1.0"), "{other:?}");
    }
}

#[test]
fn a_library_that_cannot_be_opened_is_told_with_its_reason_and_the_rest_works() {
    let scene = format!("{SCENE}shape gyroid {{}}\n");
    let folder = Folder::new("unopened").with("a.scene", &scene).with("plain.scene", SCENE);
    let folder = folder.with(&format!("plugins/{}", library("gyroid")), "not a library");
    let open = ["--plugin-dir", "plugins", "--allow-unlocked-plugins"];
    let plain = folder.luxel(&[&["check", "plain.scene"][..], &open].concat());
    assert!(plain.code == 0 && plain.err.contains("warning[E0414]: plugin library"), "{plain:?}");
    let done = folder.luxel(&[&["check", "a.scene", "--json"][..], &open].concat());
    assert!(done.code == 1 && done.out.lines().count() == 2, "{done:?}");
    assert!(done.out.lines().all(|line| line.contains("is not loaded: ")), "{done:?}");
    let list = folder.luxel(&[&["plugin", "list", "--json"][..], &open].concat());
    assert!(list.code == 1 && list.out.contains(r#""state":"refused""#), "{list:?}");
    let trust = folder.luxel(&["plugin", "trust", &format!("plugins/{}", library("gyroid"))]);
    assert!(trust.code == 1 && trust.err.contains("cannot use the library"), "{trust:?}");
    assert!(!folder.path("config").exists());
}

#[test]
fn mistakes_about_libraries_are_told_with_what_would_be_right() {
    let folder = Folder::new("library-usage").with("a.scene", SCENE).with("Upper.so", "");
    let odd = format!("plugins/{}", library("Odd-Name"));
    let folder = folder.with(&odd, "");
    for (args, code, told) in [
        (&["plugin", "trust", "none.so"][..], 1, "none.so"),
        (&["plugin", "trust", "a.scene"], 1, "a to z"),
        (&["plugin", "distrust", "gyroid"], 1, "no plugin library is trusted"),
        (&["plugin", "test", "./none.so"], 1, "none.so"),
        (&["plugin", "test", "./none.so", "--mutants"], 2, "its own plugins"),
        (&["plugin", "test", "filter", "box", "more"], 2, "a path"),
        (&["plugin", "new", "materail", "x"], 2, "did you mean `material`"),
        (&["plugin", "new", "material", "diffuse"], 2, "already"),
        (&["plugin", "new", "material", "../x"], 2, "a to z"),
        (&["plugin", "new", "material", "fn"], 2, "Rust"),
        (&["check", "a.scene", "--plugin-dir", "none"], 0, "no plugin folder `none`"),
        (&["check", "a.scene", "--plugin-dir", "plugins"], 0, "Odd-Name"),
        (&["render", "a.scene", "--builtins", "plugins/none.so"], 1, "none.so"),
    ] {
        let done = folder.luxel(args);
        assert!(done.code == code && done.err.contains(told), "{args:?}: {done:?}");
    }
    folder.write("config/luxel/config.toml", "\nplugin_dir = []\n");
    let done = folder.luxel(&["list"]);
    let told = ["config.toml", "line 2", "plugin_dir"].map(|part| done.err.contains(part));
    assert!(done.code == 1 && told == [true; 3], "{done:?}");
}

#[test]
fn distrust_removes_what_the_lock_lists_and_opens_nothing() {
    let folder = Folder::new("distrust");
    let entry = |stem: &str| {
        format!(
            "[[plugin]]\nstem = \"{stem}\"\nname = \"{stem}\"\nversion = \"1.0.0\"\nabi = \"1.0\"\n\
             sha256 = \"00\"\npath = \"/none/{}\"\n",
            library(stem)
        )
    };
    folder.write("config/luxel/plugins.lock", &(entry("gyroid") + &entry("velvet")));
    let list = folder.luxel(&["plugin", "list"]);
    assert!(list.code == 0 && list.out.matches("trusted, but missing").count() == 2, "{list:?}");
    let wrong = folder.luxel(&["plugin", "distrust", "gyrod"]);
    assert!(wrong.code == 1 && wrong.err.contains("did you mean `gyroid`"), "{wrong:?}");
    let done = folder.luxel(&["plugin", "distrust", "gyroid"]);
    assert!(done.code == 0 && done.out.contains("no longer trusted: gyroid 1.0.0"), "{done:?}");
    let left = String::from_utf8(folder.read("config/luxel/plugins.lock")).unwrap();
    assert!(left.contains("velvet") && !left.contains("gyroid"), "{left}");
    assert_eq!(folder.names(), ["config"]);
}

#[test]
fn a_new_plugin_is_a_crate_that_is_never_written_over() {
    let folder = Folder::new("new");
    let done = folder.luxel(&["plugin", "new", "phase", "air"]);
    assert!(done.code == 0 && done.out.contains("README.md"), "{done:?}");
    assert_eq!(folder.names(), ["air"]);
    let source = String::from_utf8(folder.read("air/src/lib.rs")).unwrap();
    assert!(source.contains("luxel_sdk::plugin! { phase \"air\" => Air; }"), "{source}");
    let manifest = String::from_utf8(folder.read("air/Cargo.toml")).unwrap();
    assert!(manifest.contains("cdylib") && manifest.contains("panic = \"unwind\""), "{manifest}");
    folder.write("air/src/lib.rs", "mine");
    let again = folder.luxel(&["plugin", "new", "phase", "air"]);
    assert!(again.code == 1 && again.err.contains("is there already"), "{again:?}");
    assert_eq!(folder.read("air/src/lib.rs"), b"mine");
}
