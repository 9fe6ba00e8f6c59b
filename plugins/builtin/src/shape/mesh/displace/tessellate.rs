//! Triangles are split until no edge is longer than asked for.
//!
//! Whether an edge is split depends on its two ends alone, so both of its triangles agree, and no
//! place lies inside another triangle's edge. Each pass halves all edges that are too long; a
//! triangle with one such edge becomes two, with two three, with three four.

use std::collections::HashMap;
use std::ops::{Add, Mul};

use glam::{DVec3, Vec2, Vec3};
use luxel_sdk::params::BuildContext;

use super::super::net::Net;
use crate::stop::wanted;

/// What splitting would need more triangles than there may be for.
#[derive(Clone, Copy, Debug)]
pub(super) struct TooMany {
    /// About how many.
    pub(super) triangles: f64,
    /// An edge, in metres, that would do, if any.
    pub(super) fits: Option<f64>,
}

/// Splits triangles until no edge is longer than `most`, metres, or until that is not wanted any more:
/// some triangles may be missing then.
///
/// # Errors
/// Where that takes more than `limit` triangles, before they are made.
pub(super) fn tessellate(
    mut net: Net,
    most: f64,
    limit: u64,
    context: &dyn BuildContext,
) -> Result<Net, TooMany> {
    let too_many = |net: &Net| TooMany {
        triangles: estimate(net, most, context),
        fits: fitting(net, (most, limit), context),
    };
    // An estimate may be off by as much.
    if estimate(&net, most, context) > 4.0 * limit as f64 || net.triangles.len() as u64 > limit {
        return Err(too_many(&net));
    }
    let given =
        Net { places: net.places.clone(), triangles: net.triangles.clone(), ..Net::default() };
    loop {
        let split = Split::find(&net, most, context);
        if split.middles.is_empty() {
            return Ok(net);
        }
        if split.n_triangles(&net, context) > limit {
            return Err(too_many(&given));
        }
        net = split.apply(&net, context);
        if context.cancelled() {
            return Ok(net);
        }
    }
}

/// Which edges are halved, and the place in the middle of each.
struct Split {
    middles: HashMap<(u32, u32), u32>,
    places: Vec<DVec3>,
}

fn key(a: u32, b: u32) -> (u32, u32) {
    (a.min(b), a.max(b))
}

/// The edge from each corner to the next.
fn edges([a, b, c]: [u32; 3]) -> [(u32, u32); 3] {
    [key(a, b), key(b, c), key(c, a)]
}

impl Split {
    fn find(net: &Net, most: f64, context: &dyn BuildContext) -> Self {
        // Two triangles join at most edges. A table that grows takes its time in one piece.
        let middles = HashMap::with_capacity(net.triangles.len() * 3 / 2);
        let mut out = Self { middles, places: vec![] };
        for edge in wanted(&net.triangles, context).flat_map(|t| edges(*t)) {
            let [a, b] = [edge.0, edge.1].map(|i| net.places[i as usize]);
            // The same in both directions. NaN is not split, nor an edge between whose ends no number
            // lies.
            let middle = (a + b) * 0.5;
            if a.distance_squared(b) > most * most && middle != a && middle != b {
                let next = net.places.len() + out.places.len();
                out.middles.entry(edge).or_insert_with(|| {
                    out.places.push(middle);
                    u32::try_from(next).expect("three places for each triangle")
                });
            }
        }
        out
    }

    fn n_triangles(&self, net: &Net, context: &dyn BuildContext) -> u64 {
        let split =
            |t: &[u32; 3]| edges(*t).iter().filter(|e| self.middles.contains_key(*e)).count();
        wanted(&net.triangles, context).map(|t| 1 + split(t) as u64).sum()
    }

