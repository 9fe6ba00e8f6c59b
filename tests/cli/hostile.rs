//! Scenes and folders that would have the program open a library: nothing of it runs.
#![cfg(unix)]

use std::env::consts::DLL_SUFFIX;
use std::fs;
use std::process::Command;

use super::program::{Done, Folder, SCENE};

/// A folder with a library that leaves a mark when it is opened, and a scene that would like it.
struct Trap(Folder);

impl Trap {
    /// The library is in `plugins/` and beside the scenes.
    fn new(name: &str) -> Self {
        let folder = Folder::new(name);
        let source = "#include <stdio.h>\n__attribute__((constructor)) static void mark(void) {\n\
                      FILE *file = fopen(MARK, \"w\"); if (file) fclose(file); }\n";
        folder.write("evil.c", source).write("plugins/none", "").write("scenes/none", "");
        let mark = format!("-DMARK=\"{}\"", folder.path("mark").display());
        let library = format!("plugins/libevil{DLL_SUFFIX}");
        let built = Command::new("cc")
            .args(["-shared", "-fPIC", &mark, "-o", &library, "evil.c"])
            .current_dir(folder.path(""))
            .status();
        assert!(built.unwrap().success(), "the library builds");
        fs::copy(folder.path(&library), folder.path(&format!("scenes/libevil{DLL_SUFFIX}")))
            .unwrap();
        Self(folder)
    }

    fn library(&self) -> String {
        self.0.path(&format!("plugins/libevil{DLL_SUFFIX}")).display().to_string()
    }

    /// Whether the library was opened since the last time.
    fn was_sprung(&self) -> bool {
        fs::remove_file(self.0.path("mark")).is_ok()
    }

    /// Runs the program in the scenes' folder.
    fn luxel(&self, variables: &[(&str, &str)], args: &[&str]) -> Done {
        self.0.luxel_below("scenes", variables, args)
    }

    /// A trap that nothing springs proves nothing.
    fn springs(&self) {
        assert!(!self.was_sprung());
        let done = self.luxel(&[], &["plugin", "trust", &self.library()]);
        assert!(self.was_sprung(), "trusting a library opens it: {done:?}");
        // It is no plugin, and so it is not trusted.
        assert!(done.code == 1 && done.err.contains("its code runs now"), "{done:?}");
        assert!(!self.0.path("config/luxel/plugins.lock").exists());
    }
}

#[test]
fn no_scene_makes_the_program_open_a_library() {
    let trap = Trap::new("hostile-scenes");
    trap.springs();
    let (path, relative) = (trap.library(), format!("../plugins/libevil{DLL_SUFFIX}"));
    let link = trap.0.path(&format!("scenes/liblink{DLL_SUFFIX}"));
    std::os::unix::fs::symlink(&path, link).unwrap();
    let words = ["evil", "link", "..", "libevil", "../plugins/evil", &path, &relative, "evil.so"];
    let classes = words
        .iter()
        .flat_map(|word| [format!("material {word} {{}}"), format!("material \"{word}\" {{}}")]);
    let files = [format!("libevil{DLL_SUFFIX}"), format!("liblink{DLL_SUFFIX}"), path.clone()];
    let reads = files.iter().flat_map(|file| {
        [
            format!("include \"{file}\""),
            format!("import \"{file}\" as x"),
            format!("let x = asset gltf {{ file = \"{file}\", unit = 1 m }}\nplace x {{}}"),
            format!("let x = texture image {{ file = \"{file}\" }}\nlet y = material diffuse {{ reflectance = x }}\nshape sphere {{ radius = 1 m, material = y }}"),
        ]
    });
    let uses = [
        "use plugin \"evil\" version \"1\"".to_owned(),
        format!("use plugin \"{path}\""),
        "set plugin_dirs = [\".\"]".to_owned(),
        format!("film rgb {{ file = \"{path}\" }}"),
    ];
    let mut tried = 0;
    for hostile in classes.chain(reads).chain(uses) {
        trap.0.write("scenes/a.scene", &format!("{SCENE}{hostile}\n"));
        let done = trap.luxel(&[], &["check", "a.scene"]);
        assert!(!trap.was_sprung(), "{hostile}: {done:?}");
        assert_eq!(done.code, 1, "{hostile}: {done:?}");
        tried += 1;
    }
    assert!(tried > 25);
}

