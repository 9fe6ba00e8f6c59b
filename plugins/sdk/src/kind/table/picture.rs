#![expect(clippy::cast_ptr_alignment, reason = "addresses that this file made, given back")]

use std::marker::PhantomData;
use std::panic::resume_unwind;

use super::{Lanes, RoundRef, table};
use crate::color::Spectrum;
use crate::kind::{
    Arrival, Ask, Erased, Integrator, Job, Lane, Output, PathIntegrator, PictureJob, Raster,
    Requests, Round, Wants,
};
use crate::num::Ray;
use crate::wire::Slice;
use crate::wire::expect;
use crate::wire::{Answer, ByteSink, Status, TellPanic, tell_last_panic};

table! {
    /// Paths that a picture is made of: what happens when one begins and when it arrives.
    PathIntegrator => PathsTable "luxel_paths_table" {
        /// What the host prepares at each arrival, as the integrator's `wants`.
        fn wants(paths) -> Wants { Some(paths.wants()) }
        /// Bytes of what a path remembers.
        fn state_bytes(_paths) -> u64 {
            const { assert!(align_of::<T::State>() <= 16, "states are aligned to 16 bytes") };
            Some(size_of::<T::State>() as u64)
        }
        /// A path begins: writes its state and asks; says 0.
        fn start(paths, state: *mut u8, job: &Job, ask: &mut Ask<'_>) -> u32 {
            let begun = paths.start(job, ask);
            // SAFETY: the host lends the bytes of one state.
            unsafe { state.cast::<T::State>().write(begun) };
            Some(0)
        }
        /// The paths in some lanes arrived; says 0.
        fn arrive_n(
            paths, lanes: &mut Lanes, round: &RoundRef<'_>, requests: &mut Requests
        ) -> u32 {
            // SAFETY: the host lends lanes and states of these paths.
            unsafe { lanes.arrive_n(paths, round, requests) };
            Some(0)
        }
    }
}

/// Paths that a picture is made of, lent to the host.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct PathsRef<'a> {
    pub(crate) table: &'a PathsTable,
    pub(crate) at: *const u8,
    /// Tells what a panic in them said; may be null.
    pub(crate) last_panic: Option<TellPanic>,
    lent: PhantomData<&'a ()>,
}

// SAFETY: path integrators are `Send + Sync`, and the handle borrows one.
unsafe impl Send for PathsRef<'_> {}
// SAFETY: as above.
unsafe impl Sync for PathsRef<'_> {}

/// What a path may remember, at most.
const MOST_STATE: u64 = 1 << 16;

impl<'a> PathsRef<'a> {
    /// Lends paths.
    pub const fn new<P: PathIntegrator>(paths: &'a P) -> Self {
        Self {
            table: PathsTable::of::<P>(),
            at: std::ptr::from_ref(paths).cast(),
            last_panic: Some(tell_last_panic),
            lent: PhantomData,
        }
    }

    /// What a call answered. A panic in the paths ends the host's call, which may be on another
    /// thread than the integrator's, with what it said.
    fn found<T>(&self, answer: Answer<T>) -> Option<T> {
        match answer {
            Ok(found) => found,
            Err(status) => self.failed(status),
        }
    }

    #[cold]
    fn failed(&self, status: Status) -> ! {
        unsafe extern "C" fn take(owner: *mut u8, bytes: Slice<u8>) {
            // SAFETY: the sink's own owner.
            let said = unsafe { &mut *owner.cast::<String>() };
            // SAFETY: the library lends the bytes to this call.
            *said = String::from_utf8_lossy(unsafe { bytes.get() }).into_owned();
        }
        let mut said = crate::wire::last_panic();
        if let (Some(tell), true) = (self.last_panic, said.is_empty()) {
            let mut sink = ByteSink { take, owner: (&raw mut said).cast() };
            // SAFETY: the library's own function; the sink lives.
            unsafe { tell(&mut sink) };
        }
        if said.is_empty() {
            said = format!("its paths answered with the status {}", status.0);
        }
        wrong(said)
    }
}

/// Ends the render: paths did what none may do.
#[cold]
fn wrong(said: String) -> ! {
    resume_unwind(Box::new(said))
}

impl Integrator for PathsRef<'_> {
    fn wants(&self) -> Wants {
        // SAFETY: the handle lends what the table was made for.
        self.found(unsafe { self.table.wants(self.at) }).unwrap_or(Wants::POSITION)
    }

    fn output(&self) -> Output {
        Output::Value
    }

    fn lanes<'a>(&'a self, n: usize) -> Box<dyn Erased + 'a> {
        // SAFETY: as above.
        let bytes = self.found(unsafe { self.table.state_bytes(self.at) }).unwrap_or(0);
        if bytes > MOST_STATE {
            wrong(format!("wants to remember more than {MOST_STATE} bytes of a path"));
        }
        let stride = usize::try_from(bytes).unwrap_or(0);
        let states = vec![0u128; (stride * n).div_ceil(size_of::<u128>())];
        Box::new(PathStates { paths: self, states, stride })
    }
}

/// The states of paths, as bytes.
struct PathStates<'a> {
    paths: &'a PathsRef<'a>,
    states: Vec<u128>,
    stride: usize,
}

impl PathStates<'_> {
    fn states(&mut self) -> *mut u8 {
        self.states.as_mut_ptr().cast()
    }
}

