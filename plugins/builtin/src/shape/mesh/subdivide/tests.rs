//! Known surfaces, and what must hold of all.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3, Vec2};
use luxel_sdk::sampling::Rng;

use super::*;
use crate::stop::testing::{Patience, ends_wherever};

fn polygons(points: &[[f64; 3]], faces: &[&[u32]]) -> Polygons {
    let mut out = Polygons {
        points: points.iter().map(|p| DVec3::from_array(*p)).collect(),
        starts: vec![0],
        ..Polygons::default()
    };
    for face in faces {
        out.corners.extend(*face);
        out.starts.push(out.corners.len().try_into().unwrap());
    }
    out
}

const QUADS: [&[u32]; 6] =
    [&[0, 2, 3, 1], &[4, 5, 7, 6], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 4, 6, 2], &[1, 3, 7, 5]];

/// The corners (±1, ±1, ±1), x fastest.
fn cube() -> Polygons {
    let sign = |bit: u32| if bit == 0 { -1.0 } else { 1.0 };
    let points: Vec<_> = (0..8u32).map(|i| [sign(i & 1), sign(i & 2), sign(i & 4)]).collect();
    polygons(&points, &QUADS)
}

fn octahedron() -> Polygons {
    let points = [
        [1.0, 0.0, 0.0],
        [-1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
    ];
    let faces: [&[u32]; 8] = [
        &[0, 2, 4],
        &[2, 1, 4],
        &[1, 3, 4],
        &[3, 0, 4],
        &[2, 0, 5],
        &[1, 2, 5],
        &[3, 1, 5],
        &[0, 3, 5],
    ];
    polygons(&points, &faces)
}

fn run(faces: &Polygons, scheme: Scheme, levels: u32, creases: &[f64]) -> Net {
    subdivide(faces.clone(), Settings { levels, scheme, creases }, &Patience::endless()).unwrap()
}

/// Edges with how often they are run along in each direction.
fn edges(net: &Net) -> BTreeMap<(u32, u32), [u32; 2]> {
    let mut out = BTreeMap::<_, [u32; 2]>::new();
    for [a, b, c] in &net.triangles {
        for (a, b) in [(a, b), (b, c), (c, a)] {
            out.entry((*a.min(b), *a.max(b))).or_default()[usize::from(a > b)] += 1;
        }
    }
    out
}

fn is_closed(net: &Net) -> bool {
    edges(net).values().all(|n| *n == [1, 1])
}

fn euler(net: &Net) -> i64 {
    let n = |n: usize| i64::try_from(n).unwrap();
    n(net.places.len()) - n(edges(net).len()) + n(net.triangles.len())
}

/// Where a given corner is among the places: points keep their number.
fn first(net: &Net) -> DVec3 {
    net.places[0]
}

/// Rounding of a point of size 1 through as many levels: a dozen operations each.
const ROUNDED: f64 = 100.0 * f64::EPSILON;

#[test]
fn a_cube_keeps_its_counts_and_closes_at_every_level() {
    for levels in 1..=4 {
        let net = run(&cube(), Scheme::CatmullClark, levels, &[]);
        let quads = 6 * 4usize.pow(levels);
        assert_eq!((net.triangles.len(), net.places.len()), (2 * quads, quads + 2));
        assert!(is_closed(&net) && euler(&net) == 2);
        let net = run(&octahedron(), Scheme::Loop, levels, &[]);
        assert_eq!(net.triangles.len(), 8 * 4usize.pow(levels));
        assert!(is_closed(&net) && euler(&net) == 2);
    }
}

#[test]
fn the_limit_mask_is_where_subdivision_goes() {
    // Of a cube's corner v: (9v + 4Σe + Σf) / 24, where Σe = v and Σf = −v.
    let by_hand = DVec3::splat(-0.5);
    let near = run(&cube(), Scheme::CatmullClark, 1, &[]);
    assert!((first(&near) - by_hand).length() <= ROUNDED);
    for levels in 2..=6 {
        let far = run(&cube(), Scheme::CatmullClark, levels, &[]);
        assert!((first(&far) - first(&near)).length() <= ROUNDED, "{levels}: {}", first(&far));
    }
    let (near, far) =
        (run(&octahedron(), Scheme::Loop, 1, &[]), run(&octahedron(), Scheme::Loop, 6, &[]));
    // 3/8β / (3/8β + 4) with β = 31/256: the neighbours cancel.
    let by_hand = DVec3::X * (24.0 / 55.0);
    assert!((first(&near) - by_hand).length() <= ROUNDED);
    assert!((first(&far) - by_hand).length() <= ROUNDED);
}

#[test]
fn every_limit_point_is_a_limit_point_of_the_next_level() {
    let mut rng = Rng::new(5);
    let mut faces = cube();
    for p in &mut faces.points {
        *p += DVec3::new(rng.f64(), rng.f64(), rng.f64()) - 0.5;
    }
    let creases = [0., 1., 10., 1., 3., 2.5, 3., 2., 0.5, 3., 7., 10., 7., 6., 10., 7., 5., 10.];
    for levels in 4..6 {
        let coarse = run(&faces, Scheme::CatmullClark, levels, &creases);
        let fine = run(&faces, Scheme::CatmullClark, levels + 1, &creases);
        for (a, b) in coarse.places.iter().zip(&fine.places) {
            assert!((*a - *b).length() <= ROUNDED, "{a} {b}");
        }
    }
}

#[test]
fn a_plane_stays_a_plane() {
    let at =
        |i: u32| [f64::from(i % 5), 0.25 * f64::from(i % 5) - f64::from(i / 5), f64::from(i / 5)];
    let points: Vec<_> = (0..25).map(at).collect();
    let quads: Vec<[u32; 4]> =
        (0..16).map(|i| i / 4 * 5 + i % 4).map(|i| [i, i + 1, i + 6, i + 5]).collect();
    let triangles: Vec<[u32; 3]> =
        quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    let quads: Vec<&[u32]> = quads.iter().map(|q| &q[..]).collect();
    let triangles: Vec<&[u32]> = triangles.iter().map(|t| &t[..]).collect();
    let n = DVec3::new(-0.25, 1.0, 1.0).normalize();
    for (scheme, faces) in [(Scheme::CatmullClark, quads), (Scheme::Loop, triangles)] {
        let net = run(&polygons(&points, &faces), scheme, 3, &[]);
        for p in &net.places {
            assert!(n.dot(*p).abs() <= 8.0 * ROUNDED, "{p}");
        }
        for normal in &net.normals {
            let cross = normal.as_dvec3().cross(n).length();
            // One rounding to single precision of each part.
            assert!(cross <= f64::from(f32::EPSILON), "{normal}");
        }
        // Corners of a single face stay where they are.
        let corners = if scheme == Scheme::Loop { &[4, 20][..] } else { &[0, 4, 20, 24] };
        for i in corners.iter().copied() {
            assert_eq!(net.places[i], DVec3::from_array(points[i]));
        }
    }
}

fn all_edges(faces: &Polygons, sharpness: f64) -> Vec<f64> {
    let level = Level::build(faces.clone(), &[], &Patience::endless()).unwrap();
    let each = |[a, b]: &[u32; 2]| [f64::from(*a), f64::from(*b), sharpness];
    level.ends.iter().flat_map(each).collect()
}

#[test]
fn a_cube_of_sharp_edges_stays_a_cube() {
    for sharpness in [10.0, 1e9] {
        let net = run(&cube(), Scheme::CatmullClark, 3, &all_edges(&cube(), sharpness));
        for (i, p) in net.places.iter().enumerate() {
            assert!(
                (p.abs().max_element() - 1.0).abs() <= ROUNDED && (i > 7 || p.abs() == DVec3::ONE)
            );
        }
        for (i, triangle) in net.triangles.iter().enumerate() {
            let ng = net.face_normal(*triangle);
            for normal in &net.normals[3 * i..3 * i + 3] {
                assert!((normal.as_dvec3() - ng).length() <= ROUNDED, "{normal} {ng}");
            }
        }
    }
}

#[test]
fn sharpness_rounds_less_and_less() {
    let corner = |s| first(&run(&cube(), Scheme::CatmullClark, 4, &all_edges(&cube(), s))).length();
    let mut before = first(&run(&cube(), Scheme::CatmullClark, 4, &[])).length();
    assert!((corner(0.0) - before).abs() <= ROUNDED);
    for step in 1..=12 {
        let now = corner(f64::from(step) * 0.25);
        assert!(now > before, "{step}");
        before = now;
    }
    assert!(before < 3f64.sqrt());
}

#[test]
fn limits_commute_with_affine_maps() {
    let mut rng = Rng::new(11);
    for round in 0..8 {
        let mut random = || DVec3::new(rng.f64(), rng.f64(), rng.f64()) * 2.0 - 1.0;
        let map = DMat3::from_cols(random(), random(), random());
        let shift = random() * 10.0;
        let sides = [(cube(), Scheme::CatmullClark), (octahedron(), Scheme::Loop)];
        let (faces, scheme) = &sides[round % 2];
        let creases = if round < 2 { &[][..] } else { &[0., 2., 1.5, 2., 4., 10.] };
        let creases = if round % 2 == 0 { &[][..] } else { creases };
        let before = run(faces, *scheme, 3, creases);
        let mut mapped = faces.clone();
        mapped.points.iter_mut().for_each(|p| *p = map * *p + shift);
        let after = run(&mapped, *scheme, 3, creases);
        for (a, b) in before.places.iter().zip(&after.places) {
            // Points reach 10 + 3 from the origin.
            assert!((map * *a + shift - *b).length() <= 13.0 * ROUNDED);
        }
    }
}

/// The largest angle between a limit normal and that of the triangles of a surface refined four
/// times more, at points that are old enough to have settled.
fn worst_normal(faces: &Polygons, scheme: Scheme, creases: &[f64], levels: u32) -> f64 {
    let coarse = run(faces, scheme, 2, creases);
    let fine = run(faces, scheme, levels, creases);
    let mut by_place: BTreeMap<u32, Vec<DVec3>> = BTreeMap::new();
    for (i, place) in fine.triangles.iter().flatten().enumerate() {
        by_place.entry(*place).or_default().push(fine.face_normal(fine.triangles[i / 3]));
    }
    let mut worst = 0.0f64;
    for (i, place) in coarse.triangles.iter().flatten().enumerate() {
        let n = coarse.normals[i].as_dvec3();
        // Of the faces on all sides of a crease one set belongs to this corner.
        let nearest = by_place[place].iter().map(|f| n.angle_between(*f)).fold(f64::MAX, f64::min);
        worst = worst.max(nearest);
    }
    worst
}

#[test]
fn limit_normals_are_those_of_far_subdivision() {
    // Corners with three to six edges, fans of two to four faces beside creases, a hole.
    let mut house = cube();
    house.points.iter_mut().for_each(|p| p.x *= 1.5 + 0.25 * p.y);
    let mut open = house.clone();
    open.starts.pop();
    open.corners.truncate(20);
    let crease = [0., 1., 10., 1., 3., 10., 3., 2., 10., 2., 0., 10.];
    // One of three edges, which ends in two corners.
    let dart = [0., 1., 10.];
    for (faces, creases) in
        [(&house, &[][..]), (&house, &crease[..]), (&house, &dart[..]), (&open, &[][..])]
    {
        let (near, far) = (
            worst_normal(faces, Scheme::CatmullClark, creases, 5),
            worst_normal(faces, Scheme::CatmullClark, creases, 7),
        );
        // A surface bends by as much as its faces are long: a quarter for two levels more.
        assert!(far < 0.02 && far < 0.35 * near, "{near} {far}");
    }
    let equator = [0., 2., 10., 2., 1., 10., 1., 3., 10., 3., 0., 10.];
    for creases in [&[][..], &equator[..]] {
        let (near, far) = (
            worst_normal(&octahedron(), Scheme::Loop, creases, 5),
            worst_normal(&octahedron(), Scheme::Loop, creases, 7),
        );
        assert!(far < 0.02 && far < 0.35 * near, "{near} {far}");
    }
}

/// The normals of a point, as the limit of a net has them.
fn normals_at(net: &Net, place: DVec3) -> Vec<DVec3> {
    let corners = net.triangles.iter().flatten().zip(&net.normals);
    let here = corners.filter(|(i, _)| net.places[**i as usize].distance(place) < 1e-9);
    here.map(|(_, normal)| normal.as_dvec3()).collect()
}

#[test]
fn the_end_of_a_sharp_edge_has_one_normal_whatever_the_level() {
    let tetrahedron = || {
        polygons(
            &[[1., 1., 1.5], [1., -1., -1.], [-1.2, 1., -1.], [-1., -1., 1.]],
            &[&[0, 1, 2], &[0, 3, 1], &[0, 2, 3], &[1, 3, 2]],
        )
    };
    for (scheme, faces) in [
        (Scheme::Loop, tetrahedron()),
        (Scheme::Loop, octahedron()),
        (Scheme::CatmullClark, cube()),
        (Scheme::CatmullClark, tetrahedron()),
    ] {
        let end = *faces.corners.first().expect("it has corners");
        let other = faces.corners[1];
        let creases = [f64::from(end), f64::from(other), 10.0];
        let near = run(&faces, scheme, 1, &creases);
        let far = run(&faces, scheme, 5, &creases);
        // The first point of the cage stays the first.
        let place = near.places[end as usize];
        assert!(place.distance(far.places[end as usize]) < 1e-9, "{scheme:?}");
        let (near, far) = (normals_at(&near, place), normals_at(&far, place));
        assert!(near.len() > 2 && far.len() > 2);
        for normal in near.iter().chain(&far) {
            // Rounded to single precision, twice.
            assert!(normal.distance(near[0]) < 1e-5, "{scheme:?}: {normal} {}", near[0]);
        }
    }
}

#[test]
fn seams_of_coordinates_do_not_tear() {
    let mut faces = cube();
    // Every face has a chart of its own.
    faces.uvs = (0..24)
        .map(|i| {
            Vec2::new((i / 4) as f32 + [0.0, 0.9, 0.9, 0.0][i % 4], [0.0, 0.0, 1.0, 1.0][i % 4])
        })
        .collect();
    let net = run(&faces, Scheme::CatmullClark, 3, &[]);
    let bare = run(&cube(), Scheme::CatmullClark, 3, &[]);
    assert_eq!(net.places, bare.places);
    assert_eq!(net.uvs.len(), 3 * net.triangles.len());
    let n_places = net.places.len();
    let mesh = net.into_mesh(false, &Patience::endless()).unwrap();
    // A place on an edge of the cube has two corner points, one at its corners three.
    assert_eq!(mesh.points.len(), n_places + 12 * 7 + 8 * 2);
    assert!(
        mesh.uvs
            .iter()
            .all(|uv| uv.x.fract() <= 0.9 + 4.0 * f32::EPSILON && uv.x >= 0.0 && uv.x < 6.0)
    );
    let centre = mesh.uvs.iter().any(|uv| (*uv - Vec2::new(2.45, 0.5)).length() <= 1e-6);
    assert!(centre, "the middle of a face keeps the middle of its chart");
}

#[test]
fn what_cannot_be_subdivided_is_refused() {
    let settings = |levels, scheme| Settings { levels, scheme, creases: &[] };
    let refuse = |faces: Polygons, settings: Settings<'_>| {
        let faults = subdivide(faces, settings, &Patience::endless()).unwrap_err();
        (faults[0].field, faults[0].message.clone())
    };
    let (field, message) = refuse(cube(), settings(1, Scheme::Loop));
    assert_eq!((field, &message[..20]), ("scheme", "a face has 4 corners"));
    let corner: &[u32] = &[0, 1, 2];
    let many = polygons(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[corner; 1000]);
    let (field, message) = refuse(many, settings(8, Scheme::CatmullClark));
    let expected = "8 levels make 98304000 triangles, at most 8388608 may be: 6 would fit";
    assert_eq!((field, &message[..]), ("subdivide", expected));
    for (creases, expected) in [
        (&[0., 1.][..], "2 numbers in creases: not a multiple of 3"),
        (&[0., 7., 1.], "crease 0: no edge joins points 0 and 7"),
        (&[0., 1., 1., 0., 8., 1.], "crease 1: no edge joins points 0 and 8"),
        (&[0., 1., -1.], "crease 0 has the sharpness -1, below 0"),
        (&[0., 1., f64::NAN], "crease 0 has the sharpness NaN, below 0"),
    ] {
        let (field, message) =
            refuse(cube(), Settings { creases, ..settings(1, Scheme::CatmullClark) });
        assert_eq!((field, &message[..]), ("creases", expected));
    }
}

