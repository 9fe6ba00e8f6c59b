//! Where points come to be, and which rule each follows.

use glam::DVec3;
use luxel_sdk::params::BuildContext;

use super::Scheme;
use super::topology::{Level, NONE};
use crate::stop::{gather, go_on, wanted};

/// What surrounds a point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Around {
    /// The number of its edges.
    pub(super) n: u32,
    /// The sum of the edges' other ends.
    pub(super) far: DVec3,
    /// The sum of something of its faces.
    pub(super) faces: DVec3,
}

impl Around {
    /// Of each point; `of_corner` gives each corner what its face adds.
    ///
    /// # Errors
    /// If it is not wanted any more.
    pub(super) fn all(
        level: &Level,
        of_corner: impl Fn(usize) -> DVec3,
        context: &dyn BuildContext,
    ) -> Result<Vec<Self>, String> {
        let mut out = vec![Self::default(); level.points.len()];
        for [a, b] in wanted(&level.ends, context).map(|ends| ends.map(|i| i as usize)) {
            for (at, other) in [(a, b), (b, a)] {
                out[at].n += 1;
                out[at].far += level.points[other];
            }
        }
        for (i, corner) in wanted(level.corners.iter().enumerate(), context) {
            out[*corner as usize].faces += of_corner(i);
        }
        go_on(context)?;
        Ok(out)
    }
}

/// What a point does at the next level.
#[derive(Clone, Copy, Debug)]
pub(super) enum Rule {
    /// It is drawn to everything around it.
    Smooth,
    /// A sharp edge ends in it: it is smooth, but that edge keeps its middle.
    Dart,
    /// It stays on a curve between two sharp edges, whose other ends have this sum.
    Crease(DVec3),
    /// It stays where it is.
    Corner,
}

/// The rules of a point that has sharp edges or is sharp itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sharp {
    /// By what is sharp now.
    pub(super) now: Rule,
    /// By what stays sharp.
    pub(super) later: Rule,
    /// How much the first counts, in [0, 1].
    pub(super) weight: f64,
}

/// What stays of a sharpness: after one level more.
pub(super) fn after_a_level(sharp: f32) -> f32 {
    (sharp - 1.0).max(0.0)
}

/// What stays of a sharpness: after all levels.
pub(super) fn in_the_limit(sharp: f32) -> f32 {
    if sharp < f32::INFINITY { 0.0 } else { sharp }
}

#[derive(Clone, Copy, Debug, Default)]
struct Count {
    n: u32,
    far: DVec3,
    pinned: bool,
}

impl Count {
    fn rule(self) -> Rule {
        match self.n {
            _ if self.pinned => Rule::Corner,
            0 => Rule::Smooth,
            1 => Rule::Dart,
            2 => Rule::Crease(self.far),
            _ => Rule::Corner,
        }
    }
}

#[derive(Clone, Copy, Debug, Default)]
struct Tally {
    now: Count,
    later: Count,
    fading: f32,
    n_fading: u32,
}

/// The sharp points of a level.
pub(super) struct SharpPoints {
    slots: Vec<u32>,
    sharp: Vec<Sharp>,
}

impl SharpPoints {
    /// Finds them; `later` says what stays of a sharpness.
    ///
    /// # Errors
    /// If it is not wanted any more.
    ///
    /// # Source
    /// `DeRose`, Kass & Truong 1998, appendix B; a rule that changes is blended as `OpenSubdiv` does.
    pub(super) fn find(
        level: &Level,
        later: fn(f32) -> f32,
        context: &dyn BuildContext,
    ) -> Result<Self, String> {
        let mut slots = vec![NONE; level.points.len()];
        let mut tallies: Vec<Tally> = vec![];
        let fade = |tally: &mut Tally, sharp: f32| {
            if later(sharp) <= 0.0 {
                tally.fading += sharp.min(1.0);
                tally.n_fading += 1;
            }
        };
        let mut slot = |i: u32, tallies: &mut Vec<Tally>| {
            if slots[i as usize] == NONE {
                slots[i as usize] = u32::try_from(tallies.len()).expect("as many as points");
                tallies.push(Tally::default());
            }
            slots[i as usize] as usize
        };
        let edges = wanted(level.ends.iter().zip(&level.sharp), context);
        for (ends, sharp) in edges.filter(|(_, s)| **s > 0.0) {
            for (at, other) in [(ends[0], ends[1]), (ends[1], ends[0])] {
                let i = slot(at, &mut tallies);
                let (tally, far) = (&mut tallies[i], level.points[other as usize]);
                tally.now = Count { n: tally.now.n + 1, far: tally.now.far + far, ..tally.now };
                if later(*sharp) > 0.0 {
                    let stays = tally.later;
                    tally.later = Count { n: stays.n + 1, far: stays.far + far, ..stays };
                }
                fade(tally, *sharp);
            }
        }
        let pins = wanted((0..).zip(&level.pins), context);
        for (i, pin) in pins.filter(|(_, pin)| **pin > 0.0) {
            let i = slot(i, &mut tallies);
            tallies[i].now.pinned = true;
            tallies[i].later.pinned = later(*pin) > 0.0;
            fade(&mut tallies[i], *pin);
        }
        let sharp = tallies.iter().map(|tally| {
            let n = f64::from(tally.n_fading);
            let weight = if n > 0.0 { f64::from(tally.fading) / n } else { 1.0 };
            Sharp { now: tally.now.rule(), later: tally.later.rule(), weight }
        });
        Ok(Self { sharp: gather(sharp, context)?, slots })
    }

