//! What fuzzing has found stays mended: `tests/fuzz/regressions` holds the inputs.
#![expect(clippy::disallowed_methods, reason = "tests read the project's own files")]

use std::path::Path;

use super::{chunks, edits, format_keeps, made_keeps};

type Judge = fn(&[u8]) -> bool;

#[test]
fn what_a_fuzzer_found_of_texts_stays_mended() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/fuzz/regressions");
    // What was found of made scenes is held by texts: a seed means what the generator makes of it.
    let targets: [(&str, Judge); 3] =
        [("chunks", chunks), ("format", format_keeps), ("edits", edits)];
    for (name, judge) in targets {
        let found: Vec<_> = std::fs::read_dir(folder.join(name)).unwrap().collect();
        assert!(!found.is_empty(), "{name} has found something");
        for entry in found {
            let path = entry.unwrap().path();
            println!("{}", path.display());
            judge(&std::fs::read(&path).unwrap());
        }
    }
}

#[test]
fn judges_say_what_was_of_use() {
    let scene = b"scene 1\nlet a = 1\nlet b = a\n";
    assert!(chunks(scene) && format_keeps(scene));
    assert!(!chunks(b"scene 1\nlet a = \n") && !format_keeps(b"scene 1\nlet = 1"));
    assert!(!chunks(b"\xFF") && !format_keeps(b"\xFF"));
    assert!(edits(b"scene 1\nlet a = 1\n\xFF\x80\0\x01}\xFF\0\0\x04") && !edits(scene));
    assert!(made_keeps(&[7; 512]));
}
