//! Shading an arrival as far as the integrator wants.

use glam::{DVec3, Vec3};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Arrival, ArrivalKind, Direct, Lobe, Material, Needs, Phase, Sample, Samples, Scatter, Sight,
    Surface, Wants,
};
use luxel_sdk::num::{Frame, Ray, unit_again, unit_and_length};

use super::path::{Path, Standing};
use crate::cast::narrow;
use crate::object::{Scratch, Site};
use crate::stage::{Crossing, FoundLight, Leaving, Moment, SceneHit, Seen, Skin, Stage};

/// What is needed to shade: borrowed for one arrival. Compiled for scenes whose shapes may be nested and
/// for others, for such with a choice among lights and for others.
pub(super) struct Shader<'a, 's, const NESTED: bool, const CHOICE: bool> {
    pub(super) stage: Moment<'a>,
    pub(super) wants: Wants,
    pub(super) path: &'a mut Path,
    pub(super) samples: &'a mut Samples<'s>,
    pub(super) scratch: &'a mut Scratch,
    /// What the media between the last arrival and this one let through.
    pub(super) flight: Spectrum,
}

impl<const NESTED: bool, const CHOICE: bool> Shader<'_, '_, NESTED, CHOICE> {
    /// The ray left the scene.
    pub(super) fn escaped(self, ray: &Ray, steps: u32, at: &mut Arrival) {
        begin(at, ArrivalKind::Escaped, ray, f64::INFINITY, steps);
        if self.wants.has(Wants::EMISSION) {
            self.scratch.reset();
            let (le, pdf) = self.stage.escaped(ray.d, &self.path.palette, self.scratch);
            (at.le, at.le_pdf) = (le * self.flight, pdf);
        }
        at.sight.given = false;
    }

    /// The ray was scattered by a medium at `p`.
    pub(super) fn medium(
        self,
        (ray, t, steps): (&Ray, f64, u32),
        phase: &dyn Phase,
        at: &mut Arrival,
    ) {
        begin(at, ArrivalKind::Medium, ray, t, steps);
        let (p, wo) = (ray.at(t), -ray.d);
        at.p = p;
        self.path.on = None;
        self.path.from = p;
        self.scratch.reset();
        let scratch: &Scratch = self.scratch;
        let numbers = Numbers::draw::<CHOICE>(&self.stage, self.wants, self.samples);
        if self.wants.has(Wants::DIRECT) {
            let found = self.sample_light(at, &numbers, scratch);
            self.path.light = found.map_or(0, |found| found.light);
            at.direct.set(found.map(|found| {
                let eval = phase.eval(wo.as_vec3(), found.ray.d.as_vec3());
                let f_le = eval.f * found.le_over_pdf * self.flight;
                Direct { ray: found.ray, f_le, pdf: found.pdf, f_pdf: eval.pdf }
            }));
        }
        if self.wants.has(Wants::SCATTER) {
            let sample = phase.sample(wo.as_vec3(), numbers.scatter);
            at.scatter.set(sample.map(|sample| Scatter {
                weight: sample.weight * self.flight,
                wi: sample.wi.as_dvec3().normalize(),
                pdf: density(&sample),
                eta: 1.0,
            }));
        }
        if self.wants.has(Wants::SIGHT) {
            let u = self.samples.next_1d();
            let seen = self.stage.eye.as_ref().and_then(|eye| eye.sees(self.stage, p, u));
            at.sight.set(seen.and_then(|seen| {
                let f = phase.eval(seen.d.as_vec3(), wo.as_vec3()).f * self.flight;
                sight(self.stage, at, &seen, f)
            }));
        }
    }

    /// The ray met a surface, and paths need not know what they are in.
    #[inline(always)]
    pub(super) fn surface(self, ray: &Ray, hit: &SceneHit, steps: u32, at: &mut Arrival) {
        let numbers = Numbers::draw::<CHOICE>(&self.stage, self.wants, self.samples);
        let surface = self.stage.surface(ray, hit);
        self.meets((ray, hit, steps), &surface, &numbers, at);
    }

