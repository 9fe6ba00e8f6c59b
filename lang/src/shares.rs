//! Work on many statements, shared among threads: the same answers in the same order for any number
//! of them.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Bytes of text in a share: less is done by one thread before others would have begun.
const SHARE: usize = 1 << 16;

/// What `f` makes of each share: runs of neighbours with so many bytes together.
pub(crate) fn map<T: Sync, R: Send>(
    items: &[T],
    bytes: impl Fn(&T) -> usize,
    f: impl Fn(&[T]) -> R + Sync,
) -> Vec<R> {
    let shares = shares(items, bytes);
    let n_threads = std::thread::available_parallelism().map_or(1, usize::from).min(shares.len());
    if n_threads < 2 {
        return shares.into_iter().map(|share| f(&items[share])).collect();
    }
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = vec![];
        while let Some(share) = shares.get(next.fetch_add(1, Ordering::Relaxed)) {
            done.push((share.start, f(&items[share.clone()])));
        }
        done
    };
    let mut all: Vec<(usize, R)> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..n_threads).map(|_| scope.spawn(work)).collect();
        let join = |thread: std::thread::ScopedJoinHandle<'_, Vec<(usize, R)>>| {
            thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        };
        threads.into_iter().flat_map(join).collect()
    });
    all.sort_by_key(|(start, _)| *start);
    all.into_iter().map(|(_, made)| made).collect()
}

/// What has been made of all shares, one after the other.
pub(crate) fn join<R>(made: Vec<Vec<R>>) -> Vec<R> {
    let mut all = Vec::with_capacity(made.iter().map(Vec::len).sum());
    for some in made {
        all.extend(some);
    }
    all
}

fn shares<T>(items: &[T], bytes: impl Fn(&T) -> usize) -> Vec<Range<usize>> {
    let (mut shares, mut start, mut held) = (vec![], 0, 0);
    for (i, item) in items.iter().enumerate() {
        held += bytes(item);
        if held >= SHARE || i + 1 == items.len() {
            shares.push(start..i + 1);
            (start, held) = (i + 1, 0);
        }
    }
    shares
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_hold_everything_once_in_order() {
        let items: Vec<usize> = (0..1000).map(|i| i * 37 % 4096).collect();
        let made = map(&items, |n| *n, <[usize]>::to_vec);
        assert!(made.len() > 10, "{}", made.len());
        assert_eq!(join(made), items);
        assert_eq!(map(&[], |n: &usize| *n, <[usize]>::len), [0; 0]);
    }
}
