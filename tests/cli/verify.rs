//! `luxel verify FILE`: what scenes say of their pictures, held against them.

use super::program::{Done, Folder, SCENE};
use crate::disk::{files_below, root};

/// A white furnace, empty: every pixel is 1. What it says follows.
const WHITE: &str = r"scene 1
param bright: float = 1
param side: length = 32 m
param name: string = 'none'
camera perspective {
  look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0))
  fov = 40 deg
}
film rgb { resolution = (side / 1 m, 32) }
sampler independent { samples = 4 }
light constant { scale = bright }
";

fn white(said: &str) -> String {
    [&WHITE.replace('\'', "\""), said].concat()
}

fn verify(said: &str, args: &[&str]) -> Done {
    let folder = Folder::new("verify").with("a.scene", &white(said));
    folder.luxel(&[&["verify", "a.scene"], args].concat())
}

/// The cells of a table's row, joined by one blank.
fn row(done: &Done, begin: &str) -> String {
    let line = done.out.lines().find(|line| line.starts_with(begin));
    let line = line.unwrap_or_else(|| panic!("{begin}: {done:?}"));
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn what_is_said_of_the_whole_of_pixels_and_of_parts_holds() {
    let said = "expect mean = 1
        expect pixel (3, 4) = (1, 1, 1) ± 1e-6
        expect region (1, 2, 30, 20) = rgb.linear_srgb(1, 1, 1)";
    let done = verify(said, &[]);
    assert_eq!((done.code, done.err.as_str()), (0, ""), "{done:?}");
    assert_eq!(done.out.lines().count(), 1 + 7 + 2, "{}", done.out);
    assert!(done.out.ends_with("\nall 7 hold\n"), "{}", done.out);
    assert_eq!(row(&done, "a.scene:12"), "a.scene:12 mean 1.0000000 1.0000000 0.0e0 – ok");
    assert!(row(&done, "a.scene:13").starts_with("a.scene:13 pixel (3, 4) R 1.0000000"));
    assert!(done.out.contains("region (1, 2, 30, 20) B"), "{}", done.out);
}

#[test]
fn what_the_projects_scenes_say_holds() {
    let folder = Folder::new("verify-scenes");
    let scenes = files_below(&root().join("scenes"), "scene");
    let scenes: Vec<String> = scenes.iter().map(|path| path.display().to_string()).collect();
    let args = scenes.iter().map(String::as_str);
    let done = folder.luxel(&["verify"].into_iter().chain(args).collect::<Vec<_>>());
    assert!(done.code == 0 && done.out.ends_with("\nall 4 hold\n"), "{done:?}");
    assert!(done.err.contains("cornell.scene` expects nothing of its picture"), "{done:?}");
}

#[test]
fn scenes_that_all_expect_nothing_are_no_test() {
    let folder = Folder::new("verify-mute").with("a.scene", SCENE);
    let done = folder.luxel(&["verify", "a.scene"]);
    let told = done.err.contains("error: no scene expects anything of its picture");
    assert!(done.code == 1 && told, "{done:?}");
}

#[test]
fn rows_come_in_the_order_of_the_file() {
    let said = "expect mean = 2 where { bright = 2 }\nexpect mean = 1\nexpect mean = 2 where { bright = 2 }";
    let done = verify(said, &[]);
    let lines: Vec<&str> = done.out.lines().filter_map(|line| line.get(..10)).collect();
    assert_eq!(lines[1..4], ["a.scene:12", "a.scene:13", "a.scene:14"], "{done:?}");
}

#[test]
fn a_scene_that_cannot_be_tested_is_told_at_the_end() {
    let folder = Folder::new("verify-untested").with("a.scene", &white("expect mean = 1"));
    folder.write("b.scene", "scene 1\ncamera none {}\n");
    let done = folder.luxel(&["verify", "a.scene", "b.scene"]);
    assert_eq!(done.code, 1, "{done:?}");
    let end = "hold; 1 of 2 scenes could not be tested\n";
    assert!(done.out.ends_with(end), "{}", done.out);
}

#[test]
fn what_does_not_hold_is_told_with_its_line_and_exit_code_1() {
    let done = verify("expect mean = 1\nexpect pixel (0, 0) = (1, 1.1, 1) ± 0.05", &[]);
    assert_eq!(done.code, 1, "{done:?}");
    assert!(done.out.ends_with("\n1 of 4 do not hold\n"), "{}", done.out);
    let wrong: Vec<_> = done.out.lines().filter(|line| line.ends_with("WRONG")).collect();
    assert!(wrong.len() == 1 && wrong[0].starts_with("a.scene:13  pixel (0, 0) G  1.1000000"));
}

#[test]
fn noise_buys_no_pass_and_more_samples_end_it() {
    // A pixel that the edge of a ball of 0.5 before 1 goes through.
    let said = SCENE.replace("sobol", "independent") + "expect pixel (9, 10) = 0.58 ± 0.06";
    let folder = Folder::new("noisy").with("a.scene", &said);
    let few = folder.luxel(&["verify", "a.scene"]);
    assert!(few.code == 1 && row(&few, "a.scene").ends_with("NOISY"), "{few:?}");
    assert!(few.out.contains(" too noisy to tell; ") && !few.out.contains("hold"), "{few:?}");
    let many = folder.luxel(&["verify", "a.scene", "--spp", "256"]);
    assert!(many.code == 0 && row(&many, "a.scene").ends_with("ok"), "{many:?}");
}

#[test]
fn other_seeds_give_other_noise() {
    let folder = Folder::new("seeds").with("a.scene", &format!("{SCENE}expect mean = 0.9 ± 0.2"));
    let told = |seed: &str| folder.luxel(&["verify", "a.scene", "--seed", seed]).out;
    assert_eq!(told("1"), told("1"));
    assert_ne!(told("1"), told("2"));
}

#[test]
fn what_is_said_under_other_parameters_is_tested_under_them() {
    let said = "expect mean = bright
        expect mean = 2 * bright where { bright = 0.5 }
        expect mean = bright where { bright = 3 }
        for b in [4, 5] { expect mean = b where { bright = b, side = 16 m, name = \"x\" } }";
    let done = verify(said, &["--set", "bright=7"]);
    assert_eq!(done.code, 1, "{done:?}");
    let mean = |begin: &str| row(&done, begin);
    assert!(mean("a.scene:12").starts_with("a.scene:12 mean 7.0000000 7.0000000"));
    let wrong = "a.scene:13 mean bright=0.5 1.0000000 0.5000000 0.0e0 – WRONG";
    assert_eq!(mean("a.scene:13"), wrong);
    assert!(mean("a.scene:14").ends_with("3.0000000 3.0000000 0.0e0 – ok"));
    for b in [4, 5] {
        let shown = format!("mean bright={b} side=16 m name=\"x\"");
        assert!(done.out.contains(&shown), "{shown}: {}", done.out);
    }
}

#[test]
fn what_is_no_longer_said_under_its_own_parameters_is_told() {
    let done = verify("if bright == 1 { expect mean = 2 where { bright = 2 } }", &[]);
    assert!(done.code == 1 && done.err.contains("`a.scene:12` does not say"), "{done:?}");
}

#[test]
fn a_picture_is_that_of_another_scene_or_is_not() {
    let ball = SCENE.replace("samples = 4", "samples = 64");
    let folder = Folder::new("same")
        .with("ball.scene", &ball)
        .with("dark.scene", &ball.replace("reflectance = 0.5", "reflectance = 0.45"))
        .with("small.scene", &ball.replace("(32, 32)", "(16, 16)"))
        .with("a.scene", &format!("{ball}expect same_as \"ball.scene\""));
    let same = folder.luxel(&["verify", "a.scene"]);
    assert!(same.code == 0 && same.out.contains("same_as \"ball.scene\""), "{same:?}");
    // With as many samples as needed to tell the two apart: no noise is shared.
    assert!(!row(&same, "a.scene").contains("0.0e0"), "{same:?}");
    folder.write("a.scene", &format!("{ball}expect same_as \"dark.scene\""));
    let dark = folder.luxel(&["verify", "a.scene"]);
    assert!(dark.code == 1 && row(&dark, "a.scene").ends_with("WRONG"), "{dark:?}");
    assert!(dark.out.contains("same_as \"dark.scene\", region ("), "{dark:?}");
    folder.write("a.scene", &format!("{ball}expect same_as \"small.scene\""));
    let small = folder.luxel(&["verify", "a.scene"]);
    let told = "a.scene:10: the pictures have different sizes: 32 x 32, 16 x 16";
    assert!(small.code == 1 && small.err.contains(told), "{small:?}");
}

#[test]
fn one_scenes_mistake_keeps_no_other_from_being_tested() {
    let folder = Folder::new("mistakes")
        .with("bad.scene", "scene 1\nexpect nothing = 1\n")
        .with("mute.scene", SCENE)
        .with("a.scene", &white("expect mean = 1"));
    let done = folder.luxel(&["verify", "bad.scene", "mute.scene", "a.scene", "--json"]);
    assert_eq!(done.code, 1, "{done:?}");
    assert!(done.err.contains("E0602") && done.err.contains("`bad.scene` cannot be tested"));
    assert!(done.err.contains("`mute.scene` expects nothing of its picture"), "{done:?}");
    let row: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    assert_eq!((&row["id"], &row["verdict"]), (&"a.scene:12".into(), &"ok".into()));
    assert_eq!((row["expected"].as_f64(), row["z"].as_f64()), (Some(1.0), None));
}

#[test]
#[cfg(target_os = "linux")]
fn an_interrupt_ends_it_with_code_3() {
    let long = white("expect mean = 1").replace("samples = 4", "samples = 1000000");
    let folder = Folder::new("verify-interrupt").with("a.scene", &long);
    let mut running = folder.start(&["verify", "a.scene"]);
    running.listens();
    running.interrupt();
    let done = running.end();
    assert!(done.code == 3 && done.err.contains("error: interrupted: what had not"), "{done:?}");
}
