//! Pixel filters: nowhere negative, integrating to 1, and sampled as they say.

use luxel_sdk::kind::Filter;
use luxel_sdk::sampling::Rng;

use crate::cells::{Cells, Place, integrate};
use crate::report::Judge;
use crate::statistics::{Tally, chi_square};
use crate::subject::Subject;
use crate::sweep::Set;

/// Samples are cheap: with so many more of them, 4 % of one side's width show.
const MORE: u32 = 16;

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    for (set, mut rng) in subject.usual() {
        set.ask(|resolved| {
            let filter = resolved.filter();
            let radius = filter.radius();
            let sane = radius > 0.0 && radius.is_finite();
            judge.holds("radius is finite", sane, || set.label.clone());
            if sane {
                is_legal(filter, set, &mut rng, judge);
                follows(filter, set, &mut rng, subject.options.samples, judge);
            }
        });
    }
    subject.concurrent(judge, |resolved| {
        let (filter, mut rng) = (resolved.filter(), Rng::new(7));
        (0..200).flat_map(|_| filter.sample(rng.pair()).map(f32::to_bits)).collect()
    });
}

fn is_legal(filter: &dyn Filter, set: &Set, rng: &mut Rng, judge: &mut Judge) {
    let r = filter.radius();
    let ends = [0.0, 0.5f32.next_down(), 0.5, 1.0f32.next_down()];
    for i in 0..1000 {
        let u = if i < 16 { [ends[i % 4], ends[i / 4]] } else { rng.pair() };
        let at = filter.sample(u);
        let inside = at.iter().all(|x| x.abs() <= r);
        judge.holds("samples inside the radius", inside, || format!("{}: {u:?}", set.label));
        let offset = rng.pair().map(|u| (4.0 * u - 2.0) * r);
        let value = filter.eval(offset);
        judge.holds("finite and not negative", value >= 0.0 && value.is_finite(), || {
            format!("{}: {offset:?}: {value}", set.label)
        });
        let outside = offset.iter().any(|x| x.abs() > r);
        judge.holds("zero outside", !outside || value <= 0.0, || {
            format!("{}: {offset:?}: {value}", set.label)
        });
    }
}

/// Chi-square of offsets, and the integral.
#[expect(clippy::cast_possible_truncation, reason = "offsets are f32")]
fn follows(filter: &dyn Filter, set: &Set, rng: &mut Rng, n: u32, judge: &mut Judge) {
    let r = f64::from(filter.radius());
    let mut draw = || -> Place {
        let at = filter.sample(rng.pair()).map(|x| (0.5 * f64::from(x) / r + 0.5).clamp(0.0, 1.0));
        (0, at)
    };
    let training: Vec<Place> = (0..n / 2).map(|_| draw()).collect();
    let cells = Cells::new(1, &training, 40);
    let mut tallies = vec![Tally::default(); cells.leaves.len()];
    let n = MORE * n;
    for _ in 0..n {
        tallies[cells.leaf(draw())].found += 1.0;
    }
    let area = 4.0 * r * r;
    let density = |(_, at): Place| {
        let offset = at.map(|x| ((2.0 * x - 1.0) * r) as f32);
        [f64::from(filter.eval(offset)) * area, 0.0]
    };
    let (mut sum, mut error) = (0.0, 0.0);
    let leaves = tallies.len() as f64;
    for (cell, tally) in cells.leaves.iter().zip(&mut tallies) {
        let part = integrate(&density, *cell, 1e-4 / leaves, &mut 4000);
        tally.expected = part.value[0] * f64::from(n);
        tally.error = part.error[0] * f64::from(n);
        sum += part.value[0];
        error += part.error[0];
    }
    let off = ((sum - 1.0).abs() - error).max(0.0);
    // Tables of f32, integrated.
    judge.within("integrates to 1", off, 1e-4, || format!("{}: {sum}", set.label));
    judge.statistic("samples follow their pdf", chi_square(tallies), || set.label.clone());
}
