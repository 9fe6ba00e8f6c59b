//! Sharp solids: a ray from crossing to crossing of both parts.
//!
//! Each part tells its own crossings, one after the other: a ray that goes on from one starts beyond
//! what that crossing's error bound leaves open, so that it is not met again. How often a ray has gone
//! into a part is counted, so that strands and meshes may cross themselves: it is outside when it has
//! left it as often. Where a ray starts in a part that knows its distance, and so has but one inside,
//! the outer normal of the first crossing says; in another one, all that lies ahead does. The whole is
//! crossed where what is inside of both parts changes what is inside of it.

use glam::{DVec2, DVec3};
use luxel_sdk::kind::{Hit, NormalDerivatives, Shape, ShapeRef, Surface};
use luxel_sdk::num::{Ray, gamma64, offset_origin};

use super::{Op, Pair};

/// Crossings that are walked past; a ray that meets more goes through.
const MOST: usize = 4096;

/// A crossing of one part.
#[derive(Clone, Copy)]
struct Crossing {
    /// `t` along the ray that is walked.
    hit: Hit,
    surface: Surface,
    /// Whether the ray goes into the part.
    enters: bool,
}

/// A part along the ray.
struct Follower<'s> {
    part: ShapeRef<'s>,
    /// Whether it does not cross itself.
    plain: bool,
    /// How often it is inside now, and after its next crossing.
    depth: u32,
    then: u32,
    next: Option<Crossing>,
}

impl<'s> Follower<'s> {
    fn new((part, plain): (ShapeRef<'s>, u32), ray: &Ray) -> Self {
        let whole = Ray { t_max: f64::INFINITY, ..*ray };
        let next = crossing(&part, &whole, 0.0);
        let mut found = Self { part, plain: plain > 0, depth: 0, then: 0, next };
        if found.next.is_some() && part.bounds().contains(ray.o) {
            found.depth = found.deep(&whole, None);
        }
        found.look_ahead(ray);
        found
    }

    fn t(&self) -> f64 {
        self.next.as_ref().map_or(f64::INFINITY, |next| next.hit.t)
    }

    fn is_inside(&self) -> bool {
        self.depth > 0
    }

    /// Past the next crossing.
    fn advance(&mut self, ray: &Ray) {
        let Some(passed) = self.next.take() else { return };
        self.next = following(&self.part, &passed, ray);
        // Nothing ahead: outside.
        self.depth = if self.next.is_some() { self.then } else { 0 };
        self.look_ahead(ray);
    }

    /// How deep it will be after the next crossing. Where it was entered twice and left once, it is
    /// made sure that it was not left unseen.
    fn look_ahead(&mut self, ray: &Ray) {
        self.then = match &self.next {
            Some(next) if next.enters => self.depth + 1,
            Some(next) if self.depth > 1 => self.deep(ray, Some(next)),
            _ => 0,
        };
    }

    /// How deep a ray is where it starts, or after a crossing: it leaves the part so much more often
    /// than it goes into it.
    fn deep(&self, ray: &Ray, after: Option<&Crossing>) -> u32 {
        let first = after.map_or(self.next, |passed| following(&self.part, passed, ray));
        let Some(first) = first else { return 0 };
        let least = u32::from(!first.enters);
        if self.plain {
            return least;
        }
        let (mut left, mut next) = (0i32, Some(first));
        for _ in 0..MOST {
            let Some(passed) = next else { break };
            left += if passed.enters { -1 } else { 1 };
            next = following(&self.part, &passed, ray);
        }
        left.max(0).unsigned_abs().max(least)
    }
}

/// The crossing after another one.
fn following(part: &ShapeRef<'_>, passed: &Crossing, ray: &Ray) -> Option<Crossing> {
    let Surface { p, p_err, ng, .. } = passed.surface;
    let o = offset_origin(p, p_err, ng, ray.d);
    let t = (o - ray.o).dot(ray.d) / ray.d.length_squared();
    // The ray that is walked goes on, however the point was rounded.
    crossing(part, &Ray::new(o, ray.d), t.max(passed.hit.t))
}

/// The first crossing of a ray that starts at `start` along the one that is walked.
fn crossing(part: &ShapeRef<'_>, ray: &Ray, start: f64) -> Option<Crossing> {
    let hit = part.intersect(ray)?;
    let surface = part.surface(ray, &hit);
    let enters = surface.ng.dot(ray.d) < 0.0;
    Some(Crossing { hit: Hit { t: start + hit.t, ..hit }, surface, enters })
}

/// Whether two crossings are nearer to each other than their errors can tell: as one they leave
/// neither skins nor gaps between faces that lie in each other.
fn coincide(a: &Crossing, b: &Crossing, ray: &Ray) -> bool {
    let err = |s: &Surface| s.ng.abs().dot(s.p_err);
    let cos = a.surface.ng.dot(ray.d).abs().max(b.surface.ng.dot(ray.d).abs());
    // `t` rounds with the way and with the place: a difference, a product and a quotient for either
    // crossing, and the sum that carries it to where the walk began.
    let rounds = gamma64(8) * (a.hit.t.abs() * ray.d.length() + ray.o.abs().max_element());
    let apart = (a.hit.t - b.hit.t).abs() * cos;
    apart <= err(&a.surface) + err(&b.surface) + rounds * cos / ray.d.length()
}

/// The face of the whole, if there is room for it.
fn face_of(part: u32, face: u32) -> Option<u32> {
    face.checked_mul(2)?.checked_add(part)
}

/// The nearest crossing of the whole.
pub(super) fn first(pair: &Pair<'_>, ray: &Ray) -> Option<Hit> {
    if pair.bounds.intersect_ray(ray.o, ray.d.recip(), f64::INFINITY).is_none() || ray.t_max <= 0.0
    {
        return None;
    }
    let mut a = Follower::new((pair.a, pair.plain[0]), ray);
    if pair.op != Op::Union && a.next.is_none() {
        return None;
    }
    let mut b = Follower::new((pair.b, pair.plain[1]), ray);
    for _ in 0..MOST {
        let (pass_a, pass_b) = match (&a.next, &b.next) {
            (None, None) => return None,
            (Some(next), Some(other)) if coincide(next, other, ray) => (true, true),
            _ => (a.t() <= b.t(), b.t() < a.t()),
        };
        let inside = (a.is_inside(), b.is_inside());
        let after = (
            if pass_a { a.then > 0 } else { inside.0 },
            if pass_b { b.then > 0 } else { inside.1 },
        );
        if pair.op.holds(inside.0, inside.1) != pair.op.holds(after.0, after.1) {
            // Of two that coincide the first that turns over.
            let of_a = pass_a && after.0 != inside.0;
            let (met, part) = if of_a { (&a, 0) } else { (&b, 1) };
            let hit = met.next.as_ref()?.hit;
            let hit = Hit { face: face_of(part, hit.face)?, ..hit };
            return (hit.t > 0.0 && hit.t <= ray.t_max).then_some(hit);
        }
        if pass_a {
            a.advance(ray);
            let gone = a.next.is_none() && !a.is_inside();
            if pair.op != Op::Union && gone {
                return None;
            }
        }
        if pass_b {
            b.advance(ray);
        }
        if a.t().min(b.t()) > ray.t_max {
            return None;
        }
    }
    None
}

/// The part that was met, its hit, and the other part.
fn met<'s>(pair: &Pair<'s>, hit: &Hit) -> (ShapeRef<'s>, Hit, ShapeRef<'s>) {
    let own = Hit { face: hit.face / 2, ..*hit };
    if is_of_b(hit) { (pair.b, own, pair.a) } else { (pair.a, own, pair.b) }
}

