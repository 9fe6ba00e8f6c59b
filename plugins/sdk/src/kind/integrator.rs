//! How light is followed: an integrator says what happens when a path arrives.
//!
//! The host keeps many paths in flight, traces their rays in batches, and shades every arrival
//! before it asks. An integrator is a small state machine over plain data (docs/plugins.md).

use glam::{DVec3, Vec2};

use super::flags::flag_set;
use super::{Output, PictureIntegrator, SampleAt, Sampler, Samples, Sight};
use crate::color::Spectrum;
use crate::num::{Ray, offset_origin};
use crate::params::{Fault, Maybe};
use crate::wire::Queue;

/// What the host prepares at every arrival: a set of flags.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(transparent)]
pub struct Wants(pub u32);

impl Wants {
    /// Where the path is, no more.
    pub const POSITION: Self = Self(0);
    /// Emission, and the density with which light sampling would have found it.
    pub const EMISSION: Self = Self(1);
    /// One light sample with the material's answer to it: of those lights that are looked for, which
    /// `LightForm::Everywhere` is in media alone. The others are met by chance, with a density of 0.
    pub const DIRECT: Self = Self(2);
    /// One scattering sample.
    pub const SCATTER: Self = Self(4);
    /// Where the camera would see the place: for paths that come from lights.
    pub const SIGHT: Self = Self(8);
    /// How much the surface bends.
    pub const CURVATURE: Self = Self(16);
}
flag_set!(Wants);

/// One path to be followed.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Job {
    /// The camera's ray, or one that leaves a light; world space, unit direction.
    pub ray: Ray,
    /// What it carries. From a light: `le·|cos| / pdf`, W; from the camera: 1.
    pub beta: Spectrum,
    /// Where the camera sees the place that the light leaves. With it the light that goes there is
    /// `f_we`, whatever `beta` is.
    pub sight: Maybe<Sight>,
}

impl Job {
    /// A path from the camera.
    pub fn of_camera(ray: Ray) -> Self {
        Self { ray, beta: Spectrum::ONE, sight: Maybe::default() }
    }
}

/// Where a path arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[repr(u32)]
pub enum ArrivalKind {
    /// It left the scene.
    #[default]
    Escaped,
    /// At a surface.
    Surface,
    /// In a medium.
    Medium,
}

/// One light sample, with the material's answer.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Direct {
    /// From the arrival to the light, offset at both ends.
    pub ray: Ray,
    /// `f·|cos_i|·le / pdf`: what arrives if nothing lies between.
    pub f_le: Spectrum,
    /// Solid-angle density of the light sample; infinite for a delta light.
    pub pdf: f32,
    /// Density with which scattering would have found it.
    pub f_pdf: f32,
}

impl Default for Direct {
    /// No light, along any ray.
    fn default() -> Self {
        let ray = Ray::new(DVec3::ZERO, DVec3::Z);
        Self { ray, f_le: Spectrum::ZERO, pdf: 0.0, f_pdf: 0.0 }
    }
}

/// One scattering sample, in world space.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Scatter {
    /// eval / pdf.
    pub weight: Spectrum,
    /// Unit direction.
    pub wi: DVec3,
    /// Solid-angle density; infinite for a delta lobe, which light sampling cannot find.
    pub pdf: f32,
    /// Relative index of refraction of a transmission, else 1.
    pub eta: f32,
}

