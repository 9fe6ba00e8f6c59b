//! Only what a scene requires is modelled: who requires what, that requiring more changes no bit, and
//! that what is dropped is gone.

use std::path::Path;

use luxel_core::diag::Diagnostic;
use luxel_core::files::MemoryFiles;
use luxel_core::render::{Control, Options, render};
use luxel_core::scene::{Feature, Scene, called};
use luxel_core::stage::{self, Stage};

use crate::load::registry;

const CAMERA: &str = "camera perspective { look = look_at(from = (0, 1, 4) m, to = (0, 0.5, 0) m, up = (0, 1, 0)), fov = 40 deg }\n";
const FLOOR: &str = "shape box \"floor\" { center = (0, -0.5, 0) m, size = (4, 1, 4) m, transform = [rotate((0, 1, 0), 10 deg)], material = material diffuse { reflectance = 0.6 } }\n";
const GLASS: &str = "shape sphere \"ball\" { center = (0.6, 0.6, 0) m, radius = 50 cm, material = material dielectric { ior = 1.5 } }\n";
const SKY: &str = "light constant \"sky\" { spectrum = rgb.linear_srgb(1, 0.9, 0.8), scale = 1 }\n";
const LAMP: &str = "light point \"lamp\" { position = (0, 3, 1) m, spectrum = rgb.linear_srgb(1, 1, 1), scale = 9 }\n";
const BY_WAVELENGTH: &str = "light point \"lamp\" { position = (0, 3, 1) m, spectrum = blackbody(3000 K), intensity = 8 W/sr }\n";
const FOG: &str = "shape sphere \"fog\" { center = (-0.6, 0.6, 0) m, radius = 50 cm, interior = medium homogeneous \"mist\" { sigma_t = 2 / (1 m), albedo = 0.8 } }\n";
const WATER: &str = "shape box \"water\" { center = (0.6, 0.4, 0) m, size = (1.4, 0.8, 1.4) m, material = material dielectric { ior = 1.33 } }\n";
const BUBBLE: &str = "shape sphere { center = (0, 1, 0) m, radius = 30 cm, material = material thin_film \"soap\" { thickness = 300 nm } }\n";
const MOVING: &str = "shape box \"hand\" { size = (0.3, 0.3, 0.3) m, transform = [spin((0, 1, 0), 9 deg / (1 ms)), move((0, 0.8, 0.5) m)] }\n";

/// A film of so many pixels, and what else it says.
fn film(words: &str) -> String {
    format!("film {words} resolution = (16, 12) }}\nsampler sobol {{ samples = 4, seed = 5 }}\n")
}

fn scene(parts: &[&str]) -> Scene {
    let text = format!("scene 1\n{}", parts.concat());
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let settings = luxel_lang::Settings::default();
    let loaded = luxel_lang::load(Path::new("a.scene"), &files, &registry(), &settings);
    loaded.scene.unwrap_or_else(|| panic!("{:?}", loaded.diagnostics))
}

fn staged(scene: &Scene) -> Stage {
    let built = stage::build(scene, &registry(), &MemoryFiles::default(), None);
    built.unwrap_or_else(|found: Vec<Diagnostic>| panic!("{found:?}")).stage
}

fn without(parts: &[&str], feature: Feature) -> Stage {
    let mut scene = scene(parts);
    scene.leave_out(feature).unwrap();
    staged(&scene)
}

/// Mean and variance of every pixel, as bits.
fn bits(stage: &Stage) -> Vec<[u64; 6]> {
    let (film, _) = render(stage, &Options::default(), &Control::default());
    let pixels = film.pixels().map(|(_, pixel)| {
        let (m, v) = (pixel.mean, pixel.variance());
        [m.x, m.y, m.z, v.x, v.y, v.z].map(f64::to_bits)
    });
    pixels.collect()
}

fn required_by(stage: &Stage, feature: Feature) -> Vec<String> {
    stage.reasons.of(feature).map(|(id, _)| called(stage.scene.node(id))).collect()
}

#[test]
fn each_feature_is_required_by_the_nodes_that_say_so() {
    let words = film("spectral { shutter = 10 ms, depth = true,");
    let all = [CAMERA, &words, FLOOR, GLASS, SKY, BY_WAVELENGTH, FOG, WATER, MOVING]
        .map(ToOwned::to_owned);
    let stage = staged(&scene(&all.each_ref().map(String::as_str)));
    for (feature, by) in [
        (Feature::Spectral, &["point \"lamp\"", "spectral"][..]),
        (Feature::Media, &["homogeneous \"mist\""]),
        (Feature::OpenSurfaces, &["sphere \"fog\""]),
        (Feature::Nested, &["box \"water\"", "sphere \"ball\""]),
        (Feature::Motion, &["box \"hand\""]),
        (Feature::LightChoice, &["constant \"sky\"", "point \"lamp\""]),
        (Feature::Layers, &["spectral"]),
    ] {
        assert!(stage.needs(feature) && stage.has(feature), "{feature:?}");
        let mut found = required_by(&stage, feature);
        found.sort();
        assert_eq!(found, by, "{feature:?}");
    }
    let (_, span) = stage.reasons.of(Feature::Layers).next().unwrap();
    let text = format!("scene 1\n{}", all.concat());
    assert_eq!(&text[span.range()], "true");
}

