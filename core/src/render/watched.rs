//! Paths that a picture is made of, watched: those of a library may ask for what cannot be followed.

use std::panic::resume_unwind;

use luxel_sdk::color::Spectrum;
use luxel_sdk::kind::{Erased, Integrator, Job, Lane, Output, PathsRef, Requests, Round, Wants};

use crate::registry::dynamic::Conduct;

/// Paths that are not taken on trust. What is wrong with them ends the integrator's call, as a panic
/// of theirs does.
pub(super) struct Watched<'a>(pub(super) PathsRef<'a>);

impl Integrator for Watched<'_> {
    fn wants(&self) -> Wants {
        self.0.wants()
    }

    fn output(&self) -> Output {
        self.0.output()
    }

    fn lanes<'a>(&'a self, n: usize) -> Box<dyn Erased + 'a> {
        Box::new(WatchedStates { states: self.0.lanes(n), conduct: Conduct::of_picture(n) })
    }
}

struct WatchedStates<'a> {
    states: Box<dyn Erased + 'a>,
    conduct: Conduct,
}

fn judge(told: Option<&'static str>) {
    if let Some(told) = told {
        resume_unwind(Box::new(told));
    }
}

impl Erased for WatchedStates<'_> {
    fn start(&mut self, lane: u32, job: &Job, l: &mut Spectrum, requests: &mut Requests) {
        self.conduct.before_start(lane, requests);
        self.states.start(lane, job, l, requests);
        judge(self.conduct.after_start(lane, requests));
    }

    fn arrive_n(
        &mut self,
        lanes: &mut [Lane],
        arrived: &[u32],
        round: Round<'_>,
        requests: &mut Requests,
    ) {
        self.conduct.before_arrivals(lanes, arrived, requests);
        self.states.arrive_n(lanes, arrived, round, requests);
        judge(self.conduct.after_arrivals(lanes, arrived, requests));
    }
}
