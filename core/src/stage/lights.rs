//! Which light is looked for, and what it sends.

mod emission;
mod quad;
mod sought;
mod triangle;

use std::sync::Arc;

use glam::{DVec3, Vec2};
use luxel_sdk::color::{Palette, Spectrum, Wavelengths};
use luxel_sdk::kind::{Arrival, Hit, Light, LightForm, LightQuery, Output, ShapeSample, Surface};
use luxel_sdk::num::{Ray, Transform, offset_origin, unit_and_length};
use luxel_sdk::sampling::Alias;

use self::sought::Sought;
use self::triangle::Lit;
use super::{Geometry, Mesh, Moment, Place, Placement};
use crate::accel::Watch;
use crate::cast::{index, narrow};
use crate::object::{ColorMode, Object, Scratch, Site};

pub use emission::{EmissionNumbers, Emitted, Emitters, Lamp};
pub use quad::Quad;
pub use triangle::Facets;

/// A source of light of the stage.
#[derive(Debug)]
pub enum LightSource {
    /// A placement whose surface shines.
    Surface {
        /// The light's object.
        object: Arc<Object>,
        /// Which placement.
        placement: u32,
        /// Its area in the world, m².
        area: f64,
        /// For meshes: their triangles.
        triangles: Option<Arc<Facets>>,
        /// For sheared parallelograms: what they are.
        quad: Option<Quad>,
    },
    /// A light at a point or far away.
    Free {
        /// The light's object.
        object: Arc<Object>,
        /// From its frame to the world.
        place: Place,
    },
}

impl LightSource {
    fn object(&self) -> &Arc<Object> {
        match self {
            Self::Surface { object, .. } | Self::Free { object, .. } => object,
        }
    }

    fn form(&self) -> LightForm {
        self.object().fixed().light().form()
    }

    /// Whether it is in one piece, not in triangles to choose from.
    fn is_whole(&self) -> bool {
        !matches!(self, Self::Surface { triangles: Some(_), .. })
    }
}

/// Every source of light and how one is chosen.
#[derive(Debug, Default)]
pub struct Lights {
    /// The sources.
    pub sources: Vec<LightSource>,
    /// Indices of those that escaped rays find.
    pub infinite: Vec<u32>,
    /// Names of the groups that some are of.
    pub groups: Vec<Arc<str>>,
    /// Which of them each source is of.
    pub group_of: Vec<Option<u32>>,
    /// By which paths choose where to begin.
    choice: Option<Arc<Alias>>,
    /// Those that are looked for.
    sought: Option<Sought>,
}

/// Light that was found from a point.
#[derive(Clone, Copy, Debug)]
pub struct FoundLight {
    /// From the point to the light, offset at both ends.
    pub ray: Ray,
    /// Radiance over density; for a delta light irradiance over the chance of its choice.
    pub le_over_pdf: Spectrum,
    /// Solid-angle density; infinite for a delta light.
    pub pdf: f32,
    /// Which source it is of.
    pub light: u32,
}

impl Lights {
    /// Lights of no group, chosen about in proportion to their power; of no use once the watch is cancelled.
    /// Light from everywhere is looked for where there are media alone: elsewhere what scatters finds it
    /// at least as well.
    pub(super) fn new(
        sources: Vec<LightSource>,
        (stage_radius, mode): (f64, ColorMode),
        has_media: bool,
        watch: &Watch,
    ) -> Self {
        let power = |light| f64::from(power(light, stage_radius, mode));
        let power: Vec<f64> = watch.until(&sources).map(power).collect();
        let mean = power.iter().sum::<f64>() / power.len().max(1) as f64;
        // A floor of 1 % of the mean: a texture that was looked up where it is dark, or an estimate
        // that is wrong, must not leave a light without a chance.
        let weights: Vec<f64> = power.iter().map(|p| p + 0.01 * mean).collect();
        let is_infinite = |form| matches!(form, LightForm::Infinite | LightForm::Everywhere);
        let infinite = (0..index(sources.len()))
            .filter(|i| is_infinite(sources[*i as usize].form()))
            .collect();
        let choice = Alias::new(&weights).ok().map(Arc::new);
        let is_sought = |light: &LightSource| has_media || light.form() != LightForm::Everywhere;
        let sought = Sought::new(&sources, is_sought, &weights, choice.as_ref());
        let (groups, group_of) = (vec![], vec![None; sources.len()]);
        Self { sources, infinite, groups, group_of, choice, sought }
    }

    /// The same in groups.
    pub(super) fn in_groups(self, groups: Vec<Arc<str>>, group_of: Vec<Option<u32>>) -> Self {
        Self { groups, group_of, ..self }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.sources.is_empty()
    }

    /// How many there are.
    pub fn len(&self) -> usize {
        self.sources.len()
    }

