//! Every injected fault is caught.

use luxel_conformance::Options;
use luxel_conformance::mutants::{mutants, score};

#[test]
fn every_mutant_is_caught() {
    let scores = score(&mutants(), &Options::default());
    for caught in &scores {
        eprintln!("{:<32} {:<32} {}", caught.class, caught.fault, caught.by.join(", "));
    }
    let through: Vec<_> = scores.iter().filter(|caught| caught.by.is_empty()).collect();
    assert!(through.is_empty(), "{through:#?}");
}
