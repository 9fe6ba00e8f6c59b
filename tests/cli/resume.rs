//! Renders that are killed, left or bounded, and what is there afterwards.

use std::time::Duration;

use luxel_core::film::Film;
use luxel_sdk::sampling::Rng;

#[cfg(unix)]
use super::origin::attribute;
use super::program::{Folder, SCENE};
use super::until;

/// Samples that take the program two or three seconds.
const LONG: &str = "6000";

#[test]
fn a_render_that_is_killed_twenty_times_goes_on_to_the_same_picture() {
    killed(&["--spp", LONG], 20);
}

#[test]
fn so_does_one_that_an_error_is_asked_of() {
    killed(&["--error", "0.1%"], 10);
}

/// Kills a render with these arguments so many times at random moments, and lets it go on.
fn killed(asked: &[&str], times: u32) {
    let folder = Folder::new("kill").with("a.scene", SCENE);
    let whole = folder.luxel(&[&["render", "a.scene", "-o", "whole"], asked].concat());
    let mut rng = Rng::new(11);
    let of = ["render", "a.scene", "-o", "left", "--resume", "--checkpoint", "0.02"];
    let args = [&of, asked].concat();
    let (mut killed, mut kept, mut last) = (0, 0, vec![]);
    // More than are wanted: a render that comes to its end is none, and the next begins anew.
    for _ in 0..3 * times {
        if killed == times {
            break;
        }
        let mut running = folder.start(&args);
        std::thread::sleep(Duration::from_millis(u64::from(rng.u32() % 250)));
        killed += u32::from(!running.is_over());
        // Killed, not asked: nothing can be said or saved any more.
        drop(running);
        let now = folder.read("left.checkpoint");
        kept += u32::from(!now.is_empty() && now != last);
        last = now;
    }
    assert_eq!(killed, times, "renders that were still at work");
    assert!(2 * kept >= times, "only {kept} runs left something new, less than half");
    let last = folder.luxel(&[&args[..], &["--json"]].concat());
    assert_eq!((last.code, whole.code), (0, 0), "{last:?}");
    assert!(folder.read("left.exr") == folder.read("whole.exr"));
    // Neither a checkpoint nor what a killed run had written of one.
    assert_eq!(folder.names(), ["a.scene", "left.exr", "left.png", "whole.exr", "whole.png"]);
}

/// More samples than a test can wait for.
#[cfg(unix)]
const ENDLESS: &str = "4000000000";

#[cfg(unix)]
#[test]
fn a_render_that_is_interrupted_leaves_a_picture_and_goes_on_to_the_same_as_an_undisturbed_one() {
    let folder = Folder::new("stopped").with("a.scene", SCENE);
    let args = ["render", "a.scene", "--json", "-o", "left", "--checkpoint", "0.02"];
    let mut running = folder.start(&[&args[..], &["--spp", ENDLESS]].concat());
    until("a checkpoint", || folder.path("left.checkpoint").exists());
    running.interrupt();
    let done = running.end();
    assert_eq!(done.code, 3, "{done:?}");
    assert_eq!(folder.names(), ["a.scene", "left.checkpoint", "left.exr", "left.png"]);
    // The picture is whole as a file, and says that it is not as a measurement.
    let about = attribute(&folder.read("left.exr"));
    let told: serde_json::Value = serde_json::from_str(&done.out).unwrap();
    assert_eq!(
        (&about["complete"], &about["most_samples"]),
        (&false.into(), &told["most_samples"])
    );
    assert_eq!(folder.luxel(&["compare", "left.exr", "left.exr"]).code, 0);
    assert!(folder.read("left.png").ends_with(b"IEND\xae\x42\x60\x82"));
    // A little more than it has: by going on, and without a stop.
    let number = |told: &serde_json::Value, name: &str| told[name].as_u64().unwrap();
    let (before, wanted) = (number(&told, "samples"), number(&told, "most_samples") + 50);
    assert!(before > 0, "{told}");
    let spp = wanted.to_string();
    let resumed = folder.luxel(&[&args[..], &["--resume", "--spp", &spp]].concat());
    let whole = folder.luxel(&["render", "a.scene", "-q", "-o", "whole", "--spp", &spp]);
    assert_eq!((resumed.code, whole.code), (0, 0), "{resumed:?} {whole:?}");
    let told = serde_json::from_str(&resumed.out).unwrap();
    assert_eq!(before + number(&told, "samples"), 32 * 32 * wanted, "it began anew");
    assert!(folder.read("left.exr") == folder.read("whole.exr"), "at {spp} samples");
    assert!(folder.read("left.png") == folder.read("whole.png"));
    assert!(!folder.path("left.checkpoint").exists());
}

