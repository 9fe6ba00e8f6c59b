use luxel_sdk::abi::{IntegratorTable, Lanes, PictureJobRef, RoundRef, Slice};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Ask, Erased, Integrator, Job, Lane, Output, PictureIntegrator, PictureJob, Requests, Round,
    Wants,
};

use super::Head;
use super::conduct::Conduct;
use super::texture::output;

/// A library's integrator.
#[repr(transparent)]
pub(super) struct RemoteIntegrator(Head);

// SAFETY: the SDK demands of integrators that they are `Send + Sync`.
unsafe impl Send for RemoteIntegrator {}
// SAFETY: as above.
unsafe impl Sync for RemoteIntegrator {}

impl RemoteIntegrator {
    fn table(&self) -> &'static IntegratorTable {
        // SAFETY: the view was made for integrators.
        unsafe { self.0.table() }
    }
}

/// What a path may remember, at most.
const MOST_STATE: u64 = 1 << 16;

impl Integrator for RemoteIntegrator {
    fn wants(&self) -> Wants {
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        self.0.found(unsafe { self.table().wants(self.0.at()) }).unwrap_or(Wants::POSITION)
    }

    fn output(&self) -> Output {
        // SAFETY: as above.
        output(&self.0, self.0.found(unsafe { self.table().output(self.0.at()) }))
    }

    fn lanes<'a>(&'a self, n: usize) -> Box<dyn Erased + 'a> {
        // SAFETY: as above.
        let bytes = self.0.found(unsafe { self.table().state_bytes(self.0.at()) }).unwrap_or(0);
        if bytes > MOST_STATE {
            self.0.wrong("wants to remember more than 65536 bytes of a path");
        }
        let stride = usize::try_from(bytes.min(MOST_STATE)).unwrap_or(0);
        let states = vec![0u128; (stride * n).div_ceil(size_of::<u128>())];
        let (table, conduct) = (self.table(), Conduct::of_pixels(n));
        Box::new(RemoteStates { head: &self.0, table, states, stride, conduct })
    }

    fn as_picture(&self) -> Option<&dyn PictureIntegrator> {
        // SAFETY: as above.
        let is_picture = self.0.found(unsafe { self.table().is_picture(self.0.at()) });
        if is_picture == Some(1) { Some(self) } else { None }
    }
}

impl PictureIntegrator for RemoteIntegrator {
    fn wants(&self) -> Wants {
        Integrator::wants(self)
    }

    fn output(&self) -> Output {
        Integrator::output(self)
    }

    fn has_independent_passes(&self) -> bool {
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let answer = unsafe { self.table().has_independent_passes(self.0.at()) };
        self.0.found(answer) == Some(1)
    }

    fn render(&self, job: &dyn PictureJob) {
        if self.0.is_poisoned() {
            return;
        }
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let answer = unsafe { self.table().render(self.0.at(), &PictureJobRef::new(&job)) };
        if self.0.found(answer).is_none() && !self.0.is_poisoned() {
            self.0.wrong("owns the picture, but does not render it");
        }
    }
}

/// The states of paths, as bytes.
struct RemoteStates<'a> {
    head: &'a Head,
    table: &'static IntegratorTable,
    states: Vec<u128>,
    stride: usize,
    conduct: Conduct,
}

// SAFETY: the SDK demands of states that they are `Send`.
unsafe impl Send for RemoteStates<'_> {}

impl RemoteStates<'_> {
    fn states(&mut self) -> *mut u8 {
        self.states.as_mut_ptr().cast()
    }

    /// The render ends where paths misbehaved.
    fn judge(&self, told: Option<&'static str>) {
        if let Some(told) = told {
            self.head.wrong(told);
        }
    }
}

impl Erased for RemoteStates<'_> {
    fn start(&mut self, lane: u32, job: &Job, l: &mut Spectrum, requests: &mut Requests) {
        if self.head.is_poisoned() {
            return;
        }
        self.conduct.before_start(lane, requests);
        let state = self.states().wrapping_add(lane as usize * self.stride);
        let mut no_glow = Spectrum::ZERO;
        let mut ask = Ask::new(lane, (l, &mut no_glow), requests);
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let answer = unsafe { self.table.start(self.head.at(), state, job, &mut ask) };
        self.head.found(answer);
        let told = self.conduct.after_start(lane, requests);
        self.judge(told);
    }

    fn arrive_n(
        &mut self,
        lanes: &mut [Lane],
        arrived: &[u32],
        round: Round<'_>,
        requests: &mut Requests,
    ) {
        if self.head.is_poisoned() {
            return;
        }
        self.conduct.before_arrivals(lanes, arrived, requests);
        let mut lent = Lanes {
            lanes: lanes.as_mut_ptr(),
            n_lanes: lanes.len(),
            states: self.states(),
            arrived: Slice::new(arrived),
        };
        let round = RoundRef::new(&round);
        // SAFETY: as above.
        let answer = unsafe { self.table.arrive_n(self.head.at(), &mut lent, &round, requests) };
        self.head.found(answer);
        let told = self.conduct.after_arrivals(lanes, arrived, requests);
        self.judge(told);
    }
}
