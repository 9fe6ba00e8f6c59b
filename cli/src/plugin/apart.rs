//! `luxel plugin test --isolate`: each class is judged in a process of its own.

use std::ffi::OsString;
use std::io::Read;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use luxel_conformance::{Report, Row, Verdict};
use luxel_sdk::kind::Kind;
use serde_json::Value;

use super::course::Course;
use super::test::{Args, tell};
use crate::exit::{Exit, Failure};
use crate::isolate::{Beat, Child, End, Ending};

/// So long may a class be judged.
const PATIENCE: Duration = Duration::from_secs(300);

/// Between two looks at a child.
const TICK: Duration = Duration::from_millis(5);

/// What is added to the checks of a class.
const ENDS: &str = "ends by itself";

pub(super) fn run(args: &Args) -> Result<Exit, Failure> {
    let mut course = Course::new(&Beat::silent())?;
    let classes = match classes(args)? {
        Ok(classes) => classes,
        // It has said why.
        Err(exit) => return Ok(exit),
    };
    let mut found = Report::default();
    for (done, (kind, name)) in classes.iter().enumerate() {
        if course.next(&format!("{kind} {name}"), done, classes.len()).is_break() {
            break;
        }
        found.rows.extend(judged(args, *kind, name)?);
    }
    tell(args, &found, course)
}

/// The classes that are to be judged, or how that ended: only a process apart opens the library.
fn classes(args: &Args) -> Result<Result<Vec<(Kind, String)>, Exit>, Failure> {
    let (library, words) = args.library();
    let (ending, text) = asked(args, ["--list".into()], words.iter().map(OsString::from))?;
    let of = library.unwrap_or(Path::new("luxel plugin test"));
    if let Some(failure) = ending.failure(of) {
        return Err(failure);
    }
    if let End::InOrder(exit @ (Exit::Input | Exit::Usage | Exit::Incomplete | Exit::Ours)) =
        ending.end
    {
        return Ok(Err(exit));
    }
    let listed: Vec<(String, String)> = serde_json::from_str(&text).unwrap_or_default();
    let known = |(kind, name): (String, String)| Some((Kind::of_word(&kind)?, name));
    Ok(Ok(listed.into_iter().filter_map(known).collect()))
}

/// What is found about one class; a bad end is a failed check.
fn judged(args: &Args, kind: Kind, name: &str) -> Result<Vec<Row>, Failure> {
    let words = [kind.word().into(), name.into()];
    let (ending, text) = asked(args, ["--json".into()], words)?;
    let report: Value = serde_json::from_str(&text).unwrap_or_default();
    let rows = report["rows"].as_array();
    let mut all: Vec<Row> = rows.into_iter().flatten().filter_map(row).collect();
    let (verdict, detail) = match ending.end {
        End::InOrder(_) if rows.is_some() => (Verdict::Pass, String::new()),
        end => (Verdict::Fail, end.words()),
    };
    let figure = f64::from(u8::from(verdict == Verdict::Fail));
    let (kind, class, check) = (kind.word(), name.to_owned(), ENDS.into());
    all.push(Row { kind, class, check, verdict, figure, limit: 0.0, detail });
    Ok(all)
}

/// Has the same command carried out for these words: how it ended, and what it printed.
fn asked(
    args: &Args,
    options: impl IntoIterator<Item = OsString>,
    words: impl IntoIterator<Item = OsString>,
) -> Result<(Ending, String), Failure> {
    let mut all: Vec<OsString> = ["plugin", "test", "--isolate", "--seed"].map(Into::into).into();
    all.push(args.seed.to_string().into());
    all.extend(options);
    all.extend(args.plugins.words());
    all.push("--".into());
    all.extend(args.library().0.map(Into::into));
    all.extend(words);
    let mut child = Child::start(all, args.isolate.patience(PATIENCE), Stdio::piped(), None)?;
    let output = child.output();
    // Read beside it: a full pipe would make it wait.
    let reader = std::thread::spawn(move || {
        let mut text = vec![];
        // What is cut off is not understood, and that is told.
        let _ = output.map(|mut output| output.read_to_end(&mut text));
        String::from_utf8_lossy(&text).into_owned()
    });
    let ending = loop {
        if let Some(ending) = child.poll() {
            break ending;
        }
        std::thread::sleep(TICK);
    };
    Ok((ending, reader.join().unwrap_or_default()))
}

/// A row as it was printed. What is no number was not finite.
fn row(value: &Value) -> Option<Row> {
    let text = |name: &str| Some(value[name].as_str()?.to_owned());
    let number = |name: &str| value[name].as_f64().unwrap_or(f64::INFINITY);
    Some(Row {
        kind: Kind::of_word(value["kind"].as_str()?)?.word(),
        class: text("class")?,
        check: text("check")?.into(),
        verdict: serde_json::from_value(value["verdict"].clone()).ok()?,
        figure: number("figure"),
        limit: number("limit"),
        detail: text("detail")?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_as_they_were_printed() {
        for verdict in [Verdict::Pass, Verdict::Fail, Verdict::Skip("why".into())] {
            let (class, detail) = ("box".to_owned(), "radius = 1".to_owned());
            let (figure, limit) = (0.5, f64::INFINITY);
            let check = "bounded".into();
            let one = Row { kind: "filter", class, check, verdict, figure, limit, detail };
            let printed = serde_json::to_value(&one).unwrap();
            assert_eq!(format!("{:?}", row(&printed).unwrap()), format!("{one:?}"));
        }
        assert!(row(&Value::Null).is_none());
    }
}
