//! Shapes: hits, surfaces, areas, and points that are sampled as they say.

mod placed;
mod sampling;
mod turning;

use glam::DVec3;
use luxel_sdk::kind::{Hit, Shape, Surface, TriangleMesh};
use luxel_sdk::num::{Bounds3, Moments, Ray, offset_origin};
use luxel_sdk::sampling::{Rng, uniform_sphere};

use self::sampling::{LEAST_LINES, Sampling, effective};
use crate::report::Judge;
use crate::statistics::{deviation, mean_error};
use crate::subject::Subject;
use crate::sweep::Set;

/// The row of a shape of which no ray is asked.
const HITS: &str = "hits";

/// Crossings of one line with a shape that are followed.
const CROSSINGS: usize = 64;

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    for (set, mut rng) in subject.usual() {
        look_at(subject, set, &mut rng, judge);
    }
    for (set, mut rng) in placed::sets(subject, judge) {
        look_at(subject, &set, &mut rng, judge);
    }
    judge.skip_untried(turning::TURNS, "it nowhere says how its normals turn");
    subject.concurrent(judge, |resolved| {
        let (shape, mut rng) = (resolved.shape(), Rng::new(7));
        if shape.mesh().is_some() {
            return vec![];
        }
        let mut bits = vec![];
        for _ in 0..200 {
            let o = uniform_sphere(rng.pair()).as_dvec3() * 4.0;
            let hit = shape.intersect(&Ray::new(o, -o));
            let half = |x: f64| [(x.to_bits() >> 32) as u32, (x.to_bits() & 0xffff_ffff) as u32];
            bits.extend(hit.map_or([0; 2], |hit| half(hit.t)));
        }
        bits
    });
}

fn look_at(subject: &Subject<'_>, set: &Set, rng: &mut Rng, judge: &mut Judge) {
    set.ask(|resolved| {
        let shape = resolved.shape();
        if let Some(mesh) = shape.mesh() {
            is_a_mesh(&mesh, shape.bounds(), set, judge);
            judge.skip(HITS, "triangles, which the host meets and samples: their tables alone");
            judge.skip(turning::TURNS, "triangles, of which the host says how their normals turn");
            return;
        }
        let Some(look) = Look::new(shape, set) else {
            judge.skip("bounded", "the shape has no extent");
            return;
        };
        look.rays(rng, judge);
        look.scales(rng, judge);
        look.distances(rng, judge);
        look.turning(rng, judge);
        look.parallelogram(rng, judge);
        if !shape.area().is_finite() {
            let none = shape.sample(None, [0.5; 2]).is_none();
            judge.holds("what cannot shine has no samples", none, || set.label.clone());
        } else if !look.endless {
            look.samples(rng, subject.options.samples, judge);
        }
        if shape.parts() > 0 {
            look.parts(rng, judge);
        }
    });
}

/// Indices, corners and normals of triangles that the host takes over.
fn is_a_mesh(mesh: &TriangleMesh, bounds: Bounds3, set: &Set, judge: &mut Judge) {
    let at = || set.label.clone();
    let n = mesh.points.len();
    let legal = mesh.indices.iter().flatten().all(|i| (*i as usize) < n);
    judge.holds("indices name corners", legal, at);
    judge.holds("finite", mesh.points.iter().all(|p| p.is_finite()), at);
    let per_corner = |len: usize| len == 0 || len == n;
    let matched = per_corner(mesh.normals.len()) && per_corner(mesh.uvs.len());
    judge.holds("one normal and uv per corner", matched, at);
    let off = mesh.normals.iter().map(|n| f64::from((n.length() - 1.0).abs())).fold(0.0, f64::max);
    judge.within("|n| = 1", off, 1e-5, at);
    let corners = mesh.points.iter().map(|p| mesh.centre + p.as_dvec3());
    judge.holds("hits inside bounds", corners.into_iter().all(|p| bounds.contains(p)), at);
}

/// A shape and where it is.
struct Look<'a> {
    shape: &'a dyn Shape,
    set: &'a Set,
    centre: DVec3,
    /// Of a sphere around it.
    radius: f64,
    /// Largest coordinate: what f64 rounds is relative to it.
    reach: f64,
    /// Whether this is but the part of the shape that is near to the origin.
    endless: bool,
}

/// How far out hits of an endless shape are judged, in metres.
const OUT: f64 = 100.0;

