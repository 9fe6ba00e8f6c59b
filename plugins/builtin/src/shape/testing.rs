//! What the tests of every analytic shape ask: hits, offsets, densities.

use glam::{DVec2, DVec3};
use luxel_sdk::kind::{Shape, Surface};
use luxel_sdk::num::{Moments, Ray, gamma64, offset_origin};
use luxel_sdk::sampling::{Rng, uniform_sphere};

pub(super) fn direction(rng: &mut Rng) -> DVec3 {
    uniform_sphere(rng.pair()).as_dvec3().normalize()
}

/// Checks what holds at every point of a surface.
fn check_point(shape: &dyn Shape, at: &Surface) {
    assert!(shape.bounds().contains(at.p), "{} outside {:?}", at.p, shape.bounds());
    assert!((at.ng.length() - 1.0).abs() <= 8.0 * f64::EPSILON);
    assert!(at.p_err.cmpge(DVec3::ZERO).all() && at.p_err.is_finite());
    assert!(at.ns.dot(at.ng) > 0.0 && at.dp_du.length() > 0.0);
    let n = at.dp_du.cross(at.dp_dv).normalize();
    assert!(n.dot(at.ng) >= 1.0 - 1e-12, "{n} {}", at.ng);
}

/// Shoots rays at a surface that lies on one side of each of its tangent planes, and checks the
/// hits, their residual (m) against their stated error, and that no ray away from it returns.
pub(super) fn check_convex(shape: &dyn Shape, seed: u64, residual: impl Fn(DVec3) -> f64) {
    let mut rng = Rng::new(seed);
    let b = shape.bounds();
    let (centre, size) = (b.centre(), b.diagonal().length());
    let mut n_hits = 0;
    for i in 0..4000 {
        // Of thin shapes only what is aimed at is met.
        let target = match shape.sample(None, rng.pair()) {
            Some(s) if i / 6 % 2 == 0 => s.surface.p,
            _ => centre + direction(&mut rng) * (0.3 * size * f64::from(rng.f32())),
        };
        // From nearby and from 10⁴ sizes away, with directions from short to long.
        let far = if i % 2 == 0 { 1.5 } else { 1e4 };
        let o = centre + direction(&mut rng) * (far * size);
        let d = (target - o) * [1e-6, 1.0, 1e6][i % 3];
        let ray = Ray::new(o, d);
        let Some(hit) = shape.intersect(&ray) else { continue };
        n_hits += 1;
        let at = shape.surface(&ray, &hit);
        check_point(shape, &at);
        let miss = residual(at.p);
        let slack = at.p_err.dot(at.ng.abs()) + gamma64(4) * (at.p.abs().dot(at.ng.abs()));
        assert!(miss <= slack, "residual {miss} beyond {slack}");
        let along = (ray.at(hit.t) - at.p).length();
        assert!(along <= 1e-9 * far * size + gamma64(16) * o.length(), "{along} off the ray");
        check_cut(shape, &ray, hit.t);
        check_leaving(shape, &at, &mut rng);
    }
    assert!(n_hits > 400, "{n_hits} hits");
}

fn check_cut(shape: &dyn Shape, ray: &Ray, t: f64) {
    assert!(shape.intersect(&Ray { t_max: t, ..*ray }).is_some(), "a hit at t_max counts");
    assert!(shape.intersect(&Ray { t_max: t.next_down(), ..*ray }).is_none());
    assert!(shape.intersect(&Ray { t_max: f64::NAN, ..*ray }).is_none());
    assert!(shape.intersect(&Ray::new(ray.o, DVec3::NAN)).is_none());
    assert!(shape.intersect(&Ray::new(DVec3::NAN, ray.d)).is_none());
}

fn check_leaving(shape: &dyn Shape, at: &Surface, rng: &mut Rng) {
    for k in 0..4 {
        let mut d = direction(rng);
        if k == 3 {
            // Grazing: a millionth of a radian above the surface.
            d = d.cross(at.ng).normalize() + at.ng * 1e-6;
        }
        let out = if d.dot(at.ng) < 0.0 { -d } else { d };
        let o = offset_origin(at.p, at.p_err, at.ng, out);
        assert!(shape.intersect(&Ray::new(o, out)).is_none(), "{out} from {o} meets itself");
        let o = offset_origin(at.p, at.p_err, at.ng, -out);
        let inside = shape.intersect(&Ray::new(o, -out));
        assert_eq!(inside.is_some(), shape.is_closed(), "{} from {o}", -out);
    }
}

