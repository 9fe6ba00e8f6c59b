//! Round strands: what a ball sweeps along a curve.
//!
//! A line meets the ball at `s` of a segment between z(s) − R(s) and z(s) + R(s), where z is the
//! curve's place along the line and R² = r² − ρ², ρ its distance from the line. As `s` moves through
//! a range where R is real, these chords join to one; the rod is met where the union of all such
//! begins and ends. So every line enters a strand as often as it leaves it, whatever rounds, and ends,
//! joints, sharp bends and cusps need no rule of their own. Chords of neighbouring ranges share that
//! at their common end, bit by bit, and so join.
//!
//! A chord's end is extreme where, for the vector m from the curve to it, g = m·c′ + r r′ is 0: on
//! the envelope of the balls. There g falls by K = |c′|² − r′² − m·c″ − r r″ (Bloomenthal 1990,
//! "Calculation of reference frames"; do Carmo §2-4 on tubes), which is positive but where the rod is
//! swallowed by its own bend. Segments are halved until bounds tell that an end has one extreme at
//! most and that R is real in one range at most; then Newton's steps find it.

use glam::{DVec2, DVec3, DVec4, Vec4Swizzles as _};
use luxel_sdk::kind::{NormalDerivatives, Surface};
use luxel_sdk::num::Ray;

use super::cubic::{Cubic, Range, eval, falling_root, halves};
use super::strand::{Line, ROUNDING, Strand, square_to};

/// An end of a chord.
#[derive(Clone, Copy, Debug)]
struct End {
    /// Place along the line.
    at: f64,
    s: f64,
    segment: u32,
}

/// Where a line is inside, apart from each other.
#[derive(Debug, Default)]
struct Chords(Vec<(End, End)>);

impl Chords {
    /// Joins a chord with those that it meets.
    fn join(&mut self, mut chord: (End, End)) {
        self.0.retain(|other| {
            let apart = other.1.at < chord.0.at || chord.1.at < other.0.at;
            if !apart {
                chord.0 = if other.0.at <= chord.0.at { other.0 } else { chord.0 };
                chord.1 = if other.1.at >= chord.1.at { other.1 } else { chord.1 };
            }
            apart
        });
        self.0.push(chord);
    }
}

/// The first place where a ray passes the surface: its parameter, `s`, and twice the segment within
/// the strand, 1 more where it leaves.
pub(super) fn intersect(strand: &Strand, line: &Line) -> Option<(f64, f64, u32)> {
    let mut chords = Chords::default();
    strand.along(line, |number, segment, far| {
        let seen = segment.curve.map(|p| line.seen(p.truncate()).extend(p.w));
        Piece { whole: &seen, number, from: line.from, to: far }.chords(&mut chords);
        far
    });
    let mut found: Option<(f64, f64, u32)> = None;
    for (enter, leave) in &chords.0 {
        let (first, last) = (line.t(enter.at), line.t(leave.at));
        let (t, end, side) = if first > 0.0 { (first, enter, 0) } else { (last, leave, 1) };
        if t > 0.0 && found.is_none_or(|found| t < found.0) {
            found = Some((t, end.s, 2 * end.segment + side));
        }
    }
    found
}

/// A segment as seen along a line: places across and along it, and the radius.
struct Piece<'a> {
    whole: &'a Cubic<DVec4>,
    number: u32,
    from: f64,
    to: f64,
}

/// The ball at a place of a segment, as the line meets it.
#[derive(Clone, Copy)]
struct Ball {
    c: (DVec4, DVec4, DVec4),
    /// R²; the line misses the ball where it is not positive.
    depth: f64,
}

impl Ball {
    fn of(curve: &Cubic<DVec4>, s: f64) -> Self {
        let c = eval(curve, s);
        let (away, r) = (c.0.xy().length(), c.0.w);
        Self { c, depth: (r - away) * (r + away) }
    }

    fn is_met(&self) -> bool {
        self.depth > 0.0
    }

