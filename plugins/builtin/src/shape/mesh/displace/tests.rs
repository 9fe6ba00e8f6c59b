//! What displacement keeps, and how far it goes.

use std::collections::BTreeMap;

use glam::Vec3Swizzles;
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Output, Texture, TexturePoint};

use super::*;
use crate::stop::testing::{Patience, ends_wherever};

/// Height by the place alone, or by the coordinates.
struct Heights(fn(&TexturePoint) -> f32);

impl Texture for Heights {
    fn eval(&self, at: &TexturePoint) -> Spectrum {
        Spectrum::splat((self.0)(at))
    }
    fn output(&self) -> Output {
        Output::Value
    }
}

fn settings(heights: &Heights, by: f64, edge: f64) -> Settings<'_> {
    Settings { texture: TextureRef::new(heights), by, from: 0.0, edge }
}

const CORNERS: [[f64; 3]; 6] =
    [[1., 0., 0.], [-1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [0., 0., 1.], [0., 0., -1.]];
const FACES: [[u32; 3]; 8] =
    [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];

/// An octahedron, whose corners have the normals of the sphere around it.
fn octahedron() -> Net {
    let places = CORNERS.map(DVec3::from_array).to_vec();
    let normals = FACES.as_flattened().iter().map(|i| places[*i as usize].as_vec3()).collect();
    Net { places, triangles: FACES.to_vec(), normals, ..Net::default() }
}

/// The same, each face with a chart of its own.
fn torn() -> Net {
    let chart = |i: u32| [Vec2::new(i as f32, 0.0), Vec2::new(i as f32 + 0.9, 0.1), Vec2::ONE];
    Net { uvs: (0..8).flat_map(chart).collect(), ..octahedron() }
}

/// Whether each edge is run along once in each direction.
fn is_closed(net: &Net) -> bool {
    let mut edges = BTreeMap::<_, [u32; 2]>::new();
    for [a, b, c] in &net.triangles {
        for (a, b) in [(a, b), (b, c), (c, a)] {
            edges.entry((*a.min(b), *a.max(b))).or_default()[usize::from(a > b)] += 1;
        }
    }
    edges.values().all(|n| *n == [1, 1])
}

fn longest(net: &Net) -> f64 {
    let length = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|i| net.places[i as usize]);
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    };
    net.triangles.iter().map(length).fold(0.0, f64::max)
}

