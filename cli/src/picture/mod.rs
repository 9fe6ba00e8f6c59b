//! Pictures on disk: the EXR holds what was measured, the PNG how it looks.

mod display;
mod exposed;
mod exr;
mod png;
mod read;

use std::io::{self, BufWriter, Write};

use luxel_core::film::Film;
use luxel_core::stage;

use crate::exit::Failure;
use crate::output::{Draft, Output, unwritable};

pub(crate) use display::{scale, show};
pub(crate) use exposed::Exposed;
pub(crate) use exr::{Notes, Plane, write_planes};
pub(crate) use png::write_signal;
pub(crate) use read::Picture;

/// Writes both files. They take their places only when both are whole on the disk.
///
/// # Errors
/// A file that cannot be written; the old ones stay.
pub(crate) fn write(
    output: &Output,
    film: &Film,
    settings: &stage::Film,
    notes: &Notes,
) -> Result<(), Failure> {
    write_both(output, |to| exr::write(to, film, notes), |to| png::write(to, film, settings))
}

/// Fills both files; likewise.
///
/// # Errors
/// As `write`.
pub(crate) fn write_both(
    output: &Output,
    exr: impl FnOnce(&mut To<'_>) -> io::Result<()>,
    png: impl FnOnce(&mut To<'_>) -> io::Result<()>,
) -> Result<(), Failure> {
    let exr = draft(output.exr.as_ref(), exr)?;
    let png = draft(output.png.as_ref(), png)?;
    exr.finish().map_err(|error| unwritable(&output.exr, &error))?;
    png.finish().map_err(|error| unwritable(&output.png, &error))
}

/// Where the bytes of a file go.
pub(crate) type To<'a> = BufWriter<&'a std::fs::File>;

/// Writes the PNG alone.
///
/// # Errors
/// As `write`.
pub(crate) fn preview(output: &Output, film: &Film, settings: &stage::Film) -> Result<(), Failure> {
    let png = draft(output.png.as_ref(), |to| png::write(to, film, settings))?;
    png.finish().map_err(|error| unwritable(&output.png, &error))
}

/// A film as it is read back from its file.
#[cfg(test)]
pub(crate) fn reread(film: &Film, notes: &Notes) -> Picture {
    let mut file = io::Cursor::new(vec![]);
    exr::write(&mut file, film, notes).unwrap();
    Picture::read(io::Cursor::new(file.into_inner())).unwrap()
}

fn draft(
    path: &std::path::Path,
    fill: impl FnOnce(&mut To<'_>) -> io::Result<()>,
) -> Result<Draft, Failure> {
    let filled = Draft::begin(path).and_then(|draft| {
        let mut to = BufWriter::new(&draft.file);
        fill(&mut to)?;
        to.flush()?;
        drop(to);
        draft.file.sync_all()?;
        Ok(draft)
    });
    filled.map_err(|error| unwritable(path, &error))
}

#[cfg(test)]
mod tests {
    use glam::UVec2;
    use luxel_core::film::Rect;

    use super::*;
    use crate::testing::Folder;

    #[test]
    fn both_files_appear_and_nothing_else() {
        let folder = Folder::new("picture");
        let film = Film::new(UVec2::splat(4), Rect::new(UVec2::ZERO, UVec2::splat(4)));
        let path = |name| folder.path(name);
        let output = Output { exr: path("a.exr"), png: path("a.png") };
        write(&output, &film, &stage::Film::default(), &Notes::default()).unwrap();
        let mut names = folder.names();
        names.sort();
        assert_eq!(names, ["a.exr", "a.png"]);
    }

    #[test]
    fn a_png_that_cannot_be_written_keeps_the_old_exr() {
        let folder = Folder::new("pair");
        folder.write("a.exr", b"old");
        folder.write("a.png/inside", b"");
        let film = Film::new(UVec2::splat(4), Rect::new(UVec2::ZERO, UVec2::splat(4)));
        let output = Output { exr: folder.path("a.exr"), png: folder.path("a.png") };
        let wrong = write(&output, &film, &stage::Film::default(), &Notes::default()).unwrap_err();
        assert!(wrong.message.contains("a.png"), "{}", wrong.message);
        assert_eq!(std::fs::metadata(folder.path("a.exr")).unwrap().len(), 3);
        assert_eq!(folder.names().len(), 2);
    }
}