impl<'a> Look<'a> {
    fn new(shape: &'a dyn Shape, set: &'a Set) -> Option<Self> {
        let bounds = shape.bounds();
        let endless = !bounds.is_empty() && !bounds.diagonal().is_finite();
        if endless {
            let centre = DVec3::ZERO.clamp(bounds.min, bounds.max);
            let reach = centre.abs().max_element() + OUT;
            return Some(Self { shape, set, centre, radius: 1.0, reach, endless });
        }
        let radius = 0.5 * bounds.diagonal().length();
        let usable = !bounds.is_empty() && radius > 0.0 && radius.is_finite();
        let centre = bounds.centre();
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element() + radius;
        let mut look = Self { shape, set, centre, radius: radius * 1.01, reach, endless };
        if usable {
            look.tighten();
        }
        usable.then_some(look)
    }

    /// A smaller sphere that still holds what lines meet: fewer lines miss. Corners that none of
    /// these lines met lie within the margin.
    fn tighten(&mut self) {
        let mut rng = Rng::new(1);
        let mut reach = 0.0f64;
        for _ in 0..4000 {
            for (_, s) in self.crossings(&self.chord(&mut rng)) {
                reach = reach.max(s.p.distance(self.centre));
            }
        }
        if reach > 0.0 {
            self.radius = self.radius.min(1.05 * reach);
        }
    }

    fn at(&self, ray: &Ray) -> String {
        format!("{}: from {} along {} to {:.3e}", self.set.label, ray.o, ray.d, ray.t_max)
    }

    /// What f64 may be off by in a coordinate of this shape, times the angle at which it is met.
    fn slack(&self, p_err: DVec3, cos: f64) -> f64 {
        (p_err.length() + 64.0 * f64::EPSILON * self.reach) / cos.abs().max(1e-9)
    }

    /// A line through the shape's sphere, alike for all lines (an isotropic chord), and where it
    /// enters.
    fn chord(&self, rng: &mut Rng) -> Ray {
        let d = uniform_sphere(rng.pair()).as_dvec3().normalize();
        let (s, t) = d.any_orthonormal_pair();
        let disk = luxel_sdk::sampling::disk_concentric(rng.pair()).as_dvec2() * self.radius;
        Ray::new(self.centre + s * disk.x + t * disk.y - d * (2.0 * self.radius), d)
    }

    /// All crossings of a line: each found by a ray that leaves the last point.
    fn crossings(&self, ray: &Ray) -> Vec<(Hit, Surface)> {
        let (mut found, mut leave) = (vec![], *ray);
        while let Some(hit) = self.shape.intersect(&leave) {
            let surface = self.shape.surface(&leave, &hit);
            let o = offset_origin(surface.p, surface.p_err, surface.ng, ray.d);
            leave = Ray { o, d: ray.d, t_max: ray.t_max };
            let t = (surface.p - ray.o).dot(ray.d) / ray.d.length_squared();
            found.push((Hit { t, ..hit }, surface));
            if found.len() >= CROSSINGS {
                break;
            }
        }
        found
    }

    /// What a shape says of its distance, where it says anything.
    fn distances(&self, rng: &mut Rng, judge: &mut Judge) {
        if self.shape.distance(self.centre).is_none() {
            return;
        }
        let f = |p: DVec3| self.shape.distance(p).unwrap_or(f64::NAN);
        let rounds = 256.0 * f64::EPSILON * (self.reach + 2.0 * self.radius);
        let mut any = |reach: f64| uniform_sphere(rng.pair()).as_dvec3() * (reach * rng.f64());
        for i in 0..1000 {
            let p = self.centre + any(1.5 * self.radius);
            let q = p + any(self.radius * 0.1f64.powi(i % 7));
            let change = (f(p) - f(q)).abs();
            let at = || format!("{}: from {p} to {q}", self.set.label);
            let most = p.distance(q) + rounds;
            judge.within("distance: no more than the way", change / most, 1.0, at);
        }
        for _ in 0..200 {
            let ray = self.chord(rng);
            let found = self.crossings(&ray);
            let at = || self.at(&ray);
            for (_, s) in &found {
                let off = f(s.p).abs() / (rounds + s.p_err.length());
                judge.within("distance: 0 on the surface", off, 1.0, at);
            }
            for (k, ends) in found.windows(2).enumerate() {
                let (a, b) = (ends[0].1.p, ends[1].1.p);
                let grazing = ends.iter().any(|(_, s)| s.ng.dot(ray.d).abs() < 1e-3);
                if !grazing && a.distance(b) > 1e-3 * self.radius {
                    let inside = f(0.5 * (a + b)) < 0.0;
                    judge.holds("distance: negative inside", inside == (k % 2 == 0), at);
                }
            }
        }
    }

