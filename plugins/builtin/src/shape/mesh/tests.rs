//! Meshes from tables and files, sound and damaged.

use std::cell::RefCell;
use std::fmt::Write;
use std::sync::{Arc, LazyLock};

use glam::{Vec2, Vec3};
use luxel_sdk::params::Text;

use super::*;

mod made;
mod moving;

/// A host with one file.
struct OneFile {
    bytes: Arc<[u8]>,
    warnings: RefCell<Vec<String>>,
}

impl BuildContext for OneFile {
    fn read(&self, _path: &str) -> Result<Arc<[u8]>, String> {
        Ok(self.bytes.clone())
    }
    fn read_beside(&self, _base: &str, _path: &str) -> Result<Arc<[u8]>, String> {
        Err("there is no other".to_owned())
    }
    fn warn(&self, message: &str) {
        self.warnings.borrow_mut().push(message.to_owned());
    }
}

fn params(path: &'static str) -> Mesh<'static> {
    const NONE: Table<'static> = Table::new(&[]);
    static EMPTY: LazyLock<Arc<TriangleMesh>> = LazyLock::new(Arc::default);
    Mesh {
        points: NONE,
        indices: NONE,
        normals: NONE,
        uvs: NONE,
        colors: NONE,
        file: File { path: Text::new(path) },
        unit: 1.0,
        up: Up::Y,
        smooth: Shading::Keep,
        sides: NONE,
        subdivide: 0,
        scheme: Scheme::CatmullClark,
        creases: NONE,
        displace: TextureRef::NONE,
        displace_by: 0.0,
        displace_from: 0.0,
        next: File { path: Text::new("") },
        next_points: NONE,
        at: 0.0,
        next_at: 1.0,
        edge: 0.0,
        table: Shared::new(&EMPTY),
    }
}

fn load(mesh: Mesh<'_>, bytes: &[u8]) -> Result<Arc<TriangleMesh>, Vec<Fault>> {
    let host = OneFile { bytes: bytes.into(), warnings: RefCell::default() };
    mesh.build(&host)
}

fn ply_file(bytes: &[u8]) -> Result<Arc<TriangleMesh>, Vec<Fault>> {
    load(params("a.ply"), bytes)
}

const SQUARE: &[f64] = &[0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.];

fn square() -> Mesh<'static> {
    Mesh {
        points: Table::new(SQUARE),
        indices: Table::new(&[0., 1., 2., 0., 2., 3.]),
        ..params("")
    }
}

/// The only fault of a build: its field, code and message.
fn fault(found: Result<Arc<TriangleMesh>, Vec<Fault>>) -> (&'static str, &'static str, String) {
    let faults = found.unwrap_err();
    assert_eq!(faults.len(), 1, "{faults:?}");
    (faults[0].field, faults[0].code, faults[0].message.clone())
}

#[test]
fn tables_become_a_mesh_about_its_centre() {
    let mesh = load(square(), b"").unwrap();
    assert_eq!(mesh.centre, DVec3::new(0.5, 0.5, 0.0));
    assert_eq!(mesh.corners(1)[1], DVec3::new(1.0, 1.0, 0.0));
    let shape = Mesh { table: Shared::new(&mesh), ..square() };
    assert!((shape.area() - 1.0).abs() <= f64::EPSILON);
    assert_eq!((shape.bounds().min, shape.bounds().max), (DVec3::ZERO, DVec3::new(1.0, 1.0, 0.0)));
    let turned = load(Mesh { up: Up::Z, ..square() }, b"").unwrap();
    assert_eq!(turned.corners(1)[1], DVec3::new(1.0, 0.0, -1.0));
}

#[test]
fn tables_that_do_not_fit_are_refused_together() {
    let bad = Mesh {
        points: Table::new(&SQUARE[..11]),
        indices: Table::new(&[0., 1., 2., 0., 2., 3., 1.]),
        uvs: Table::new(&[0., 0., 1., 1.]),
        ..square()
    };
    let faults = load(bad, b"").unwrap_err();
    let fields: Vec<_> = faults.iter().map(|f| f.field).collect();
    assert_eq!(fields, ["points", "indices", "uvs"]);
    assert_eq!(faults[1].message, "7 numbers in indices: not a multiple of 3");
    let beyond = Mesh { indices: Table::new(&[0., 1., 2., 0., 2., 4.]), ..square() };
    let (_, _, message) = fault(load(beyond, b""));
    assert_eq!(message, "index 4 of triangle 1 names no point: there are 4, from 0");
    for bad in [-1.0, 0.5, f64::NAN, 4.0, 1e300] {
        let indices = [0., 1., bad];
        let found = load(Mesh { indices: Table::new(&indices), ..square() }, b"");
        assert_eq!(fault(found).1, "E0411");
    }
    let points = [0., 0., 0., 1., f64::INFINITY, 0., 1., 1., 0.];
    let found = load(
        Mesh { points: Table::new(&points), indices: Table::new(&[0., 1., 2.]), ..square() },
        b"",
    );
    assert!(
        fault(found)
            .2
            .starts_with("point 1 at (1e0, inf, 0e0) has a coordinate that is not a finite")
    );
    assert!(load(Mesh { indices: Table::new(&[]), ..square() }, b"").is_err());
}

