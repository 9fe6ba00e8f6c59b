mod marched;

use std::f64::consts::TAU;

use luxel_sdk::num::{gamma64, offset_origin, sphere_roots};
use luxel_sdk::sampling::Rng;

use super::*;
use crate::shape::r#box::Box;
use crate::shape::sphere::Sphere;
use crate::shape::testing::direction;

const OPS: [Op; 3] = [Op::Union, Op::Intersection, Op::Difference];

fn pair<'s, A: Shape, B: Shape>(op: Op, a: &'s A, b: &'s B, smooth: f64) -> Solid<'s> {
    let (a, b) = (ShapeRef::new(a), ShapeRef::new(b));
    Pair::check(op, &a, &b, smooth).unwrap();
    let bounds = Pair::found_bounds(op, &a, &b, smooth);
    Solid(Pair { op, a, b, smooth, bounds, plain: Pair::found_plain(&a, &b) })
}

/// A pair as a shape, so that it may be a part.
struct Solid<'s>(Pair<'s>);

impl Shape for Solid<'_> {
    fn bounds(&self) -> Bounds3 {
        self.0.bounds
    }
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.0.intersect(ray)
    }
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.0.surface(ray, hit)
    }
    fn area(&self) -> f64 {
        self.0.area()
    }
    fn is_closed(&self) -> bool {
        true
    }
    fn distance(&self, p: DVec3) -> Option<f64> {
        self.0.distance(p)
    }
    fn normal_derivatives(&self, hit: &Hit, at: &Surface) -> Option<NormalDerivatives> {
        self.0.normal_derivatives(hit, at)
    }
}

/// Every crossing, each found by a ray that leaves the last one.
fn crossings(shape: &dyn Shape, ray: &Ray) -> Vec<Surface> {
    let (mut o, mut found) = (ray.o, vec![]);
    while let Some(hit) = shape.intersect(&Ray::new(o, ray.d)) {
        let s = shape.surface(&Ray::new(o, ray.d), &hit);
        o = offset_origin(s.p, s.p_err, s.ng, ray.d);
        found.push(s);
        assert!(found.len() < 50, "{ray:?} does not come to an end");
    }
    found
}

/// Entries and exits in turn, and points between them inside and outside by their distance.
fn check_crossings(shape: &dyn Shape, rays: u32, seed: u64) {
    let mut rng = Rng::new(seed);
    let bounds = shape.bounds();
    let (centre, size) = (bounds.centre(), bounds.diagonal().length());
    let mut n_hits = 0;
    for i in 0..rays {
        let d = direction(&mut rng);
        let target = centre + direction(&mut rng) * (0.4 * size * rng.f64());
        let far = [1.0, 3.0, 1e3][i as usize % 3] * size;
        let ray = Ray::new(target - d * far, d * [1e-6, 1.0, 1e6][i as usize / 3 % 3]);
        let found = crossings(shape, &ray);
        if found.iter().any(|s| s.ng.dot(d).abs() < 1e-5) {
            continue;
        }
        assert!(found.len().is_multiple_of(2), "{ray:?}: {found:?}");
        for (k, s) in found.iter().enumerate() {
            assert_eq!(s.ng.dot(d) < 0.0, k % 2 == 0, "{ray:?}: {found:?}");
            let off = shape.distance(s.p).unwrap().abs();
            let slack = s.p_err.max_element() * 2.0 + gamma64(64) * (far + size);
            assert!(off <= slack, "{off} beyond {slack}");
            n_hits += 1;
        }
        for (k, ends) in found.windows(2).enumerate() {
            let middle = 0.5 * (ends[0].p + ends[1].p);
            let apart = ends[0].p.distance(ends[1].p);
            if apart > 1e-6 * size {
                let f = shape.distance(middle).unwrap();
                assert_eq!(f < 0.0, k % 2 == 0, "{ray:?}: {f} at {middle}");
            }
        }
    }
    assert!(n_hits > rays / 4, "{n_hits} hits");
}

