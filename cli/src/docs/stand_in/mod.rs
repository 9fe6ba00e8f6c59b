//! Files that stand for those that manuals name, made by the program, so that what a manual shows can be
//! drawn without them.

mod flat;
mod solid;

use luxel_core::files::MemoryFiles;

/// A file as a manual names it, and what is drawn in its place.
type StandIn = (&'static str, fn() -> Vec<u8>);

const ALL: [StandIn; 6] = [
    ("assets/spot.obj", solid::cow),
    ("assets/bust.obj", solid::bust),
    ("assets/tree.glb", solid::tree),
    ("assets/overcast.exr", flat::sky),
    ("assets/soil.exr", flat::soil),
    ("alps.png", flat::mountains),
];

fn of(text: &str) -> impl Iterator<Item = &'static StandIn> {
    ALL.iter().filter(move |(name, _)| text.contains(&format!("\"{name}\"")))
}

/// The files that a text names and that something stands for.
pub(super) fn names(text: &str) -> impl Iterator<Item = &'static str> {
    of(text).map(|(name, _)| *name)
}

/// What stands for the files that a text names.
pub(super) fn files(text: &str) -> MemoryFiles {
    of(text).fold(MemoryFiles::default(), |files, (name, bytes)| files.with(*name, bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stands_for_a_file_of_a_manual_and_begins_as_its_format_does() {
        let classes = luxel_builtin::CLASSES.iter().flat_map(|of_kind| of_kind.iter());
        let manuals: String = classes.map(|class| class.doc).collect();
        assert_eq!(names(&manuals).count(), ALL.len());
        for (name, bytes) in ALL {
            let begins: &[u8] = match name.rsplit('.').next().unwrap() {
                "obj" => b"v ",
                "glb" => b"glTF\x02\0\0\0",
                "exr" => b"\x76\x2f\x31\x01",
                _ => b"\x89PNG",
            };
            assert!(bytes().starts_with(begins), "{name}");
        }
        assert_eq!(names("file = \"assets/other.obj\"").count(), 0);
    }
}