/// Checks how normals turn against those of hits beside a hit, and returns how many were compared.
///
/// Over a step of a hundred-thousandth of the size, central differences leave its square times a few
/// hundred, for parts as small as a twentieth; `blur` is what a normal itself may be off.
pub(super) fn check_turning(shape: &dyn Shape, seed: u64, blur: f64) -> u32 {
    let mut rng = Rng::new(seed);
    let b = shape.bounds();
    let (centre, size) = (b.centre(), b.diagonal().length());
    let step = 1e-5 * size;
    let mut n = 0;
    for _ in 0..600 {
        let d = direction(&mut rng);
        let ray = Ray::new(centre + direction(&mut rng) * (0.3 * size * rng.f64()) - d * size, d);
        let Some(hit) = shape.intersect(&ray) else { continue };
        let at = shape.surface(&ray, &hit);
        let Some(turns) = shape.normal_derivatives(&hit, &at) else { continue };
        let beside = |offset: DVec3| {
            let ray = Ray::new(ray.o + offset, d);
            let near = shape.surface(&ray, &shape.intersect(&ray)?);
            let same = near.p.distance(at.p) < 10.0 * step && near.ng.dot(at.ng) > 0.999;
            let seam = (near.uv - at.uv).abs().max_element() > 0.01;
            (same && !seam).then_some(near)
        };
        for across in <[DVec3; 2]>::from(d.any_orthonormal_pair()) {
            let (Some(a), Some(b)) = (beside(across * step), beside(across * -step)) else {
                continue;
            };
            // At the ends of strands coordinates say nothing of the place.
            if at.ng.dot(d).abs() < 0.3 || at.dp_du.length() < step {
                continue;
            }
            let moved = b.uv - a.uv;
            let told = turns.dn_du * moved.x + turns.dn_dv * moved.y;
            let off = (b.ns - a.ns - told).length();
            let slack = 1e-4 * told.length() + 1e-9 + blur;
            assert!(off <= slack, "{ray:?}: {hit:?}: {told}, not {}: {off:e}", b.ns - a.ns);
            n += 1;
        }
    }
    n
}

/// Checks that each sample lies on the shape and has the density that `pdf` states.
pub(super) fn check_sampling(shape: &dyn Shape, from: Option<DVec3>, seed: u64) {
    let mut rng = Rng::new(seed);
    let corner = 1.0f32.next_down();
    let corners = [[0.0, 0.0], [corner, 0.0], [0.0, corner], [corner, corner]];
    let scattered: Vec<_> = (0..500).map(|_| rng.pair()).collect();
    for u in corners.into_iter().chain(scattered) {
        let Some(s) = shape.sample(from, u) else { continue };
        check_point(shape, &s.surface);
        assert!(s.pdf > 0.0 && s.pdf.is_finite());
        let pdf = shape.pdf(from, &s.surface);
        assert!((pdf / s.pdf - 1.0).abs() <= 1e-12, "{pdf} {}", s.pdf);
    }
}

/// Mean of 1 / pdf: the area of the part of the surface that `sample` reaches.
pub(super) fn visible_area(shape: &dyn Shape, from: Option<DVec3>, n: u32, seed: u64) -> Moments {
    let mut rng = Rng::new(seed);
    let mut m = Moments::default();
    for _ in 0..n {
        m.push(shape.sample(from, rng.pair()).map_or(0.0, |s| s.pdf.recip()));
    }
    m
}

/// The solid angle (sr) of what faces `from`, by samples of the surface.
pub(super) fn solid_angle(shape: &dyn Shape, from: DVec3, n: u32, seed: u64) -> Moments {
    let mut rng = Rng::new(seed);
    let mut m = Moments::default();
    for _ in 0..n {
        m.push(shape.sample(Some(from), rng.pair()).map_or(0.0, |s| {
            let to = from - s.surface.p;
            let cos = (to.normalize().dot(s.surface.ng)).max(0.0);
            cos / (to.length_squared() * s.pdf)
        }));
    }
    m
}

/// Checks the solid angle by samples against that by rays in all directions.
pub(super) fn check_solid_angle(shape: &dyn Shape, from: DVec3, seed: u64) {
    let mut rng = Rng::new(seed);
    let mut rays = Moments::default();
    let full = 4.0 * std::f64::consts::PI;
    for _ in 0..100_000 {
        let ray = Ray::new(from, direction(&mut rng));
        let seen =
            shape.intersect(&ray).is_some_and(|hit| shape.surface(&ray, &hit).ng.dot(ray.d) < 0.0);
        rays.push(if seen { full } else { 0.0 });
    }
    let samples = solid_angle(shape, from, 100_000, seed + 1);
    let noise = rays.standard_error().hypot(samples.standard_error());
    assert!((rays.mean - samples.mean).abs() <= 5.0 * noise, "{} {}", rays.mean, samples.mean);
    assert!(rays.mean > 20.0 * noise, "too few rays hit to tell");
}

