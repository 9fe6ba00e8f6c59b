//! Where paths from lights begin.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DVec2, DVec3, Vec2};
use luxel_sdk::color::{Palette, Spectrum, Wavelengths};
use luxel_sdk::kind::{Arrival, LightForm, Surface};
use luxel_sdk::num::{Frame, Ray, offset_origin};
use luxel_sdk::sampling::{
    Piecewise2, cosine_hemisphere, disk_concentric, sobol_owen_2d, uniform_sphere, uniform_triangle,
};

use super::super::{Geometry, Leaving, MediumStack, Moment, Place};
use super::{LightSource, emitted};
use crate::cast::{index, narrow};
use crate::object::{ColorMode, Object, Scratch, Site};

/// What is found once, before paths begin at lights.
#[derive(Debug, Default)]
pub struct Emitters {
    /// For each source, where it is a point.
    points: Vec<Option<Beacon>>,
}

/// A light at a point, as it is when the shutter opens.
#[derive(Debug)]
struct Beacon {
    p: DVec3,
    media: MediumStack,
    /// Density of directions: height from 1 to −1 down, azimuth across.
    directions: Piecewise2,
}

/// Light that leaves a source along a ray.
#[derive(Clone, Copy, Debug)]
pub struct Emitted {
    /// From the source, or from outside the scene.
    pub ray: Ray,
    /// `le·|cos| / pdf`, W.
    pub beta: Spectrum,
    /// The surface that it leaves.
    pub lamp: Option<Lamp>,
    /// The media around its origin.
    pub media: MediumStack,
}

/// A point of a shining surface.
#[derive(Clone, Copy, Debug)]
pub struct Lamp {
    /// In the world.
    pub surface: Surface,
    /// Which face of which placement.
    pub leaving: Leaving,
    light: u32,
    /// Reciprocal density of the point, m².
    per_pdf: f64,
}

/// The random numbers that a path from a light begins with.
#[derive(Clone, Copy, Debug)]
pub struct EmissionNumbers {
    /// Chooses the source.
    pub light: f32,
    /// Chooses the side of a surface.
    pub side: f32,
    /// A point.
    pub point: [f32; 2],
    /// A direction.
    pub direction: [f32; 2],
}

/// Tries to find a light at a point: a beam of a thousandth of all directions is found.
const TRIES: u32 = 1 << 14;
/// Rows of the table of directions, and columns.
const TABLE: [u32; 2] = [16, 32];
/// Least share of a side, and of a cell of the table: what looked dark may shine.
const FLOOR: f64 = 1.0 / 64.0;

