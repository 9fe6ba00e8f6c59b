//! The mesh tree against brute force, and its edges.

use glam::{DVec3, Vec3};

use super::soup::{Arrays, BruteForce, Rng, icosphere, soup};
use super::{BuildError, MeshBvh, MeshHit, Precision};

const FAR: f32 = f32::INFINITY;

fn build((points, indices): &Arrays) -> MeshBvh {
    MeshBvh::build(points, indices).unwrap()
}

/// Shoots `n` rays at the tree and at the list; every number of every answer must be the same.
fn check(
    arrays: &Arrays,
    n: usize,
    rng: &mut Rng,
    mut length: impl FnMut(&mut Rng) -> f32,
) -> usize {
    let (tree, list) = (build(arrays), BruteForce::new(arrays));
    let mut hits = 0;
    for _ in 0..n {
        let (o, d) = (rng.point() * 2.0, rng.point());
        let d = d * length(rng);
        let t_max = if rng.next() < 0.5 { FAR } else { rng.next() * 2.0 / d.length() };
        let expected = list.intersect(o, d, t_max);
        assert_eq!(tree.hit(o, d, t_max), expected, "o {o} d {d} t_max {t_max}");
        assert_eq!(tree.is_hit(o, d, t_max), expected.is_some());
        let (counted, steps) = tree.shoot(o, d, t_max);
        assert_eq!(counted, expected);
        assert!(steps > 0);
        hits += usize::from(expected.is_some());
    }
    hits
}

#[test]
fn soups_of_every_size_agree_with_brute_force() {
    let mut rng = Rng(1);
    for n in [1, 2, 3, 4, 5, 8, 9, 17, 64, 257, 900] {
        for size in [0.02, 0.2, 1.0] {
            check(&soup(n, size, &mut rng), 150, &mut rng, |_| 1.0);
        }
    }
}

#[test]
fn direction_length_changes_nothing_over_twelve_decades() {
    let mut rng = Rng(2);
    let arrays = soup(200, 0.3, &mut rng);
    let hits = check(&arrays, 2000, &mut rng, |rng| 10f32.powf(rng.next() * 12.0 - 6.0));
    assert!(hits > 200, "{hits}");
}

/// Scaled to a mesh of 1e18, products of what measures 0.01 underflow, and products of these with distances do
/// where it measures 1000.
#[test]
fn a_small_part_of_an_enormous_mesh_is_met_where_it_is() {
    let mut rng = Rng(12);
    for radius in [1e-6, 0.01, 10.0, 1000.0, 1e6] {
        let (mut points, indices) = icosphere(2, radius);
        points.push(Vec3::splat(1e18));
        let tree = build(&(points, indices));
        let mut shot = |distance: f32| {
            let o = Vec3::new(-distance, 0.5 * radius * rng.next(), 0.5 * radius * rng.next());
            assert!(tree.is_hit(o, Vec3::X, FAR), "{o}");
            tree.hit(o, Vec3::X, FAR).expect("the ball is closed").t
        };
        for _ in 0..500 {
            // Its front is met, which lies within a radius of its centre.
            let near = shot(3.0 * radius) / f64::from(radius);
            assert!((2.0 * (1.0 - ROUNDINGS)..3.0).contains(&near), "{radius} {near}");
            let error = (shot(1e12) / f64::from(1e12_f32) - 1.0).abs();
            assert!(error <= ROUNDINGS + f64::from(radius) / 1e12, "{radius} {error}");
        }
    }
}

/// What rounding adds to a distance at most, relative: in a row an edge, its product, two sums, the quotient by
/// the sum of the edges, which has two, and the product with the length of the direction are rounded.
const ROUNDINGS: f64 = 8.0 * (f32::EPSILON / 2.0) as f64;

#[test]
fn parameter_scales_with_direction_even_at_the_ends_of_f32() {
    let tree = build(&icosphere(1, 1.0));
    let d = Vec3::new(0.5, 0.25, 0.125);
    let one = tree.hit(Vec3::ZERO, d, FAR).unwrap();
    for exponent in [-120, -60, -30, 30, 60, 120] {
        let k = 2f32.powi(exponent);
        let hit = tree.hit(Vec3::ZERO, d * k, FAR).unwrap();
        assert_eq!(hit, MeshHit { t: one.t / f64::from(k), ..one });
    }
}

