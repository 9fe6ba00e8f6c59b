//! How much is measured, and how that is kept within a time.

use std::time::Duration;

use crate::progress;

/// Fewer random seeds than this tell nothing of what scatters.
pub(super) const LEAST_SEEDS: u32 = 4;
/// Samples of the reference for one of the largest number that is swept.
const REFERENCE: u32 = 64;
/// Share of a time that is for measuring; the rest is for the render that verifies.
const SHARE: f64 = 0.6;

/// What is measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Plan {
    /// Numbers of samples, rising.
    pub(super) spp: Vec<u32>,
    /// Rounds, each with random numbers of its own.
    pub(super) seeds: u32,
    /// What was left out, in words.
    pub(super) notes: Vec<String>,
}

impl Plan {
    /// Everything.
    pub(super) fn whole(spp: Vec<u32>, seeds: u32) -> Self {
        Self { spp, seeds, notes: vec![] }
    }

    /// Samples of the reference in each round.
    pub(super) fn reference(&self) -> u32 {
        self.most().saturating_mul(REFERENCE).div_ceil(self.seeds)
    }

    /// The largest number of samples.
    pub(super) fn most(&self) -> u32 {
        self.spp.last().copied().unwrap_or(1)
    }

    /// As much of it as fits a time, where one sample of each pixel takes `cost` seconds: fewer seeds,
    /// then fewer samples.
    pub(super) fn within(mut self, time: Duration, subjects: usize, cost: f64) -> Self {
        let (wanted, seconds) = (self.clone(), SHARE * time.as_secs_f64());
        let fits = |plan: &Self| plan.samples(subjects) * cost <= seconds;
        while !fits(&self) && (self.seeds > LEAST_SEEDS || self.spp.len() > 2) {
            if self.seeds > LEAST_SEEDS {
                self.seeds -= 1;
            } else {
                self.spp.pop();
                self.seeds = wanted.seeds;
            }
        }
        let time = progress::duration(time.as_secs_f64());
        if self != wanted {
            self.notes.push(format!(
                "{} seeds up to {} spp instead of {} up to {}, to stay within {time}",
                self.seeds,
                self.most(),
                wanted.seeds,
                wanted.most(),
            ));
        }
        if !fits(&self) {
            let needed = progress::duration(self.samples(subjects) * cost / SHARE);
            self.notes.push(format!("the least that tells anything takes {needed}, not {time}"));
        }
        self
    }

    /// Samples of one pixel, in all.
    fn samples(&self, subjects: usize) -> f64 {
        let each: f64 = self.spp.iter().map(|n| f64::from(*n)).sum();
        f64::from(self.seeds) * (subjects as f64 * each + f64::from(self.reference()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn within(seconds: u64) -> Plan {
        // 84 samples in each of 16 rounds for each of 10, and 64 times 64: 17536 in all.
        Plan::whole(vec![4, 16, 64], 16).within(Duration::from_secs(seconds), 10, 0.001)
    }

    #[test]
    fn a_short_time_costs_seeds_then_samples_and_what_it_costs_is_told() {
        assert_eq!(within(30), Plan::whole(vec![4, 16, 64], 16));
        let fewer = within(20);
        assert_eq!((fewer.seeds, fewer.most(), fewer.reference()), (9, 64, 456));
        assert_eq!(
            fewer.notes,
            ["9 seeds up to 64 spp instead of 16 up to 64, to stay within 20 s"]
        );
        let few = within(4);
        assert_eq!((few.seeds, few.most(), few.notes.len()), (6, 16, 1));
        let short = within(1);
        assert_eq!((short.seeds, short.most()), (LEAST_SEEDS, 16));
        assert_eq!(short.notes[1], "the least that tells anything takes 3.04 s, not 1.00 s");
    }
}