/// A point that a path arrived at, shaded as far as the integrator wants.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub struct Arrival {
    /// Where it is.
    pub kind: ArrivalKind,
    /// World space.
    pub p: DVec3,
    /// Bound of the error of each coordinate of `p`.
    pub p_err: DVec3,
    /// Geometric normal, unit, to the outside of the shape; zero unless at a surface.
    pub ng: DVec3,
    /// Shading normal, unit; zero unless at a surface.
    pub ns: DVec3,
    /// From `p` to where the smooth surface would be that the normals of a mesh speak of: what is
    /// reflected leaves from there.
    pub lift: DVec3,
    /// Surface coordinates.
    pub uv: Vec2,
    /// Distance flown by the last ray, metres.
    pub t: f64,
    /// Towards where the path came from, unit.
    pub wo: DVec3,
    /// Index of the material among the stage's; `u32::MAX` without one.
    pub material: u32,
    /// Steps that tracing the last ray took: nodes and primitives.
    pub steps: u32,
    /// Emitted radiance towards `wo`.
    pub le: Spectrum,
    /// Density with which light sampling at the last point would have found it, sr⁻¹; 0 if it could not.
    pub le_pdf: f32,
    /// Radiance of the media that the last ray flew through, dimmed by them: see [`Ask::add_glow`].
    pub glow: Spectrum,
    /// A light sample, if one may contribute.
    pub direct: Maybe<Direct>,
    /// A scattering sample, if the path can go on.
    pub scatter: Maybe<Scatter>,
    /// Where the camera sees it, if it does.
    pub sight: Maybe<Sight>,
    /// Mean curvature of the smooth surface, m⁻¹, above 0 where it bulges to the side of `ns`; 0 where
    /// the shape does not know. Of no meaning unless it is wanted, and at a surface.
    pub curvature: f32,
}

impl Arrival {
    /// Where a ray that leaves along `wi` begins, beyond the error of the point. What leaves to the
    /// side of the shading normal that `wo` is on begins on that side of the surface even if `wi`
    /// dips below it: from the smooth surface if that lies above, else to meet this one again.
    ///
    /// # Source
    /// Hanika 2021, Hacking the Shadow Terminator (Ray Tracing Gems II, ch. 4).
    #[inline(always)]
    pub fn origin(&self, wi: DVec3) -> DVec3 {
        let side = self.wo.dot(self.ns);
        if wi.dot(self.ns) * side > 0.0 && side * self.wo.dot(self.ng) > 0.0 {
            offset_origin(self.p + self.lift, self.p_err, self.ng, self.wo)
        } else {
            offset_origin(self.p, self.p_err, self.ng, wi)
        }
    }

    /// A ray that leaves this point along the unit direction `wi`, its origin beyond the error of
    /// the point.
    #[inline(always)]
    pub fn ray(&self, wi: DVec3) -> Ray {
        self.ray_to(wi, f64::INFINITY)
    }

    /// The same, up to a distance in metres.
    #[inline(always)]
    pub fn ray_to(&self, wi: DVec3, distance: f64) -> Ray {
        Ray { o: self.origin(wi), d: wi, t_max: distance }
    }
}

/// What the host answers while a path arrives.
pub trait Host {
    /// Whether something lies along a ray. Media and surfaces without a material do not count.
    fn occluded(&self, ray: &Ray) -> bool;

    /// A sphere around the scene: centre and radius in metres.
    fn scene_sphere(&self) -> (DVec3, f64);
}

impl<H: Host + ?Sized> Host for &H {
    fn occluded(&self, ray: &Ray) -> bool {
        (**self).occluded(ray)
    }
    fn scene_sphere(&self) -> (DVec3, f64) {
        (**self).scene_sphere()
    }
}

/// A ray with the path that goes on along it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Onward {
    /// Where it goes on.
    pub ray: Ray,
    /// Whose.
    pub lane: u32,
}

/// A shadow ray with the light that it decides about.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Shadow {
    /// From the point to the light.
    pub ray: Ray,
    /// Whose.
    pub lane: u32,
    /// Which pixel gets it: `Shadow::OWN`, or any, by its place in the rows.
    pub pixel: u32,
    /// What arrives if nothing lies between.
    pub l: Spectrum,
}

impl Shadow {
    /// The pixel that the path came from.
    pub const OWN: u32 = u32::MAX;
}

/// The rays that a round of arrivals asked for, in asking order.
#[derive(Debug, Default)]
#[repr(C)]
pub struct Requests {
    /// Paths that go on.
    pub rays: Queue<Onward>,
    /// Light that depends on a shadow ray.
    pub shadows: Queue<Shadow>,
}

