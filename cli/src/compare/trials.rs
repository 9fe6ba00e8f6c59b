//! Two seeds of a scene are the same, and a bias of 1 % in a material is found: tried many times.

use std::path::Path;

use glam::UVec2;
use luxel_core::files::MemoryFiles;
use luxel_core::film::Rect;
use luxel_core::registry::Registry;
use luxel_core::render::{Control, Options, render};
use luxel_core::stage::{self, Stage};

use super::judge::{POWER, judge};
use super::numbers::Numbers;
use super::pair::Pair;
use super::verdict::{Limits, Verdict, Word};
use crate::picture::{self, Notes, Picture};
use crate::testing::published;

/// A ball on a ground under a sky.
const SCENE: &str = "scene 1
    param rho: float = 0.5
    camera perspective { look = look_at(from = (0, 1, 4) m, to = (0, 0.5, 0) m, up = (0, 1, 0)), fov = 13 deg }
    film rgb { resolution = (32, 32) }
    sampler sobol { samples = 16 }
    integrator path { light_sampling = false }
    light constant { scale = 1 }
    shape sphere { center = (0, 0.5, 0) m, radius = 50 cm, material = material diffuse { reflectance = rho } }
    shape plane { point = (0, 0, 0) m, normal = (0, 1, 0), material = material diffuse { reflectance = 0.8 } }";

/// A ball of 0.4 pixels in the middle of each 8 × 8 tile, black before a sky of 1: half of the samples of
/// one pixel in 64 meet it, and nothing else is random.
const DOTS: &str = "scene 1
    param rho: float = 0.5
    camera orthographic { look = look_at(from = (0, 0, 10) m, to = (0, 0, 0) m, up = (0, 1, 0)), height = 64 m }
    film rgb { resolution = (64, 64) }
    sampler independent { samples = 16 }
    integrator path {}
    light constant { scale = 1 }
    for y in 0..8 { for x in 0..8 {
        shape sphere { center = (8 * x - 28.5, 8 * y - 28.5, 0) m, radius = 40 cm, material = material diffuse { reflectance = 0 } }
    } }";

/// A ball of glass under a small lamp, which only paths through the glass and chance find: of most pixels
/// few samples are bright, and those very.
const CAUSTIC: &str = "scene 1
    param rho: float = 0.5
    camera perspective { look = look_at(from = (0, 1.5, 3) m, to = (0, 0.3, 0) m, up = (0, 1, 0)), fov = 30 deg }
    film rgb { resolution = (16, 16) }
    sampler SAMPLER { samples = 16 }
    integrator path { max_depth = 8 }
    light constant { scale = 0.2 }
    light area {
        shape = shape sphere { center = (-0.8, 2, -0.5) m, radius = 20 cm }
        radiance = 20 W/m^2/sr
    }
    shape sphere { center = (0, 0.5, 0) m, radius = 40 cm, material = material dielectric { ior = 1.5 } }
    shape plane { point = (0, 0, 0) m, normal = (0, 1, 0), material = material diffuse { reflectance = rho } }";

fn stage(scene: &str, rho: &str) -> Stage {
    let mut registry = Registry::new();
    for classes in luxel_builtin::CLASSES {
        registry.add("builtin", classes).unwrap();
    }
    let reflectance = &include_bytes!("../../../scenes/cornell/reflectance.csv")[..];
    let files = MemoryFiles::default()
        .with("a.scene", scene.as_bytes())
        .with("cornell/reflectance.csv", reflectance);
    let settings =
        luxel_lang::Settings { set: vec![("rho".into(), rho.into())], ..Default::default() };
    let loaded = luxel_lang::load(Path::new("a.scene"), &files, &registry, &settings);
    let scene = loaded.scene.unwrap_or_else(|| panic!("{:?}", loaded.diagnostics));
    stage::build(&scene, &registry, &files, None).unwrap().stage
}

