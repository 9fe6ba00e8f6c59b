//! How much is measured, and how that is kept within a time.

use std::time::Duration;

use crate::progress;

/// Fewer random seeds than this tell nothing of what scatters.
pub(super) const LEAST_SEEDS: u32 = 4;
/// Seeds that a short time does not take away while anything else can be left out: so many tell a standard
/// error to a fifth (1 in √(2 · 15)), four to two fifths.
pub(super) const SEEDS: u32 = 16;
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
    /// Configurations, the first so many.
    pub(super) subjects: usize,
    /// What was left out, in words.
    pub(super) notes: Vec<String>,
}

impl Plan {
    /// Everything.
    pub(super) fn whole(spp: Vec<u32>, seeds: u32, subjects: usize) -> Self {
        Self { spp, seeds, subjects, notes: vec![] }
    }

    /// Samples of the reference in each round.
    pub(super) fn reference(&self) -> u32 {
        self.most().saturating_mul(REFERENCE).div_ceil(self.seeds)
    }

    /// The largest number of samples.
    pub(super) fn most(&self) -> u32 {
        self.spp.last().copied().unwrap_or(1)
    }

    /// As much of it as fits a time, where one sample of each pixel takes `cost` seconds: seeds beyond
    /// `SEEDS` go first, then samples, then the configurations that were named last, and seeds below
    /// `SEEDS` at the end. `names` are those of all configurations.
    pub(super) fn within(mut self, time: Duration, names: &[String], cost: f64) -> Self {
        let (wanted, seconds) = (self.clone(), SHARE * time.as_secs_f64());
        while self.samples() * cost > seconds && self.lessen(&wanted) {}
        let time = progress::duration(time.as_secs_f64());
        if (self.seeds, self.most()) != (wanted.seeds, wanted.most()) {
            self.notes.push(format!(
                "{} seeds up to {} spp instead of {} up to {}, to stay within {time}",
                self.seeds,
                self.most(),
                wanted.seeds,
                wanted.most(),
            ));
        }
        if let Some(left_out @ [_, ..]) = names.get(self.subjects..) {
            let left_out = left_out.join(", ");
            self.notes.push(format!("left out to stay within {time}: {left_out}"));
        }
        if self.samples() * cost > seconds {
            let needed = progress::duration(self.samples() * cost / SHARE);
            self.notes.push(format!("the least that tells anything takes {needed}, not {time}"));
        }
        self
    }

    /// Takes away what is missed least; returns whether there was anything.
    fn lessen(&mut self, wanted: &Self) -> bool {
        if self.seeds > SEEDS {
            self.seeds -= 1;
        } else if self.spp.len() > 2 {
            self.spp.pop();
            self.seeds = wanted.seeds;
        } else if self.subjects > 1 {
            self.subjects -= 1;
            self.seeds = wanted.seeds;
        } else if self.seeds > LEAST_SEEDS {
            self.seeds -= 1;
        } else {
            return false;
        }
        true
    }

    /// Samples of one pixel, in all.
    fn samples(&self) -> f64 {
        let each: f64 = self.spp.iter().map(|n| f64::from(*n)).sum();
        f64::from(self.seeds) * (self.subjects as f64 * each + f64::from(self.reference()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn within(milliseconds: u64) -> Plan {
        let names: Vec<String> = (0..10).map(|i| format!("depth={i}")).collect();
        // 84 samples in each of 20 rounds for each of 10, and 64 times 64: some 20900 in all.
        let whole = Plan::whole(vec![4, 16, 64], 20, names.len());
        whole.within(Duration::from_millis(milliseconds), &names, 0.001)
    }

    #[test]
    fn a_short_time_costs_what_is_missed_least_and_that_is_told() {
        assert_eq!(within(36_000), Plan::whole(vec![4, 16, 64], 20, 10));
        let fewer = within(30_000);
        assert_eq!((fewer.seeds, fewer.most(), fewer.reference()), (16, 64, 256));
        assert_eq!(
            fewer.notes,
            ["16 seeds up to 64 spp instead of 20 up to 64, to stay within 30 s"]
        );
        // Samples before seeds below sixteen: 20 in each of 20 rounds for each of 10, and 64 times 16.
        let few = within(10_000);
        assert_eq!((few.seeds, few.most(), few.subjects, few.notes.len()), (20, 16, 10, 1));
        // Then configurations.
        let some = within(5_000);
        assert_eq!((some.seeds, some.most(), some.subjects), (16, 16, 6));
        assert_eq!(
            some.notes[1],
            "left out to stay within 5.00 s: depth=6, depth=7, depth=8, depth=9"
        );
        let alone = within(2_000);
        assert_eq!((alone.seeds, alone.most(), alone.subjects), (8, 16, 1));
        let short = within(1_000);
        assert_eq!((short.seeds, short.most(), short.subjects), (LEAST_SEEDS, 16, 1));
        assert_eq!(short.notes[2], "the least that tells anything takes 1.84 s, not 1.00 s");
    }
}
