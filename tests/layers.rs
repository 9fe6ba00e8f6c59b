//! What pictures hold beside colour.

use std::path::Path;

use glam::{DVec3, UVec2};
use luxel_core::files::MemoryFiles;
use luxel_core::film::{Film, Layer};
use luxel_core::render::{Control, Options, render, render_on};
use luxel_core::scene::{Feature, Scene};
use luxel_core::stage::Stage;

use crate::load::stage_of;

/// A ball before nothing, 4 m from the eye, that moves by a tenth of the picture's height.
const SCENE: &str = "scene 1
    param layers: bool = true
    camera orthographic { look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)), height = 4 m }
    film auto { resolution = (33, 33), shutter = 1 s,
        albedo = layers, normal = layers, position = layers, depth = layers,
        material_id = layers, object_id = layers, motion = layers, cost = layers }
    sampler sobol { samples = 64, seed = 2 }
    light constant { scale = 1 }
    shape rectangle \"behind\" { center = (0, 0, 9) m, u = (1, 0, 0) m, v = (0, 1, 0) m }
    shape sphere \"ball\" { radius = 1 m, material = material diffuse { reflectance = rgb.linear_srgb(0.2, 0.5, 0.8) },
        transform = motion([(0 s, move((0, 0, 0) m)), (1 s, move((0, 0.4, 0) m))]) }";

fn stage(text: &str, set: &[(&str, &str)]) -> Stage {
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let set: Vec<_> = set.iter().map(|(n, v)| ((*n).to_owned(), (*v).to_owned())).collect();
    stage_of(Path::new("a.scene"), &files, &set, None).unwrap_or_else(|said| panic!("{said:?}"))
}

fn film(stage: &Stage) -> Film {
    render(stage, &Options::default(), &Control::default()).0
}

/// The values of a channel, row by row.
fn values(film: &Film, name: &str) -> Vec<f64> {
    let mut channels = film.channels().into_iter();
    channels.find(|(channel, _)| channel.name == name).unwrap().1
}

/// The number of the pixel in the middle.
const MIDDLE: usize = 33 * 16 + 16;

#[test]
fn layers_tell_what_stands_where() {
    let film = film(&stage(SCENE, &[]));
    let middle = |name: &str| values(&film, name)[MIDDLE];
    let vector = |name: &str| DVec3::from(["X", "Y", "Z"].map(|x| middle(&format!("{name}.{x}"))));
    // The ball's middle goes up by 0.4 m, so its front lies on average where a ball at 0.2 m has it:
    // within the second order, 0.4²/12/2 m.
    assert!((vector("position") - DVec3::new(0.0, 0.0, 0.98)).abs().max_element() < 0.02);
    assert!((vector("normal") - DVec3::new(0.0, -0.2, 0.98)).abs().max_element() < 0.02);
    assert!((middle("depth.Z") - 4.02).abs() < 0.02);
    // 0.4 m of 4 m are 3.3 of 33 pixels; up is against the rows.
    assert!(middle("motion.X").abs() < 1e-9 && (middle("motion.Y") + 3.3).abs() < 1e-9);
    let numbers = ["material.ID", "object.ID", "coverage.A"].map(middle);
    // The first of each is that of the sheet behind.
    assert_eq!(numbers.map(f64::to_bits), [2.0, 2.0, 1.0].map(f64::to_bits));
    assert!(middle("cost.steps") >= 1.0);
    for (channel, values) in film.channels() {
        assert!(values[0].abs() <= 0.0 || channel.name == "cost.steps", "{}", channel.name);
    }
}

#[test]
fn albedo_is_what_the_material_says_in_rgb_and_by_wavelength() {
    let given = [0.2, 0.5, 0.8];
    for mode in ["rgb", "spectral"] {
        let film = film(&stage(&SCENE.replace("film auto", &format!("film {mode}")), &[]));
        for (channel, expected) in ["R", "G", "B"].into_iter().zip(given) {
            let all = values(&film, &format!("albedo.{channel}"));
            let coverage = values(&film, "coverage.A");
            // All pixels that see nothing but the ball tell the same.
            let whole: Vec<f64> =
                all.iter().zip(coverage).filter(|(_, a)| *a >= 1.0).map(|(v, _)| *v).collect();
            let mean = whole.iter().sum::<f64>() / whole.len() as f64;
            // 64 samples of each of some 170 pixels: by wavelength they differ by .3 from each other.
            let allowed = if mode == "rgb" { 1e-6 } else { 4.0 * 0.3 / (64.0 * 170.0_f64).sqrt() };
            assert!(
                (mean - expected).abs() <= allowed,
                "{mode} {channel}: {mean}, {}",
                whole.len()
            );
        }
    }
}

#[test]
fn layers_change_no_bit_of_the_picture() {
    let with = film(&stage(SCENE, &[]));
    let without = film(&stage(SCENE, &[("layers", "false")]));
    assert!(without.channels().is_empty() && without.holds.is_empty());
    assert_eq!(with.holds.layers, Layer::ALL);
    assert!(with.pixels().zip(without.pixels()).all(|(a, b)| a == b));
}

#[test]
fn layers_of_a_picture_that_begins_coarsely_are_the_same() {
    // Two rows of tiles, wider than what is measured together of a coarse step.
    let wide = SCENE.replace("(33, 33)", "(290, 19)");
    assert_ne!(wide, SCENE, "the test's scene has another form");
    let stage = stage(&wide, &[]);
    let film = |coarse| {
        let options = Options { coarse, spp: Some(3), ..Options::default() };
        render(&stage, &options, &Control::default()).0
    };
    assert_eq!(film(true), film(false));
}