    /// The ray met a surface beyond which it would be in something else.
    pub(super) fn boundary(
        self,
        (ray, hit, steps): (&Ray, &SceneHit, u32),
        crossing: &Crossing,
        at: &mut Arrival,
    ) {
        self.path.beyond = crossing.beyond;
        let numbers = Numbers::draw::<CHOICE>(&self.stage, self.wants, self.samples);
        self.meets((ray, hit, steps), &crossing.surface, &numbers, at);
    }

    #[inline(always)]
    fn meets(
        mut self,
        (ray, hit, steps): (&Ray, &SceneHit, u32),
        surface: &Surface,
        numbers: &Numbers,
        at: &mut Arrival,
    ) {
        let stage = self.stage;
        let placement = &stage.placements[hit.placement as usize];
        let wo = -ray.d;
        begin(at, ArrivalKind::Surface, ray, hit.hit.t, steps);
        (at.p, at.p_err) = (surface.p, surface.p_err);
        (at.ng, at.ns) = (surface.ng, surface.ns);
        at.uv = surface.uv.as_vec2();
        if self.wants.has(Wants::EMISSION) && placement.light.is_some() {
            self.scratch.reset();
            let from = self.path.from;
            let palette = &self.path.palette;
            let place = (placement, hit.hit.face);
            let (le, pdf) =
                stage.surface_emission(place, surface, (from, wo), palette, self.scratch);
            (at.le, at.le_pdf) = (le * self.flight, pdf);
        }
        if self.wants.has(Wants::CURVATURE) {
            at.curvature = narrow(stage.mean_curvature(ray, hit, surface));
        }
        let outside = wo.dot(surface.ng) > 0.0;
        let mut leaving = Leaving::from(hit);
        if surface.ns != surface.ng {
            // A ray that dips below the facet may have to meet it again.
            leaving.face = Leaving::NO_FACE;
            if (wo.dot(surface.ns) > 0.0) == outside {
                at.lift = stage.lift(hit, outside);
            }
        }
        self.path.from = surface.p + at.lift;
        self.path.on = Some(Standing { leaving, p: surface.p, ng: surface.ng, outside });
        if let Skin::Material(material) = placement.skin {
            at.material = material;
            self.scatter(at, surface, hit, numbers);
        } else {
            at.sight.given = false;
        }
    }

    /// The light sample and the scattering sample at a surface.
    #[inline(always)]
    fn scatter(&mut self, at: &mut Arrival, surface: &Surface, hit: &SceneHit, numbers: &Numbers) {
        if self.wants.0 & SHADED.0 == 0 {
            return;
        }
        let takes_colors = self.stage.materials[at.material as usize].takes_colors();
        if takes_colors || (NESTED && self.stage.features.nested()) {
            self.scatter_apart(at, surface, hit, numbers);
        } else {
            self.scatter_with(at, surface, numbers, (None, None));
        }
    }

    /// The same where the material asks for more than its place. Apart: what is found in between
    /// would cost every other surface its registers.
    #[inline(never)]
    fn scatter_apart(
        &mut self,
        at: &mut Arrival,
        surface: &Surface,
        hit: &SceneHit,
        numbers: &Numbers,
    ) {
        let color = self.stage.color(hit);
        let site = Site { p: at.p, uv: at.uv, palette: &self.path.palette, color };
        let around = (NESTED && self.stage.features.nested()).then(|| {
            let sides = (&self.path.media, &self.path.beyond);
            self.stage.index_around(sides, hit.placement, &site, self.scratch)
        });
        self.scatter_with(at, surface, numbers, (color, around));
    }