impl Requests {
    /// Forgets everything, keeps the memory.
    pub fn clear(&mut self) {
        self.rays.clear();
        self.shadows.clear();
    }
}

/// What an arrival leads to. Every call adds to the batch of the next round.
#[repr(C)]
pub struct Ask<'a> {
    pub(crate) lane: u32,
    pub(crate) l: &'a mut Spectrum,
    pub(crate) glow: &'a mut Spectrum,
    pub(crate) requests: &'a mut Requests,
}

impl<'a> Ask<'a> {
    /// For a path: its lane, its light so far, that of media, and where its requests go.
    pub fn new(
        lane: u32,
        (l, glow): (&'a mut Spectrum, &'a mut Spectrum),
        requests: &'a mut Requests,
    ) -> Self {
        Self { lane, l, glow, requests }
    }

    /// Light for the pixel.
    pub fn add(&mut self, l: Spectrum) {
        *self.l += l;
    }

    /// What the media sent that the path has just flown through, for the pixel: no lamp's, so that no
    /// group of lights counts it. `beta` is what radiance from here on counts for.
    pub fn add_glow(&mut self, beta: Spectrum, at: &Arrival) {
        if !at.glow.is_black() {
            *self.glow += beta * at.glow;
        }
    }

    /// Goes on: `arrive` is called where this ray ends. A path that does not ask is done. Once per
    /// arrival.
    pub fn trace(&mut self, ray: Ray) {
        self.requests.rays.push(Onward { ray, lane: self.lane });
    }

    /// Light for the pixel if nothing lies between, dimmed by the media along the ray. Any number
    /// per arrival.
    pub fn add_if_visible(&mut self, ray: Ray, l: Spectrum) {
        if !l.is_black() {
            self.requests.shadows.push(Shadow { ray, lane: self.lane, pixel: Shadow::OWN, l });
        }
    }

    /// Light for the pixel where the camera sees this place, if nothing lies between, dimmed by the
    /// media. Any number per arrival; for paths from lights, which have no pixel of their own.
    pub fn splat_if_visible(&mut self, sight: &Sight, l: Spectrum) {
        if !l.is_black() {
            let Sight { ray, pixel, .. } = *sight;
            self.requests.shadows.push(Shadow { ray, lane: self.lane, pixel, l });
        }
    }
}

/// An integrator that follows one path at a time, from its point of view.
pub trait PathIntegrator: Send + Sync {
    /// What a path remembers.
    type State: Copy + Default + Send;

    /// Computes the derived fields.
    fn prepare(&mut self) {}

    /// Rules between parameters.
    ///
    /// # Errors
    /// The parameter at fault.
    fn check(&self) -> Result<(), Fault> {
        Ok(())
    }

    /// What the host prepares at each arrival.
    fn wants(&self) -> Wants;

    /// What the lanes of the light that it adds mean. Pictures that are not of light (normals,
    /// depth) are RGB, whatever the colour mode.
    fn output(&self) -> Output {
        Output::Value
    }

    /// A path begins: usually asks for the camera's ray.
    fn start(&self, job: &Job, ask: &mut Ask<'_>) -> Self::State;

    /// A path arrived.
    fn arrive(
        &self,
        state: &mut Self::State,
        at: &Arrival,
        samples: &mut Samples<'_>,
        host: &dyn Host,
        ask: &mut Ask<'_>,
    );

    /// The same as what owns the whole picture: nothing, for what follows one path at a time.
    fn as_picture(&self) -> Option<&dyn PictureIntegrator> {
        None
    }
}

/// One path in flight, as host and integrator share it.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Lane {
    /// Where it arrived.
    pub at: Arrival,
    /// Light gathered so far, without that of media.
    pub l: Spectrum,
    /// Light of media gathered so far.
    pub glow: Spectrum,
    /// The next of its random numbers.
    pub numbers: SampleAt,
}

