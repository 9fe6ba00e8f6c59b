//! `luxel study`: what it tells of scenes of which everything is known.

use serde_json::Value;

use super::program::{Done, Folder, SCENE};

/// Inside an evenly shining ball of reflectance .5: 2 everywhere. Paths end by chance from the first
/// corner on, or are cut off after `max_depth` corners, which takes .5^(depth + 1) of the light.
const FURNACE: &str = r"scene 1
let skin = material diffuse { reflectance = 0.5 }
camera perspective {
  look = look_at(from = (0, 0, 0) m, to = (0.3, 0.2, -1) m, up = (0, 1, 0)), fov = 60 deg
}
film rgb { resolution = (16, 16) }
integrator path { russian_roulette_from = 0, russian_roulette_below = 1, light_sampling = false }
sampler independent { samples = 16 }
light area {
  shape = shape sphere { radius = 1 m, material = skin }
  spectrum = rgb.linear_srgb(1, 1, 1), scale = 1, two_sided = true
}
";

fn study(scene: &str, args: &[&str]) -> (Folder, Done) {
    let folder = Folder::new("study").with("a.scene", scene);
    let done = folder.luxel(&[&["study", "a.scene"], args].concat());
    (folder, done)
}

fn json(done: &Done) -> Value {
    serde_json::from_str(&done.out).unwrap_or_else(|error| panic!("{error}: {done:?}"))
}

fn number(value: &Value) -> [f64; 2] {
    ["value", "standard_error"].map(|field| value[field].as_f64().unwrap())
}

#[test]
fn a_furnace_that_is_cut_off_is_told_as_biased_by_exactly_that_and_the_whole_one_is_not() {
    let sweep = ["--sweep", "depth=2,5,spp=16,64", "--truth", "2", "--target", "10%", "--json"];
    let (_, done) = study(FURNACE, &sweep);
    let found = json(&done);
    let [whole, two, five] = [0, 1, 2].map(|i| &found["configurations"][i]);
    assert_eq!([&whole["name"], &two["name"]], ["as it is", "depth=2"]);
    // Four standard errors; chosen before the seeds were drawn.
    for (configuration, bias) in [(whole, 0.0), (two, 0.125), (five, 0.5_f64.powi(6))] {
        let [value, error] = number(&configuration["points"][1]["bias_squared"]);
        assert!((value - bias * bias).abs() <= 4.0 * error, "{configuration:#}");
    }
    let is_biased = |configuration: &Value| configuration["points"][1]["is_biased"].clone();
    assert_eq!([is_biased(whole), is_biased(two)], [false, true]);
    assert_eq!(two["spp_for_target"], Value::Null, "12.5 % cannot become 10 %");
    // The spread of independent samples falls as one over their number.
    let [power, error] = number(&whole["power"]);
    assert!((power - 1.0).abs() <= 4.0 * error && error < 0.1, "{power} ± {error}");
    // Variance of a path that ends by chance with .5: .5 / .25 = 2, relative to 2².
    let [variance, error] = number(&whole["points"][1]["variance"]);
    assert!((variance * 64.0 - 0.5).abs() <= 4.0 * 64.0 * error, "{variance} ± {error}");
}

#[test]
fn every_setting_is_swept_and_only_one_that_leaves_light_out_is_biased() {
    let sweep = "integrator,precision,color,filter,rr,sampler,spp=16,64";
    let (_, done) =
        study(FURNACE, &["--sweep", sweep, "--truth", "2", "--target", "10%", "--json"]);
    let found = json(&done);
    let all = found["configurations"].as_array().unwrap();
    let names: Vec<&str> = all.iter().map(|it| it["name"].as_str().unwrap()).collect();
    let expected = "as it is,integrator=direct,precision=fast,precision=exact,color=spectral,\
                    filter=box,filter=gaussian,rr=8,rr=32,sampler=sobol";
    assert_eq!(names.join(","), expected);
    for configuration in all {
        let (name, last) = (&configuration["name"], &configuration["points"][1]);
        // Direct light leaves out what was scattered twice: 1.5 of 2. Four standard errors.
        let bias: f64 = if name == "integrator=direct" { 0.25 } else { 0.0 };
        let [value, error] = number(&last["bias_squared"]);
        assert!((value - bias * bias).abs() <= 4.0 * error + 1e-9, "{configuration:#}");
        assert_eq!(last["is_biased"].as_bool(), Some(bias > 0.0), "{name}");
    }
}

