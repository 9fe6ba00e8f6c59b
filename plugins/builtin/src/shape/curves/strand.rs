//! Strands: points, radii and directions across, made ready to be met by lines.

use glam::{DVec3, DVec4};
use luxel_sdk::num::{Bounds3, Ray, gamma64};
use luxel_sdk::params::{BuildContext, Fault};

use super::cubic::{Cubic, segments};
use super::{Basis, Form};
use crate::stop::{STRIDE, gather, go_on};

/// What a scene says of curves.
pub(super) struct Given<'a> {
    pub(super) points: &'a [f64],
    pub(super) radius: f64,
    pub(super) radii: &'a [f64],
    pub(super) strands: &'a [f64],
    pub(super) normals: &'a [f64],
    pub(super) basis: Basis,
    pub(super) form: Form,
}

/// All strands of a shape.
#[derive(Debug)]
pub(crate) struct Strands {
    pub(super) strands: Vec<Strand>,
    pub(super) bounds: Bounds3,
}

impl Strands {
    /// The strand of a segment, which are counted through.
    pub(super) fn of_segment(&self, segment: u32) -> &Strand {
        let after = self.strands.partition_point(|strand| strand.first <= segment);
        &self.strands[after.saturating_sub(1)]
    }
}

/// One strand, in lengths of a power of two about its middle: within the unit ball.
#[derive(Debug)]
pub(super) struct Strand {
    pub(super) centre: DVec3,
    /// Metres of a unit: a power of two.
    pub(super) unit: f64,
    /// How many segments all strands before it have.
    pub(super) first: u32,
    pub(super) segments: Vec<Segment>,
    /// Over the segments in their order: each node, then what is below its first half.
    boxes: Vec<Bounds3>,
    pub(super) bounds: Bounds3,
}

/// A segment of a strand.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    /// Points, and the radius.
    pub(super) curve: Cubic<DVec4>,
    /// Across: half the width of a ribbon; of a rod, where `v` is 0.
    pub(super) across: Cubic<DVec3>,
}

/// What rounding may do to the distance between a line and a strand, in units of the strand: a
/// control point in the frame of a line rounds twelve times, averages nine times, a distance three.
pub(super) const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Bound on the error of a point, in units of the strand: that of the line by which it was found,
/// its own, and that of the line that leaves it.
const POINT: f64 = 4.0 * ROUNDING;

