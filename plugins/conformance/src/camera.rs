//! Cameras: rays and projections are inverse, and the picture is the right way up.

use glam::{DVec2, DVec3, UVec2};
use luxel_core::scene::Value;
use luxel_sdk::kind::{Camera, Raster};
use luxel_sdk::sampling::Rng;

use crate::report::Judge;
use crate::subject::Subject;
use crate::sweep::Set;
use crate::values::LOOK;

/// A picture that is wider than high, and one that is not.
const RASTERS: [Raster; 2] =
    [Raster { size: UVec2::new(640, 360) }, Raster { size: UVec2::new(100, 300) }];

/// Pixels by which a place may be off: f64 through two rotations and a tangent, by the tangent.
const PIXELS: f64 = 1e-6;

/// The middle of the lens.
const MIDDLE: [f32; 2] = [0.5; 2];

pub(crate) fn judge(subject: &Subject<'_>, judge: &mut Judge) {
    for (i, (set, mut rng)) in subject.usual().enumerate() {
        set.ask(|resolved| {
            let camera = resolved.camera();
            for raster in RASTERS {
                for _ in 0..300 {
                    one(camera, raster, set, &mut rng, judge);
                }
            }
            if i == 0 {
                stands_upright(camera, set, judge);
            }
        });
    }
    subject.concurrent(judge, |resolved| {
        let (camera, mut rng) = (resolved.camera(), Rng::new(7));
        (0..200)
            .flat_map(|_| {
                let p = DVec2::new(rng.f64(), rng.f64()) * RASTERS[0].size.as_dvec2();
                let ray = camera.ray(RASTERS[0], p, rng.pair());
                ray.map_or([0; 3], |ray| ray.ray.d.as_vec3().to_array().map(f32::to_bits))
            })
            .collect()
    });
}

fn one(camera: &dyn Camera, raster: Raster, set: &Set, rng: &mut Rng, judge: &mut Judge) {
    let p = DVec2::new(rng.f64(), rng.f64()) * raster.size.as_dvec2();
    let at = || format!("{}: raster {} at {p}", set.label, raster.size);
    let mut rays = vec![];
    for lens in [MIDDLE, rng.pair(), rng.pair()] {
        let Some(seen) = camera.ray(raster, p, lens) else { continue };
        let finite = seen.ray.o.is_finite() && seen.ray.d.is_finite();
        let weight = seen.weight >= 0.0 && seen.weight.is_finite();
        judge.holds("rays are finite", finite && weight, at);
        let off = (seen.ray.d.length() - 1.0).abs();
        judge.within("|d| = 1", off, 1e-12, at);
        rays.push((lens, seen.ray));
    }
    let Some((_, centre)) = rays.first().filter(|(lens, _)| *lens == MIDDLE) else { return };
    for t in [0.1, 1.0, 37.0, 1e4] {
        let back = camera.project(raster, centre.at(t));
        // A view of many radians spreads rounding over its tangent.
        let spread = 1.0 + p.length() * 1e-4;
        let off = back.map_or(f64::INFINITY, |back| (back - p).length());
        judge.within("projection undoes rays", off / spread, PIXELS * 10.0, || {
            format!("{}: {t} m: {back:?}", at())
        });
        let behind = camera.project(raster, centre.at(-t));
        let hidden = behind.is_none_or(|behind| (behind - p).length() > 1e-3);
        judge.holds("nothing behind appears in front", hidden, at);
    }
    meets_in_focus(camera, raster, p, &rays, judge, &at);
}

/// Rays of one place of the picture through the lens meet in one point, which appears there.
fn meets_in_focus(
    camera: &dyn Camera,
    raster: Raster,
    p: DVec2,
    rays: &[([f32; 2], luxel_sdk::num::Ray)],
    judge: &mut Judge,
    at: &dyn Fn() -> String,
) {
    let [(_, a), (_, b), (_, c)] = rays else { return };
    let Some(met) = nearest(a, b) else { return };
    let distance = (met - a.o).length();
    let Some(other) = nearest(a, c) else { return };
    // The angle between the rays magnifies what rounds.
    let sine = a.d.cross(b.d).length().min(a.d.cross(c.d).length());
    let far = a.o.length() + b.o.length() + c.o.length();
    let rounds = 1e-13 * (distance + far + 1.0) / sine;
    let off = (met - other).length();
    judge.within("rays of a pixel meet in focus", off / rounds, 1.0, at);
    let off = camera.project(raster, met).map_or(f64::INFINITY, |back| (back - p).length());
    judge.within("the focus appears in its place", off * 1e-3 / (1.0 + rounds), PIXELS, at);
}

/// Where a ray comes nearest to another; `None` for rays that are nearly the same or parallel.
fn nearest(a: &luxel_sdk::num::Ray, b: &luxel_sdk::num::Ray) -> Option<DVec3> {
    let normal = a.d.cross(b.d);
    let n2 = normal.length_squared();
    let t = (b.o - a.o).cross(b.d).dot(normal) / n2;
    (n2 > 1e-12 && t.is_finite()).then(|| a.at(t))
}

/// As the raster says: x to the right, y down, the view at its middle.
fn stands_upright(camera: &dyn Camera, set: &Set, judge: &mut Judge) {
    let looks = set.given.iter().any(|(_, value)| *value == Value::look(LOOK));
    if !looks {
        return;
    }
    let raster = RASTERS[0];
    let (right, up, backward) = LOOK.axes();
    let middle = raster.size.as_dvec2() / 2.0;
    let ray = |p: DVec2| camera.ray(raster, p, MIDDLE).map(|seen| seen.ray.at(1.0));
    let at = || set.label.clone();
    let Some(centre) = ray(middle) else { return };
    let seen = (centre - LOOK.from).normalize().dot(-backward);
    judge.within("the middle looks ahead", 1.0 - seen, 1e-9, at);
    let step = |to: DVec2| ray(middle + to).map(|p| p - centre);
    let (x, y) = (step(DVec2::X * 9.0), step(DVec2::Y * 9.0));
    judge.holds("x runs right", x.is_none_or(|x| x.dot(right) > 0.9 * x.length()), at);
    judge.holds("y runs down", y.is_none_or(|y| y.dot(up) < -0.9 * y.length()), at);
}
