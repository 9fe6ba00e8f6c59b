//! The plot: error over time, both by their logarithms.

use std::fmt::Write;

use super::outcome::Outcome;
use super::table::percent;
use super::verify::Verified;
use crate::progress::duration;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 460.0;
/// Left, right, upper and lower end of the plot proper.
const LEFT: f64 = 76.0;
const RIGHT: f64 = 560.0;
const TOP: f64 = 44.0;
const BOTTOM: f64 = 404.0;
/// Okabe and Ito's colours, which all eyes tell apart; then again, dashed.
const COLOURS: [&str; 7] =
    ["#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"];

/// An axis by logarithms.
struct Axis {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Axis {
    /// Over all positive values, with some room.
    fn over(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
        for value in values.filter(|value| *value > 0.0 && value.is_finite()) {
            (low, high) = (low.min(value), high.max(value));
        }
        if high <= 0.0 {
            (low, high) = (1.0, 1.0);
        }
        Self { low: low / 1.4, high: high * 1.4, from, to }
    }

    fn at(&self, value: f64) -> f64 {
        let share = (value.max(self.low) / self.low).ln() / (self.high / self.low).ln();
        self.from + share * (self.to - self.from)
    }

    /// 1, 2, 5, 10, … within it.
    fn ticks(&self) -> Vec<f64> {
        let decades = -12..12;
        let all = decades.flat_map(|d| [1.0, 2.0, 5.0].map(|x| x * 10.0_f64.powi(d)));
        all.filter(|x| (self.low..=self.high).contains(x)).collect()
    }
}

/// What is drawn beside the configurations.
pub(super) struct Marks<'a> {
    pub(super) title: &'a str,
    pub(super) size: glam::UVec2,
    pub(super) target: f64,
    pub(super) verified: Option<Verified>,
}

/// The plot as a picture that browsers show.
pub(super) fn svg(outcomes: &[Outcome], marks: &Marks<'_>) -> String {
    let points = || outcomes.iter().flat_map(|outcome| &outcome.points);
    let verified = marks.verified.iter();
    let seconds = points().map(|p| p.seconds).chain(verified.clone().map(|v| v.seconds));
    let errors = points().map(|p| p.estimate.rmse()).chain([marks.target]);
    let x = Axis::over(seconds, LEFT, RIGHT);
    let y = Axis::over(errors.chain(verified.map(|v| v.rmse.value)), BOTTOM, TOP);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" \
         width=\"{WIDTH}\" height=\"{HEIGHT}\" font-family=\"sans-serif\" font-size=\"13\">\n\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" fill=\"#ffffff\"/>\n"
    );
    text(&mut out, (LEFT, 24.0), "start", &format!("{}: error over time", marks.title));
    grid(&mut out, &x, &y);
    let title = format!("time of a picture of {} x {} pixels", marks.size.x, marks.size.y);
    text(&mut out, (f64::midpoint(LEFT, RIGHT), HEIGHT - 14.0), "middle", &title);
    target(&mut out, &y, marks.target);
    for (i, outcome) in outcomes.iter().enumerate() {
        curve(&mut out, (&x, &y), i, outcome);
    }
    if let Some(Verified { rmse, seconds, .. }) = marks.verified {
        let (cx, cy) = (x.at(seconds), y.at(rmse.value));
        let _ = writeln!(
            out,
            "<path d=\"M{cx:.1} {:.1} l8 8 l-8 8 l-8 -8 z\" fill=\"none\" stroke=\"#c00000\" \
             stroke-width=\"2.5\"/>",
            cy - 8.0
        );
    }
    legend(&mut out, outcomes.len(), marks.verified.is_some());
    out + "</svg>\n"
}