impl Given<'_> {
    /// The strands.
    pub(super) fn strands(&self, context: &dyn BuildContext) -> Result<Strands, Fault> {
        let points = triples("points", self.points, context)?;
        let radii = self.all_radii(points.len())?;
        let normals = triples("normals", self.normals, context)?;
        if !normals.is_empty() && normals.len() != points.len() {
            let message = format!("{} normals for {} points", normals.len(), points.len());
            return Err(Fault::mesh("normals", message));
        }
        let (mut strands, mut bounds, mut at, mut first) = (vec![], Bounds3::EMPTY, 0, 0);
        let mut looked = 0;
        for n in self.counts(points.len())? {
            if at >= looked {
                go_on(context).map_err(stopped)?;
                looked = at + STRIDE;
            }
            let range = at..at + n;
            let normals = if normals.is_empty() { &normals[..] } else { &normals[range.clone()] };
            let strand = self.strand(
                (&points[range.clone()], &radii[range], normals),
                (at, first),
                context,
            )?;
            bounds = bounds.union(strand.bounds);
            first += strand.count();
            at += n;
            strands.push(strand);
        }
        Ok(Strands { strands, bounds })
    }

    fn all_radii(&self, n: usize) -> Result<Vec<f64>, Fault> {
        if self.radii.is_empty() {
            super::super::check_length("radius", self.radius)?;
            return Ok(vec![self.radius; n]);
        }
        if self.radii.len() != n {
            let message = format!("{} radii for {n} points", self.radii.len());
            return Err(Fault::mesh("radii", message));
        }
        let wrong = |r: &f64| !(*r >= 0.0 && *r <= super::super::LONGEST);
        if let Some(i) = self.radii.iter().position(wrong) {
            let message = format!("{:e} m at point {i}: it must be 0 or more", self.radii[i]);
            return Err(Fault::mesh("radii", message));
        }
        Ok(self.radii.to_vec())
    }

    /// How many points each strand has.
    fn counts(&self, n: usize) -> Result<Vec<usize>, Fault> {
        let (field, counts) = match *self.strands {
            [] => ("points", vec![n]),
            [each] => {
                let each = whole(each, 0)?;
                if n == 0 || !n.is_multiple_of(each) {
                    let message = format!("{n} points in strands of {each}: some are left over");
                    return Err(Fault::mesh("strands", message));
                }
                ("strands", vec![each; n / each])
            }
            _ => {
                let counts = self.strands.iter().enumerate();
                let counts: Result<Vec<_>, _> = counts.map(|(i, x)| whole(*x, i)).collect();
                let counts = counts?;
                let sum: usize = counts.iter().fold(0, |sum, n| sum.saturating_add(*n));
                if sum != n {
                    let message = format!("strands of {sum} points in all, but there are {n}");
                    return Err(Fault::mesh("strands", message));
                }
                ("strands", counts)
            }
        };
        for (i, n) in counts.iter().enumerate() {
            let (fits, want) = match self.basis {
                Basis::Bezier => (*n >= 4 && n % 3 == 1, "4, 7, 10 … make Bézier segments"),
                Basis::Bspline => (*n >= 4, "a B-spline has 4 or more"),
            };
            if !fits {
                return Err(Fault::mesh(field, format!("strand {i} has {n} points: {want}")));
            }
        }
        Ok(counts)
    }

    fn strand(
        &self,
        (points, radii, normals): (&[DVec3], &[f64], &[DVec3]),
        (at, first): (usize, u32),
        context: &dyn BuildContext,
    ) -> Result<Strand, Fault> {
        let widest = radii.iter().fold(0.0, |a: f64, r| a.max(*r));
        if widest <= 0.0 {
            let message = format!("all 0 from point {at} on: the strand is nowhere");
            return Err(Fault::mesh("radii", message));
        }
        let centre = Bounds3::of_points(points.iter().copied()).centre();
        let reach = points.iter().map(|p| (*p - centre).length()).fold(0.0, f64::max) + widest;
        // The next power of two, of which products are exact.
        let unit = reach.log2().ceil().exp2();
        let local = points.iter().zip(radii);
        let local = local.map(|(p, r)| ((*p - centre) / unit).extend(r / unit));
        let local = long(local, context)?;
        let mut across = across(&local, normals, at, context)?;
        if self.form == Form::Ribbon {
            across.iter_mut().zip(&local).for_each(|(b, p)| *b *= p.w);
        }
        let is_bspline = self.basis == Basis::Bspline;
        let curves = segments(&local, is_bspline);
        let both = curves.into_iter().zip(segments(&across, is_bspline));
        let segments = long(both.map(|(curve, across)| Segment { curve, across }), context)?;
        let mut boxes = Vec::with_capacity(2 * segments.len());
        let hull = self.hull(&segments, &mut boxes);
        let room = DVec3::splat(unit * POINT) + (centre.abs() + unit) * gamma64(8);
        let bounds =
            Bounds3 { min: centre + hull.min * unit - room, max: centre + hull.max * unit + room };
        Ok(Strand { centre, unit, first, segments, boxes, bounds })
    }

    /// Boxes over segments, each in front of those below it; the outermost is the result.
    fn hull(&self, segments: &[Segment], boxes: &mut Vec<Bounds3>) -> Bounds3 {
        let place = boxes.len();
        boxes.push(Bounds3::EMPTY);
        let hull = if let [segment] = segments {
            let ends = |(p, b): (&DVec4, &DVec3)| {
                let half = if self.form == Form::Ribbon { b.abs() } else { DVec3::splat(p.w) };
                let half = half + ROUNDING;
                Bounds3 { min: p.truncate() - half, max: p.truncate() + half }
            };
            let all = segment.curve.iter().zip(&segment.across).map(ends);
            all.fold(Bounds3::EMPTY, Bounds3::union)
        } else {
            let (a, b) = segments.split_at(segments.len() / 2);
            let a = self.hull(a, boxes);
            a.union(self.hull(b, boxes))
        };
        boxes[place] = hull;
        hull
    }
}

