//! How far denoised pictures of the Cornell box are from one of many samples.

use std::path::Path;

use serde_json::Value;

use super::{Form, answer, luxel, told};
use crate::process::{Luxel, scratch};

/// Samples of the pictures that are denoised.
const COUNTS: [u32; 2] = [16, 64];
/// Of the picture that they are compared with.
const SEED: u32 = 9;

/// # Errors
/// The program's words.
pub(super) fn table(program: &Luxel, root: &Path, form: Form) -> Result<String, String> {
    let folder = scratch()?;
    let scene = root.join("scenes/cornell.scene");
    let render = |name: &str, [spp, seed]: [u32; 2]| {
        let [spp, seed] = [format!("--spp={spp}"), format!("--seed={seed}")];
        let size = form.pick("--size=256x256", "--size=32x32");
        let words = ["render", "--quiet", size, &spp, &seed, "-o", name];
        told(luxel(program, &folder, &words).arg(&scene))
    };
    render("reference", [form.pick(320, 64), SEED])?;
    let mut rows = ["| | relMSE | MSE | FLIP |", "|---|---|---|---|"].map(str::to_owned).to_vec();
    for spp in COUNTS {
        render("noisy", [spp, 1])?;
        told(&mut luxel(program, &folder, &["denoise", "noisy.exr", "-o", "smooth"]))?;
        for (name, file) in
            [(&*format!("{spp} samples"), "noisy.exr"), ("the same, denoised", "smooth.exr")]
        {
            let words = ["compare", file, "reference.exr", "--json"];
            // Different or inconclusive are answers too.
            let found = answer(&mut luxel(program, &folder, &words), &[0, 1, 3])?;
            let found: Value = serde_json::from_str(&found).map_err(|error| error.to_string())?;
            let number = |field: &str| found[field].as_f64().unwrap_or(f64::NAN);
            let [relative, mse, flip] = ["rel_mse", "mse", "flip"].map(number);
            rows.push(format!("| {name} | {relative:.2e} | {mse:.2e} | {flip:.4} |"));
        }
    }
    Ok(rows.join("\n"))
}