#[test]
fn a_file_needs_its_unit() {
    let found = Mesh { unit: 0.0, ..params("a.obj") }.check().unwrap_err();
    assert_eq!((found.field, found.code), ("unit", "E0415"));
    assert!(params("a.obj").check().is_ok() && Mesh { unit: 0.0, ..square() }.check().is_ok());
}

#[test]
fn normals_are_kept_dropped_or_made() {
    let roof = &[0., 0., 0., 0., 0., 1., 1., 1., 0., 1., 1., 1., 2., 0., 0., 2., 0., 1.];
    let indices = &[0., 1., 3., 0., 3., 2., 2., 3., 5., 2., 5., 4.];
    let roof = Mesh { points: Table::new(roof), indices: Table::new(indices), ..params("") };
    assert!(load(roof, b"").unwrap().normals.is_empty());
    let smooth = load(Mesh { smooth: Shading::Smooth, ..roof }, b"").unwrap();
    // The ridge is symmetric but for its diagonals: angles make the weights equal on both sides.
    assert!((smooth.normals[3] - Vec3::Y).length() <= 2.0 * f32::EPSILON, "{}", smooth.normals[3]);
    let normals = [0., 0., 2.].repeat(4);
    let kept = load(Mesh { normals: Table::new(&normals), ..square() }, b"").unwrap();
    assert_eq!(kept.normals, [Vec3::Z; 4]);
    let flat = Mesh { normals: Table::new(&normals), smooth: Shading::Flat, ..square() };
    assert!(load(flat, b"").unwrap().normals.is_empty());
    let mut holes = normals.clone();
    holes[..3].fill(f64::NAN);
    let mended = load(Mesh { normals: Table::new(&holes), ..square() }, b"").unwrap();
    assert_eq!(mended.normals, [Vec3::Z; 4]);
}

#[test]
fn quads_and_polygons_of_an_obj_become_fans() {
    let text = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 3 0\nv 0 2 0\nvt 0 0\nvt 1 0.5\n\
                g caf\u{e9}\nf 1/1 2/2 3/1 4/1 5/1\ng b\nf -5/-2 -4/-1 -3/-1 -2/-1\n";
    let mesh = load(Mesh { unit: 0.01, ..params("a.obj") }, text.as_bytes()).unwrap();
    assert_eq!(mesh.indices.len(), 5);
    assert_eq!(mesh.points.len(), 9);
    let area: f64 = Mesh { table: Shared::new(&mesh), ..params("a.obj") }.area();
    // Corners are single precision about the centre; each area is a product of two lengths.
    assert!((area / 9e-4 - 1.0).abs() <= 8.0 * f64::from(f32::EPSILON), "{area}");
    assert_eq!(mesh.uvs[1], Vec2::new(1.0, 0.5));
    // Latin-1 in a name is no reason to refuse the numbers.
    let latin = [b"o caf\xe9\n".as_slice(), text.as_bytes()].concat();
    assert!(load(params("a.obj"), &latin).is_ok());
}

#[test]
fn files_that_are_no_meshes_are_told_by_what_they_are() {
    for (bytes, expected) in [
        (&b"\x89PNG\r\n\x1a\n"[..], "not a mesh but a PNG picture: as meshes, OBJ and PLY"),
        (b"\xff\xd8\xff\xe0", "a JPEG picture"),
        (b"glTF\x02\0\0\0", "a binary glTF file: place it as an asset"),
        (b"{ \"asset\": 1 }", "place it as an asset"),
        (b"v 0 0 0\0\0", "not a mesh but binary data"),
    ] {
        let told = fault(load(params("a.obj"), bytes)).2;
        assert!(told.contains(expected), "{told}");
    }
}

