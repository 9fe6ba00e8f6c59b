//! Rays side by side meet what they meet one by one, on every processor.

use glam::DVec3;
use luxel_core::accel::{Processor, Work};
use luxel_core::stage::{Leaving, Rooms, SceneHit, Stage};
use luxel_sdk::num::{Ray, offset_origin};
use luxel_sdk::sampling::Rng;

use crate::disk::{OnDisk, root};
use crate::load::stage_of;

/// Meshes, analytic shapes, placements that turn and scale, open surfaces, and things that
/// move.
const SCENES: [&str; 5] = ["spot", "gltf", "parametric", "fog", "motion"];

type Rays = Vec<(Ray, Option<Leaving>, f64)>;
type Found = Vec<(Option<SceneHit>, u32, bool)>;

fn direction(rng: &mut Rng) -> DVec3 {
    let mut uniform = || 2.0 * rng.f64() - 1.0;
    DVec3::new(uniform(), uniform(), uniform())
}

/// Rays from everywhere, and rays that leave what those meet, some of limited length.
fn rays(stage: &Stage) -> Rays {
    let mut rng = Rng::new(17);
    let (centre, radius) = stage.sphere;
    let mut rays: Rays = (0..3000)
        .map(|_| {
            let time = stage.time_of(rng.pair()[0]);
            let o = centre + direction(&mut rng) * radius;
            let towards = centre + direction(&mut rng) * 0.2 * radius;
            (Ray::new(o, towards - o), None, time)
        })
        .collect();
    for i in 0..rays.len() {
        let (ray, _, time) = rays[i];
        let moment = stage.at(time);
        let Some(hit) = moment.intersect(Processor::ANY, &ray, None, &mut 0) else { continue };
        let surface = moment.surface(&ray, &hit);
        let d = direction(&mut rng);
        let o = offset_origin(surface.p, surface.p_err, surface.ng, d);
        let t_max = if i % 2 == 0 { f64::INFINITY } else { 0.3 * radius };
        rays.push((Ray { o, d, t_max }, Some(Leaving::from(&hit)), time));
    }
    rays
}

struct OneByOne<'a>(&'a Stage, &'a Rays, &'a mut Found);

impl Work for OneByOne<'_> {
    #[inline(always)]
    fn run(self, processor: Processor) {
        let Self(stage, rays, found) = self;
        found.extend(rays.iter().map(|(ray, from, time)| {
            let (moment, mut steps) = (stage.at(*time), 0);
            let hit = moment.intersect(processor, ray, *from, &mut steps);
            (hit, steps, moment.occluded(processor, ray, *from))
        }));
    }
}

struct SideBySide<'a>(&'a Stage, &'a Rays, &'a mut Found);

impl Work for SideBySide<'_> {
    #[inline(always)]
    fn run(self, processor: Processor) {
        let Self(stage, rays, found) = self;
        let mut rooms = Rooms::side_by_side();
        found.resize(rays.len(), (None, 0, false));
        let asked = || rays.iter().map(|(ray, from, time)| (ray, *from, *time));
        stage.intersect_all(processor, asked(), &mut rooms, |i, hit, steps| {
            (found[i].0, found[i].1) = (hit, steps);
        });
        stage.occluded_all(processor, asked(), &mut rooms, |i, is_hit| found[i].2 = is_hit);
    }
}

#[test]
fn going_side_by_side_changes_nothing() {
    for name in SCENES {
        let path = root().join(format!("scenes/{name}.scene"));
        let stage = stage_of(&path, &OnDisk, &[], None).unwrap_or_else(|said| panic!("{said:?}"));
        let rays = rays(&stage);
        let mut reference = vec![];
        Processor::ANY.run(OneByOne(&stage, &rays, &mut reference));
        let hits = reference.iter().filter(|found| found.0.is_some()).count();
        assert!(hits > 1000, "{name}: {hits} of {} rays hit", rays.len());
        for processor in Processor::all() {
            let (mut single, mut flock) = (vec![], vec![]);
            processor.run(OneByOne(&stage, &rays, &mut single));
            processor.run(SideBySide(&stage, &rays, &mut flock));
            assert!(single == reference, "{name}: {}, one by one", processor.name());
            assert!(flock == reference, "{name}: {}, side by side", processor.name());
        }
    }
}
