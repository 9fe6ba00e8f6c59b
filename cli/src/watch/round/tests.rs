//! A picture on its way to the disk, and what is wanted of it meanwhile.

use std::path::Path;

use clap::Parser;
use luxel_core::registry::Registry;
use luxel_core::stage::Anew;

use super::*;
use crate::testing::Folder;

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    args: Args,
}

/// A black film of four pixels that goes to this file.
fn subject(folder: &Folder, file: &str) -> (Arc<Stage>, Arc<Read>) {
    let text = format!(
        "scene 1\nfilm rgb {{ resolution = (2, 2), file = \"{file}\" }}\n\
         camera perspective {{ look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, \
         up = (0, 1, 0)), fov = 40 deg }}\nsampler sobol {{ samples = 2 }}\n"
    );
    folder.write("a.scene", text.as_bytes());
    let mut registry = Registry::new();
    for classes in luxel_builtin::CLASSES {
        registry.add("builtin", classes).unwrap();
    }
    let path = folder.path("a.scene");
    let files = DiskFiles::new(&path, &[]);
    let settings = luxel_lang::Settings::default();
    let read = luxel_lang::load(&path, &files, &registry, &settings);
    let stage = luxel_core::stage::build(&read.scene.unwrap(), &registry, &files, None);
    (Arc::new(stage.unwrap().stage), Arc::new(Read { files, sources: read.sources }))
}

fn edit(word: &str) -> Edit {
    Edit::new(vec![word.to_owned()], Anew::default(), 0.0)
}

fn line(out: &Path) -> Args {
    Line::parse_from(["watch".as_ref(), "a.scene".as_ref(), "-q".as_ref(), "-o".as_ref(), out]).args
}

#[test]
fn what_is_wanted_while_a_picture_is_written_is_written_after_it() {
    let folder = Folder::new("sitting");
    let args = line(&folder.path("a"));
    let (stage, read) = subject(&folder, "a");
    let sitting = Sitting::new(stage.clone(), read.clone(), Some(edit("first")));
    let show = |word| sitting.show_as((stage.clone(), read.clone()), edit(word));
    let (control, guard, beat) = (Arc::default(), Guard::default(), Beat::silent());
    let course = Course { control: &control, guard: &guard, beat: &beat };
    assert!(!show("while it is measured") && sitting.to_print().is_none());
    assert!(sitting.render(&args, &course, &mut |_, _| {}).unwrap_or(false));
    let words = |print: &Print| print.edit.as_ref().map(Edit::words).unwrap_or_default();

    assert!(sitting.is_in_press() && !sitting.is_written());
    assert!(!show("before it is written"), "whoever writes it has it already");
    let first = sitting.to_print().unwrap();
    assert!(words(&first).starts_with("first; while it is measured; before it is written · "));
    assert!(sitting.to_print().is_none(), "it is written once");

    assert!(!show("while it is written"));
    sitting.printed(true);
    assert!(sitting.is_in_press() && !sitting.is_written());
    let second = sitting.to_print().unwrap();
    assert!(words(&second).starts_with("while it is written · "), "{}", words(&second));
    second.write(&args, &beat).unwrap_or_else(|failure| panic!("{}", failure.message));
    sitting.printed(true);
    assert!(!sitting.is_in_press() && sitting.is_written() && sitting.to_print().is_none());
    let mut names = folder.names();
    names.sort();
    assert_eq!(names, ["a.exr", "a.png", "a.scene"]);

    assert!(show("at rest"), "it has to be brought to whoever writes it");
    sitting.to_print().unwrap();
    sitting.printed(false);
    assert!(!sitting.is_in_press() && !sitting.is_written(), "it could not be written");
    assert!(show("again"));
}
