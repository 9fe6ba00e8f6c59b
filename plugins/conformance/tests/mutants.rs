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
