//! How long trees take to build, ours and Embree's in turn, on as many threads as
//! `RAYON_NUM_THREADS` says, or all.

use std::num::NonZeroUsize;
use std::time::Instant;

use glam::Vec3;
use libloading::Library;
use luxel_core::accel::{Direction, MeshBvh, Precision, Processor, Query};

use super::embree::{Embree, Flags};
use super::knot::{Soup, eight, knot};
use super::shots::{Landing, Set, Shot, sets};
use crate::series::Series;

/// Times that each mesh is built, in turn with the other builder.
const ROUNDS: usize = 9;

/// Prints seconds for three meshes, and how many nodes and blocks of ours a ray looks at.
pub(super) fn run(library: Option<&Library>) {
    let one = knot(1341, 335);
    #[expect(clippy::disallowed_methods, reason = "rayon asks it too; Embree must get as many")]
    let told = std::env::var("RAYON_NUM_THREADS").ok().and_then(|n| n.parse().ok());
    let cores = || std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    let threads = told.filter(|n| *n > 0).unwrap_or_else(cores);
    println!("{threads} threads");
    println!("{:<12}{:>10}{:>10}{:>8}{:>12}", "", "ours s", "Embree s", "ratio", "steps");
    for (name, soup, eye) in [
        ("small", &knot(375, 94), Vec3::new(0.3, 0.6, 2.2)),
        ("large", &one, Vec3::new(0.3, 0.6, 2.2)),
        ("huge", &eight(&one), Vec3::new(0.9, 2.4, 4.4)),
    ] {
        let (ours, theirs) = race(soup, threads, library);
        let ratio = theirs.as_ref().map(|theirs| format!("{:.2}", ours.min() / theirs.min()));
        let theirs = theirs.map(|theirs| format!("{:.4}", theirs.min()));
        let [theirs, ratio] = [theirs, ratio].map(Option::unwrap_or_default);
        let steps = steps(soup, eye);
        println!("{name:<12}{:>10.4}{theirs:>10}{ratio:>8}{steps:>12.4}", ours.min());
    }
}

fn race(soup: &Soup, threads: usize, library: Option<&Library>) -> (Series, Option<Series>) {
    let (mut ours, mut theirs) = (vec![], vec![]);
    for _ in 0..ROUNDS {
        let start = Instant::now();
        let tree = MeshBvh::build(&soup.points, &soup.indices);
        ours.push(start.elapsed().as_secs_f64());
        drop(tree);
        if let Some(library) = library {
            let start = Instant::now();
            let scene = Embree::with_threads(library, soup, Flags::Default, threads);
            theirs.extend(scene.is_some().then(|| start.elapsed().as_secs_f64()));
        }
    }
    (Series::from(ours), (!theirs.is_empty()).then(|| Series::from(theirs)))
}

/// Nodes and blocks that rays look at, on average: tells trees apart without a clock.
fn steps(soup: &Soup, eye: Vec3) -> f64 {
    let tree = MeshBvh::build(&soup.points, &soup.indices).expect("the knot is finite");
    let trace = |shot: &Shot| {
        let direction = Direction::new(shot.d.as_dvec3())?;
        let t_max = f64::from(shot.t_max) * direction.scale();
        let o = shot.o.as_dvec3();
        let precision = Precision::Standard;
        let query = Query { o, direction: &direction, t_max, skip: None, precision, share: 0.0 };
        let (hit, steps) = tree.intersect(Processor::ANY, &query);
        #[expect(clippy::cast_possible_truncation, reason = "rounded as the other rays are")]
        let t = hit.map(|hit| ((hit.t * direction.per_scale()) as f32, hit.triangle));
        Some((t, steps))
    };
    let land = |shots: &[Shot]| {
        let found = shots.iter().map(|shot| match trace(shot).and_then(|found| found.0) {
            Some((t, triangle)) => Landing { t, triangle },
            None => Landing::NOWHERE,
        });
        found.collect()
    };
    let sets: Vec<Set> = sets(soup, super::WIDTH, eye, &land);
    let all = sets.iter().filter(|set| !set.any).flat_map(|set| &set.shots);
    let steps: Vec<f64> = all.filter_map(trace).map(|(_, steps)| f64::from(steps)).collect();
    steps.iter().sum::<f64>() / steps.len() as f64
}
