//! What rays in turns, and numbers too small to be normal, do to whole pictures.

use std::num::NonZeroUsize;
use std::time::Instant;

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
/// Vertices along each side of the mesh: 2,093,058 triangles.
const SIDE: u32 = 1024;

/// Prints paths per second of one thread.
///
/// # Errors
/// A scene does not build.
pub(crate) fn run() -> Result<(), String> {
    let cornell = include_str!("../scenes/cornell_rgb.scene").replace("(512, 512)", "(256, 256)");
    let waves = include_str!("../scenes/waves.scene");
    let files = MemoryFiles::default().with("waves.ply", grid(SIDE).as_slice());
    let registry = linked();
    let box_of = |text: &str| stage_of(&registry, text);
    let stages = [
        ("Cornell box", box_of(&cornell)?),
        ("2 M triangles", stage_with(&registry, files, waves)?),
    ];
    println!("rays of whole pictures, one thread, Mpaths/s: best of {ROUNDS} rounds, interleaved");
    println!(
        "  {:14}{:>12}{:>12}{:>12}{:>10}",
        "", "one by one", "in turns", "as chosen", "spread"
    );
    let paths = f64::from(PIXELS * SPP) / 1e6;
    for (name, stage) in &stages {
        let [single, turns, chosen] =
            rates([(stage, Some(false)), (stage, Some(true)), (stage, None)]);
        let spread = single.spread().max(turns.spread()).max(chosen.spread());
        let [single, turns, chosen] = [single, turns, chosen].map(|seconds| paths / seconds.min());
        println!("  {name:14}{single:12.3}{turns:12.3}{chosen:12.3}{spread:8.1} %");
    }
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

/// Seconds of a picture, for each way.
fn rates<const N: usize>(ways: [(&Stage, Option<bool>); N]) -> [Series; N] {
    let mut seconds = [const { vec![] }; N];
    for _ in 0..ROUNDS {
        for ((stage, turns), seconds) in ways.iter().zip(&mut seconds) {
            let options = Options {
                spp: Some(SPP),
                threads: NonZeroUsize::new(1),
                turns: *turns,
                ..Options::default()
            };
            let start = Instant::now();
            std::hint::black_box(render(stage, &options, &Control::default()));
            seconds.push(start.elapsed().as_secs_f64());
        }
    }
    seconds.map(Series::from)
}
