//! Surfaces that are told by a distance alone: f vanishes on them and changes by no more than the
//! way. A step of |f| along a ray cannot pass them; a field may know of longer ones that cannot
//! either. No other step is made.
//!
//! # Source
//! Hart 1996, "Sphere Tracing": steps of |f|. Galin et al. 2020, "Segment Tracing using Local
//! Lipschitz Bounds": a bound for what lies ahead on the line instead of for all directions.

use glam::{DVec2, DVec3};
use luxel_sdk::kind::{Hit, NormalDerivatives, Surface};
use luxel_sdk::num::{Bounds3, Ray, gamma64, offset_origin};
use luxel_sdk::sampling::sobol_owen_2d;

use super::axial::length_of;

/// A function with |f(p) − f(q)| ≤ |p − q|, negative inside, found to within `Way::error`.
pub(super) trait Field {
    /// What is remembered along one line.
    type Known: Default;

    /// f at a point, metres.
    fn value(&self, p: DVec3) -> f64;

    /// The gradient of f; where it comes from differences, they are over `step` metres.
    fn gradient(&self, p: DVec3, step: f64) -> DVec3;

    /// The derivative of the gradient along `d`, metres; where it comes from differences, of a function
    /// known to `error` in a box of `size`, both metres. `None` where the gradient jumps.
    fn bend(&self, p: DVec3, d: DVec3, size: f64, error: f64) -> Option<DVec3>;

    /// f at a place of a line, and what is known to lie ahead. Places are asked for in order.
    fn look(&self, way: &Way, s: f64, _known: &mut Self::Known) -> Look {
        let value = self.value(way.at(s));
        Look { value, free: value.abs(), met: false }
    }
}

/// A line of unit direction.
pub(super) struct Way {
    o: DVec3,
    pub(super) d: DVec3,
    /// How far a value of the field may be off along it, metres.
    pub(super) error: f64,
}

impl Way {
    pub(super) fn at(&self, s: f64) -> DVec3 {
        self.o + self.d * s
    }
}

/// What a field tells at a place of a line.
pub(super) struct Look {
    /// f there, metres.
    pub(super) value: f64,
    /// For how many metres ahead f keeps its sign: a lower bound.
    pub(super) free: f64,
    /// Whether f is known to change its sign at the end of these.
    pub(super) met: bool,
}

/// The gradient of a function, by differences.
pub(super) fn differences(f: impl Fn(DVec3) -> f64, p: DVec3, step: f64) -> DVec3 {
    let along = |axis: DVec3| (f(p + axis * step) - f(p - axis * step)) / (2.0 * step);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
}

/// How often `bend` tries, with steps a quarter as long each time.
const TRIES: u32 = 4;
/// By how much of them two second differences may disagree: by more, one of them is across an edge.
const AGREE: f64 = 1e-3;

/// The derivative along `d` of the gradient of a function that is known to `error` in a box of `size`.
///
/// Second differences over h and 2h leave out h² times a fourth derivative, which both together
/// tell, and then h⁴; they round by error / h². The first step balances these. Near an edge of the
/// function they disagree, until the step is short enough not to reach it.
pub(super) fn bend(
    f: impl Fn(DVec3) -> f64,
    p: DVec3,
    d: DVec3,
    (size, error): (f64, f64),
) -> Option<DVec3> {
    let length = d.length();
    let over = |step: f64| {
        let gradient = |side: f64| differences(&f, p + d * (side * step / length), step);
        (gradient(1.0) - gradient(-1.0)) / (2.0 * step)
    };
    let mut step = size * (error / size).powf(1.0 / 6.0);
    for _ in 0..TRIES {
        let (wide, narrow) = (over(2.0 * step), over(step));
        let rounds = 8.0 * error / (step * step);
        if (wide - narrow).length() <= AGREE * narrow.length() + rounds {
            return Some((narrow + (narrow - wide) / 3.0) * length);
        }
        step *= 0.25;
    }
    None
}

/// How far a value may be off inside these bounds, metres: what `Shape::distance` promises of each
/// part, and the roundings that join them.
fn error(bounds: &Bounds3) -> f64 {
    gamma64(80) * bounds.min.abs().max(bounds.max.abs()).max_element()
}

/// How far a box is away, negative inside.
pub(super) fn box_distance(bounds: &Bounds3, p: DVec3) -> f64 {
    let out = (p - bounds.centre()).abs() - 0.5 * bounds.diagonal();
    out.max(DVec3::ZERO).length() + out.max_element().min(0.0)
}