#[test]
fn a_plain_scene_requires_nothing() {
    let stage = staged(&scene(&[CAMERA, &film("auto {"), FLOOR, GLASS, SKY]));
    for feature in Feature::ALL {
        assert!(!stage.needs(feature) && !stage.has(feature), "{feature:?}");
        assert!(required_by(&stage, feature).is_empty(), "{feature:?}");
    }
}

#[test]
fn requiring_what_a_scene_does_not_need_changes_no_bit() {
    let still = film("rgb { shutter = 10 ms,");
    let lens = CAMERA.replace("perspective {", "thin_lens { focus = 4 m, aperture = 3 cm,");
    let lamp = "light area { shape = shape mesh { points = [(-1 m, 3 m, 0 m), (1 m, 3 m, 0 m), (0 m, 3 m, 1 m)], indices = #[ 0 1 2 ] }, spectrum = rgb.linear_srgb(1, 1, 1), scale = 5 }\n";
    for (name, parts) in [
        ("plain", vec![CAMERA, &still, FLOOR, GLASS, SKY]),
        ("a lamp", vec![CAMERA, &still, FLOOR, GLASS, lamp]),
        ("a point", vec![&*lens, &still, FLOOR, GLASS, LAMP]),
        ("two lights", vec![CAMERA, &still, FLOOR, GLASS, SKY, BY_WAVELENGTH]),
        ("fog", vec![&*lens, &still, FLOOR, GLASS, SKY, FOG]),
        ("nested", vec![CAMERA, &still, FLOOR, GLASS, WATER, SKY]),
        ("moving", vec![CAMERA, &still, FLOOR, GLASS, SKY, MOVING]),
    ] {
        let plain = scene(&parts);
        let derived = staged(&plain);
        let (expected, mut all) = (bits(&derived), plain.clone());
        assert!(expected.iter().any(|pixel| f64::from_bits(pixel[0]) > 0.0), "{name}");
        for feature in Feature::ALL.into_iter().filter(|it| it.unrequirable().is_none()) {
            let mut one = plain.clone();
            one.require(feature).unwrap();
            all.require(feature).unwrap();
            let stage = staged(&one);
            assert!(stage.has(feature) && stage.needs(feature) == derived.needs(feature));
            assert!(bits(&stage) == expected, "{name}: {feature:?}");
        }
        assert!(bits(&staged(&all)) == expected, "{name}: all");
    }
}

#[test]
fn what_is_dropped_is_as_if_the_scene_did_not_say_it() {
    let [auto, open, shut, rgb] =
        ["auto {", "auto { shutter = 10 ms,", "auto { shutter = 0 ms,", "rgb {"].map(film);
    let layered = film("auto { depth = true,");
    for (feature, with, as_if) in [
        (Feature::Spectral, [&*auto, BY_WAVELENGTH], [&*rgb, BY_WAVELENGTH]),
        (Feature::Spectral, [&*auto, BUBBLE], [&*rgb, BUBBLE]),
        (Feature::Media, [&*auto, FOG], [&*auto, ""]),
        (Feature::Motion, [&*open, MOVING], [&*shut, MOVING]),
        (Feature::Layers, [&*layered, ""], [&*auto, ""]),
    ] {
        let [with, as_if] =
            [with, as_if].map(|[film, more]| [CAMERA, film, FLOOR, GLASS, SKY, more]);
        assert!(staged(&scene(&with)).needs(feature), "{feature:?}");
        let stage = without(&with, feature);
        assert!(!stage.needs(feature) && !stage.has(feature), "{feature:?}");
        assert!(required_by(&stage, feature).is_empty(), "{feature:?}");
        assert!(bits(&stage) == bits(&staged(&scene(&as_if))), "{feature:?}");
    }
}

#[test]
fn dropped_nesting_changes_the_picture_of_glass_in_water_and_no_other() {
    let words = film("rgb {");
    for (more, is_changed) in [(WATER, true), (MOVING, false)] {
        let parts = [CAMERA, &words, FLOOR, GLASS, SKY, more];
        let stage = without(&parts, Feature::Nested);
        assert!(!stage.has(Feature::Nested));
        assert_eq!(bits(&stage) != bits(&staged(&scene(&parts))), is_changed, "{more}");
    }
}
