//! What the code of features costs scenes that need none of it: whole renders by this program and by one
//! that was built without that code, in turns, first one then the other first.

use std::path::Path;

use crate::process::{Luxel, here, read, scratch};
use crate::series::Series;

/// Pairs of renders; the first is not counted.
const PAIRS: usize = 25;
const SIZE: u32 = 192;
const SPP: u32 = 32;

/// Scenes that need no medium, no open surface, no nested refraction and no motion.
const SCENES: [&str; 3] = ["cornell_rgb.scene", "glass_metal.scene", "cornell_spectral.scene"];

/// Prints for each scene the time of this program over that of the lean one.
///
/// # Errors
/// A program failed; its words. No lean one.
pub(crate) fn run(luxel: &Luxel, lean: Option<&Path>) -> Result<(), String> {
    let lean = lean.filter(|path| path.exists()).ok_or(
        "--lean PATH: a program of `cargo build --release -p luxel --features luxel-core/lean \
         --target-dir target/lean`",
    )?;
    let lean = Luxel { program: lean.to_owned() };
    println!(
        "{SIZE} x {SIZE}, {SPP} spp, one thread, processor time of the whole process, median of {} ratios of \
         interleaved pairs, with the middle half",
        PAIRS - 1
    );
    println!("| scene | with the code / without | middle half | pictures |\n|---|---|---|---|");
    for name in SCENES {
        println!("| {name} | {} |", told(&here().join("scenes").join(name), luxel, &lean)?);
    }
    Ok(())
}

fn told(scene: &Path, with: &Luxel, without: &Luxel) -> Result<String, String> {
    let (mut ratios, mut same) = (vec![], true);
    for pair in 0..PAIRS {
        let (own, other);
        if pair % 2 == 0 {
            own = shot(with, scene)?;
            other = shot(without, scene)?;
        } else {
            other = shot(without, scene)?;
            own = shot(with, scene)?;
        }
        same &= own.1 == other.1;
        if pair > 0 {
            ratios.push(own.0 / other.0);
        }
    }
    let ratios = Series::from(ratios);
    let [low, high] = [25, 75].map(|percent| ratios.percentile(percent));
    let word = if same { "the same" } else { "others" };
    Ok(format!("{:.3} | {low:.3} to {high:.3} | {word}", ratios.median()))
}

/// Processor time of a render, and every byte of what it measured.
fn shot(luxel: &Luxel, scene: &Path) -> Result<(f64, Vec<u8>), String> {
    let took = luxel.render_with(scene, SIZE, SPP, &["--threads=1"])?;
    Ok((took.cpu, read(&scratch()?.join("picture.exr"))?))
}