/// The most steps of one ray.
///
/// A ray that leaves a flat surface at an angle θ takes ln(size / error) / θ of them, 32 / θ; one that
/// passes a ball of radius R at a height h π·√(R / 2h). More is needed by what crawls along a surface.
const MOST_STEPS: u32 = 1 << 16;
/// So near to the surface, in sizes of the box, a ray steps to where its last steps say that it is.
/// Crossings nearer to each other than `FORWARD` such lengths may count as one.
const NEAR: f64 = 1.0 / (1u64 << 30) as f64;
const FORWARD: f64 = 64.0;

/// A line through a field, from where it enters the box.
struct Line<'f, F> {
    field: &'f F,
    way: Way,
    /// Where the box is left, metres.
    end: f64,
    near: f64,
}

/// The first root along a ray, within the box.
pub(super) fn march<F: Field>(field: &F, bounds: &Bounds3, ray: &Ray) -> Option<Hit> {
    let length = length_of(ray)?;
    let d = ray.d / length;
    let (enter, leave) = through(bounds, ray.o, d)?;
    let near = NEAR * bounds.diagonal().length();
    // From where it enters: from afar the ray's own parameter is too coarse to march by.
    let way = Way { o: ray.o + d * enter, d, error: error(bounds) };
    // Beyond the ray's end by what rounds, at most.
    let stop = ray.t_max * length * (1.0 + gamma64(16)) - enter + way.error;
    let line = Line { field, way, end: leave - enter, near };
    let t = (enter + line.root(stop)?) / length;
    (t > 0.0 && t <= ray.t_max).then_some(Hit { t, at: DVec2::ZERO, face: 0 })
}

/// Where a line is in a box, from its origin on; a little more than that.
fn through(bounds: &Bounds3, o: DVec3, d: DVec3) -> Option<(f64, f64)> {
    let (enter, leave) = bounds.intersect_ray(o, d.recip(), f64::INFINITY)?;
    let room = gamma64(8) * (enter + leave.abs());
    let (enter, leave) = ((enter - room).max(0.0), leave + room);
    (enter <= leave && leave.is_finite()).then_some((enter, leave))
}

impl<F: Field> Line<'_, F> {
    fn at(&self, s: f64) -> f64 {
        self.field.value(self.way.at(s))
    }

    /// The first change of sign before `stop`.
    ///
    /// Steps are as long as the field allows, and no shorter than f's own error: what that skips
    /// cannot be told from nothing. A ray that has not come through after `MOST_STEPS` is said to meet
    /// the surface that it crawls along, where it is nearest to it in the second half of these: no
    /// farther than its way over their number. So a touch may be made up, but never a gap.
    fn root(&self, stop: f64) -> Option<f64> {
        let mut known = F::Known::default();
        let mut s = 0.0;
        let mut here = self.field.look(&self.way, s, &mut known);
        let outside = here.value > 0.0;
        let mut nearest = (f64::INFINITY, 0.0);
        for i in 0..MOST_STEPS {
            if !(s < self.end && s <= stop) {
                return None;
            }
            let step = here.free.max(self.way.error);
            if here.met {
                return Some(s + step);
            }
            let next = (s + step).min(self.end);
            let step = next - s;
            let there = self.field.look(&self.way, next, &mut known);
            let (f, g) = (here.value, there.value);
            if (g > 0.0) != outside {
                return Some(self.between((s, f), (next, g)));
            }
            if g.abs() < self.near && g.abs() < f.abs() {
                // As straight as it came, and a quarter farther.
                let rest = 1.25 * g.abs() * step / (f - g).abs() + self.way.error;
                let beyond = next + rest.min(FORWARD * self.near);
                let h = self.at(beyond);
                if (h > 0.0) != outside && beyond <= self.end {
                    return Some(self.between((next, g), (beyond, h)));
                }
            }
            if i >= MOST_STEPS / 2 && g.abs() < nearest.0 {
                nearest = (g.abs(), next);
            }
            (s, here) = (next, there);
        }
        Some(nearest.1)
    }

    /// The root between two places where the sign differs: by secants, halves where one end stays.
    fn between(&self, mut a: (f64, f64), mut b: (f64, f64)) -> f64 {
        let width = 0.25 * self.way.error;
        for i in 0..128 {
            if !(b.0 - a.0 > width) {
                break;
            }
            let secant = b.0 - b.1 * (b.0 - a.0) / (b.1 - a.1);
            let halved = 0.5 * (a.0 + b.0);
            let s = if i % 3 < 2 && secant > a.0 && secant < b.0 { secant } else { halved };
            let f = self.at(s);
            if (f > 0.0) == (a.1 > 0.0) {
                a = (s, f);
            } else {
                b = (s, f);
            }
        }
        if a.1.abs() < b.1.abs() && a.0 > 0.0 { a.0 } else { b.0 }
    }
}

