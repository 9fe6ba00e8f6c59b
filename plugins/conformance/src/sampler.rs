//! Samplers: numbers in [0, 1), even over indices, dimensions and streams, and the same each time.

use std::collections::BTreeSet;

use luxel_sdk::kind::{SampleAt, Sampler};
use luxel_sdk::sampling::hash32;

use crate::report::Judge;
use crate::statistics::{Tally, chi_square};
use crate::subject::Subject;
use crate::sweep::Set;

/// Cells along each side.
const SIDE: usize = 8;

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    for (set, _) in subject.usual() {
        set.ask(|resolved| {
            let sampler = resolved.sampler();
            tells_its_settings(sampler, set, judge);
            is_even(sampler, set, subject.options.samples, judge);
            fills_cells_always_or_never(sampler, set, judge);
            is_fine(sampler, set, subject.options.samples, judge);
        });
    }
    subject.concurrent(judge, |resolved| {
        let sampler = resolved.sampler();
        let at = |i: u32| SampleAt { stream: i / 16, index: i % 16, dimension: i % 5 };
        (0..200).flat_map(|i| sampler.get_2d(at(i)).map(f32::to_bits)).collect()
    });
}

fn tells_its_settings(sampler: &dyn Sampler, set: &Set, judge: &mut Judge) {
    let known = [("samples", sampler.samples()), ("seed", sampler.seed())];
    for (name, found) in known {
        if let Some(given) = set.number(name) {
            let off = (f64::from(found) - given).abs();
            // A sampler may round the number of samples up to what it can spread.
            let rounded = name == "samples" && f64::from(found) >= given;
            judge.holds("settings are told", off < 0.5 || rounded, || {
                format!("{}: {name} is {found}", set.label)
            });
        }
    }
    judge.holds("at least one sample", sampler.samples() > 0, || set.label.clone());
}

/// A way through the numbers: the k-th place.
type Walk = (&'static str, fn(u32) -> SampleAt);

/// Along indices, dimensions, streams, and streams as the host makes them.
const WALKS: [Walk; 5] = [
    ("even over indices", |k| SampleAt { stream: 7, index: k, dimension: 4 }),
    ("even over dimensions", |k| SampleAt { stream: 7, index: 3, dimension: 2 * k }),
    ("even over streams", |k| SampleAt { stream: hash32(k), index: 0, dimension: 0 }),
    ("even over near streams", |k| SampleAt { stream: k, index: 1, dimension: 2 }),
    ("even over pixels", |k| SampleAt { stream: hash32(k / 16), index: k % 16, dimension: 6 }),
];

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, SIDE)")]
fn cell(u: f32) -> usize {
    ((u * SIDE as f32) as usize).min(SIDE - 1)
}

