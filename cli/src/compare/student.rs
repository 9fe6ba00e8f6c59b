//! Student's t: tails and quantiles, for any degrees of freedom.

/// Degrees of freedom are cut here, where t is normal to 1e-5 in p; more never tells of less chance.
const MOST_DOF: f64 = 1e6;

/// Probability that Student's variable is further from 0 than `t`; 1 where `t` is not a number.
///
/// # Source
/// Abramowitz & Stegun 26.7.1, by the incomplete beta function (26.5.8).
pub(crate) fn two_sided(t: f64, dof: f64) -> f64 {
    if t.is_nan() {
        return 1.0;
    }
    if t.is_infinite() {
        return 0.0;
    }
    let dof = dof.clamp(1.0, MOST_DOF);
    let (a, b, square) = (0.5 * dof, 0.5, t * t);
    let (x, rest) = (dof / (dof + square), square / (dof + square));
    let scale = (ln_gamma(a + b) - ln_gamma(a) - ln_gamma(b) - a * (square / dof).ln_1p()
        + b * rest.ln())
    .exp();
    // The fraction converges on the side of the mean alone.
    let p = if x < (a + 1.0) / (a + b + 2.0) {
        scale * fraction(x, a, b) / a
    } else {
        1.0 - scale * fraction(rest, b, a) / b
    };
    p.clamp(0.0, 1.0)
}

/// What Student's variable exceeds with the probability `p` < 1/2.
fn quantile(p: f64, dof: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    while 0.5 * two_sided(high, dof) > p && high < 1e150 {
        high *= 2.0;
    }
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if 0.5 * two_sided(middle, dof) > p {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// Quantiles of one probability for many degrees of freedom.
#[derive(Clone, Debug)]
pub(super) struct Quantiles(Vec<f64>);

/// From one entry of the table to the next.
const STEP: f64 = 1.05;

impl Quantiles {
    pub(super) fn new(p: f64) -> Self {
        let mut dof = 1.0;
        let mut all = vec![];
        while dof < MOST_DOF {
            all.push(quantile(p, dof));
            dof *= STEP;
        }
        Self(all)
    }

    /// Of the next fewer degrees of freedom: not below the quantile.
    #[expect(clippy::cast_possible_truncation, reason = "the logarithm is small")]
    #[expect(clippy::cast_sign_loss, reason = "not below one degree")]
    pub(super) fn at(&self, dof: f64) -> f64 {
        let i = (dof.max(1.0).ln() / STEP.ln()) as usize;
        self.0[i.min(self.0.len() - 1)]
    }
}

/// The continued fraction of the incomplete beta function.
///
/// # Source
/// Abramowitz & Stegun 26.5.8, by Lentz's method.
fn fraction(x: f64, a: f64, b: f64) -> f64 {
    const TINY: f64 = 1e-300;
    let away = |v: f64| if v.abs() < TINY { TINY } else { v };
    let mut c = 1.0;
    let mut d = 1.0 / away(1.0 - (a + b) * x / (a + 1.0));
    let mut h = d;
    for m in 1..10_000 {
        let m = f64::from(m);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        for term in [even, odd] {
            d = 1.0 / away(1.0 + term * d);
            c = away(1.0 + term / c);
            h *= d * c;
        }
        if (d * c - 1.0).abs() < 1e-15 {
            break;
        }
    }
    h
}

/// Logarithm of the gamma function of x > 0, to 1e-14 of it.
///
/// # Source
/// Lanczos 1964, with g = 7 and nine terms.
fn ln_gamma(x: f64) -> f64 {
    const TERMS: [f64; 8] = [
        676.5203681218851,
        -1259.1392167224028,
        771.323_428_777_653_1,
        -176.615_029_162_140_6,
        12.507343278686905,
        -0.13857109526572012,
        9.984_369_578_019_572e-6,
        1.5056327351493116e-7,
    ];
    let x = x - 1.0;
    let base = x + 7.5;
    let sum = (1_i32..)
        .zip(TERMS)
        .fold(0.999_999_999_999_809_9, |sum, (i, term)| sum + term / (x + f64::from(i)));
    0.5 * std::f64::consts::TAU.ln() + (x + 0.5) * base.ln() - base + sum.ln()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tails_are_those_of_the_tables() {
        // SciPy 1.17: 2 * stats.t.sf(t, dof).
        for (t, dof, p) in TAILS {
            let found = two_sided(t, dof);
            assert!((found / p - 1.0).abs() < 1e-8, "{t} {dof}: {found} {p}");
            assert!((two_sided(-t, dof) - found).abs() <= 0.0);
        }
        assert!((two_sided(0.0, 5.0) - 1.0).abs() < 1e-12);
        assert!(two_sided(f64::NAN, 5.0) >= 1.0 && two_sided(f64::INFINITY, 5.0) <= 0.0);
        // Normal.
        assert!((two_sided(1.959_963_984_540_054, f64::INFINITY) - 0.05).abs() < 1e-6);
    }

    #[test]
    fn a_quantile_is_exceeded_as_often_as_it_says_or_more_rarely() {
        for p in [0.05, 1e-3, 1e-7] {
            let table = Quantiles::new(p);
            for dof in [1.0, 3.7, 15.0, 1000.0, 1e9] {
                let tail = 0.5 * two_sided(table.at(dof), dof);
                assert!(tail <= p * (1.0 + 1e-6), "{p} {dof}: {tail}");
                assert!((0.5 * two_sided(quantile(p, dof), dof) / p - 1.0).abs() < 1e-6);
            }
        }
    }

    const TAILS: [(f64, f64, f64); 7] = [
        (1.0, 1.0, 0.5000000000000001),
        (2.0, 3.0, 0.13932596855884305),
        (2.5, 15.0, 0.024505803246513826),
        (0.3, 15.0, 0.7682945345355523),
        (5.0, 7.5, 0.0012762228035169815),
        (6.0, 1900.0, 2.3568454935013833e-09),
        (4.0, 250000.0, 6.336068643511169e-05),
    ];
}
