//! Pictures with fresh random numbers that show whether what is recommended reaches its error.
//!
//! They are added until the error is known well enough to say so; how well depends on what scatters, and a
//! caustic takes many more than an even light. Where the error is off, the samples are corrected by all that
//! was seen, and what was seen before still counts.

use super::choose::MOST;
use super::estimate::Number;
use super::fit::Fit;
use crate::exit::{Exit, Failure};

/// A verified error may be off its target by this share.
pub(super) const NEAR: f64 = 0.1;
/// Standard errors to either side within which the truth is taken to be.
pub(super) const WITHIN: f64 = 2.0;
/// An error is known well enough with a standard error of this share of its target: what is on target as far
/// as can be seen is off by `WITHIN` of them at most, and as many more fit into `NEAR`.
const KNOWN: f64 = NEAR / (2.0 * WITHIN);
/// Fewest pictures: how fewer scatter is not known, and the few that lack what is seldom look alike.
pub(super) const LEAST: usize = 16;
/// Most pictures, of all tries.
const MOST_PICTURES: usize = 128;
/// Pictures between two looks.
const STEP: usize = 8;
/// Numbers of samples that are tried.
const TRIES: usize = 4;
/// Numbers of samples that differ by this factor at most are taken together.
const ALIKE: f64 = 1.5;
/// Standard errors beyond which fit and pictures contradict each other.
const CONTRARY: f64 = 3.0;

/// What one picture showed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Witness {
    pub(super) samples: u32,
    /// Squared relative error, mean over the pixels.
    pub(super) squared: f64,
    pub(super) seconds: f64,
}

/// What pictures with fresh random numbers showed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Verified {
    /// Of each pixel, as recommended.
    pub(super) samples: u32,
    /// Fewest and most samples of the pictures.
    pub(super) seen_at: [u32; 2],
    pub(super) pictures: usize,
    /// Relative error, root mean square.
    pub(super) rmse: Number,
    /// Of one picture.
    pub(super) seconds: f64,
}

/// What can be said of a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Verdict {
    /// Within a tenth of it.
    Near,
    /// Below it.
    Better,
    /// More than a tenth above it.
    Missed,
    /// None of these for certain.
    Unsure,
}

impl Verified {
    /// How far off the target, as a share of it.
    pub(super) fn off(&self, target: f64) -> Number {
        Number { value: self.rmse.value / target - 1.0, error: self.rmse.error / target }
    }

    /// The ends of the interval that `off` is in.
    pub(super) fn bounds(&self, target: f64) -> [f64; 2] {
        let Number { value, error } = self.off(target);
        [value - WITHIN * error, value + WITHIN * error]
    }

    pub(super) fn verdict(&self, target: f64) -> Verdict {
        match self.bounds(target) {
            [low, high] if low >= -NEAR && high <= NEAR => Verdict::Near,
            [_, high] if high <= 0.0 => Verdict::Better,
            [low, _] if low > NEAR => Verdict::Missed,
            _ => Verdict::Unsure,
        }
    }

    /// Near, or better than was asked.
    pub(super) fn is_met(&self, target: f64) -> bool {
        matches!(self.verdict(target), Verdict::Near | Verdict::Better)
    }

    fn is_off(&self, target: f64) -> bool {
        let Number { value, error } = self.off(target);
        value.abs() > WITHIN * error
    }

    fn is_known(&self, target: f64) -> bool {
        self.pictures >= LEAST && self.off(target).error <= KNOWN
    }
}

/// What is known before the first picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Asked {
    pub(super) target: f64,
    /// How the variance falls; `None` where nothing scatters.
    pub(super) fit: Option<Fit>,
    /// The squared bias that no number of samples takes away.
    pub(super) bias2: f64,
    /// Standard error of what the reference adds to every squared error.
    pub(super) common: f64,
    /// Seconds for a sample of each pixel.
    pub(super) cost: f64,
    /// Seconds that are left, if time is short.
    pub(super) left: Option<f64>,
}

impl Asked {
    /// Shows what `samples` reach, or a number nearby that reaches the target better; nothing if there is no
    /// time for two pictures.
    ///
    /// # Errors
    /// What `shoot` says, less an interrupt after two pictures.
    pub(super) fn verify(
        &self,
        samples: u32,
        shoot: &mut dyn FnMut(u32) -> Result<Witness, Failure>,
    ) -> Result<Option<Verified>, Failure> {
        let (mut seen, mut samples, mut verified) = (vec![], samples, None);
        let mut tries = 1;
        loop {
            let is_ended = self.look(&mut seen, samples, shoot)?;
            let Some(found) = self.together(&seen, samples) else { return Ok(verified) };
            verified = Some(found);
            if is_ended {
                return Ok(verified);
            }
            let next = self.corrected(&found).filter(|next| {
                tries < TRIES
                    && *next != samples
                    && found.is_off(self.target)
                    && self.has_room(&seen, *next, 2)
            });
            let is_near = found.verdict(self.target) == Verdict::Near;
            match next {
                _ if found.is_known(self.target) && (is_near || next.is_none()) => {
                    return Ok(verified);
                }
                Some(next) => (samples, tries) = (next, tries + 1),
                None => {}
            }
        }
    }

