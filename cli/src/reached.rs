//! How wrong a picture may be, and where it is not as good as was asked, for people and as JSON.

use luxel_core::film::{Above, Confidence, Errors, Film, Intervals, Rect};
use luxel_core::render::Goal;
use serde_json::{Value, json};

/// So many tiles are told by name.
const NAMED: usize = 5;
/// And so many for programs.
const LISTED: usize = 64;

/// What was asked for and what there is.
#[derive(Clone, Debug)]
pub(crate) struct Reached {
    goal: Goal,
    error: Option<Errors>,
    intervals: Option<Intervals>,
    /// Where an error that was asked for is not reached.
    above: Option<Above>,
}

impl Reached {
    pub(crate) fn of(film: &Film, goal: Goal) -> Self {
        let above = |limit| Above::of_film(film, (limit, goal.confidence), LISTED);
        Self {
            goal,
            error: Errors::of_film(film, f64::INFINITY),
            intervals: Intervals::of_film(film, goal.confidence.unwrap_or(Confidence::USUAL)),
            above: goal.error.map(above),
        }
    }

    /// Whether every tile has the error that was asked for, if one was.
    pub(crate) fn is_whole(&self) -> bool {
        self.above.as_ref().is_none_or(|above| above.tiles == 0 && self.error.is_some())
    }

    pub(crate) fn say(&self, all: &mut Value) {
        all["rms_relative_error"] = json!(self.error.map(|error| error.rms));
        all["median_relative_error"] = json!(self.error.map(|error| error.median));
        all["p95_relative_error"] = json!(self.error.map(|error| error.p95));
        all["worst_relative_error"] = json!(self.error.map(|error| error.worst));
        all["worst_pixel"] = json!(self.error.map(|error| error.worst_at.to_array()));
        all["half_width"] = json!(self.intervals.map(|of| json!({
            "confidence": of.confidence.share(),
            "median": of.median,
            "p95": of.p95,
            "worst_tile": of.worst_tile,
            "worst_tile_at": place(of.worst_tile_at),
        })));
        all["error_asked"] = json!(self.goal.error);
        all["confidence_asked"] = json!(self.goal.confidence.map(Confidence::share));
        if let Some(above) = &self.above {
            let tile =
                |(at, error): &(Rect, Option<f64>)| json!({ "at": place(*at), "error": error });
            all["pixels_above"] = json!(above.pixels);
            all["tiles_above"] = json!(above.tiles);
            all["worst_tiles_above"] = above.worst.iter().map(tile).collect();
        }
    }

    /// Two or three lines.
    pub(crate) fn words(&self) -> String {
        let Some(Errors { rms, median, p95, worst, worst_at, .. }) = self.error else {
            let unknown = "standard error per pixel: unknown, it takes two samples\n";
            return unknown.to_owned() + &self.asked_words();
        };
        let [rms, median, p95, worst] = [rms, median, p95, worst].map(percent);
        let intervals = self.intervals.map_or_else(String::new, |of| {
            let [median, p95, tile] = [of.median, of.p95, of.worst_tile].map(percent);
            let (share, at) = (confidence(of.confidence), of.worst_tile_at.min);
            format!(
                "half width of {share} intervals: median {median}, 95th percentile {p95}, worst tile {tile} \
                 at ({}, {})\n",
                at.x, at.y
            )
        });
        format!(
            "relative standard error per pixel: rms {rms}, median {median}, 95th percentile {p95}, \
             worst {worst} at ({}, {})\n{intervals}{}",
            worst_at.x,
            worst_at.y,
            self.asked_words()
        )
    }

    fn asked_words(&self) -> String {
        let (Some(asked), Some(above)) = (self.goal.error, &self.above) else {
            return String::new();
        };
        let with = self
            .goal
            .confidence
            .map_or_else(String::new, |share| format!(" with {} confidence", confidence(share)));
        let (asked, pixels) = (percent(asked) + &with, above.pixels);
        match above.tiles {
            0 => format!(
                "every tile is within the {asked} asked for; single pixels above: {pixels}\n"
            ),
            tiles => {
                let are = if tiles == 1 { "tile is" } else { "tiles are" };
                format!(
                    "the {asked} asked for is not reached: {tiles} {are} above, {pixels} pixels; the worst: \
                     {}\n",
                    worst(above)
                )
            }
        }
    }
}

/// `16 x 16 at (32, 48) 3.20 %, 16 x 16 at (0, 0) unknown, and 7 others`
fn worst(above: &Above) -> String {
    let tile = |(Rect { min, size }, error): &(Rect, Option<f64>)| {
        let error = error.map_or_else(|| "unknown".to_owned(), percent);
        format!("{} x {} at ({}, {}) {error}", size.x, size.y, min.x, min.y)
    };
    let named: Vec<String> = above.worst.iter().take(NAMED).map(tile).collect();
    let others = match above.tiles.saturating_sub(named.len() as u64) {
        0 => String::new(),
        1 => ", and another".into(),
        n => format!(", and {n} others"),
    };
    named.join(", ") + &others
}

