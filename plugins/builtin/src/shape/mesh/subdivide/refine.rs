//! From one level to the next.
//!
//! Points of the next level are those of this one, then one for each edge, then, where faces have a
//! point in their middle, one for each face. Its edges are two for each edge, in the order of its
//! ends, and then one for each corner.

use std::iter::Sum;
use std::ops::{Add, Mul};

use luxel_sdk::params::BuildContext;

use super::Scheme;
use super::rules::{after_a_level, middles, moved, of_corners, of_edges};
use super::topology::{Level, NONE, Sides};
use crate::stop::{go_on, wanted};

/// Splits every face.
///
/// # Errors
/// If it is not wanted any more.
pub(super) fn refine(
    level: &Level,
    scheme: Scheme,
    context: &dyn BuildContext,
) -> Result<Level, String> {
    let own_middles = match scheme {
        Scheme::CatmullClark => middles(level, context)?,
        Scheme::Loop => vec![],
    };
    let of_corners = of_corners(level, scheme, &own_middles, context)?;
    let mut points = moved(level, scheme, &of_corners, context)?;
    points.extend(of_edges(level, scheme, &of_corners, context)?);
    drop(of_corners);
    points.extend(own_middles);
    let n_points = points.len();
    let mut out = Level {
        points,
        sides: Sides::All(if scheme == Scheme::Loop { 3 } else { 4 }),
        corners: Vec::with_capacity(4 * level.corners.len()),
        edges: Vec::with_capacity(4 * level.corners.len()),
        ends: vec![],
        joins: vec![],
        sharp: level.sharp.iter().flat_map(|s| [after_a_level(*s); 2]).collect(),
        pins: level.pins.iter().map(|pin| after_a_level(*pin)).collect(),
    };
    out.pins.resize(n_points, 0.0);
    match scheme {
        Scheme::CatmullClark => quads(level, &mut out, context),
        Scheme::Loop => triangles(level, &mut out, context),
    }
    go_on(context)?;
    out.sharp.resize(out.ends.len(), 0.0);
    join(level, &mut out, context);
    go_on(context)?;
    Ok(out)
}

/// What faces become of points and edges: how both are counted at the next level.
struct Split<'a> {
    level: &'a Level,
    n_points: u32,
    n_edges: u32,
}

impl<'a> Split<'a> {
    fn new(level: &'a Level) -> Self {
        let count = |n: usize| u32::try_from(n).expect("as many as triangles are allowed");
        Self { level, n_points: count(level.points.len()), n_edges: count(level.ends.len()) }
    }

    /// The point on the edge that begins at a corner.
    fn on_edge(&self, corner: u32) -> u32 {
        self.n_points + self.level.edges[corner as usize]
    }

    /// The half of the edge `side` at the point of `corner`.
    fn half(&self, side: u32, corner: u32) -> u32 {
        let edge = self.level.edges[side as usize];
        let at = self.level.corners[corner as usize];
        2 * edge + u32::from(self.level.ends[edge as usize][0] != at)
    }

    /// The edge across the face, before a corner.
    fn inside(&self, corner: u32) -> u32 {
        2 * self.n_edges + corner
    }

    /// The two halves of each edge.
    fn halves(&self) -> impl Iterator<Item = [u32; 2]> {
        let edges = self.level.ends.iter().zip(self.n_points..);
        edges.flat_map(|([a, b], middle)| [[*a, middle], [*b, middle]])
    }
}

/// Each corner becomes a quad: the corner, the middle of its edge, that of its face, and that of the
/// edge before.
fn quads(level: &Level, out: &mut Level, context: &dyn BuildContext) {
    let split = Split::new(level);
    out.ends.extend(wanted(split.halves(), context));
    let middles = split.n_points + split.n_edges..;
    for (face, range) in wanted(middles.zip(level.faces()), context) {
        for corner in range {
            let corner = u32::try_from(corner).expect("corners are counted in u32");
            let before = level.before(corner);
            let (ahead, behind) = (split.on_edge(corner), split.on_edge(before));
            out.ends.push([ahead, face]);
            out.corners.extend([level.corners[corner as usize], ahead, face, behind]);
            out.edges.extend([
                split.half(corner, corner),
                split.inside(corner),
                split.inside(before),
                split.half(before, corner),
            ]);
        }
    }
}

/// Each corner becomes a triangle, and what is left in the middle a fourth.
fn triangles(level: &Level, out: &mut Level, context: &dyn BuildContext) {
    let split = Split::new(level);
    out.ends.extend(wanted(split.halves(), context));
    for range in wanted(level.faces(), context) {
        let first = u32::try_from(range.start).expect("corners are counted in u32");
        let corners = [first, first + 1, first + 2];
        for corner in corners {
            let before = level.before(corner);
            let (ahead, behind) = (split.on_edge(corner), split.on_edge(before));
            out.ends.push([ahead, behind]);
            out.corners.extend([level.corners[corner as usize], ahead, behind]);
            let halves = [split.half(corner, corner), split.half(before, corner)];
            out.edges.extend([halves[0], split.inside(corner), halves[1]]);
        }
        out.corners.extend(corners.map(|c| split.on_edge(c)));
        out.edges.extend(corners.map(|c| split.inside(level.next(c))));
    }
}

/// Finds which sides make each edge: those of an edge at which no faces join stay apart.
fn join(level: &Level, out: &mut Level, context: &dyn BuildContext) {
    let apart = |edge: usize| level.joins.get(edge / 2).is_some_and(|join| join[0] == NONE);
    out.joins = vec![[NONE; 2]; out.ends.len()];
    for (side, edge) in wanted((0..).zip(out.edges.iter().map(|edge| *edge as usize)), context) {
        if !apart(edge) {
            let join = &mut out.joins[edge];
            let free = usize::from(join[0] != NONE);
            join[free] = side;
        }
    }
}

/// What corners carry, at the next level: linear within each face, and alike on both sides of an
/// edge to the last bit where it is alike at its ends.
///
/// # Errors
/// If it is not wanted any more.
pub(super) fn values<T>(
    level: &Level,
    scheme: Scheme,
    of_corners: &[T],
    context: &dyn BuildContext,
) -> Result<Vec<T>, String>
where
    T: Copy + Add<Output = T> + Mul<f32, Output = T> + Sum,
{
    if of_corners.is_empty() {
        return Ok(vec![]);
    }
    let mut out = Vec::with_capacity(4 * of_corners.len());
    for range in wanted(level.faces(), context) {
        let own = &of_corners[range];
        let n = own.len();
        let middle = |i: usize| (own[i] + own[(i + 1) % n]) * 0.5;
        let face = own.iter().copied().sum::<T>() * (n as f32).recip();
        for (i, value) in own.iter().enumerate() {
            out.extend([*value, middle(i)]);
            if scheme == Scheme::CatmullClark {
                out.push(face);
            }
            out.push(middle((i + n - 1) % n));
        }
        if scheme == Scheme::Loop {
            out.extend((0..n).map(middle));
        }
    }
    go_on(context)?;
    Ok(out)
}