#[test]
fn zero_components_of_either_sign_agree_with_brute_force() {
    let mut rng = Rng(3);
    // Points on a coarse grid put origins into the planes of boxes.
    let (mut points, indices) = soup(120, 0.5, &mut rng);
    for p in &mut points {
        *p = (*p * 4.0).round() / 4.0;
    }
    let (tree, list) =
        (build(&(points.clone(), indices.clone())), BruteForce::new(&(points, indices)));
    let parts = [0.0, -0.0, 1.0, -1.0];
    for i in 0..4000 {
        let o = (rng.point() * 6.0).round() / 4.0;
        let d = Vec3::new(parts[i % 4], parts[i / 4 % 4], parts[i / 16 % 4]);
        assert_eq!(tree.hit(o, d, FAR), list.intersect(o, d, FAR), "o {o} d {d}");
    }
}

#[test]
fn distance_and_barycentrics_are_as_good_as_the_precision_says() {
    let single = f64::from(f32::EPSILON) / 2.0;
    for (precision, u) in [(Precision::Standard, single), (Precision::Exact, f64::EPSILON / 2.0)] {
        let mut rng = Rng(4);
        let arrays = soup(300, 0.3, &mut rng);
        let tree = build(&arrays);
        let mut hits = 0;
        for _ in 0..3000 {
            let (o, d) = (rng.point(), rng.point());
            let Some(hit) = tree.shoot_with(precision, o, d, FAR).0 else { continue };
            let corners = arrays.1[hit.triangle as usize];
            let [a, b, c] = corners.map(|i| arrays.0[i as usize].as_dvec3());
            let on_triangle = a * (1.0 - hit.b1 - hit.b2) + b * hit.b1 + c * hit.b2;
            let on_ray = o.as_dvec3() + d.as_dvec3() * hit.t;
            let n = (b - a).cross(c - a);
            // The shear moves each vertex by at most 7u·(|o| + |p|) < 7u·2.3·√3 in the plane across
            // the ray's main axis; a shift s across moves the hit along the ray by s·tan of
            // incidence, and the weights of a triangle of height h by s/h, that is the point by s
            // times its aspect.
            let cos = (n.dot(d.as_dvec3()) / (n.length() * d.as_dvec3().length())).abs();
            let height = n.length() / (b - a).length().max((c - a).length()).max((c - b).length());
            let bound = 7.0 * u * 2.3 * 3.0 / cos * (1.0 + 0.6 / height);
            let error = (on_triangle - on_ray).length();
            assert!(error < bound, "{precision:?}: {on_triangle} {on_ray} {bound:e}");
            hits += 1;
        }
        assert!(hits > 500, "{hits}");
    }
}

#[test]
fn every_precision_meets_the_same_triangles_away_from_edges() {
    let mut rng = Rng(41);
    let arrays = soup(300, 0.3, &mut rng);
    let tree = build(&arrays);
    let (mut hits, mut inner) = (0, 0);
    for _ in 0..3000 {
        let (o, d) = (rng.point(), rng.point());
        let [fast, standard, exact] =
            Precision::ALL.map(|precision| tree.shoot_with(precision, o, d, FAR).0);
        let Some(hit) = exact else { continue };
        hits += 1;
        // Single precision shifts by less than 7u·2.3·√3 < 2e-6, and weights by that over the height
        // of the triangle: far less than this for heights above 1e-3.
        if hit.b1.min(hit.b2).min(1.0 - hit.b1 - hit.b2) > 0.05 && hit.t > 0.05 {
            inner += 1;
            let triangle = |hit: Option<MeshHit>| hit.map(|hit| hit.triangle);
            assert_eq!(triangle(standard), Some(hit.triangle));
            assert_eq!(triangle(fast), Some(hit.triangle));
        }
    }
    assert!(inner > 300 && hits > inner, "{inner} of {hits}");
}

#[test]
fn twenty_thousand_identical_triangles_give_the_first_in_few_steps() {
    let points = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let tree = build(&(points, vec![[0, 1, 2]; 20_000]));
    let (hit, steps) = tree.shoot(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z, FAR);
    assert_eq!(hit.unwrap().triangle, 0);
    // All must be looked at, four at a time, and a third as many nodes again.
    assert!(steps < 20_000, "{steps}");
    assert!(!tree.is_hit(Vec3::new(0.6, 0.6, 1.0), Vec3::NEG_Z, FAR));
}

