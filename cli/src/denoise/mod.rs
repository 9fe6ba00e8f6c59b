//! `luxel denoise`: a smoother picture beside the measured one.

mod guide;
mod nlm;

use std::ffi::OsString;
use std::path::{Path, PathBuf};

use glam::Vec3;
use serde_json::{Value, json};

use crate::exit::{Exit, Failure};
use crate::interrupt::Guard;
use crate::output::Output;
use crate::picture::{self, Picture, Plane};
use crate::report;
use guide::Guide;
use nlm::Noisy;

/// Smooth the noise of a finished picture into another one
///
/// Each pixel becomes the mean of those about it that differ by no more than their standard errors
/// explain, guided by albedo, normal and depth where the EXR has them. What was measured stays as it
/// is: the result is another pair of files. A denoised picture is an estimate with a bias that nobody
/// knows. Its EXR says so (`denoised` in the attribute `luxel`), and its channels SE.R … and N are
/// those of the measured picture; `luxel compare` gives no verdict on it.
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
    let guard = Guard::of_files()?;
    let picture = Picture::open(&args.file)?;
    refuse(&picture, &args.file)?;
    let noisy = noisy(&picture);
    let guides = noisy.guide.names();
    let smooth = nlm::smooth(&noisy);
    let notes = notes(&picture, &guides).to_string();
    let rgb = |i: usize| Plane::Floats(smooth.iter().map(|rgb| rgb[i]).collect());
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
    let shown = smooth.iter().map(|rgb| picture::show(rgb.as_dvec3() * scale, settings.display));
    let _whole = guard.saving();
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
        });
        format!("{told}\n")
    } else {
        let by = if guides.is_empty() { "its noise alone".into() } else { guides.join(", ") };
        format!(
            "wrote {} and {}, guided by {by}\n\
             how wrong it is, is not known: standard errors in the EXR are those of the measured picture\n",
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
    let variance: Vec<_> = se.iter().map(|se| *se * *se).collect();
    // The square of a finite error may be beyond all floats.
    let valid = rgb.iter().zip(&variance).map(|(rgb, v)| rgb.is_finite() && v.is_finite());
    let valid = valid.collect();
    let width = picture.window.size.x as usize;
    Noisy { width, rgb, variance, valid, guide: Guide::of(picture) }
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

    use super::*;

    /// Grey, with its errors.
    fn grey() -> Picture {
        let size = UVec2::splat(40);
        Picture {
            size,
            window: Rect::new(UVec2::ZERO, size),
            rgb: vec![1.0; 4800],
            se: vec![0.1; 4800],
            n: vec![16; 1600],
            notes: json!({ "seed": 3 }),
            others: vec![],
        }
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
    fn an_error_whose_square_has_no_float_spoils_no_pixel_beside() {
        let mut picture = grey();
        picture.se[3] = 1e20;
        let noisy = noisy(&picture);
        assert!(!noisy.valid[1] && noisy.valid[0]);
        let smooth = nlm::smooth(&noisy);
        assert!(smooth.iter().all(|rgb| rgb.abs_diff_eq(Vec3::ONE, 1e-5)), "{:?}", smooth[1]);
    }

    #[test]
    fn the_result_stands_beside_with_another_name() {
        assert_eq!(beside(Path::new("out/a.b.exr")), Path::new("out/a.b-denoised"));
    }
}