/// A count of points.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "whole and within the numbers of 32 bits"
)]
fn whole(x: f64, i: usize) -> Result<usize, Fault> {
    if x >= 1.0 && x <= f64::from(u32::MAX) && x.fract() == 0.0 {
        return Ok(x as usize);
    }
    Err(Fault::mesh("strands", format!("{x} in place {i} is no number of points")))
}

/// All of what may be many; of a short strand, without a look at whether it is still wanted.
fn long<I: ExactSizeIterator>(items: I, context: &dyn BuildContext) -> Result<Vec<I::Item>, Fault> {
    if items.len() < STRIDE { Ok(items.collect()) } else { gather(items, context).map_err(stopped) }
}

/// The fault of strands that are not wanted any more.
fn stopped(message: String) -> Fault {
    Fault::mesh("points", message)
}

fn triples(
    field: &'static str,
    numbers: &[f64],
    context: &dyn BuildContext,
) -> Result<Vec<DVec3>, Fault> {
    if !numbers.len().is_multiple_of(3) {
        let message = format!("{} numbers: x y z of each point are wanted", numbers.len());
        return Err(Fault::mesh(field, message));
    }
    if let Some(i) = numbers.iter().position(|x| !(x.abs() <= super::super::LONGEST)) {
        let message = format!("{:e} at point {}: it is beyond every measure", numbers[i], i / 3);
        return Err(Fault::mesh(field, message));
    }
    long(numbers.chunks_exact(3).map(DVec3::from_slice), context)
}

/// Unit vectors across the curve at its points: square to where each faces, or, from level, carried
/// along the points with as little twist as can be.
///
/// # Source
/// Wang et al. 2008, "Computation of rotation minimizing frames": two reflections per step.
fn across(
    points: &[DVec4],
    normals: &[DVec3],
    at: usize,
    context: &dyn BuildContext,
) -> Result<Vec<DVec3>, Fault> {
    let tangents = tangents(points, context)?;
    if !normals.is_empty() {
        let square = |(i, (n, t)): (usize, (&DVec3, &DVec3))| {
            let n = n.normalize_or_zero();
            let message = || format!("{n} at point {} does not face away from the curve", at + i);
            n.cross(*t).try_normalize().ok_or_else(|| Fault::mesh("normals", message()))
        };
        return normals.iter().zip(&tangents).enumerate().map(square).collect();
    }
    let level = DVec3::Y.cross(tangents[0]);
    let mut b =
        if level.length() > LEVEL { level.normalize() } else { square_to(tangents[0], DVec3::X) };
    let mut all = vec![b];
    for (i, (p, t)) in points.windows(2).zip(tangents.windows(2)).enumerate() {
        if i % STRIDE == STRIDE - 1 {
            go_on(context).map_err(stopped)?;
        }
        let step = p[1].truncate() - p[0].truncate();
        let first = mirror(step);
        let (b1, t1) = (first(b), first(t[0]));
        b = square_to(t[1], mirror(t[1] - t1)(b1));
        all.push(b);
    }
    Ok(all)
}

/// Below this share of the horizontal a curve counts as upright.
const LEVEL: f64 = 1e-6;

/// The reflection that swaps the ends of `v`; nothing for no vector.
fn mirror(v: DVec3) -> impl Fn(DVec3) -> DVec3 {
    let c = v.length_squared();
    move |x| if c > 0.0 { x - v * (2.0 * v.dot(x) / c) } else { x }
}

/// The part of `b` across the unit vector `t`, unit; any if there is none.
pub(super) fn square_to(t: DVec3, b: DVec3) -> DVec3 {
    (b - t * t.dot(b)).try_normalize().unwrap_or_else(|| t.any_orthonormal_vector())
}

/// Unit tangents at the points, from their neighbours; where those coincide, that before.
fn tangents(points: &[DVec4], context: &dyn BuildContext) -> Result<Vec<DVec3>, Fault> {
    let between =
        |i: usize, j: usize| (points[j].truncate() - points[i].truncate()).try_normalize();
    let last = points.len() - 1;
    let some = (1..=last).find_map(|i| between(0, i));
    let mut before = some.unwrap_or(DVec3::Z);
    let at = |i: usize| {
        before = between(i.saturating_sub(1), (i + 1).min(last)).unwrap_or(before);
        before
    };
    long((0..points.len()).map(at), context)
}