#[cfg(unix)]
#[test]
fn a_time_is_that_of_one_run_and_stands_beside_that_of_all() {
    let folder = Folder::new("timed").with("a.scene", SCENE);
    let number = |told: &serde_json::Value, name: &str| told[name].as_f64().unwrap();
    let interrupted = |more: &[&str]| {
        let args = ["render", "a.scene", "--json", "-o", "a", "--checkpoint", "0.02"];
        let before = folder.read("a.checkpoint");
        let mut running = folder.start(&[&args[..], more].concat());
        until("a checkpoint", || ![&before[..], b""].contains(&&*folder.read("a.checkpoint")));
        running.interrupt();
        let done = running.end();
        assert_eq!(done.code, 3, "{done:?}");
        serde_json::from_str::<serde_json::Value>(&done.out).unwrap()
    };
    let first = interrupted(&["--time", "1h"]);
    assert_eq!(
        (&first["seconds_in_all"], &first["time_asked"]),
        (&first["seconds"], &3600.0.into())
    );
    // What nobody says is as it was: so much is left of the hour.
    let second = interrupted(&["--resume"]);
    let left = 3600.0 - number(&first, "seconds");
    assert!((number(&second, "time_asked") - left).abs() < 1e-6, "{first} {second}");
    let in_all = |before: &serde_json::Value, told: &serde_json::Value| {
        for name in ["seconds", "samples"] {
            let all = format!("{name}_in_all");
            let sum = number(before, &all) + number(told, name);
            assert!((number(told, &all) - sum).abs() < 1e-6, "{name}: {before} {told}");
        }
    };
    in_all(&first, &second);
    // And so much for this run, whatever those before it had.
    let resumed = ["render", "a.scene", "-o", "a", "--resume", "--time", "0.05s"];
    let copy = folder.read("a.checkpoint");
    let third = folder.luxel(&[&resumed[..], &["--json"]].concat());
    let told = serde_json::from_str(&third.out).unwrap();
    in_all(&second, &told);
    assert_eq!((third.code, &told["time_asked"]), (0, &0.05.into()));
    folder.write_bytes("a.checkpoint", &copy);
    let text = folder.luxel(&resumed);
    assert!(text.code == 0 && text.out.contains(" in all), "), "{text:?}");
}

/// Fog in which every path is scattered thousands of times: one sample of every pixel takes minutes.
const SLOW: &str = r"scene 1
camera perspective {
  look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0))
  fov = 40 deg
}
film rgb { resolution = (1024, 1024) }
sampler sobol { samples = 4 }
integrator path { max_depth = 2000, russian_roulette_from = 2000 }
light constant { scale = 1 }
medium homogeneous { sigma_t = 100 / (1 m), albedo = 1 }
";

#[test]
fn what_is_measured_is_kept_before_every_pixel_has_a_sample() {
    let folder = Folder::new("slow").with("a.scene", SLOW);
    let args = ["render", "a.scene", "-o", "a", "--resume", "--checkpoint", "1"];
    let mut running = folder.start(&args);
    until("the first checkpoint", || folder.path("a.checkpoint").exists());
    assert!(!running.is_over());
    drop(running);
    let first = folder.read("a.checkpoint");
    let mut again = folder.start(&args);
    until("the next checkpoint", || folder.read("a.checkpoint") != first);
    assert!(!again.is_over());
    drop(again);
    let [before, after] = [first, folder.read("a.checkpoint")].map(|bytes| samples(&bytes));
    assert!(0 < before && before < after && after < 1024 * 1024, "{before}, then {after}");
}

/// Bytes of a hash.
const HASH: usize = 32;

/// Of the film in a checkpoint: after two lines of text, and before a hash.
fn samples(checkpoint: &[u8]) -> u64 {
    let film = checkpoint.splitn(3, |byte| *byte == b'\n').nth(2).unwrap();
    Film::load(&film[..film.len() - HASH]).unwrap().samples()
}

