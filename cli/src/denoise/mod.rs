//! `luxel denoise`: a smoother picture beside the measured one.

mod guide;
mod nlm;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use glam::Vec3;
use luxel_sdk::color::RgbSpace;
use serde_json::{Value, json};

use crate::exit::{Exit, Failure};
use crate::output::Output;
use crate::picture::{self, Picture, Plane};
use crate::report;
use guide::Guide;
use nlm::{Noisy, Smooth};

/// Smooth the noise of a finished picture into another one
///
/// Each pixel becomes the mean of those about it that differ by no more than their standard errors
/// explain, guided by albedo, normal and depth where the EXR has them. What was measured stays as it
/// is: the result is another pair of files. A denoised picture is an estimate with a bias that nobody
/// knows. Its EXR says so (`denoised` in the attribute `luxel`), and its channels SE.R … and N are
/// those of the measured picture; `luxel compare` gives no verdict on it. What is told of its error is
/// an estimate for the whole picture (Stein's, weights taken as fixed).
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Examples:
  luxel denoise cornell.exr
  luxel denoise cornell.exr -o smooth --json")]
pub(crate) struct Args {
    /// The picture, an EXR of `luxel render`
    file: PathBuf,
    /// Where the pictures go: OUT.exr and OUT.png [default: beside it, with -denoised in the name]
    #[arg(short, long = "output", value_name = "OUT")]
    output: Option<PathBuf>,
    /// One JSON object on standard output
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let stem = args.output.clone().unwrap_or_else(|| beside(&args.file));
    let output = Output::choose(Some(&stem), None, &stem)?;
    output.keep(&args.file)?;
    let picture = Picture::open(&args.file)?;
    refuse(&picture, &args.file)?;
    let noisy = noisy(&picture);
    let guides = noisy.guide.names();
    let smooth = nlm::smooth(&noisy);
    let [before, after] = estimates(&noisy, &smooth);
    let notes = notes(&picture, &guides).to_string();
    let rgb = |i: usize| Plane::Floats(smooth.iter().map(|smooth| smooth.rgb[i]).collect());
    let mut planes: Vec<(String, Plane)> =
        ["R", "G", "B"].into_iter().enumerate().map(|(i, name)| (name.into(), rgb(i))).collect();
    for (i, name) in ["SE.R", "SE.G", "SE.B"].into_iter().enumerate() {
        let values = picture.se.iter().skip(i).step_by(3).copied().collect();
        planes.push((name.into(), Plane::Floats(values)));
    }
    planes.push(("N".into(), Plane::Counts(picture.n.clone())));
    planes.extend(picture.others.iter().cloned());
    let place = (picture.size, picture.window);
    let settings = picture.settings();
    let scale = picture::scale(settings.exposure);
    let shown = smooth.iter().map(|s| picture::show(s.rgb.as_dvec3() * scale, settings.display));
    picture::write_both(
        &output,
        |to| picture::write_planes(to, place, planes, &notes),
        |to| picture::write_signal(to, picture.window.size, shown),
    )?;
    report::out(&if args.json {
        let told = json!({
            "exr": output.exr,
            "png": output.png,
            "guides": guides,
            "estimated_rel_mse": { "before": before, "after": after },
        });
        format!("{told}\n")
    } else {
        let by = if guides.is_empty() { "its noise alone".into() } else { guides.join(", ") };
        format!(
            "wrote {} and {}, guided by {by}\n\
             estimated relMSE: {before:.2e} before, {after:.2e} after\n\
             standard errors in the EXR are those of the measured picture\n",
            output.exr.display(),
            output.png.display(),
        )
    })?;
    Ok(Exit::Fine)
}

/// `cornell-denoised` for `cornell.exr`.
fn beside(file: &Path) -> PathBuf {
    let mut name: OsString = file.file_stem().unwrap_or_default().to_owned();
    name.push("-denoised");
    file.with_file_name(name)
}

fn refuse(picture: &Picture, file: &Path) -> Result<(), Failure> {
    let wrong = |why: &str| {
        Err(Failure::new(Exit::Input, format!("cannot denoise {}: {why}", file.display())))
    };
    if picture.is_denoised() {
        return wrong("it is denoised already");
    }
    if picture.se.is_empty() || picture.n.is_empty() {
        return wrong("it does not say how wrong it is (SE.R, SE.G, SE.B and N)");
    }
    Ok(())
}

