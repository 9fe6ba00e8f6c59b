//! Where endless refinement would bring the points of a level, and the normals there.

use glam::{DVec3, Vec3};
use luxel_sdk::num::gamma64;
use luxel_sdk::params::BuildContext;

use super::Scheme;
use super::masks::{self, Ring};
use super::rules::{Around, Rule, SharpPoints, beta, in_the_limit, placed};
use super::topology::{Level, NONE};
use crate::stop::{go_on, wanted};

/// The limit of each point. What is still sharp for a number of levels counts as sharp for ever if
/// it is for at least one, and is blended if it is for less.
///
/// # Errors
/// If it is not wanted any more.
///
/// # Source
/// Halstead, Kass & `DeRose` 1993 for quads; Loop 1987 for triangles; Hoppe et al. 1994 for creases.
pub(super) fn points(
    level: &Level,
    scheme: Scheme,
    context: &dyn BuildContext,
) -> Result<Vec<DVec3>, String> {
    let across = |c: usize| level.points[level.corners[c / 4 * 4 + (c + 2) % 4] as usize];
    let around = match scheme {
        Scheme::CatmullClark => Around::all(level, across, context)?,
        Scheme::Loop => Around::all(level, |_| DVec3::ZERO, context)?,
    };
    let sharp = SharpPoints::find(level, in_the_limit, context)?;
    let smooth = |n: f64, p: DVec3, around: &Around| match scheme {
        Scheme::CatmullClark => (p * (n * n) + around.far * 4.0 + around.faces) / (n * (n + 5.0)),
        Scheme::Loop => p + (around.far - p * n) / (0.375 / beta(n) + n),
    };
    let curve = |p, ends| (p * 4.0 + ends) / 6.0;
    let mut out = placed(level, (&around, &sharp), smooth, curve, context)?;
    darts(level, scheme, &sharp, &mut out, context);
    go_on(context)?;
    Ok(out)
}

/// Brings points in which a sharp edge ends to their limit.
fn darts(
    level: &Level,
    scheme: Scheme,
    sharp: &SharpPoints,
    out: &mut [DVec3],
    context: &dyn BuildContext,
) {
    let (mut fan, mut ring) = (vec![], Ring::default());
    for (corner, point) in wanted((0..).zip(&level.corners), context) {
        let Some(found) = sharp.get(*point) else { continue };
        let edge = level.edges[corner as usize] as usize;
        if !matches!(found.now, Rule::Dart) || level.sharp[edge] <= 0.0 {
            continue;
        }
        ring.closed = level.walk(corner, |_| false, &mut fan);
        if ring.closed {
            fill(level, scheme, &fan, &mut ring);
            let (p, smooth) = (level.points[*point as usize], out[*point as usize]);
            let limit = p + settle(scheme, &mut ring, sharp_edge(level, &fan));
            out[*point as usize] = smooth + (limit - smooth) * found.weight;
        }
    }
}

/// Which edge of a fan is sharp.
fn sharp_edge(level: &Level, fan: &[u32]) -> usize {
    let is_sharp = |c: &u32| level.sharp[level.edges[*c as usize] as usize] > 0.0;
    fan.iter().position(is_sharp).unwrap_or(0)
}

/// Refines the surroundings of a dart until they are the limit's but for their size; how far the
/// point itself moves. No closed form is known to us.
fn settle(scheme: Scheme, ring: &mut Ring, sharp: usize) -> DVec3 {
    let n = ring.far.len();
    let mut moved = DVec3::ZERO;
    for _ in 0..SETTLED {
        let all = ring.far.iter().sum::<DVec3>();
        let far = ring.far.clone();
        let by = match scheme {
            Scheme::CatmullClark => {
                let middle = |i: usize| (far[i] + ring.across[i] + far[(i + 1) % n]) / 4.0;
                ring.across = (0..n).map(middle).collect();
                (ring.across.iter().sum::<DVec3>() + all) / (n * n) as f64
            }
            Scheme::Loop => all * beta(n as f64),
        };
        for i in 0..n {
            let (before, after) = ((i + n - 1) % n, (i + 1) % n);
            let to = match scheme {
                _ if i == sharp => far[i] * 0.5,
                Scheme::CatmullClark => (far[i] + ring.across[before] + ring.across[i]) / 4.0,
                Scheme::Loop => far[i] * 0.375 + (far[before] + far[after]) * 0.125,
            };
            ring.far[i] = to - by;
        }
        ring.across.iter_mut().for_each(|p| *p -= by);
        moved += by;
    }
    moved
}

