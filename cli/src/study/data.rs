//! What was found, for programs.

use std::fmt::Write;

use serde_json::{Value, json};

use super::estimate::Number;
use super::expected::Expected;
use super::outcome::{Outcome, Point};

const HEAD: &str = "configuration,spp,rmse,variance,variance_standard_error,bias_squared,\
                    bias_squared_standard_error,is_biased,seconds,is_on_front";

/// A line for each configuration and number of samples.
pub(super) fn csv(outcomes: &[Outcome]) -> String {
    let mut out = format!("{HEAD}\n");
    for (outcome, point) in outcomes.iter().flat_map(|o| o.points.iter().map(move |p| (o, p))) {
        let Point { spp, estimate, seconds, is_on_front } = point;
        let (variance, bias2) = (estimate.variance, estimate.bias2);
        let _ = writeln!(
            out,
            "{},{spp},{:e},{:e},{:e},{:e},{:e},{},{seconds:e},{is_on_front}",
            outcome.name,
            estimate.rmse(),
            variance.value,
            variance.error,
            bias2.value,
            bias2.error,
            estimate.is_biased(),
        );
    }
    out
}

/// The configurations as a JSON array.
///
/// With how far off their means are where one is expected.
pub(super) fn json(outcomes: &[Outcome], target: f64, expected: Option<Expected>) -> Value {
    let Some(base) = outcomes.first() else { return json!([]) };
    let one = |outcome: &Outcome| {
        json!({
            "name": outcome.name,
            "points": outcome.points.iter().map(point).collect::<Vec<_>>(),
            "power": outcome.fit.map(|fit| number(fit.measured)),
            "seconds_per_spp": outcome.cost,
            "time_ratio_quartiles": outcome.slower,
            "efficiency": outcome.fit.map(|_| outcome.efficiency(base)),
            "spp_for_target": outcome.samples_for(target),
            "mean_off": expected.map(|expected| number(expected.off(outcome))),
            "samples_not_finite": outcome.bad,
        })
    };
    outcomes.iter().map(one).collect()
}

fn point(point: &Point) -> Value {
    let Point { spp, estimate, seconds, is_on_front } = point;
    json!({
        "spp": spp,
        "rmse": estimate.rmse(),
        "variance": number(estimate.variance),
        "bias_squared": number(estimate.bias2),
        "is_biased": estimate.is_biased(),
        "bias_unseen_below": estimate.unseen(),
        "seconds": seconds,
        "is_on_front": is_on_front,
    })
}

pub(super) fn number(Number { value, error }: Number) -> Value {
    json!({ "value": value, "standard_error": error })
}
