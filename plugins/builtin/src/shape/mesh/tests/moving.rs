//! Meshes whose corners move.

use super::*;

/// Each file by its name.
struct Two<'a>(&'a str, &'a str);

impl BuildContext for Two<'_> {
    fn read(&self, path: &str) -> Result<Arc<[u8]>, String> {
        Ok(if path == "a.ply" { self.0 } else { self.1 }.as_bytes().into())
    }
    fn read_beside(&self, _: &str, path: &str) -> Result<Arc<[u8]>, String> {
        self.read(path)
    }
    fn warn(&self, _: &str) {}
}

/// The square, a metre higher and twice as wide.
const AWAY: &[f64] = &[0., 0., 1., 2., 0., 1., 2., 1., 1., 0., 1., 1.];

fn moving() -> Mesh<'static> {
    Mesh { next_points: Table::new(AWAY), at: 0.5, next_at: 0.75, ..square() }
}

#[test]
fn corners_have_a_second_place_about_the_same_centre() {
    let mesh = load(moving(), b"").unwrap();
    let later = mesh.later.as_ref().unwrap();
    assert_eq!(later.times.map(f64::to_bits), [0.5f64, 0.75].map(f64::to_bits));
    assert_eq!(mesh.centre + later.points[2].as_dvec3(), DVec3::new(2.0, 1.0, 1.0));
    let shares = [0.0, 0.5, 0.625, 0.75, 9.0].map(|time| later.share(time).to_bits());
    assert_eq!(shares, [0.0f32, 0.0, 0.5, 1.0, 1.0].map(f32::to_bits));
    assert!(load(square(), b"").unwrap().later.is_none());
}

#[test]
fn subdivided_corners_move_though_their_normals_part_on_the_way() {
    // Flat at first: corners on both sides of the crease have one normal, and two at the end.
    let bent = &[0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 1.];
    let cage = Mesh {
        subdivide: 2,
        creases: Table::new(&[0., 2., 10.]),
        smooth: Shading::Smooth,
        ..square()
    };
    let mesh = load(Mesh { next_points: Table::new(bent), ..cage }, b"").unwrap();
    let later = mesh.later.as_ref().unwrap();
    assert_eq!((later.points.len(), later.normals.len()), (mesh.points.len(), mesh.normals.len()));
    let parts = |normals: &[Vec3]| normals.iter().any(|n| n.distance(normals[0]) > 0.1);
    assert!(!parts(&mesh.normals) && parts(&later.normals));
}

#[test]
fn motions_that_cannot_be_are_told_where_they_stand() {
    let other = Mesh { next_points: Table::new(&AWAY[..9]), ..square() };
    let faults = load(other, b"").unwrap_err();
    assert!(faults.iter().any(|fault| fault.message.contains("names no point")), "{faults:?}");
    let more = [AWAY, &[5., 5., 5.]].concat();
    let (field, code, text) = fault(load(Mesh { next_points: Table::new(&more), ..square() }, b""));
    assert_eq!((field, code), ("next_points", "E0411"));
    assert!(text.contains("2 triangles of 5 corners here, 2 of 4 before"), "{text}");
    let found = Mesh { next_at: 0.5, ..moving() }.check().unwrap_err();
    assert_eq!(found.field, "next_at");
    let found = Mesh { normals: Table::new(SQUARE), ..moving() }.check().unwrap_err();
    assert!(found.field == "normals" && found.message.contains("do not turn"), "{found:?}");
    let far = [0., 0., 0., 1., 0., 0., 1., 1., 0., 1e39, 1., 0.];
    let (field, _, text) = fault(load(Mesh { next_points: Table::new(&far), ..square() }, b""));
    assert!(field == "next_points" && text.contains("too far out"), "{field}: {text}");
}

#[test]
fn files_of_which_one_has_normals_are_not_two_places_of_one_mesh() {
    const FACES: &str = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const POINTS: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let bare = format!("{POINTS}{FACES}0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    let normals = "property float nx\nproperty float ny\nproperty float nz\n";
    let full = format!("{POINTS}{normals}{FACES}0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n");
    let mesh = Mesh { next: File { path: Text::new("b.ply") }, ..params("a.ply") };
    let (field, _, text) = fault(mesh.build(&Two(&full, &bare)));
    assert!(field == "next" && text.contains("has none"), "{field}: {text}");
    assert!(mesh.build(&Two(&full, &full)).unwrap().later.is_some());
    let smooth = Mesh { smooth: Shading::Smooth, ..mesh };
    assert!(smooth.build(&Two(&full, &bare)).unwrap().later.is_some());
}