/// Where a body of revolution stands, to measure distances in the half plane through its axis.
pub(super) struct Profile {
    pub(super) base: DVec3,
    /// Unit.
    pub(super) axis: DVec3,
}

impl Profile {
    /// Distance from the axis, and height above the base.
    pub(super) fn flat(&self, p: DVec3) -> DVec2 {
        let q = p - self.base;
        let z = self.axis.dot(q);
        DVec2::new((q - self.axis * z).length(), z)
    }

    /// Distance to the nearest of the segments that are the outline.
    pub(super) fn distance(&self, p: DVec3, outline: &[(DVec2, DVec2)]) -> f64 {
        let q = self.flat(p);
        let to = |(a, b): &(DVec2, DVec2)| {
            let along = *b - *a;
            let part = ((q - *a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
            (q - (*a + along * part)).length()
        };
        outline.iter().map(to).fold(f64::INFINITY, f64::min)
    }
}

/// What marching along a ray finds.
enum March {
    Hit(f64),
    /// The least distance on the way.
    Miss(f64),
    /// Along the surface for too long to tell.
    Unknown,
}

/// Steps as long as the distance to the surface, until that is next to nothing. `d` is unit.
fn march(o: DVec3, d: DVec3, size: f64, distance: &impl Fn(DVec3) -> f64) -> March {
    let (mut t, mut least) = (0.0, f64::INFINITY);
    for _ in 0..20_000 {
        let gap = distance(o + d * t);
        least = least.min(gap);
        if gap <= 4.0 * f64::EPSILON * size {
            return March::Hit(t);
        }
        t += gap;
        if t > 8.0 * size {
            return March::Miss(least);
        }
    }
    March::Unknown
}

/// Checks hits against marching rays, by the exact `distance` to the surface: rays from inside and
/// from up to 10⁵ sizes away, along the axes with zeros of either sign, of any length, and cut.
pub(super) fn check_against(shape: &dyn Shape, seed: u64, distance: impl Fn(DVec3) -> f64) {
    let mut rng = Rng::new(seed);
    let b = shape.bounds();
    let size = b.diagonal().length();
    let (mut n_hits, mut unknown) = (0, 0);
    for i in 0..3000 {
        let scatter = direction(&mut rng) * (size * 10f64.powf(-8.0 * rng.f64()));
        let Some(s) = shape.sample(None, rng.pair()) else { continue };
        let target = s.surface.p + scatter;
        let d = match i % 5 {
            0 => DVec3::AXES[i / 5 % 3],
            1 => -DVec3::AXES[i / 5 % 3],
            _ => direction(&mut rng),
        };
        let far = [0.0, 2.0, 10.0, 1e3, 1e5][i / 3 % 5];
        let near = f64::min(far, 2.0) * size;
        let o = target - d * near;
        if distance(o) < 1e-6 * size {
            continue;
        }
        let length = [1e-6, 1.0, 1e6][i % 3];
        let ray = Ray::new(target - d * (far * size), d * length);
        let hit = shape.intersect(&ray);
        // What rounds: the ray's origin and its parameter, and the tracing itself.
        let slack = 64.0 * f64::EPSILON * (far + 4.0) * size;
        match march(o, d, size, &distance) {
            March::Unknown => unknown += 1,
            March::Miss(least) if least <= slack => unknown += 1,
            March::Miss(_) => assert!(hit.is_none(), "{ray:?}: {hit:?} where nothing is"),
            March::Hit(t) => {
                let hit = hit.unwrap_or_else(|| panic!("{ray:?} misses what it meets"));
                let at = shape.surface(&ray, &hit);
                let cos = at.ng.dot(d).abs();
                let off = (hit.t * length - (t + far * size - near)).abs();
                if cos >= 0.01 {
                    assert!(
                        off * cos <= slack,
                        "{ray:?}: t is off by {off} beyond {slack} / {cos}"
                    );
                    check_cut(shape, &ray, hit.t);
                    check_point(shape, &at);
                    n_hits += 1;
                }
            }
        }
    }
    assert!(n_hits > 400 && unknown < 100, "{n_hits} hits, {unknown} unknown");
}