fn ball(x: f64, y: f64, radius: f64) -> Sphere {
    Sphere { center: DVec3::new(x, y, 0.0), radius }
}

#[test]
fn two_spheres_are_crossed_where_their_chords_say() {
    let mut rng = Rng::new(81);
    for (scale, place) in [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)] {
        let at = |x: f64| DVec3::new(x * scale, 0.1 * scale, 0.0) + DVec3::splat(place);
        let a = Sphere { center: at(0.0), radius: scale };
        let b = Sphere { center: at(0.9), radius: 0.8 * scale };
        let mut checked = 0;
        for _ in 0..2000 {
            let d = direction(&mut rng);
            let target = a.center + direction(&mut rng) * (1.5 * scale * rng.f64());
            let o = target - d * (4.0 * scale);
            let chord = |s: &Sphere| {
                sphere_roots(o - s.center, d, s.radius).unwrap_or((f64::INFINITY, f64::INFINITY))
            };
            let (ca, cb) = (chord(&a), chord(&b));
            let mut ends = vec![ca.0, ca.1, cb.0, cb.1];
            ends.retain(|t| t.is_finite());
            ends.sort_by(f64::total_cmp);
            let near = ends.windows(2).any(|w| w[1] - w[0] < 1e-4 * scale);
            if near {
                continue;
            }
            for op in OPS {
                let inside = |t: f64| op.holds(ca.0 < t && t < ca.1, cb.0 < t && t < cb.1);
                let step = 1e-5 * scale;
                let truth: Vec<f64> =
                    ends.iter().copied().filter(|t| inside(t - step) != inside(t + step)).collect();
                let found = crossings(&pair(op, &a, &b, 0.0), &Ray::new(o, d));
                assert_eq!(found.len(), truth.len(), "{op:?}");
                for (s, t) in found.iter().zip(truth) {
                    let off = ((s.p - o).dot(d) - t).abs() * s.ng.dot(d).abs();
                    assert!(off <= 64.0 * f64::EPSILON * (8.0 * scale + 2.0 * place), "{off}");
                    checked += 1;
                }
            }
        }
        assert!(checked > 3000, "{checked}");
    }
}

#[test]
fn solids_of_solids_are_entered_and_left_in_turn() {
    let block = Box { center: DVec3::ZERO, size: DVec3::new(2.0, 1.0, 1.5) };
    let (hole, knob, far) = (ball(0.3, 0.5, 0.6), ball(-0.9, 0.4, 0.5), ball(0.0, 0.0, 1.05));
    let carved = pair(Op::Difference, &block, &hole, 0.0);
    let more = pair(Op::Union, &carved, &knob, 0.0);
    check_crossings(&carved, 3000, 82);
    check_crossings(&more, 3000, 83);
    check_crossings(&pair(Op::Intersection, &more, &far, 0.0), 3000, 84);
    check_crossings(&pair(Op::Difference, &far, &more, 0.0), 3000, 85);
    // The face tells the way down: b of a of the whole.
    let whole = pair(Op::Union, &carved, &far, 0.0);
    let inner = Ray::new(DVec3::new(0.3, 0.2, 0.0), DVec3::NEG_Y);
    assert_eq!(carved.intersect(&inner).unwrap().face, 1);
    assert!(whole.intersect(&inner).unwrap().face % 2 == 1, "the ball holds it");
}

#[test]
fn the_area_of_a_lens_is_that_of_its_caps() {
    let (a, b) = (ball(-0.6, 0.0, 1.0), ball(0.6, 0.0, 1.0));
    let lens = pair(Op::Intersection, &a, &b, 0.0);
    let caps = 2.0 * TAU * 0.4;
    assert!((lens.area() / caps - 1.0).abs() < 3e-3, "{} {caps}", lens.area());
    let both = pair(Op::Union, &a, &b, 0.0).area();
    assert!((both / (4.0 * TAU - caps) - 1.0).abs() < 3e-3, "{both}");
    // Edge to edge as far as the circle in which both meet, 0.8 in radius.
    let edge = lens.0.bounds.max;
    assert!((edge.x - 0.4).abs() < 1e-14 && edge.y >= 0.8);
}

