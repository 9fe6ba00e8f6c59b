use std::marker::PhantomData;

use glam::DVec3;

use super::{PictureJobRef, SamplerRef, table};
use crate::kind::{
    Ask, Host, Job, Lane, PathIntegrator, PictureIntegrator, Requests, Round, Wants, arrive_n,
};
use crate::num::Ray;
use crate::wire::Slice;
use crate::wire::expect;

/// A sphere around the scene.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct SceneSphere {
    /// World space, metres.
    pub centre: DVec3,
    /// Metres.
    pub radius: f64,
}

table! {
    /// What the host answers while a path arrives.
    Host => HostTable "luxel_host_table" {
        /// Whether something lies along a ray: 1 or 0.
        fn occluded(host, ray: &Ray) -> u32 { Some(u32::from(host.occluded(ray))) }
        /// A sphere around the scene.
        fn scene_sphere(host) -> SceneSphere {
            let (centre, radius) = host.scene_sphere();
            Some(SceneSphere { centre, radius })
        }
    }
}

/// The host, lent through the boundary.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct HostRef<'a> {
    pub(crate) table: &'a HostTable,
    pub(crate) at: *const u8,
    lent: PhantomData<&'a ()>,
}

impl<'a> HostRef<'a> {
    /// Lends a host.
    pub const fn new<H: Host>(host: &'a H) -> Self {
        let at = std::ptr::from_ref(host).cast();
        Self { table: HostTable::of::<H>(), at, lent: PhantomData }
    }
}

impl Host for HostRef<'_> {
    fn occluded(&self, ray: &Ray) -> bool {
        // SAFETY: the handle lends what the table was made for.
        expect(unsafe { self.table.occluded(self.at, ray) }) == Some(1)
    }

    fn scene_sphere(&self) -> (DVec3, f64) {
        // SAFETY: as above.
        let sphere = expect(unsafe { self.table.scene_sphere(self.at) });
        sphere.map_or((DVec3::ZERO, 1.0), |sphere| (sphere.centre, sphere.radius))
    }
}

/// What the host offers a round of arrivals, on its way through the boundary.
#[repr(C)]
pub struct RoundRef<'a> {
    /// Answers while paths arrive.
    pub host: HostRef<'a>,
    /// Where the lanes' random numbers come from.
    pub sampler: SamplerRef<'a>,
}

impl<'a> RoundRef<'a> {
    /// Lends a round.
    pub fn new(round: &'a Round<'a>) -> Self {
        Self { host: HostRef::new(&round.host), sampler: SamplerRef::new(&round.sampler) }
    }
}

/// Paths in flight, and which of them arrived.
#[repr(C)]
pub struct Lanes {
    /// All lanes; their states stand in the same order, `state_bytes` each.
    pub lanes: *mut Lane,
    /// How many lanes there are.
    pub n_lanes: usize,
    /// One state for each lane, zero until `start` has written it, aligned to 16 bytes.
    pub states: *mut u8,
    /// The lanes that arrived.
    pub arrived: Slice<u32>,
}

impl Lanes {
    /// The paths in some lanes arrived.
    ///
    /// # Safety
    /// The host lends lanes and as many states of this integrator, to this call alone.
    pub(super) unsafe fn arrive_n<I: PathIntegrator>(
        &mut self,
        integrator: &I,
        round: &RoundRef<'_>,
        requests: &mut Requests,
    ) {
        // SAFETY: the caller says so.
        let (states, lanes, arrived) = unsafe { self.split::<I::State>() };
        let round = Round { host: &round.host, sampler: &round.sampler };
        arrive_n(integrator, states, (lanes, arrived), round, requests);
    }

    /// # Safety
    /// The host lends lanes and as many states of type `S`, to this call alone.
    unsafe fn split<'a, S>(&mut self) -> (&'a mut [S], &'a mut [Lane], &'a [u32]) {
        // SAFETY: the caller says so.
        let states = unsafe { std::slice::from_raw_parts_mut(self.states.cast(), self.n_lanes) };
        // SAFETY: as above.
        let lanes = unsafe { std::slice::from_raw_parts_mut(self.lanes, self.n_lanes) };
        // SAFETY: as above.
        (states, lanes, unsafe { self.arrived.get() })
    }
}

table! {
    /// How light is followed: what happens when a path begins and when it arrives.
    PathIntegrator => IntegratorTable "luxel_integrator_table" {
        /// What the host prepares at each arrival, as flags: 1 emission, 2 a light sample, 4 a
        /// scattering sample, 8 where the camera sees it, 16 curvature. Of what owns the picture: for all its paths.
        fn wants(integrator) -> Wants { Some(integrator.wants()) }
        /// What the lanes of its light mean: 0 values as they are, 1 linear sRGB.
        fn output(integrator) -> u32 { Some(integrator.output() as u32) }
        /// Bytes of what a path remembers.
        fn state_bytes(_integrator) -> u64 {
            const { assert!(align_of::<T::State>() <= 16, "states are aligned to 16 bytes") };
            Some(size_of::<T::State>() as u64)
        }
        /// A path begins: writes its state and asks; says 0.
        fn start(integrator, state: *mut u8, job: &Job, ask: &mut Ask<'_>) -> u32 {
            let begun = integrator.start(job, ask);
            // SAFETY: the host lends the bytes of one state.
            unsafe { state.cast::<T::State>().write(begun) };
            Some(0)
        }
        /// The paths in some lanes arrived; says 0.
        fn arrive_n(
            integrator, lanes: &mut Lanes, round: &RoundRef<'_>, requests: &mut Requests
        ) -> u32 {
            // SAFETY: the host lends lanes and states of this class.
            unsafe { lanes.arrive_n(integrator, round, requests) };
            Some(0)
        }
        /// Whether it owns the whole picture: 1 or 0. Then `render` is called, and no path of its
        /// own begins. May be null: it does not.
        fn is_picture(integrator) -> u32 { Some(u32::from(integrator.as_picture().is_some())) }
        /// Makes the picture; says 0. Nothing where it does not own it; may be null then.
        fn render(integrator, job: &PictureJobRef<'_>) -> u32 {
            integrator.as_picture()?.render(job);
            Some(0)
        }
        /// 1 if it owns the picture and no pass of it depends on what earlier ones found or counted, nor on
        /// how many there are to be, so that the host may leave out those that a picture has; else 0. May
        /// be null: 0.
        fn has_independent_passes(integrator) -> u32 {
            let owner = integrator.as_picture();
            Some(u32::from(owner.is_some_and(PictureIntegrator::has_independent_passes)))
        }
    }
}