/// What the host offers a round of arrivals.
#[derive(Clone, Copy)]
pub struct Round<'a> {
    /// Answers while paths arrive.
    pub host: &'a dyn Host,
    /// Where the lanes' random numbers come from.
    pub sampler: &'a dyn Sampler,
}

/// The states of many paths, their type forgotten.
pub trait Erased: Send {
    /// A path begins in a lane.
    fn start(&mut self, lane: u32, job: &Job, l: &mut Spectrum, requests: &mut Requests);

    /// The paths in the lanes `arrived` did so.
    fn arrive_n(
        &mut self,
        lanes: &mut [Lane],
        arrived: &[u32],
        round: Round<'_>,
        requests: &mut Requests,
    );
}

/// An integrator, its path state forgotten. Every `PathIntegrator` is one.
///
/// Integrators come in two sizes: where `as_picture` gives one, it is asked to render, and no path
/// of its own is ever begun.
pub trait Integrator: Send + Sync {
    /// What the host prepares at each arrival.
    fn wants(&self) -> Wants;

    /// What the lanes of its light mean.
    fn output(&self) -> Output;

    /// Room for `n` paths.
    fn lanes<'a>(&'a self, n: usize) -> Box<dyn Erased + 'a>;

    /// The same as what owns the whole picture, if it does.
    fn as_picture(&self) -> Option<&dyn PictureIntegrator> {
        None
    }
}

struct States<'a, I: PathIntegrator> {
    integrator: &'a I,
    states: Vec<I::State>,
}

impl<I: PathIntegrator> Erased for States<'_, I> {
    fn start(&mut self, lane: u32, job: &Job, l: &mut Spectrum, requests: &mut Requests) {
        let mut no_glow = Spectrum::ZERO;
        let mut ask = Ask::new(lane, (l, &mut no_glow), requests);
        self.states[lane as usize] = self.integrator.start(job, &mut ask);
    }

    fn arrive_n(
        &mut self,
        lanes: &mut [Lane],
        arrived: &[u32],
        round: Round<'_>,
        requests: &mut Requests,
    ) {
        arrive_n(self.integrator, &mut self.states, (lanes, arrived), round, requests);
    }
}

/// The paths in the lanes `arrived` did so, one after the other.
pub(crate) fn arrive_n<I: PathIntegrator>(
    integrator: &I,
    states: &mut [I::State],
    (lanes, arrived): (&mut [Lane], &[u32]),
    round: Round<'_>,
    requests: &mut Requests,
) {
    for &lane in arrived {
        let path = &mut lanes[lane as usize];
        let mut ask = Ask::new(lane, (&mut path.l, &mut path.glow), requests);
        let state = &mut states[lane as usize];
        let mut samples = Samples::new(round.sampler, path.numbers);
        integrator.arrive(state, &path.at, &mut samples, round.host, &mut ask);
        path.numbers = samples.at();
    }
}

impl<I: PathIntegrator> Integrator for I {
    fn wants(&self) -> Wants {
        PathIntegrator::wants(self)
    }

    fn output(&self) -> Output {
        PathIntegrator::output(self)
    }

    fn lanes<'a>(&'a self, n: usize) -> Box<dyn Erased + 'a> {
        Box::new(States { integrator: self, states: vec![I::State::default(); n] })
    }

    fn as_picture(&self) -> Option<&dyn PictureIntegrator> {
        PathIntegrator::as_picture(self)
    }
}

/// Weight of a sample of density `a` that another technique finds with density `b`: the power
/// heuristic. `a` infinite means that the other technique cannot find it.
///
/// # Source
/// Veach 1997, §9.2.4; PBR4 §2.2.3.
pub fn mis(a: f32, b: f32) -> f32 {
    if a.is_infinite() {
        return 1.0;
    }
    let ratio = b / a;
    if a > 0.0 { 1.0 / (1.0 + ratio * ratio) } else { 0.0 }
}