#[test]
fn faces_that_lie_in_each_other_leave_neither_skins_nor_walls() {
    for scale in [1.0, 1e-6, 1e6] {
        let block = |x: f64, size: DVec3| Box {
            center: DVec3::new(x, 0.1, -0.3) * scale,
            size: size * scale,
        };
        let (left, right) = (block(-0.5, DVec3::ONE), block(0.5, DVec3::ONE));
        let beam = pair(Op::Union, &left, &right, 0.0);
        let mut rng = Rng::new(86);
        for _ in 0..2000 {
            let d = direction(&mut rng);
            let target = DVec3::new(0.0, rng.f64() - 0.4, rng.f64() - 0.8) * (0.99 * scale);
            let found = crossings(&beam, &Ray::new(target - d * (3.0 * scale), d));
            assert_eq!(found.len(), 2, "{d}: {found:?}");
        }
        // A tenth cut away from the top, up to where the top is.
        let cut = Box { center: left.center, size: DVec3::new(0.5, 1.0, 0.5) * scale };
        let pipe = pair(Op::Difference, &left, &cut, 0.0);
        let nothing = pair(Op::Difference, &left, &left, 0.0);
        let same = pair(Op::Union, &left, &left, 0.0);
        for _ in 0..2000 {
            let d = direction(&mut rng);
            let inside = DVec3::new(rng.f64() - 0.5, 0.0, rng.f64() - 0.5) * (0.49 * scale);
            let o = left.center + inside + DVec3::Y * (2.0 * scale);
            assert_eq!(crossings(&pipe, &Ray::new(o, DVec3::NEG_Y)).len(), 0, "{o}");
            let ray = Ray::new(left.center + inside - d * (3.0 * scale), d);
            assert_eq!(crossings(&nothing, &ray).len(), 0);
            assert_eq!(crossings(&same, &ray).len(), 2);
        }
    }
}

/// Two balls that overlap, as one shape with all of their crossings.
struct Twins([Sphere; 2]);

impl Shape for Twins {
    fn bounds(&self) -> Bounds3 {
        self.0[0].bounds().union(self.0[1].bounds())
    }
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        let hit = |i: usize| Some(Hit { face: u32::from(i == 1), ..self.0[i].intersect(ray)? });
        [hit(0), hit(1)].into_iter().flatten().min_by(|a, b| a.t.total_cmp(&b.t))
    }
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.0[hit.face as usize].surface(ray, hit)
    }
    fn area(&self) -> f64 {
        f64::INFINITY
    }
    fn is_closed(&self) -> bool {
        true
    }
}

#[test]
fn a_part_that_crosses_itself_is_what_is_inside_of_any_of_its_pieces() {
    let twins = Twins([ball(-0.3, 0.0, 0.6), ball(0.3, 0.1, 0.5)]);
    let block = Box { center: DVec3::Y * 0.4, size: DVec3::new(3.0, 0.8, 0.7) };
    let joined = pair(Op::Union, &twins.0[0], &twins.0[1], 0.0);
    let mut rng = Rng::new(89);
    for op in OPS {
        let solids = [pair(op, &twins, &block, 0.0), pair(op, &block, &twins, 0.0)];
        let truths = [pair(op, &joined, &block, 0.0), pair(op, &block, &joined, 0.0)];
        let mut n = 0;
        for i in 0..3000 {
            let d = direction(&mut rng);
            // From without, from within and from the overlap.
            let far = [4.0, 0.0, 0.5][i % 3];
            let o = direction(&mut rng) * (0.6 * rng.f64()) - d * far;
            for (solid, truth) in solids.iter().zip(&truths) {
                let (found, truth) =
                    (crossings(solid, &Ray::new(o, d)), crossings(truth, &Ray::new(o, d)));
                assert_eq!(found.len(), truth.len(), "{op:?}: {o} {d}");
                for (found, truth) in found.iter().zip(&truth) {
                    assert!(found.p.distance(truth.p) < 1e-12, "{op:?}: {o} {d}");
                    assert!(found.ng.distance(truth.ng) < 1e-12, "{op:?}: {o} {d}");
                }
                n += found.len();
            }
        }
        assert!(n > 3000, "{n}");
    }
}