#[test]
fn what_is_recommended_is_verified_and_can_be_pasted() {
    let (folder, done) = study(
        SCENE,
        &["--sweep", "sampler,spp=4,16", "--target", "1%", "--size", "16x16", "-o", "out"],
    );
    assert_eq!((done.code, done.err.as_str()), (0, ""), "{done:?}");
    assert!(done.out.contains("off the target of 1.00 %: within 10 %\n"), "{}", done.out);
    let line = done.out.lines().find(|line| line.starts_with("sampler ")).unwrap();
    folder.write("b.scene", &SCENE.replace("sampler sobol { samples = 4 }", line));
    assert_eq!(folder.luxel(&["check", "b.scene"]).code, 0, "{line}");

    assert_eq!(folder.names(), ["a.scene", "b.scene", "out.csv", "out.json", "out.svg"]);
    let [csv, data, svg] =
        ["out.csv", "out.json", "out.svg"].map(|n| String::from_utf8(folder.read(n)).unwrap());
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    assert!(rows.len() == 1 + 2 * 2 && rows.iter().all(|row| row.len() == 10), "{csv}");
    assert_eq!((rows[0][1], rows[1][1], rows[4][0]), ("spp", "4", "sampler=independent"));
    let data: Value = serde_json::from_str(&data).unwrap();
    assert_eq!((&data["seeds"], &data["recommended"]["settings"]), (&16.into(), &line.into()));
    assert_eq!(data["recommended"]["verified"]["is_within_tenth"], true);
    assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
    assert_eq!(svg.matches("<circle").count(), 4);
    assert!(svg.contains("sampler=independent</text>") && svg.contains("target 1.00 %"));
}

/// A floor below a disc that one path in 50 meets: 1 everywhere.
const RARE: &str = "scene 1
camera perspective {
  look = look_at(from = (0, 0.5, 0) m, to = (0, 0, 0) m, up = (0, 0, 1)), fov = 0.01 deg
}
film rgb { resolution = (8, 8) }
integrator path { max_depth = 1, light_sampling = false }
sampler independent { samples = 16 }
light area {
  shape = shape disk { center = (0, 1, 0) m, normal = (0, -1, 0), radius = 1 m / 7 }
  spectrum = rgb.linear_srgb(1, 1, 1), scale = 50
}
shape rectangle { u = (0, 0, 1) m, v = (1, 0, 0) m, material = material diffuse { reflectance = 1 } }
";

#[test]
fn of_skewed_noise_the_verified_error_is_known_and_is_the_true_one() {
    // Few samples see little of what is seldom: the fit alone would be far off.
    let args = ["--sweep", "spp=1,4", "--truth", "1", "--target", "30%", "--json"];
    let (_, done) = study(RARE, &args);
    assert_eq!(done.code, 0, "{done:?}");
    let found = json(&done);
    let verified = &found["recommended"]["verified"];
    let [rmse, error] = number(&verified["rmse"]);
    assert!(verified["pictures"].as_u64().unwrap() >= 16, "{verified}");
    assert!(verified["is_within_tenth"] == true && error <= 0.025 * 0.3, "{verified}");
    // 1 of 50 is 50: a variance of 49 of each sample. Four standard errors.
    let truth = (49.0 / verified["samples"].as_f64().unwrap()).sqrt();
    assert!((rmse - truth).abs() <= 4.0 * error && (truth / 0.3 - 1.0).abs() < 0.1, "{verified}");
}