impl Moment<'_> {
    /// What has to be found before `emit`, for all times.
    pub fn emitters(self) -> Emitters {
        let beacon = |source: &LightSource| match source {
            LightSource::Free { object, .. }
                if object.fixed().light().form() == LightForm::Point =>
            {
                self.beacon(source)
            }
            _ => None,
        };
        Emitters { points: self.lights.sources.iter().map(beacon).collect() }
    }

    /// A beginning of a path from a light, every one with its due chance. A point light is never
    /// found where it lights none of many points in and around the scene.
    pub fn emit(
        self,
        emitters: &Emitters,
        palette: &Palette,
        u: &EmissionNumbers,
        scratch: &mut Scratch,
    ) -> Option<Emitted> {
        let drawn = self.lights.choice.as_ref()?.sample(f64::from(u.light));
        scratch.reset();
        let found = match &self.lights.sources[drawn.index] {
            source @ LightSource::Surface { .. } => {
                self.emit_surface(index(drawn.index), source, palette, (u, drawn.u), scratch)
            }
            source => match &emitters.points[drawn.index] {
                Some(beacon) => self.emit_point(source, beacon, palette, u.direction, scratch),
                None => self.emit_infinite(source, palette, u, scratch),
            },
        }?;
        let chance = narrow(drawn.pmf);
        let lamp = found.lamp.map(|lamp| Lamp { per_pdf: lamp.per_pdf / drawn.pmf, ..lamp });
        let beta = found.beta / chance;
        (beta.is_finite() && !beta.is_black()).then_some(Emitted { beta, lamp, ..found })
    }

    fn emit_surface(
        self,
        light: u32,
        source: &LightSource,
        palette: &Palette,
        (u, left): (&EmissionNumbers, f64),
        scratch: &Scratch,
    ) -> Option<Emitted> {
        let LightSource::Surface { object, placement: place, area, triangles, .. } = source else {
            return None;
        };
        let placement = &self.placements[*place as usize];
        let (mut surface, face, mut pdf) = match &*self.geometries[placement.geometry as usize] {
            Geometry::Mesh(mesh) => {
                let facets = triangles.as_deref()?;
                let triangle = index(facets.choice.sample(left).index);
                let [_, b, c] = uniform_triangle(u.point).map(f64::from);
                let surface =
                    mesh.surface(triangle, DVec2::new(b, c), self.film.precision, self.time);
                let mut room = None;
                let transform = placement.place.at(self.time, &mut room);
                let chosen = (facets, triangle);
                let pdf = self.facet_density(placement, mesh, chosen, *area, transform)
                    * transform.map_or(1.0, |transform| transform.area_scale(surface.ng));
                (surface, triangle, pdf)
            }
            Geometry::Analytic(shape) => {
                let sample = shape.object().fixed().shape().sample(None, u.point)?;
                (sample.surface, 0, sample.pdf)
            }
        };
        if let Some(transform) = placement.place.at(self.time, &mut None) {
            pdf /= transform.area_scale(surface.ng);
            surface = surface.carried(transform);
        }
        if !(pdf > 0.0 && pdf.is_finite()) {
            return None;
        }
        let le = self.shines(object, &surface, *area, palette, scratch);
        // Few cosines tell which side shines.
        let bright = |side: f32| [1.0, 0.5, 0.1].map(|cos: f32| f64::from(le(side * cos).mean()));
        let [front, back] = [1.0, -1.0].map(|side| bright(side).iter().sum::<f64>());
        let share = front / (front + back);
        let share = if share.is_nan() { 0.5 } else { share.clamp(FLOOR, 1.0 - FLOOR) };
        let (side, chance) =
            if f64::from(u.side) < share { (1.0, share) } else { (-1.0, 1.0 - share) };
        // The cosine of emission and that of the density cancel.
        let local = cosine_hemisphere(u.direction);
        let frame = Frame::from_z(surface.ng.as_vec3());
        let d = (frame.to_world(local).as_dvec3() * f64::from(side)).normalize();
        let o = offset_origin(surface.p, surface.p_err, surface.ng, d);
        let beta = le(side * local.z) * narrow(PI / (pdf * chance));
        let media =
            if self.features.is_tracked() { self.media_at(o) } else { MediumStack::default() };
        let leaving = Leaving { placement: *place, face };
        let lamp = Some(Lamp { surface, leaving, light, per_pdf: 1.0 / pdf });
        Some(Emitted { ray: Ray { o, d, t_max: f64::INFINITY }, beta, lamp, media })
    }

    /// Radiance of a surface by the cosine.
    fn shines<'a>(
        &'a self,
        object: &'a Object,
        surface: &Surface,
        area: f64,
        palette: &'a Palette,
        scratch: &'a Scratch,
    ) -> impl Fn(f32) -> Spectrum + 'a {
        let uv = surface.uv.as_vec2();
        let light =
            object.resolve(&Site { p: surface.p, uv, palette, color: None }, scratch).light();
        move |cos| emitted(light, light.le(cos, uv, area), self.mode, palette)
    }

    /// What a point of a shining surface sends along the unit direction `d`, times the cosine, over
    /// the density of the point: W·sr⁻¹.
    pub fn lamp_towards(
        &self,
        lamp: &Lamp,
        d: DVec3,
        palette: &Palette,
        scratch: &mut Scratch,
    ) -> Spectrum {
        let LightSource::Surface { object, area, .. } = &self.lights.sources[lamp.light as usize]
        else {
            return Spectrum::ZERO;
        };
        scratch.reset();
        let cos = lamp.surface.ng.dot(d);
        let le = self.shines(object, &lamp.surface, *area, palette, scratch);
        le(narrow(cos)) * narrow(cos.abs() * lamp.per_pdf)
    }

    fn emit_point(
        self,
        source: &LightSource,
        beacon: &Beacon,
        palette: &Palette,
        u: [f32; 2],
        scratch: &Scratch,
    ) -> Option<Emitted> {
        let drawn = beacon.directions.sample(u.map(f64::from));
        let (mut p, mut d, mut per_pdf) = (beacon.p, direction(drawn.uv), 4.0 * PI / drawn.pdf);
        let mut media = beacon.media;
        if let LightSource::Free { place, .. } = source
            && let Some((now, stretch)) = since_opening(place, self.time, d)
        {
            (p, d) = (now.transform_point3(p), now.transform_vector3(d).normalize());
            per_pdf *= stretch;
            if self.features.is_tracked() {
                media = self.media_at(p);
            }
        }
        let intensity = self.intensity(source, p, d, palette, scratch)?;
        let beta = intensity * narrow(per_pdf);
        let ray = Ray { o: p, d, t_max: f64::INFINITY };
        Some(Emitted { ray, beta, lamp: None, media })
    }

    /// W/sr from the point `p` along `d`: what arrives at a distance of one radius of the scene.
    fn intensity(
        self,
        source: &LightSource,
        p: DVec3,
        d: DVec3,
        palette: &Palette,
        scratch: &Scratch,
    ) -> Option<Spectrum> {
        let from = p + d * self.sphere.1;
        let (at, le) = self.found_from(source, from, [0.5; 2], palette, scratch)?;
        let distance = at.t_max;
        Some(le * narrow(distance * distance))
    }

    /// The ray to a source without a surface from a point, and radiance over density, or irradiance.
    fn found_from(
        self,
        source: &LightSource,
        p: DVec3,
        u: [f32; 2],
        palette: &Palette,
        scratch: &Scratch,
    ) -> Option<(Ray, Spectrum)> {
        let LightSource::Free { object, place } = source else { return None };
        let from = Arrival { p, ..Arrival::default() };
        let site = Site { p, uv: Vec2::ZERO, palette, color: None };
        let light = object.resolve(&site, scratch).light();
        let found = self.sample_free(light, place, &from, palette, u)?;
        Some((found.ray, found.le_over_pdf))
    }

    /// Parallel light through what holds the scene, and what fills the outside of it.
    fn emit_infinite(
        self,
        source: &LightSource,
        palette: &Palette,
        u: &EmissionNumbers,
        scratch: &Scratch,
    ) -> Option<Emitted> {
        let (centre, near) = self.sphere;
        let radius = if self.outside.is_some() { self.reach } else { near };
        let (to, le) = self.found_from(source, centre, u.direction, palette, scratch)?;
        if to.t_max.is_finite() {
            // A light at a point that was not found.
            return None;
        }
        let across = Frame::from_z(to.d.as_vec3());
        let disk = disk_concentric(u.point);
        // Outside the sphere there is nothing: paths begin where they enter it.
        let height = (1.0 - disk.as_dvec2().length_squared()).max(0.0).sqrt();
        let aside = across.to_world(disk.extend(0.0)).as_dvec3();
        let o = centre + (aside + to.d * height) * radius;
        let ray = Ray { o, d: -to.d, t_max: f64::INFINITY };
        let beta = le * narrow(PI * radius * radius);
        Some(Emitted { ray, beta, lamp: None, media: MediumStack::default() })
    }

    /// Looks for a light at a point by asking for its light where some may arrive.
    fn beacon(self, source: &LightSource) -> Option<Beacon> {
        let (centre, radius) = self.sphere;
        let mut scratch = Scratch::default();
        let (from, to) = (0..TRIES).find_map(|i| {
            let d = uniform_sphere(sobol_owen_2d(i, 0xbeac)).as_dvec3();
            let p = centre + d * (radius * [0.3, 1.0, 4.0, 64.0][i as usize % 4]);
            scratch.reset();
            let (ray, _) = self.found_from(source, p, [0.5; 2], &self.some(i), &scratch)?;
            Some((p, ray))
        })?;
        // Once more from nearby: what rounds is then as small as the scene.
        let rough = to.at(to.t_max);
        let near = rough + (from - rough).normalize_or_zero() * radius;
        let again = (0..64).find_map(|i| {
            scratch.reset();
            self.found_from(source, near, [0.5; 2], &self.some(i), &scratch)
        });
        let p = again.map_or(rough, |(ray, _)| ray.at(ray.t_max));
        if !p.is_finite() {
            return None;
        }
        let media =
            if self.features.is_tracked() { self.media_at(p) } else { MediumStack::default() };
        Some(Beacon { p, media, directions: self.directions(source, p, &mut scratch)? })
    }

    /// Wavelengths among which a light that has few finds its own.
    fn some(&self, i: u32) -> Palette {
        match self.mode {
            ColorMode::Rgb => Palette::rgb(),
            ColorMode::Spectral => Palette::new(Wavelengths::sample(sobol_owen_2d(i, 0x1a3bda)[0])),
        }
    }

    fn directions(
        self,
        source: &LightSource,
        p: DVec3,
        scratch: &mut Scratch,
    ) -> Option<Piecewise2> {
        let [rows, columns] = TABLE;
        let mut bright = vec![0.0; (rows * columns) as usize];
        for (cell, sum) in bright.iter_mut().enumerate() {
            let (row, column) = (index(cell) / columns, index(cell) % columns);
            for i in 0..8 {
                let [x, y] = sobol_owen_2d(i, 0xd1).map(f64::from);
                let uv = [
                    (f64::from(column) + x) / f64::from(columns),
                    (f64::from(row) + y) / f64::from(rows),
                ];
                scratch.reset();
                let found = self.intensity(source, p, direction(uv), &self.some(i), scratch);
                let mean = found.map_or(0.0, |found| f64::from(found.mean()));
                *sum += if mean.is_finite() { mean } else { 0.0 };
            }
        }
        let floor = FLOOR * bright.iter().sum::<f64>() / bright.len() as f64;
        let at = |row: u32, column: u32| bright[(row * columns + column % columns) as usize];
        // An edge of a beam may run between the directions that were tried.
        let spread = |cell: u32| {
            let (row, column) = (cell / columns, cell % columns);
            let around = (row.saturating_sub(1)..=(row + 1).min(rows - 1))
                .flat_map(|row| (0..3).map(move |i| at(row, column + columns - 1 + i)));
            bright[cell as usize] + 0.25 * around.fold(0.0, f64::max) + floor
        };
        let weights: Vec<f64> = (0..rows * columns).map(spread).collect();
        Piecewise2::new(&weights, columns as usize).ok()
    }
}

/// How something has moved since the shutter opened, and how much larger the solid angle around the
/// unit direction `d` of then is now; `None` where it stands.
fn since_opening(place: &Place, time: f64, d: DVec3) -> Option<(DAffine3, f64)> {
    let mut room = None;
    let now = place.at(time, &mut room).filter(|_| place.is_moving())?;
    let moved = *now.affine() * place.first()?.affine().inverse();
    let length = moved.transform_vector3(d).length();
    Some((moved, moved.matrix3.determinant().abs() / (length * length * length)))
}

/// A direction of the table: equal areas of the square are equal solid angles.
fn direction([u, v]: [f64; 2]) -> DVec3 {
    let z = 1.0 - 2.0 * v;
    let (sin, cos) = (TAU * u).sin_cos();
    let r = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(r * cos, r * sin, z)
}