/// A picture as a file gives it back.
fn picture(stage: &Stage, seed: u32, spp: u32) -> Picture {
    let options = Options { seed: Some(seed), spp: Some(spp), ..Options::default() };
    let film = render(stage, &options, &Control::default()).0;
    picture::reread(&film, &Notes { json: format!(r#"{{"seed":{seed}}}"#) })
}

/// The word, the relative bias that is seen, and how large a difference there is.
fn verdict(a: Picture, b: Picture) -> (Word, f64, f64) {
    let limits = Limits { alpha: 0.01, bias: 0.01 };
    let pair = Pair::new(a, b).unwrap();
    let judged = judge(&pair, limits.alpha);
    let word = Verdict::of(&pair, &Numbers::of(&pair), &judged, limits).word;
    (word, judged.detectable.whole, judged.whole[0].relative())
}

/// How many pairs of seeds are tried.
const TRIALS: u32 = 200;

/// The least number of successes of `n` trials that one run in a thousand falls short of, if each
/// succeeds with the probability `p`.
fn least(n: u32, p: f64) -> u32 {
    // By logarithms: all failing has no float beyond a few hundred trials.
    let (mut sum, mut term) = (0.0, f64::from(n) * (1.0 - p).ln());
    for k in 0..n {
        sum += f64::exp(term);
        if sum > 1e-3 {
            return k;
        }
        term += (f64::from(n - k) / f64::from(k + 1) * p / (1.0 - p)).ln();
    }
    n
}

/// Which of two renders of each trial differ: of the same scene, and of one with another reflectance.
fn words(rho: &str, spp: u32) -> Vec<(Word, f64)> {
    let (a, b) = (stage(SCENE, rho), stage(SCENE, "0.5"));
    let trial = |seed| {
        let (word, seen, _) = verdict(picture(&a, seed, spp), picture(&b, seed + 100_000, spp));
        (word, seen)
    };
    (0..TRIALS).map(trial).collect()
}

#[test]
fn two_seeds_of_one_scene_are_the_same() {
    let words = words("0.5", 48);
    let same = words.iter().filter(|(word, _)| *word == Word::Same).count();
    // 190 of 200: one in a hundred may be called different, and some be too noisy.
    let least = words.len() * 19 / 20;
    assert!(same >= least, "{words:?}");
    let n = words.len();
    let told =
        format!("{same} of {n} pairs of seeds of one scene are `same`; {least} are asked for.");
    published::hold("accuracy.md", "trials-same", &told);
}

/// Biases of the whole picture that are to be excluded where noise is skewed.
const BIASES: [f64; 3] = [0.01, 0.1, 0.25];

/// What pairs of seeds of one scene are called, for each of those biases.
fn words_by_bias(stage: &Stage, spp: u32) -> Vec<[Word; 3]> {
    let words = |seed| {
        let pair = Pair::new(picture(stage, seed, spp), picture(stage, seed + 100_000, spp));
        let (pair, alpha) = (pair.unwrap(), 0.01);
        let (numbers, judged) = (Numbers::of(&pair), judge(&pair, alpha));
        BIASES.map(|bias| Verdict::of(&pair, &numbers, &judged, Limits { alpha, bias }).word)
    };
    (0..TRIALS).map(words).collect()
}

#[test]
fn two_seeds_of_a_caustic_are_not_called_different() {
    let heads = BIASES.map(|bias| format!("`same`, `--bias {:.0}%`", bias * 100.0)).join(" | ");
    let mut rows = vec![format!("| points | `different` | {heads} |"), "|---".repeat(5) + "|"];
    for (name, sampler) in [("independent", "independent"), ("Sobol'", "sobol")] {
        let stage = stage(&CAUSTIC.replace("SAMPLER", sampler), "0.5");
        let words = words_by_bias(&stage, 48);
        let count = |i: usize, of| words.iter().filter(|word| word[i] == of).count();
        let same = [0, 1, 2].map(|i| count(i, Word::Same));
        let different = count(0, Word::Different);
        rows.push(format!(
            "| {name} | {different} | {} |",
            same.map(|n| n.to_string()).join(" | ")
        ));
        println!("{}", rows[rows.len() - 1]);
        // One in a hundred may be called different; 95 % are called the same where noise allows it.
        assert!(words.len() - different >= least(TRIALS, 0.99) as usize, "{rows:?}");
        assert!(same[2] >= words.len() * 19 / 20, "{rows:?}");
    }
    published::hold("accuracy.md", "trials-skewed", &rows.join("\n"));
}

#[test]
fn samples_that_are_equal_by_chance_make_no_difference() {
    let dots = stage(DOTS, "0.5");
    for (spp, expected) in [(8, Word::Inconclusive), (16, Word::Same)] {
        let word = |seed| verdict(picture(&dots, seed, spp), picture(&dots, seed + 100_000, spp)).0;
        let words: Vec<_> = (0..TRIALS).map(word).collect();
        println!("{spp} {words:?}");
        assert!(words.iter().all(|word| *word == expected), "{spp}: {words:?}");
    }
}

#[test]
fn a_bias_of_a_hundredth_in_one_material_is_found_with_the_stated_power() {
    // Equal seeds: nearly all of the noise is common, and what is left is the bias.
    let (brighter, plain) = (stage(SCENE, "0.505"), stage(SCENE, "0.5"));
    let (_, _, bias) = verdict(picture(&brighter, 1, 256), picture(&plain, 1, 256));
    let words = words("0.505", 48);
    let seen = words.iter().map(|(_, seen)| *seen).fold(0.0, f64::max);
    let found = words.iter().filter(|(word, _)| *word == Word::Different).count();
    assert!(seen <= bias, "the picture's mean is off by {bias}, and {seen} is seen");
    let least = least(TRIALS, POWER) as usize;
    assert!(found >= least, "{words:?}");
    let [bias, seen] = [bias, seen].map(|share| format!("{:.2} %", share * 100.0));
    let told = format!(
        "{found} of {TRIALS} are `different` where the ball's reflectance is 1 % higher in one, which is {bias} of the\n\
         mean, {seen} or less of which was stated to be found; {least} are asked for."
    );
    published::hold("accuracy.md", "trials-different", &told);
}

/// The Cornell box as it ships, its lamp of a brightness that can be set.
fn cornell() -> String {
    let (lamp, whole) = ("  scale    = 2\n", "film spectral { resolution = (512, 512) }");
    let text = include_str!("../../../scenes/cornell.scene");
    assert!(text.contains(lamp) && text.contains(whole), "the scene is as it was");
    let small = "film spectral { resolution = (64, 64) }";
    let text = text.replace(lamp, "  scale    = 4 * rho\n").replace(whole, small);
    text.replace("scene 1\n", "scene 1\nparam rho: float = 0.5\n")
}

/// Lamp and ceiling about it.
const ABOUT_THE_LAMP: Rect = Rect { min: UVec2::new(20, 4), size: UVec2::new(24, 12) };

/// Biases that are injected are so many times the one that a typical pair is stated to tell.
const OVER: f64 = 1.2;

/// Pairs that are tried of each of these.
const FEW: u32 = 60;

/// A scene, the part of it that is looked at, and samples.
struct Injected {
    scene: String,
    crop: Option<Rect>,
    spp: u32,
}

/// What of a picture's mean is stated to be told, at the median pair; how large the bias is that was
/// injected; and how many pairs of it are `different`, of those that were stated to tell it, and of all.
fn injected(of: &Injected) -> ([f64; 2], [usize; 3]) {
    let picture = |stage: &Stage, seed: u32, spp: u32| {
        let options =
            Options { seed: Some(seed), spp: Some(spp), crop: of.crop, ..Options::default() };
        let film = render(stage, &options, &Control::default()).0;
        picture::reread(&film, &Notes { json: format!(r#"{{"seed":{seed}}}"#) })
    };
    let plain = stage(&of.scene, "0.5");
    let other = |seed: u32| picture(&plain, seed + 100_000, of.spp);
    let mut seen: Vec<f64> =
        (0..FEW).map(|seed| verdict(picture(&plain, seed, of.spp), other(seed)).1).collect();
    seen.sort_by(f64::total_cmp);
    let seen = seen[seen.len() / 2];
    // Equal seeds: nearly all of the noise is common, and what is left is the bias. It is nearly
    // proportional to what is added, so that two steps find how much that is to be.
    let bias = |rho: f64| {
        let brighter = stage(&of.scene, &format!("{rho}"));
        let pictures = [&brighter, &plain].map(|stage| picture(stage, 1, 4 * of.spp));
        let [a, b] = pictures;
        verdict(a, b).2
    };
    let mut more = 0.5 * OVER * seen;
    for _ in 0..2 {
        more *= OVER * seen / bias(0.5 + more);
    }
    let brighter = stage(&of.scene, &format!("{}", 0.5 + more));
    let (mut told, mut found, mut all) = (0, 0, 0);
    for seed in 0..FEW {
        let (word, stated, _) = verdict(picture(&brighter, seed, of.spp), other(seed));
        let is_found = word == Word::Different;
        let is_stated = stated <= OVER * seen;
        all += usize::from(is_found);
        told += usize::from(is_stated);
        found += usize::from(is_found && is_stated);
    }
    ([seen, bias(0.5 + more)], [found, told, all])
}

#[test]
fn a_bias_of_what_is_stated_is_found_with_a_lamp_in_view_and_in_a_caustic() {
    let caustic = |sampler| CAUSTIC.replace("SAMPLER", sampler);
    let scenes = [
        ("Cornell box, lamp in view", cornell(), Some(ABOUT_THE_LAMP), 32),
        ("caustic, independent", caustic("independent"), None, 48),
        ("caustic, Sobol'", caustic("sobol"), None, 48),
    ];
    let mut rows = vec![
        "| scene | stated to be told | injected | found, of those that state it | found, of all |"
            .to_owned(),
        "|---".repeat(5) + "|",
    ];
    for (name, scene, crop, spp) in scenes {
        let ([seen, bias], [found, told, all]) = injected(&Injected { scene, crop, spp });
        let [seen, bias] = [seen, bias].map(|share| format!("{:.2} %", share * 100.0));
        rows.push(format!("| {name} | {seen} | {bias} | {found} of {told} | {all} of {FEW} |"));
        println!("{}", rows[rows.len() - 1]);
        let told = u32::try_from(told).unwrap();
        assert!(found >= least(told, POWER) as usize, "{rows:?}");
    }
    published::hold("accuracy.md", "trials-injected", &rows.join("\n"));
}

#[test]
fn the_least_number_of_successes_is_the_binomials() {
    // SciPy 1.17: the largest k with stats.binom.cdf(k - 1, n, 0.95) <= 1e-3.
    assert_eq!([20, 200, 1000].map(|n| least(n, 0.95)), [15, 179, 927]);
}