    /// From the middle to where the line enters (side −1) or leaves (1).
    fn arm(&self, side: f64) -> DVec3 {
        (-self.c.0.xy()).extend(side * self.depth.max(0.0).sqrt())
    }

    /// g and −K.
    fn balance(&self, side: f64) -> (f64, f64) {
        let (m, (c, c1, c2)) = (self.arm(side), self.c);
        let g = m.dot(c1.xyz()) + c.w * c1.w;
        let k = c1.xyz().length_squared() - c1.w * c1.w - m.dot(c2.xyz()) - c.w * c2.w;
        (g, -k)
    }
}

/// A part of a segment, and the bounds by which it is judged.
#[derive(Clone, Copy)]
struct Part {
    curve: Cubic<DVec4>,
    start: f64,
    end: f64,
}

/// What bounds tell of the ends of chords within a part.
#[derive(Clone, Copy, PartialEq)]
enum Extreme {
    /// At an end of the part.
    Outside,
    /// Perhaps inside, and then but once.
    Once,
    Unknown,
}

/// Parts that are looked at before the rest is taken as it is: bounds settle a few.
const MOST_PARTS: u32 = 4096;

impl Piece<'_> {
    fn chords(&self, chords: &mut Chords) {
        let whole = Part { curve: *self.whole, start: 0.0, end: 1.0 };
        self.chords_of(&whole, &mut 0, chords);
    }

    fn chords_of(&self, part: &Part, looked: &mut u32, chords: &mut Chords) {
        let hull = Hull::of(&part.curve);
        if hull.is_missed(&part.curve, (self.from, self.to)) {
            return;
        }
        *looked += 1;
        let settled = if *looked > MOST_PARTS || hull.is_still(&part.curve) {
            Some([Extreme::Outside; 2])
        } else {
            hull.settled(&part.curve)
        };
        if let Some(extremes) = settled {
            self.part(part, extremes, chords);
            return;
        }
        let middle = 0.5 * (part.start + part.end);
        let (low, high) = halves(&part.curve);
        self.chords_of(&Part { curve: low, start: part.start, end: middle }, looked, chords);
        self.chords_of(&Part { curve: high, start: middle, end: part.end }, looked, chords);
    }

    /// The chord of a part that bounds have settled.
    fn part(&self, part: &Part, extremes: [Extreme; 2], chords: &mut Chords) {
        let ball = |s: f64| Ball::of(self.whole, s);
        let (first, last) = (ball(part.start), ball(part.end));
        let seed = if first.is_met() {
            Some((part.start, first))
        } else if last.is_met() {
            Some((part.end, last))
        } else if extremes.contains(&Extreme::Once) {
            self.nearest(part)
        } else {
            None
        };
        let Some((seed, inside)) = seed else { return };
        let end = |s: f64, ball: &Ball, side: f64| {
            let at = ball.c.0.z + ball.arm(side).z;
            End { at, s, segment: self.number }
        };
        let mut chord = [-1.0, 1.0].map(|side| end(seed, &inside, side));
        let mut take = |s: f64, ball: Ball| {
            if ball.is_met() {
                let (enter, leave) = (end(s, &ball, -1.0), end(s, &ball, 1.0));
                chord[0] = if enter.at < chord[0].at { enter } else { chord[0] };
                chord[1] = if leave.at > chord[1].at { leave } else { chord[1] };
            }
        };
        take(part.start, first);
        take(part.end, last);
        for (side, extreme) in [-1.0, 1.0].into_iter().zip(extremes) {
            let falls = !first.is_met() || first.balance(side).0 > 0.0;
            let fell = !last.is_met() || last.balance(side).0 < 0.0;
            if extreme == Extreme::Once && falls && fell {
                // Where no ball is met, g has the sign that it has at the edge of those which are.
                let s = falling_root(part.start, part.end, |s| {
                    let ball = ball(s);
                    if ball.is_met() {
                        ball.balance(side)
                    } else {
                        (if s < seed { 1.0 } else { -1.0 }, f64::NAN)
                    }
                });
                take(s, ball(s));
            }
        }
        chords.join((chord[0], chord[1]));
    }

    /// A place whose ball is met, though those at both ends of the part are not: on the way to where
    /// R² is greatest.
    fn nearest(&self, part: &Part) -> Option<(f64, Ball)> {
        let mut found = None;
        falling_root(part.start, part.end, |s| {
            let ball = Ball::of(self.whole, s);
            if ball.is_met() {
                found = Some((s, ball));
                return (0.0, 0.0);
            }
            let (c, c1, c2) = ball.c;
            let rise = c.w * c1.w - c.xy().dot(c1.xy());
            let bend = c1.w * c1.w + c.w * c2.w - c1.xy().length_squared() - c.xy().dot(c2.xy());
            (rise, bend)
        });
        found
    }
}

