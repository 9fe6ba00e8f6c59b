//! How paths of a library behave: they ask for themselves alone, and for what can be followed.

use luxel_sdk::kind::{Lane, Requests, SampleAt, Shadow};
use luxel_sdk::num::Ray;

use super::medium::{NOT_ITS_OWN, goes_on};

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

/// What was there before a call, and who may ask for more.
pub(crate) struct Conduct {
    lanes: Vec<Asked>,
    /// Where the random numbers of the paths that arrived stand.
    numbers: Vec<SampleAt>,
    /// Requests of others.
    before: [usize; 2],
    /// Whether they may leave light in any pixel.
    splats: bool,
}

impl Conduct {
    /// Of so many paths that a picture is made of: their light may go to any pixel.
    pub(crate) fn of_picture(n: usize) -> Self {
        Self { splats: true, ..Self::of_pixels(n) }
    }

    /// Of so many paths, each of a pixel.
    pub(super) fn of_pixels(n: usize) -> Self {
        let lanes = vec![Asked::Nothing; n];
        Self { lanes, numbers: vec![], before: [0; 2], splats: false }
    }

    /// A path is about to begin.
    pub(crate) fn before_start(&mut self, lane: u32, requests: &mut Requests) {
        self.note(requests);
        self.lanes[lane as usize] = Asked::Arrived;
    }

    /// Paths are about to be told that they arrived.
    pub(crate) fn before_arrivals(
        &mut self,
        lanes: &[Lane],
        arrived: &[u32],
        requests: &mut Requests,
    ) {
        self.note(requests);
        self.numbers.clear();
        for lane in arrived {
            self.lanes[*lane as usize] = Asked::Arrived;
            self.numbers.push(lanes[*lane as usize].numbers);
        }
    }

    fn note(&mut self, requests: &mut Requests) {
        self.before = [requests.rays.len(), requests.shadows.len()];
        requests.rays.limit();
        requests.shadows.limit();
    }

    /// What was wrong with a path that began; its requests are then forgotten, with all others.
    pub(crate) fn after_start(
        &mut self,
        lane: u32,
        requests: &mut Requests,
    ) -> Option<&'static str> {
        let told = self.judge(requests);
        self.lanes[lane as usize] = Asked::Nothing;
        told
    }

    /// What was wrong with the paths that arrived; their requests are then forgotten.
    pub(crate) fn after_arrivals(
        &mut self,
        lanes: &mut [Lane],
        arrived: &[u32],
        requests: &mut Requests,
    ) -> Option<&'static str> {
        let mut told = self.judge(requests);
        for (lane, before) in arrived.iter().zip(&self.numbers) {
            self.lanes[*lane as usize] = Asked::Nothing;
            let now = &mut lanes[*lane as usize].numbers;
            if !goes_on(*before, *now) {
                *now = *before;
                told = told.or(Some(NOT_ITS_OWN));
            }
        }
        told
    }

    fn judge(&mut self, requests: &mut Requests) -> Option<&'static str> {
        let told = self.fault(requests);
        if told.is_some() {
            requests.clear();
        }
        told
    }

    fn fault(&mut self, requests: &Requests) -> Option<&'static str> {
        if requests.rays.is_full() || requests.shadows.is_full() {
            return Some("asked for more than a million rays at once");
        }
        let [rays, shadows] = self.before;
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
            if !self.splats && shadow.pixel != Shadow::OWN {
                return Some("left light in another pixel than the path's own");
            }
        }
        None
    }
}
