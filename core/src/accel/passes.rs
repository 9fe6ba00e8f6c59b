//! Passes over many primitives: a stride at a time, in parallel where there are many, left off when
//! the watch is cancelled. The same result for any number of threads.

use std::mem::take;

use rayon::prelude::*;

use super::partition::Prim;
use super::watch::{STRIDE, Watch};

/// Folds each stride with `one`, from `empty`, and joins what comes of them. What is left when the
/// watch is cancelled counts as empty.
pub(super) fn fold<T: Send, P: Sync>(
    items: &[P],
    watch: &Watch,
    empty: impl Fn() -> T + Sync + Send,
    one: impl Fn(T, &[P]) -> T + Sync + Send,
    join: impl Fn(T, T) -> T + Sync + Send,
) -> T {
    let stride = |items| if watch.is_cancelled() { empty() } else { one(empty(), items) };
    if items.len() <= STRIDE {
        return stride(items);
    }
    items.par_chunks(STRIDE).map(stride).reduce(&empty, join)
}

/// Moves what is on the left to the front; returns how many that are.
pub(super) fn partition(
    prims: &mut [Prim],
    watch: &Watch,
    is_left: impl Fn(&Prim) -> bool + Sync,
) -> usize {
    let sift = |prims: &mut [Prim]| {
        let mut first = 0;
        if watch.is_cancelled() {
            return first;
        }
        // Without a branch, which nothing could foresee.
        for i in 0..prims.len() {
            let left = is_left(&prims[i]);
            prims.swap(i, first);
            first += usize::from(left);
        }
        first
    };
    if prims.len() <= STRIDE {
        return sift(prims);
    }
    let lefts: Vec<usize> = prims.par_chunks_mut(STRIDE).map(sift).collect();
    let middle = lefts.iter().sum();
    exchange(prims, &lefts, middle, watch);
    middle
}

/// Every stride has its lefts in front: exchanges those that lie behind the middle of all for the
/// rights before it, of which there are as many.
fn exchange(prims: &mut [Prim], lefts: &[usize], middle: usize, watch: &Watch) {
    let n = prims.len();
    let (mut front, mut back) = prims.split_at_mut(middle);
    let (mut rights, mut strays) = (vec![], vec![]);
    for (i, left) in lefts.iter().enumerate() {
        let (start, end) = (i * STRIDE, n.min((i + 1) * STRIDE));
        let turn = start + left;
        let here = end.min(middle) - start.min(middle);
        let (run, rest) = take(&mut front).split_at_mut(here);
        front = rest;
        rights.push(&mut run[here.min(turn.saturating_sub(start))..]);
        let (run, rest) = take(&mut back).split_at_mut(end - start - here);
        back = rest;
        strays.push(&mut run[..turn.saturating_sub(start.max(middle)).min(end - start - here)]);
    }
    let (mut strays, mut pairs) = (strays.into_iter(), vec![]);
    let mut stray: &mut [Prim] = &mut [];
    for mut right in rights {
        while !right.is_empty() {
            while stray.is_empty() {
                stray = strays.next().expect("as many lie on the wrong side as on the other");
            }
            let both = right.len().min(stray.len());
            let (a, rest) = take(&mut right).split_at_mut(both);
            right = rest;
            let (b, rest) = take(&mut stray).split_at_mut(both);
            stray = rest;
            pairs.push((a, b));
        }
    }
    pairs.into_par_iter().for_each(|(a, b)| {
        if !watch.is_cancelled() {
            a.swap_with_slice(b);
        }
    });
}

/// Bits of a key that are told apart at once.
const DIGIT: u32 = 11;