#[test]
fn no_faces_however_joined_are_fatal() {
    let mut rng = Rng::new(3);
    for round in 0..300 {
        let points: Vec<_> = (0..6).map(|_| [rng.f64(), rng.f64(), rng.f64()]).collect();
        let mut pick = |n: u32| rng.u32() % n;
        let faces: Vec<Vec<u32>> = (0..=pick(6))
            .map(|_| (0..3 + pick(if round % 2 == 0 { 3 } else { 1 })).map(|_| pick(6)).collect())
            .collect();
        let faces: Vec<&[u32]> = faces.iter().map(|f| &f[..]).collect();
        let scheme = if round % 2 == 0 { Scheme::CatmullClark } else { Scheme::Loop };
        let faces = polygons(&points, &faces).clean(&Patience::endless()).unwrap();
        if let Ok(net) =
            subdivide(faces, Settings { levels: 2, scheme, creases: &[] }, &Patience::endless())
        {
            assert!(net.places.iter().all(|p| p.is_finite()));
            for n in &net.normals {
                assert!((n.length() - 1.0).abs() <= 2.0 * f32::EPSILON, "{n}");
            }
        }
    }
}

#[test]
fn subdividing_ends_soon_after_it_is_not_wanted_any_more() {
    let mut faces = cube();
    faces.uvs = vec![Vec2::ONE; faces.corners.len()];
    faces.colors = vec![Vec3::ONE; faces.corners.len()];
    for (scheme, faces) in [(Scheme::CatmullClark, faces), (Scheme::Loop, octahedron())] {
        let settings = |levels| Settings { levels, scheme, creases: &[0.0, 2.0, 1.5] };
        let looks = |levels| {
            let faces = || faces.clone();
            ends_wherever(|patience| {
                let net = subdivide(faces(), settings(levels), patience)?;
                net.into_mesh(false, patience).map_err(|told| vec![Fault::mesh("file", told)])
            })
        };
        // Not only between the levels: the last two have most of the faces.
        let (few, many) = (looks(4), looks(6));
        assert!(many > 2 * few, "{scheme:?}: {few} looks for 4 levels, {many} for 6");
    }
}