impl Strand {
    pub(super) fn count(&self) -> u32 {
        u32::try_from(self.segments.len()).expect("tables of a scene are shorter")
    }

    /// A point of the strand in metres, and the bound of its error.
    pub(super) fn place(&self, p: DVec3) -> (DVec3, DVec3) {
        let p_err = self.centre.abs() * gamma64(6) + DVec3::splat(self.unit * POINT);
        (self.centre + p * self.unit, p_err)
    }

    /// Shows the segments whose boxes the line enters to `see`, in order; it gives how far on the
    /// line there is something to see.
    pub(super) fn along(&self, line: &Line, mut see: impl FnMut(u32, &Segment, f64) -> f64) {
        // Of a single segment the box is that of the strand, which the ray has entered.
        if let [segment] = &self.segments[..] {
            see(0, segment, line.to);
            return;
        }
        let walk = Walk { strand: self, line, recip: line.d.recip() };
        walk.below(0, 0..self.segments.len(), line.to, &mut see);
    }
}

/// A line on its way through the boxes of a strand.
struct Walk<'a> {
    strand: &'a Strand,
    line: &'a Line,
    recip: DVec3,
}

impl Walk<'_> {
    /// What is below a box, and how far there is something to see after it.
    fn below(
        &self,
        node: usize,
        segments: std::ops::Range<usize>,
        far: f64,
        see: &mut dyn FnMut(u32, &Segment, f64) -> f64,
    ) -> f64 {
        // The strand's middle stands across from the line's origin, and its unit boxes reach √3 from
        // there: within 2 along the line, and within 4 of where it sets out.
        let back = self.line.o - self.line.d * 4.0;
        let Some((enter, leave)) = self.strand.boxes[node].intersect_ray(back, self.recip, 8.0)
        else {
            return far;
        };
        if enter - 4.0 > far + ROUNDING || leave - 4.0 < self.line.from - ROUNDING {
            return far;
        }
        let n = segments.len();
        if n == 1 {
            let number = u32::try_from(segments.start).expect("tables of a scene are shorter");
            return see(number, &self.strand.segments[segments.start], far);
        }
        let middle = segments.start + n / 2;
        let far = self.below(node + 1, segments.start..middle, far, see);
        self.below(node + 2 * (n / 2), middle..segments.end, far, see)
    }
}

/// A line in the units of a strand, from its point that is nearest to the strand's middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) o: DVec3,
    /// Unit, and two vectors square to it.
    pub(super) d: DVec3,
    x: DVec3,
    y: DVec3,
    /// Where the ray begins.
    pub(super) from: f64,
    /// Where it ends, and what rounds.
    pub(super) to: f64,
    /// Units to a length of the ray's direction.
    per_t: f64,
}

impl Line {
    /// `None` for a ray that is not finite, or passes the strand by.
    pub(super) fn of(strand: &Strand, ray: &Ray) -> Option<Self> {
        let length = super::super::axial::length_of(ray)?;
        let far = (ray.o - strand.centre) / strand.unit;
        let d = ray.d / length;
        let shift = -far.dot(d);
        let near = far + d * shift;
        // Once more: what the first shift rounded was relative to the distance.
        let rest = -near.dot(d);
        let o = near + d * rest;
        // Beyond the corners of the unit boxes: √3.
        if !(o.length() <= 2.0) {
            return None;
        }
        let (from, per_t) = (-(shift + rest), length / strand.unit);
        let to = ray.t_max * per_t + from;
        let to = to + (to.abs() + from.abs()) * gamma64(8);
        if to.is_nan() {
            return None;
        }
        let (x, y) = d.any_orthonormal_pair();
        Some(Self { o, d, x, y, from, to, per_t })
    }

    /// The ray's parameter at a place of the line.
    pub(super) fn t(&self, at: f64) -> f64 {
        (at - self.from) / self.per_t
    }

    /// A vector's parts across and along the line.
    pub(super) fn turned(&self, v: DVec3) -> DVec3 {
        DVec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.d))
    }

    /// A point's place across and along the line.
    pub(super) fn seen(&self, p: DVec3) -> DVec3 {
        self.turned(p - self.o)
    }

    /// The vector with these parts.
    pub(super) fn turned_back(&self, v: DVec3) -> DVec3 {
        self.x * v.x + self.y * v.y + self.d * v.z
    }
}
