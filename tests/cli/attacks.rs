//! Scenes that are meant to hurt are refused within the memory that a scene may take.
#![cfg(target_os = "linux")]

use std::thread::available_parallelism;

use super::program::{Folder, SCENE};
use crate::attack_texts;

/// What a scene may take, KiB, and what each thread may for its stack.
const MEMORY: usize = 256 << 10;
const STACK: usize = 4 << 10;

#[test]
fn what_is_meant_to_hurt_is_refused_within_256_mib() {
    let folder = Folder::new("attacks");
    // Memory beyond that is not given, and the program would end without a word.
    let limit = MEMORY + STACK * available_parallelism().unwrap().get();
    let limit = format!("ulimit -d {limit}");
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
fn memory_beyond_the_limit_is_not_given() {
    let folder = Folder::new("limit").with("a.scene", SCENE);
    let done = folder.luxel_under("ulimit -d 1000", &["check", "a.scene"]);
    assert!(done.code != 0 && !done.err.contains("error[E"), "{done:?}");
}