/// Bounds of a part and of its derivatives, by its control points.
struct Hull {
    low: DVec4,
    high: DVec4,
    /// Squared distance from the line, least and most.
    away: Range,
}

fn hull<const N: usize>(points: [DVec4; N]) -> (DVec4, DVec4) {
    let rest = &points[1..];
    rest.iter().fold((points[0], points[0]), |(low, high), p| (low.min(*p), high.max(*p)))
}

fn steps([a, b, c, d]: &Cubic<DVec4>) -> ([DVec4; 3], [DVec4; 2]) {
    let first = [(*b - *a) * 3.0, (*c - *b) * 3.0, (*d - *c) * 3.0];
    (first, [(first[1] - first[0]) * 2.0, (first[2] - first[1]) * 2.0])
}

impl Hull {
    fn of(curve: &Cubic<DVec4>) -> Self {
        let (low, high) = hull(*curve);
        let squared = |low: f64, high: f64| Range::new(low, high).square();
        Self { low, high, away: squared(low.x, high.x).plus(squared(low.y, high.y)) }
    }

    /// Whether no ball of the part is met within the limits.
    fn is_missed(&self, curve: &Cubic<DVec4>, (from, to): (f64, f64)) -> bool {
        let r = self.high.w + ROUNDING;
        if self.away.low > r * r || self.high.z + r < from || self.low.z - r > to {
            return true;
        }
        // Beside the plane through the ends and along the line.
        let across = (curve[3].xy() - curve[0].xy()).perp();
        let length = across.length();
        let beside = curve.map(|p| p.xy().dot(across));
        let (low, high) =
            beside.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
        length > 0.0 && (low > r * length || high < -r * length)
    }

    /// Whether the balls at both ends hold all others but for rounding: the waist between two balls
    /// of radius r, a step apart, is step²/8r deep, and step/2 at most.
    fn is_still(&self, curve: &Cubic<DVec4>) -> bool {
        let (first, second) = steps(curve);
        let step = first.iter().map(|d| d.length()).fold(0.0, f64::max);
        let bend = second.iter().map(|d| d.length()).fold(0.0, f64::max);
        let waist = step.min(step * step / (4.0 * self.low.w.max(f64::MIN_POSITIVE)));
        waist + bend <= ROUNDING
    }

    /// What is known of the near and the far end of chords; `None` if too little.
    fn settled(&self, curve: &Cubic<DVec4>) -> Option<[Extreme; 2]> {
        let (first, second) = steps(curve);
        let ((d_low, d_high), (s_low, s_high)) = (hull(first), hull(second));
        let d = |i: usize| Range::new(d_low[i], d_high[i]);
        let s = |i: usize| Range::new(s_low[i], s_high[i]);
        let (r, most) = (Range::new(self.low.w, self.high.w), self.high.w);
        // From the curve to the line, where the ball is met.
        let m = |i: usize| Range::new((-self.high[i]).max(-most), (-self.low[i]).min(most));
        let arm = Range::new(
            (r.low * r.low - self.away.high).max(0.0).sqrt(),
            (most * most - self.away.low).max(0.0).sqrt(),
        );
        let flat = m(0).times(d(0)).plus(m(1).times(d(1))).plus(r.times(d(3)));
        let speed = d(0).square().plus(d(1).square()).plus(d(2).square()).minus(d(3).square());
        let bend = m(0).times(s(0)).plus(m(1).times(s(1))).plus(r.times(s(3)));
        let k = speed.minus(bend);
        let look = |side: f64| {
            let arm = if side > 0.0 { arm } else { Range::new(-arm.high, -arm.low) };
            let (g, k) = (flat.plus(arm.times(d(2))), k.minus(arm.times(s(2))));
            if !g.has_zero() {
                (Extreme::Outside, true)
            } else if k.high < 0.0 {
                (Extreme::Outside, false)
            } else if k.low > 0.0 {
                (Extreme::Once, false)
            } else {
                (Extreme::Unknown, false)
            }
        };
        let ends = [look(-1.0), look(1.0)];
        let known = ends.iter().all(|(extreme, _)| *extreme != Extreme::Unknown);
        // Where g does not change its sign, R has no two edges.
        let whole = ends.iter().any(|(_, steady)| *steady) || self.is_in_one(r, d, s);
        (known && whole).then_some(ends.map(|(extreme, _)| extreme))
    }