#[test]
fn damaged_objs_are_refused_with_their_line() {
    let v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (text, expected) in [
        ("f 1 2 4\n", "a.obj: line 4: v 4 of 3"),
        ("f 1 2 0\n", "a.obj: line 4: `0` is no index of a v"),
        ("f 1 2 -4\n", "a.obj: line 4: `-4` is no index of a v"),
        ("f 1 2 3/9223372036854775807\n", "a.obj: line 4: vt 9223372036854775807 of 0"),
        (
            "f 1 2 99999999999999999999\n",
            "a.obj: line 4: `99999999999999999999` is no index of a v",
        ),
        ("f 1//1 2 3\n", "a.obj: line 4: vn 1 of 0"),
        ("l 1 2\n", "a.obj: an OBJ file without a face (no line `f 1 2 3`)"),
        ("", "a.obj: an OBJ file without a face (no line `f 1 2 3`)"),
        (
            "v 1e400 0 0\nf 1 2 4\n",
            "a.obj: line 4: this point has a coordinate that is not a finite number",
        ),
        (
            "v nan 0 0\nf 4 2 1\n",
            "a.obj: line 4: this point has a coordinate that is not a finite number",
        ),
        (
            "v 0 0 -1e300\nf 1 2 4\n",
            "a.obj: line 4: this point is too far out: a mesh reaches less than 3.4e38 m from \
             its centre",
        ),
    ] {
        let found = load(params("a.obj"), format!("{v}{text}").as_bytes());
        assert_eq!(fault(found), ("file", "E0413", expected.to_owned()), "{text}");
    }
    for text in ["f\n", "v 1 2\n", "f 1 2 x\n", "f 1/2/3/4 2 3\n", "\0\u{ff}"] {
        assert!(load(params("a.obj"), format!("{v}{text}").as_bytes()).is_err(), "{text}");
    }
}

const HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                      element face 1\nproperty list uchar int vertex_indices\nend_header\n";

fn text_ply(body: &str) -> Vec<u8> {
    format!("ply\r\nformat ascii 1.0\ncomment c\n{HEADER}{body}").into_bytes()
}

#[expect(clippy::cast_possible_truncation, reason = "whole numbers")]
fn binary_ply(big: bool) -> Vec<u8> {
    let word = if big { "big" } else { "little" };
    let mut out = format!("ply\nformat binary_{word}_endian 1.0\n{HEADER}").into_bytes();
    for x in SQUARE {
        let x = *x as f32;
        out.extend(if big { x.to_be_bytes() } else { x.to_le_bytes() });
    }
    out.push(4);
    for i in 0..4i32 {
        out.extend(if big { i.to_be_bytes() } else { i.to_le_bytes() });
    }
    out
}