fn is_of_b(hit: &Hit) -> bool {
    !hit.face.is_multiple_of(2)
}

/// Seen from where it was taken away: turned over, and the texture stands on its head. Twice is as
/// it was.
fn turned_over(s: &Surface) -> Surface {
    let uv = DVec2::new(s.uv.x, 1.0 - s.uv.y);
    Surface { ng: -s.ng, ns: -s.ns, dp_dv: -s.dp_dv, uv, ..*s }
}

/// The point that a hit names.
pub(super) fn surface(pair: &Pair<'_>, ray: &Ray, hit: &Hit) -> Surface {
    let (part, own, other) = met(pair, hit);
    let mut found = part.surface(ray, &own);
    found.p_err = clear_of(&found, &other);
    if pair.op == Op::Difference && is_of_b(hit) { turned_over(&found) } else { found }
}

/// How the normal of the part that was met turns. Turned over, both the normal and `v` run the other
/// way.
pub(super) fn normal_derivatives(
    pair: &Pair<'_>,
    hit: &Hit,
    at: &Surface,
) -> Option<NormalDerivatives> {
    let (part, own, _) = met(pair, hit);
    if pair.op == Op::Difference && is_of_b(hit) {
        let NormalDerivatives { dn_du, dn_dv } = part.normal_derivatives(&own, &turned_over(at))?;
        return Some(NormalDerivatives { dn_du: -dn_du, dn_dv });
    }
    part.normal_derivatives(&own, at)
}

/// The error bound of a point, grown where the other part's surface lies in this one: a ray that
/// leaves the point leaves both.
fn clear_of(s: &Surface, other: &ShapeRef<'_>) -> DVec3 {
    let bounds = other.bounds();
    let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
    // The other face may lie twice its error beside this one, which may be as wrong as this face on
    // either side; and it is found to 64 roundings of where it is, which `Shape` promises.
    let room = 4.0 * s.ng.abs().dot(s.p_err) + gamma64(64) * reach;
    let across = Ray { t_max: 2.0 * room, ..Ray::new(s.p + s.ng * room, -s.ng) };
    let Some(hit) = other.intersect(&across) else { return s.p_err };
    let there = other.surface(&across, &hit);
    let gap = (there.p - s.p).dot(s.ng).abs();
    s.p_err.max(there.p_err) + s.ng.abs() * gap
}