    /// Whether any is looked for.
    pub fn is_sought(&self) -> bool {
        self.sought.is_some()
    }

    /// Whether there are several to choose from when one is looked for: sources, or triangles of a source.
    pub fn is_choice(&self) -> bool {
        self.sought.as_ref().is_some_and(|it| it.is_choice(&self.sources))
    }

    /// Whether the first that is looked for is in one piece.
    pub(super) fn is_first_whole(&self) -> bool {
        self.sought.as_ref().is_some_and(|it| it.first(&self.sources).is_whole())
    }

    /// The chance with which a light is looked for.
    fn chance(&self, light: u32) -> f64 {
        self.sought.as_ref().map_or(0.0, |it| it.chance(light))
    }
}

/// Places along each texture coordinate at which a light's power is asked for.
const GRID: u32 = 4;

fn power(light: &LightSource, radius: f64, mode: ColorMode) -> f32 {
    let palette = Palette::new(Wavelengths::sample(0.5));
    let mut scratch = Scratch::default();
    let mut sum = 0.0;
    for i in 0..GRID * GRID {
        let uv = (Vec2::new((i % GRID) as f32, (i / GRID) as f32) + 0.5) / GRID as f32;
        scratch.reset();
        let at = Site { p: DVec3::ZERO, uv, palette: &palette, color: None };
        let area = match light {
            LightSource::Surface { area, .. } => *area,
            LightSource::Free { .. } => 0.0,
        };
        let p = light.object().resolve(&at, &scratch).light().power(area, radius);
        sum += if p.is_finite() && p > 0.0 { p } else { 0.0 };
        if light.object().is_constant() && mode == ColorMode::Rgb {
            return sum;
        }
    }
    sum / (GRID * GRID) as f32
}

/// Lanes of what a light emits: RGB is uplifted where the path is spectral.
fn emitted(light: &dyn Light, value: Spectrum, mode: ColorMode, palette: &Palette) -> Spectrum {
    if mode.is_spectral() && light.output() == Output::Rgb {
        return palette.illuminant(value.rgb());
    }
    value
}