#[test]
fn nothing_is_gone_on_with_that_is_of_another_picture() {
    let folder = Folder::new("other").with("a.scene", SCENE);
    // An error that cannot be reached leaves what it takes to go on.
    let unreached = ["render", "a.scene", "--error", "0.0001%", "--spp", "64", "-o", "a", "--json"];
    let done = folder.luxel(&unreached);
    assert_eq!(done.code, 3, "{done:?}");
    assert!(done.out.contains("\"complete\":false"), "{}", done.out);
    let seed = folder.luxel(&["render", "a.scene", "-o", "a", "--resume", "--seed", "9"]);
    assert!(seed.code == 1 && seed.err.contains("it is of another seed"), "{seed:?}");
    let size = folder.luxel(&["render", "a.scene", "-o", "a", "--resume", "--size", "8x8"]);
    assert!(size.code == 1 && size.err.contains("it is of another size"), "{size:?}");
    let fewer = folder.luxel(&["render", "a.scene", "-o", "a", "--resume", "--spp", "9"]);
    assert!(fewer.code == 1 && fewer.err.contains("64 samples of a pixel, more than"), "{fewer:?}");
    // What nobody says is as it was: the error is not reached this time either.
    let again = folder.luxel(&["render", "a.scene", "-o", "a", "--resume"]);
    assert!(again.code == 3 && again.out.contains("is not reached"), "{again:?}");
    let silent =
        folder.luxel(&["render", "a.scene", "-o", "a", "--error", "0.0001%", "--spp", "64"]);
    assert!(silent.err.contains("a.checkpoint` is of this picture"), "{silent:?}");
    // A comment is no other scene, and more samples are more of the same.
    folder.write("a.scene", &format!("{SCENE}// said later\n"));
    let more = folder.luxel(&["render", "a.scene", "-o", "a", "--resume", "--spp", "80", "--json"]);
    assert_eq!(more.code, 0, "{more:?}");
    assert!(more.out.contains("\"least_samples\":80"), "{}", more.out);
    let anew = folder.luxel(&["render", "a.scene", "-o", "a", "--resume"]);
    assert!(anew.code == 0 && anew.err.contains("begins anew"), "{anew:?}");
    // Somebody else's file is left alone.
    folder.write("a.checkpoint", "a diary");
    let foreign = folder.luxel(&["render", "a.scene", "-o", "a"]);
    assert!(foreign.code == 1 && foreign.err.contains("is in the way"), "{foreign:?}");
    assert_eq!(folder.read("a.checkpoint"), b"a diary");
}

#[cfg(unix)]
#[test]
fn an_interval_is_told_and_can_be_asked_for_and_tiles_where_it_is_not_reached_have_names() {
    let folder = Folder::new("sure").with("a.scene", SCENE);
    assert_eq!(folder.luxel(&["render", "a.scene", "-q", "-o", "a", "--spp", "16"]).code, 0);
    let half = &attribute(&folder.read("a.exr"))["half_width"];
    assert!(
        half["confidence"] == 0.95 && half["worst_tile"].as_f64() > half["median"].as_f64(),
        "{half}"
    );
    // What cannot be reached is told with the tiles where it is not.
    let sure =
        ["render", "a.scene", "--error", "0.1%", "--confidence", "99%", "--spp", "64", "-o", "b"];
    let done = folder.luxel(&sure);
    let told = "the 0.10 % with 99 % confidence asked for is not reached: ";
    assert!(done.code == 3 && done.out.contains(told), "{done:?}");
    let about = attribute(&folder.read("b.exr"));
    let (above, worst) = (&about["tiles_above"], &about["worst_tiles_above"]);
    assert_eq!(above.as_u64(), worst.as_array().map(|tiles| tiles.len() as u64), "{about}");
    assert!(worst[0]["error"].as_f64() >= worst[1]["error"].as_f64(), "{worst}");
    assert_eq!((&worst[0]["at"][2], &about["confidence_asked"]), (&16.into(), &0.99.into()));
    // It is gone on with as it was asked for.
    let again = folder.luxel(&["render", "a.scene", "-o", "b", "--resume"]);
    assert!(again.code == 3 && again.out.contains(told), "{again:?}");
}

#[test]
fn an_error_and_a_time_are_read_or_refused() {
    let folder = Folder::new("goal").with("a.scene", SCENE);
    let done = folder.luxel(&["render", "a.scene", "--error", "2%", "-o", "a"]);
    assert_eq!(done.code, 0, "{done:?}");
    assert!(done.out.contains("every tile is within the 2.00 % asked for"), "{}", done.out);
    // The picture says itself how good it is.
    let exr = folder.read("a.exr");
    assert!(exr.windows(20).any(|bytes| bytes == b"\"rms_relative_error\""));
    assert!(done.out.contains("\nhalf width of 95 % intervals: median "), "{}", done.out);
    let timed = folder.luxel(&["render", "a.scene", "--time", "0.05s", "-o", "a", "--json"]);
    assert!(timed.code == 0 && timed.out.contains("rms_relative_error"), "{timed:?}");
    for wrong in [
        ["--error", "one"],
        ["--time", "3 weeks"],
        ["--checkpoint", "-1"],
        ["--confidence", "100%"],
    ] {
        let args = [&["render", "a.scene"][..], &wrong].concat();
        let done = folder.luxel(&args);
        assert!(done.code == 2 && done.err.contains("expected"), "{done:?}");
    }
    let alone = folder.luxel(&["render", "a.scene", "--confidence", "95%"]);
    assert!(alone.code == 2 && alone.err.contains("--error"), "{alone:?}");
}
