//! Plugins that fail while they run: the render ends and says who, where and how; the process lives.

use luxel_core::diag::Diagnostic;
use luxel_core::registry::Registry;
use luxel_core::render::{Control, Options, Outcome, render};
use luxel_core::stage::Stage;

use super::{bad, registered, stage_after};

/// The scene's statements by kind; `{}` is the object that may be wrong.
pub(super) const CAMERA: &str = "camera perspective {
    look = look_at(from = (0, 0, 4) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }\n";
pub(super) const LIGHT: &str =
    "light constant { spectrum = rgb.linear_srgb(1, 1, 1), scale = 1 }\n";
const POINT: &str = "light point { position = (0, 0, 3) m, spectrum = rgb.linear_srgb(1, 1, 1), intensity = 8 W/sr }\n";
pub(super) const FILM: &str = "film rgb { resolution = (6, 6) }\nsampler sobol { samples = 4 }\n";
pub(super) const FLOOR: &str = "shape rectangle { u = (8, 0, 0) m, v = (0, 8, 0) m }\n";

fn registry() -> Registry {
    registered(&[bad::library()])
}

/// The words of the scene that a message is about.
fn place<'a>(text: &'a str, found: &Diagnostic) -> &'a str {
    found.span().map_or("", |span| &text[span.start as usize..span.end as usize])
}

fn failed(stage: &Stage) -> Option<Vec<Diagnostic>> {
    let (_, outcome) = render(stage, &Options::default(), &Control::default());
    if outcome == Outcome::Complete {
        return None;
    }
    assert_eq!(outcome, Outcome::Failed);
    Some(stage.failures())
}

/// With an object that is wrong in this way, the build or the render ends and tells it at the object;
/// twice, as what failed is not used again; and with a sound object all is well.
#[track_caller]
fn check(template: &str, wrong: &str, told: &str) {
    let registry = registry();
    let text = |wrong: &str| format!("scene 1\n{}", template.replace("WRONG", wrong));
    let faulty = text(wrong);
    let mut before = None;
    for _ in 0..2 {
        let found = match stage_after(&registry, &faulty, before.as_ref()) {
            Err(found) => found,
            Ok(stage) => {
                let found = failed(&stage);
                before = Some(stage);
                found.unwrap_or_else(|| panic!("{wrong}: the render did not fail: {told}"))
            }
        };
        let found: Vec<_> = found.into_iter().filter(Diagnostic::is_error).collect();
        let all = || format!("{wrong}: {found:?}");
        assert!(found.iter().any(|d| d.message.contains(told)), "{told} is not in {}", all());
        assert!(found.iter().all(|d| d.code.starts_with("E04")), "{}", all());
        assert!(found.iter().all(|d| place(&faulty, d).contains("bad {")), "{}", all());
    }
    let sound = text("nothing");
    let fixed = stage_after(&registry, &sound, before.as_ref());
    let fixed = fixed.unwrap_or_else(|found| panic!("{wrong}: after mending: {found:?}"));
    assert_eq!(failed(&fixed).map(|found| format!("{found:?}")), None, "{wrong}: after mending");
}

