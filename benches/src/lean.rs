//! What the code of features costs scenes that need none of it: whole renders by this program and by those
//! that were built without that code, in turns, first one then the other first.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::process::{Luxel, here, read, scratch};
use crate::series::Series;

/// Pairs of renders; the first is not counted.
const PAIRS: usize = 17;
const SIZE: u32 = 192;
const SPP: u32 = 16;

/// Scenes that need no medium, no open surface, no nested refraction, no motion, one light and no layer.
const SCENES: [&str; 3] = ["cornell_rgb.scene", "glass_metal.scene", "cornell_spectral.scene"];

/// For counting: pixels along a side, and samples of two renders, whose difference is that of paths alone.
const COUNTED: (u32, [u32; 2]) = (64, [1, 16]);

/// What a program says of a scene that it has no code for.
const REFUSED: &str = "this program was built without";

/// Prints for each program and scene the time of this program over that of the lean one; first over its
/// own, to show the machine's noise.
///
/// # Errors
/// A program failed; its words. No lean ones.
pub(crate) fn run(luxel: &Luxel, lean: Option<&Path>) -> Result<(), String> {
    const WANTED: &str = "--lean DIRECTORY: of programs that were built without some code \
                          (docs/performance.md says how)";
    let mut programs = lean.and_then(programs).filter(|found| !found.is_empty()).ok_or(WANTED)?;
    programs.insert(0, ("with all of it".to_owned(), luxel.program.clone()));
    println!(
        "{SIZE} x {SIZE}, {SPP} spp, one thread, processor time of the whole process, median of {} ratios of \
         interleaved pairs, with the middle half; instructions of a path, as callgrind counts them with AVX2",
        PAIRS - 1
    );
    println!(
        "| built | scene | with the code / without | middle half | instructions | pictures |\n\
         |---|---|---|---|---|---|"
    );
    for (built, program) in programs {
        let other = Luxel { program };
        for name in SCENES {
            let scene = here().join("scenes").join(name);
            match told(&scene, luxel, &other) {
                Ok(told) => println!("| {built} | {name} | {told} |"),
                Err(words) if words.contains(REFUSED) => {}
                Err(words) => return Err(words),
            }
        }
    }
    Ok(())
}

/// What lies in a directory, each with its name.
fn programs(directory: &Path) -> Option<Vec<(String, PathBuf)>> {
    let named = |path: PathBuf| Some((path.file_stem()?.to_str()?.replace('_', " "), path));
    let found = fs::read_dir(directory).ok()?;
    let mut found: Vec<_> = found.filter_map(|entry| named(entry.ok()?.path())).collect();
    found.sort();
    Some(found)
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
    let counted = match [with, without].map(|luxel| instructions(luxel, scene)) {
        [Some(with), Some(without)] => format!("{:.3}", with / without),
        _ => "no valgrind".to_owned(),
    };
    Ok(format!("{:.3} | {low:.3} to {high:.3} | {counted} | {word}", ratios.median()))
}

/// Instructions of a path, which depend neither on the machine's noise nor on where code lies in memory;
/// nothing without valgrind.
fn instructions(luxel: &Luxel, scene: &Path) -> Option<f64> {
    let (side, spp) = COUNTED;
    let out = scratch().ok()?.join("counted");
    let count = |spp: u32| {
        let mut command = Command::new("valgrind");
        command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]).arg(&luxel.program);
        command.arg("render").arg(scene).args(["--quiet", "--threads=1", "-o"]).arg(&out);
        command.args([format!("--size={side}x{side}"), format!("--spp={spp}")]);
        let told = String::from_utf8(command.output().ok()?.stderr).ok()?;
        let (_, n) = told.lines().find_map(|line| line.split_once("Collected : "))?;
        n.trim().parse::<f64>().ok()
    };
    let [few, many] = spp.map(count);
    Some((many? - few?) / (f64::from(side * side) * f64::from(spp[1] - spp[0])))
}

/// Processor time of a render, and every byte of what it measured.
fn shot(luxel: &Luxel, scene: &Path) -> Result<(f64, Vec<u8>), String> {
    let took = luxel.render_with(scene, SIZE, SPP, &["--threads=1"])?;
    Ok((took.cpu, read(&scratch()?.join("picture.exr"))?))
}
