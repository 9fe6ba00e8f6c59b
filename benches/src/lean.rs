//! What the code of features costs scenes that need none of it: whole renders by this program and by those
//! that were built without that code, in turns, first one then the other first. Where code lies in memory
//! moves times by more than a feature does: each program is there many times, its code in another order.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::process::{Luxel, here, read, scratch};

const SIZE: u32 = 192;
const SPP: u32 = 16;

/// Scenes that need no medium, no open surface, no nested refraction, no motion, one light and no layer.
const SCENES: [(&str, &str); 3] = [
    ("cornell_rgb", "Cornell box, RGB"),
    ("glass_metal", "glass and metal"),
    ("cornell_spectral", "Cornell box, by wavelength"),
];

/// For counting: pixels along a side, and samples of two renders, whose difference is that of paths alone.
const COUNTED: (u32, [u32; 2]) = (64, [1, 16]);

/// What a program says of a scene that it has no code for.
const REFUSED: &str = "this program was built without";

/// Orders of a program, at least: four pairs of it beside itself.
const LEAST: usize = 8;

/// The directory of the programs with all code.
const WHOLE: &str = "none";

/// One program in several orders of its code.
struct Program {
    name: String,
    orders: Vec<Luxel>,
}

/// Prints for each program and scene the time of that with all code over its own, with the standard error
/// of that over all orders; first of half of the same orders over the other half.
///
/// # Errors
/// A program failed; its words. No such programs.
pub(crate) fn run(directory: Option<&Path>) -> Result<(), String> {
    const WANTED: &str = "--lean DIRECTORY: of programs that were built without some code \
                          (docs/performance.md says how)";
    let programs = directory.and_then(programs).ok_or(WANTED)?;
    let whole = programs.iter().find(|program| program.name == WHOLE).ok_or(WANTED)?;
    println!(
        "{SIZE} x {SIZE}, {SPP} spp, one thread, processor time of the whole process: mean ratio of \
         interleaved pairs, one for each of {} orders of the code, with its standard error; instructions of a \
         path, as callgrind counts them with AVX2",
        whole.orders.len()
    );
    println!(
        "| built | scene | with the code / without | ± | instructions | pictures |\n\
         |---|---|---|---|---|---|"
    );
    // What was not changed, then all together, then one feature after the other.
    let rank = |name: &str| [WHOLE, "lean"].iter().position(|it| *it == name).unwrap_or(2);
    let mut sorted: Vec<_> = programs.iter().collect();
    sorted.sort_by_key(|program| (rank(&program.name), &program.name));
    for program in sorted {
        let built = if program.name == WHOLE { "with all of it" } else { &program.name };
        for (scene, title) in SCENES {
            let scene = here().join("scenes").join(scene).with_extension("scene");
            match told(&scene, whole, program) {
                Ok(told) => println!("| {} | {title} | {told} |", built.replace('_', " ")),
                Err(words) if words.contains(REFUSED) => {}
                Err(words) => return Err(words),
            }
        }
    }
    Ok(())
}

/// What lies in a directory, each in its own directory, one file for each order.
fn programs(directory: &Path) -> Option<Vec<Program>> {
    let inside = |path: &Path| -> Option<Vec<PathBuf>> {
        let mut found: Vec<_> =
            fs::read_dir(path).ok()?.map(|it| Some(it.ok()?.path())).collect::<Option<_>>()?;
        found.sort();
        Some(found)
    };
    let one = |path: PathBuf| {
        let orders: Vec<_> = inside(&path)?.into_iter().map(|program| Luxel { program }).collect();
        let name = path.file_name()?.to_str()?.to_owned();
        (orders.len() >= LEAST).then_some(Program { name, orders })
    };
    Some(inside(directory)?.into_iter().filter_map(one).collect())
}

fn told(scene: &Path, with: &Program, without: &Program) -> Result<String, String> {
    let (mut logs, mut same) = (vec![], true);
    // A program beside itself: one half of its orders beside the other.
    let first = if with.name == without.name { with.orders.len() / 2 } else { 0 };
    for (i, (with, without)) in with.orders.iter().zip(&without.orders[first..]).enumerate() {
        let (own, other);
        if i % 2 == 0 {
            own = shot(with, scene)?;
            other = shot(without, scene)?;
        } else {
            other = shot(without, scene)?;
            own = shot(with, scene)?;
        }
        same &= own.1 == other.1;
        logs.push((own.0 / other.0).ln());
    }
    let (mean, error) = mean_and_error(&logs);
    let word = if same { "the same" } else { "others" };
    let counted = match [with, without].map(|program| instructions(program.orders.first()?, scene))
    {
        [Some(with), Some(without)] => format!("{:.3}", with / without),
        _ => "no valgrind".to_owned(),
    };
    Ok(format!("{:.3} | {error:.3} | {counted} | {word}", mean.exp()))
}

/// With the standard error of the mean.
fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / (n - 1.0) / n).sqrt())
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
