//! A closed furnace near and far, tiny and huge, beside Mitsuba.

use std::path::Path;
use std::process::Command;

use luxel_core::files::MemoryFiles;
use luxel_core::render::{Control, Options, render};
use luxel_core::stage;
use luxel_lang::Settings;
use serde_json::Value;

use super::peers::minus;
use super::{Form, told};
use crate::process::{here, read, scratch};
use crate::scene::linked;

/// The scene, below the project's folder.
const SCENE: &str = "cli/src/verify/truths/furnace_closed.scene";
/// What every place of it shows.
const TRUTH: f64 = 2.0;

/// Head, and what the scene and Mitsuba's script call the distance from the origin and the size.
type Cell = (&'static str, &'static str, &'static str);

const FAR: [Cell; 6] = [
    ("0", "0 m", "0 1"),
    ("1e3", "1e3 m", "1000 1"),
    ("1e4", "1e4 m", "10000 1"),
    ("1e5", "1e5 m", "100000 1"),
    ("1e6", "1e6 m", "1e+06 1"),
    ("1e7", "1e7 m", "1e+07 1"),
];
const SIZES: [Cell; 7] = [
    ("1e-9", "1e-9 m", "0 1e-09"),
    ("1e-6", "1e-6 m", "0 1e-06"),
    ("1e-4", "1e-4 m", "0 0.0001"),
    ("1e-3", "1e-3 m", "0 0.001"),
    ("1e3", "1e3 m", "0 1000"),
    ("1e6", "1e6 m", "0 1e+06"),
    ("1e9", "1e9 m", "0 1e+09"),
];

/// Name, form and precision.
const OURS: [(&str, &str, &str); 4] = [
    ("Luxel: sphere", "sphere", "standard"),
    ("Luxel: mesh", "mesh", "standard"),
    ("Luxel: mesh with `precision = fast`", "mesh", "fast"),
    ("Luxel: mesh with `precision = exact`", "mesh", "exact"),
];

/// Name and form.
const THEIRS: [(&str, &str); 2] = [("sphere", "sphere"), ("mesh", "mesh")];

/// Two tables of the error of the mean: over the distance from the origin, and over the size.
///
/// # Errors
/// A scene that does not build; the script's words.
pub(super) fn tables(root: &Path, python: Option<&Path>, form: Form) -> Result<String, String> {
    // Their errors are seen without as many.
    let (spp, of_peer) = (form.pick(16_384, 16), form.pick(1024, 16));
    let found = python.map(|python| peer(python, of_peer)).transpose()?;
    let mut most = 0.0;
    let mut table = |corner: &str, param: &str, cells: &[Cell]| {
        let heads: Vec<&str> = cells.iter().map(|(head, ..)| *head).collect();
        let mut rows = vec![
            format!("| {corner} | {} |", heads.join(" | ")),
            "|---".repeat(heads.len() + 1) + "|",
        ];
        for (name, form, tight) in OURS {
            let mut own = vec![];
            for (_, value, _) in cells {
                let (mean, error) = inside(root, (form, tight), (param, value), spp)?;
                most = f64::max(most, error / TRUTH);
                own.push(off(mean));
            }
            rows.push(format!("| {name} | {} |", own.join(" | ")));
        }
        for (name, form) in found.iter().flat_map(|_| THEIRS) {
            let of = |(_, _, key): &Cell| found.as_ref()?[form][*key].as_f64();
            let told = |cell| of(cell).map_or_else(|| "no picture".to_owned(), off);
            let cells: Vec<String> = cells.iter().map(told).collect();
            rows.push(format!("| Mitsuba: {name} | {} |", cells.join(" | ")));
        }
        Ok::<_, String>(rows.join("\n"))
    };
    let far = table("metres from the origin, radius 1 m", "away", &FAR)?;
    let sizes = table("size, metres", "size", &SIZES)?;
    let peer = found.as_ref().and_then(|found| found["program"].as_str()).unwrap_or("no Mitsuba");
    Ok(format!(
        "{spp} samples of each of 64 pixels, Mitsuba's {of_peer}, light looked for at every corner; standard errors of \
         Luxel's means at most {:.2} %; {peer}.\n\n{far}\n\n{sizes}",
        most * 100.0
    ))
}

/// Mean over the picture and its standard error; a parameter has that value.
fn inside(
    root: &Path,
    (form, tight): (&str, &str),
    (param, value): (&str, &str),
    spp: u32,
) -> Result<(f64, f64), String> {
    let text = read(&root.join(SCENE))?;
    let files = MemoryFiles::default().with("a.scene", text);
    let set = [
        ("form", format!("\"{form}\"")),
        ("tight", format!("\"{tight}\"")),
        ("depth", "64".to_owned()),
        ("roulette", "3".to_owned()),
        ("lights", "true".to_owned()),
        (param, value.to_owned()),
    ];
    let set = set.map(|(name, value)| (name.to_owned(), value)).to_vec();
    let settings = Settings { set, ..Settings::default() };
    let registry = linked();
    let loaded = luxel_lang::load(Path::new("a.scene"), &files, &registry, &settings);
    let scene = loaded.scene.ok_or_else(|| format!("{:?}", loaded.diagnostics))?;
    let built = stage::build(&scene, &registry, &files, None);
    let stage = built.map_err(|found| format!("{found:?}"))?.stage;
    let options = Options { spp: Some(spp), ..Options::default() };
    let (mean, error) = render(&stage, &options, &Control::default()).0.mean();
    Ok((mean.y, error.y))
}

/// What the script found.
fn peer(python: &Path, spp: u32) -> Result<Value, String> {
    let json = scratch()?.join("furnace.json");
    let mut command = Command::new(python);
    command.arg(here().join("mitsuba_furnace.py")).arg("--json").arg(&json);
    told(command.arg("--spp").arg(spp.to_string()))?;
    serde_json::from_slice(&read(&json)?).map_err(|error| error.to_string())
}

/// How far a mean is off, in hundredths of a per cent.
fn off(mean: f64) -> String {
    let parts = ((mean / TRUTH - 1.0) * 1e4).round();
    // Nothing has no sign.
    minus(&format!("{:+.2} %", parts / 100.0 + 0.0))
}
