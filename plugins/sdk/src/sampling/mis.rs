//! Weights of multiple importance sampling, one sample from each of two techniques.

/// f / (f + g): the weight of a sample that technique f drew.
///
/// Both are densities in one measure, ≥ 0. An infinite f (a delta) gives 1 against a finite g and
/// ½ against another; f = 0 or a NaN gives 0.
///
/// # Source
/// PBR4 §2.2.3, eq. 2.14.
pub fn balance_heuristic(f_pdf: f32, g_pdf: f32) -> f32 {
    weight(f_pdf, g_pdf, |ratio| ratio)
}

/// f² / (f² + g²), found without overflow; edges as in [`balance_heuristic`].
///
/// # Source
/// PBR4 §2.2.3, eq. 2.15, β = 2.
pub fn power_heuristic(f_pdf: f32, g_pdf: f32) -> f32 {
    weight(f_pdf, g_pdf, |ratio| ratio * ratio)
}

fn weight(f: f32, g: f32, power: impl Fn(f32) -> f32) -> f32 {
    if f <= 0.0 || f.is_nan() || g.is_nan() {
        0.0
    } else if f.is_infinite() {
        if g.is_infinite() { 0.5 } else { 1.0 }
    } else {
        1.0 / (1.0 + power(g / f))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_both_techniques_sum_to_one() {
        let densities = [1e-45, 1e-30, 1e-3, 1.0, 7.0, 1e30, f32::MAX, f32::INFINITY];
        for h in [balance_heuristic, power_heuristic] {
            for f in densities {
                for g in densities {
                    let sum = h(f, g) + h(g, f);
                    // Each weight rounds at most three times.
                    assert!((sum - 1.0).abs() <= 4.0 * f32::EPSILON, "{f} {g} {sum}");
                }
            }
        }
    }

    #[test]
    fn the_power_heuristic_squares() {
        assert!((power_heuristic(2.0, 1.0) - 0.8).abs() <= f32::EPSILON);
        assert!((balance_heuristic(2.0, 1.0) - 2.0 / 3.0).abs() <= f32::EPSILON);
    }

    #[test]
    fn edges_give_zero_or_one_and_never_nan() {
        for h in [balance_heuristic, power_heuristic] {
            let ones = [(1.0, 0.0), (f32::INFINITY, 1.0), (f32::INFINITY, 0.0)];
            assert!(ones.iter().all(|&(f, g)| h(f, g).to_bits() == 1f32.to_bits()));
            let zeros = [(0.0, 0.0), (0.0, 1.0), (1.0, f32::INFINITY), (f32::NAN, 1.0)];
            assert!(zeros.iter().all(|&(f, g)| h(f, g).to_bits() == 0));
            assert!(h(1.0, f32::NAN).to_bits() == 0);
        }
    }
}