/// Steps of Newton's from where the ray's parameter says, across the surface.
const POLISH: u32 = 3;

/// The point that a hit names.
///
/// The step of the differences balances what they round, error / step, against what they leave out,
/// step² times a third derivative: (error / size)^⅔ of the normal each.
pub(super) fn surface_of<F: Field>(field: &F, bounds: &Bounds3, ray: &Ray, hit: &Hit) -> Surface {
    let (size, error) = (bounds.diagonal().length(), error(bounds));
    let step = size * (error / size).cbrt();
    let mut p = ray.at(hit.t);
    let mut gradient = field.gradient(p, step);
    for _ in 0..POLISH {
        let f = field.value(p);
        let moved = gradient * (f / gradient.length_squared());
        // Not where the gradient says nothing: at an edge, or where two surfaces meet.
        if !(moved.length() <= 1e-3 * size) || f.abs() <= 0.0 {
            break;
        }
        p -= moved;
    }
    if (p - ray.at(hit.t)).length() > 0.0 {
        gradient = field.gradient(p, step);
    }
    let steep = gradient.length().clamp(1e-3, 1.0);
    let ng = gradient.normalize_or(-ray.d.normalize());
    // Where f is known to `error`, the point is known to that over how steeply f changes; and once
    // more for the ray that starts here.
    let p_err = DVec3::splat(2.0 * error / steep + field.value(p).abs() / steep);
    let (uv, dp_du, dp_dv) = flat_coordinates(p, ng, size);
    Surface { p, p_err, ng, ns: ng, uv, dp_du, dp_dv }
}

/// How the normal turns at a point that `surface_of` found: that of ∇f / |∇f| along the coordinates.
///
/// # Source
/// Goldman 2005, "Curvature formulas for implicit curves and surfaces".
pub(super) fn turns_of<F: Field>(
    field: &F,
    bounds: &Bounds3,
    at: &Surface,
) -> Option<NormalDerivatives> {
    let (size, error) = (bounds.diagonal().length(), error(bounds));
    let steep = field.gradient(at.p, size * (error / size).cbrt()).length();
    let along = |d: DVec3| {
        let bend = field.bend(at.p, d, size, error)?;
        let turn = (bend - at.ns * at.ns.dot(bend)) / steep;
        turn.is_finite().then_some(turn)
    };
    Some(NormalDerivatives { dn_du: along(at.dp_du)?, dn_dv: along(at.dp_dv)? })
}

/// The two coordinates across which the surface is flattest, in lengths of `scale`.
fn flat_coordinates(p: DVec3, n: DVec3, scale: f64) -> (DVec2, DVec3, DVec3) {
    let axis = n.abs().max_position();
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let (u, v) = if n[axis] > 0.0 { (next, last) } else { (last, next) };
    let along = |i: usize| {
        let mut d = DVec3::AXES[i];
        d[axis] = -n[i] / n[axis];
        d * scale
    };
    (DVec2::new(p[u], p[v]) / scale, along(u), along(v))
}

/// Lines along each axis by which an area is measured, and crossings of one.
const LINES: u32 = 1 << 14;
const CROSSINGS: u32 = 1024;

/// The area of a surface in a box, by lines along the axes, to about a thousandth: `first` finds the
/// first crossing of a ray. A crossing counts for 1 / (|nx| + |ny| + |nz|) of what a line stands for,
/// so that the three families share the area, and none counts for more than its square. The lines
/// are scattered evenly but in no pattern that a shape may have too.
pub(super) fn area_by_lines(bounds: &Bounds3, first: impl Fn(&Ray) -> Option<Surface>) -> f64 {
    let size = bounds.diagonal();
    let mut area = 0.0;
    for (axis, seed) in [(0, 0x5eed), (1, 0xa11e), (2, 0xcafe)] {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let part = size[u] * size[v] / f64::from(LINES);
        let d = DVec3::AXES[axis];
        for i in 0..LINES {
            let at = sobol_owen_2d(i, seed).map(f64::from);
            let mut o = bounds.min - d * size[axis];
            o[u] = bounds.min[u] + size[u] * at[0];
            o[v] = bounds.min[v] + size[v] * at[1];
            for _ in 0..CROSSINGS {
                let Some(s) = first(&Ray::new(o, d)) else { break };
                let n = s.ng.abs();
                area += part / (n.x + n.y + n.z);
                o = offset_origin(s.p, s.p_err, s.ng, d);
            }
        }
    }
    area
}