    /// The same, with the surface's own colour and the index of refraction of what lies around it.
    #[inline(always)]
    fn scatter_with(
        &mut self,
        at: &mut Arrival,
        surface: &Surface,
        numbers: &Numbers,
        (color, around): (Option<Vec3>, Option<Spectrum>),
    ) {
        let site = Site { p: at.p, uv: at.uv, palette: &self.path.palette, color };
        self.scratch.reset();
        let scratch: &Scratch = self.scratch;
        let object = &self.stage.materials[at.material as usize];
        let (material, needs) = match around {
            None => {
                let material = object.resolve(&site, scratch).material();
                (material, object.needs().unwrap_or_else(|| material.needs()))
            }
            Some(index) => {
                let material = object.resolve_within(&site, scratch, index).material();
                (material, material.needs())
            }
        };
        let local = Local::new(at.wo, at, surface, needs);
        if self.wants.has(Wants::DIRECT) && needs.has(Needs::LIGHT) {
            let found = self.sample_light(at, numbers, scratch);
            self.path.light = found.map_or(0, |found| found.light);
            at.direct.set(self.lit(found, &local, material));
        }
        if self.wants.has(Wants::SIGHT) {
            let u = self.samples.next_1d();
            let eye = self.stage.eye.as_ref().filter(|_| needs.has(Needs::LIGHT));
            let seen = eye.and_then(|eye| eye.sees(self.stage, at.p, u));
            let sight = seen.and_then(|seen| {
                let local = Local::new(seen.d, at, surface, needs);
                let f = seen_from(seen.d, &local, material, at)? * self.flight;
                sight(self.stage, at, &seen, f)
            });
            at.sight.set(sight);
        }
        if self.wants.has(Wants::SCATTER) {
            // The pair is copied as such: read again at once in another size, it would be waited for.
            let mut u = [0.0; 3];
            u[..2].copy_from_slice(&numbers.scatter);
            u[2] = self.samples.next_1d_if(needs.has(Needs::CHOICE));
            let sample = material.sample(local.wo, u);
            at.scatter.set(sample.and_then(|sample| self.scattered(&local, &sample)));
        }
    }

    #[inline(always)]
    fn sample_light(
        &self,
        at: &Arrival,
        numbers: &Numbers,
        scratch: &Scratch,
    ) -> Option<FoundLight> {
        self.stage.sample_light::<CHOICE>(at, &self.path.palette, numbers.light, scratch)
    }

    /// What a light sends on along the path.
    #[inline(always)]
    fn lit(
        &self,
        found: Option<FoundLight>,
        local: &Local,
        material: &dyn Material,
    ) -> Option<Direct> {
        let found = found?;
        let wi = local.of_world(found.ray.d)?;
        let eval = material.eval(local.wo, wi);
        let f_le = eval.f * found.le_over_pdf * self.flight;
        let (ray, pdf, f_pdf) = (found.ray, found.pdf, eval.pdf);
        (!f_le.is_black()).then_some(Direct { ray, f_le, pdf, f_pdf })
    }

    #[inline(always)]
    fn scattered(&mut self, local: &Local, sample: &Sample) -> Option<Scatter> {
        let wi = local.to_world(sample.wi)?;
        let mut weight = sample.weight * self.flight;
        if sample.lobe.has(Lobe::DISPERSIVE) && self.stage.mode.is_spectral() {
            weight *= self.path.end_secondary();
        }
        let usable = !weight.is_black();
        usable.then_some(Scatter { weight, wi, pdf: density(sample), eta: sample.eta })
    }
}

/// What a material is asked for.
const SHADED: Wants = Wants::DIRECT.with(Wants::SCATTER).with(Wants::SIGHT);

/// What the camera gets of a place from which `f` is sent towards it.
pub(super) fn sight(stage: Moment<'_>, at: &Arrival, seen: &Seen, f: Spectrum) -> Option<Sight> {
    let f_we = f * narrow(seen.per_area);
    if f_we.is_black() || !f_we.is_finite() {
        return None;
    }
    let o = at.origin(seen.d);
    let (d, t_max) = unit_and_length(stage.eye?.at(stage) - o);
    Some(Sight { ray: Ray { o, d, t_max }, pixel: seen.pixel, f_we })
}

/// What a material sends along `d` to the camera, whose frame this is, of the light that comes from `wo`: seen
/// as paths from the camera see it, whose formula is the same for bent normals and for refraction.
fn seen_from(d: DVec3, local: &Local, material: &dyn Material, at: &Arrival) -> Option<Spectrum> {
    let wi = local.of_world(at.wo)?;
    // Light arrives as power through the surface, which the cosine to the geometry belongs to.
    let cosines = (d.dot(at.ng) / at.wo.dot(at.ng)).abs();
    Some(material.eval(local.wo, wi).f * narrow(cosines))
}

