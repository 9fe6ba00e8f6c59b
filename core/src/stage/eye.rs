//! The camera as paths from lights find it: a point, and which pixels look where.

use glam::{DVec2, DVec3, UVec2};
use luxel_sdk::kind::{Camera, Filter, Raster};

use super::Stage;

/// Where the camera stands, if its lens is a point.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    /// World space.
    pub p: DVec3,
    raster: Raster,
}

/// A direction in which the eye is seen from a place, and the pixel that sees the place.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// Towards the eye, unit.
    pub d: DVec3,
    /// Which pixel, by its place in the rows.
    pub pixel: u32,
    /// What radiance along −`d` adds to the pixel, for each solid angle at the eye that it fills,
    /// over the chance of this pixel, and over the squared distance: sr⁻¹·m⁻².
    pub per_area: f64,
}

/// Side of the cross of rays that tells how densely pixels lie: the directions of a smooth lens
/// differ from a plane by its square, 1e-6, and round to 1e-16/1e-3 of a pixel's angle.
const STEP: f64 = 1.0 / 1024.0;

impl Eye {
    /// Of a camera; `None` where its rays do not all begin at one point.
    pub fn of(camera: &dyn Camera, size: UVec2) -> Option<Self> {
        let raster = Raster { size };
        let middle = size.as_dvec2() / 2.0;
        let ray = |p, lens| Some(camera.ray(raster, p, lens)?.ray.o);
        let p = ray(middle, [0.5; 2])?;
        let others = [(middle, [0.1, 0.7]), (middle / 2.0, [0.9, 0.2]), (middle * 1.5, [0.3, 0.4])];
        let point = others.into_iter().all(|(at, lens)| ray(at, lens).is_none_or(|o| o == p));
        point.then_some(Self { p, raster })
    }

    /// How the camera sees a point. `u` uniform in [0, 1) chooses among the pixels that see it.
    pub fn sees(&self, stage: &Stage, p: DVec3, u: f32) -> Option<Seen> {
        let camera = stage.camera.fixed().camera();
        let to = self.p - p;
        let distance2 = to.length_squared();
        let at = camera.project(self.raster, p).filter(|at| at.is_finite())?;
        let (pixel, weight) = self.pixel(stage.filter.fixed().filter(), at, f64::from(u))?;
        let density = self.density(camera, at)?;
        let per_area = weight * density / distance2;
        let seen = Seen { d: to / distance2.sqrt(), pixel, per_area };
        (per_area > 0.0 && per_area.is_finite()).then_some(seen)
    }

    /// One of the pixels whose filters reach a place, chosen by the filter's value, and the sum of
    /// the values. The estimate of a pixel is the filter's integral, so nothing is blurred.
    fn pixel(&self, filter: &dyn Filter, at: DVec2, mut u: f64) -> Option<(u32, f64)> {
        let radius = f64::from(filter.radius());
        let size = self.raster.size;
        let reach = |x: f64, n: u32| {
            let first = (x - radius - 0.5).ceil().max(0.0);
            let last = (x + radius - 0.5).floor().min(f64::from(n) - 1.0);
            (first <= last).then(|| crate::cast::whole(first)..=crate::cast::whole(last))
        };
        let (columns, rows) = (reach(at.x, size.x)?, reach(at.y, size.y)?);
        let (mut chosen, mut sum) = (None, 0.0);
        for y in rows {
            for x in columns.clone() {
                let offset = (at - UVec2::new(x, y).as_dvec2() - 0.5).as_vec2();
                let value = f64::from(filter.eval(offset.to_array()));
                if !(value > 0.0) {
                    continue;
                }
                sum += value;
                let chance = value / sum;
                if u < chance {
                    chosen = Some(u64::from(y) * u64::from(size.x) + u64::from(x));
                    u /= chance;
                } else {
                    u = (u - chance) / (1.0 - chance);
                }
            }
        }
        Some((u32::try_from(chosen?).ok()?, sum))
    }

    /// Pixels per solid angle around a place of the picture, times what its rays count for.
    fn density(&self, camera: &dyn Camera, at: DVec2) -> Option<f64> {
        let d =
            |x: f64, y: f64| Some(camera.ray(self.raster, at + DVec2::new(x, y), [0.5; 2])?.ray.d);
        let across = (d(STEP, 0.0)? - d(-STEP, 0.0)?) / (2.0 * STEP);
        let down = (d(0.0, STEP)? - d(0.0, -STEP)?) / (2.0 * STEP);
        let weight = camera.ray(self.raster, at, [0.5; 2])?.weight;
        Some(f64::from(weight) / across.cross(down).length())
    }
}