#[test]
fn layers_are_gone_on_with_too() {
    let stage = stage(SCENE, &[]);
    let with = |spp| Options { spp: Some(spp), ..Options::default() };
    let mut film = render(&stage, &with(5), &Control::default()).0;
    let mut bytes = vec![];
    film.save(&mut bytes).unwrap();
    film = Film::load(&bytes).unwrap();
    render_on(&mut film, &stage, &with(12), &Control::default(), &mut |_, _| {});
    assert_eq!(film, render(&stage, &with(12), &Control::default()).0);
    assert_eq!(film.size, UVec2::splat(33));
}

/// A sky and a sun, a lamp that is seen and sampled, another of the sun's group, a lamp of no group.
const LAMPS: &str = "scene 1
    camera perspective { look = look_at(from = (0, 1, 6) m, to = (0, 0.5, 0) m, up = (0, 1, 0)), fov = 50 deg }
    film spectral { resolution = (40, 24) }
    sampler sobol { samples = 32, seed = 2 }
    light constant { spectrum = illuminant(\"D65\"), radiance = 0.3 W/m^2/sr, group = \"sky\" }
    light sun { direction = (1, 2, 1), illuminance = 300 lx, group = \"warm\" }
    light area { shape = shape sphere { center = (1, 1.5, 0) m, radius = 30 cm }, spectrum = blackbody(3000 K), radiance = 5 W/m^2/sr, group = \"warm\" }
    light point { position = (-1, 2, 1) m, spectrum = blackbody(8000 K), intensity = 2 W/sr GROUP }
    shape sphere { center = (-0.5, 0.5, 0) m, radius = 50 cm, material = material dielectric {} }
    shape plane \"floor\" { material = material diffuse { reflectance = 0.6 } }";

#[test]
fn groups_of_lights_sum_to_the_picture() {
    let film = film(&stage(&LAMPS.replace("GROUP", ", group = \"blue\""), &[]));
    let groups: Vec<&str> = film.holds.groups.iter().map(|group| &**group).collect();
    assert_eq!(groups, ["sky", "warm", "blue"]);
    for (i, part) in ["R", "G", "B"].into_iter().enumerate() {
        let parts: Vec<_> =
            groups.iter().map(|group| values(&film, &format!("light.{group}.{part}"))).collect();
        assert!(parts.iter().all(|values| values.iter().any(|v| v.abs() > 1e-3)), "one is black");
        for (k, (at, pixel)) in film.pixels().enumerate() {
            let sum: f64 = parts.iter().map(|values| values[k]).sum();
            // Lanes are in single precision, and up to four times as large as what they come to.
            let rounding = 64.0 * f64::from(f32::EPSILON) * (1.0 + pixel.mean.length());
            assert!((sum - pixel.mean[i]).abs() < rounding, "{at} {part}: {sum} {}", pixel.mean[i]);
        }
    }
}

#[test]
fn a_group_is_what_its_lights_alone_would_give() {
    let all = film(&stage(&LAMPS.replace("GROUP", ""), &[]));
    // The same scene, whose other lights are gone or black.
    let lines = LAMPS.lines().filter(|line| !line.contains("sun") && !line.contains("GROUP"));
    let dark = lines.collect::<Vec<_>>().join("\n").replace("radiance = 5", "radiance = 0");
    let sky = film(&stage(&dark, &[]));
    let of_group: f64 = values(&all, "light.sky.G").iter().sum::<f64>() / (40.0 * 24.0);
    // A part is at most about as noisy as the whole.
    let ((alone, error), (_, whole)) = (sky.mean(), all.mean());
    let allowed = 4.0 * error.y.hypot(whole.y);
    assert!((of_group - alone.y).abs() < allowed, "{of_group} {alone} ± {allowed}");
    assert_eq!(all.holds.groups.len(), 2);
}

#[test]
fn what_media_send_is_of_no_group() {
    let gas = |scale: f64| {
        let shape = format!(
            "shape box {{ center = (0, 1, 2) m, size = (9, 9, 1) m, interior = medium glowing \
             {{ sigma_a = 1 / (2 m), sigma_s = 1 / (3 m), scale = {scale} }} }}"
        );
        film(&stage(&format!("{}\n{shape}", LAMPS.replace("GROUP", "")), &[]))
    };
    let (bright, dark) = (gas(1e5), gas(0.0));
    for channel in ["light.sky.G", "light.warm.G"] {
        assert_eq!(values(&bright, channel), values(&dark, channel), "{channel}");
    }
    assert!(bright.pixels().zip(dark.pixels()).all(|((_, a), (_, b))| a.mean.y > b.mean.y));
}

#[test]
fn groups_are_layers_that_can_be_dropped() {
    let files = MemoryFiles::default().with("a.scene", LAMPS.replace("GROUP", "").as_bytes());
    let registry = crate::load::registry();
    let settings = luxel_lang::Settings::default();
    let read = luxel_lang::load(Path::new("a.scene"), &files, &registry, &settings);
    let mut scene = read.scene.unwrap();
    let built =
        |scene: &Scene| luxel_core::stage::build(scene, &registry, &files, None).unwrap().stage;
    let stage = built(&scene);
    assert!(stage.needs(Feature::Layers) && stage.reasons.of(Feature::Layers).count() == 3);
    scene.leave_out(Feature::Layers).unwrap();
    let stage = built(&scene);
    assert!(!stage.needs(Feature::Layers) && film(&stage).holds.is_empty());
    assert_eq!(stage.reasons.of(Feature::Layers).count(), 0);
}

#[test]
fn a_group_without_a_proper_name_is_told() {
    let text = LAMPS.replace("GROUP", ", group = \"blue lamp\"");
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let said = stage_of(Path::new("a.scene"), &files, &[], None).unwrap_err();
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].code == "E0405" && said[0].message.contains("letters, digits"), "{said:?}");
}