#[test]
fn nearly_equal_boxes_do_not_make_a_chain() {
    // Nested triangles with one centre each a rounding away from the next, and growing ones.
    let nested = |i: u32| {
        let r = 1.0 + i as f32 * f32::EPSILON * 4.0;
        [Vec3::new(-r, -r, 0.0), Vec3::new(r, -r, 0.0), Vec3::new(0.0, r, r * 1e-3)]
    };
    let grown = |i: u32| {
        let r = 1.01f32.powi(i32::try_from(i).unwrap());
        [Vec3::new(r, 0.0, 0.0), Vec3::new(r, r * 0.1, 0.0), Vec3::new(r, 0.0, r * 0.1)]
    };
    for (n, make) in [(6000, &nested as &dyn Fn(u32) -> [Vec3; 3]), (6000, &grown)] {
        let points: Vec<Vec3> = (0..n).flat_map(make).map(|p| p.min(Vec3::splat(1e30))).collect();
        let indices = (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let arrays = (points, indices);
        let tree = build(&arrays);
        let o = Vec3::new(0.5, 0.01, 0.001);
        let hit = tree.hit(o, Vec3::new(0.5, 0.01, 0.02), FAR);
        assert_eq!(hit, BruteForce::new(&arrays).intersect(o, Vec3::new(0.5, 0.01, 0.02), FAR));
    }
}

#[test]
fn flat_mesh_is_hit_everywhere_and_nowhere_beside() {
    let n = 40u32;
    let points: Vec<Vec3> =
        (0..=n).flat_map(|y| (0..=n).map(move |x| Vec3::new(x as f32, 0.0, y as f32))).collect();
    let at = |x, y| y * (n + 1) + x;
    let mut indices = Vec::new();
    for y in 0..n {
        for x in 0..n {
            indices.push([at(x, y), at(x + 1, y), at(x, y + 1)]);
            indices.push([at(x + 1, y + 1), at(x, y + 1), at(x + 1, y)]);
        }
    }
    let tree = build(&(points, indices));
    for i in 0..=400 {
        for j in 0..=400 {
            let o = Vec3::new(i as f32 * 0.1, 3.0, j as f32 * 0.1).min(Vec3::splat(n as f32));
            let hit = tree.hit(o, Vec3::new(0.0, -2.0, -0.0), FAR).unwrap();
            assert!((hit.t - 1.5).abs() <= f64::from(f32::EPSILON) * 4.0, "{o} {hit:?}");
        }
    }
    assert_eq!(tree.hit(Vec3::new(-1.0, 0.0, 3.5), Vec3::X, FAR), None, "within the plane");
    assert!(!tree.is_hit(Vec3::new(40.1, 1.0, 3.0), Vec3::NEG_Y, FAR));
}

#[test]
fn huge_and_tiny_together_are_both_hit() {
    let (mut points, mut indices) = icosphere(6, 1e-3);
    let n_tiny = u32::try_from(indices.len()).unwrap();
    let base = u32::try_from(points.len()).unwrap();
    let room = 1e6;
    points.extend([
        Vec3::new(-room, -1.0, -room),
        Vec3::new(room, -1.0, -room),
        Vec3::new(0.0, -1.0, room),
    ]);
    indices.push([base, base + 1, base + 2]);
    let tree = build(&(points, indices));
    let down = tree.hit(Vec3::new(1.0, 0.0, 0.0), Vec3::NEG_Y, FAR).unwrap();
    assert_eq!((n_tiny, down.triangle), (81_920, n_tiny));
    let ball = tree.hit(Vec3::new(1.0, 0.0, 0.0), Vec3::NEG_X, FAR).unwrap();
    assert!(ball.triangle < n_tiny);
}

#[test]
fn coincident_faces_give_the_lowest_index_from_both_sides() {
    let (points, faces) = icosphere(2, 1.0);
    let twice: Vec<[u32; 3]> = faces.iter().chain(&faces).copied().collect();
    let (once, twice) = (build(&(points.clone(), faces)), build(&(points, twice)));
    let mut rng = Rng(6);
    for _ in 0..3000 {
        let (o, d) = (rng.point() * 2.0, rng.point());
        assert_eq!(twice.hit(o, d, FAR), once.hit(o, d, FAR));
    }
}

#[test]
fn limit_is_included_and_the_origin_is_not() {
    let points = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(3.0, -1.0, 0.0), Vec3::new(-1.0, 3.0, 0.0)];
    let tree = MeshBvh::build(&points, &[[0, 1, 2]]).unwrap();
    let o = Vec3::new(0.0, 0.0, 2.0);
    assert_eq!(tree.hit(o, Vec3::NEG_Z, 2.0).unwrap().t.to_bits(), 2f64.to_bits());
    assert!(tree.hit(o, Vec3::NEG_Z, 2f32.next_down()).is_none());
    assert!(tree.hit(Vec3::ZERO, Vec3::NEG_Z, FAR).is_none());
    assert!(tree.hit(o, Vec3::Z, FAR).is_none());
}

