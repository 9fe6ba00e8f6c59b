use luxel_sdk::abi::{IntegratorTable, Lanes, RoundRef, Slice};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Ask, Erased, Integrator, Job, Lane, Output, Requests, Round, Wants};

use super::Head;
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
        Box::new(RemoteStates { head: &self.0, table: self.table(), states, stride })
    }
}

/// The states of paths, as bytes.
struct RemoteStates<'a> {
    head: &'a Head,
    table: &'static IntegratorTable,
    states: Vec<u128>,
    stride: usize,
}

// SAFETY: the SDK demands of states that they are `Send`.
unsafe impl Send for RemoteStates<'_> {}

impl RemoteStates<'_> {
    fn states(&mut self) -> *mut u8 {
        self.states.as_mut_ptr().cast()
    }
}

impl Erased for RemoteStates<'_> {
    fn start(&mut self, lane: u32, job: &Job, l: &mut Spectrum, requests: &mut Requests) {
        if self.head.is_poisoned() {
            return;
        }
        let state = self.states().wrapping_add(lane as usize * self.stride);
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let answer = unsafe {
            self.table.start(self.head.at(), state, job, &mut Ask::new(lane, l, requests))
        };
        self.head.found(answer);
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
        let n = lanes.len();
        let inside = |lane: u32| (lane as usize) < n;
        let mine = requests.rays.iter().all(|onward| inside(onward.lane))
            && requests.shadows.iter().all(|shadow| inside(shadow.lane));
        if !mine {
            self.head.wrong("asked for a path that does not exist");
            requests.clear();
        }
    }
}
