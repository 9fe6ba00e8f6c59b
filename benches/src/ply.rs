//! Two million triangles: reading a binary PLY and building its tree.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::process::{Luxel, has_mitsuba, here, write};
use crate::series::Series;

/// How much is measured.
#[derive(Clone, Copy)]
pub(crate) struct Amount {
    /// Vertices along each side of the grid.
    pub(crate) side: u32,
    pub(crate) rounds: usize,
}

/// 2 · 1023² = 2,093,058 triangles.
pub(crate) const WHOLE: Amount = Amount { side: 1024, rounds: 5 };

const SCENE: &str = "scene 1
camera perspective { look = look_at(from = (0, 2, 3) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }
film rgb { resolution = (8, 8) }
light area { shape = shape sphere { center = (0, 5, 0) m, radius = 1 m }, radiance = 1 W/m^2/sr }
";

/// What a program took to read the mesh and to build its tree.
pub(crate) struct Loaded {
    pub(crate) program: &'static str,
    /// Medians: of the time above that without the mesh, and of the most memory, MiB.
    pub(crate) seconds: f64,
    pub(crate) memory: f64,
    /// Of the time, in per cent, where it is told.
    spread: Option<f64>,
}

/// Prints time and peak memory.
///
/// # Errors
/// As `measure`.
pub(crate) fn run(luxel: &Luxel, python: Option<&Path>) -> Result<(), String> {
    let n = 2 * (WHOLE.side - 1) * (WHOLE.side - 1);
    println!("binary PLY of {n} triangles, read and built (goals: 1 s, 300 MiB)");
    for Loaded { program, seconds, memory, spread } in measure(luxel, python, WHOLE)? {
        let spread = spread.map_or(String::new(), |spread| format!(" (spread {spread:.0} %)"));
        println!("  {program:11} {seconds:.2} s{spread}, peak {memory:.0} MiB");
    }
    Ok(())
}

/// Luxel, and Mitsuba's two variants where this Python has it.
///
/// # Errors
/// A program failed; its words.
pub(crate) fn measure(
    luxel: &Luxel,
    python: Option<&Path>,
    Amount { side, rounds }: Amount,
) -> Result<Vec<Loaded>, String> {
    let ply = write("read.ply", &grid(side))?;
    let empty = write("empty.scene", SCENE.as_bytes())?;
    let mesh = "shape mesh \"waves\" { file = \"read.ply\", unit = 1 m }\n";
    let full = write("read.scene", format!("{SCENE}{mesh}").as_bytes())?;
    let (mut seconds, mut memory) = (vec![], vec![]);
    for _ in 0..rounds {
        let (with, without) = (luxel.render(&full, 8, 1)?, luxel.render(&empty, 8, 1)?);
        seconds.push(with.seconds - without.seconds);
        memory.extend(with.megabytes);
    }
    let (seconds, memory) = (Series::from(seconds), Series::from(memory));
    let spread = Some(seconds.spread());
    let (seconds, memory) = (seconds.median(), memory.median());
    let mut found = vec![Loaded { program: "luxel", seconds, memory, spread }];
    if let Some(python) = python.filter(|python| has_mitsuba(python)) {
        found.extend(peers(python, &ply)?);
    }
    Ok(found)
}

/// Mitsuba's two variants, with Python's own memory.
fn peers(python: &Path, ply: &Path) -> Result<[Loaded; 2], String> {
    let script = here().join("load_ply.py");
    let output = Command::new(python).arg(script).arg(ply).output();
    let output = output.map_err(|error| format!("{}: {error}", python.display()))?;
    let told: Value = serde_json::from_slice(&output.stdout)
        .map_err(|_| format!("load_ply.py: {}", String::from_utf8_lossy(&output.stderr)))?;
    Ok(["scalar_rgb", "llvm_ad_rgb"].map(|program| {
        let number = |i: usize| told[program][i].as_f64().unwrap_or(f64::NAN);
        Loaded { program, seconds: number(0), memory: number(1), spread: None }
    }))
}

/// A wavy square of 2 m as binary PLY, with so many vertices along each side.
pub(crate) fn grid(side: u32) -> Vec<u8> {
    let n = 2 * (side - 1) * (side - 1);
    let header = format!(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n\
         property float y\nproperty float z\nelement face {n}\n\
         property list uchar int vertex_indices\nend_header\n",
        side * side
    );
    let mut bytes = header.into_bytes();
    for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
        let at = |k: u32| 2.0 * k as f32 / (side - 1) as f32 - 1.0;
        let (x, z) = (at(j), at(i));
        let y = 0.05 * (23.0 * x).sin() * (17.0 * z).cos();
        bytes.extend([x, y, z].into_iter().flat_map(f32::to_le_bytes));
    }
    for (i, j) in (1..side).flat_map(|i| (1..side).map(move |j| (i, j))) {
        let corner = i * side + j;
        let (left, above) = (corner - 1, corner - side);
        for face in [[above - 1, left, corner], [above - 1, corner, above]] {
            bytes.push(3);
            bytes.extend(face.into_iter().flat_map(u32::to_le_bytes));
        }
    }
    bytes
}