#[test]
fn a_ray_that_touches_one_part_is_not_inside_of_it_before() {
    let (a, b) = (ball(0.0, 0.0, 2.0), ball(3.0, 0.0, 0.5));
    let ray = Ray::new(DVec3::new(-9.0, 0.3, 0.4), DVec3::X);
    let hit = pair(Op::Union, &a, &b, 0.0).intersect(&ray).unwrap();
    assert!(hit.t < 9.0, "{hit:?}");
}

#[test]
fn a_ray_that_starts_inside_meets_the_inner_side() {
    let (a, b) = (ball(0.0, 0.0, 1.0), ball(1.0, 0.0, 1.0));
    for (op, t, n) in [
        (Op::Union, 1.5, DVec3::X),
        (Op::Intersection, 0.5, DVec3::X),
        (Op::Difference, f64::INFINITY, DVec3::X),
    ] {
        let solid = pair(op, &a, &b, 0.0);
        let ray = Ray::new(DVec3::X * 0.5, DVec3::X);
        let hit = solid.intersect(&ray);
        assert!((hit.map_or(f64::INFINITY, |hit| hit.t) - t).abs() <= 1e-15 || t.is_infinite());
        assert_eq!(hit.is_none(), t.is_infinite(), "{op:?}");
        if let Some(hit) = hit {
            assert!((solid.surface(&ray, &hit).ng - n).length() < 1e-15);
            assert!(solid.intersect(&Ray { t_max: t - 1e-9, ..ray }).is_none());
        }
    }
    // From the crescent into what was cut away: its normal is turned.
    let crescent = pair(Op::Difference, &a, &b, 0.0);
    let ray = Ray::new(DVec3::X * -0.5, DVec3::X);
    let hit = crescent.intersect(&ray).unwrap();
    assert!((hit.t - 0.5).abs() < 1e-15 && hit.face == 1);
    assert!((crescent.surface(&ray, &hit).ng - DVec3::X).length() < 1e-15);
}

/// Snell's law in vectors: `n` points against `d`, both unit.
fn bent(d: DVec3, n: DVec3, eta: f64) -> DVec3 {
    let cos = -d.dot(n);
    let rest = 1.0 - (1.0 - cos * cos) / (eta * eta);
    d / eta + n * (cos / eta - rest.sqrt())
}

#[test]
fn a_lens_of_two_spheres_has_the_focal_length_of_the_lensmakers_equation() {
    let (index, radius, half) = (1.5, 1.0, 0.05);
    let at = |z: f64| Sphere { center: DVec3::Z * z, radius };
    let (front, back) = (at(radius - half), at(half - radius));
    let lens = pair(Op::Intersection, &front, &back, 0.0);
    assert!(lens.is_closed());
    let thick = 2.0 * half;
    let power = (index - 1.0) * (2.0 / radius - (index - 1.0) * thick / (index * radius * radius));
    // From the back vertex to the focus.
    let behind = (1.0 - (index - 1.0) * thick / (index * radius)) / power;
    let height = 1e-4;
    let mut ray = Ray::new(DVec3::new(height, 0.0, -3.0), DVec3::Z);
    for eta in [index, 1.0 / index] {
        let s = lens.surface(&ray, &lens.intersect(&ray).unwrap());
        let n = if s.ng.dot(ray.d) < 0.0 { s.ng } else { -s.ng };
        let d = bent(ray.d, n, eta);
        ray = Ray::new(offset_origin(s.p, s.p_err, s.ng, d), d);
    }
    assert!(lens.intersect(&ray).is_none());
    let focus = ray.o.z - ray.o.x * ray.d.z / ray.d.x;
    // Spherical aberration grows with the square of the height.
    assert!((focus - half - behind).abs() < 1e-7, "{focus} {behind}");
}