    fn rays(&self, rng: &mut Rng, judge: &mut Judge) {
        for i in 0..600 {
            let mut ray = self.chord(rng);
            if i % 3 == 0 {
                // From inside, along the axes too.
                let d = ray.d;
                ray = Ray::new(self.centre + d * (self.radius * rng.f64()), -d);
            }
            if i % 7 == 0 {
                ray.d = DVec3::AXES[i / 7 % 3] * if i % 2 == 0 { 1.0 } else { -1.0 };
            }
            self.one_ray(&ray, judge);
            if i % 3 != 0 {
                self.parity(&ray, judge);
            }
        }
        for broken in [
            Ray::new(DVec3::NAN, DVec3::X),
            Ray::new(DVec3::ZERO, DVec3::NAN),
            Ray { t_max: f64::NAN, ..Ray::new(self.centre - DVec3::X * 9.0, DVec3::X) },
        ] {
            let none = self.shape.intersect(&broken).is_none();
            judge.holds("a NaN hits nothing", none, || self.at(&broken));
        }
    }

    fn one_ray(&self, ray: &Ray, judge: &mut Judge) {
        let Some(hit) = self.shape.intersect(ray) else { return };
        let surface = self.shape.surface(ray, &hit);
        if self.endless && surface.p.distance(self.centre) > OUT {
            return;
        }
        let at = || format!("{}: {hit:?}", self.at(ray));
        let positive = hit.t > 0.0 && hit.t <= ray.t_max && hit.t.is_finite();
        judge.holds("t within limits", positive, at);
        let cos = surface.ng.dot(ray.d) / ray.d.length();
        let slack = self.slack(surface.p_err, cos);
        self.is_legal_surface(&surface, judge, &at);
        let off = (surface.p - ray.at(hit.t)).length();
        let t_err = 32.0 * f64::EPSILON * (hit.t * ray.d.length() + ray.o.length());
        judge.within(
            "the point lies on the ray",
            off / (slack + t_err / cos.abs().max(1e-9)),
            1.0,
            at,
        );
        // Limits: at the hit it still counts, before it nothing does.
        let nearer = |t_max: f64| self.shape.intersect(&Ray { t_max, ..*ray });
        let at_hit = nearer(hit.t);
        let kept = at_hit.is_some_and(|h| (h.t - hit.t).abs() <= 0.0);
        judge.holds("t_max at the hit keeps it", kept, at);
        judge.holds("t_max before the hit hides it", nearer(hit.t.next_down()).is_none(), at);
        let far = nearer(hit.t * 2.0);
        judge.holds("t_max never changes the nearest", far == Some(hit), at);
        // A ray of another length meets the same point.
        for length in [1e-6, 2.5, 1e6] {
            let scaled = Ray { d: ray.d * length, ..*ray };
            let t = self.shape.intersect(&scaled).map_or(f64::NAN, |h| h.t * length);
            let off = (t - hit.t).abs() * ray.d.length() * cos.abs().max(1e-9);
            judge.within(
                "t counts lengths of d",
                off / (slack * cos.abs().max(1e-9) + t_err),
                1.0,
                at,
            );
        }
        self.leaves(&surface, ray.d, judge, &at);
    }

    /// A ray that leaves a point does not meet the same place again.
    fn leaves(&self, from: &Surface, d: DVec3, judge: &mut Judge, at: &dyn Fn() -> String) {
        for d in [d, from.ng, -from.ng, d - from.ng * (2.0 * d.dot(from.ng))] {
            let d = d.normalize();
            if d.dot(from.ng).abs() < 1e-3 {
                continue;
            }
            let ray = Ray::new(offset_origin(from.p, from.p_err, from.ng, d), d);
            let near = 4.0 * self.slack(from.p_err, d.dot(from.ng));
            let again = self.shape.intersect(&ray).filter(|hit| hit.t <= near);
            judge.holds("no hit where it leaves", again.is_none(), || {
                format!("{}: leaving along {d}: {again:?}", at())
            });
        }
    }