    /// A few pictures more; returns whether there will be no others.
    fn look(
        &self,
        seen: &mut Vec<Witness>,
        samples: u32,
        shoot: &mut dyn FnMut(u32) -> Result<Witness, Failure>,
    ) -> Result<bool, Failure> {
        for _ in 0..STEP {
            if !self.has_room(seen, samples, 1) {
                return Ok(true);
            }
            match shoot(samples) {
                Ok(witness) => seen.push(witness),
                Err(failure) if failure.exit == Exit::Incomplete && seen.len() > 1 => {
                    return Ok(true);
                }
                Err(failure) => return Err(failure),
            }
        }
        Ok(false)
    }

    /// Whether so many pictures more may be made.
    fn has_room(&self, seen: &[Witness], samples: u32, pictures: usize) -> bool {
        let spent: f64 = seen.iter().map(|witness| witness.seconds).sum();
        let next = pictures as f64 * f64::from(samples) * self.cost;
        seen.len() + pictures <= MOST_PICTURES && self.left.is_none_or(|left| spent + next <= left)
    }

    /// The error with so many samples, by all pictures of about as many; `None` below two.
    ///
    /// Each counts by its samples: where what is seldom makes the error, it is met in proportion to them.
    fn together(&self, seen: &[Witness], samples: u32) -> Option<Verified> {
        let to = f64::from(samples);
        let ratio = |witness: &Witness| f64::from(witness.samples) / to;
        let is_alike = |w: &&Witness| (1.0 / ALIKE..=ALIKE).contains(&ratio(w));
        let seen: Vec<&Witness> = seen.iter().filter(is_alike).collect();
        let n = seen.len() as f64;
        let (power, power_error) =
            self.fit.map_or((0.0, 0.0), |fit| (fit.power, fit.measured.error));
        let moved = |w: &Witness| self.bias2 + (w.squared - self.bias2) * ratio(w).powf(power);
        let weights: f64 = seen.iter().map(|w| f64::from(w.samples)).sum();
        let mean_of = |value: &dyn Fn(&Witness) -> f64| {
            seen.iter().map(|w| f64::from(w.samples) * value(w)).sum::<f64>() / weights
        };
        let mean = mean_of(&moved);
        let square = |w: &Witness| (f64::from(w.samples) / weights * (moved(w) - mean)).powi(2);
        let scatter = seen.iter().map(|w| square(w)).sum::<f64>() * n / (n - 1.0);
        let leaning = mean_of(&|w| (moved(w) - self.bias2) * ratio(w).ln()) * power_error;
        let error = (scatter + leaning * leaning + self.common * self.common).sqrt();
        let at = seen.iter().map(|w| w.samples);
        (seen.len() > 1).then(|| Verified {
            samples,
            seen_at: [at.clone().min().unwrap_or(samples), at.max().unwrap_or(samples)],
            pictures: seen.len(),
            rmse: Number { value: mean, error }.root(),
            seconds: seen.iter().map(|w| w.seconds / ratio(w)).sum::<f64>() / n,
        })
    }

