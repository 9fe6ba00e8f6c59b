//! How faces join, level by level.

use glam::{DVec3, Vec2, Vec3};
use luxel_sdk::params::{BuildContext, Fault};

use super::super::inline::index;
use super::super::net::Net;
use super::super::polygons::{Polygons, pick};
use crate::stop::{gather, go_on, wanted};

/// No corner.
pub(super) const NONE: u32 = u32::MAX;

/// The sharpness from which on an edge stays sharp for ever, as elsewhere.
const FOR_EVER: f64 = 10.0;

/// How many corners faces have.
#[derive(Clone, Debug)]
pub(super) enum Sides {
    /// As given: where each face's corners begin (and the last one's end), and each corner's face.
    Each { starts: Vec<u32>, face_of: Vec<u32> },
    /// All the same.
    All(u32),
}

/// The faces of one level. An edge runs from each corner to the next of its face, in the face's
/// order; so a corner also stands for that side of the edge.
#[derive(Clone, Debug)]
pub(super) struct Level {
    pub(super) points: Vec<DVec3>,
    pub(super) sides: Sides,
    /// The point of each corner.
    pub(super) corners: Vec<u32>,
    /// The edge from each corner to the next.
    pub(super) edges: Vec<u32>,
    /// The two points of each edge.
    pub(super) ends: Vec<[u32; 2]>,
    /// The corners whose sides make each edge: two, if two faces join there and run along it in
    /// opposite directions; the second is `NONE` at a boundary; both are where faces cannot join.
    pub(super) joins: Vec<[u32; 2]>,
    /// Levels for which each edge stays sharp; fractions are blended.
    pub(super) sharp: Vec<f32>,
    /// The same of each point.
    pub(super) pins: Vec<f32>,
}

impl Level {
    /// The first level, with creases of two points and a sharpness each.
    ///
    /// # Errors
    /// Creases along no edge; that it is not wanted any more.
    pub(super) fn build(
        faces: Polygons,
        creases: &[f64],
        context: &dyn BuildContext,
    ) -> Result<Self, Vec<Fault>> {
        let Polygons { points, starts, corners, same, .. } = faces;
        let face_of = (0..).zip(starts.windows(2));
        let face_of = face_of.flat_map(|(i, f)| (f[0]..f[1]).map(move |_| i)).collect();
        let n_points = points.len();
        let mut level = Self {
            edges: vec![NONE; corners.len()],
            points,
            sides: Sides::Each { starts, face_of },
            corners,
            ends: vec![],
            joins: vec![],
            sharp: vec![],
            pins: vec![0.0; n_points],
        };
        let stopped = |message| vec![Fault::mesh("subdivide", message)];
        level.join(context).map_err(stopped)?;
        level.pin_corners(context).map_err(stopped)?;
        level.crease(creases, &same)?;
        Ok(level)
    }

    /// The sides of faces by the points at their ends, the lesser first, then in their order.
    fn sides(&self, context: &dyn BuildContext) -> Result<Vec<(u32, u32, u32)>, String> {
        let n = u32::try_from(self.corners.len()).expect("corners are counted in u32");
        let ends = |h: u32| {
            let (a, b) = (self.corners[h as usize], self.corners[self.next(h) as usize]);
            (a.min(b), a.max(b), h)
        };
        // Where the sides of each first point begin; counted, then summed up.
        let mut begins = vec![0u32; self.points.len() + 1];
        wanted(0..n, context).for_each(|h| begins[ends(h).0 as usize + 1] += 1);
        let mut sum = 0;
        for begin in wanted(&mut begins, context) {
            sum += *begin;
            *begin = sum;
        }
        go_on(context)?;
        let (mut next, mut sides) = (begins.clone(), vec![(0, 0, 0); self.corners.len()]);
        for side in wanted(0..n, context).map(ends) {
            let at = &mut next[side.0 as usize];
            sides[*at as usize] = side;
            *at += 1;
        }
        for of_point in wanted(begins.windows(2), context) {
            sides[of_point[0] as usize..of_point[1] as usize].sort_unstable();
        }
        go_on(context)?;
        Ok(sides)
    }

