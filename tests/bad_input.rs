//! What comes from outside and is wrong: each mistake gets its diagnostic and nothing panics.

use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use luxel_core::diag::Diagnostic;
use luxel_core::files::MemoryFiles;
use luxel_core::render::{Control, Options, render};
use luxel_core::stage::Stage;

use crate::disk::{OnDisk, root};
use crate::load::stage_of;
use luxel_core::files::Files;

const CAMERA: &str =
    "camera perspective { look = look_at(from = (0, 0, 3) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }
    film rgb { resolution = (4, 4) }
    light constant { spectrum = rgb.linear_srgb(1, 1, 1), scale = 1 }\n";

/// The stage of a scene of these statements and a camera, with files beside it.
fn build(body: &str, files: MemoryFiles) -> Result<Stage, Vec<Diagnostic>> {
    let text = format!("scene 1\n{CAMERA}{body}");
    stage_of(Path::new("bad.scene"), &files.with("bad.scene", text.as_bytes()), &[], None)
}

/// What is said of it includes this code, as an error, at a place in the scene.
fn check(body: &str, files: MemoryFiles, code: &str) {
    let said = build(body, files).expect_err(body);
    let found = said.iter().find(|d| d.code == code && d.is_error());
    let found = found.unwrap_or_else(|| panic!("{code} is not said of {body}: {said:?}"));
    assert!(found.span().is_some(), "{found} without a place");
    assert!(!found.message.is_empty());
}

fn one(name: &str, bytes: impl Into<Arc<[u8]>>) -> MemoryFiles {
    MemoryFiles::default().with(name, bytes)
}

/// A file of the project.
fn shipped(path: &str) -> Arc<[u8]> {
    OnDisk.read(&root().join(path)).unwrap()
}

const MESH: &str = "shape mesh { file = \"a.obj\", unit = 1 m }";
const PAINTED: &str = "shape sphere { radius = 1 m, material = material diffuse {
    reflectance = texture image { file = \"a.png\" } } }";
const SKY: &str = "light environment { file = \"a.exr\" }";
const ASSET: &str = "place a\nlet b = 1\n";

fn asset(file: &str) -> String {
    format!("let a = asset gltf {{ file = \"{file}\", unit = 1 m }}\n{ASSET}")
}

#[test]
fn files_that_are_missing_are_named() {
    for body in [MESH, PAINTED, SKY, &asset("a.glb")] {
        check(body, MemoryFiles::default(), "E0413");
    }
}

#[test]
fn files_of_the_wrong_kind_are_refused() {
    let noise: Vec<u8> =
        (0..5000_u32).map(|i| (i.wrapping_mul(2_654_435_761)).to_be_bytes()[0]).collect();
    for bytes in [vec![], vec![0], b"hello world, this is no picture".to_vec(), noise] {
        check(PAINTED, one("a.png", bytes.clone()), "E0413");
        check(SKY, one("a.exr", bytes.clone()), "E0413");
        check(&asset("a.glb"), one("a.glb", bytes.clone()), "E0413");
        check(&MESH.replace("a.obj", "a.ply"), one("a.ply", bytes), "E0413");
    }
}

#[test]
fn files_that_end_too_early_are_refused() {
    let png = shipped("scenes/assets/spot/spot_texture.png");
    let glb = shipped("scenes/assets/cake/cakeBirthday.glb");
    for part in [1, 8, 20, 33, 1000, png.len() / 2] {
        check(PAINTED, one("a.png", &png[..part]), "E0413");
    }
    for part in [1, 12, 20, 1000, glb.len() / 2, glb.len() - 1] {
        check(&asset("a.glb"), one("a.glb", &glb[..part]), "E0413");
    }
    let ply = "ply\nformat binary_little_endian 1.0\nelement vertex 1000000000000\n\
        property float x\nproperty float y\nproperty float z\nend_header\nabc";
    check(&MESH.replace("a.obj", "a.ply"), one("a.ply", ply.as_bytes()), "E0413");
}

#[test]
fn meshes_whose_indices_lie_are_refused() {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for face in ["f 1 2 4\n", "f 1 2 -9\n", "f 0 1 2\n", "f 1 2 99999999999999999999\n"] {
        let obj = format!("{triangle}{face}");
        let said = build(MESH, one("a.obj", obj.as_bytes())).expect_err(face);
        assert!(said.iter().any(|d| ["E0411", "E0413"].contains(&d.code)), "{face}: {said:?}");
    }
    for indices in ["0 1 3", "0 1", "0 1 -1", "0 1 0.5", ""] {
        let body =
            format!("shape mesh {{ points = #[ 0 0 0 1 0 0 0 1 0 ] m, indices = #[ {indices} ] }}");
        check(&body, MemoryFiles::default(), "E0411");
    }
}

#[test]
fn corners_that_are_no_numbers_are_refused() {
    for corner in ["nan 0 0", "inf 0 0", "0 -inf 0", "1e400 0 0"] {
        let obj = format!("v 0 0 0\nv 1 0 0\nv {corner}\nf 1 2 3\n");
        let said = build(MESH, one("a.obj", obj.as_bytes())).expect_err(corner);
        assert!(said.iter().any(|d| ["E0411", "E0413"].contains(&d.code)), "{corner}: {said:?}");
    }
}

#[test]
fn triangles_without_area_are_left_out_and_the_rest_is_shown() {
    let body =
        "shape mesh { points = #[ -9 -9 0  9 -9 0  0 9 0 ] m, indices = #[ 0 0 0  0 1 1  0 1 2 ],
        material = material diffuse { reflectance = 0.5 } }";
    let stage = build(body, MemoryFiles::default()).unwrap();
    let options = Options { spp: Some(4), ..Options::default() };
    let (film, _) = render(&stage, &options, &Control::default());
    assert_eq!(film.bad_samples(), 0);
    assert!(film.mean().0.y > 0.0 && film.mean().0.y < 0.9, "{}", film.mean().0);
    // A mesh of nothing else still loads, and shows nothing.
    let body = "shape mesh { points = #[ 0 0 0  1 0 0  2 0 0 ] m, indices = #[ 0 1 2 ] }";
    if let Ok(stage) = build(body, MemoryFiles::default()) {
        render(&stage, &options, &Control::default());
    }
}

