//! How often intervals hold the truth after `--error` has decided how many samples there are: pictures of
//! places whose light is known, each rendered 1000 times over.

use std::fmt::Write;
use std::num::NonZeroUsize;
use std::path::Path;

use luxel_core::files::MemoryFiles;
use luxel_core::film::{Film, half_width_95};
use luxel_core::render::{Control, Goal, Options, render};
use luxel_core::stage::Stage;

use crate::load::stage_of;
use crate::published;

/// Runs of each case, by as many threads.
const RUNS: u32 = 1000;
const THREADS: u32 = 4;
/// Of a normal distribution, 95 % lie within so many standard deviations.
const NORMAL_95: f64 = 1.959_964;

/// A place that looks alike in all pixels.
struct Case {
    name: &'static str,
    body: &'static str,
    truth: f64,
    /// What is asked for.
    error: f64,
    /// Whether a sample says seldom what counts, so that intervals may miss more often than one in 14.
    is_skewed: bool,
}

/// A camera above a white floor that sees a spot of a tenth of a millimetre, and a disc 1 m above it: of
/// radius r it gives the floor the share r² / (1 + r²) of its radiance.
const CASES: [Case; 3] = [
    Case {
        name: "a floor below a disc that lights are looked for on",
        body: "integrator direct {}
            light area { shape = shape disk { center = (0, 1, 0) m, normal = (0, -1, 0), radius = 1 m }, spectrum = rgb.linear_srgb(1, 1, 1), scale = 2 }
            shape rectangle { u = (0, 0, 1) m, v = (1, 0, 0) m, material = material diffuse { reflectance = 1 } }",
        truth: 1.0,
        error: 0.02,
        is_skewed: false,
    },
    Case {
        name: "inside a ball that shines and reflects half, with roulette",
        body: "integrator path { russian_roulette_from = 1 }
            light area { shape = shape sphere { radius = 3 m, material = material diffuse { reflectance = 0.5 } }, spectrum = rgb.linear_srgb(1, 1, 1), scale = 0.5, two_sided = true }",
        truth: 1.0,
        error: 0.04,
        is_skewed: false,
    },
    Case {
        name: "a floor below a disc that one path in 50 meets",
        body: "integrator path { max_depth = 1, light_sampling = false }
            light area { shape = shape disk { center = (0, 1, 0) m, normal = (0, -1, 0), radius = 1 m / 7 }, spectrum = rgb.linear_srgb(1, 1, 1), scale = 50 }
            shape rectangle { u = (0, 0, 1) m, v = (1, 0, 0) m, material = material diffuse { reflectance = 1 } }",
        truth: 1.0,
        error: 0.2,
        is_skewed: true,
    },
];

fn stage(case: &Case, sampler: &str) -> Stage {
    let text = format!(
        "scene 1
        camera perspective {{ look = look_at(from = (0, 0.5, 0) m, to = (0, 0, 0) m, up = (0, 0, 1)), fov = 0.01 deg }}
        film rgb {{ resolution = (4, 4) }}
        sampler {sampler} {{}}
        {}",
        case.body
    );
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    stage_of(Path::new("a.scene"), &files, &[], None).unwrap_or_else(|said| panic!("{said:?}"))
}

/// What runs found.
#[derive(Clone, Copy, Default)]
struct Found {
    runs: f64,
    pixels: f64,
    samples: f64,
    /// Pixels whose interval holds the truth, and pictures whose mean's does.
    held: [f64; 2],
    /// Of pictures: sum of errors, and of their squares.
    off: [f64; 2],
}

impl Found {
    fn add(&mut self, film: &Film, truth: f64) {
        for (_, pixel) in film.pixels() {
            self.pixels += 1.0;
            self.samples += f64::from(pixel.n);
            let width = pixel.standard_error().y * half_width_95(pixel.n);
            self.held[0] += f64::from(u8::from((pixel.mean.y - truth).abs() <= width));
        }
        let (mean, error) = film.mean();
        let off = mean.y - truth;
        self.runs += 1.0;
        self.held[1] += f64::from(u8::from(off.abs() <= NORMAL_95 * error.y));
        self.off = [self.off[0] + off, self.off[1] + off * off];
    }

    fn and(self, other: Self) -> Self {
        Self {
            runs: self.runs + other.runs,
            pixels: self.pixels + other.pixels,
            samples: self.samples + other.samples,
            held: [0, 1].map(|i| self.held[i] + other.held[i]),
            off: [0, 1].map(|i| self.off[i] + other.off[i]),
        }
    }

    /// Share of the pixels, and of the pictures.
    fn coverage(self) -> [f64; 2] {
        [self.held[0] / self.pixels, self.held[1] / self.runs]
    }

    /// Mean error of pictures, and its standard error.
    fn bias(self) -> (f64, f64) {
        let mean = self.off[0] / self.runs;
        let variance = self.off[1] / self.runs - mean * mean;
        (mean, (variance / (self.runs - 1.0)).sqrt())
    }
}

fn measured(case: &Case, sampler: &str) -> Found {
    let stage = &stage(case, sampler);
    let goal = Goal { error: Some(case.error), ..Goal::default() };
    let some = |first: u32| {
        let mut found = Found::default();
        for seed in (first..RUNS).step_by(THREADS as usize) {
            let (threads, seed) = (NonZeroUsize::new(1), Some(seed));
            let options = Options { goal, seed, threads, ..Options::default() };
            found.add(&render(stage, &options, &Control::default()).0, case.truth);
        }
        found
    };
    std::thread::scope(|scope| {
        let begun: Vec<_> = (0..THREADS).map(|i| scope.spawn(move || some(i))).collect();
        let found = begun.into_iter().map(|it| it.join().expect("no render panics"));
        found.fold(Found::default(), Found::and)
    })
}

#[test]
fn intervals_hold_the_truth_after_an_error_was_asked_for() {
    let mut table = String::from(
        "| place | points | asked | samples, mean | coverage of pixels | of the picture's mean | mean off by |\n|---|---|---|---|---|---|---|\n",
    );
    let mut wrong = vec![];
    for (case, sampler) in CASES.iter().flat_map(|it| [(it, "independent"), (it, "sobol")]) {
        let found = measured(case, sampler);
        let ([pixels, means], (bias, error)) = (found.coverage(), found.bias());
        let points = if sampler == "sobol" { "Sobol'" } else { sampler };
        let [asked, pixels_told, means_told] = [case.error, pixels, means].map(|x| x * 100.0);
        let (n, [bias, error]) = (found.samples / found.pixels, [bias, error].map(|x| x * 100.0));
        writeln!(table, "| {} | {points} | {asked:.0} % | {n:.0} | {pixels_told:.1} % | {means_told:.1} % | {bias:+.2} ± {error:.2} % |", case.name).unwrap();
        if !case.is_skewed && pixels.min(means) < 0.93 {
            wrong.push((case.name, sampler));
        }
    }
    println!("{table}");
    assert!(wrong.is_empty(), "{wrong:?}\n{table}");
    published::hold("accuracy.md", "coverage-asked", &table);
}
