//! How a watch begins: with the libraries, or with a wait for a save where another one came to a bad end.

use std::path::PathBuf;

use super::Args;
use super::audience::Audience;
use super::changes::Changes;
use crate::exit::Failure;
use crate::files::Watched;
use crate::isolate::{Beat, Phase};
use crate::libraries::{Plugins, Session, Surroundings};
use crate::load;
use crate::report::Stream;

/// Opens what libraries there are.
///
/// # Errors
/// A lock or configuration that cannot be understood; standard error that cannot be written.
pub(super) fn open(
    session: &mut Session,
    args: &Args,
    surroundings: &Surroundings,
    beat: &Beat,
) -> Result<Plugins, Failure> {
    beat.phase(Phase::Opening);
    let plugins = session.refresh(&args.plugins, surroundings)?;
    beat.opened(plugins.open(), &plugins.watched);
    plugins.notes.tell(args.form(), Stream::Error)?;
    Ok(plugins)
}

/// Waits for a save of what a watch that came to a bad end had asked for, or of what may have to change:
/// the scene, and what decides which libraries are opened. False when the end is asked for.
pub(super) fn is_saved_after(
    failure: &Failure,
    told: Watched,
    args: &Args,
    (audience, changes, beat): (&Audience, &mut Changes, &Beat),
) -> bool {
    audience.page().inspect(|page| page.failed(failure));
    let plugins = load::look_at_libraries(&args.plugins);
    let libraries = plugins.map_or_else(|_| Watched::new(), |plugins| plugins.watched);
    let also = libraries.keys().map(PathBuf::as_path).chain([args.file.as_path()]);
    changes.expect_more_than(told, also);
    beat.phase(Phase::Waiting);
    changes.wait()
}