#[test]
fn transforms_that_flatten_space_are_refused() {
    for transform in ["scale(0)", "scale((1, 0, 1))", "[move((1, 0, 0) m), scale(0)]"] {
        check(
            &format!("shape sphere {{ radius = 1 m, transform = {transform} }}"),
            MemoryFiles::default(),
            "E0412",
        );
    }
}

#[test]
fn a_light_without_end_is_refused_where_it_stands() {
    let body = "light area { shape = shape plane {}, radiance = 1 W/m^2/sr }";
    check(body, MemoryFiles::default(), "E0423");
    let said = build(body, MemoryFiles::default()).unwrap_err();
    let found = said.iter().find(|d| d.code == "E0423").unwrap();
    assert_eq!(found.message, "a light on a `plane` without end: its area is infinite");
    assert!(found.help.iter().any(|help| help.contains("rectangle")), "{found:?}");
}

#[test]
fn a_scene_without_a_camera_is_told_how_to_get_one() {
    let files = one("bad.scene", &b"scene 1\nshape sphere { radius = 1 m }"[..]);
    let said = stage_of(Path::new("bad.scene"), &files, &[], None).unwrap_err();
    let found = said.iter().find(|d| d.code == "E0409").unwrap();
    assert!(found.help.iter().any(|help| help.contains("perspective")), "{found:?}");
}

#[test]
fn a_scene_without_anything_is_black() {
    let text = "scene 1\ncamera perspective {
        look = look_at(from = (0, 0, 1) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }
        film rgb { resolution = (1, 1) }";
    let files = one("empty.scene", text.as_bytes());
    let stage = stage_of(Path::new("empty.scene"), &files, &[], None).unwrap();
    let (film, _) = render(&stage, &Options::default(), &Control::default());
    assert_eq!(film.mean().0, glam::DVec3::ZERO);
    let none = Options { spp: Some(0), ..Options::default() };
    assert_eq!(render(&stage, &none, &Control::default()).0.bad_samples(), 0);
}

#[test]
fn objects_that_double_with_every_step_are_refused() {
    for (kind, first, next) in
        [("shape", "sphere { radius = 1 m }", "union"), ("material", "diffuse {}", "mix")]
    {
        let mut body = format!("let x0 = {kind} {first}\n");
        for i in 0..40 {
            let _ = writeln!(body, "let x{} = {kind} {next} {{ a = x{i}, b = x{i} }}", i + 1);
        }
        body += match kind {
            "shape" => "place x40",
            _ => "shape sphere { radius = 1 m, material = x40 }",
        };
        check(&body, MemoryFiles::default(), "E0501");
    }
}
