//! Long lists, shared among as many threads as there are cores.

use std::thread;

use luxel_sdk::params::leave;

use super::compact::{IsOver, STRIDE};

/// How many threads share the work.
pub(super) fn n_cores() -> usize {
    thread::available_parallelism().map_or(1, usize::from)
}

/// What `f` adds for each few neighbours of a list, on as many threads as there are cores, in order;
/// `None` once it is over.
pub(super) fn in_parts<T: Sync, R: Send + 'static>(
    list: &[T],
    is_over: IsOver<'_>,
    f: &(dyn Fn(&[T], &mut Vec<R>) + Sync),
) -> Option<Vec<R>> {
    let length = list.len().div_ceil(n_cores()).max(STRIDE);
    let of_part = |part: &[T], room: usize| {
        let mut out = Vec::with_capacity(room);
        part.chunks(STRIDE).take_while(|_| !is_over()).for_each(|few| f(few, &mut out));
        out
    };
    let mut parts = list.chunks(length);
    let Some(first) = parts.next() else { return Some(vec![]) };
    let all = thread::scope(|scope| {
        let of_part = &of_part;
        let others: Vec<_> =
            parts.map(|part| scope.spawn(move || of_part(part, part.len()))).collect();
        let mut all = of_part(first, list.len());
        for other in others {
            all.extend(other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        all
    });
    if is_over() {
        leave(all);
        return None;
    }
    Some(all)
}

/// Has `f` done to each of a list.
pub(super) fn each_in_parts<T: Send>(list: Vec<T>, f: &(dyn Fn(T) + Sync)) {
    let length = list.len().div_ceil(n_cores()).max(1);
    let mut left = list.into_iter();
    thread::scope(|scope| {
        loop {
            let part: Vec<T> = left.by_ref().take(length).collect();
            if left.len() == 0 {
                return part.into_iter().for_each(f);
            }
            scope.spawn(|| part.into_iter().for_each(f));
        }
    });
}
