//! Luxel beside Mitsuba, as `compare.py` measures both.

use std::path::Path;

use serde_json::Value;

use super::Form;
use crate::peer::compare;
use crate::process::{Luxel, read, scratch};

/// Name, scene, and channel of the pictures whose means are compared.
const CHANNELS: [(&str, &str, usize); 7] = [
    ("grey", "cornell_grey", 0),
    ("R", "cornell_rgb", 0),
    ("G", "cornell_rgb", 1),
    ("B", "cornell_rgb", 2),
    ("X", "cornell_spectral", 0),
    ("Y", "cornell_spectral", 1),
    ("Z", "cornell_spectral", 2),
];

/// Name, and what `compare.py` calls it.
const REGIONS: [(&str, &str); 8] = [
    ("whole", "whole"),
    ("floor", "floor"),
    ("ceiling", "ceiling"),
    ("back", "back"),
    ("green wall", "right"),
    ("red wall", "left"),
    ("short block", "short"),
    ("tall block", "tall"),
];

/// Name, and scene.
const TIMED: [(&str, &str); 3] = [
    ("Cornell box", "cornell_rgb"),
    ("glass and metal", "glass_metal"),
    ("2.1 M triangles", "waves"),
];

/// Name, and what `compare.py` calls it.
const PROGRAMS: [(&str, &str); 3] = [
    ("luxel", "luxel"),
    ("Mitsuba, scalar_rgb", "scalar_rgb"),
    ("Mitsuba, llvm_ad_rgb", "llvm_ad_rgb"),
];

/// Luxel without reading and writing, as Mitsuba is measured.
const ALONE: (&str, &str) = ("luxel, the render alone", "luxel_alone");

/// Standard errors beyond which a difference is named.
const FAR: f64 = 3.5;

/// What `compare.py` found.
pub(super) struct Found {
    accuracy: Value,
    speed: Value,
    /// Of each program on each scene.
    rounds: u32,
}

impl Found {
    /// # Errors
    /// The script failed.
    pub(super) fn measure(luxel: &Luxel, python: &Path, form: Form) -> Result<Self, String> {
        let asked = |what: &str, words: &str| {
            let json = scratch()?.join(format!("{what}.json"));
            let mut all = vec![what, "--json", json.to_str().ok_or("a folder that is no text")?];
            all.extend(words.split(' '));
            compare(luxel, python, &all)?;
            serde_json::from_slice(&read(&json)?).map_err(|error| error.to_string())
        };
        let amount = form.pick(
            "--spp 128 --seeds 6 --res 256 --reference-spp 4096",
            "--spp 4 --seeds 2 --res 128 --reference-spp 16",
        );
        let accuracy = format!("{amount} --scenes cornell_grey cornell_rgb cornell_spectral");
        let (rounds, amount) = form.pick((9, "--spp 16"), (1, "--spp 1 --res 64"));
        let speed = format!("--rounds {rounds} {amount} --scenes cornell_rgb glass_metal waves");
        let (accuracy, speed) = (asked("accuracy", &accuracy)?, asked("speed", &speed)?);
        Ok(Self { accuracy, speed, rounds })
    }

    /// The same figures everywhere, to try what is made of them.
    #[cfg(test)]
    pub(super) fn made_up() -> Self {
        use serde_json::json;

        let regions = REGIONS.map(|(_, region)| (region, json!(vec![[-0.002, 0.001]; 3])));
        let regions: Value = regions.into_iter().map(|(name, it)| (name.to_owned(), it)).collect();
        let accuracy =
            CHANNELS.map(|(_, scene, _)| (scene.to_owned(), json!({ "regions": regions })));
        let figures = json!({ "rate": 1.5, "efficiency": 250.0 });
        let programs = PROGRAMS.into_iter().chain([ALONE]);
        let programs = programs.map(|(_, program)| (program.to_owned(), figures.clone()));
        let programs: Value = programs.collect();
        let speed = TIMED.map(|(_, scene)| (scene.to_owned(), programs.clone()));
        let (accuracy, speed) = (accuracy.into_iter().collect(), speed.into_iter().collect());
        Self { accuracy, speed, rounds: 9 }
    }

    /// Luxel / Mitsuba − 1 of a region's mean, and its standard error.
    ///
    /// # Errors
    /// It was not measured.
    pub(super) fn difference(
        &self,
        scene: &str,
        region: &str,
        channel: usize,
    ) -> Result<[f64; 2], String> {
        let at = |i| number(&self.accuracy, &format!("/{scene}/regions/{region}/{channel}/{i}"));
        Ok([at(0)?, at(1)?])
    }

    /// One figure of each of the programs.
    ///
    /// # Errors
    /// It was not measured.
    pub(super) fn of_programs(&self, scene: &str, figure: &str) -> Result<[f64; 3], String> {
        let of = |program: &str| number(&self.speed, &format!("/{scene}/{program}/{figure}"));
        let [(_, a), (_, b), (_, c)] = PROGRAMS;
        Ok([of(a)?, of(b)?, of(c)?])
    }

    /// 1 / (relMSE · second) of each of the programs, in three digits; of Luxel that of the whole process,
    /// and of its render alone.
    ///
    /// # Errors
    /// It was not measured.
    pub(super) fn efficiencies(&self, scene: &str) -> Result<Vec<String>, String> {
        let alone = number(&self.speed, &format!("/{scene}/{}/efficiency", ALONE.1))?;
        let [ours, theirs @ ..] = self.of_programs(scene, "efficiency")?.map(three_digits);
        Ok([format!("{ours} · {}", three_digits(alone))].into_iter().chain(theirs).collect())
    }

