//! The camera as paths from lights find it: a point, and which pixels look where.

use glam::{DVec2, DVec3, UVec2};
use luxel_sdk::kind::{Camera, CameraRay, Filter, Raster, Wants};
use luxel_sdk::num::unit_and_length;

use super::{Moment, Stage};
use crate::diag::Diagnostic;

/// Where the camera stands, if its lens is a point.
#[derive(Clone, Copy, Debug)]
pub struct Eye {
    /// In the camera's frame.
    p: DVec3,
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

    /// Where it is at a moment, in the world.
    pub fn at(&self, moment: Moment<'_>) -> DVec3 {
        let mut room = None;
        let place = moment.camera_place.at(moment.time, &mut room);
        place.map_or(self.p, |transform| transform.point(self.p))
    }

    /// How the camera sees a point. `u` uniform in [0, 1) chooses among the pixels that see it.
    pub fn sees(&self, moment: Moment<'_>, p: DVec3, u: f32) -> Option<Seen> {
        let to = self.at(moment) - p;
        let distance2 = to.length_squared();
        let at = moment.project(p).filter(|at| at.is_finite())?;
        let (pixel, weight) = self.pixel(moment.filter.fixed().filter(), at, f64::from(u))?;
        let density = density(moment, at)?;
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
}

/// Pixels per solid angle around a place of the picture, times what its rays count for.
fn density(moment: Moment<'_>, at: DVec2) -> Option<f64> {
    let d = |x: f64, y: f64| Some(moment.camera_ray(at + DVec2::new(x, y), [0.5; 2])?.ray.d);
    let across = (d(STEP, 0.0)? - d(-STEP, 0.0)?) / (2.0 * STEP);
    let down = (d(0.0, STEP)? - d(0.0, -STEP)?) / (2.0 * STEP);
    let weight = moment.camera_ray(at, [0.5; 2])?.weight;
    Some(f64::from(weight) / across.cross(down).length())
}

impl Moment<'_> {
    /// The camera's ray through raster point `p`, in the world; `lens` uniform in [0, 1)².
    #[inline]
    pub fn camera_ray(self, p: DVec2, lens: [f32; 2]) -> Option<CameraRay> {
        let raster = Raster { size: self.film.resolution };
        let mut found = self.camera.fixed().camera().ray(raster, p, lens)?;
        let mut room = None;
        if let Some(transform) = self.camera_place.at(self.time, &mut room) {
            found.ray.o = transform.point(found.ray.o);
            found.ray.d = unit_and_length(transform.vector(found.ray.d)).0;
        }
        Some(found)
    }

    /// Where a point in the world appears through the centre of the lens; `None` behind it.
    pub fn project(self, p: DVec3) -> Option<DVec2> {
        let raster = Raster { size: self.film.resolution };
        let mut room = None;
        let place = self.camera_place.at(self.time, &mut room);
        let p = place.map_or(p, |transform| transform.inverse_point(p));
        self.camera.fixed().camera().project(raster, p)
    }
}

/// An integrator that looks for the camera from where light is, and a camera that is no point.
pub(super) fn unseen(stage: &Stage) -> Option<Diagnostic> {
    let integrator = stage.integrator.fixed().integrator();
    let looks = integrator.as_picture().is_some() && integrator.wants().has(Wants::SIGHT);
    if !looks || stage.eye.is_some() {
        return None;
    }
    let name = stage.integrator.class().name;
    let message = format!("`{name}` needs a camera whose lens is a point, as `perspective`");
    let camera = stage.scene.camera.map(|id| stage.scene.node(id).span);
    Some(match camera {
        Some(span) => Diagnostic::error("E0422", span, message).label(span, "this camera"),
        None => Diagnostic::unplaced("E0422", message),
    })
}
