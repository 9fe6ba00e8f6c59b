//! Meshes whose corners move.

use super::*;

/// The square, a metre higher and twice as wide.
const AWAY: &[f64] = &[0., 0., 1., 2., 0., 1., 2., 1., 1., 0., 1., 1.];

fn moving() -> Mesh<'static> {
    Mesh { next_points: Table::new(AWAY), at: 0.5, next_at: 0.75, ..square() }
}

#[test]
fn corners_have_a_second_place_about_the_same_centre() {
    let mesh = load(moving(), b"").unwrap();
    let later = mesh.later.as_ref().unwrap();
    assert_eq!(later.times, [0.5, 0.75]);
    assert_eq!(mesh.centre + later.points[2].as_dvec3(), DVec3::new(2.0, 1.0, 1.0));
    assert_eq!(
        [0.0, 0.5, 0.625, 0.75, 9.0].map(|time| later.share(time)),
        [0.0, 0.0, 0.5, 1.0, 1.0]
    );
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
    let parts = |normals: &[glam::Vec3]| normals.iter().any(|n| n.distance(normals[0]) > 0.1);
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
    let far = [0., 0., 0., 1., 0., 0., 1., 1., 0., 1e39, 1., 0.];
    let (field, _, text) = fault(load(Mesh { next_points: Table::new(&far), ..square() }, b""));
    assert!(field == "next_points" && text.contains("too far out"), "{field}: {text}");
}