    /// Whether R is real in one range of the part at most: everywhere, or because ρ² − r² only falls
    /// or only rises, or bends upwards.
    fn is_in_one(&self, r: Range, d: impl Fn(usize) -> Range, s: impl Fn(usize) -> Range) -> bool {
        if self.away.high < r.low * r.low {
            return true;
        }
        let c = |i: usize| Range::new(self.low[i], self.high[i]);
        let rise = c(0).times(d(0)).plus(c(1).times(d(1))).minus(r.times(d(3)));
        let speed = d(0).square().plus(d(1).square()).minus(d(3).square());
        let bend = c(0).times(s(0)).plus(c(1).times(s(1))).minus(r.times(s(3)));
        !rise.has_zero() || speed.plus(bend).low > 0.0
    }
}

/// The point that a hit names: on the ball at `s`, where the line of the ray enters or leaves it.
pub(super) fn surface(
    strand: &Strand,
    ray: &Ray,
    (number, leaves): (u32, bool),
    s: f64,
) -> Surface {
    let segment = &strand.segments[number as usize];
    let ng = Line::of(strand, ray).and_then(|line| {
        let seen = segment.curve.map(|p| line.seen(p.truncate()).extend(p.w));
        let arm = Ball::of(&seen, s).arm(if leaves { 1.0 } else { -1.0 });
        line.turned_back(arm).try_normalize()
    });
    let ng = ng.unwrap_or(DVec3::Y);
    let (c, c1, c2) = eval(&segment.curve, s);
    let (p, p_err) = strand.place(c.xyz() + ng * c.w);
    let around = Around::of((c1, c2), eval(&segment.across, s), ng);
    let n = f64::from(strand.count());
    let (u, v) = ((f64::from(number) + s) / n, around.turn / std::f64::consts::TAU);
    // Where a circle about the curve shrinks to a point, as at the ends: a direction.
    let dp_dv = around.forward * (c.w * std::f64::consts::TAU * around.cos.max(f64::EPSILON));
    let dp_du = around.along(c.w, (c1, c2), ng) * n;
    let uv = DVec2::new(u, if v < 0.0 { v + 1.0 } else { v });
    let (dp_du, dp_dv) = (dp_du * strand.unit, dp_dv * strand.unit);
    Surface { p, p_err, ng, ns: ng, uv, dp_du, dp_dv }
}

/// How the normal turns. At an end or a corner, which are of a ball, as that of a ball does; there
/// `dp_du` of the surface is next to nothing.
pub(super) fn normal_derivatives(
    strand: &Strand,
    number: u32,
    s: f64,
    at: &Surface,
) -> Option<NormalDerivatives> {
    let segment = &strand.segments[number as usize];
    let (c, c1, c2) = eval(&segment.curve, s);
    let around = Around::of((c1, c2), eval(&segment.across, s), at.ns);
    let (dn_du, dn_dv) = if let Some((_, n1)) = around.rates(c.w, (c1, c2), at.ns) {
        let whole = around.forward * (std::f64::consts::TAU * around.cos);
        (n1 * f64::from(strand.count()), whole)
    } else {
        let radius = c.w * strand.unit;
        (at.dp_du / radius, at.dp_dv / radius)
    };
    (dn_du.is_finite() && dn_dv.is_finite()).then_some(NormalDerivatives { dn_du, dn_dv })
}