#[test]
fn edges_are_as_short_as_asked_and_the_surface_stays_closed() {
    for edge in [1.5, 1.0, 0.6, 0.2, 0.05] {
        for mut net in [octahedron(), torn()] {
            // Needles, and corners that differ.
            net.places[0] *= 7.0;
            net.places[4] *= 0.01;
            let net = tessellate(net, edge, MOST_TRIANGLES, &Patience::endless()).unwrap();
            assert!(longest(&net) <= edge && is_closed(&net), "{edge}: {}", longest(&net));
            // Flat faces keep the area that they had.
            assert!(net.normals.len() == 3 * net.triangles.len());
        }
    }
    let area = |net: &Net| -> f64 {
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| net.places[i as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        net.triangles.iter().map(of).sum()
    };
    let (before, after) = (
        octahedron(),
        tessellate(octahedron(), 0.1, MOST_TRIANGLES, &Patience::endless()).unwrap(),
    );
    // A rounding for each of the triangles.
    let rounded = after.triangles.len() as f64 * f64::EPSILON;
    assert!((area(&before) - area(&after)).abs() <= rounded * area(&before));
}

#[test]
fn a_constant_moves_a_sphere_to_a_sphere() {
    let mut sphere = tessellate(octahedron(), 0.2, MOST_TRIANGLES, &Patience::endless()).unwrap();
    sphere.places.iter_mut().for_each(|p| *p = p.normalize());
    sphere.normals =
        sphere.triangles.iter().flatten().map(|i| sphere.places[*i as usize].as_vec3()).collect();
    let places = sphere.places.clone();
    for (by, from) in [(0.5, 0.0), (-0.25, 0.0), (0.5, 2.0)] {
        let flat = Heights(|_| 1.0);
        let settings = Settings { from, ..settings(&flat, by, 10.0) };
        let moved =
            displace(sphere.clone(), settings, Shading::Keep, &Patience::endless()).unwrap();
        assert!(is_closed(&moved));
        let radius = 1.0 + by * (1.0 - from);
        for (p, before) in moved.places.iter().zip(&places) {
            // Normals are single precision.
            assert!((*p - *before * radius).length() <= by.abs() * 4.0 * f64::from(f32::EPSILON));
        }
        for (normal, place) in moved.normals.iter().zip(moved.triangles.iter().flatten()) {
            let out = moved.places[*place as usize] * radius.signum();
            // Faces of a fifth of the radius are as far from it as their sagitta.
            assert!(normal.as_dvec3().angle_between(out) < 0.05);
        }
    }
}

#[test]
fn seams_with_other_heights_on_each_side_stay_closed() {
    let checker = Heights(|at| if (at.uv.x * 4.0).floor() % 2.0 == 0.0 { 1.0 } else { 0.0 });
    let moved = displace(torn(), settings(&checker, 0.3, 0.1), Shading::Keep, &Patience::endless())
        .unwrap();
    assert!(is_closed(&moved));
    let mesh = moved.clone().into_mesh(false, &Patience::endless()).unwrap();
    assert!(mesh.points.len() > moved.places.len(), "the seams are there");
    // No corner point of a place differs from the others.
    let mut of_places = BTreeMap::new();
    for (t, triangle) in mesh.indices.iter().zip(&moved.triangles) {
        for k in 0..3 {
            let p = mesh.points[t[k] as usize];
            assert_eq!(*of_places.entry(triangle[k]).or_insert(p), p);
        }
    }
}

#[test]
fn a_plate_rises_where_its_texture_is_high() {
    // A square of 1 m with its coordinates, split along the edges of a 2 × 2 checker.
    let places = [[0., 0., 0.], [0., 0., 1.], [1., 0., 1.], [1., 0., 0.]].map(DVec3::from_array);
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    let uv = |i: &u32| places[*i as usize].as_vec3().xz();
    let uvs = triangles.iter().flatten().map(uv).collect();
    let plate = Net { places: places.to_vec(), triangles, uvs, ..Net::default() };
    let checker = Heights(|at| f32::from((at.uv.x < 0.5) == (at.uv.y < 0.5)));
    let moved = displace(plate, settings(&checker, 0.02, 0.1), Shading::Keep, &Patience::endless())
        .unwrap();
    for p in &moved.places {
        let expected = if (p.x < 0.5) == (p.z < 0.5) { 0.02 } else { 0.0 };
        assert!((p.y - expected).abs() <= f64::EPSILON, "{p}");
    }
    assert!(moved.places.len() > 100 && longest(&moved) > 0.0);
}

#[test]
fn normals_are_of_what_was_moved_or_none() {
    let bumps = Heights(|at| at.p.as_vec3().x);
    let moved =
        displace(octahedron(), settings(&bumps, 0.1, 0.2), Shading::Smooth, &Patience::endless())
            .unwrap();
    assert!(moved.normals.iter().all(|n| (n.length() - 1.0).abs() <= 2.0 * f32::EPSILON));
    let flat =
        displace(octahedron(), settings(&bumps, 0.1, 0.2), Shading::Flat, &Patience::endless())
            .unwrap();
    assert!(flat.normals.is_empty() && is_closed(&flat));
}

#[test]
fn too_short_an_edge_is_refused_with_one_that_fits() {
    let flat = Heights(|_| 1.0);
    let faults =
        displace(octahedron(), settings(&flat, 0.1, 1e-4), Shading::Keep, &Patience::endless())
            .unwrap_err();
    let expected = "an edge of 0.0001 m makes about 2147483648 triangles, at most 8388608 may be: \
                    2.87e-3 m would fit";
    assert_eq!((faults[0].field, &faults[0].message[..]), ("edge", expected));
    let faults =
        displace(octahedron(), settings(&flat, 0.1, 1e-300), Shading::Keep, &Patience::endless());
    assert!(faults.unwrap_err()[0].message.contains("far too many triangles"));
    for edge in [1e-3, 0.011, 0.04] {
        let refused = tessellate(octahedron(), edge, 10_000, &Patience::endless()).unwrap_err();
        let made = tessellate(octahedron(), refused.fits.unwrap(), 10_000, &Patience::endless())
            .unwrap()
            .triangles
            .len();
        // Halving makes steps of four.
        assert!((1_000..=10_000).contains(&made), "{refused:?}: {made}");
    }
    assert!(tessellate(octahedron(), 0.5, 7, &Patience::endless()).unwrap_err().fits.is_none());
    let bad = Heights(|_| f32::NAN);
    let faults =
        displace(octahedron(), settings(&bad, 0.1, 1.0), Shading::Keep, &Patience::endless())
            .unwrap_err();
    assert_eq!(faults[0].field, "displace");
}

#[test]
fn displacing_ends_soon_after_it_is_not_wanted_any_more() {
    let bumps = Heights(|p| p.uv.x);
    for smooth in [Shading::Keep, Shading::Smooth, Shading::Flat] {
        let looks = |edge| {
            let settings = || settings(&bumps, 0.1, edge);
            ends_wherever(|patience| {
                let net = Net { normals: vec![], ..torn() };
                let net = displace(net, settings(), smooth, patience)?;
                net.into_mesh(false, patience).map_err(|told| vec![Fault::mesh("file", told)])
            })
        };
        // Not only between the steps.
        let (few, many) = (looks(0.4), looks(0.06));
        assert!(many > 2 * few, "{smooth:?}: {few} looks for a coarse net, {many} for a fine one");
    }
}
