//! Every injected fault is caught.

use std::sync::Mutex;
use std::{iter, thread};

use luxel_conformance::Options;
use luxel_conformance::mutants::{Caught, Mutant, mutants, score};
use luxel_sdk::kind::Kind;

/// As [`score`], by as many threads as the machine has, each of which takes the next when it has judged one.
/// Integrators come after the others, one by one: a check of theirs is one of time.
fn scored(all: Vec<Mutant>) -> Vec<Caught> {
    let is_timed = |mutant: &Mutant| mutant.class.kind == Kind::Integrator;
    let (timed, others): (Vec<_>, Vec<_>) = all.into_iter().partition(is_timed);
    let left = Mutex::new(others.chunks(1));
    let next = || left.lock().expect("none panics").next();
    let judge = || iter::from_fn(next).flat_map(|one| score(one, &Options::default())).collect();
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut scores: Vec<Caught> = thread::scope(|scope| {
        let judging: Vec<_> = (0..threads).map(|_| scope.spawn(judge)).collect();
        judging.into_iter().flat_map(|one| -> Vec<_> { one.join().expect("none panics") }).collect()
    });
    scores.extend(score(&timed, &Options::default()));
    scores
}

#[test]
fn every_mutant_is_caught() {
    let scores = scored(mutants());
    for caught in &scores {
        eprintln!("{:<32} {:<32} {}", caught.class, caught.fault, caught.by.join(", "));
    }
    let through: Vec<_> = scores.iter().filter(|caught| caught.by.is_empty()).collect();
    assert!(through.is_empty(), "{through:#?}");
    // Checks of time, of several pictures and of the boundary notice what they are there for.
    for (class, check) in [
        ("integrator dawdles", "a render ends when asked"),
        ("integrator blotchy", "error falls as N^-1/2"),
        ("material no_number", "never ends a render"),
        ("material trips_at_the_end", "never panics"),
        ("light shapeless", "a surface has a `shape`"),
    ] {
        let caught = scores.iter().find(|caught| caught.class == class);
        let caught = caught.unwrap_or_else(|| panic!("there is no {class}"));
        assert!(caught.by.iter().any(|by| by == check), "{caught:#?}");
    }
}