/// Everything that an arrival holds, as it is before it is shaded.
#[inline(always)]
fn begin(at: &mut Arrival, kind: ArrivalKind, ray: &Ray, t: f64, steps: u32) {
    (at.kind, at.t, at.wo, at.steps) = (kind, t, -ray.d, steps);
    (at.p, at.p_err) = (DVec3::ZERO, DVec3::ZERO);
    (at.ng, at.ns, at.uv) = (DVec3::ZERO, DVec3::ZERO, glam::Vec2::ZERO);
    at.lift = DVec3::ZERO;
    (at.le, at.le_pdf, at.material) = (Spectrum::ZERO, 0.0, u32::MAX);
    at.glow = Spectrum::ZERO;
    (at.direct.given, at.scatter.given) = (false, false);
}

/// The random numbers of one arrival. They are drawn before anything else is done there: each takes
/// a long chain of multiplications, during which the processor finds the surface.
struct Numbers {
    /// To choose a light by, and light from it.
    light: [f32; 3],
    /// To choose a direction by.
    scatter: [f32; 2],
}

impl Numbers {
    #[inline(always)]
    fn draw<const CHOICE: bool>(stage: &Stage, wants: Wants, samples: &mut Samples<'_>) -> Self {
        let has_choice = CHOICE && stage.features.light_choice();
        if wants.has(Wants::DIRECT) && wants.has(Wants::SCATTER) {
            let (choice, [[u, v], scatter]) = if has_choice {
                samples.next_1d_and_2d_pair()
            } else {
                (samples.next_1d_if(false), samples.next_2d_pair())
            };
            return Self { light: [choice, u, v], scatter };
        }
        let mut numbers = Self { light: [0.0; 3], scatter: [0.0; 2] };
        if wants.has(Wants::DIRECT) {
            let choice = samples.next_1d_if(has_choice);
            let [u, v] = samples.next_2d();
            numbers.light = [choice, u, v];
        } else if wants.has(Wants::SCATTER) {
            numbers.scatter = samples.next_2d();
        }
        numbers
    }
}

/// Density for comparing with light sampling, which cannot find a delta lobe.
fn density(sample: &Sample) -> f32 {
    if sample.lobe.has(Lobe::DELTA) { f32::INFINITY } else { sample.pdf }
}

/// The frame that a material sees.
struct Local {
    frame: Frame,
    wo: Vec3,
    ng: DVec3,
    /// Whether `wo` is on the outside of the geometry.
    outside: bool,
    /// Whether the shading normal is another than the geometric one.
    smooth: bool,
}

impl Local {
    #[inline(always)]
    fn new(wo: DVec3, at: &Arrival, surface: &Surface, needs: Needs) -> Self {
        let outside = wo.dot(at.ng) > 0.0;
        // Where the viewer is above one normal and below the other, the shading normal shows a side
        // that the surface does not have: the geometric one counts.
        let agree = (wo.dot(at.ns) > 0.0) == outside;
        let (normal, smooth) = if agree { (at.ns, at.ns != at.ng) } else { (at.ng, false) };
        let frame = if needs.has(Needs::TANGENT) {
            // Of any length, but in the range of single precision.
            let tangent = (surface.dp_du / surface.dp_du.abs().max_element()).as_vec3();
            Frame::from_z_and_tangent(normal.as_vec3(), tangent)
        } else {
            Frame::from_z(normal.as_vec3())
        };
        Self { wo: frame.to_local(wo.as_vec3()), frame, ng: at.ng, outside, smooth }
    }

    /// A direction of the world; `None` where the normals disagree on its side, so that no light
    /// leaks through a surface.
    #[inline(always)]
    fn of_world(&self, wi: DVec3) -> Option<Vec3> {
        let local = self.frame.to_local(wi.as_vec3());
        self.sides_agree(wi, local).then_some(local)
    }

    #[inline(always)]
    fn to_world(&self, local: Vec3) -> Option<DVec3> {
        let wi = unit_again(self.frame.to_world(local).as_dvec3());
        (!wi.is_nan() && self.sides_agree(wi, local)).then_some(wi)
    }

    /// What is reflected off a facet that stands for a smooth surface may dip below the facet.
    #[inline(always)]
    fn sides_agree(&self, wi: DVec3, local: Vec3) -> bool {
        let same_side = (wi.dot(self.ng) > 0.0) == self.outside;
        let same_local = local.z * self.wo.z > 0.0;
        same_side == same_local || (self.smooth && same_local)
    }
}