/// Moves the half with the smaller centres along an axis to the front; returns how many that are.
pub(super) fn median(prims: &mut [Prim], axis: usize, watch: &Watch) -> usize {
    let middle = prims.len() / 2;
    if watch.is_cancelled() {
        return middle;
    }
    if prims.len() <= STRIDE {
        prims.select_nth_unstable_by(middle, |a, b| {
            let key = |p: &Prim| p.centre_along(axis);
            key(a).total_cmp(&key(b)).then(a.index().cmp(&b.index()))
        });
        return middle;
    }
    // A radix select; of equal ones any may come first, in an order that threads do not change.
    let key = |p: &Prim| ordered(p.centre_along(axis));
    let (mut nth, mut known) = (middle, 0u64);
    for shift in [2 * DIGIT, DIGIT, 0] {
        let digit = |p: &Prim| {
            let key = key(p) >> shift;
            (key >> DIGIT == known).then_some((key & ((1 << DIGIT) - 1)) as usize)
        };
        let count = |mut counts: Vec<usize>, prims: &[Prim]| {
            prims.iter().filter_map(digit).for_each(|digit| counts[digit] += 1);
            counts
        };
        let join = |a: Vec<usize>, b: Vec<usize>| a.iter().zip(&b).map(|(a, b)| a + b).collect();
        let counts = fold(prims, watch, || vec![0; 1 << DIGIT], count, join);
        let mut found = 0;
        while found + 1 < counts.len() && nth >= counts[found] {
            nth -= counts[found];
            found += 1;
        }
        known = known << DIGIT | found as u64;
    }
    let below = partition(prims, watch, |p| key(p) < known);
    partition(&mut prims[below..], watch, |p| key(p) == known);
    middle
}

/// Maps finite numbers to integers of the same order, below 2³².
fn ordered(x: f32) -> u64 {
    let bits = (x + 0.0).to_bits();
    u64::from(if bits >> 31 == 0 { bits | 1 << 31 } else { !bits })
}

#[cfg(test)]
mod tests {
    use glam::Vec3A;

    use super::super::node::{Bounds, narrow};
    use super::super::soup::Rng;
    use super::*;

    fn prims(n: usize, rng: &mut Rng, distinct: f32) -> Vec<Prim> {
        let one = |i: usize| {
            let p = Vec3A::from((rng.point() * distinct).round() / distinct);
            Prim::new(Bounds { min: p, max: p }, narrow(i))
        };
        (0..n).map(one).collect()
    }

    /// Every number is there once.
    fn assert_whole(prims: &[Prim]) {
        let mut all: Vec<u32> = prims.iter().map(Prim::index).collect();
        all.sort_unstable();
        assert!(all.into_iter().eq(0..narrow(prims.len())));
    }

    #[test]
    fn a_partition_keeps_everything_and_puts_it_on_its_side() {
        let mut rng = Rng(91);
        for n in [1, 2, 1000, STRIDE + 1, 5 * STRIDE + 17, 8 * STRIDE] {
            for limit in [-2.0, -0.9, 0.0, 0.3, 2.0] {
                let mut all = prims(n, &mut rng, 1e6);
                let left = |p: &Prim| p.centre().x < limit;
                let expected = all.iter().filter(|p| left(p)).count();
                let middle = partition(&mut all, &Watch::default(), left);
                assert_eq!(middle, expected);
                assert!(all[..middle].iter().all(left) && !all[middle..].iter().any(left));
                assert_whole(&all);
            }
        }
    }

    #[test]
    fn a_median_halves_whatever_is_equal() {
        let mut rng = Rng(92);
        for distinct in [1e6, 3.0, 0.4] {
            for n in [2, 999, STRIDE + 1, 5 * STRIDE + 17] {
                let mut all = prims(n, &mut rng, distinct);
                let middle = median(&mut all, 1, &Watch::default());
                assert_eq!(middle, n / 2);
                let key = |p: &Prim| p.centre().y;
                let most = all[..middle].iter().map(key).fold(f32::MIN, f32::max);
                assert!(all[middle..].iter().all(|p| key(p) >= most));
                assert_whole(&all);
            }
        }
    }

    #[test]
    fn numbers_become_integers_of_the_same_order() {
        let mut last = None;
        for x in [f32::MIN, -2.0, -1.0, -1e-40, 0.0, 1e-40, 0.5, f32::MAX] {
            assert!(last < Some(ordered(x)));
            last = Some(ordered(x));
        }
        assert_eq!(ordered(-0.0), ordered(0.0));
        assert!(ordered(f32::MAX) < 1 << 32);
    }
}
