//! `luxel watch`, as an editor sees it.
#![cfg(unix)]

use std::os::unix::fs::MetadataExt;

use super::program::{Folder, SCENE};
use super::until;

#[test]
fn a_save_changes_the_picture_a_mistake_keeps_it_and_ctrl_c_ends_well() {
    let folder = Folder::new("watch").with("a.scene", SCENE);
    let mut watching = folder.start(&["watch", "a.scene"]);
    until("the first picture", || !folder.read("a.exr").is_empty());
    let first = folder.read("a.exr");

    let darker = SCENE.replace("reflectance = 0.5", "reflectance = 0.1");
    folder.write("a.scene", &darker);
    until("the second picture", || folder.read("a.exr") != first);
    let second = folder.read("a.exr");

    folder.write("a.scene", &darker.replace("radius", "radus"));
    std::thread::sleep(std::time::Duration::from_millis(400));
    assert_eq!(folder.read("a.exr"), second);

    folder.write("a.scene", SCENE);
    until("the first picture again", || folder.read("a.exr") == first);
    watching.interrupt();
    let done = watching.end();
    assert_eq!(done.code, 0, "{done:?}");
    assert!(done.err.contains("E0402"), "{done:?}");
    assert_eq!(folder.names(), ["a.exr", "a.png", "a.scene"]);
}

#[test]
fn the_end_leaves_both_files_of_one_picture() {
    let folder = Folder::new("watch-pair").with("a.scene", SCENE);
    let mut watching = folder.start(&["watch", "a.scene"]);
    until("the first picture", || !folder.read("a.png").is_empty());
    let [exr, png] = ["a.exr", "a.png"].map(|name| folder.read(name));
    folder.write("a.scene", &SCENE.replace("samples = 4", "samples = 1000000"));
    until("the first samples of the second", || folder.read("a.png") != png);
    assert_eq!(folder.read("a.exr"), exr);
    watching.interrupt();
    let done = watching.end();
    assert!(done.code == 0 && done.out.contains(", interrupted after 0."), "{done:?}");
    assert!(done.out.contains(" of 1000000 spp, "), "{done:?}");
    assert_ne!(folder.read("a.exr"), exr);
    // Of one that is wanted whole that is no good end.
    let mut once = folder.start(&["watch", "a.scene", "--once-stable", "-o", "b"]);
    until("the first samples", || folder.names().contains(&"b.png".to_owned()));
    once.interrupt();
    let done = once.end();
    assert!(done.code == 3 && done.err.contains("watching has ended"), "{done:?}");
    assert_eq!(folder.names(), ["a.exr", "a.png", "a.scene", "b.exr", "b.png"]);
}

#[test]
fn a_watch_whose_json_nobody_reads_ends() {
    let folder = Folder::new("watch-unheard").with("a.scene", SCENE);
    let mut watching = folder.start(&["watch", "a.scene", "--json"]);
    until("the first picture", || !folder.read("a.png").is_empty());
    watching.turn_away();
    for i in 0.. {
        if watching.is_over() {
            break;
        }
        assert!(i < 100, "it goes on");
        folder.write("a.scene", &SCENE.replace("samples = 4", &format!("samples = {}", 5 + i)));
        std::thread::sleep(std::time::Duration::from_millis(200));
    }
    assert_eq!(watching.end().code, 0);
}

#[test]
fn comments_and_mistakes_leave_a_render_in_hand_alone() {
    let scene = |comment: &str, radius: &str| {
        let long = SCENE.replace("samples = 4", "samples = 3072").replace("radius", radius);
        format!("{long}// {comment}\n")
    };
    assert!(scene("", "radius").contains("3072"), "the test's scene has another form");
    let folder = Folder::new("watch-goes-on").with("a.scene", &scene("one", "radius"));
    let mut watching = folder.start(&["watch", "a.scene", "--json"]);
    until("the coarse picture", || folder.names().contains(&"a.png".to_owned()));
    // Each picture, a coarse one too, is another file.
    let file = || std::fs::metadata(folder.path("a.png")).unwrap().ino();
    let is_done = || folder.names().contains(&"a.exr".to_owned());
    let coarse = file();
    folder.write("a.scene", &scene("two", "radus"));
    std::thread::sleep(std::time::Duration::from_millis(400));
    folder.write("a.scene", &scene("three", "radius"));
    std::thread::sleep(std::time::Duration::from_millis(400));
    // A machine that is done by now shows less.
    assert!(file() == coarse || is_done(), "it began anew");
    until("the picture", is_done);
    // Another comment once it is done asks for nothing either.
    std::thread::sleep(std::time::Duration::from_millis(100));
    let done = file();
    folder.write("a.scene", &scene("four", "radius"));
    std::thread::sleep(std::time::Duration::from_millis(800));
    assert_eq!(file(), done);
    watching.interrupt();
    let done = watching.end();
    assert_eq!(done.code, 0, "{done:?}");
    assert!(done.err.contains("E0402"), "{done:?}");
    let told = done.out.lines().map(|line| serde_json::from_str(line).unwrap());
    let told: Vec<serde_json::Value> = told.collect();
    let of = |name: &str| told.iter().filter(|it| !it[name].is_null()).count();
    assert_eq!(of("exr"), 1, "one picture, told once: {done:?}");
    // And that a mistake is gone: of half a save none is told.
    assert_eq!((told.len(), of("edit")), (2, 2), "{done:?}");
}

