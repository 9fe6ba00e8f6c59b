//! What is told of a comparison, for people and as JSON.

use serde_json::{Value, json};

use super::judge::{Judged, POWER, TILE};
use super::numbers::Numbers;
use super::pair::Pair;
use super::verdict::{Limits, Verdict, chance, percent};
use super::welch::LANES;

/// All that was found.
pub(super) struct Told<'a> {
    pub(super) names: [String; 2],
    pub(super) pair: &'a Pair,
    pub(super) numbers: Numbers,
    /// Nothing for pictures too large for it.
    pub(super) flip: Option<f64>,
    pub(super) judged: Judged,
    pub(super) limits: Limits,
    pub(super) verdict: Verdict,
}

impl Told<'_> {
    pub(super) fn json(&self) -> Value {
        let Self { numbers, judged, .. } = self;
        let window = self.pair.window;
        let lanes = LANES.iter().zip(judged.whole).map(|(name, lane)| {
            json!({
                "lane": name,
                "difference": lane.difference,
                "reference": lane.reference,
                "standard_error": lane.se,
                "degrees_of_freedom": lane.dof,
                "p": lane.p,
            })
        });
        let least = judged.least.map(|least| {
            json!({
                "tile": least.tile.rect.min.to_array(),
                "lane": LANES[least.lane],
                "relative_difference": least.tile.lanes[least.lane].relative(),
                "z": least.tile.lanes[least.lane].z(),
                "corrected_p": least.p,
            })
        });
        json!({
            "verdict": self.verdict.word,
            "why": self.verdict.why,
            "remarks": self.pair.remarks(),
            "files": self.names,
            "size": self.pair.a.size.to_array(),
            "window": [window.min.x, window.min.y, window.size.x, window.size.y],
            "alpha": self.limits.alpha,
            "bias": self.limits.bias,
            "power": POWER,
            "mse": numbers.mse,
            "expected_mse": numbers.expected_mse,
            "rel_mse": numbers.rel_mse,
            "flip": self.flip,
            "max_ulp": numbers.max_ulp,
            "not_finite": numbers.not_finite,
            "measured_pixels": judged.measured,
            "whole": lanes.collect::<Value>(),
            "whole_corrected_p": judged.whole_p,
            "tile_side": TILE,
            "tiles": judged.tiles.len(),
            "least_tile": least,
            "histogram": judged.histogram(),
            "histogram_p": judged.histogram_p,
            "smallest_detectable_bias": {
                "whole": judged.detectable.whole,
                "median_tile": judged.detectable.median_tile,
                "worst_tile": judged.detectable.worst_tile,
            },
        })
    }

    pub(super) fn text(&self) -> String {
        let word = format!("{:?}", self.verdict.word).to_lowercase();
        let mut lines = vec![format!("{word}: {}", self.verdict.why.join("; "))];
        lines.extend(self.pair.remarks().iter().map(|remark| format!("remark: {remark}")));
        lines.extend([
            String::new(),
            format!("A {}", self.names[0]),
            format!("B {}", self.names[1]),
        ]);
        lines.extend(self.place());
        lines.extend([String::new(), self.distances()]);
        if self.judged.measured > 0 {
            lines.extend([String::new(), self.tests()]);
        }
        lines.join("\n") + "\n"
    }

    /// Where, if not everywhere.
    fn place(&self) -> Option<String> {
        let (size, window) = (self.pair.a.size, self.pair.window);
        let [x, y, w, h] = [window.min.x, window.min.y, window.size.x, window.size.y];
        let part = format!("compared in {w} x {h} at ({x}, {y}) of {} x {}", size.x, size.y);
        (window.size != size).then_some(part)
    }

    fn distances(&self) -> String {
        let Numbers { mse, expected_mse, rel_mse, max_ulp, not_finite: [a, b], .. } = self.numbers;
        let expected =
            expected_mse.map_or(String::new(), |noise| format!(", of noise alone {noise:.3e}"));
        let flip =
            self.flip.map_or("not for so large pictures".into(), |flip| format!("{flip:.4}"));
        let number = |x: f64| if x.is_nan() { "–".to_owned() } else { format!("{x:.3e}") };
        let [mse, rel_mse] = [mse, rel_mse].map(number);
        format!(
            "MSE         {mse}{expected}\n\
             relMSE      {rel_mse}\n\
             FLIP        {flip}\n\
             max ulp     {max_ulp}\n\
             not finite  {a} pixels of A, {b} of B"
        )
    }

    fn tests(&self) -> String {
        let Self { judged, .. } = self;
        let mut lines = vec!["A − B        relative   ± one SE        p".to_owned()];
        for (name, lane) in LANES.iter().zip(judged.whole) {
            let relative = |x: f64| percent(x / lane.reference);
            let p = lane.p.map_or("–".into(), chance);
            let (difference, se) = (relative(lane.difference), relative(lane.se));
            lines.push(format!("{name:<10}{difference:>11}{se:>11}{p:>9}"));
        }
        lines.push(format!("together, corrected: p = {}", chance(judged.whole_p)));
        if let Some(least) = judged.least {
            let (at, lane) = (least.tile.rect.min, least.tile.lanes[least.lane]);
            lines.push(format!(
                "{} tiles of {TILE} x {TILE}: least corrected p = {} at ({}, {}), {} of {}, z = {:+.1}",
                judged.tiles.len(),
                chance(least.p),
                at.x,
                at.y,
                percent(lane.relative()),
                LANES[least.lane],
                lane.z(),
            ));
        }
        let tenths = judged.histogram().map(|n| n.to_string()).join(" ");
        lines.push(format!("tiles by the tenth where their p lies, 0 to 1: {tenths}"));
        lines.push(format!("too many small p values of tiles: p = {}", chance(judged.histogram_p)));
        let seen = judged.detectable;
        lines.push(format!(
            "a bias found with {} probability: {} of the mean, {} of the median tile, {} of the worst",
            percent(POWER),
            percent(seen.whole),
            percent(seen.median_tile),
            percent(seen.worst_tile),
        ));
        lines.join("\n")
    }
}
