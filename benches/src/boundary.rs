//! What the plugin boundary costs: the same built-ins linked and as a dynamic library.

use std::path::{Path, PathBuf};
use std::time::Instant;

use glam::{DVec3, Vec2, Vec3};
use luxel_core::object::{Object, Scratch, Site};
use luxel_core::registry::Registry;
use luxel_core::registry::dynamic::Library;
use luxel_sdk::color::{Palette, Wavelengths};
use luxel_sdk::kind::Material;
use luxel_sdk::sampling::{Rng, uniform_hemisphere};

use crate::process::{self, Luxel, here};
use crate::scene::{linked, stage_of};
use crate::series::Series;

/// Prints pictures and events, linked and loaded, side by side.
///
/// # Errors
/// The library is missing or does not open; the program failed.
pub(crate) fn run(luxel: &Luxel) -> Result<(), String> {
    println!(
        "pictures, {0} x {0}, {SPP} spp, processor seconds of the whole process, {1} rounds \
              in turn (goal 1.10)",
        WHOLE.size, WHOLE.rounds
    );
    println!("  {:18} {:>9} {:>9} {:>7} {:>9}", "scene", "linked", "loaded", "ratio", "spread");
    for (name, both) in PICTURES.into_iter().zip(pictures(luxel, WHOLE)?) {
        println!(
            "  {name:18} {:7.3} s {:7.3} s {:7.3} {:7.1} %",
            both.linked.min(),
            both.loaded.min(),
            both.ratio(),
            both.spread()
        );
    }
    events(&library(luxel)?)
}

/// The library of the built-ins in the folder of the program.
fn library(luxel: &Luxel) -> Result<PathBuf, String> {
    let words = ["rustc", "-p", "luxel-builtin-library", "--crate-type", "cdylib"];
    process::library(luxel, "builtins", &words)
}

/// What the same took with the built-ins linked and loaded.
pub(crate) struct Both {
    linked: Series,
    loaded: Series,
}

impl Both {
    /// What it takes loaded, in parts of what it takes linked.
    pub(crate) fn ratio(&self) -> f64 {
        self.loaded.min() / self.linked.min()
    }

    /// The greater of the two, in per cent.
    fn spread(&self) -> f64 {
        self.linked.spread().max(self.loaded.spread())
    }
}

/// How much is measured.
#[derive(Clone, Copy)]
pub(crate) struct Amount {
    /// Width and height of the pictures.
    pub(crate) size: u32,
    /// Rounds of pictures, each of both ways.
    pub(crate) rounds: usize,
}

pub(crate) const WHOLE: Amount = Amount { size: 256, rounds: 7 };
/// Samples per pixel: enough that opening the library does not count.
const SPP: u32 = 64;

/// Scenes whose pictures are made.
const PICTURES: [&str; 2] = ["cornell_rgb", "glass_metal"];

/// Processor seconds of the Cornell box, and of the spheres of glass and metal.
///
/// # Errors
/// As `run`.
pub(crate) fn pictures(
    luxel: &Luxel,
    Amount { size, rounds }: Amount,
) -> Result<Vec<Both>, String> {
    let flag = format!("--builtins={}", library(luxel)?.display());
    let mut found = vec![];
    for name in PICTURES {
        let scene = here().join(format!("scenes/{name}.scene"));
        let (mut linked, mut loaded) = (vec![], vec![]);
        for _ in 0..rounds {
            linked.push(luxel.render_with(&scene, size, SPP, &[])?.cpu);
            loaded.push(luxel.render_with(&scene, size, SPP, &[&flag])?.cpu);
        }
        found.push(Both { linked: Series::from(linked), loaded: Series::from(loaded) });
    }
    Ok(found)
}

