//! `luxel compare`: whether two pictures differ by more than their noise.

mod blur;
mod flip;
mod judge;
mod map;
mod numbers;
mod pair;
mod student;
mod told;
#[cfg(test)]
mod trials;
mod verdict;
mod welch;

use std::path::{Path, PathBuf};

use crate::exit::{Exit, Failure};
use crate::interrupt::Guard;
use crate::output::Output;
use crate::picture::{self, Picture};
use crate::report;
pub(crate) use judge::share as share_of_error;
use numbers::Numbers;
use pair::Pair;
pub(crate) use student::two_sided;
use told::Told;
use verdict::{Limits, Verdict, Word};

/// Tell whether two pictures differ by more than their noise
///
/// Takes what `luxel render` writes: the means of pixels, their standard errors (SE.R …) and numbers
/// of samples (N). Welch's test of the whole picture and of tiles of 8 x 8 pixels says `different`
/// where chance alone would do so with a probability of alpha at most. Where no test does, it says
/// `same` if a bias of --bias of the mean would have been found with 95 % probability, else
/// `inconclusive`: take more samples. Pictures without standard errors are inconclusive unless every
/// bit is the same; their numbers are told. B is the reference. FLIP is what a person sees, at B's
/// exposure. docs/accuracy.md has the rules.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Exit codes: 0 same, 1 different (or a file is at fault), 2 usage, 3 inconclusive.

Examples:
  luxel compare new.exr reference.exr
  luxel compare new.exr reference.exr --bias 0.1% --picture where
  luxel compare new.exr reference.exr --json")]
pub(crate) struct Args {
    /// The picture
    a: PathBuf,
    /// What it is compared with
    b: PathBuf,
    /// Probability of calling two equal pictures different
    #[arg(long, value_name = "SHARE", default_value = "1%", value_parser = share)]
    alpha: f64,
    /// Relative bias of the whole picture that `same` is to exclude
    #[arg(long, value_name = "SHARE", default_value = "1%", value_parser = share)]
    bias: f64,
    /// Show where: OUT.png, and A − B with its standard errors as OUT.exr
    #[arg(long, value_name = "OUT")]
    picture: Option<PathBuf>,
    /// One JSON object on standard output
    #[arg(long)]
    json: bool,
}

/// FLIP holds a dozen numbers for each pixel.
const MOST_FLIPPED: usize = 1 << 24;

pub(crate) fn run(args: &Args) -> Result<Exit, Failure> {
    let output =
        args.picture.as_ref().map(|out| Output::choose(Some(out), None, out)).transpose()?;
    if let Some(output) = &output {
        for read in [&args.a, &args.b] {
            output.keep(read)?;
        }
    }
    let guard = Guard::of_files()?;
    let pair = Pair::new(Picture::open(&args.a)?, Picture::open(&args.b)?)?;
    let limits = Limits { alpha: args.alpha, bias: args.bias };
    let (numbers, judged) = (Numbers::of(&pair), judge::judge(&pair, limits.alpha));
    let verdict = Verdict::of(&pair, &numbers, &judged, limits);
    let flip = (pair.window.area() <= MOST_FLIPPED).then(|| flipped(&pair));
    let names = [&args.a, &args.b].map(|path| name(path));
    let told = Told { names, pair: &pair, numbers, flip, judged, limits, verdict };
    let mut text = if args.json { format!("{}\n", told.json()) } else { told.text() };
    if let Some(output) = &output {
        let _whole = guard.saving();
        picture::write_both(
            output,
            |to| map::write_exr(to, &pair, &told.judged),
            |to| map::write_png(to, &pair, &told.judged),
        )?;
        if !args.json {
            let legend = map::legend(&told.judged);
            let (exr, png) = (output.exr.display(), output.png.display());
            text.extend(["\n".into(), format!("wrote {exr} and {png}\n"), legend, "\n".into()]);
        }
    }
    report::out(&text)?;
    Ok(match told.verdict.word {
        Word::Same => Exit::Fine,
        Word::Different => Exit::Input,
        Word::Inconclusive => Exit::Incomplete,
    })
}

fn name(path: &Path) -> String {
    path.display().to_string()
}

/// FLIP of what a screen shows of them.
fn flipped(pair: &Pair) -> f64 {
    let settings = pair.b.settings();
    let scale = picture::scale(settings.exposure);
    let shown = |i: usize| -> Vec<glam::DVec3> {
        let linear = |value: pair::Value| {
            let shown = picture::show(value.rgb * scale, settings.display);
            // As the PNG shows what is not a number: black.
            let decoded = shown.to_array().map(|x| luxel_sdk::color::srgb_decode(x.max(0.0)));
            glam::DVec3::from(decoded)
        };
        pair.pixels().map(|pixel| linear(pixel[i])).collect()
    };
    flip::flip(&shown(1), &shown(0), pair.window.size.x as usize)
}

/// A share of one, as `0.01` or `1%`.
fn share(text: &str) -> Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 0.01));
    let share = number.trim().parse().map(|x: f64| x * unit);
    let wrong = || "expected a share between 0 and 1, as in 0.01 or 1%".to_owned();
    share.ok().filter(|x| *x > 0.0 && *x < 1.0).ok_or_else(wrong)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_read_as_numbers_or_hundredths() {
        assert_eq!(share("0.25"), Ok(0.25));
        assert_eq!(share("25%"), Ok(0.25));
        assert_eq!(share("25 %"), Ok(0.25));
        for bad in ["0", "1", "-1%", "100%", "nan", "inf", "", "%", "x"] {
            assert!(share(bad).is_err(), "{bad}");
        }
    }
}