    fn apply(self, net: &Net, context: &dyn BuildContext) -> Net {
        let mut places = net.places.clone();
        places.extend(&self.places);
        let mut out = Net { places, ..Net::default() };
        for (i, triangle) in wanted(net.triangles.iter().enumerate(), context) {
            let found = edges(*triangle).map(|edge| self.middles.get(&edge).copied());
            let (parts, n) = pattern(found.map(|middle| middle.is_some()), |a, b| {
                let place = |i: usize| {
                    let i = if i < 3 { triangle[i] } else { found[i - 3].unwrap_or(triangle[0]) };
                    out.places[i as usize]
                };
                place(a).distance_squared(place(b))
            });
            let six = |i: u8| found.get(usize::from(i).wrapping_sub(3));
            for part in &parts[..n] {
                out.triangles.push(part.map(|i| match six(i) {
                    Some(middle) => middle.expect("a pattern takes the edges that are split"),
                    None => triangle[usize::from(i)],
                }));
                values(&net.uvs, i, *part, |v: Vec2| v, &mut out.uvs);
                values(&net.colors, i, *part, |c: Vec3| c, &mut out.colors);
                values(&net.normals, i, *part, Vec3::normalize_or_zero, &mut out.normals);
            }
        }
        out
    }
}

/// The values of a part's corners; those of middles are the mean of their edge's ends.
fn values<T>(of: &[T], triangle: usize, part: [u8; 3], unit: impl Fn(T) -> T, out: &mut Vec<T>)
where
    T: Copy + Add<Output = T> + Mul<f32, Output = T>,
{
    let Some(own) = of.get(3 * triangle..3 * triangle + 3) else { return };
    out.extend(part.map(usize::from).map(|i| match i {
        0..3 => own[i],
        _ => unit((own[i - 3] + own[(i - 2) % 3]) * 0.5),
    }));
}

/// The parts of a triangle by which of its edges are split: 0, 1, 2 are its corners, 3, 4, 5 the
/// middles of the edges after them. `length` orders what may be cut across.
fn pattern(split: [bool; 3], length: impl Fn(usize, usize) -> f64) -> ([[u8; 3]; 4], usize) {
    let mut out = [[0, 1, 2]; 4];
    let n = split.iter().filter(|s| **s).count();
    // Turned so that the first edge is split, or the first two.
    let turn = match n {
        1 => split.iter().position(|s| *s).unwrap_or(0),
        2 => (split.iter().position(|s| !*s).unwrap_or(0) + 1) % 3,
        _ => 0,
    };
    let at = |i: u8| {
        let turn = u8::try_from(turn).unwrap_or(0);
        if i < 3 { (i + turn) % 3 } else { 3 + (i - 3 + turn) % 3 }
    };
    let parts: &[[u8; 3]] = match n {
        0 => &[[0, 1, 2]],
        1 => &[[0, 3, 2], [3, 1, 2]],
        // What is left beside the corner between both is cut across the shorter way.
        2 if length(at(0).into(), at(4).into()) <= length(at(3).into(), at(2).into()) => {
            &[[3, 1, 4], [0, 3, 4], [0, 4, 2]]
        }
        2 => &[[3, 1, 4], [0, 3, 2], [3, 4, 2]],
        _ => &[[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]],
    };
    for (out, part) in out.iter_mut().zip(parts) {
        *out = part.map(at);
    }
    (out, parts.len())
}

/// About how many triangles edges of at most this length make: by how often each edge is halved.
fn estimate(net: &Net, most: f64, context: &dyn BuildContext) -> f64 {
    let of = |triangle: &[u32; 3]| {
        let n = edges(*triangle).map(|(a, b)| {
            let length = net.places[a as usize].distance(net.places[b as usize]);
            (length / most).log2().ceil().clamp(0.0, 60.0).exp2()
        });
        let (long, short) = (n[0].max(n[1]).max(n[2]), n[0].min(n[1]).min(n[2]));
        long * short * (2.0 - short / long)
    };
    wanted(&net.triangles, context).map(of).sum()
}

/// An edge that makes as many triangles as there may be, or a little fewer; none where there are too
/// many already.
fn fitting(net: &Net, (most, limit): (f64, u64), context: &dyn BuildContext) -> Option<f64> {
    let length = |(a, b): (u32, u32)| net.places[a as usize].distance(net.places[b as usize]);
    let triangles = wanted(&net.triangles, context);
    let longest = triangles.flat_map(|t| edges(*t)).map(length).fold(0.0, f64::max);
    // Shorter ones split a single edge into more than there may be.
    let mut edge = most.max(longest / (2.0 * limit as f64));
    while edge <= longest {
        if estimate(net, edge, context) <= 0.5 * limit as f64 {
            break;
        }
        edge *= 1.25;
    }
    // It will be told with three digits.
    (edge <= longest || net.triangles.len() as u64 <= limit).then_some(edge * 1.01)
}