    /// The samples that reach the target, by pictures and fit, each counting by how well it knows; the fit
    /// not where they contradict it.
    fn corrected(&self, found: &Verified) -> Option<u32> {
        let fit = self.fit?;
        let n = f64::from(found.samples);
        let (square, target) = (found.rmse.value.powi(2), self.target * self.target);
        let seen = square - self.bias2;
        if seen <= 0.0 || target <= self.bias2 {
            return None;
        }
        let own = (2.0 * found.rmse.value * found.rmse.error / seen).powi(2);
        let of_fit = (fit.relative_error(n) * fit.power).powi(2);
        let apart = (fit.variance(n) / seen).ln();
        let is_contrary = apart.abs() > CONTRARY * (own + of_fit).sqrt();
        let share = if is_contrary || own <= 0.0 { 0.0 } else { own / (own + of_fit) };
        let variance = seen * (share * apart).exp();
        let samples = fit.corrected(n, variance, target - self.bias2).ceil().max(1.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to MOST")]
        (samples <= MOST).then_some(samples as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A variance of 10 per sample: 1 % squared at a hundred thousand, 10 % at a thousand.
    const PER_SAMPLE: f64 = 10.0;

    /// Of a fit that foretells `share` of the variance, as one that has seen too little that is seldom does.
    fn asked(share: f64) -> Asked {
        let point = |n: u32| {
            let value = share * PER_SAMPLE / f64::from(n);
            (n, Number { value, error: 0.1 * value })
        };
        let fit = Fit::of(&[4, 16, 64].map(point));
        Asked { target: 0.1, fit, bias2: 0.0, common: 0.0, cost: 0.0, left: None }
    }

    /// Uniform in [0, 1).
    struct Dice(u64);

    impl Dice {
        fn next(&mut self) -> f64 {
            // Knuth's MMIX generator, of which the upper bits are good.
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            f64::from(u32::try_from(self.0 >> 32).unwrap()) / 4_294_967_296.0
        }

        /// Poisson's, by Knuth's product of uniform numbers.
        fn events(&mut self, mean: f64) -> f64 {
            let (end, mut product, mut n) = ((-mean).exp(), self.next(), 0.0);
            while product > end {
                product *= self.next();
                n += 1.0;
            }
            n
        }

        /// Half of the squared error comes from what one picture in a few meets once or twice: two of a
        /// thousand samples each.
        fn picture(&mut self, samples: u32) -> Witness {
            let n = f64::from(samples);
            let mean = 2.0 * n / 1000.0;
            let squared = PER_SAMPLE / n * (0.5 + 0.5 * self.events(mean) / mean);
            Witness { samples, squared, seconds: 1.0 }
        }
    }

    #[test]
    fn of_skewed_noise_within_a_tenth_is_said_only_where_it_is_true() {
        let (mut near, mut wrong) = (0, 0);
        for run in 0..200 {
            let mut dice = Dice(run);
            let found = asked(0.4).verify(400, &mut |samples| Ok(dice.picture(samples)));
            let found = found.unwrap().unwrap();
            let is_near = found.verdict(0.1) == Verdict::Near;
            let truth = (PER_SAMPLE / f64::from(found.samples)).sqrt() / 0.1 - 1.0;
            near += u32::from(is_near);
            wrong += u32::from(is_near && truth.abs() > NEAR);
        }
        // Two standard errors leave 4.6 % outside: 9 of 200, and three standard deviations of that.
        assert!(wrong <= 18, "{wrong} of {near}");
        // One picture's squared error scatters by 0.35 of itself: 0.18 in its root, of which 2.5 % take 50.
        assert!(near >= 180, "{near}");
    }

    #[test]
    fn pictures_are_added_until_the_error_is_known_and_the_first_tries_still_count() {
        let mut dice = Dice(1);
        let mut counts = vec![];
        let found = asked(0.4).verify(700, &mut |samples| {
            counts.push(samples);
            Ok(dice.picture(samples))
        });
        let found = found.unwrap().unwrap();
        assert!(found.is_known(0.1) && found.off(0.1).error <= 0.025, "{found:?}");
        assert!(counts.len() > 2 * LEAST && counts[0] == 700, "{counts:?}");
        assert!(found.pictures == counts.len() && found.seen_at[0] == 700, "{found:?} {counts:?}");
    }

    #[test]
    fn even_noise_takes_the_fewest_pictures_and_a_short_time_fewer_still() {
        let shoot = |samples: u32| {
            Ok(Witness { samples, squared: PER_SAMPLE / f64::from(samples), seconds: 1.0 })
        };
        let found = asked(1.0).verify(1000, &mut shoot.clone()).unwrap().unwrap();
        assert_eq!((found.pictures, found.samples), (LEAST, 1000));
        assert_eq!(found.verdict(0.1), Verdict::Near);
        let short = |left| Asked { cost: 1e-3, left: Some(left), ..asked(1.0) };
        let few = short(5.5).verify(1000, &mut shoot.clone()).unwrap().unwrap();
        assert_eq!(few.pictures, 5);
        assert!(short(1.5).verify(1000, &mut shoot.clone()).unwrap().is_none());
        // Far off, the pictures at the first number are not taken for the next.
        let far = asked(0.1).verify(100, &mut shoot.clone()).unwrap().unwrap();
        assert_eq!((far.samples, far.seen_at), (1000, [1000, 1000]));
    }

    #[test]
    fn an_interval_has_to_lie_inside() {
        let verdict = |value, error| {
            let rmse = Number { value, error };
            let seen_at = [1, 1];
            Verified { samples: 1, seen_at, pictures: 16, rmse, seconds: 1.0 }.verdict(1.0)
        };
        assert_eq!(verdict(1.04, 0.029), Verdict::Near);
        assert_eq!(verdict(1.04, 0.031), Verdict::Unsure);
        assert_eq!(verdict(0.89, 0.05), Verdict::Better);
        assert_eq!(verdict(0.89, 0.06), Verdict::Unsure);
        assert_eq!(verdict(1.17, 0.03), Verdict::Missed);
    }
}