impl Erased for PathStates<'_> {
    fn start(&mut self, lane: u32, job: &Job, l: &mut Spectrum, requests: &mut Requests) {
        let state = self.states().wrapping_add(lane as usize * self.stride);
        let paths = self.paths;
        let mut no_glow = Spectrum::ZERO;
        let mut ask = Ask::new(lane, (l, &mut no_glow), requests);
        // SAFETY: the handle lends what the table was made for; the state is one of its own.
        paths.found(unsafe { paths.table.start(paths.at, state, job, &mut ask) });
    }

    fn arrive_n(
        &mut self,
        lanes: &mut [Lane],
        arrived: &[u32],
        round: Round<'_>,
        requests: &mut Requests,
    ) {
        let mut lent = Lanes {
            lanes: lanes.as_mut_ptr(),
            n_lanes: lanes.len(),
            states: self.states(),
            arrived: Slice::new(arrived),
        };
        let (paths, round) = (self.paths, RoundRef::new(&round));
        // SAFETY: as above, with as many states as lanes. The host judges what was asked.
        paths.found(unsafe { paths.table.arrive_n(paths.at, &mut lent, &round, requests) });
    }
}

table! {
    /// What the host does for an integrator that owns the picture. All say 0 that have nothing to
    /// tell.
    PictureJob => PictureJobTable "luxel_picture_job_table" {
        /// The picture's size.
        fn raster(job) -> Raster { Some(job.raster()) }
        /// Passes that were asked for: each gives every pixel one sample.
        fn samples(job) -> u32 { Some(job.samples()) }
        /// The seed.
        fn seed(job) -> u32 { Some(job.seed()) }
        /// Whether an end was asked for: 1 or 0.
        fn is_cancelled(job) -> u32 { Some(u32::from(job.is_cancelled())) }
        /// Where rays arrive: positions alone. Room for as many results as there are rays.
        fn trace_n(job, rays: &Slice<Ray>, arrivals: *mut Arrival) -> u32 {
            // SAFETY: the caller lends the rays to this call.
            let rays = unsafe { rays.get() };
            // SAFETY: the caller lends as many results, which it has initialised.
            job.trace_n(rays, unsafe { room(arrivals, rays.len()) });
            Some(0)
        }
        /// Whether something lies along rays. Room for as many results as there are rays.
        fn occluded_n(job, rays: &Slice<Ray>, occluded: *mut bool) -> u32 {
            // SAFETY: the caller lends the rays to this call.
            let rays = unsafe { rays.get() };
            // SAFETY: the caller lends as many results, which it has initialised.
            job.occluded_n(rays, unsafe { room(occluded, rays.len()) });
            Some(0)
        }
        /// Follows one path from the camera through every pixel; what it adds is added to this pass.
        fn run_camera_paths(job, paths: &PathsRef<'_>) -> u32 {
            job.run_camera_paths(*paths);
            Some(0)
        }
        /// Follows paths from the lights; what they splat, divided by their number, is added to this
        /// pass.
        fn run_light_paths(job, n: u32, paths: &PathsRef<'_>) -> u32 {
            job.run_light_paths(n, *paths);
            Some(0)
        }
        /// Ends the pass: its light becomes one sample of every pixel.
        fn finish_pass(job) -> u32 {
            job.finish_pass();
            Some(0)
        }
    }
}

/// Room for results; none where there is no address.
///
/// # Safety
/// The caller lends `n` initialised values for `'a`.
unsafe fn room<'a, T>(items: *mut T, n: usize) -> &'a mut [T] {
    if items.is_null() || n == 0 {
        return &mut [];
    }
    // SAFETY: the caller says so.
    unsafe { std::slice::from_raw_parts_mut(items, n) }
}

/// What the host does for an integrator that owns the picture, lent through the boundary.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct PictureJobRef<'a> {
    pub(crate) table: &'a PictureJobTable,
    pub(crate) at: *const u8,
    lent: PhantomData<&'a ()>,
}

impl<'a> PictureJobRef<'a> {
    /// Lends a job.
    pub const fn new<J: PictureJob>(job: &'a J) -> Self {
        let at = std::ptr::from_ref(job).cast();
        Self { table: PictureJobTable::of::<J>(), at, lent: PhantomData }
    }
}

impl PictureJob for PictureJobRef<'_> {
    fn raster(&self) -> Raster {
        // SAFETY: the handle lends what the table was made for; so it is below.
        let raster = expect(unsafe { self.table.raster(self.at) });
        raster.unwrap_or(Raster { size: glam::UVec2::ZERO })
    }

    fn samples(&self) -> u32 {
        // SAFETY: as above.
        expect(unsafe { self.table.samples(self.at) }).unwrap_or(0)
    }

    fn seed(&self) -> u32 {
        // SAFETY: as above.
        expect(unsafe { self.table.seed(self.at) }).unwrap_or(0)
    }

    fn is_cancelled(&self) -> bool {
        // SAFETY: as above.
        expect(unsafe { self.table.is_cancelled(self.at) }) != Some(0)
    }

    fn trace_n(&self, rays: &[Ray], out: &mut [Arrival]) {
        let n = rays.len().min(out.len());
        // SAFETY: as above, with as many results as rays.
        expect(unsafe { self.table.trace_n(self.at, &Slice::new(&rays[..n]), out.as_mut_ptr()) });
    }

    fn occluded_n(&self, rays: &[Ray], out: &mut [bool]) {
        let n = rays.len().min(out.len());
        let rays = Slice::new(&rays[..n]);
        // SAFETY: as above, with as many results as rays.
        expect(unsafe { self.table.occluded_n(self.at, &rays, out.as_mut_ptr()) });
    }

    fn run_camera_paths(&self, paths: PathsRef<'_>) {
        // SAFETY: as above.
        expect(unsafe { self.table.run_camera_paths(self.at, &paths) });
    }

    fn run_light_paths(&self, n: u32, paths: PathsRef<'_>) {
        // SAFETY: as above.
        expect(unsafe { self.table.run_light_paths(self.at, n, &paths) });
    }

    fn finish_pass(&self) {
        // SAFETY: as above.
        expect(unsafe { self.table.finish_pass(self.at) });
    }
}