    fn is_legal_surface(&self, s: &Surface, judge: &mut Judge, at: &dyn Fn() -> String) {
        let finite = s.p.is_finite() && s.p_err.is_finite() && s.uv.is_finite();
        judge.holds("finite", finite && s.dp_du.is_finite() && s.dp_dv.is_finite(), at);
        let unit = (s.ng.length() - 1.0).abs().max((s.ns.length() - 1.0).abs());
        judge.within("|n| = 1", unit, 1e-9, at);
        judge.holds("shading normal on its side", s.ns.dot(s.ng) > 0.0, at);
        let length = s.dp_du.length();
        judge.holds("dp/du is not zero", length > 0.0, at);
        let along = (s.dp_du / length).dot(s.ng).abs();
        judge.within("dp/du lies in the surface", along, 1e-6, at);
        let bounds = self.shape.bounds();
        let off = (bounds.min - s.p).max(s.p - bounds.max).max_element();
        judge.within(
            "hits inside bounds",
            off / (s.p_err.max_element() + f64::MIN_POSITIVE),
            1.0,
            at,
        );
        // Half a length of the box: an error bound that large would tell nothing.
        let loose = s.p_err.max_element() / (self.reach * 1e-9);
        judge.within("error bounds are small", loose, 1.0, at);
    }

    /// What the parts are hit at is what the shape is, and they lie in their boxes.
    fn parts(&self, rng: &mut Rng, judge: &mut Judge) {
        let n = self.shape.parts();
        for _ in 0..200 {
            let ray = self.chord(rng);
            let hits =
                (0..n).filter_map(|part| Some((part, self.shape.intersect_part(part, &ray)?)));
            let nearest = hits.min_by(|a, b| a.1.t.total_cmp(&b.1.t));
            let (whole, part) = (self.shape.intersect(&ray), nearest.map(|(_, hit)| hit));
            let same = whole.map(|hit| hit.t.to_bits()) == part.map(|hit| hit.t.to_bits());
            let at = || format!("{}: {whole:?} and of parts {nearest:?}", self.at(&ray));
            judge.holds("its parts are hit where it is", same, at);
            if let Some((part, hit)) = nearest {
                let p = self.shape.surface(&ray, &hit).p;
                let held = self.shape.part_bounds(part).contains(p);
                judge.holds("hits inside bounds", held, at);
            }
        }
    }

    /// The normal against neighbouring hits, and whether a closed shape is entered and left in turn.
    fn parity(&self, ray: &Ray, judge: &mut Judge) {
        let found = self.crossings(ray);
        let at = || self.at(ray);
        let grazing = found.iter().any(|(_, s)| s.ng.dot(ray.d).abs() < 1e-6);
        if !grazing && self.shape.is_closed() {
            judge.holds("closed: an even number of crossings", found.len().is_multiple_of(2), at);
            let in_turn =
                found.iter().enumerate().all(|(i, (_, s))| (s.ng.dot(ray.d) < 0.0) == (i % 2 == 0));
            judge.holds("closed: normals point outside", in_turn, at);
        }
        judge.holds("crossings come to an end", found.len() < CROSSINGS, at);
        if let Some((_, s)) = found.first().filter(|(_, s)| s.ng.dot(ray.d).abs() > 0.05) {
            self.gradient(ray, s, judge);
        }
    }

    /// The normal across two chords to hits of nearby rays.
    fn gradient(&self, ray: &Ray, s: &Surface, judge: &mut Judge) {
        let step = 1e-5 * self.radius;
        let (u, v) = ray.d.any_orthonormal_pair();
        let hit = |offset: DVec3| {
            let near = Ray::new(ray.o + offset, ray.d);
            let hit = self.shape.intersect(&near)?;
            let there = self.shape.surface(&near, &hit);
            // Not across an edge, nor over a rim.
            let same = there.ng.dot(s.ng) > 0.999 && (there.p - s.p).length() < 100.0 * step;
            same.then_some(there.p)
        };
        let ends = [hit(u * step), hit(u * -step), hit(v * step), hit(v * -step)];
        let [Some(a), Some(b), Some(c), Some(d)] = ends else { return };
        let normal = (a - b).cross(c - d).normalize();
        let off = 1.0 - normal.dot(s.ng).abs();
        // Central differences: second order in the step, over a curvature of at most 1e3 radii; and
        // rounding of the points over the step.
        let rounding = self.reach * 1e-14 / step;
        judge.within("the normal is the gradient", off, 1e-6 + rounding, || self.at(ray));
        for offset in [u * step, v * step] {
            self.tangent(&Ray::new(ray.o + offset, ray.d), s, judge);
        }
    }

