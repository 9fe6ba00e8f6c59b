//! What rays side by side, and numbers too small to be normal, do to whole pictures.

use std::num::NonZeroUsize;
use std::time::Instant;

use luxel_core::accel::Precision;
use luxel_core::files::MemoryFiles;
use luxel_core::render::{Control, Options, render};
use luxel_core::stage::Stage;

use crate::ply::grid;
use crate::scene::{linked, stage_of, stage_with};
use crate::series::Series;

/// Rounds of each way, interleaved.
const ROUNDS: usize = 7;
const SPP: u32 = 8;
/// Pixels of the pictures.
const PIXELS: u32 = 256 * 256;
/// Vertices along each side of the meshes: 70,688 and 2,093,058 triangles.
const SMALL: u32 = 189;
const SIDE: u32 = 1024;
/// Placements of the small mesh instead of one.
const PLACED: &str = "let small = shape mesh { file = \"waves.ply\", unit = 1 m, material = material diffuse { reflectance = 0.5 } }
for i in 0..20 { for j in 0..20 { place small { transform = [scale(0.05), move((i - 9.5, 0, j - 9.5) * 0.1 m)] } } }
";

/// Prints paths per second of one thread.
///
/// # Errors
/// A scene does not build.
pub(crate) fn run() -> Result<(), String> {
    let cornell = include_str!("../scenes/cornell_rgb.scene").replace("(512, 512)", "(256, 256)");
    let waves = include_str!("../scenes/waves.scene");
    let registry = linked();
    let box_of = |text: &str| stage_of(&registry, text);
    let of = |side: u32, text: &str| {
        let files = MemoryFiles::default().with("waves.ply", grid(side).as_slice());
        stage_with(&registry, files, text)
    };
    let looks = waves.split("shape mesh").next().unwrap_or(waves);
    let placed = format!("{looks}{PLACED}");
    let foggy = format!(
        "{waves}shape sphere {{ radius = 9 m, interior = medium homogeneous {{ sigma_t = 0.1 / (1 m), albedo = 0.9 }} }}\n"
    );
    let stages = [
        ("Cornell box", box_of(&cornell)?),
        ("70 k triangles", of(SMALL, waves)?),
        ("400 of these", of(SMALL, &placed)?),
        ("2 M triangles", of(SIDE, waves)?),
        ("2 M in fog", of(SIDE, &foggy)?),
    ];
    println!("rays of whole pictures, one thread, Mpaths/s: best of {ROUNDS} rounds, interleaved");
    println!(
        "  {:14}{:>12}{:>14}{:>12}{:>10}",
        "", "one by one", "side by side", "as chosen", "spread"
    );
    let paths = f64::from(PIXELS * SPP) / 1e6;
    for (name, stage) in &stages {
        let [single, flock, chosen] =
            rates([(stage, Some(false)), (stage, Some(true)), (stage, None)]);
        let spread = single.spread().max(flock.spread()).max(chosen.spread());
        let [single, flock, chosen] = [single, flock, chosen].map(|seconds| paths / seconds.min());
        println!("  {name:14}{single:12.3}{flock:14.3}{chosen:12.3}{spread:8.1} %");
    }
    precisions(waves, &of)?;
    let dim = cornell.replace(
        "rgb.linear_srgb(17, 12, 4)\n  scale    = 1\n",
        "rgb.linear_srgb(17, 12, 4)\n  scale    = 1e-41\n",
    );
    if dim == cornell {
        return Err("the lamp of cornell_rgb.scene is not where it was".to_owned());
    }
    let dim = box_of(&dim)?;
    let [normal, tiny] = rates([(&stages[0].1, None), (&dim, None)]);
    println!(
        "a lamp of 1e-40 in the Cornell box takes {:.2} times as long (goal: below 2)",
        tiny.min() / normal.min()
    );
    Ok(())
}

/// Prints paths per second through the largest mesh in each precision.
fn precisions(waves: &str, of: &dyn Fn(u32, &str) -> Result<Stage, String>) -> Result<(), String> {
    let with = |precision: Precision| {
        let film = format!("resolution = (256, 256), precision = \"{}\"", precision.word());
        of(SIDE, &waves.replace("resolution = (256, 256)", &film))
    };
    let [a, b, c] = Precision::ALL;
    let stages = [with(a)?, with(b)?, with(c)?];
    let [a, b, c] = &stages;
    let rates = rates([(a, None), (b, None), (c, None)]);
    let of_each = Precision::ALL.iter().zip(&rates).map(|(precision, seconds)| {
        let rate = f64::from(PIXELS * SPP) / 1e6 / seconds.min();
        format!("{} {rate:.3}", precision.word())
    });
    println!("  2 M triangles: {}", of_each.collect::<Vec<_>>().join(", "));
    Ok(())
}

/// Seconds of a picture, for each way.
fn rates<const N: usize>(ways: [(&Stage, Option<bool>); N]) -> [Series; N] {
    let mut seconds = [const { vec![] }; N];
    for _ in 0..ROUNDS {
        for ((stage, side_by_side), seconds) in ways.iter().zip(&mut seconds) {
            let options = Options {
                spp: Some(SPP),
                threads: NonZeroUsize::new(1),
                side_by_side: *side_by_side,
                ..Options::default()
            };
            let start = Instant::now();
            std::hint::black_box(render(stage, &options, &Control::default()));
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
    seconds.map(Series::from)
}