fn is_even(sampler: &dyn Sampler, set: &Set, n: u32, judge: &mut Judge) {
    let expected = f64::from(n) / (SIDE * SIDE) as f64;
    let mut test = |check, pairs: &mut dyn Iterator<Item = [f32; 2]>| {
        let mut cells = [Tally { expected, ..Tally::default() }; SIDE * SIDE];
        for [x, y] in pairs {
            cells[cell(x) * SIDE + cell(y)].found += 1.0;
        }
        judge.statistic(check, chi_square(cells), || set.label.clone());
    };
    let next = |at: SampleAt, by: u32| SampleAt { dimension: at.dimension + by, ..at };
    for (check, at) in WALKS {
        test(check, &mut (0..n).map(|k| sampler.get_2d(at(k))));
        // One number and the next, and pairs of neighbouring pairs.
        test(check, &mut (0..n).map(|k| [sampler.get_1d(at(k)), sampler.get_1d(next(at(k), 1))]));
        test(
            check,
            &mut (0..n).map(|k| [sampler.get_2d(at(k))[0], sampler.get_2d(next(at(k), 2))[0]]),
        );
        test(
            check,
            &mut (0..n).map(|k| [sampler.get_2d(at(k))[1], sampler.get_1d(next(at(k), 2))]),
        );
    }
    // What a path takes one after the other, and what it takes many dimensions later.
    let (_, at) = WALKS[0];
    for apart in [1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 32, 64] {
        let later = |k| next(at(k), apart);
        let one = &mut (0..n).map(|k| [sampler.get_1d(at(k)), sampler.get_2d(later(k))[0]]);
        test("dimensions are independent", one);
        let other = &mut (0..n).map(|k| [sampler.get_1d(at(k)), sampler.get_2d(later(k))[1]]);
        test("dimensions are independent", other);
        if apart > 1 {
            let second = |k| [sampler.get_2d(at(k))[1], sampler.get_2d(later(k))[0]];
            test("dimensions are independent", &mut (0..n).map(second));
        }
    }
    for k in 0..2000 {
        for (_, at) in WALKS {
            let (one, two) = (sampler.get_1d(at(k)), sampler.get_2d(at(k)));
            let inside = two.iter().chain([&one]).all(|u| (0.0..1.0).contains(u));
            judge.holds("numbers in [0, 1)", inside, || format!("{}: {:?}", set.label, at(k)));
            let again = sampler.get_2d(at(k)).map(f32::to_bits) == two.map(f32::to_bits);
            judge.holds("the same each time", again, || format!("{}: {:?}", set.label, at(k)));
            let pairs = [two, sampler.get_2d(next(at(k), 2))];
            let after = [sampler.get_2d(next(at(k), 1)), sampler.get_2d(next(at(k), 3))];
            let at_once = sampler.get_2d_pair(at(k)) == pairs
                && sampler.get_1d_and_2d_pair(at(k)) == (one, after);
            judge.holds("several numbers at once", at_once, || {
                format!("{}: {:?}", set.label, at(k))
            });
        }
    }
}

/// Numbers that take many values: along the best of the walks every second is new, as they are with
/// 15 bits. Fewer show in a picture, as steps in the shadow of a small lamp.
fn is_fine(sampler: &dyn Sampler, set: &Set, n: u32, judge: &mut Judge) {
    let most = |lane: usize| {
        let different = |at: fn(u32) -> SampleAt| {
            let found = (0..n).map(|k| sampler.get_2d(at(k))[lane].to_bits());
            found.collect::<BTreeSet<u32>>().len()
        };
        WALKS.iter().map(|(_, at)| different(*at)).max().unwrap_or(0)
    };
    for lane in 0..2 {
        let found = most(lane);
        judge.holds("numbers differ", 2 * found >= n as usize, || {
            format!("{}: {found} different numbers of {n}", set.label)
        });
    }
}

/// A sampler that puts its first 16 points into 16 elementary intervals does so in every dimension
/// of every pixel; independent numbers never do (16!/16¹⁶ is 1e-6).
fn fills_cells_always_or_never(sampler: &dyn Sampler, set: &Set, judge: &mut Judge) {
    let (mut full, mut all) = ([0u32; 5], 0u32);
    for stream in 0..16 {
        for dimension in 0..16 {
            all += 1;
            let points: Vec<[f32; 2]> = (0..16)
                .map(|index| sampler.get_2d(SampleAt { stream: hash32(stream), index, dimension }))
                .collect();
            for (shape, full) in full.iter_mut().enumerate() {
                *full += u32::from(fills(&points, shape));
            }
        }
    }
    for (shape, full) in full.into_iter().enumerate() {
        judge.holds("elementary intervals", full == all || full < 2, || {
            format!("{}: {full} of {all} fill 2^{shape} by 2^{} cells", set.label, 4 - shape)
        });
    }
}

/// Whether 16 points lie one in each of 2^`shape` × 2^(4 − `shape`) cells.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "u is in [0, 1)")]
fn fills(points: &[[f32; 2]], shape: usize) -> bool {
    let (columns, rows) = (1u32 << shape, 16u32 >> shape);
    let taken = points.iter().fold(0u32, |taken, [x, y]| {
        let (i, j) = ((x * columns as f32) as u32, (y * rows as f32) as u32);
        taken | 1 << ((i * rows + j) & 15)
    });
    taken == 0xffff
}
