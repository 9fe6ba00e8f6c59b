//! The example library in C: without warnings, judged, and in pictures.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use glam::DVec3;
use luxel_conformance::{Options as Effort, run};
use luxel_core::files::MemoryFiles;
use luxel_core::film::Film;
use luxel_core::registry::Registry;
use luxel_core::registry::dynamic::Library;
use luxel_core::render::{Control, Options, Outcome, render};

use super::compiler::{Folder, opened, run_sanitized};
use super::registered;
use crate::disk::root;

fn source(name: &str) -> PathBuf {
    root().join("plugins/examples/disk_c").join(name)
}

/// The library, compiled and opened once.
fn example() -> &'static Library {
    static LIBRARY: OnceLock<Library> = OnceLock::new();
    LIBRARY.get_or_init(|| {
        let folder = Folder::new();
        opened(&folder, &source("disk_c.c"), "disk_c", &["-O2"]).unwrap()
    })
}

fn registry() -> Registry {
    registered(&[example()])
}

#[test]
fn the_library_says_what_it_is() {
    let library = example();
    assert_eq!((&*library.name, &*library.version, &*library.compiler), ("disk_c", "0.1.0", "C"));
    let names: Vec<_> = library.classes.iter().map(|class| format!("{class:?}")).collect();
    assert_eq!(names, ["shape disk_c", "material velvet_c"]);
}

#[test]
fn the_library_satisfies_the_suite() {
    let effort = Effort { samples: 4096, sets: 2, ..Effort::default() };
    let report = run(&registry(), |class| class.name.ends_with("_c"), &effort);
    assert!(report.rows.len() > 40, "nothing was judged: {report}");
    assert!(report.is_clean() && report.unmade().next().is_none(), "{report}");
}

#[test]
fn every_function_is_sound_under_the_sanitizers() {
    let folder = Folder::new();
    run_sanitized(&source("check.c"), &folder.path("check"));
}

#[test]
fn its_manual_pages_show_scenes_that_load() {
    for class in &example().classes {
        let snippet = class.doc.split("```").nth(1).and_then(|s| s.strip_prefix("scene")).unwrap();
        let white = "let white = material diffuse { reflectance = 0.8 }\n";
        let text = format!("scene 1\n{white}{CAMERA}{snippet}");
        let files = MemoryFiles::default().with("a.scene", text.as_bytes());
        let settings = luxel_lang::Settings::default();
        let said = luxel_lang::load(Path::new("a.scene"), &files, &registry(), &settings);
        assert!(said.diagnostics.iter().all(|d| !d.is_error()), "{:?}", said.diagnostics);
    }
}

const CAMERA: &str = "camera perspective {
    look = look_at(from = (0, 2, 4) m, to = (0, 0.5, 0) m, up = (0, 1, 0)), fov = 40 deg }\n";

fn picture(body: &str, samples: u32) -> Film {
    let scene = format!(
        "scene 1\n{CAMERA}film rgb {{ resolution = (24, 24) }}
        light constant {{ spectrum = rgb.linear_srgb(1, 1, 1), scale = 0.3 }}
        let red = material diffuse {{ reflectance = rgb.linear_srgb(0.8, 0.2, 0.1) }}\n{body}"
    );
    let stage = super::stage(&registry(), &scene).unwrap_or_else(|said| panic!("{said:?}"));
    let options = Options { spp: Some(samples), ..Options::default() };
    let (film, outcome) = render(&stage, &options, &Control::default());
    assert_eq!((outcome, film.bad_samples()), (Outcome::Complete, 0), "{:?}", stage.failures());
    film
}

/// Two pictures of the same thing: means within five standard errors of their difference in each
/// channel, for the whole and for each quarter.
fn check_same(a: &str, b: &str) {
    let (a, b) = (picture(a, 64), picture(b, 64));
    let mut sums = [[DVec3::ZERO; 2]; 5];
    for ((at, p), (_, q)) in a.pixels().zip(b.pixels()) {
        let quarter = usize::from(at.x >= 12) + 2 * usize::from(at.y >= 12);
        let variance = p.variance() / f64::from(p.n.max(1)) + q.variance() / f64::from(q.n.max(1));
        for i in [quarter, 4] {
            sums[i][0] += p.mean - q.mean;
            sums[i][1] += variance;
        }
    }
    for [difference, variance] in sums {
        // A picture without noise is the same to a few roundings of f32 in each of 576 pixels.
        let allowed = 5.0 * variance.map(f64::sqrt) + 576.0 * 4.0 * f64::from(f32::EPSILON);
        assert!(difference.abs().cmple(allowed).all(), "{difference} is beyond {allowed}");
    }
    assert!(a.mean().0.min_element() > 0.05, "the picture is dark");
}

#[test]
fn a_disk_and_a_ring_look_like_the_built_in_ones() {
    let lamp = "spectrum = rgb.linear_srgb(1, 1, 1), radiance = 4 W/m^2/sr }";
    let scene = |class: &str| {
        format!(
            "shape {class} {{ center = (0, 0.1, 0) m, normal = (0.1, 1, 0.2), radius = 1.5 m,
                inner_radius = 0.4 m, material = red }}
            shape {class} {{ radius = 3 m }}
            light area {{ shape = shape {class} {{ center = (0.5, 2, 0) m, normal = (0, -1, 0),
                radius = 0.5 m }}, {lamp}"
        )
    };
    check_same(&scene("disk_c"), &scene("disk"));
}

#[test]
fn a_disk_of_three_pieces_is_a_disk() {
    let piece = |angle: f64| {
        let (sin, cos) = angle.to_radians().sin_cos();
        format!(
            "shape disk_c {{ radius = 1.5 m, start = ({cos}, 0, {}), sweep = 120 deg,
                material = red }}\n",
            -sin
        )
    };
    let pieces = [0.0, 120.0, 240.0].map(piece).concat();
    check_same(&pieces, "shape disk { radius = 1.5 m, material = red }");
}

#[test]
fn velvet_without_fibres_is_matt_and_with_them_bright_at_the_rim() {
    let ball = |material: &str| {
        format!("shape sphere {{ center = (0, 0.6, 0) m, radius = 1 m, material = {material} }}")
    };
    let colour = "reflectance = rgb.linear_srgb(0.8, 0.2, 0.1)";
    check_same(&ball(&format!("material velvet_c {{ {colour}, sheen = 0 }}")), &ball("red"));
    let textured = "material velvet_c { reflectance = texture checker { a = 0.5, b = 0.5 },
        sheen = texture checker { a = 0, b = 0 } }";
    check_same(&ball(textured), &ball("material diffuse { reflectance = 0.5 }"));
    // In light from everywhere a point reflects 1 - sheen cos: next to nothing in the middle.
    let white = "material velvet_c { reflectance = 1, sheen = 1 }";
    let film = picture(&ball(white), 64);
    let centre = film.pixel(glam::UVec2::new(12, 11)).mean.y;
    assert!(centre < 0.1 * 0.3, "the middle reflects {centre}");
}
