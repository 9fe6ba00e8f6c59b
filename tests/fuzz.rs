//! What fuzzing has found stays mended, and what it begins with is judged here once, in the same code:
//! `tests/fuzz/run` lets a fuzzer choose the bytes.

#[path = "fuzz/src/targets/mod.rs"]
mod targets;

use std::ffi::OsStr;
use std::path::Path;

use glam::UVec2;
use luxel_core::files::Files;
use luxel_core::film::{Film, Rect};

use crate::builder;
use crate::disk::{OnDisk, files_below, root};
use crate::plant::Dice;

type Judge = fn(&[u8]) -> bool;

const TARGETS: [(&str, Judge); 8] = [
    ("bytes", targets::bytes::judge),
    ("readers", targets::readers::judge),
    ("damage", targets::damage::judge),
    ("evaluate", targets::evaluate::judge),
    ("nested", targets::nested::judge),
    ("import", targets::import::judge),
    ("film", targets::film::judge),
    ("builder", |bytes| builder::judge(bytes) > 0),
];

fn read(path: &Path) -> Vec<u8> {
    OnDisk.read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_vec()
}

#[test]
fn what_a_fuzzer_found_stays_mended() {
    // The others are judged where the inside of the language is seen.
    const ELSEWHERE: [&str; 4] = ["chunks", "format", "made", "edits"];
    let found = files_below(&root().join("tests/fuzz/regressions"), "seed");
    assert!(found.len() > 10, "{found:?}");
    for path in found {
        println!("{}", path.display());
        let target = path.parent().and_then(Path::file_name).and_then(OsStr::to_str).unwrap();
        match TARGETS.iter().find(|(name, _)| *name == target) {
            Some((_, judge)) => drop(judge(&read(&path))),
            None => assert!(ELSEWHERE.contains(&target), "{target} is no target"),
        }
    }
}

#[test]
fn files_with_changed_bytes_are_built_or_refused() {
    const FILES: [(&str, &str); 4] = [
        ("gltf", "tests/data/gltf/box_sparse.gltf"),
        ("glb", "tests/data/gltf/box_sparse.glb"),
        ("obj", "tests/data/mesh/spot_control_mesh.obj"),
        ("picture", "scenes/assets/spot/spot_texture.png"),
    ];
    let mut dice = Dice(3);
    for (extension, path) in FILES {
        let whole = read(&root().join(path));
        for _ in 0..40 {
            let mut bytes = whole[..whole.len().min(4000)].to_vec();
            for _ in 0..=dice.below(3) {
                let at = dice.below(bytes.len());
                bytes[at] = dice.below(256).to_le_bytes()[0];
            }
            let input = [extension.as_bytes(), b"\n", &bytes].concat();
            assert!(targets::import::judge(&input));
        }
    }
}

#[test]
fn films_with_changed_bytes_are_read_or_refused() {
    let mut whole = vec![];
    Film::new(UVec2::new(3, 2), Rect::new(UVec2::ZERO, UVec2::new(3, 2))).save(&mut whole).unwrap();
    let mut dice = Dice(4);
    for _ in 0..2000 {
        let mut bytes = whole.clone();
        let at = dice.below(bytes.len().min(200));
        bytes[at] = dice.below(256).to_le_bytes()[0];
        targets::film::judge(&bytes);
        targets::film::judge(&bytes[..at]);
    }
}

#[test]
fn judges_of_scenes_look_at_them() {
    let scene = b"scene 1\nfor i in 0..3 { shape sphere { radius = i * 1 m + 1 m } }\n\
        camera perspective {\n  look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, \
        up = (0, 1, 0))\n  fov = 40 deg\n}\ninclude \"b\"\n// file: b\nscene 1\nlet a = 1\n";
    assert!(targets::bytes::judge(scene));
    assert!(targets::damage::judge(scene) && targets::readers::judge(scene));
    assert!(targets::evaluate::judge(scene));
    assert!(targets::nested::judge(b"group {\n~a = = 1\n~}\n"));
    let wrong: Vec<String> = (0..20).map(|i| format!("let a{i} = nope_{i}")).collect();
    assert!(!targets::damage::judge(format!("scene 1\n{}", wrong.join("\n")).as_bytes()));
    assert!(!targets::import::judge(b"nope\n"));
}