#[test]
fn a_picture_that_could_not_be_written_is_tried_again_at_the_next_save() {
    let folder = Folder::new("watch-tried-again").with("a.scene", SCENE).with("out/kept", "");
    let mut watching = folder.start(&["watch", "a.scene", "-o", "out/a", "--json"]);
    let is_written = || folder.path("out/a.exr").exists();
    until("the first picture", is_written);
    std::fs::rename(folder.path("out"), folder.path("away")).unwrap();
    folder.write("a.scene", &SCENE.replace("samples = 4", "samples = 5"));
    // What goes wrong is JSON too.
    let told = watching.says(|line| serde_json::from_str::<serde_json::Value>(line).ok());
    assert_eq!(told["severity"], "error", "{told}");
    assert!(told["message"].as_str().unwrap().contains("out"), "{told}");
    std::fs::create_dir(folder.path("out")).unwrap();
    folder.write("a.scene", &format!("{}// again\n", SCENE.replace("samples = 4", "samples = 5")));
    until("the picture again", is_written);
    watching.interrupt();
    let done = watching.end();
    assert_eq!(done.code, 0, "{done:?}");
}

#[test]
fn a_mistake_that_is_taken_back_is_told_to_be_gone() {
    let folder = Folder::new("watch-taken-back").with("a.scene", SCENE);
    let mut watching = folder.start(&["watch", "a.scene"]);
    until("the picture", || !folder.read("a.exr").is_empty());
    folder.write("a.scene", &SCENE.replace("radius", "radus"));
    std::thread::sleep(std::time::Duration::from_millis(800));
    folder.write("a.scene", SCENE);
    std::thread::sleep(std::time::Duration::from_millis(800));
    // The file is as it was before, which is no news.
    folder.write("a.scene", &format!("{SCENE}// as it was\n"));
    std::thread::sleep(std::time::Duration::from_millis(800));
    watching.interrupt();
    let done = watching.end();
    let (_, after) = done.err.split_once("E0402").unwrap_or_else(|| panic!("{done:?}"));
    assert_eq!(after.matches("as before · nothing made anew · ").count(), 1, "{done:?}");
}

#[test]
fn another_exposure_shows_what_was_measured_in_another_way() {
    let folder = Folder::new("watch-exposure").with("a.scene", SCENE);
    let mut watching = folder.start(&["watch", "a.scene", "--json"]);
    // It takes its place after the EXR.
    until("the first picture", || !folder.read("a.png").is_empty());
    let first = folder.read("a.png");
    let brighter = SCENE.replace("film rgb {", "film rgb { exposure = 1.5,");
    assert_ne!(brighter, SCENE, "the test's scene has another form");
    folder.write("a.scene", &brighter);
    until("the brighter picture", || folder.read("a.png") != first);
    let second = folder.read("a.png");
    folder.write("a.scene", &brighter.replace("exposure", "file = \"b\", exposure"));
    until("the picture elsewhere", || folder.names().contains(&"b.png".to_owned()));
    watching.interrupt();
    let done = watching.end();
    assert_eq!(done.code, 0, "{done:?}");
    assert_eq!(folder.read("b.png"), second);
    let told: Vec<serde_json::Value> =
        done.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let changes = told.iter().map(|it| it["edit"]["changes"].clone());
    let words = [vec![], vec!["film rgb: exposure"], vec!["film rgb: file"]];
    assert_eq!(changes.collect::<Vec<_>>(), words.map(serde_json::Value::from), "{done:?}");
    // Two renders never take the same time to the last bit.
    assert!(told.iter().all(|it| it["seconds"] == told[0]["seconds"]), "measured again: {done:?}");

    // A fresh render of the same text is the same picture.
    let fresh = folder.luxel(&["render", "a.scene", "-o", "c"]);
    assert_eq!(fresh.code, 0, "{fresh:?}");
    assert_eq!(folder.read("c.exr"), folder.read("b.exr"));
}

