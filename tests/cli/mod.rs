//! The program as a person runs it: exit codes, files, interrupts.

#[cfg(test)]
mod attacks;
#[cfg(test)]
mod compare;
#[cfg(test)]
mod denoise;
#[cfg(test)]
mod diff;
#[cfg(test)]
mod docs;
#[cfg(test)]
mod explain;
#[cfg(test)]
mod faulty;
mod fix;
#[cfg(test)]
mod fmt;
mod grown;
mod hostile;
mod isolate;
mod judged;
mod libraries;
mod lsp;
mod origin;
mod plugin;
#[cfg(test)]
pub(crate) mod program;
mod resume;
mod study;
mod tev;
#[cfg(test)]
mod tutorial;
mod verify;
mod watch;

use std::time::{Duration, Instant};

use program::{Folder, SCENE};

#[test]
fn a_scene_becomes_two_pictures_named_after_it_in_the_current_folder() {
    let folder = Folder::new("two-pictures").with("scenes/ball.scene", SCENE);
    let done = folder.luxel(&["render", "scenes/ball.scene"]);
    assert_eq!(done.code, 0, "{done:?}");
    assert!(done.out.contains("wrote ball.exr and ball.png"), "{done:?}");
    assert_eq!(folder.names(), ["ball.exr", "ball.png", "scenes"]);
    assert!(folder.read("ball.exr").starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    assert!(folder.read("ball.png").starts_with(b"\x89PNG"));
}

#[test]
fn a_picture_in_which_nothing_shines_is_told_to_be_black() {
    let dark = SCENE.replace("light constant { scale = 1 }\n", "");
    let folder = Folder::new("dark").with("a.scene", SCENE).with("dark.scene", &dark);
    for (scene, is_told) in [("a.scene", false), ("dark.scene", true)] {
        let done = folder.luxel(&["render", scene]);
        assert_eq!(
            (done.code, done.out.contains("the picture is black")),
            (0, is_told),
            "{done:?}"
        );
    }
}

#[test]
fn the_same_scene_gives_the_same_bytes_for_any_number_of_threads() {
    let folder = Folder::new("same-bytes").with("a.scene", SCENE);
    for (name, threads) in [("one", "1"), ("three", "3")] {
        let done = folder.luxel(&["render", "a.scene", "-q", "--threads", threads, "-o", name]);
        assert_eq!((done.code, done.out.as_str(), done.err.as_str()), (0, "", ""));
    }
    assert_eq!(folder.read("one.exr"), folder.read("three.exr"));
    assert_eq!(folder.read("one.png"), folder.read("three.png"));
    folder.luxel(&["render", "a.scene", "-q", "--seed", "9", "-o", "other"]);
    assert_ne!(folder.read("one.exr"), folder.read("other.exr"));
}

#[test]
fn json_tells_size_samples_and_files() {
    let folder = Folder::new("json").with("a.scene", SCENE);
    let done = folder.luxel(&[
        "render",
        "a.scene",
        "--json",
        "--size",
        "20x10",
        "--spp",
        "3",
        "--crop",
        "15,0,10,5",
        "--precision",
        "exact",
    ]);
    assert_eq!(done.code, 0, "{done:?}");
    for part in [
        r#""size":[20,10]"#,
        r#""window":[15,0,5,5]"#,
        r#""samples":75"#,
        r#""complete":true"#,
        r#""bad_samples":0"#,
        r#""exr":"a.exr""#,
    ] {
        assert!(done.out.contains(part), "{part} in {}", done.out);
    }
    assert_eq!(done.out.lines().count(), 1);
    // How the picture came about stands in its file, too.
    let exr = folder.read("a.exr");
    let exr = String::from_utf8_lossy(&exr);
    for part in [
        r#""precision":"exact""#,
        r#""sampler":"sobol""#,
        r#""filter":"blackman_harris""#,
        r#""bad_samples":0"#,
        r#""size":[20,10]"#,
    ] {
        assert!(exr.contains(part), "{part}");
    }
}

#[test]
fn pixels_with_samples_that_are_not_finite_are_named() {
    // Four skies are brighter together than a number holds.
    let sky = "light constant { scale = 1 }\n";
    let bright = SCENE.replace(sky, &sky.replace('1', "1e38").repeat(4));
    let folder = Folder::new("bad").with("a.scene", &bright);
    let done = folder.luxel(&["render", "a.scene", "--json", "--strict"]);
    let told: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    let (first, bad) = (&told["first_bad_pixels"], told["bad_samples"].as_u64().unwrap());
    assert_eq!((done.code, first.as_array().map(Vec::len)), (4, Some(5)), "{done:?}");
    assert!(done.err.contains(&format!("{bad} samples were not finite and were left out")));
    let exr = folder.read("a.exr");
    assert!(String::from_utf8_lossy(&exr).contains(&format!("\"first_bad_pixels\":{first}")));
    let text = folder.luxel(&["render", "a.scene"]).out;
    let [n, x, y] = ["samples", "x", "y"].map(|key| first[0][key].as_u64().unwrap());
    assert!(
        text.contains(&format!("\nsamples that were not finite: {n} at ({x}, {y}), ")),
        "{text}"
    );
}

#[test]
fn mistakes_of_the_scene_are_told_at_their_place_with_code_1_and_no_picture() {
    let camera_end = SCENE.find("film").unwrap();
    let faults = [
        (format!("{SCENE}shape sphere {{ radus = 1 m }}"), "E0402"),
        (format!("{SCENE}shape mesh {{ file = \"none.obj\", unit = 1 m }}"), "E0413"),
        (format!("scene 1\n{}", &SCENE[camera_end..]), "E0409"),
        (SCENE.replace("rgb {", "rgb { file = \"../up.exr\","), "outside this folder"),
    ];
    for (scene, told) in faults {
        let folder = Folder::new("mistakes").with("a.scene", &scene);
        let done = folder.luxel(&["render", "a.scene"]);
        assert_eq!(done.code, 1, "{done:?}");
        assert!(done.err.contains(told), "{told}: {done:?}");
        assert_eq!(folder.names(), ["a.scene"]);
    }
}

#[test]
fn check_tells_place_and_code_as_json_lines() {
    let scene = format!("{SCENE}\nshape sphere {{ radus = 1 m }}\n");
    let folder = Folder::new("check").with("good.scene", SCENE).with("bad.scene", &scene);
    let good = folder.luxel(&["check", "good.scene"]);
    assert_eq!((good.code, good.out.as_str()), (0, "good.scene: fine\n"), "{good:?}");
    let both = folder.luxel(&["check", "--json", "good.scene", "bad.scene"]);
    assert_eq!(both.code, 1);
    let line = scene.lines().count();
    for part in [r#""code":"E0402""#, r#""file":"bad.scene""#, &format!("\"line\":{line},")] {
        assert!(both.out.contains(part), "{part} in {}", both.out);
    }
    let missing = folder.luxel(&["check", "none.scene"]);
    assert_eq!(missing.code, 1, "{missing:?}");
    assert!(missing.err.contains("none.scene"), "{missing:?}");
}

#[test]
fn what_has_no_place_names_the_scene_that_it_is_of() {
    let blind = "scene 1\nlight constant { radiance = 1 nit }\n";
    let folder = Folder::new("unplaced").with("a.scene", SCENE).with("blind.scene", blind);
    let both = folder.luxel(&["check", "--json", "a.scene", "blind.scene", "none.scene"]);
    let told: Vec<serde_json::Value> =
        both.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let of = |code: &str| told.iter().find(|it| it["code"] == code).map(|it| it["file"].clone());
    assert_eq!(of("E0409"), Some("blind.scene".into()), "{both:?}");
    assert_eq!(of("E0107"), Some("none.scene".into()), "{both:?}");
    let text = folder.luxel(&["check", "blind.scene"]);
    assert!(text.err.contains("--> blind.scene\n"), "{text:?}");
    let lost = folder.luxel(&["render", "a.scene", "-o", "none/a", "--json"]);
    let told: serde_json::Value = serde_json::from_str(lost.err.trim()).unwrap();
    assert!(lost.code == 1 && told["severity"] == "error", "{lost:?}");
}

#[cfg(unix)]
#[test]
fn a_scene_may_be_a_link_to_another_folder_and_its_files_may_not() {
    use std::os::unix::fs::symlink;

    let scene = format!("{SCENE}include \"more.scene\"\n");
    let folder =
        Folder::new("linked").with("real/a.scene", &scene).with("in/more.scene", "scene 1\n");
    symlink("../real/a.scene", folder.path("in/a.scene")).unwrap();
    assert_eq!(folder.luxel(&["check", "in/a.scene"]).code, 0);
    std::fs::remove_file(folder.path("in/more.scene")).unwrap();
    folder.write("real/more.scene", "scene 1\n");
    symlink("../real/more.scene", folder.path("in/more.scene")).unwrap();
    let done = folder.luxel(&["check", "in/a.scene"]);
    assert!(done.code == 1 && done.err.contains("E0108"), "{done:?}");
}

#[test]
fn check_prints_the_scene_graph() {
    let folder = Folder::new("print").with("a.scene", SCENE);
    let done = folder.luxel(&["check", "--print", "a.scene"]);
    assert!(done.code == 0 && done.out.contains("sphere"), "{done:?}");
}

#[test]
fn mistakes_of_the_command_line_end_with_code_2() {
    let folder = Folder::new("usage").with("a.scene", SCENE);
    for args in [
        &["render"][..],
        &["paint", "a.scene"],
        &["render", "a.scene", "--size", "0x4"],
        &["render", "a.scene", "--spp", "0"],
        &["render", "a.scene", "--crop", "99,99,4,4"],
        &["watch", "a.scene", "--port", "8123"],
        &["watch", "a.scene", "--no-open"],
        &["watch", "a.scene", "--allow-host", "box.example"],
    ] {
        let done = folder.luxel(args);
        assert_eq!(done.code, 2, "{args:?}: {done:?}");
        assert!(!done.err.is_empty());
    }
    assert_eq!(folder.names(), ["a.scene"]);
}

#[test]
fn a_place_that_cannot_be_written_is_told_before_rendering() {
    let folder = Folder::new("unwritable").with("a.scene", SCENE).with("taken.exr/x", "");
    // At this many samples the render would take days.
    for place in ["none/out", "taken"] {
        let done = folder.luxel(&["render", "a.scene", "--spp", "4000000000", "-o", place]);
        assert_eq!(done.code, 1, "{done:?}");
        assert!(done.err.contains(&format!("cannot write `{place}.exr`")), "{done:?}");
    }
    assert_eq!(folder.names(), ["a.scene", "taken.exr"]);
}

#[test]
fn unknown_names_are_answered_with_the_nearest() {
    let folder = Folder::new("names");
    let kind = folder.luxel(&["list", "materail"]);
    assert!(kind.code == 1 && kind.err.contains("did you mean `material`"), "{kind:?}");
    let name = folder.luxel(&["describe", "shape", "spher"]);
    assert!(name.code == 1 && name.err.contains("did you mean `sphere`"), "{name:?}");
    let page = folder.luxel(&["describe", "shape", "sphere"]);
    assert!(page.code == 0 && page.out.contains("radius: number, in m"), "{page:?}");
    let which = folder.luxel(&["describe", "shape"]);
    assert!(which.code == 2 && which.err.contains("known: ") && which.err.contains("sphere"));
    let group = folder.luxel(&["describe", "group"]);
    assert!(group.code == 0 && group.out.contains("place pair"), "{group:?}");
    let one = folder.luxel(&["list", "group"]);
    assert!(one.code == 0 && one.out.starts_with("group ") && one.out.lines().count() == 1);
    let list = folder.luxel(&["list"]);
    assert!(list.out.contains("\ngroup "), "{list:?}");
    assert!(list.code == 0 && list.out.contains("sphere") && list.out.contains("sobol"));
}

#[cfg(unix)]
#[test]
fn an_interrupt_leaves_a_valid_picture_and_says_so() {
    let folder = Folder::new("interrupt").with("a.scene", SCENE);
    let mut running = folder.start(&["render", "a.scene", "--spp", "4000000000", "--json"]);
    // Whatever the machine is busy with, the first pass is done well within this time.
    std::thread::sleep(Duration::from_millis(700));
    running.interrupt();
    let done = running.end();
    assert_eq!(done.code, 3, "{done:?}");
    assert!(done.out.contains(r#""complete":false"#), "{done:?}");
    assert_eq!(folder.names(), ["a.checkpoint", "a.exr", "a.png", "a.scene"]);
    // Reading it as a scene's texture proves that it is whole.
    let read = "scene 1\nlet t = texture image { file = \"a.exr\" }\n";
    let scene = SCENE.replace("scene 1\n", read).replace("reflectance = 0.5", "reflectance = t");
    let again = Folder::write(&folder, "b.scene", &scene).luxel(&["check", "b.scene"]);
    assert_eq!(again.code, 0, "{again:?}");
}

#[cfg(unix)]
#[test]
fn a_second_interrupt_still_leaves_a_whole_picture() {
    let folder = Folder::new("twice").with("a.scene", SCENE);
    let mut running = folder.start(&["render", "a.scene", "--spp", "4000000000"]);
    std::thread::sleep(Duration::from_millis(700));
    let since = Instant::now();
    running.interrupt();
    running.interrupt();
    let done = running.end();
    assert_eq!(done.code, 3, "{done:?}");
    assert!(done.out.contains("wrote a.exr and a.png, interrupted"), "{done:?}");
    assert_eq!(folder.names(), ["a.checkpoint", "a.exr", "a.png", "a.scene"]);
    assert!(since.elapsed() < Duration::from_secs(10));
}

/// A mesh whose tree takes seconds to build.
#[cfg(target_os = "linux")]
fn large_ply() -> Vec<u8> {
    let side = 1400u16;
    let n = u32::from(side);
    let mut ply = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n\
         property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        n * n,
        2 * (n - 1) * (n - 1),
    )
    .into_bytes();
    for i in 0..side {
        for j in 0..side {
            let (x, y) = (f32::from(i), f32::from(j));
            let corner = [x, y, (x * 0.3).sin() * (y * 0.2).cos()];
            ply.extend(corner.into_iter().flat_map(f32::to_le_bytes));
        }
    }
    for (i, j) in (0..n - 1).flat_map(|i| (0..n - 1).map(move |j| (i, j))) {
        let at = i * n + j;
        for triangle in [[at, at + n, at + 1], [at + n, at + n + 1, at + 1]] {
            ply.push(3);
            ply.extend(triangle.into_iter().flat_map(u32::to_le_bytes));
        }
    }
    ply
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_while_a_mesh_is_read_or_built_ends_and_leaves_no_file() {
    let mesh = "shape mesh { file = \"big.ply\", unit = 1 mm }\n";
    let folder = Folder::new("cancel").with("a.scene", &format!("{SCENE}{mesh}"));
    folder.write_bytes("big.ply", &large_ply());
    for milliseconds in [0, 600, 1200] {
        let mut running = folder.start(&["render", "a.scene", "--spp", "4000000000"]);
        running.listens();
        std::thread::sleep(Duration::from_millis(milliseconds));
        running.interrupt();
        let done = running.end();
        assert_eq!((done.code, done.out.as_str()), (3, ""), "{done:?}");
        assert!(done.err.contains("before anything was measured: no picture"), "{done:?}");
        assert_eq!(folder.names(), ["a.scene", "big.ply"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_is_full_is_told_and_a_reader_who_leaves_is_not() {
    let folder = Folder::new("stdout").with("a.scene", SCENE);
    for args in [
        &["list"][..],
        &["describe", "shape", "sphere", "--json"],
        &["check", "--print", "a.scene"],
        &["--help"],
        &["render", "--help"],
        &["--version"],
    ] {
        let full = folder.luxel_under("exec >/dev/full", args);
        assert_eq!(full.code, 1, "{args:?}: {full:?}");
        assert!(full.err.contains("cannot write to standard output"), "{args:?}: {full:?}");
    }
    // The reader has gone before the first line is written.
    let left = folder.luxel_under("mkfifo p; (: <p) & exec >p; wait", &["list"]);
    assert_eq!((left.code, left.err.as_str()), (0, ""), "{left:?}");
}

#[cfg(unix)]
#[test]
fn a_full_disk_keeps_the_old_picture_and_leaves_nothing_else() {
    let folder = Folder::new("full").with("a.scene", SCENE).with("a.exr", "old");
    // A limit on the size of files stands in for the disk's: writing fails half way through.
    let done = folder
        .luxel_under("trap '' XFSZ; ulimit -f 8", &["render", "a.scene", "--size", "200x200"]);
    assert_eq!(done.code, 1, "{done:?}");
    assert!(done.err.contains("cannot write `a.exr`"), "{done:?}");
    assert_eq!(folder.read("a.exr"), b"old");
    assert_eq!(folder.names(), ["a.exr", "a.scene"]);
}

#[test]
fn a_scene_does_not_write_over_what_it_reads() {
    let folder = Folder::new("own-output").with("a.scene", SCENE);
    assert_eq!(folder.luxel(&["render", "a.scene", "-q", "-o", "sky"]).code, 0);
    let scene =
        SCENE.replace("light constant { scale = 1 }", "light environment { file = \"sky.exr\" }");
    let folder = folder.with("b.scene", &scene);
    let done = folder.luxel(&["render", "b.scene", "-o", "sky"]);
    assert!(done.code == 1 && done.err.contains("its own output"), "{done:?}");
}

/// Waits until `done`, at most a minute: a machine may have much else to do.
fn until(what: &str, mut done: impl FnMut() -> bool) {
    let since = Instant::now();
    while !done() {
        assert!(since.elapsed() < Duration::from_secs(60), "waited for {what}");
        std::thread::sleep(Duration::from_millis(10));
    }
}