impl Moment<'_> {
    /// Chooses a light and light from it, as `from` sees it: its place, normals and `wo` count. `u`
    /// uniform in [0, 1). Without `CHOICE` there is one light at most, of one piece.
    #[inline(always)]
    pub fn sample_light<const CHOICE: bool>(
        self,
        from: &Arrival,
        palette: &Palette,
        u: [f32; 3],
        scratch: &Scratch,
    ) -> Option<FoundLight> {
        let chosen = self.lights.sought.as_ref()?.choose::<CHOICE>(&self.lights.sources, u[0]);
        let u = [u[1], u[2]];
        let found = match chosen.source {
            LightSource::Surface { object, placement, area, triangles, quad } => {
                let triangles = triangles.as_deref().filter(|_| CHOICE);
                let triangles = triangles.map(|facets| (facets, chosen.u));
                let (placement, area, quad) = (*placement, *area, quad.as_ref());
                let light = SurfaceLight { object, placement, area, triangles, quad };
                self.sample_surface(&light, from, palette, u, scratch)
            }
            LightSource::Free { object, place } => {
                let at = Site { p: from.p + from.lift, uv: Vec2::ZERO, palette, color: None };
                let light = object.resolve(&at, scratch).light();
                self.sample_free(light, place, from, palette, u)
            }
        }?;
        Some(found.of(chosen.light, chosen.chance))
    }

    fn sample_free(
        self,
        light: &dyn Light,
        place: &Place,
        from: &Arrival,
        palette: &Palette,
        u: [f32; 2],
    ) -> Option<FoundLight> {
        let p = from.p + from.lift;
        let mut room = None;
        let transform = place.at(self.time, &mut room);
        let p = transform.map_or(p, |transform| transform.inverse_point(p));
        let found = light.sample(&LightQuery { p, u })?;
        let mut le = emitted(light, found.le, self.mode, palette);
        let (mut wi, mut distance) = (found.wi, found.distance);
        if let Some(transform) = transform {
            let to = transform.vector(found.wi);
            let scale = to.length();
            wi = to / scale;
            if distance.is_finite() {
                // A delta light gave irradiance at its own distance.
                le /= narrow(scale * scale);
                distance *= scale;
            }
        }
        let pdf = if found.delta { f32::INFINITY } else { found.pdf };
        let usable = found.pdf > 0.0 && !le.is_black();
        usable.then(|| FoundLight {
            ray: from.ray_to(wi, distance),
            le_over_pdf: le / found.pdf,
            pdf,
            light: 0,
        })
    }

    #[inline(always)]
    fn sample_surface(
        self,
        light: &SurfaceLight<'_>,
        from: &Arrival,
        palette: &Palette,
        u: [f32; 2],
        scratch: &Scratch,
    ) -> Option<FoundLight> {
        let placement = &self.placements[light.placement as usize];
        let geometry = &self.geometries[placement.geometry as usize];
        let mut room = None;
        let transform = placement.place.at(self.time, &mut room);
        // Density per solid angle, where that is how a point is found.
        let mut direct = None;
        let mut sample = match (&**geometry, light.triangles) {
            (Geometry::Mesh(mesh), Some((facets, choose))) => {
                let (from, time) = (from.p + from.lift, self.time);
                let point = Lit { mesh, facets, transform, from, time }.sample(u, choose);
                direct = point.pdf;
                let precision = self.film.precision;
                let surface = mesh.surface(point.triangle, point.at, precision, time);
                // The world's density in the mesh's own frame.
                let chosen = (facets, point.triangle);
                let pdf = self.facet_density(placement, mesh, chosen, light.area, transform)
                    * transform.map_or(1.0, |transform| transform.area_scale(surface.ng));
                Some(ShapeSample { surface, pdf })
            }
            (Geometry::Analytic(shape), _) => {
                let (shape, from) = (shape.object().fixed().shape(), from.p + from.lift);
                let local = transform.map_or(from, |transform| transform.inverse_point(from));
                match light.quad.and_then(|quad| quad.seen(transform, from)) {
                    Some(seen) => {
                        direct = Some(seen.pdf());
                        let hit = Hit { t: 0.0, at: seen.sample(u), face: 0 };
                        let surface = shape.surface(&Ray::new(local, DVec3::X), &hit);
                        Some(ShapeSample { surface, pdf: 1.0 })
                    }
                    None => shape.sample(Some(local), u),
                }
            }
            (Geometry::Mesh(_), None) => None,
        };
        // By reference: a surface is large to copy.
        let sample = sample.as_mut()?;
        if let Some(transform) = transform {
            sample.pdf /= transform.area_scale(sample.surface.ng);
            sample.surface = sample.surface.carried(transform);
        }
        let surface = &sample.surface;
        let ray = ray_between(from, surface);
        let to = surface.p - (from.p + from.lift);
        let distance2 = to.length_squared();
        let cos_o = -surface.ng.dot(ray.d);
        let (pdf, per_pdf) = match direct {
            Some(pdf) => (pdf, pdf.recip()),
            None => (sample.pdf * distance2 / cos_o.abs(), cos_o.abs() / (sample.pdf * distance2)),
        };
        if !(pdf > 0.0 && pdf.is_finite()) {
            return None;
        }
        let uv = surface.uv.as_vec2();
        let at = Site { p: surface.p, uv, palette, color: None };
        let resolved = light.object.resolve(&at, scratch).light();
        let le = emitted(resolved, resolved.le(narrow(cos_o), uv, light.area), self.mode, palette);
        (!le.is_black()).then(|| FoundLight {
            ray,
            le_over_pdf: le * narrow(per_pdf),
            pdf: narrow(pdf),
            light: 0,
        })
    }

    /// Radiance of a face of a shining surface towards the point `from`, and the density with which
    /// `sample_light` would have found it from there; `wo` is the unit direction of the ray that came.
    pub fn surface_emission(
        self,
        (placement, face): (&Placement, u32),
        surface: &Surface,
        (from, wo): (DVec3, DVec3),
        palette: &Palette,
        scratch: &Scratch,
    ) -> (Spectrum, f32) {
        let Some(light) = placement.light else { return (Spectrum::ZERO, 0.0) };
        let source = &self.lights.sources[light as usize];
        let LightSource::Surface { object, area, .. } = source else {
            return (Spectrum::ZERO, 0.0);
        };
        let uv = surface.uv.as_vec2();
        let at = Site { p: surface.p, uv, palette, color: None };
        let resolved = object.resolve(&at, scratch).light();
        let cos_o = surface.ng.dot(wo);
        let le = emitted(resolved, resolved.le(narrow(cos_o), uv, *area), self.mode, palette);
        if le.is_black() {
            return (le, 0.0);
        }
        let pdf = self
            .surface_pdf((placement, face), source, surface, from)
            .unwrap_or_else(|area| area * surface.p.distance_squared(from) / cos_o.abs());
        (le, narrow(pdf * self.lights.chance(light)))
    }

    /// Density per area of the world of a point of a triangle that is chosen for its size.
    fn facet_density(
        self,
        placement: &Placement,
        mesh: &Mesh,
        (facets, triangle): (&Facets, u32),
        area: f64,
        transform: Option<&Transform>,
    ) -> f64 {
        if !(placement.place.is_moving() || mesh.is_moving()) {
            return 1.0 / area;
        }
        let edge = |v| transform.map_or(v, |transform| transform.vector(v));
        facets.choice.pmf(triangle as usize) / mesh.area(triangle, self.time, edge)
    }

    /// Density per solid angle with which a point of a shining surface is sampled from there.
    ///
    /// # Errors
    /// The density per area of the world, where that is how it is sampled.
    fn surface_pdf(
        self,
        (placement, face): (&Placement, u32),
        source: &LightSource,
        surface: &Surface,
        from: DVec3,
    ) -> Result<f64, f64> {
        let LightSource::Surface { area, triangles, quad, .. } = source else { return Ok(0.0) };
        let place = &placement.place;
        let mut room = None;
        let transform = place.at(self.time, &mut room);
        let shape = match &*self.geometries[placement.geometry as usize] {
            Geometry::Analytic(shape) => shape.object().fixed().shape(),
            Geometry::Mesh(mesh) => {
                let Some(facets) = triangles.as_deref() else { return Ok(0.0) };
                let lit = Lit { mesh, facets, transform, from, time: self.time };
                if let Some(pdf) = lit.pdf(face) {
                    return Ok(pdf);
                }
                let chosen = (facets, face);
                return Err(self.facet_density(placement, mesh, chosen, *area, transform));
            }
        };
        if let Some(seen) = quad.as_ref().and_then(|quad| quad.seen(transform, from)) {
            return Ok(seen.pdf());
        }
        let Some(transform) = transform else { return Err(shape.pdf(Some(from), surface)) };
        let mut local = *surface;
        local.p = transform.inverse_point(surface.p);
        local.ng = transform.inverse_normal(surface.ng).normalize();
        let pdf = shape.pdf(Some(transform.inverse_point(from)), &local);
        Err(pdf / transform.area_scale(local.ng))
    }

    /// What a ray that leaves the scene along `d` finds, and the density with which `sample_light`
    /// would have found it.
    pub fn escaped(self, d: DVec3, palette: &Palette, scratch: &Scratch) -> (Spectrum, f32) {
        self.escaped_to(|_| true, d, palette, scratch)
    }

    /// The same of a group of lights alone.
    pub fn escaped_to_group(
        self,
        group: u32,
        d: DVec3,
        palette: &Palette,
        scratch: &Scratch,
    ) -> Spectrum {
        let is_of = |light: u32| self.lights.group_of[light as usize] == Some(group);
        self.escaped_to(is_of, d, palette, scratch).0
    }

    #[inline(always)]
    fn escaped_to(
        self,
        is_meant: impl Fn(u32) -> bool,
        d: DVec3,
        palette: &Palette,
        scratch: &Scratch,
    ) -> (Spectrum, f32) {
        let (mut le, mut pdf) = (Spectrum::ZERO, 0.0);
        for &light in self.lights.infinite.iter().filter(|light| is_meant(**light)) {
            let LightSource::Free { object, place } = &self.lights.sources[light as usize] else {
                continue;
            };
            let local = match place.at(self.time, &mut None) {
                Some(transform) => transform.inverse_vector(d).normalize(),
                None => d,
            };
            let at = Site { p: DVec3::ZERO, uv: Vec2::ZERO, palette, color: None };
            let resolved = object.resolve(&at, scratch).light();
            let found = resolved.escaped(local);
            le += emitted(resolved, found.le, self.mode, palette);
            pdf += found.pdf * narrow(self.lights.chance(light));
        }
        (le, pdf)
    }
}

/// A shining placement from which light is sampled.
struct SurfaceLight<'a> {
    object: &'a Object,
    placement: u32,
    area: f64,
    /// For meshes: their triangles, and a random number to choose by.
    triangles: Option<(&'a Facets, f64)>,
    quad: Option<&'a Quad>,
}

impl FoundLight {
    fn of(self, light: u32, chance: f32) -> Self {
        Self { le_over_pdf: self.le_over_pdf / chance, pdf: self.pdf * chance, light, ..self }
    }
}

/// Share of a ray's length by which it ends before a surface: a ray that goes on to a sphere meets it
/// up to 1e-14 of its length too soon (`sphere_roots`: 1e-9 radii from 1e5 away), which is more than
/// the error of the point.
const SHORT: f64 = 1.0 / (1u64 << 45) as f64;

/// The ray from a point to a point of a surface, both moved beyond their errors towards each other.
#[inline(always)]
fn ray_between(from: &Arrival, to: &Surface) -> Ray {
    let d = to.p - from.p;
    let o = from.origin(d);
    let end = offset_origin(to.p, to.p_err, to.ng, -d);
    let d = end - o;
    let (d, distance) = unit_and_length(d);
    Ray { o, d, t_max: distance * (1.0 - SHORT) }
}