/// In the middle of a ball of a medium that takes e^-.5 of an even sky's light on a radius.
#[test]
fn what_is_dropped_is_told_with_the_error_that_it_adds() {
    let (head, _) = FURNACE.split_once("light area").unwrap();
    let fog = head.to_owned()
        + "light constant { spectrum = rgb.linear_srgb(1, 1, 1), scale = 1 }
shape sphere {
  radius = 1 m, interior = medium homogeneous { sigma_t = 0.5 / (1 m), albedo = 0 }
}
";
    let truth = (-0.5_f64).exp().to_string();
    let args = ["--drop", "media,motion", "--truth", &truth, "--seeds", "4"];
    let (_, done) = study(&fog, &[&args[..], &["--json"]].concat());
    let found = json(&done);
    let names = found["configurations"].as_array().unwrap().iter().map(|it| &it["name"]);
    assert_eq!(names.collect::<Vec<_>>(), ["as it is", "drop=media"]);
    // Without the medium 1 instead of e^-.5, which nothing scatters; pictures are in single precision.
    let [bias2, _] = number(&found["configurations"][1]["points"][0]["bias_squared"]);
    assert!((bias2.sqrt() - (0.5_f64.exp() - 1.0)).abs() < 1e-5, "{bias2}");
    assert_eq!(found["recommended"]["configuration"], "as it is");
    let notes: Vec<&str> =
        found["notes"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    assert_eq!(notes[0], "drop=motion was left out: the scene does not require it");
    assert!(notes[1].starts_with("drop=media adds an error of 64.9 % ± 0.00 and "), "{notes:?}");
}

#[test]
fn a_mean_that_the_scene_expects_tells_what_the_scene_itself_gets_wrong() {
    // Cut off after two corners it lacks 0.5³ of the light, which its own pictures cannot tell.
    let cut = FURNACE.replace("path { ", "path { max_depth = 2, ") + "expect mean = 2 ± 1e-3\n";
    let args = ["--sweep", "depth=5,spp=16,64", "--size", "16x16", "--target", "20%", "--json"];
    let found = json(&study(&cut, &args).1);
    assert_eq!(found["expected_mean"]["luminance"], 2.0);
    for (i, bias) in [(0, 0.125), (1, 0.5_f64.powi(6))] {
        let configuration = &found["configurations"][i];
        // Four standard errors, and a digit of pictures in single precision.
        let [off, error] = number(&configuration["mean_off"]);
        assert!((off + bias).abs() <= 4.0 * error + 1e-7 && error < 5e-3, "{configuration:#}");
    }
    assert_eq!(found["configurations"][0]["points"][1]["is_biased"], false);
    let notes: Vec<&str> =
        found["notes"].as_array().unwrap().iter().filter_map(Value::as_str).collect();
    let told = "bias of the mean, against the 2 that the scene expects: as it is -12.";
    assert!(notes.iter().any(|note| note.starts_with(told)), "{notes:?}");
    // Nothing is expected of others.
    let found = json(&study(FURNACE, &args).1);
    assert_eq!(found["configurations"][0]["mean_off"], Value::Null);
}

#[test]
fn a_time_is_kept_by_measuring_less_and_that_is_told() {
    let args = ["--sweep", "spp=16,64,256", "--size", "32x32", "--target", "50%", "--time", "1s"];
    let (_, done) = study(FURNACE, &args);
    assert!(done.out.contains("note: "), "{done:?}");
    assert!(done.out.contains("to stay within 1.00 s"), "{done:?}");
}

#[test]
fn what_cannot_be_studied_is_told() {
    let told = |scene: &str, args: &[&str], code: i32, words: &str| {
        let (_, done) = study(scene, args);
        let at = done.err.contains(words);
        assert!(done.code == code && at, "{args:?} {words}: {done:?}");
    };
    told(SCENE, &["--size", "300x300"], 2, "300 x 300 pixels are too many to be studied");
    told(SCENE, &["--sweep", "sampler=dice"], 2, "there is no sampler `dice`");
    told(SCENE, &["--sweep", "colour"], 2, "nothing can be swept that is called `colour`");
    told(SCENE, &["--seeds", "3"], 2, "3 is not in 4..=1024");
    told("scene 2\n", &[], 1, "`a.scene` cannot be studied");
    let black = SCENE.replace("scale = 1", "scale = 0");
    told(&black, &["--sweep", "spp=1,2"], 1, "the picture is black");
    told(SCENE, &["-o", "nowhere/out"], 1, "cannot write `nowhere/out.csv`");
}

#[test]
fn what_a_class_has_not_is_left_out_and_nothing_that_misses_the_target_is_recommended() {
    let direct = FURNACE.replace(
        "path { russian_roulette_from = 0, russian_roulette_below = 1, light_sampling = false }",
        "direct {}",
    );
    let (_, done) =
        study(&direct, &["--sweep", "depth=2,spp=1,4", "--truth", "2", "--target", "1%"]);
    assert_eq!(done.code, 3, "{done:?}");
    let note = "note: depth=2 was left out: the scene's integrator has no `max_depth`";
    assert!(done.out.contains(note), "{}", done.out);
    assert!(done.out.ends_with("nothing that was swept reaches 1.00 %\n"), "{}", done.out);
}

#[test]
fn the_study_reads_what_is_known_exactly() {
    let done = Folder::new("study").luxel(&["study", "--calibrate", "--json"]);
    assert_eq!((done.code, done.err.as_str()), (0, ""), "{done:?}");
    let readings: Vec<Value> =
        done.out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    for (reading, exact) in readings.iter().zip([90.0, 0.0625]) {
        let [read, error] = ["read", "standard_error"].map(|name| reading[name].as_f64().unwrap());
        assert!((read - exact).abs() <= 4.0 * error && error < 0.03 * exact, "{reading}");
    }
    assert_eq!(readings.len(), 2);
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_keeps_what_was_measured() {
    let folder = Folder::new("study").with("a.scene", FURNACE);
    let sweep = ["--sweep", "spp=8,64", "--size", "32x32", "--truth", "2", "--seeds", "1024"];
    // On a slow machine an interrupt comes before there are rounds enough.
    for seconds in [1, 2, 4, 8, 16] {
        let mut running = folder.start(&[&["study", "a.scene", "-o", "out"][..], &sweep].concat());
        running.listens();
        std::thread::sleep(std::time::Duration::from_secs(seconds));
        running.interrupt();
        let done = running.end();
        assert_eq!(done.code, 3, "{done:?}");
        if done.out.contains("note: interrupted after ") {
            assert_eq!(folder.names(), ["a.scene", "out.csv", "out.json", "out.svg"]);
            return;
        }
        assert_eq!(folder.names(), ["a.scene"]);
        assert!(done.err.contains("interrupted: what had not been measured"), "{done:?}");
    }
    panic!("an interrupt never kept anything");
}