/// Levels after which a point no longer moves: what lies around it shrinks to two thirds or less each
/// time.
const SETTLED: usize = 80;

/// The normal at a point in which a sharp edge ends. Along that edge is where its other end comes from in
/// the end; across it a smooth point's sine weights serve, for they vanish on the edge, whose rule alone
/// is another.
fn dart_normal(scheme: Scheme, ring: &mut Ring, sharp: usize) -> DVec3 {
    ring.far.rotate_left(sharp);
    if !ring.across.is_empty() {
        ring.across.rotate_left(sharp);
    }
    let mean = ring.mean_normal();
    let Some([_, across]) = masks::smooth(scheme, ring) else { return mean };
    settle(scheme, ring, 0);
    let along = ring.far[0].try_normalize().unwrap_or_default();
    let normal = along.cross(across.sum).try_normalize().unwrap_or(mean);
    if normal.dot(mean) < 0.0 { -normal } else { normal }
}

/// The limit's normal for each corner: one for all corners of a point between its creases.
///
/// # Errors
/// If it is not wanted any more.
pub(super) fn normals(
    level: &Level,
    scheme: Scheme,
    context: &dyn BuildContext,
) -> Result<Vec<Vec3>, String> {
    let sharp = SharpPoints::find(level, in_the_limit, context)?;
    let mut out = vec![Vec3::NAN; level.corners.len()];
    let (mut fan, mut ring) = (vec![], Ring::default());
    for corner in wanted(0..u32::try_from(out.len()).unwrap_or(NONE), context) {
        if !out[corner as usize].is_nan() {
            continue;
        }
        let found = sharp.get(level.corners[corner as usize]);
        let rules = found.map(|found| (found.now, found.later, found.weight));
        let (now, later, weight) = rules.unwrap_or((Rule::Smooth, Rule::Smooth, 1.0));
        let mut by = |rule: Rule, least: f32, fan: &mut Vec<u32>| {
            let whole = matches!(rule, Rule::Smooth | Rule::Dart);
            let stops = |edge: u32| !whole && level.sharp[edge as usize] >= least;
            ring.closed = level.walk(corner, stops, fan);
            fill(level, scheme, fan, &mut ring);
            if ring.closed && matches!(rule, Rule::Dart) {
                return dart_normal(scheme, &mut ring, sharp_edge(level, fan));
            }
            normal(scheme, rule, &ring)
        };
        let blunt = if weight < 1.0 { by(later, f32::INFINITY, &mut fan) } else { DVec3::ZERO };
        let keen = by(now, f32::MIN_POSITIVE, &mut fan);
        let normal = (blunt + (keen - blunt) * weight).try_normalize().unwrap_or(keen).as_vec3();
        for corner in &fan {
            out[*corner as usize] = normal;
        }
    }
    go_on(context)?;
    Ok(out)
}

/// Puts what lies about a point into its ring, relative to it.
fn fill(level: &Level, scheme: Scheme, fan: &[u32], ring: &mut Ring) {
    let point = |corner: u32| level.points[level.corners[corner as usize] as usize];
    let p = point(fan[0]);
    ring.reach = p.abs().max_element();
    ring.far.clear();
    ring.across.clear();
    for corner in fan {
        let next = level.next(*corner);
        ring.far.push(point(next) - p);
        if scheme == Scheme::CatmullClark {
            ring.across.push(point(level.next(next)) - p);
        }
    }
    if !ring.closed {
        let last = fan[fan.len() - 1];
        ring.far.push(point(level.before(last)) - p);
    }
}

fn normal(scheme: Scheme, rule: Rule, ring: &Ring) -> DVec3 {
    let tangents = match (rule, ring.closed) {
        (Rule::Smooth, true) => masks::smooth(scheme, ring),
        (Rule::Crease(_), false) => Some(masks::crease(scheme, ring)),
        (Rule::Corner, false) => Some(masks::corner(ring)),
        _ => None,
    };
    let Some([s, t]) = tangents else { return ring.mean_normal() };
    let normal = s.sum.cross(t.sum);
    // Each tangent is a sum of products of differences of points, which round as well.
    let error = gamma64(u16::try_from(ring.far.len()).unwrap_or(u16::MAX).saturating_add(8));
    let size = (s.size + ring.reach) * t.size + (t.size + ring.reach) * s.size;
    if normal.length() <= error * size {
        return ring.mean_normal();
    }
    let normal = normal.normalize();
    // Around a whole point the order of its faces decides; where a fan ends, its faces do.
    if !ring.closed && normal.dot(ring.mean_normal()) < 0.0 { -normal } else { normal }
}
