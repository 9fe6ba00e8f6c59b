//! Closed-form truths: what the renderer measures against what mathematics says. The program carries
//! them, so that whoever has it can tell whether it is right.

mod bench;
mod colour;
mod estimators;
mod lamps;
mod list;
mod photometry;
mod rays;
mod scene;
mod texts;
mod unit;
mod walks;

use luxel_core::accel::Precision;
use luxel_core::stage::Stage;

use self::bench::Bench;
use super::row::Row;
use super::run::Run;
use crate::exit::Failure;

/// One of the scenes with some parameters set.
///
/// # Errors
/// One that the classes at hand cannot make.
pub(super) fn stage(name: &str, set: &[(String, String)], run: &Run) -> Result<Stage, Failure> {
    Bench::new(run, None).stage(name, &texts::files(), set)
}

/// Tests every truth whose name begins so; what is found is kept even if it ends early.
///
/// # Errors
/// What `Run::film` says; a scene of this program that the classes at hand cannot make.
pub(super) fn test(
    only: &str,
    precision: Option<Precision>,
    run: &Run,
    rows: &mut Vec<Row>,
) -> Result<(), Failure> {
    let bench = Bench::new(run, precision);
    scene::test(only, &bench, rows)?;
    colour::test(only, &bench, rows)?;
    rows.extend(unit::rows(&bench)?.into_iter().filter(|row| row.id.starts_with(only)));
    Ok(())
}
