//! Triangles that are made of cages, and colours that go along.

use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Texture, TexturePoint};

use super::*;

const CUBE: &str = "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\n\
    v 1 1 1\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 3/2 4/3 2/4\nf 5/1 6/2 8/3 7/4\n\
    f 1/1 2/2 6/3 5/4\ng b\nf 3/1 7/2 8/3 4/4\nf -8/1 -4/2 -2/3 -6/4\nf 2/1 4/2 8/3 6/4\n";

/// Whether over a closed surface the vector areas of all triangles cancel; each corner is rounded
/// once to single precision.
fn areas_cancel(mesh: &TriangleMesh) -> bool {
    let n = u32::try_from(mesh.indices.len()).unwrap();
    let areas = (0..n).map(|i| {
        let [a, b, c] = mesh.corners(i);
        (b - a).cross(c - a)
    });
    areas.sum::<DVec3>().length() <= f64::from(n) * 1e-15
}

#[test]
fn faces_of_every_source_subdivide_alike() {
    let obj = Mesh { subdivide: 2, ..params("a.obj") };
    let obj = load(obj, CUBE.as_bytes()).unwrap();
    let numbers = |line: &str| line.split(' ').skip(1).map(|x| x.parse().unwrap()).collect();
    let points: Vec<Vec<f64>> = CUBE.lines().filter(|l| l.starts_with("v ")).map(numbers).collect();
    let points = points.concat();
    let indices = [0., 2., 3., 1., 4., 5., 7., 6., 0., 1., 5., 4., 2., 6., 7., 3.];
    let indices = [&indices[..], &[0., 4., 6., 2., 1., 3., 7., 5.]].concat();
    let tables = Mesh {
        points: Table::new(&points),
        indices: Table::new(&indices),
        sides: Table::new(&[4.0; 6]),
        ..params("")
    };
    let smooth = load(Mesh { subdivide: 2, ..tables }, b"").unwrap();
    assert_eq!((smooth.points.len(), smooth.indices.len()), (98, 192));
    assert!(areas_cancel(&smooth) && areas_cancel(&obj));
    assert!(obj.points.len() > 98 && obj.uvs.len() == obj.points.len());
    for i in 0..192 {
        assert_eq!(obj.corners(i), smooth.corners(i));
    }
    let mut ply = String::from("ply\nformat ascii 1.0\nelement vertex 8\nproperty double x\n");
    ply.push_str("property double y\nproperty double z\nelement face 6\n");
    ply.push_str("property list uchar int vertex_indices\nend_header\n");
    let (points, faces) = (points.as_chunks::<3>().0, indices.as_chunks::<4>().0);
    for [x, y, z] in points {
        writeln!(ply, "{x} {y} {z}").unwrap();
    }
    for [a, b, c, d] in faces {
        writeln!(ply, "4 {a} {b} {c} {d}").unwrap();
    }
    let ply = load(Mesh { subdivide: 2, ..params("a.ply") }, ply.as_bytes()).unwrap();
    assert_eq!(ply, smooth);
    let flat = load(Mesh { subdivide: 2, smooth: Shading::Flat, ..tables }, b"").unwrap();
    assert!(flat.normals.is_empty() && flat.indices.len() == 192);
    // Without levels, polygons are fans.
    assert_eq!(load(tables, b"").unwrap().indices.len(), 12);
}

#[test]
fn points_that_seams_have_doubled_are_joined_again() {
    // Two triangles of a square that meet in points of their own.
    let points = [0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 0., 0., 1., 1., 0., 0., 1., 0.];
    let uvs = [0., 0., 1., 0., 1., 1., 5., 5., 6., 6., 5., 6.];
    let torn = Mesh {
        points: Table::new(&points),
        indices: Table::new(&[0., 1., 2., 3., 4., 5.]),
        uvs: Table::new(&uvs),
        scheme: Scheme::Loop,
        ..params("")
    };
    let whole = load(Mesh { subdivide: 2, scheme: Scheme::Loop, ..square() }, b"").unwrap();
    let welded = load(Mesh { subdivide: 2, ..torn }, b"").unwrap();
    for i in 0..32 {
        assert_eq!(welded.corners(i), whole.corners(i));
    }
    // The seam's points by either number name it.
    for seam in [[0., 2., 10.], [3., 4., 10.], [3., 2., 10.]] {
        assert!(load(Mesh { subdivide: 1, creases: Table::new(&seam), ..torn }, b"").is_ok());
    }
}

#[test]
fn sides_that_do_not_fit_are_refused() {
    for (sides, expected) in [
        (&[3.0, 4.0][..], "7 corners in sides, but 6 numbers in indices"),
        (&[3.0, 2.0], "face 1 has 2 sides: 3 or more are wanted"),
        (&[3.0, f64::NAN], "face 1 has NaN sides: 3 or more are wanted"),
        (&[4e9, 4e9], "8000000000 corners in sides, but 6 numbers in indices"),
    ] {
        let found = fault(load(Mesh { sides: Table::new(sides), ..square() }, b""));
        assert_eq!((found.0, &found.2[..]), ("sides", expected));
    }
    let text = CUBE.replace("f 2/1 4/2 8/3 6/4", "f 2/1 4/2");
    let found = fault(load(Mesh { subdivide: 1, ..params("a.obj") }, text.as_bytes()));
    assert_eq!(found.2, "a.obj: line 19: a face with fewer than 3 corners");
    let text = CUBE.replace("v 1 1 1", "v 1 nan 1");
    let found = fault(load(Mesh { subdivide: 1, ..params("a.obj") }, text.as_bytes()));
    assert_eq!(found.2, "a.obj: line 8: this point has a coordinate that is not a finite number");
}