    /// The rules of a point, if it is sharp.
    pub(super) fn get(&self, point: u32) -> Option<&Sharp> {
        self.sharp.get(self.slots[point as usize] as usize)
    }

    /// Where a point comes to be: by its rules, where `smooth` is the smooth one and a crease's
    /// `curve` is of the point and the sum of its two neighbours.
    pub(super) fn place(
        &self,
        i: u32,
        p: DVec3,
        smooth: DVec3,
        curve: fn(DVec3, DVec3) -> DVec3,
    ) -> DVec3 {
        let Some(sharp) = self.get(i) else { return smooth };
        let by = |rule: Rule| match rule {
            Rule::Smooth | Rule::Dart => smooth,
            Rule::Crease(ends) => curve(p, ends),
            Rule::Corner => p,
        };
        let (now, later) = (by(sharp.now), by(sharp.later));
        if sharp.weight < 1.0 { later + (now - later) * sharp.weight } else { now }
    }
}

/// The middle of each face.
///
/// # Errors
/// As all here: if it is not wanted any more.
pub(super) fn middles(level: &Level, context: &dyn BuildContext) -> Result<Vec<DVec3>, String> {
    let middle = |range: std::ops::Range<usize>| {
        let n = range.len() as f64;
        range.map(|c| level.points[level.corners[c] as usize]).sum::<DVec3>() / n
    };
    gather(level.faces().map(middle), context)
}

/// What each corner's face adds to its point and its edge: its middle, or the point opposite.
pub(super) fn of_corners(
    level: &Level,
    scheme: Scheme,
    middles: &[DVec3],
    context: &dyn BuildContext,
) -> Result<Vec<DVec3>, String> {
    match scheme {
        Scheme::CatmullClark => {
            let faces = level.faces().zip(middles);
            gather(faces.flat_map(|(range, middle)| range.map(move |_| *middle)), context)
        }
        Scheme::Loop => {
            let opposite = |c: u32| level.points[level.corners[level.before(c) as usize] as usize];
            gather((0..).take(level.corners.len()).map(opposite), context)
        }
    }
}

/// Where the points of a level come to be by its sharp edges and corners, where `smooth` is told how
/// many neighbours a point has, the point, and what lies around it.
pub(super) fn placed(
    level: &Level,
    (around, sharp): (&[Around], &SharpPoints),
    smooth: impl Fn(f64, DVec3, &Around) -> DVec3,
    curve: fn(DVec3, DVec3) -> DVec3,
    context: &dyn BuildContext,
) -> Result<Vec<DVec3>, String> {
    let place = |((i, p), around): ((u32, &DVec3), &Around)| {
        if around.n == 0 {
            return *p;
        }
        sharp.place(i, *p, smooth(f64::from(around.n), *p, around), curve)
    };
    gather((0..).zip(&level.points).zip(around).map(place), context)
}

/// Where the given points are at the next level.
pub(super) fn moved(
    level: &Level,
    scheme: Scheme,
    of_corners: &[DVec3],
    context: &dyn BuildContext,
) -> Result<Vec<DVec3>, String> {
    let around = Around::all(level, |c| of_corners[c], context)?;
    let sharp = SharpPoints::find(level, after_a_level, context)?;
    let smooth = |n: f64, p: DVec3, around: &Around| match scheme {
        Scheme::CatmullClark => (around.faces / n + around.far / n + p * (n - 2.0)) / n,
        Scheme::Loop => p + (around.far - p * n) * beta(n),
    };
    placed(level, (&around, &sharp), smooth, |p, ends| (p * 6.0 + ends) / 8.0, context)
}

/// The points that edges make at the next level.
pub(super) fn of_edges(
    level: &Level,
    scheme: Scheme,
    of_corners: &[DVec3],
    context: &dyn BuildContext,
) -> Result<Vec<DVec3>, String> {
    let point = |((ends, join), sharp): ((&[u32; 2], &[u32; 2]), &f32)| {
        let [a, b] = ends.map(|i| level.points[i as usize]);
        let middle = (a + b) * 0.5;
        if *sharp >= 1.0 || join.contains(&NONE) {
            return middle;
        }
        let [c, d] = join.map(|corner| of_corners[corner as usize]);
        let smooth = match scheme {
            Scheme::CatmullClark => (a + b + (c + d)) * 0.25,
            Scheme::Loop => (a + b) * 0.375 + (c + d) * 0.125,
        };
        smooth + (middle - smooth) * f64::from(*sharp)
    };
    gather(level.ends.iter().zip(&level.joins).zip(&level.sharp).map(point), context)
}

/// Loop's weight of each neighbour of a point with n of them: `1/n (5/8 − (3/8 + cos(2π/n)/4)²)`.
pub(super) fn beta(n: f64) -> f64 {
    let c = 0.375 + 0.25 * (std::f64::consts::TAU / n).cos();
    (0.625 - c * c) / n
}