/// Where a normal stands about the curve.
struct Around {
    /// Unit tangent of the curve, and how it turns.
    t: DVec3,
    t1: DVec3,
    /// Across it, where the angle is 0, and how that turns.
    e: DVec3,
    e1: DVec3,
    /// Angle about the tangent.
    turn: f64,
    /// Share of the normal that is across the tangent.
    cos: f64,
    /// The way in which the angle grows.
    forward: DVec3,
}

/// How far a normal may lean from that of the envelope, which has m·c′ + r r′ = 0, and count as it:
/// beyond, it is of the end of a strand or of a corner.
const LEAN: f64 = 1e-5;

impl Around {
    fn of((c1, c2): (DVec4, DVec4), (b, b1, _): (DVec3, DVec3, DVec3), ng: DVec3) -> Self {
        let speed = c1.xyz().length();
        let t = c1.xyz().try_normalize().or(c2.xyz().try_normalize()).unwrap_or(DVec3::Z);
        let t1 = (c2.xyz() - t * t.dot(c2.xyz())) / speed;
        let flat = b - t * t.dot(b);
        let e = square_to(t, b);
        let flat1 = b1 - t1 * t.dot(b) - t * (t1.dot(b) + t.dot(b1));
        let e1 = (flat1 - e * e.dot(flat1)) / flat.length();
        let f = e.cross(t);
        let turn = ng.dot(f).atan2(ng.dot(e));
        let cos = ng.dot(f).hypot(ng.dot(e));
        let forward = square_to(ng, f * turn.cos() - e * turn.sin());
        Self { t, t1, e, e1, turn, cos, forward }
    }

    /// ∂p/∂s of c + r n at a fixed angle. At an end or a corner, where the curve stands still, the
    /// direction alone.
    fn along(&self, r: f64, rates: (DVec4, DVec4), ng: DVec3) -> DVec3 {
        let stands = self.forward.cross(ng) * (r.max(f64::MIN_POSITIVE) * f64::EPSILON);
        self.rates(r, rates, ng).map_or(stands, |(along, _)| along)
    }

    /// ∂p/∂s of c + r n and ∂n/∂s at a fixed angle; `None` where the curve stands still.
    fn rates(&self, r: f64, (c1, c2): (DVec4, DVec4), ng: DVec3) -> Option<(DVec3, DVec3)> {
        let n1 = self.turn_along((c1, c2), ng)?;
        let along = c1.xyz() + ng * c1.w + n1 * r;
        let along = along - ng * ng.dot(along);
        let forward = along.is_finite() && along.dot(self.forward.cross(ng)) > 0.0;
        forward.then_some((along, n1 - ng * ng.dot(n1)))
    }

    /// ∂n/∂s at a fixed angle of n = −a t + √(1 − a²) (e cos + f sin) with a = r′/|c′|; `None` at an
    /// end or a corner.
    fn turn_along(&self, (c1, c2): (DVec4, DVec4), ng: DVec3) -> Option<DVec3> {
        let Self { t, t1, e, e1, turn, .. } = *self;
        let speed = c1.xyz().length();
        let a = c1.w / speed;
        if !((ng.dot(t) + a).abs() <= LEAN && a.abs() < 1.0) {
            return None;
        }
        let a1 = c2.w / speed - a * t.dot(c2.xyz()) / speed;
        let b = (1.0 - a * a).sqrt();
        let f1 = e1.cross(t) + e.cross(t1);
        let (sin, cos) = turn.sin_cos();
        let out = e * cos + e.cross(t) * sin;
        let out1 = e1 * cos + f1 * sin;
        Some(out1 * b - t1 * a - t * a1 - out * (a * a1 / b))
    }
}