    /// Finds the edges.
    fn join(&mut self, context: &dyn BuildContext) -> Result<(), String> {
        let ends = |h: u32| (self.corners[h as usize], self.corners[self.next(h) as usize]);
        let sides = self.sides(context)?;
        let mut of_corners = vec![NONE; self.corners.len()];
        let (mut all, mut joins, mut sharp) = (vec![], vec![], vec![]);
        for group in wanted(sides.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)), context) {
            for side in group {
                of_corners[side.2 as usize] = u32::try_from(all.len()).expect("as many as corners");
            }
            all.push([group[0].0, group[0].1]);
            let (join, is_sharp) = match group {
                [one] => ([one.2, NONE], true),
                [a, b] if ends(a.2).0 != ends(b.2).0 => ([a.2, b.2], false),
                // Three faces or more, or two that face opposite ways: each ends here.
                _ => ([NONE, NONE], true),
            };
            joins.push(join);
            sharp.push(if is_sharp { f32::INFINITY } else { 0.0 });
        }
        (self.edges, self.ends, self.joins, self.sharp) = (of_corners, all, joins, sharp);
        go_on(context)
    }

    /// Points of a single face, and points where surfaces touch in nothing else, stay where they are.
    fn pin_corners(&mut self, context: &dyn BuildContext) -> Result<(), String> {
        let mut faces = vec![0u32; self.points.len()];
        let mut fans = vec![0u32; self.points.len()];
        let mut closed = vec![false; self.points.len()];
        let mut seen = vec![false; self.corners.len()];
        for corner in wanted(0..u32::try_from(self.corners.len()).unwrap_or(NONE), context) {
            let point = self.corners[corner as usize] as usize;
            faces[point] += 1;
            if seen[corner as usize] {
                continue;
            }
            fans[point] += 1;
            let mut fan = vec![];
            closed[point] |= self.walk(corner, |_| false, &mut fan);
            for corner in fan {
                seen[corner as usize] = true;
            }
        }
        for (i, pin) in self.pins.iter_mut().enumerate() {
            let touches = closed[i] && fans[i] > 1;
            *pin = if faces[i] == 1 || touches { f32::INFINITY } else { 0.0 };
        }
        go_on(context)
    }

    fn crease(&mut self, creases: &[f64], same: &[u32]) -> Result<(), Vec<Fault>> {
        let (triples, rest) = creases.as_chunks::<3>();
        let fault = |message: String| Fault::mesh("creases", message);
        if !rest.is_empty() {
            let n = creases.len();
            return Err(vec![fault(format!("{n} numbers in creases: not a multiple of 3"))]);
        }
        let n_points = if same.is_empty() { self.points.len() } else { same.len() };
        let place = |x: f64| {
            let i = index(x, n_points)?;
            Some(same.get(i as usize).copied().unwrap_or(i))
        };
        let mut faults = vec![];
        for (i, [a, b, sharpness]) in triples.iter().enumerate() {
            let edge = place(*a)
                .zip(place(*b))
                .and_then(|(a, b)| self.ends.binary_search(&[a.min(b), a.max(b)]).ok());
            #[expect(clippy::cast_possible_truncation, reason = "a sharpness below 10")]
            match edge {
                _ if sharpness.is_nan() || *sharpness < 0.0 => {
                    faults
                        .push(fault(format!("crease {i} has the sharpness {sharpness}, below 0")));
                }
                Some(edge) => {
                    let levels =
                        if *sharpness < FOR_EVER { *sharpness as f32 } else { f32::INFINITY };
                    self.sharp[edge] = self.sharp[edge].max(levels);
                }
                None => faults.push(fault(format!("crease {i}: no edge joins points {a} and {b}"))),
            }
        }
        if faults.is_empty() { Ok(()) } else { Err(faults) }
    }

    /// The first corner of a corner's face, and how many the face has.
    fn face(&self, corner: u32) -> (u32, u32) {
        match &self.sides {
            Sides::All(n) => (corner / n * n, *n),
            Sides::Each { starts, face_of } => {
                let face = face_of[corner as usize] as usize;
                (starts[face], starts[face + 1] - starts[face])
            }
        }
    }

    /// The corners of each face, as ranges.
    pub(super) fn faces(&self) -> impl Iterator<Item = std::ops::Range<usize>> {
        let n = match &self.sides {
            Sides::All(n) => self.corners.len() / *n as usize,
            Sides::Each { starts, .. } => starts.len() - 1,
        };
        (0..n).map(|face| match &self.sides {
            Sides::All(n) => face * *n as usize..(face + 1) * *n as usize,
            Sides::Each { starts, .. } => starts[face] as usize..starts[face + 1] as usize,
        })
    }

    /// The next corner of the face.
    pub(super) fn next(&self, corner: u32) -> u32 {
        let (first, n) = self.face(corner);
        if corner + 1 == first + n { first } else { corner + 1 }
    }

    /// The corner before it in the face.
    pub(super) fn before(&self, corner: u32) -> u32 {
        let (first, n) = self.face(corner);
        if corner == first { first + n - 1 } else { corner - 1 }
    }

    fn across(&self, side: u32) -> Option<u32> {
        let join = self.joins[self.edges[side as usize] as usize];
        let other = if join[0] == side { join[1] } else { join[0] };
        (other != NONE).then_some(other)
    }

    /// The corners around a point, counter-clockwise, between edges that `stops` names or at which
    /// faces do not join: with the corner in the fan. Whether the fan closes.
    pub(super) fn walk(
        &self,
        corner: u32,
        stops: impl Fn(u32) -> bool,
        fan: &mut Vec<u32>,
    ) -> bool {
        let open = |side: u32| (!stops(self.edges[side as usize])).then_some(side);
        let clockwise = |c: u32| Some(self.next(self.across(open(c)?)?));
        let counter = |c: u32| self.across(open(self.before(c))?);
        fan.clear();
        let mut first = corner;
        while let Some(before) = clockwise(first) {
            first = before;
            if first == corner {
                break;
            }
        }
        fan.push(first);
        let mut at = first;
        while let Some(after) = counter(at) {
            if after == first {
                return true;
            }
            fan.push(after);
            at = after;
        }
        false
    }

    /// The triangles of a level whose faces are alike; quads are cut from their first corner.
    fn triangles(&self, context: &dyn BuildContext) -> Result<Vec<[u32; 3]>, String> {
        let Sides::All(n) = self.sides else { return Ok(vec![]) };
        let n_corners = u32::try_from(self.corners.len()).expect("corners are counted in u32");
        let faces = (0..n_corners).step_by(n as usize);
        match n {
            3 => gather(faces.map(|c| [c, c + 1, c + 2]), context),
            _ => gather(faces.flat_map(|c| [[c, c + 1, c + 2], [c, c + 2, c + 3]]), context),
        }
    }

    /// The same as triangles, at other places.
    ///
    /// # Errors
    /// If it is not wanted any more.
    pub(super) fn into_net(
        self,
        places: Vec<DVec3>,
        (uvs, normals, colors): (&[Vec2], &[Vec3], &[Vec3]),
        context: &dyn BuildContext,
    ) -> Result<Net, String> {
        let triangles = self.triangles(context)?;
        let uvs = pick(&triangles, uvs, context)?;
        let normals = pick(&triangles, normals, context)?;
        let colors = pick(&triangles, colors, context)?;
        let points = triangles.iter().map(|t| t.map(|i| self.corners[i as usize]));
        Ok(Net { places, triangles: gather(points, context)?, uvs, normals, colors })
    }
}