/// Materials of the table, in a scene each: name, colour mode, text.
const EVENTS: [(&str, &str, &str); 6] = [
    ("diffuse, constant", "rgb", "material diffuse { reflectance = 0.5 }"),
    ("diffuse, 1 texture", "rgb", "material diffuse { reflectance = texture checker {} }"),
    ("GGX metal, constant", "rgb", "material conductor { eta = 0.2, k = 3.9, roughness = 0.3 }"),
    (
        "GGX, textures, spectral",
        "spectral",
        "material conductor { eta = metal(\"Au\"), roughness = texture checker { a = 0.2, b = 0.4 } }",
    ),
    (
        "rough glass, spectral",
        "spectral",
        "material dielectric { ior = glass(\"N-BK7\"), roughness = 0.2 }",
    ),
    (
        "mix of matt and metal",
        "rgb",
        "material mix { a = material diffuse { reflectance = texture checker {} }, \
         b = material conductor { eta = 0.2, k = 3.9, roughness = 0.3 }, weight = texture checker {} }",
    ),
];

fn scene(mode: &str, material: &str) -> String {
    format!(
        "scene 1\ncamera perspective {{ look = look_at(from = (0, 0, 4) m, to = (0, 0, 0) m, \
         up = (0, 1, 0)), fov = 40 deg }}\nfilm {mode} {{ resolution = (8, 8) }}\n\
         light constant {{ radiance = 1 W/m^2/sr }}\n\
         shape sphere {{ radius = 1 m, material = {material} }}\n"
    )
}

fn events(library: &Path) -> Result<(), String> {
    let library = Library::open(library, "builtins", 0).map_err(|error| error.to_string())?;
    let mut loaded = Registry::new();
    loaded.add("builtin", &library.classes).map_err(|conflict| conflict.to_string())?;
    let linked = linked();
    println!(
        "a shading event: parameters at the point, eval, sample; ns, least of 41 rounds in turn \
              (goal 1.05)"
    );
    println!("  {:26} {:>9} {:>9} {:>7} {:>9}", "material", "linked", "loaded", "ratio", "spread");
    for (name, mode, material) in EVENTS {
        let text = scene(mode, material);
        let stages = [stage_of(&linked, &text)?, stage_of(&loaded, &text)?];
        let mut found = [vec![], vec![]];
        for _ in 0..41 {
            for (stage, found) in stages.iter().zip(&mut found) {
                found.push(event(&stage.materials[0], mode == "spectral"));
            }
        }
        let [linked, loaded] = found.map(Series::from);
        let both = Both { linked, loaded };
        println!(
            "  {name:26} {:6.1} ns {:6.1} ns {:7.3} {:7.1} %",
            both.linked.min(),
            both.loaded.min(),
            both.ratio(),
            both.spread()
        );
    }
    Ok(())
}

/// Events in one round.
const N: u32 = 20_000;

/// Nanoseconds of one event, over many points, directions and numbers.
fn event(material: &Object, spectral: bool) -> f64 {
    let mut rng = Rng::new(7);
    let palette = if spectral { Palette::new(Wavelengths::sample(0.3)) } else { Palette::rgb() };
    let directions: Vec<(Vec3, Vec3, Vec2)> = (0..512)
        .map(|_| {
            let [a, b] = [rng.pair(), rng.pair()].map(uniform_hemisphere);
            (a, b, Vec2::from(rng.pair()))
        })
        .collect();
    let (mut scratch, mut sum) = (Scratch::default(), 0.0);
    let start = Instant::now();
    for i in 0..N {
        let (wo, wi, uv) = directions[i as usize % directions.len()];
        scratch.reset();
        let site = Site { p: DVec3::ZERO, uv, palette: &palette, color: None };
        let material: &dyn Material = material.resolve(&site, &scratch).material();
        sum += material.eval(wo, wi).pdf;
        sum += material.sample(wo, [uv.x, uv.y, 0.3]).map_or(0.0, |sample| sample.pdf);
    }
    let ns = start.elapsed().as_secs_f64() * 1e9 / f64::from(N);
    std::hint::black_box(sum);
    ns
}
