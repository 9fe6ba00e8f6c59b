//! Truths about whole pictures.

use glam::UVec2;
use luxel_core::film::{Film, Pixel, Rect};

use super::bench::Bench;
use super::list::{Case, Quantity, Region, cases};
use crate::exit::Failure;
use crate::verify::mean::luminance;
use crate::verify::row::{Measured, Row};

/// Side of a patch, pixels.
const PATCH: u32 = 8;

/// Tests the cases whose name begins so.
pub(super) fn test(only: &str, bench: &Bench<'_>, rows: &mut Vec<Row>) -> Result<(), Failure> {
    let mut last: Option<(Case, Film)> = None;
    for case in cases().into_iter().filter(|case| case.id.starts_with(only)) {
        // Several quantities of one picture need it once.
        let kept = last.take().filter(|(before, _)| {
            (&before.scene, &before.set, before.region) == (&case.scene, &case.set, case.region)
        });
        let film = match kept {
            Some((_, film)) => film,
            None => picture(&case, bench)?,
        };
        let (rel, abs) = case.tolerance;
        let settings = case.set.iter().map(|(n, v)| format!("{n}={v}")).collect::<Vec<_>>();
        let tolerance = abs.max(rel * case.expected.abs());
        let id = (&*case.id, &*settings.join(" "));
        let row = Row::new(id, case.expected, measure(&film, &case), tolerance);
        rows.push(row.without(film.bad_samples()));
        last = Some((case, film));
    }
    Ok(())
}

fn picture(case: &Case, bench: &Bench<'_>) -> Result<Film, Failure> {
    let crop = match case.region {
        Region::Patch(at) => Some(Rect::new(at - UVec2::splat(PATCH / 2), UVec2::splat(PATCH))),
        _ => None,
    };
    bench.film(&case.scene, &case.set, crop)
}

/// The value and its standard error. All truths here are grey: channels rise and fall together.
fn measure(film: &Film, case: &Case) -> Measured {
    let (of, factor): (fn(&Pixel) -> f64, f64) = match case.quantity {
        Quantity::Luminance(factor) => (|pixel| luminance(pixel.mean), factor),
        Quantity::Variance => (|pixel| pixel.variance().y, 1.0),
    };
    let Measured { value, error } = if case.region == Region::Whole {
        let (mean, error) = film.mean();
        Measured { value: luminance(mean), error: luminance(error) }
    } else {
        spread(film.pixels().map(|(_, pixel)| of(pixel)))
    };
    Measured { value: value * factor, error: error * factor }
}

/// Mean and standard error of independent values with the same expectation.
pub(super) fn spread(values: impl Iterator<Item = f64>) -> Measured {
    let values: Vec<f64> = values.collect();
    let n = values.len() as f64;
    let value = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x - value) * (x - value)).sum();
    Measured { value, error: (squares / (n - 1.0) / n).sqrt() }
}
