//! Whole renders: start, memory, and the comparison with Mitsuba.

use std::path::Path;
use std::process::Command;

use crate::ply::grid;
use crate::process::{Luxel, Took, has_mitsuba, here, write};
use crate::series::Series;

const TRIVIAL: &str = "scene 1
camera perspective { look = look_at(from = (0, 0, 4) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }
film rgb { resolution = (64, 64) }
shape sphere { radius = 1 m, material = material diffuse {} }
light area { shape = shape sphere { center = (0, 5, 0) m, radius = 1 m }, radiance = 1 W/m^2/sr }
";

/// Starts that are timed.
pub(crate) const STARTS: usize = 20;

/// What starting the program takes.
pub(crate) struct Start {
    /// From its start to its end with a trivial picture on disk, milliseconds.
    pub(crate) ms: Series,
    /// Memory at most, megabytes.
    mb: Series,
}

/// Prints what starting the program takes.
///
/// # Errors
/// The program failed; its words.
pub(crate) fn cold(luxel: &Luxel) -> Result<(), String> {
    let Start { ms, mb } = start(luxel, STARTS)?;
    println!("start to a trivial 64 x 64 picture, whole process, {STARTS} runs (goal 20 ms)");
    println!("  min {:.1} ms, median {:.1} ms, peak {:.0} MiB", ms.min(), ms.median(), mb.median());
    Ok(())
}

/// Starts the program so many times.
///
/// # Errors
/// The program failed; its words.
pub(crate) fn start(luxel: &Luxel, times: usize) -> Result<Start, String> {
    let scene = write("trivial.scene", TRIVIAL.as_bytes())?;
    luxel.render(&scene, 64, 1)?;
    let (mut ms, mut mb) = (vec![], vec![]);
    for _ in 0..times {
        let took = luxel.render(&scene, 64, 1)?;
        ms.push(took.seconds * 1e3);
        mb.extend(took.megabytes);
    }
    Ok(Start { ms: Series::from(ms), mb: Series::from(mb) })
}

/// Prints the peak memory of the Cornell box and of a million placements.
///
/// # Errors
/// The program failed; its words.
pub(crate) fn memory(luxel: &Luxel) -> Result<(), String> {
    let peak = cornell_box(luxel)?.megabytes.unwrap_or(f64::NAN);
    println!("Cornell box 512 x 512, picture written: peak {peak:.1} MiB (goal 45)");
    placements(luxel)
}

/// What the Cornell box takes, 512 × 512, one sample per pixel.
///
/// # Errors
/// The program failed; its words.
pub(crate) fn cornell_box(luxel: &Luxel) -> Result<Took, String> {
    luxel.render(&here().join("scenes/cornell_rgb.scene"), 512, 1)
}

/// A million placements of one mesh: a row of a thousand, placed a thousand times.
const PLACEMENTS: &str = "scene 1
camera perspective { look = look_at(from = (0, 400, 1200) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 50 deg }
film rgb { resolution = (8, 8) }
light constant { radiance = 1 W/m^2/sr }
let square = shape mesh { file = \"square.ply\", unit = 1 m }
let row = group { for j in 0..1000 { place square { transform = move((0, 0, 2 * j - 999) * 1 m) } } }
for i in 0..1000 {
  place row { transform = [rotate((0, 1, 0), 7 deg * i), move((2 * i - 999, 0, 0) * 1 m)] }
}
";

/// Prints the peak memory of a million placements.
fn placements(luxel: &Luxel) -> Result<(), String> {
    write("square.ply", &grid(225))?;
    let scene = write("placements.scene", PLACEMENTS.as_bytes())?;
    let took = luxel.render(&scene, 256, 1)?;
    println!(
        "1,000,000 placements of a mesh of 100,352 triangles: {:.1} s, peak {:.0} MiB (goal 1024)",
        took.seconds,
        took.megabytes.unwrap_or(f64::NAN)
    );
    Ok(())
}

/// Runs the comparison with Mitsuba, where this Python has it; without, Luxel's speed alone.
///
/// # Errors
/// A program failed; its words.
pub(crate) fn cornell(luxel: &Luxel, python: Option<&Path>) -> Result<(), String> {
    let Some(python) = python.filter(|python| has_mitsuba(python)) else {
        println!("Mitsuba is not to be had (--python PATH of one that imports it): Luxel alone");
        return alone(luxel);
    };
    ["accuracy", "speed"].into_iter().try_for_each(|what| compare(luxel, python, &[what]))
}

/// Runs `compare.py` with these words.
///
/// # Errors
/// It does not start or fails.
pub(crate) fn compare(luxel: &Luxel, python: &Path, words: &[&str]) -> Result<(), String> {
    let mut command = Command::new(python);
    command.arg(here().join("compare.py")).args(words).arg("--luxel").arg(&luxel.program);
    let status = command.status().map_err(|e| format!("{}: {e}", python.display()))?;
    if status.success() { Ok(()) } else { Err(format!("compare.py {} failed", words.join(" "))) }
}

fn alone(luxel: &Luxel) -> Result<(), String> {
    for name in ["cornell_rgb", "cornell_spectral", "glass_metal"] {
        let scene = here().join(format!("scenes/{name}.scene"));
        let mut seconds = vec![];
        for _ in 0..5 {
            seconds.push(luxel.render(&scene, 512, 16)?.seconds);
        }
        let seconds = Series::from(seconds);
        let rate = 512.0 * 512.0 * 16.0 / 1e6 / seconds.median();
        println!("  {name:18} {rate:.2} Mpaths/s wall (spread {:.0} %)", seconds.spread());
    }
    Ok(())
}