fn noisy(picture: &Picture) -> Noisy {
    let three = |plane: &[f32]| plane.chunks_exact(3).map(Vec3::from_slice).collect::<Vec<_>>();
    let (rgb, se) = (three(&picture.rgb), three(&picture.se));
    let valid = rgb.iter().zip(&se).map(|(rgb, se)| rgb.is_finite() && se.is_finite()).collect();
    let variance = se.iter().map(|se| *se * *se).collect();
    let width = picture.window.size.x as usize;
    Noisy { width, rgb, variance, valid, guide: Guide::of(picture) }
}

/// Stein's estimate of the mean squared error relative to luminance, before and after.
///
/// # Source
/// Stein 1981, eq. 2.10 as for linear filters: squared change, less variance, and twice the variance
/// times the pixel's share in its own mean. Weights depend on values a little, which is left out.
fn estimates(noisy: &Noisy, smooth: &[Smooth]) -> [f64; 2] {
    let weights = RgbSpace::LinearSrgb.luminance_weights();
    let luminance = |s: &Smooth| weights.dot(s.rgb.as_dvec3()).max(0.0);
    let pixels = || smooth.iter().enumerate().filter(|(i, _)| noisy.valid[*i]);
    let n = f64::max(pixels().count() as f64, 1.0);
    let floor = 0.01 * pixels().map(|(_, s)| luminance(s)).sum::<f64>() / n;
    let mut sums = [0.0; 2];
    for (i, s) in pixels() {
        let scale = luminance(s).max(floor).max(f64::MIN_POSITIVE).powi(2) * 3.0 * n;
        let change = (s.rgb - noisy.rgb[i]).as_dvec3().length_squared();
        let variance = noisy.variance[i].as_dvec3().element_sum();
        sums[0] += variance / scale;
        sums[1] += (change - variance + 2.0 * f64::from(s.own) * variance) / scale;
    }
    sums
}

/// What the EXR says about itself: all that the measured one did, and by what it was changed.
fn notes(picture: &Picture, guides: &[&str]) -> Value {
    let mut notes = if picture.notes.is_object() { picture.notes.clone() } else { json!({}) };
    notes["denoised"] = json!(true);
    notes["denoised_by"] = json!({
        "luxel": env!("CARGO_PKG_VERSION"),
        "filter": "non-local means",
        "guides": guides,
        "standard_errors": "of the measured picture",
    });
    notes
}

#[cfg(test)]
mod tests {
    use glam::UVec2;
    use luxel_core::film::Rect;
    use luxel_sdk::sampling::Rng;

    use super::*;

    /// Grey with noise of a standard error of 0.1.
    fn grey() -> Picture {
        let size = UVec2::splat(40);
        let mut rng = Rng::new(5);
        let mut normal = || (0..12).map(|_| rng.f32()).sum::<f32>() - 6.0;
        let rgb: Vec<f32> = (0..4800).map(|_| 1.0 + 0.1 * normal()).collect();
        Picture {
            size,
            window: Rect::new(UVec2::ZERO, size),
            se: vec![0.1; rgb.len()],
            n: vec![16; 1600],
            rgb,
            notes: json!({ "seed": 3 }),
            others: vec![],
        }
    }

    #[test]
    fn the_estimate_of_the_error_is_near_the_error() {
        let noisy = noisy(&grey());
        let smooth = nlm::smooth(&noisy);
        let squares = smooth.iter().map(|s| (s.rgb - Vec3::ONE).as_dvec3().length_squared());
        let truth = squares.sum::<f64>() / 4800.0;
        let [before, after] = estimates(&noisy, &smooth);
        assert!((before / 0.01 - 1.0).abs() < 0.05, "{before}");
        // Its standard error is that of the mean of 4800 squares of noise: 0.01·√(2/4800).
        assert!((after - truth).abs() < 4.0 * 0.01 * (2.0 / 4800.0_f64).sqrt(), "{after} {truth}");
        assert!(after < before / 5.0);
    }

    #[test]
    fn a_denoised_picture_says_so_and_is_not_denoised_again() {
        let mut picture = grey();
        let told = notes(&picture, &["depth"]);
        assert_eq!((&told["denoised"], &told["seed"]), (&json!(true), &json!(3)));
        assert_eq!(told["denoised_by"]["guides"], json!(["depth"]));
        let why = |picture: &Picture| refuse(picture, Path::new("a.exr")).unwrap_err().message;
        picture.notes = told;
        assert!(why(&picture).contains("a.exr: it is denoised already"));
        (picture.notes, picture.se) = (Value::Null, vec![]);
        assert!(why(&picture).contains("does not say how wrong it is"));
    }

    #[test]
    fn the_result_stands_beside_with_another_name() {
        assert_eq!(beside(Path::new("out/a.b.exr")), Path::new("out/a.b-denoised"));
    }
}