#[test]
fn the_folders_of_the_scene_and_of_the_program_are_not_searched() {
    let trap = Trap::new("hostile-folders");
    trap.springs();
    let own = format!("{SCENE}shape evil {{}}\n");
    let dirs = "plugin_dirs = [\".\", \"../plugins\"]\n";
    trap.0.write("scenes/a.scene", &own);
    for place in ["scenes/", "scenes/luxel/", "scenes/.config/luxel/", "scenes/config/luxel/"] {
        trap.0.write(&format!("{place}config.toml"), dirs);
    }
    for variables in [
        &[][..],
        &[("LUXEL_PLUGIN_PATH", ".")],
        &[("LUXEL_PLUGIN_PATH", ":")],
        &[("LUXEL_PLUGIN_PATH", "../plugins:./")],
        &[("XDG_CONFIG_HOME", "."), ("HOME", ".")],
        &[("XDG_CONFIG_HOME", ""), ("HOME", "")],
    ] {
        for args in [
            &["check", "a.scene", "--allow-unlocked-plugins"][..],
            &["render", "a.scene", "--allow-unlocked-plugins"],
            &["list", "--allow-unlocked-plugins"],
            &["plugin", "list", "--allow-unlocked-plugins"],
        ] {
            let done = trap.luxel(variables, args);
            assert!(!trap.was_sprung(), "{variables:?} {args:?}: {done:?}");
        }
    }
    let told = trap.luxel(&[("LUXEL_PLUGIN_PATH", ".")], &["list"]).err;
    assert!(told.contains("`.` of LUXEL_PLUGIN_PATH is not searched"), "{told}");
    // Searched and allowed, it is opened: the above could have failed.
    let all = ["list", "--allow-unlocked-plugins", "--plugin-dir", "../plugins"];
    trap.luxel(&[], &all);
    assert!(trap.was_sprung());
    let folder = trap.0.path("plugins").display().to_string();
    trap.luxel(&[("LUXEL_PLUGIN_PATH", &folder)], &["list", "--allow-unlocked-plugins"]);
    assert!(trap.was_sprung());
}

#[test]
fn what_is_searched_is_opened_only_when_its_bytes_are_trusted() {
    let trap = Trap::new("hostile-lock");
    trap.springs();
    let path = trap.library();
    let link = trap.0.path(&format!("plugins/liblink{DLL_SUFFIX}"));
    std::os::unix::fs::symlink(&path, link).unwrap();
    trap.0.write("scenes/a.scene", &format!("{SCENE}shape evil {{}}\n"));
    let (other, none) = ("0".repeat(64), "");
    let entry = |stem: &str, sha256: &str| {
        format!(
            "[[plugin]]\nstem = \"{stem}\"\nname = \"evil\"\nversion = \"1.0.0\"\nabi = \"1.0\"\n\
             sha256 = \"{sha256}\"\npath = \"{path}\"\n"
        )
    };
    for (lock, code, told) in [
        (String::new(), 1, "is not trusted: luxel plugin trust"),
        (entry("evil", &other), 1, "has changed since it was trusted: luxel plugin trust"),
        (entry("evil", none), 1, "has changed since"),
        (entry("evil", "*"), 1, "has changed since"),
        (entry("*", &other), 1, "is not trusted"),
        ("plugin = 7".to_owned(), 1, "line 1"),
        ("[[plugin]]\n".to_owned(), 1, "cannot be understood"),
    ] {
        trap.0.write("config/luxel/plugins.lock", &lock);
        let done = trap.luxel(&[], &["check", "a.scene", "--plugin-dir", "../plugins"]);
        assert!(!trap.was_sprung(), "{lock}: {done:?}");
        assert!(done.code == code && done.err.contains(told), "{lock}: {done:?}");
        let list = trap.luxel(&[], &["plugin", "list", "--plugin-dir", "../plugins"]);
        assert!(!trap.was_sprung(), "{lock}: {list:?}");
    }
}