#[test]
fn plys_of_every_encoding_are_the_same_mesh() {
    let text = ply_file(&text_ply("0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3")).unwrap();
    assert_eq!(text.indices, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(text, load(square(), b"").unwrap());
    assert_eq!(ply_file(&binary_ply(false)).unwrap(), text);
    assert_eq!(ply_file(&binary_ply(true)).unwrap(), text);
    // A file is what it holds, whatever it is called.
    assert_eq!(load(params("a.obj"), &binary_ply(true)).unwrap(), text);
}

#[test]
fn ply_normals_and_coordinates_are_read_and_the_rest_is_passed_over() {
    let header = "ply\nformat ascii 1.0\nelement material 1\nproperty list uchar int a\n\
        element vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
        property float nx\nproperty float ny\nproperty float nz\nproperty uchar red\n\
        property float s\nproperty float t\nelement face 1\nproperty uchar flags\n\
        property list uchar uint vertex_index\nelement edge 1\nproperty int a\nend_header\n";
    let body = "2 7 7\n1e6 0 0 0 0 2 255 0 1\n1000001 0 0 0 0 2 255 1 1\n1e6 1 0 0 0 2 255 0 0\n\
        0 3 0 1 2\n5";
    let mesh = ply_file(format!("{header}{body}").as_bytes()).unwrap();
    assert_eq!(mesh.corners(0)[1], DVec3::new(1_000_001.0, 0.0, 0.0));
    assert_eq!((mesh.normals[0], mesh.uvs[1]), (Vec3::Z, Vec2::ONE));
}

#[test]
fn damaged_plys_are_refused() {
    let body = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    for (face, expected) in [
        ("4 0 1 2 4", "a.ply: face 0 of 1: index 4 names no vertex: there are 4"),
        ("4 0 1 2 -1", "a.ply: face 0 of 1: index -1 names no vertex: there are 4"),
        ("4 0 1 2", "a.ply: face 0 of 1: a list of 4 numbers, but the file ends"),
        ("9 0 1 2", "a.ply: face 0 of 1: a list of 9 numbers, but the file ends"),
        ("3 0 1 x", "a.ply: face 0 of 1: `x` is not a number"),
        ("2 0 1", "a.ply: a mesh without a triangle"),
    ] {
        let found = ply_file(&text_ply(&format!("{body}{face}")));
        assert_eq!(fault(found), ("file", "E0413", expected.to_owned()));
    }
    let lie = HEADER.replace("vertex 4", "vertex 1000000000000000000");
    for format in ["ascii", "binary_little_endian"] {
        let text = format!("ply\nformat {format} 1.0\n{lie}");
        let told = fault(ply_file(text.as_bytes())).2;
        assert!(told.contains("000 points in one mesh, at most"), "{format}: {told}");
    }
    let nan = text_ply("0 0 0\n1 0 nan\n1 1 0\n0 1 0\n3 0 1 2");
    assert!(
        fault(ply_file(&nan)).2.starts_with("a.ply: point 1 at (1e0, 0e0, NaN) has a coordinate")
    );
    assert!(fault(ply_file(b"o hello")).2.contains("not a PLY file"));
}

#[test]
fn headers_that_claim_five_thousand_million_are_refused_before_room_is_made() {
    // Room for so many would end the process: 60 GB of points, and as much of triangles.
    for (claim, expected) in [
        (("vertex 4", "vertex 5000000000"), "5000000000 points in one mesh, at most 2147483648"),
        (("vertex 4", "vertex 2147483649"), "2147483649 points in one mesh, at most 2147483648"),
        (("vertex 4", "vertex 2147483648"), "2147483648 of element `vertex` do not fit into"),
        (("face 1", "face 5000000000"), "5000000000 of element `face` do not fit into"),
        (("face 1", "face 536870913"), "536870913 of element `face` do not fit into"),
    ] {
        for file in [binary_ply(false), text_ply("0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3")] {
            let at = file.windows(11).position(|w| w == b"end_header\n").unwrap();
            let header = String::from_utf8_lossy(&file[..at]).replace(claim.0, claim.1);
            let file = [header.as_bytes(), &file[at..]].concat();
            let faces = Mesh { subdivide: 1, ..params("a.ply") };
            for found in [load(params("a.ply"), &file), load(faces, &file)] {
                let (field, code, message) = fault(found);
                assert_eq!((field, code), ("file", "E0413"));
                assert!(message.starts_with(&format!("a.ply: {expected}")), "{message}");
            }
        }
    }
}

#[test]
fn no_cut_or_flipped_byte_of_a_file_is_fatal() {
    let (binary, text) = (binary_ply(false), text_ply("0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3"));
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\n".to_vec();
    for (path, file) in [("a.ply", binary), ("a.ply", text), ("a.obj", obj)] {
        for cut in 0..file.len() {
            let _ = load(params(path), &file[..cut]);
            for flip in [1u8, 0x10, 0x80] {
                let mut damaged = file.clone();
                damaged[cut] ^= flip;
                // Whatever comes out is sound.
                if let Ok(mesh) = load(params(path), &damaged) {
                    let n = mesh.points.len();
                    assert!(mesh.indices.iter().flatten().all(|i| (*i as usize) < n));
                    assert!(mesh.points.iter().all(|p| p.is_finite()));
                }
            }
        }
    }
}

/// A height field of n × n points as binary PLY, for the measurement below.
fn field(n: u32) -> Vec<u8> {
    let mut header = String::from("ply\nformat binary_little_endian 1.0\n");
    let (points, faces) = (n * n, 2 * (n - 1) * (n - 1));
    write!(header, "element vertex {points}\nproperty float x\nproperty float y\n").unwrap();
    write!(header, "property float z\nelement face {faces}\n").unwrap();
    header.push_str("property list uchar int vertex_indices\nend_header\n");
    let mut out = header.into_bytes();
    for i in 0..points {
        for x in [(i % n) as f32, (i % 7) as f32, (i / n) as f32] {
            out.extend(x.to_le_bytes());
        }
    }
    for i in 0..faces / 2 {
        let a = i / (n - 1) * n + i % (n - 1);
        for t in [[a, a + n, a + 1], [a + 1, a + n, a + n + 1]] {
            out.push(3);
            out.extend(t.iter().flat_map(|i| i.to_le_bytes()));
        }
    }
    out
}

#[test]
fn large_binary_plys_are_read_in_place() {
    let mesh = ply_file(&field(300)).unwrap();
    assert_eq!((mesh.points.len(), mesh.indices.len()), (90_000, 2 * 299 * 299));
    assert_eq!(mesh.corners(0)[1], DVec3::new(0.0, 300.0 % 7.0, 1.0));
}

#[test]
fn a_real_cage_of_quads_is_closed() {
    let bytes = include_bytes!("../../../../../tests/data/mesh/spot_control_mesh.obj");
    let mesh = load(params("spot.obj"), bytes).unwrap();
    // Over a closed surface the vector areas of all triangles cancel.
    let sum: DVec3 = (0..mesh.indices.len())
        .map(|i| {
            let [a, b, c] = mesh.corners(i.try_into().unwrap());
            (b - a).cross(c - a)
        })
        .sum();
    assert!(mesh.indices.len() == 372 && sum.length() <= 1e-12, "{sum} {}", mesh.indices.len());
}