fn place(rect: Rect) -> [u32; 4] {
    [rect.min.x, rect.min.y, rect.size.x, rect.size.y]
}

fn percent(share: f64) -> String {
    let percent = share * 100.0;
    // What rounding would take away altogether is told by its first digits.
    if percent > 0.0 && percent < 0.005 {
        format!("{percent:.1e} %")
    } else {
        format!("{percent:.2} %")
    }
}

/// `95 %`
fn confidence(of: Confidence) -> String {
    // A share of 0.999 is 99.9: what rounding leaves is cut off.
    format!("{} %", (of.share() * 1e5).round() / 1e3)
}

#[cfg(test)]
mod tests {
    use glam::UVec2;

    use super::*;

    fn tile(x: u32) -> Rect {
        Rect::new(UVec2::new(x, 0), UVec2::splat(16))
    }

    /// Of a picture whose tiles have errors of 2 % and less, less than that, and so many of them above.
    fn reached(tiles: u8, confidence: Option<Confidence>) -> Reached {
        let worst =
            (0..tiles).map(|i| (tile(16 * u32::from(i)), Some(0.08 - f64::from(i) / 100.0)));
        let above = Above { pixels: 112, tiles: tiles.into(), worst: worst.collect() };
        let at = UVec2::new(3, 4);
        let (rms, median, p95, worst) = (0.01, 0.008, 0.017, 0.025);
        let error = Errors { rms, median, p95, worst, worst_at: at, above: 0, tiles_above: 0 };
        let of = confidence.unwrap_or(Confidence::USUAL);
        let (worst_tile, worst_tile_at) = (0.042, tile(32));
        let intervals =
            Intervals { confidence: of, median: 0.016, p95: 0.035, worst_tile, worst_tile_at };
        Reached {
            goal: Goal { error: Some(0.015), confidence, ..Goal::default() },
            error: Some(error),
            intervals: Some(intervals),
            above: Some(above),
        }
    }

    #[test]
    fn small_shares_are_not_told_as_none() {
        let shares = [0.0, 1e-6, 4e-5, 6e-5, 0.015].map(percent);
        assert_eq!(shares, ["0.00 %", "1.0e-4 %", "4.0e-3 %", "0.01 %", "1.50 %"]);
    }

    #[test]
    fn tiles_above_are_told_by_name_the_worst_first() {
        let words = reached(7, None).words();
        let told = "the 1.50 % asked for is not reached: 7 tiles are above, 112 pixels; the worst: 16 x 16 at \
                    (0, 0) 8.00 %, 16 x 16 at (16, 0) 7.00 %, 16 x 16 at (32, 0) 6.00 %, 16 x 16 at (48, 0) \
                    5.00 %, 16 x 16 at (64, 0) 4.00 %, and 2 others\n";
        assert!(words.ends_with(told), "{words}");
        assert!(reached(6, None).words().ends_with("4.00 %, and another\n"));
        let mut unknown = reached(1, None);
        unknown.above.as_mut().unwrap().worst[0].1 = None;
        let words = unknown.words();
        assert!(
            words.ends_with("1 tile is above, 112 pixels; the worst: 16 x 16 at (0, 0) unknown\n"),
            "{words}"
        );
        let mut told = json!({});
        reached(3, None).say(&mut told);
        assert_eq!(told["worst_tiles_above"][2], json!({ "at": [32, 0, 16, 16], "error": 0.06 }));
        assert_eq!((&told["tiles_above"], &told["pixels_above"]), (&json!(3), &json!(112)));
        assert!(!reached(3, None).is_whole() && reached(0, None).is_whole());
    }

    #[test]
    fn the_interval_is_told_beside_the_standard_error() {
        let words = reached(0, None).words();
        let told = "relative standard error per pixel: rms 1.00 %, median 0.80 %, 95th percentile 1.70 %, worst \
                    2.50 % at (3, 4)\nhalf width of 95 % intervals: median 1.60 %, 95th percentile 3.50 %, worst \
                    tile 4.20 % at (32, 0)\nevery tile is within the 1.50 % asked for; single pixels above: 112\n";
        assert_eq!(words, told);
        let sure = reached(0, Confidence::new(0.999));
        assert!(sure.words().contains("half width of 99.9 % intervals: "));
        assert!(sure.words().contains("within the 1.50 % with 99.9 % confidence asked for; "));
        let mut json = json!({});
        sure.say(&mut json);
        let half = json!({
            "confidence": 0.999, "median": 0.016, "p95": 0.035, "worst_tile": 0.042,
            "worst_tile_at": [32, 0, 16, 16],
        });
        assert_eq!((&json["confidence_asked"], &json["half_width"]), (&json!(0.999), &half));
    }
}
