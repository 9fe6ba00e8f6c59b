//! Builds that are followed and stopped: counted in looks and primitives, never in time.

use glam::DVec3;

use super::build::BATCH;
use super::partition::PART;
use super::soup::{Arrays, Rng, icosphere, soup};
use super::watch::STRIDE;
use super::{BuildError, MeshBvh, TopBvh, Watch};

/// A watch that is cancelled at this look.
fn ending_at(look: usize) -> Watch {
    let mut watch = Watch::default();
    watch.looks.last = look;
    watch
}

/// How often a build looks that nobody stops.
fn looks(watch: &Watch) -> usize {
    watch.looks.seen.lock().unwrap().len()
}

/// Stops builds of `n` primitives at some of the looks of a whole one. Each returns after few looks
/// more and with little more work done.
fn stop_anywhere(n: usize, seed: u64, build: impl Fn(&Watch) -> bool) {
    let whole = Watch::default();
    assert!(build(&whole));
    let total = looks(&whole);
    // Every primitive is looked after in its part, and in the passes over all of them.
    assert!(total > n / PART + 4 * (n / STRIDE), "{total} looks for {n} primitives");
    let threads = rayon::current_num_threads();
    let mut rng = Rng(seed);
    let some = (0..5).map(|_| 1 + rng.below(total));
    for look in [1, 2, total].into_iter().chain(some) {
        let watch = ending_at(look);
        assert!(!build(&watch), "it went on after look {look} of {total}");
        let seen = watch.looks.seen.lock().unwrap();
        // Each task of the pass in hand looks once, and does nothing.
        let most = look + n.div_ceil(STRIDE).max(BATCH * threads) + 2 * threads + 16;
        assert!(seen.len() <= most, "{} looks, stopped at {look}", seen.len());
        let more = watch.standing().done - seen[look - 1];
        assert!(more <= (threads * PART) as u64, "{more} more after look {look}");
    }
}

fn equal(n: usize) -> Arrays {
    let (points, _) = soup(1, 0.5, &mut Rng(7));
    (points, vec![[0, 1, 2]; n])
}

#[test]
fn a_build_that_is_cancelled_anywhere_ends_there() {
    let (points, indices) = icosphere(7, 1.0);
    stop_anywhere(indices.len(), 31, |watch| {
        let built = MeshBvh::build_watched(&points, &indices, watch);
        assert!(matches!(built, Ok(_) | Err(BuildError::Cancelled)));
        built.is_ok()
    });
}

#[test]
fn a_build_of_equal_triangles_ends_where_it_is_cancelled() {
    let (points, indices) = equal(150_000);
    stop_anywhere(indices.len(), 32, |watch| {
        MeshBvh::build_watched(&points, &indices, watch).is_ok()
    });
}

#[test]
fn a_tree_of_placements_ends_where_it_is_cancelled() {
    let mut rng = Rng(33);
    let boxes: Vec<_> = (0..200_000)
        .map(|_| {
            let p = rng.point().as_dvec3();
            (p, p + 0.01 * DVec3::ONE)
        })
        .collect();
    stop_anywhere(boxes.len(), 34, |watch| TopBvh::build_watched(&boxes, watch).is_some());
}

#[test]
fn progress_never_falls_and_ends_at_the_total() {
    let (mut points, mut indices) = icosphere(6, 1.0);
    // Some without an area, which are done by being left out.
    points.push(points[0]);
    indices.extend([[0, 0, 1], [3, 3, 3]].repeat(500));
    let watch = Watch::default();
    let tree = MeshBvh::build_watched(&points, &indices, &watch).unwrap();
    assert_eq!(tree.dropped(), 1000);
    let standing = watch.standing();
    assert_eq!((standing.done, standing.total), (indices.len() as u64, indices.len() as u64));
    assert_eq!(standing.unit, "triangles");
    let seen = watch.looks.seen.lock().unwrap();
    assert!(seen.is_sorted());
    // What is told moves in small steps, so that a line of progress does.
    let steps = seen.windows(2).map(|pair| pair[1] - pair[0]);
    let threads = rayon::current_num_threads() as u64;
    assert!(steps.max() <= Some(threads.max(2) * PART as u64));
}

#[test]
fn a_tree_has_the_same_bits_for_any_number_of_threads_and_watched_or_not() {
    let grid = |n: usize| soup(u32::try_from(n).unwrap(), 0.02, &mut Rng(35));
    for (points, indices) in [grid(9 * STRIDE + 5), icosphere(6, 3.0), equal(5 * STRIDE)] {
        let plain = MeshBvh::build(&points, &indices).unwrap().fingerprint();
        for threads in [1, 2, 7] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let watch = Watch::default();
            let tree = pool.install(|| MeshBvh::build_watched(&points, &indices, &watch));
            assert_eq!(tree.unwrap().fingerprint(), plain, "{threads} threads");
        }
    }
    let (points, indices) = icosphere(3, 1.0);
    let (other, _) = icosphere(3, 1.5);
    let of = |points| MeshBvh::build(points, &indices).unwrap().fingerprint();
    assert_ne!(of(&points), of(&other), "a fingerprint of nothing");
}