#[test]
fn once_a_scene_is_stable_its_picture_is_the_end_and_a_command_follows_it() {
    let folder = Folder::new("watch-once").with("a.scene", &SCENE.replace("radius", "radus"));
    let command = "cp $LUXEL_PNG seen.png; echo $LUXEL_SCENE $LUXEL_EXR; exit 3";
    let watching =
        folder.start(&["watch", "a.scene", "--once-stable", "--json", "--exec", command]);
    std::thread::sleep(std::time::Duration::from_millis(400));
    assert!(!folder.names().contains(&"a.png".to_owned()), "a mistake is not the end");
    folder.write("a.scene", SCENE);
    let done = watching.end();
    assert_eq!(done.code, 0, "{done:?}");
    assert_eq!(folder.read("seen.png"), folder.read("a.png"));
    assert!(
        done.err.contains("a.scene a.exr\n") && done.err.contains("exit status: 3"),
        "{done:?}"
    );
    assert_eq!(done.out.lines().count(), 1, "one picture, told once: {done:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_hundred_edits_leave_no_file_open_and_no_thread() {
    let scene = |n: u32| {
        let mesh = "shape mesh { file = \"a.obj\", unit = 1 m }";
        SCENE.replace("= 0.5", &format!("= 0.{n:03}")).replace("= 4", "= 1") + mesh
    };
    let mesh = |n: u32| format!("v 0 0 0\nv 1 0 0\nv 0 1 {n}\nf 1 2 3\n");
    let folder = Folder::new("watch-holds").with("a.scene", &scene(1)).with("a.obj", &mesh(1));
    let mut watching =
        folder.start(&["watch", "a.scene", "--quiet", "--preview", "--no-open", "--port=0"]);
    let picture = || folder.read("a.exr");
    until("the first picture", || !picture().is_empty());
    let edit = |n: u32| {
        let before = picture();
        folder.write("a.obj", &mesh(n));
        folder.write("a.scene", &if n % 10 == 7 { scene(n) + "mistake" } else { scene(n) });
        // A picture now and then: most edits overtake the one before.
        if n % 10 == 1 {
            until("a picture", || picture() != before);
        }
        std::thread::sleep(std::time::Duration::from_millis(3));
    };
    (2..12).for_each(edit);
    // A picture that is being written has a file open: what is held at rest stays the same.
    let mut held = watching.held();
    until("rest", || {
        std::thread::sleep(std::time::Duration::from_millis(300));
        let before = std::mem::replace(&mut held, watching.held());
        held == before
    });
    let [files, threads] = held;
    (12..112).for_each(edit);
    // Those of one pool may come, which the first build that is cut off midway starts; a thread that
    // stays of each edit would be a hundred.
    let pool = std::thread::available_parallelism().unwrap().get();
    let is_at_rest =
        |[now_files, now_threads]: [usize; 2]| now_files == files && now_threads <= threads + pool;
    until("what was held before", || is_at_rest(watching.held()));
    watching.interrupt();
    assert_eq!(watching.end().code, 0);
}

#[test]
fn a_picture_that_could_not_be_written_comes_once_it_can() {
    let to = |file: &str| SCENE.replace("film rgb {", &format!("film rgb {{ file = \"{file}\","));
    let folder = Folder::new("watch-unwritable").with("a.scene", &to("no/a"));
    let mut watching = folder.start(&["watch", "a.scene"]);
    std::thread::sleep(std::time::Duration::from_millis(400));
    folder.write("a.scene", &to("b"));
    until("the picture that was never measured", || folder.names().contains(&"b.png".to_owned()));
    folder.write("a.scene", &to("no/c"));
    std::thread::sleep(std::time::Duration::from_millis(400));
    folder.write("a.scene", &to("d"));
    until("the picture that was measured", || folder.names().contains(&"d.png".to_owned()));
    assert_eq!(folder.read("b.png"), folder.read("d.png"));
    watching.interrupt();
    let done = watching.end();
    assert_eq!((done.code, done.err.matches("cannot write").count()), (0, 2), "{done:?}");
}

#[test]
fn once_stable_without_a_picture_on_the_disk_is_no_success() {
    let scene = SCENE.replace("film rgb {", "film rgb { file = \"no/a\",");
    let folder = Folder::new("watch-once-unwritable").with("a.scene", &scene);
    let done = folder.luxel(&["watch", "a.scene", "--once-stable"]);
    assert_eq!(done.code, 1, "{done:?}");
    assert!(done.err.contains("cannot write"), "{done:?}");
}

#[test]
fn a_scene_that_reads_its_own_output_is_refused_until_it_does_not() {
    let folder = Folder::new("watch-own-output").with("a.scene", SCENE);
    assert_eq!(folder.luxel(&["render", "a.scene", "-q", "-o", "sky"]).code, 0);
    let sky = folder.read("sky.exr");
    let scene =
        SCENE.replace("light constant { scale = 1 }", "light environment { file = \"sky.exr\" }");
    let folder = folder.with("b.scene", &scene);
    let mut watching = folder.start(&["watch", "b.scene", "-o", "sky", "--json"]);
    std::thread::sleep(std::time::Duration::from_millis(600));
    assert!(!watching.is_over() && folder.read("sky.exr") == sky, "it is read and not written");
    // Brighter than what lies there: the same scene would make the same bytes.
    folder.write("b.scene", &SCENE.replace("constant { scale = 1 }", "constant { scale = 2 }"));
    until("a picture", || folder.read("sky.exr") != sky);
    watching.interrupt();
    let done = watching.end();
    assert_eq!((done.code, done.err.matches("its own output").count()), (0, 1), "{done:?}");
    assert_eq!(done.out.lines().count(), 1, "one picture: {done:?}");
}
