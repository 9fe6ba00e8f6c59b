//! Scenes that are meant to hurt are refused within the memory that a scene may take.
#![cfg(target_os = "linux")]

use std::thread::available_parallelism;

use super::program::{Folder, SCENE};
use crate::attack_texts;

/// What a scene may take, KiB, and what each thread may for its stack.
const MEMORY: usize = 256 << 10;
const STACK: usize = 4 << 10;

/// What a scene may take of all processors together, seconds: one in a program that is made to be fast.
/// A debug build takes up to half as long again (measured: 1.5 s of a million `set`s), and processors
/// and caches that others use up to twice that; two more, as the system counts whole ones.
const SECONDS: usize = 5;

#[test]
fn what_is_meant_to_hurt_is_refused_within_256_mib_and_its_time() {
    let folder = Folder::new("attacks");
    // Memory beyond that is not given, and the program would end without a word; so it would after its
    // time on processors, however long it waited for them.
    let limit = MEMORY + STACK * available_parallelism().unwrap().get();
    let limit = format!("ulimit -d {limit}; ulimit -t {SECONDS}");
    for attack in attack_texts::all() {
        folder.write("a.scene", &attack.scene);
        for (name, text) in &attack.files {
            folder.write(name, text);
        }
        let done = folder.luxel_under(&limit, &["check", "a.scene"]);
        let is_refused = done.code == 1 && done.err.contains("error[E");
        assert!(is_refused, "{}: {:.2000}", attack.name, done.err);
    }
}

#[test]
fn ten_megabytes_of_remarks_are_laid_out_in_their_time() {
    let text = "scene 1\n".to_owned() + &"// a\n".repeat(2_000_000);
    let folder = Folder::new("remarks").with("a.scene", &text);
    let done = folder.luxel_under(&format!("ulimit -t {SECONDS}"), &["fmt", "--check", "a.scene"]);
    assert_eq!(done.code, 0, "{done:?}");
}

#[test]
fn time_beyond_the_limit_is_not_given() {
    let loops = "scene 1\nfor i in 0..1000000000 { let a = i }";
    let folder = Folder::new("time").with("a.scene", loops);
    let budget = ["check", "a.scene", "--budget", "steps=1e12"];
    let done = folder.luxel_under("ulimit -t 1", &budget);
    assert!(done.code != 1 && !done.err.contains("error[E"), "{done:?}");
}

#[test]
fn memory_beyond_the_limit_is_not_given() {
    let folder = Folder::new("limit").with("a.scene", SCENE);
    let done = folder.luxel_under("ulimit -d 1000", &["check", "a.scene"]);
    assert!(done.code != 0 && !done.err.contains("error[E"), "{done:?}");
}