#[test]
fn colours_of_every_source_are_linear() {
    let colors = [0.0, 0.5, 1.0, 0.25, 0.25, 0.25, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mesh = load(Mesh { colors: Table::new(&colors), ..square() }, b"").unwrap();
    assert_eq!(mesh.colors[..2], [Vec3::new(0.0, 0.5, 1.0), Vec3::splat(0.25)]);
    let ply = |ty: &str, number: &str| {
        let header = HEADER.replace(
            "property float z\n",
            &format!(
                "property float z\nproperty {ty} red\nproperty {ty} green\nproperty {ty} blue\n"
            ),
        );
        let row = |p: &str| format!("{p} {number} 0 {number}\n");
        let rows: String = ["0 0 0", "1 0 0", "1 1 0", "0 1 0"].map(row).concat();
        let text = format!("ply\nformat ascii 1.0\n{header}{rows}4 0 1 2 3");
        ply_file(text.as_bytes()).unwrap().colors[3]
    };
    // Truth srgb.transfer: 0.5 is 0.21404114; 127.5/255 lies between two whole numbers.
    let (low, high) = (ply("uchar", "127").x, ply("uchar", "128").x);
    assert!(low < 0.214_041_14 && 0.214_041_14 < high && high - low < 0.004);
    assert_eq!((ply("float", "0.5"), ply("uchar", "255").x), (Vec3::new(0.5, 0.0, 0.5), 1.0));
    assert_eq!((ply("float", "nan").x, ply("double", "7").x), (0.0, 1.0));
    let obj = "v 0 0 0 0.5 0 1\nv 1 0 0 0.5 0 1\nv 0 1 0 0.5 0 1\nf 1 2 3\n";
    for subdivide in [0, 1] {
        let found = load(Mesh { subdivide, ..params("a.obj") }, obj.as_bytes()).unwrap();
        assert_eq!(found.colors.len(), found.points.len());
        let expected = Vec3::new(0.214_041_14, 0.0, 1.0);
        assert!(found.colors.iter().all(|c| (*c - expected).length() <= 2.0 * f32::EPSILON));
    }
    // Some points without: none.
    let holes = obj.replace("1 0 0 0.5 0 1", "1 0 0");
    let found = load(Mesh { subdivide: 1, ..params("a.obj") }, holes.as_bytes()).unwrap();
    assert!(found.colors.is_empty());
}

#[test]
fn colours_go_along_through_levels_and_displacement() {
    let colors = [0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.];
    let flat =
        Mesh { sides: Table::new(&[4.]), indices: Table::new(&[0., 1., 2., 3.]), ..square() };
    let mesh = Mesh { subdivide: 3, colors: Table::new(&colors), ..flat };
    let mesh = load(mesh, b"").unwrap();
    assert!(mesh.colors.len() == 81 && mesh.indices.len() == 128);
    // The middle of the face has the mean of its corners' colours.
    let middle = mesh.points.iter().position(|p| *p == Vec3::ZERO).unwrap();
    assert_eq!(mesh.colors[middle], Vec3::new(0.5, 0.5, 0.0));
    for (colors, expected) in [
        (&[0.5; 9][..], "3 colors for 4 points: there must be as many"),
        (&[0.5, 1.5, 0., 0., 0., 0., 0., 0., 0., 0., 0., 0.], "colour 0 has 1.5, outside [0, 1]"),
    ] {
        let found = fault(load(Mesh { colors: Table::new(colors), ..square() }, b""));
        assert_eq!((found.0, &found.2[..]), ("colors", expected));
    }
}

/// Half its first coordinate.
struct Ramp;

impl Texture for Ramp {
    fn eval(&self, at: &TexturePoint) -> Spectrum {
        Spectrum::splat(0.5 * at.uv.x)
    }
}

#[test]
fn a_mesh_is_displaced_as_its_parameters_say() {
    let uvs = [0., 0., 1., 0., 1., 1., 0., 1.];
    let flat = Mesh { uvs: Table::new(&uvs), ..square() };
    let raised = Mesh { displace: TextureRef::new(&Ramp), displace_by: 0.5, edge: 0.25, ..flat };
    let mesh = load(raised, b"").unwrap();
    for i in 0..u32::try_from(mesh.indices.len()).unwrap() {
        for p in mesh.corners(i) {
            // Corners are single precision about a centre at half a metre.
            let height = 0.25 * p.x;
            assert!((p.z - height).abs() <= f64::from(f32::EPSILON), "{p}");
        }
    }
    assert!(mesh.indices.len() >= 32 && mesh.normals.len() == mesh.points.len());
    for (wrong, field) in [
        (Mesh { edge: 0.0, ..raised }, "edge"),
        (Mesh { displace_by: 0.0, ..raised }, "displace_by"),
    ] {
        assert_eq!(wrong.check().unwrap_err().field, field);
    }
    assert!(raised.check().is_ok());
}

#[test]
fn what_does_nothing_is_told() {
    let creases = Mesh { creases: Table::new(&[0., 1., 1.]), ..square() };
    let edge = Mesh { edge: 0.1, ..square() };
    for (mesh, expected) in [
        (creases, "`creases` do nothing without `subdivide`"),
        (edge, "`displace_by` and `edge` do nothing without `displace`"),
    ] {
        let host = OneFile { bytes: b"".as_slice().into(), warnings: RefCell::default() };
        mesh.build(&host).unwrap();
        assert_eq!(*host.warnings.borrow(), [expected]);
    }
}