#[test]
fn rays_that_are_not_finite_hit_nothing() {
    let tree = build(&icosphere(1, 1.0));
    for bad in [f32::NAN, FAR, -FAR] {
        assert_eq!(tree.hit(Vec3::ZERO, Vec3::new(1.0, bad, 0.0), FAR), None);
        assert_eq!(tree.hit(Vec3::new(bad, 0.0, 0.0), Vec3::X, FAR), None);
    }
    assert_eq!(tree.hit(Vec3::ZERO, Vec3::ZERO, FAR), None);
    for t_max in [f32::NAN, 0.0, -1.0, -FAR] {
        assert_eq!(tree.hit(Vec3::ZERO, Vec3::X, t_max), None);
    }
    assert!(tree.is_hit(Vec3::ZERO, Vec3::X, f32::MAX));
}

#[test]
fn nothing_to_hit_is_a_mesh_too() {
    let tree = MeshBvh::build(&[], &[]).unwrap();
    assert_eq!(tree.hit(Vec3::ZERO, Vec3::X, FAR), None);
    assert_eq!((tree.bounds(), tree.dropped(), tree.bytes()), (None, 0, 0));
}

#[test]
fn triangles_without_area_are_dropped_and_counted() {
    let points = [Vec3::ZERO, Vec3::X, Vec3::X * 2.0, Vec3::Y];
    let indices = [[0, 1, 2], [0, 0, 3], [0, 1, 3], [3, 3, 3]];
    let tree = MeshBvh::build(&points, &indices).unwrap();
    assert_eq!(tree.dropped(), 3);
    let hit = tree.hit(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z, FAR).unwrap();
    assert_eq!(hit.triangle, 2);
    assert_eq!(tree.bounds(), Some((Vec3::ZERO, Vec3::new(1.0, 1.0, 0.0))));
}

#[test]
fn broken_arrays_are_refused_with_their_place() {
    let mut points = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let outside = MeshBvh::build(&points, &[[0, 1, 2], [0, 3, 1]]).unwrap_err();
    assert_eq!(outside, BuildError::IndexOutOfRange { triangle: 1, index: 3, n_points: 3 });
    assert_eq!(outside.to_string(), "triangle 1 uses point 3, but there are 3 points");
    for bad in [f32::NAN, FAR] {
        points[2].y = bad;
        let broken = MeshBvh::build(&points, &[[0, 1, 2]]).unwrap_err();
        assert_eq!(broken, BuildError::NonFinitePoint { point: 2 });
        assert_eq!(broken.to_string(), "point 2 is not finite");
    }
}

#[test]
fn many_parts_agree_with_the_nearest_of_their_triangles() {
    // 20·4⁶ triangles are cut into more than forty parts before they are clustered.
    let arrays = icosphere(6, 3.0);
    let tree = build(&arrays);
    let mut rng = Rng(8);
    for _ in 0..5000 {
        let (o, d) = (rng.point(), rng.point());
        let hit = tree.hit(o, d, FAR).unwrap();
        let [a, b, c] = arrays.1[hit.triangle as usize].map(|i| arrays.0[i as usize].as_dvec3());
        let p = o.as_dvec3() + d.as_dvec3() * hit.t;
        let off = (b - a).cross(c - a).normalize().dot(p - a);
        // 7u·(|o| + |p|) across, seen at an incidence with cosine above 0.8: the origin is near.
        assert!(off.abs() < 7.0 * 2f64.powi(-24) * 5.0 / 0.8, "{off:e}");
        assert!(p.length() <= 3.0 + 1e-5 && DVec3::ZERO.distance(p) > 2.99);
    }
    assert!(tree.bytes() < 90 * arrays.1.len(), "{}", tree.bytes());
}

#[test]
fn equal_input_gives_an_equal_tree() {
    let arrays = icosphere(5, 1.0);
    let text = |tree: &MeshBvh| format!("{tree:?}");
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(one.install(|| text(&build(&arrays))), text(&build(&arrays)));
}