/// The same for several, with the name of the object before each message.
#[track_caller]
fn check_all(template: &str, who: &str, cases: &[(&str, &str)]) {
    let mut wrong = vec![];
    for (fault, told) in cases {
        let told = format!("{who} `bad` of tests 0.1.0 {told}");
        let done = std::panic::catch_unwind(|| check(template, fault, &told));
        if let Err(payload) = done {
            let said = payload.downcast_ref::<String>().cloned();
            wrong.push(format!("{fault}: {}", said.unwrap_or_default()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

const FELL: &str = "panicked: fell over on purpose";

#[test]
fn a_material_that_fails_ends_the_render() {
    let cases = [
        ("check", FELL),
        ("prepare", FELL),
        ("other", FELL),
        ("eval", FELL),
        ("bomb", "panicked: no message"),
        ("nan", "gave an eval that is negative or not finite"),
        ("negative", "gave an eval that is negative or not finite"),
        ("infinite", "gave an eval that is negative or not finite"),
        ("sample", FELL),
        ("sample_nan", "gave a sample"),
        ("sample_zero", "gave a sample"),
        ("sample_long", "gave a sample"),
        ("zero", "gave a sample"),
    ];
    let floor = FLOOR.replace(" }", ", material = material bad { wrong = \"WRONG\" } }");
    check_all(&[CAMERA, FILM, POINT, &floor].concat(), "material", &cases);
    let grey = "grey = texture checker { a = 0.2, b = 0.8 }";
    let floor = floor.replace("bad {", &["bad { ", grey, ","].concat());
    let template = [CAMERA, FILM, POINT, &floor].concat().replace("rgb {", "spectral {");
    check_all(&template, "material", &cases[1..4]);
}

#[test]
fn a_mix_of_a_material_that_fails_names_the_one_that_failed() {
    let mix = "material mix { a = material bad { wrong = \"WRONG\" }, b = material diffuse {},
        weight = texture checker { a = 0.2, b = 0.8 } }";
    let floor = FLOOR.replace(" }", &format!(", material = {mix} }}"));
    let cases = [("eval", FELL), ("prepare", FELL), ("sample_nan", "gave a sample")];
    check_all(&[CAMERA, FILM, LIGHT, &floor].concat(), "material", &cases);
}

#[test]
fn a_texture_that_fails_ends_the_render() {
    let texture = "texture bad { wrong = \"WRONG\" }";
    let paint = format!(", material = material diffuse {{ reflectance = {texture} }} }}");
    let template = [CAMERA, FILM, LIGHT, &FLOOR.replace(" }", &paint)].concat();
    let value = "gave a value that is not finite";
    let cases = [("eval", FELL), ("nan", value), ("infinite", value), ("other", FELL)];
    check_all(&template, "texture", &cases);
    check_all(&template, "texture", &[("prepare", FELL)]);
    // Its table panics once more when it is freed.
    check_all(&template, "texture", &[("bomb", "panicked: no message")]);
    check(&template, "dangling", "nothing");
}

#[test]
fn a_light_that_fails_ends_the_render() {
    let template = |far: bool| {
        let lamp = format!("light bad {{ wrong = \"WRONG\", far = {far} }}\n");
        [CAMERA, FILM, &lamp, FLOOR].concat()
    };
    let light = "gave light that is negative or not finite";
    let cases = [
        ("prepare", FELL),
        ("sample", FELL),
        ("sample_nan", "gave a sample that is not finite"),
        ("sample_long", "gave a sample"),
        ("sample_zero", "gave a sample that is not finite"),
        ("beyond", "gave a sample"),
        ("zero", "gave a sample"),
        ("nan", light),
        ("negative", light),
        ("infinite", light),
        ("second", FELL),
        ("second_nan", "gave a power that is negative or no number"),
    ];
    check_all(&template(false), "light", &cases);
    let far = [("eval", FELL), ("nan", light), ("other_nan", "gave a density")];
    check_all(&template(true).replace(FLOOR, ""), "light", &far);
}

#[test]
fn a_shape_that_fails_ends_the_render() {
    let shape = "shape bad { wrong = \"WRONG\" }";
    let limits = "gave a hit beyond the ray's limits";
    let point = "gave a point of its surface that is not";
    let cases = [
        ("prepare", FELL),
        ("eval", FELL),
        ("sample", FELL),
        ("nan", limits),
        ("negative", limits),
        ("zero", limits),
        ("infinite", limits),
        ("sample_nan", point),
        ("sample_long", point),
        ("other_nan", point),
        ("second_nan", "gave bounds that are no numbers"),
    ];
    check_all(&[CAMERA, FILM, LIGHT, shape].concat(), "shape", &cases);
    // Shadow rays have limits.
    check_all(&[CAMERA, FILM, POINT, FLOOR, shape].concat(), "shape", &[("beyond", limits)]);
    let lamp = format!(
        "light area {{ shape = {shape}, spectrum = rgb.linear_srgb(1, 1, 1), radiance = 1 W/m^2/sr,
            transform = move((0, 0, 1) m) }}"
    );
    let cases = [
        ("sample_zero", "gave a sample whose density is not positive and finite"),
        ("sample_nan", point),
        ("second", FELL),
        ("greedy", "gave an area that is negative or no number"),
        ("foreign", "gave an area that is negative or no number"),
    ];
    check_all(&[CAMERA, FILM, FLOOR, &lamp].concat(), "shape", &cases);
}

#[test]
fn triangles_that_do_not_fit_together_are_refused() {
    let shape = "shape bad { wrong = \"WRONG\", mesh = true }";
    let template = [CAMERA, FILM, LIGHT, shape].concat();
    check_all(&template, "shape", &[("eval", FELL)]);
    for wrong in
        ["dangling", "greedy", "nan", "infinite", "sample", "sample_nan", "other", "other_nan"]
    {
        check(&template, wrong, "");
    }
}

#[test]
fn a_medium_that_fails_ends_the_render() {
    let fog = "medium bad { wrong = \"WRONG\" }\n";
    let flight = "gave a flight that is negative, not finite or too long";
    let cases = [
        ("eval", FELL),
        ("sample_nan", flight),
        ("sample_zero", flight),
        ("beyond", flight),
        ("nan", flight),
        ("negative", flight),
        ("infinite", flight),
        ("sample", FELL),
        ("sample_long", "gave a glow that is negative or not finite"),
        ("zero", "gave a glow that is negative or not finite"),
        ("other", FELL),
        ("other_nan", "gave a transmittance that is negative or not finite"),
        ("second", FELL),
        ("foreign", FELL),
        ("second_nan", "gave an eval that is negative or not finite"),
        ("greedy", "took random numbers that are not its own"),
    ];
    check_all(&[CAMERA, FILM, POINT, fog, FLOOR].concat(), "medium", &cases);
}

#[test]
fn a_phase_function_that_fails_ends_the_render() {
    let fog = "medium homogeneous { sigma_t = 0.5 / (1 m), albedo = 0.9,
        phase = phase bad { wrong = \"WRONG\" } }\n";
    let eval = "gave an eval that is negative or not finite";
    let cases = [
        ("eval", FELL),
        ("nan", eval),
        ("negative", eval),
        ("infinite", eval),
        ("sample", FELL),
        ("sample_nan", "gave a sample"),
        ("sample_zero", "gave a sample"),
        ("sample_long", "gave a sample"),
    ];
    check_all(&[CAMERA, FILM, POINT, fog, FLOOR].concat(), "phase", &cases);
}

#[test]
fn settings_that_fail_end_the_render() {
    let ray = "gave a ray that is not finite or not of unit length";
    let cases = [
        ("eval", FELL),
        ("sample_nan", ray),
        ("sample_long", ray),
        ("zero", ray),
        ("nan", ray),
        ("negative", ray),
        ("infinite", ray),
    ];
    let camera = "camera bad { wrong = \"WRONG\" }\n";
    check_all(&[camera, FILM, LIGHT, FLOOR].concat(), "camera", &cases);
    let unit = "gave a number outside [0, 1)";
    let film = FILM.replace("sobol { samples = 4 }", "bad { wrong = \"WRONG\" }");
    let cases = [
        ("eval", FELL),
        ("nan", unit),
        ("negative", unit),
        ("infinite", unit),
        ("beyond", unit),
        ("other", FELL),
        ("second", FELL),
    ];
    check_all(&[CAMERA, &film, LIGHT, FLOOR].concat(), "sampler", &cases);
    let filter = "filter bad { wrong = \"WRONG\" }\n";
    let offset = "gave an offset that is not finite";
    let cases = [("eval", FELL), ("nan", offset), ("infinite", offset)];
    check_all(&[CAMERA, FILM, filter, LIGHT, FLOOR].concat(), "filter", &cases);
}

#[test]
fn an_integrator_that_fails_ends_the_render() {
    let walk = "integrator bad { wrong = \"WRONG\" }\n";
    let twice = "asked twice for one path";
    let ray = "asked for a ray that is not finite";
    let cases = [
        ("prepare", FELL),
        ("eval", FELL),
        ("other", FELL),
        ("second", twice),
        ("sample", twice),
        ("sample_nan", ray),
        ("sample_long", ray),
        ("zero", ray),
        ("greedy", "asked for more than"),
        ("beyond", "took random numbers that are not its own"),
    ];
    check_all(&[CAMERA, FILM, walk, LIGHT, FLOOR].concat(), "integrator", &cases);
}

#[test]
fn an_importer_that_fails_is_told_at_its_asset() {
    let asset = "let thing = asset bad { wrong = \"WRONG\" }\nplace thing\n";
    let template = [CAMERA, FILM, LIGHT, asset].concat();
    check_all(&template, "asset", &[("check", FELL), ("eval", FELL)]);
    for (wrong, told) in [
        ("dangling", "places node 2 of 2"),
        ("beyond", "places node 4294967295 of 2"),
        ("other", "has a `material` that is not there: Node(7)"),
        ("second", "has a `material` that is not there: Node(1)"),
        ("other_nan", "has a `material` that is not there"),
        ("foreign", "node 2 (film `rgb`) is of a kind that no file holds"),
        ("prepare", "node 2 (asset `bad`) is of a kind that no file holds"),
        ("zero", "places node 0, which is a material"),
        ("nan", "radius"),
        ("negative", "it must exceed 0"),
        ("sample", "radius"),
        ("sample_nan", "node 1 (shape `no_such_shape`) is of no known class"),
        ("sample_zero", "node 1 (shape `sphere`) lacks `radius`"),
        ("sample_long", "node 1 (shape `sphere`) has no parameter `width`"),
        ("infinite", "the transform is singular"),
        ("second_nan", "node 0 (material `mix`) lacks `a`"),
    ] {
        check(&template, wrong, told);
    }
}

#[test]
fn a_failure_in_a_later_stage_does_not_end_an_earlier_render() {
    let registry = registry();
    let text = |wrong: &str| {
        let material = format!(", material = material bad {{ wrong = \"{wrong}\" }} }}");
        format!("scene 1\n{}", [CAMERA, FILM, POINT, &FLOOR.replace(" }", &material)].concat())
    };
    let sound = stage_after(&registry, &text("nothing"), None).unwrap();
    let (control, endless) =
        (Control::default(), Options { spp: Some(u32::MAX), ..Options::default() });
    let outcome = std::thread::scope(|scope| {
        let rendering = scope.spawn(|| render(&sound, &endless, &control).1);
        let goes_on = || {
            let before = control.samples_done();
            while control.samples_done() == before && !rendering.is_finished() {
                std::thread::yield_now();
            }
        };
        goes_on();
        assert!(stage_after(&registry, &text("check"), Some(&sound)).is_err());
        let later = stage_after(&registry, &text("eval"), Some(&sound)).unwrap();
        assert!(failed(&later).is_some());
        // Each thread has looked at the alarm once more.
        (0..8).for_each(|_| goes_on());
        control.cancel();
        rendering.join().unwrap()
    });
    assert_eq!(outcome, Outcome::Cancelled);
    assert!(sound.failures().is_empty());
}

#[test]
fn a_preset_that_fails_is_told() {
    let mut registry = Registry::new();
    for classes in luxel_builtin::CLASSES {
        let others = classes.iter().filter(|class| class.name != "blackman_harris");
        registry.add("built-in", &others.copied().collect::<Vec<_>>()).unwrap();
    }
    registry.add("preset", &bad::preset().classes).unwrap();
    let text = format!("scene 1\n{}", [CAMERA, FILM, LIGHT, FLOOR].concat());
    let stage = stage_after(&registry, &text, None).unwrap();
    let found = failed(&stage).expect("the filter falls over");
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(found[0].code == "E0421" && found[0].message.contains(FELL), "{found:?}");
}

#[test]
fn a_flood_of_nodes_is_taken() {
    let asset = "let thing = asset bad { wrong = \"greedy\" }\nplace thing\n";
    let text = format!("scene 1\n{}", [CAMERA, FILM, LIGHT, asset].concat());
    let stage = stage_after(&registry(), &text, None).unwrap();
    assert_eq!(stage.placements.len(), 100_001);
}

#[test]
fn light_of_an_integrator_that_is_no_number_counts_as_a_bad_sample() {
    for wrong in ["nan", "infinite", "second_nan"] {
        let walk = format!("integrator bad {{ wrong = \"{wrong}\" }}\n");
        let text = format!("scene 1\n{}", [CAMERA, FILM, &walk, LIGHT, FLOOR].concat());
        let stage = stage_after(&registry(), &text, None).unwrap();
        let (film, outcome) = render(&stage, &Options::default(), &Control::default());
        assert_eq!(outcome, Outcome::Complete, "{wrong}: {:?}", stage.failures());
        assert!(film.bad_samples() > 0 && film.mean().0.is_finite(), "{wrong}");
    }
}