fn text(out: &mut String, (x, y): (f64, f64), anchor: &str, words: &str) {
    let words = words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let _ =
        writeln!(out, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{words}</text>");
}

fn line(out: &mut String, (x, y): (f64, f64), (to_x, to_y): (f64, f64), style: &str) {
    let _ = writeln!(
        out,
        "<line x1=\"{x:.1}\" y1=\"{y:.1}\" x2=\"{to_x:.1}\" y2=\"{to_y:.1}\" {style}/>"
    );
}

fn grid(out: &mut String, x: &Axis, y: &Axis) {
    let style = "stroke=\"#d8d8d8\"";
    for tick in x.ticks() {
        line(out, (x.at(tick), TOP), (x.at(tick), BOTTOM), style);
        text(out, (x.at(tick), BOTTOM + 18.0), "middle", &short_time(tick));
    }
    for tick in y.ticks() {
        line(out, (LEFT, y.at(tick)), (RIGHT, y.at(tick)), style);
        text(out, (LEFT - 8.0, y.at(tick) + 4.5), "end", &format!("{} %", short(tick * 100.0)));
    }
}

/// `20 ms`, `2 s`, `3 min 20 s`
fn short_time(seconds: f64) -> String {
    match seconds {
        _ if seconds < 0.9 => format!("{} ms", short(seconds * 1000.0)),
        _ if seconds < 60.0 => format!("{} s", short(seconds)),
        _ => duration(seconds),
    }
}

/// Without the digits that powers of ten leave behind.
fn short(x: f64) -> f64 {
    format!("{x:.3e}").parse().unwrap_or(x)
}

fn target(out: &mut String, y: &Axis, target: f64) {
    let at = y.at(target);
    line(out, (LEFT, at), (RIGHT, at), "stroke=\"#c00000\" stroke-dasharray=\"2 4\"");
    text(out, (LEFT + 6.0, at - 5.0), "start", &format!("target {}", percent(target)));
}

/// How a configuration is drawn.
fn pen(i: usize) -> String {
    let dash = ["", " stroke-dasharray=\"7 4\"", " stroke-dasharray=\"2 3\""];
    let (colour, dash) = (COLOURS[i % COLOURS.len()], dash[i / COLOURS.len() % dash.len()]);
    format!("stroke=\"{colour}\"{dash}")
}

/// Its points joined; those that nothing beats are filled. Its name stands in the legend.
fn curve(out: &mut String, (x, y): (&Axis, &Axis), i: usize, outcome: &Outcome) {
    let points = outcome.points.iter().filter(|point| point.estimate.rmse() > 0.0);
    let places = points.clone().map(|point| (x.at(point.seconds), y.at(point.estimate.rmse())));
    let joined = places.clone().map(|(x, y)| format!("{x:.1},{y:.1}")).collect::<Vec<_>>();
    let (pen, colour) = (pen(i), COLOURS[i % COLOURS.len()]);
    let joined = joined.join(" ");
    let _ =
        writeln!(out, "<polyline points=\"{joined}\" fill=\"none\" stroke-width=\"1.5\" {pen}/>");
    for (point, (x, y)) in points.zip(places) {
        let fill = if point.is_on_front { colour } else { "#ffffff" };
        let _ = writeln!(
            out,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{fill}\" stroke=\"{colour}\"/>"
        );
    }
    let at = row(i);
    line(out, (RIGHT + 14.0, at), (RIGHT + 42.0, at), &format!("stroke-width=\"2\" {pen}"));
    text(out, (RIGHT + 48.0, at + 4.5), "start", &outcome.name);
}

/// Height of a line of the legend.
fn row(i: usize) -> f64 {
    TOP + 8.0 + 18.0 * i as f64
}

fn legend(out: &mut String, n: usize, is_verified: bool) {
    let mut notes = vec!["filled: nothing measured is", "better in time and error"];
    if is_verified {
        notes.push("red: recommended and verified");
    }
    for (i, note) in notes.iter().enumerate() {
        let at = row(n + 1 + i) - 4.0;
        let note = note.to_owned();
        let _ = writeln!(
            out,
            "<text x=\"{:.1}\" y=\"{at:.1}\" font-size=\"11\" fill=\"#555555\">{note}</text>",
            RIGHT + 14.0
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_axis_puts_decades_at_equal_distances_and_bears_no_values() {
        let axis = Axis::over([0.01, 1.0, 0.0, f64::NAN].into_iter(), 0.0, 100.0);
        let steps = [axis.at(0.1) - axis.at(0.01), axis.at(1.0) - axis.at(0.1)];
        assert!((steps[0] - steps[1]).abs() < 1e-9 && steps[0] > 40.0, "{steps:?}");
        assert_eq!(axis.ticks().iter().map(|x| short(*x)).collect::<Vec<_>>().len(), 7);
        let none = Axis::over(std::iter::empty(), 0.0, 100.0);
        assert!(none.at(0.0).abs() < 1e-9 && none.at(1.0) > 0.0);
    }

    #[test]
    fn names_cannot_break_the_picture() {
        let mut out = String::new();
        text(&mut out, (1.0, 2.0), "start", "a<b>&c");
        assert!(out.contains(">a&lt;b&gt;&amp;c</text>"), "{out}");
    }

    #[test]
    fn times_on_the_axis_are_round() {
        assert_eq!(
            [0.02, 0.5, 5.0, 200.0].map(short_time),
            ["20 ms", "500 ms", "5 s", "3 min 20 s"]
        );
    }
}