#[test]
fn blended_solids_are_crossed_in_turn_at_every_scale() {
    for (scale, place) in [(1.0, 0.0), (1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)] {
        let at = |x: f64| DVec3::new(x, 0.2, 0.0) * scale + DVec3::splat(place);
        let a = Sphere { center: at(0.0), radius: scale };
        let b = Box { center: at(0.8), size: DVec3::new(0.9, 1.5, 1.1) * scale };
        for op in OPS {
            check_crossings(&pair(op, &a, &b, 0.3 * scale), 300, 87);
        }
    }
}

#[test]
fn a_blend_lies_between_the_sharp_solid_and_a_quarter_of_its_width() {
    let (a, b) = (ball(-0.7, 0.0, 1.0), ball(0.7, 0.0, 1.0));
    let blend = pair(Op::Union, &a, &b, 0.4);
    // Midway both are as far: the waist is where √(0.7² + y²) − 1 is a quarter of the blend.
    let ray = Ray::new(DVec3::Y * 3.0, DVec3::NEG_Y);
    let s = blend.surface(&ray, &blend.intersect(&ray).unwrap());
    let waist = (1.1f64 * 1.1 - 0.49).sqrt();
    assert!((s.p.y - waist).abs() <= 1e-13 && s.ng.y > 1.0 - 1e-9, "{} {waist}", s.p.y);
    // Far from the other the ball is what it was.
    let ray = Ray::new(DVec3::X * -9.0, DVec3::X);
    assert!((blend.intersect(&ray).unwrap().t - 7.3).abs() <= 1e-13);
}

#[test]
fn distances_change_by_no_more_than_the_way() {
    let (a, b) = (ball(0.0, 0.0, 1.0), Box { center: DVec3::ONE, size: DVec3::splat(1.5) });
    let mut rng = Rng::new(88);
    for op in OPS {
        for smooth in [0.0, 0.3, 2.0] {
            let solid = pair(op, &a, &b, smooth);
            for _ in 0..5000 {
                let p = direction(&mut rng) * (3.0 * rng.f64());
                let q = p + direction(&mut rng) * 10f64.powf(-6.0 * rng.f64());
                let change = (solid.distance(p).unwrap() - solid.distance(q).unwrap()).abs();
                assert!(change <= p.distance(q) + 1e-15, "{op:?} {smooth}: {p} {q}");
            }
        }
    }
}

/// A sphere that says that it is open.
struct Sheet(Sphere);

impl Shape for Sheet {
    fn bounds(&self) -> Bounds3 {
        self.0.bounds()
    }
    fn intersect(&self, ray: &Ray) -> Option<Hit> {
        self.0.intersect(ray)
    }
    fn surface(&self, ray: &Ray, hit: &Hit) -> Surface {
        self.0.surface(ray, hit)
    }
    fn area(&self) -> f64 {
        self.0.area()
    }
}

#[test]
fn parts_that_cannot_be_joined_are_told() {
    let a = ball(0.0, 0.0, 1.0);
    let open = Sheet(a);
    let refs = (ShapeRef::new(&a), ShapeRef::new(&open));
    let fault = Pair::check(Op::Union, &refs.0, &refs.1, 0.0).unwrap_err();
    assert!(fault.field == "b" && fault.message.contains("encloses no volume"), "{fault:?}");
    let far = ball(5.0, 0.0, 1.0);
    let apart = Pair::check(Op::Intersection, &refs.0, &ShapeRef::new(&far), 0.0).unwrap_err();
    assert!(apart.message.contains("too far apart"));
    let wrong = Pair::check(Op::Union, &refs.0, &refs.0, -1.0).unwrap_err();
    assert_eq!(wrong.field, "smooth");
}
