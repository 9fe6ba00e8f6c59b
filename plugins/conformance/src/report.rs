//! What a run found: a table, for people and programs.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use luxel_sdk::abi::Class;

use crate::statistics::limit;

/// How a check ended.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// The figure is within its limit.
    Pass,
    /// It is not.
    Fail,
    /// The check could not be made: why.
    Skip(String),
}

/// One check of one class, over all parameters and points that were tried.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Row {
    /// The word of the kind.
    pub kind: &'static str,
    /// The name of the class.
    pub class: String,
    /// What was checked.
    pub check: Cow<'static, str>,
    /// How it ended.
    pub verdict: Verdict,
    /// The worst figure that was found, in the check's unit; standard deviations for statistics.
    pub figure: f64,
    /// Its limit, in the same unit.
    pub limit: f64,
    /// The parameters and the point at which the worst figure was found.
    pub detail: String,
}

/// All rows of a run, by kind and class.
#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct Report {
    /// Every check of every class.
    pub rows: Vec<Row>,
}

impl Report {
    /// The rows that failed.
    pub fn failed(&self) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(|row| row.verdict == Verdict::Fail)
    }

    /// Whether no check failed.
    pub fn is_clean(&self) -> bool {
        self.failed().next().is_none()
    }

    /// The rows of checks that could not be made, each with the reason.
    pub fn skipped(&self) -> impl Iterator<Item = (&Row, &str)> {
        self.rows.iter().filter_map(|row| match &row.verdict {
            Verdict::Skip(why) => Some((row, why.as_str())),
            _ => None,
        })
    }

    /// The rows of classes of which no object could be made, so that next to nothing was judged.
    pub fn unmade(&self) -> impl Iterator<Item = (&Row, &str)> {
        self.skipped().filter(|(row, _)| row.check == crate::UNMADE)
    }

    /// The report of what all judges found. Limits of statistics depend on how many there are.
    pub(crate) fn of(judges: Vec<Judge>) -> Self {
        let n = judges.iter().flat_map(|judge| judge.findings.values()).map(|f| f.tests).sum();
        let z = limit(n);
        Self { rows: judges.into_iter().flat_map(|judge| judge.into_rows(z)).collect() }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{:<10} {:<24} {:<30} {:<7} {:>10} {:>10}",
            "kind", "class", "check", "verdict", "figure", "limit"
        )?;
        for row in &self.rows {
            let verdict = match &row.verdict {
                Verdict::Pass => "pass",
                Verdict::Fail => "FAIL",
                Verdict::Skip(_) => "skip",
            };
            let Row { kind, class, check, .. } = row;
            write!(f, "{kind:<10} {class:<24} {check:<30} {verdict:<7} ")?;
            match &row.verdict {
                Verdict::Skip(why) => writeln!(f, "{why}")?,
                _ => writeln!(f, "{:>10.3e} {:>10.3e}", row.figure, row.limit)?,
            }
            if row.verdict == Verdict::Fail {
                writeln!(f, "{:11}{}", "", row.detail)?;
            }
        }
        Ok(())
    }
}

/// What one check has found so far.
struct Finding {
    figure: f64,
    limit: f64,
    detail: String,
    /// Statistics that were compared; 0 for a check without chance.
    tests: u64,
    skipped: Option<String>,
}

/// Gathers the findings about one class: of each check the worst.
pub(crate) struct Judge {
    kind: &'static str,
    class: String,
    findings: BTreeMap<&'static str, Finding>,
}

impl Judge {
    pub(crate) fn new(class: &Class) -> Self {
        let (kind, class) = (class.kind.word(), class.name.to_owned());
        Self { kind, class, findings: BTreeMap::new() }
    }

    /// A judge of the same class who knows of nothing yet.
    pub(crate) fn fresh(&self) -> Self {
        Self { kind: self.kind, class: self.class.clone(), findings: BTreeMap::new() }
    }

    /// The checks of which something is known.
    pub(crate) fn checks(&self) -> impl Iterator<Item = &'static str> {
        self.findings.keys().copied()
    }

    /// Takes over what another found.
    pub(crate) fn join(&mut self, other: Self) {
        for (check, found) in other.findings {
            self.take(check, found);
        }
    }

    fn take(&mut self, check: &'static str, found: Finding) {
        let tests = found.tests;
        match self.findings.get_mut(check) {
            Some(old) => {
                let tests = old.tests + tests;
                let worse = old.skipped.is_some() || !(ratio(&found) <= ratio(old));
                if worse && found.skipped.is_none() {
                    *old = found;
                }
                old.tests = tests;
            }
            None => {
                self.findings.insert(check, found);
            }
        }
    }

    /// A figure that must not exceed a limit; NaN does.
    pub(crate) fn within(
        &mut self,
        check: &'static str,
        figure: f64,
        limit: f64,
        detail: impl FnOnce() -> String,
    ) {
        let known = self.findings.get(check);
        let found = Finding { figure, limit, detail: String::new(), tests: 0, skipped: None };
        let better = known.is_some_and(|old| old.skipped.is_none() && ratio(&found) <= ratio(old));
        if !better {
            self.take(check, Finding { detail: detail(), ..found });
        }
    }

    /// A property that must hold.
    pub(crate) fn holds(
        &mut self,
        check: &'static str,
        holds: bool,
        detail: impl FnOnce() -> String,
    ) {
        self.within(check, f64::from(u8::from(!holds)), 0.0, detail);
    }

    /// A statistic in standard deviations that large values speak against.
    pub(crate) fn statistic(
        &mut self,
        check: &'static str,
        z: f64,
        detail: impl FnOnce() -> String,
    ) {
        let z = if z.is_nan() { f64::INFINITY } else { z.max(0.0) };
        // The limit is known when all have been counted.
        self.take(
            check,
            Finding { figure: z, limit: 1.0, detail: detail(), tests: 1, skipped: None },
        );
    }

    /// A check that cannot be made here.
    pub(crate) fn skip(&mut self, check: &'static str, why: impl Into<String>) {
        let skipped = Some(why.into());
        let detail = String::new();
        self.take(check, Finding { figure: 0.0, limit: 0.0, detail, tests: 0, skipped });
    }

    /// A check that could not be made, unless it was.
    pub(crate) fn skip_untried(&mut self, check: &'static str, why: &str) {
        if !self.findings.contains_key(check) {
            self.skip(check, why);
        }
    }

    fn into_rows(self, z: f64) -> impl Iterator<Item = Row> {
        let Self { kind, class, findings } = self;
        findings.into_iter().map(move |(check, found)| {
            let limit = if found.tests > 0 { z } else { found.limit };
            let verdict = match found.skipped {
                Some(why) => Verdict::Skip(why),
                None if found.figure <= limit => Verdict::Pass,
                None => Verdict::Fail,
            };
            let (figure, detail) = (found.figure, found.detail);
            let check = Cow::Borrowed(check);
            Row { kind, class: class.clone(), check, verdict, figure, limit, detail }
        })
    }
}

/// How near a figure comes to its limit: beyond 1 it fails.
fn ratio(found: &Finding) -> f64 {
    if found.figure.is_nan() {
        f64::INFINITY
    } else if found.limit > 0.0 {
        found.figure / found.limit
    } else if found.figure > 0.0 {
        f64::INFINITY
    } else {
        0.0
    }
}