    /// Differences of means, in thousandths, and which of them are far from nothing.
    ///
    /// # Errors
    /// Something was not measured.
    pub(super) fn regions(&self) -> Result<String, String> {
        let mut rows = table("region", &CHANNELS.map(|(name, ..)| name));
        let mut far = vec![];
        for (name, region) in REGIONS {
            let mut cells = vec![];
            for (channel, scene, i) in CHANNELS {
                let [difference, error] = self.difference(scene, region, i)?;
                if difference.abs() > FAR * error {
                    far.push(format!("{name} {channel}"));
                }
                let sign = if difference < 0.0 { '−' } else { '+' };
                cells.push(format!("{sign}{} ± {}", thousandths(difference), thousandths(error)));
            }
            rows.push(row(name, &cells));
        }
        let n = REGIONS.len() * CHANNELS.len();
        let colon = if far.is_empty() { "" } else { ": " };
        let (beyond, far) = (far.len(), far.join(", "));
        rows.push(format!("\n{beyond} of {n} lie beyond {FAR} standard errors{colon}{far}."));
        Ok(rows.join("\n"))
    }

    /// Relative MSE of blocks at growing sample counts.
    ///
    /// # Errors
    /// Something was not measured.
    pub(super) fn blocks(&self) -> Result<String, String> {
        let blocks = &self.accuracy["cornell_grey"]["blocks"];
        let counted = blocks["of_spp"].as_array().map_or(0, Vec::len);
        let (mut heads, mut cells) = (vec![], vec![]);
        for i in 0..counted {
            heads.push(format!("{}", number(blocks, &format!("/of_spp/{i}/0"))?));
            cells.push(format!("{:.1e}", number(blocks, &format!("/of_spp/{i}/1"))?));
        }
        heads.push("the reference's own noise".to_owned());
        cells.push(format!("{:.1e}", number(blocks, "/own")?));
        let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
        let mut rows = table("samples", &heads);
        rows.push(row("relMSE", &cells));
        Ok(rows.join("\n"))
    }

    /// Rates, efficiencies, and the programs' times round by round.
    ///
    /// # Errors
    /// Something was not measured.
    pub(super) fn speed(&self) -> Result<String, String> {
        let scenes = TIMED.map(|(name, _)| name);
        let figure = |(_, scene): (&str, &str), program: &str, figure: &str| {
            number(&self.speed, &format!("/{scene}/{program}/{figure}"))
        };
        let mut rates = table("Mpaths per CPU-second (spread)", &scenes);
        let mut efficiencies = table("1 / (relMSE · second), two cores", &scenes);
        let mut times = table("time of luxel over that of: median (least to greatest)", &scenes);
        let [ours, theirs @ ..] = PROGRAMS;
        for (name, program) in [ours, ALONE].into_iter().chain(theirs) {
            let (mut rate, mut efficiency) = (vec![], vec![]);
            for scene in TIMED {
                let of = |what: &str| figure(scene, program, what);
                rate.push(format!("{:.3} ({:.0} %)", of("rate")?, of("spread")? * 100.0));
                efficiency.push(three_digits(of("efficiency")?));
            }
            rates.push(row(name, &rate));
            efficiencies.push(row(name, &efficiency));
        }
        for (name, program) in theirs {
            for (of_what, what) in [("", "of_time"), (", the render alone", "of_time_alone")] {
                let mut time = vec![];
                for scene in TIMED {
                    let [least, middle, most] = [0, 1, 2].map(|i| format!("{what}/{i}"));
                    let of = |what: &str| figure(scene, program, what);
                    let [least, middle, most] = [of(&least)?, of(&middle)?, of(&most)?];
                    time.push(format!("{middle:.3} ({least:.3} to {most:.3})"));
                }
                times.push(row(&format!("{name}{of_what}"), &time));
            }
        }
        let tables = [rates, efficiencies, times].map(|rows| rows.join("\n")).join("\n\n");
        Ok(format!("{} rounds of each.\n\n{tables}", self.rounds))
    }
}

/// What stands at a place of what `compare.py` wrote.
fn number(found: &Value, place: &str) -> Result<f64, String> {
    let at = found.pointer(place).and_then(Value::as_f64);
    at.ok_or_else(|| format!("compare.py did not measure {place}"))
}

/// The lines that a table begins with.
fn table(corner: &str, heads: &[&str]) -> Vec<String> {
    vec![format!("| {corner} | {} |", heads.join(" | ")), "|---".repeat(heads.len() + 1) + "|"]
}

fn row(name: &str, cells: &[String]) -> String {
    format!("| {name} | {} |", cells.join(" | "))
}

/// With a minus sign where programs write a hyphen.
pub(super) fn minus(text: &str) -> String {
    text.replace('-', "−")
}

/// The amount in thousandths; without the nought before the point, and with fewer decimals from 1 on.
fn thousandths(share: f64) -> String {
    let amount = share.abs() * 1e3;
    let text = format!("{amount:.2}");
    text.strip_prefix('0').map_or_else(|| format!("{amount:.1}"), str::to_owned)
}

fn three_digits(value: f64) -> String {
    let decimals = [10.0, 100.0].iter().filter(|limit| value < **limit).count();
    format!("{value:.decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_told_as_the_tables_have_them() {
        let told = [-0.00004, 0.00078, 0.0011, 0.0009996].map(thousandths);
        assert_eq!(told, [".04", ".78", "1.1", "1.0"]);
        assert_eq!([2.041, 52.03, 951.9].map(three_digits), ["2.04", "52.0", "952"]);
        assert_eq!(minus("-0.010 %"), "−0.010 %");
    }
}
