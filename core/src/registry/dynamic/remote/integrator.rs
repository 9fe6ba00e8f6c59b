use luxel_sdk::abi::{IntegratorTable, Lanes, RoundRef, Slice};
use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{
    Ask, Erased, Integrator, Job, Lane, Output, Requests, Round, SampleAt, Wants,
};
use luxel_sdk::num::Ray;

use super::Head;
use super::medium::{NOT_ITS_OWN, goes_on};
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
        let (table, lanes) = (self.table(), vec![Asked::Nothing; n]);
        Box::new(RemoteStates { head: &self.0, table, states, stride, lanes, numbers: vec![] })
    }
}

/// What a path may still ask for in this round.
#[derive(Clone, Copy, PartialEq)]
enum Asked {
    /// Nothing: it has not arrived.
    Nothing,
    /// To go on, once.
    Arrived,
    /// It has asked to go on.
    GoesOn,
}

/// The states of paths, as bytes.
struct RemoteStates<'a> {
    head: &'a Head,
    table: &'static IntegratorTable,
    states: Vec<u128>,
    stride: usize,
    lanes: Vec<Asked>,
    /// Where the random numbers of the paths that arrived stand.
    numbers: Vec<SampleAt>,
}

// SAFETY: the SDK demands of states that they are `Send`.
unsafe impl Send for RemoteStates<'_> {}

impl RemoteStates<'_> {
    fn states(&mut self) -> *mut u8 {
        self.states.as_mut_ptr().cast()
    }

    /// Whether what a call has added to the requests may be followed. Else the render ends, and
    /// nothing of it is.
    fn judge(&mut self, before: [usize; 2], requests: &mut Requests) {
        if let Some(told) = self.fault(before, requests) {
            self.head.wrong(told);
            requests.clear();
        }
    }

    fn fault(&mut self, [rays, shadows]: [usize; 2], requests: &Requests) -> Option<&'static str> {
        if requests.rays.is_full() || requests.shadows.is_full() {
            return Some("asked for more than a million rays at once");
        }
        let (Some(rays), Some(shadows)) =
            (requests.rays.get(rays..), requests.shadows.get(shadows..))
        else {
            return Some("took back what other paths asked for");
        };
        for onward in rays {
            let Ray { o, d, t_max } = onward.ray;
            match self.lanes.get_mut(onward.lane as usize) {
                Some(lane) if *lane == Asked::Arrived => *lane = Asked::GoesOn,
                Some(lane) if *lane == Asked::GoesOn => return Some("asked twice for one path"),
                _ => return Some("asked for a path that did not arrive"),
            }
            if !(o.is_finite() && d.is_normalized() && t_max > 0.0) {
                return Some("asked for a ray that is not finite or not of unit length");
            }
        }
        for shadow in shadows {
            if self.lanes.get(shadow.lane as usize).is_none_or(|lane| *lane == Asked::Nothing) {
                return Some("asked for a path that did not arrive");
            }
        }
        None
    }
}

impl Erased for RemoteStates<'_> {
    fn start(&mut self, lane: u32, job: &Job, l: &mut Spectrum, requests: &mut Requests) {
        if self.head.is_poisoned() {
            return;
        }
        let before = [requests.rays.len(), requests.shadows.len()];
        requests.rays.limit();
        requests.shadows.limit();
        self.lanes[lane as usize] = Asked::Arrived;
        let state = self.states().wrapping_add(lane as usize * self.stride);
        // SAFETY: the struct behind the head is of the class that the table belongs to.
        let answer = unsafe {
            self.table.start(self.head.at(), state, job, &mut Ask::new(lane, l, requests))
        };
        self.head.found(answer);
        self.judge(before, requests);
        self.lanes[lane as usize] = Asked::Nothing;
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
        let before = [requests.rays.len(), requests.shadows.len()];
        requests.rays.limit();
        requests.shadows.limit();
        self.numbers.clear();
        for lane in arrived {
            self.lanes[*lane as usize] = Asked::Arrived;
            self.numbers.push(lanes[*lane as usize].numbers);
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
        self.judge(before, requests);
        for (lane, before) in arrived.iter().zip(&self.numbers) {
            self.lanes[*lane as usize] = Asked::Nothing;
            let now = &mut lanes[*lane as usize].numbers;
            if !goes_on(*before, *now) {
                *now = *before;
                self.head.wrong(NOT_ITS_OWN);
            }
        }
    }
}
