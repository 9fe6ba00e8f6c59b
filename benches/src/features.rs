//! What features cost: each that a scene does not require, with its code and without; each that it
//! requires, dropped and not, or beside a scene that looks alike where it cannot be dropped. Pairs are
//! rendered one after the other, first one then the other first.

use std::num::NonZeroUsize;
use std::time::Instant;

use luxel_core::files::MemoryFiles;
use luxel_core::film::{Film, Layer};
use luxel_core::render::{Control, Options, render};
use luxel_core::scene::{Feature, Scene};
use luxel_core::stage::{self, Stage};

use crate::scene::{linked, scene_in};
use crate::series::Series;

/// Pairs of renders; the first is not counted.
const PAIRS: usize = 15;
const SPP: u32 = 16;
/// Of the pictures, in pixels.
const SIZE: [u32; 2] = [160, 120];

const BOX: &str = include_str!("../scenes/cornell_rgb.scene");
const GLASS: &str = include_str!("../scenes/glass_metal.scene");

/// Scenes of the project.
const SCENES: [(&str, &str); 4] = [
    ("Cornell box", BOX),
    ("glass and metal", GLASS),
    ("fog", include_str!("../../scenes/fog.scene")),
    ("motion", include_str!("../../scenes/motion.scene")),
];

/// Within the glass ball of `GLASS`.
const WATER: &str = "shape sphere \"water\" {
    center = (170, 100, 180), radius = 60, material = material dielectric { ior = 1.33 } }";

/// Two of those above, each requiring one feature more.
fn enriched() -> Result<[(&'static str, Feature, Scene); 3], String> {
    let mut layered = small(BOX)?;
    for layer in Layer::ALL {
        layered.add_layer(layer);
    }
    let spectral = small(include_str!("../scenes/cornell_spectral.scene"))?;
    let nested = small(&format!("{GLASS}\n{WATER}\n"))?;
    Ok([
        ("Cornell box by wavelength", Feature::Spectral, spectral),
        ("Cornell box, all layers", Feature::Layers, layered),
        ("water in glass", Feature::Nested, nested),
    ])
}

/// The lamp of `BOX`, and the same in two halves.
const LAMP: &str = "light area \"lamp\" {
  shape    = shape rectangle {
    center   = (278, 548.3, 279.5)
    u        = (130, 0, 0)";
const HALVES: &str = "for x in [245.5, 310.5] { light area {
  shape    = shape rectangle {
    center   = (x, 548.3, 279.5)
    u        = (65, 0, 0)";
/// Where the lamp ends.
const LAMP_END: &str = "  scale    = 1\n}";

/// Thin fog everywhere, and in a ball around the box and the camera.
const FOG: &str = "medium homogeneous { sigma_t = 1 / (3 m), albedo = 0.8 }";
const FOG_BALL: &str = "shape sphere \"fog\" { center = (278, 273, 0), radius = 4000,
    interior = medium homogeneous { sigma_t = 1 / (3 m), albedo = 0.8 } }";

/// Name, feature, and a scene that needs it with one that does not.
type Alike = (&'static str, Feature, [Scene; 2]);

/// What cannot be dropped: scenes that need it, each with one that looks alike and does not.
fn alike() -> Result<[Alike; 2], String> {
    let halves = BOX.replacen(LAMP_END, &format!("{LAMP_END} }}"), 1).replacen(LAMP, HALVES, 1);
    let lamps = [small(&halves)?, small(BOX)?];
    let fogs = [small(&format!("{BOX}\n{FOG_BALL}\n"))?, small(&format!("{BOX}\n{FOG}\n"))?];
    Ok([
        ("Cornell box, its lamp in two halves", Feature::LightChoice, lamps),
        ("Cornell box in a ball of fog", Feature::OpenSurfaces, fogs),
    ])
}

/// Prints for each scene and feature the time of the one over that of the other.
///
/// # Errors
/// A scene does not build.
pub(crate) fn run() -> Result<(), String> {
    println!(
        "one thread, {SPP} spp, medians of {} ratios of interleaved pairs, with the middle half",
        PAIRS - 1
    );
    println!("| scene | feature | | ratio | middle half | bits |\n|---|---|---|---|---|---|");
    for (name, text) in SCENES {
        features(name, &small(text)?, &Feature::ALL)?;
    }
    for (name, feature, scene) in enriched()? {
        features(name, &scene, &[feature])?;
    }
    for (name, feature, [with, without]) in alike()? {
        let [with, without] = [built(&with)?, built(&without)?];
        let is_told = with.needs(feature) && !without.needs(feature);
        let is_told = is_told.then(|| told(&with, &without));
        let ratios = is_told.ok_or_else(|| format!("{name}: which needs `{}`?", feature.name()))?;
        println!("| {name} | `{}` | used / alike without | {ratios} |", feature.name());
    }
    Ok(())
}

/// The scene of a text, with a small picture.
fn small(text: &str) -> Result<Scene, String> {
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let mut scene = scene_in(&linked(), &files)?;
    scene.set_resolution(SIZE.into());
    Ok(scene)
}

/// A scene's rows of these features.
fn features(name: &str, scene: &Scene, of: &[Feature]) -> Result<(), String> {
    let derived = built(scene)?;
    println!("| {name} | as derived, twice | | {} |", told(&derived, &built(scene)?));
    for feature in of.iter().copied() {
        let mut other = scene.clone();
        let is_used = derived.needs(feature);
        let way = if is_used {
            other.leave_out(feature).map(|()| "used / dropped")
        } else {
            other.require(feature).map(|()| "required / left out")
        };
        let Ok(way) = way else { continue };
        let other = built(&other)?;
        let ratios = if is_used { told(&derived, &other) } else { told(&other, &derived) };
        println!("| {name} | `{}` | {way} | {ratios} |", feature.name());
    }
    Ok(())
}

fn built(scene: &Scene) -> Result<Stage, String> {
    let built = stage::build(scene, &linked(), &MemoryFiles::default(), None);
    built.map(|built| built.stage).map_err(|found| format!("{found:?}"))
}

/// How much longer one takes than the other: the median, where the middle half lies, and whether the
/// pictures are the same.
fn told(one: &Stage, other: &Stage) -> String {
    let mut ratios = vec![];
    let mut same = true;
    for pair in 0..PAIRS {
        let ((a, seen), (b, shown)) = if pair % 2 == 0 {
            (timed(one), timed(other))
        } else {
            let second = timed(other);
            (timed(one), second)
        };
        same &= bits(&seen).eq(bits(&shown));
        if pair > 0 {
            ratios.push(a / b);
        }
    }
    let ratios = Series::from(ratios);
    let bits = if same { "the same" } else { "others" };
    let [low, high] = [25, 75].map(|percent| ratios.percentile(percent));
    format!("{:.3} | {low:.3} to {high:.3} | {bits}", ratios.median())
}

fn timed(stage: &Stage) -> (f64, Film) {
    let options = Options { spp: Some(SPP), threads: NonZeroUsize::new(1), ..Options::default() };
    let start = Instant::now();
    let (film, _) = render(stage, &options, &Control::default());
    (start.elapsed().as_secs_f64(), film)
}

/// Of every number of a picture.
fn bits(film: &Film) -> impl Iterator<Item = u64> + '_ {
    film.pixels().flat_map(|(_, pixel)| {
        let (mean, variance) = (pixel.mean, pixel.variance());
        [mean, variance].into_iter().flat_map(|it| it.to_array().map(f64::to_bits))
    })
}
