//! A filter along one axis as a polygon, so that what is sampled is exactly what is evaluated.

/// Steps from the centre to the edge. A polygon of that many misses a smooth profile of `n`
/// standard deviations by less than (n/256)²/8: 3e-5 of its peak for 4.
const STEPS: usize = 256;

/// Parts of [0, 1) whose first step is known: so many that few hold the ends of two.
const PARTS: usize = 1024;

/// An even, piecewise-linear density on [−radius, radius].
pub(crate) struct Profile {
    radius: f32,
    /// Density at the steps, per pixel; integrates to ½ over [0, radius].
    density: [f32; STEPS + 1],
    /// Share of [0, x] at each step, of both sides together: from 0 to 1.
    cumulative: [f32; STEPS + 1],
    /// For each of `PARTS` equal parts of [0, 1): the first step that ends beyond its beginning.
    guide: [u16; PARTS],
}

impl Profile {
    /// A polygon through `f` (finite, not negative, somewhere positive), at distances up to
    /// `radius` pixels.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a table of f32 made in f64, and steps below 2^16"
    )]
    pub(crate) fn new(radius: f32, f: impl Fn(f64) -> f64) -> Self {
        let step = f64::from(radius) / STEPS as f64;
        let values: [f64; STEPS + 1] = std::array::from_fn(|i| f(i as f64 * step));
        let mut sums = [0.0; STEPS + 1];
        for i in 0..STEPS {
            sums[i + 1] = sums[i] + 0.5 * (values[i] + values[i + 1]);
        }
        let total = sums[STEPS];
        let cumulative = sums.map(|s| (s / total) as f32);
        let first = |part: usize| {
            let begin = part as f32 / PARTS as f32;
            cumulative[1..].iter().position(|&c| c > begin).unwrap_or(STEPS - 1) as u16
        };
        Self {
            radius,
            density: values.map(|v| (0.5 * v / (total * step)) as f32),
            cumulative,
            guide: std::array::from_fn(first),
        }
    }

    /// The density at `x` pixels from the centre.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, STEPS]")]
    pub(crate) fn eval(&self, x: f32) -> f32 {
        let at = x.abs() / self.radius * STEPS as f32;
        if !(at < STEPS as f32) {
            return 0.0;
        }
        let i = at as usize;
        self.density[i] + (at - i as f32) * (self.density[i + 1] - self.density[i])
    }

    /// A place with density `eval`; `u` in [0, 1). Increasing in `u`.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in [0, STEPS)")]
    pub(crate) fn sample(&self, u: f32) -> f32 {
        let centred = 2.0 * u - 1.0;
        let u = centred.abs();
        let mut i = usize::from(self.guide[((u * PARTS as f32) as usize).min(PARTS - 1)]);
        // Added, where a jump would be guessed wrongly every fourth time.
        i += usize::from(i + 1 < STEPS && self.cumulative[i + 1] <= u);
        while i + 1 < STEPS && self.cumulative[i + 1] <= u {
            i += 1;
        }
        let (low, high) = (self.cumulative[i], self.cumulative[i + 1]);
        // Where the trapezoid from a to b holds the fraction v of its area: the stable root.
        let v = ((u - low) / (high - low)).clamp(0.0, 1.0);
        let (a, b) = (self.density[i], self.density[i + 1]);
        let root = (a * a + v * (b * b - a * a)).max(0.0).sqrt();
        let within = if a + root > 0.0 { v * (a + b) / (a + root) } else { 0.0 };
        ((i as f32 + within.min(1.0)) * self.radius / STEPS as f32).copysign(centred)
    }
}

/// Makes a class with a `radius` and a `profile` a filter, that of the profile along both axes.
macro_rules! separable {
    ($class:ident) => {
        impl luxel_sdk::kind::Filter for $class<'_> {
            fn radius(&self) -> f32 {
                self.radius
            }

            fn eval(&self, offset: [f32; 2]) -> f32 {
                self.profile.eval(offset[0]) * self.profile.eval(offset[1])
            }

            fn sample(&self, u: [f32; 2]) -> [f32; 2] {
                u.map(|u| self.profile.sample(u))
            }
        }
    };
}
pub(crate) use separable;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_follow_the_density_they_claim() {
        let profile = Profile::new(1.5, |x| (-2.0 * x * x).exp());
        // The inverse of the sampling map is the integral of the density, here by the midpoint rule.
        let n = 30_000;
        let step = 3.0 / f64::from(n);
        let mut sum = 0.0;
        for i in 0..n {
            let x = -1.5 + (f64::from(i) + 0.5) * step;
            #[expect(clippy::cast_possible_truncation, reason = "test input")]
            let density = f64::from(profile.eval(x as f32));
            sum += density * step;
            if i % 1000 == 999 && sum < 1.0 {
                #[expect(clippy::cast_possible_truncation, reason = "test input")]
                let sampled = f64::from(profile.sample(sum as f32));
                // f32 rounding of the table (6e-8) over the least density (.0088), and of x.
                assert!((sampled - (x + 0.5 * step)).abs() < 4e-5, "{x} {sampled}");
            }
        }
        // f32 rounding of each density: 6e-8 relative.
        assert!((sum - 1.0).abs() < 1e-6, "{sum}");
    }

    #[test]
    fn the_ends_of_u_stay_inside() {
        let profile = Profile::new(2.0, |x| 2.0 - x);
        for u in [0.0, 0.5f32.next_down(), 0.5, 1.0f32.next_down()] {
            assert!(profile.sample(u).abs() <= 2.0);
        }
        assert!(profile.eval(2.0).abs() <= 0.0 && profile.eval(f32::NAN).abs() <= 0.0);
    }
}