    /// A step along the surface is that which its coordinates and their derivatives tell.
    fn tangent(&self, near: &Ray, s: &Surface, judge: &mut Judge) {
        let Some(hit) = self.shape.intersect(near) else { return };
        let there = self.shape.surface(near, &hit);
        let (moved, uv) = (there.p - s.p, there.uv - s.uv);
        let flat = s.dp_du.length().min(s.dp_dv.length()) > 0.05 * self.radius;
        // Not over an edge, a seam or near a pole.
        let same = there.ng.dot(s.ng) > 0.999_999 && uv.abs().max_element() < 1e-3;
        if !(flat && same && moved.length() < 1e-3 * self.radius) {
            return;
        }
        let off = (moved - s.dp_du * uv.x - s.dp_dv * uv.y).length() / moved.length();
        let rounding = self.reach * 1e-13 / moved.length();
        // First order in the step, over curvatures of at most a hundred radii.
        judge.within("dp/du is the derivative", off, 1e-2 + rounding, || self.at(near));
    }

    /// The same ray told in lengths from 1e-6 to 1e6 and from far away: hits move by what rounds.
    fn scales(&self, rng: &mut Rng, judge: &mut Judge) {
        for far in [1.0, 1e3, 1e6] {
            for _ in 0..50 {
                let near = self.chord(rng);
                let Some(hit) = self.shape.intersect(&near) else { continue };
                let p = self.shape.surface(&near, &hit);
                let cos = p.ng.dot(near.d).abs();
                if cos < 0.1 {
                    continue;
                }
                let ray = Ray::new(near.o - near.d * (far * self.radius), near.d);
                let Some(hit) = self.shape.intersect(&ray) else {
                    judge.holds("hit from afar", false, || self.at(&ray));
                    continue;
                };
                let q = self.shape.surface(&ray, &hit);
                let off = (q.p - p.p).length();
                let rounds = 64.0 * f64::EPSILON * (far * self.radius + self.reach) / cos;
                judge.within("hit from afar", off / rounds, 1.0, || self.at(&ray));
            }
        }
    }

    /// Area, and sampled points from several places, against isotropic lines.
    fn samples(&self, rng: &mut Rng, n: u32, judge: &mut Judge) {
        let (c, r) = (self.centre, self.radius);
        let views =
            [None, Some(c + DVec3::new(3.1, 1.7, -2.3) * r), Some(c + DVec3::Y * (1.2 * r))];
        let inside = Some(c + DVec3::new(0.11, -0.07, 0.13) * r);
        let chords: Vec<(DVec3, Vec<(Hit, Surface)>)> = (0..n)
            .map(|_| {
                let ray = self.chord(rng);
                (ray.d, self.crossings(&ray))
            })
            .collect();
        // Crofton: lines through a sphere of radius R cross an area A in it A/(2πR²) times each.
        let per_area = 2.0 * std::f64::consts::PI * r * r;
        let mut area = Moments::default();
        for (_, found) in &chords {
            area.push(found.len() as f64 * per_area);
        }
        // Few lines meet a needle: what they say of it is not normal.
        if effective(&area) < LEAST_LINES {
            let expected = self.shape.area() / per_area * f64::from(n);
            judge.holds("lines meet it", expected < 5.0 * LEAST_LINES, || {
                format!("{}: of {n} lines {} should, not {}", self.set.label, expected, area.mean)
            });
            return;
        }
        let z = deviation(area.mean - self.shape.area(), 0.0, mean_error(&area));
        judge.statistic("area by lines", z, || {
            format!("{}: {} is {}", self.set.label, self.shape.area(), area.mean)
        });
        for from in views.into_iter().chain([inside]) {
            let all = chords.iter().map(|(_, found)| found.as_slice());
            Sampling { look: self, from, per_area }.judge(all, rng, n, judge);
        }
    }
}
