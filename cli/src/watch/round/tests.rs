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

/// A ball on a film of two tiles that goes to the file `a`.
fn subject(folder: &Folder, samples: u32) -> (Arc<Stage>, Arc<Read>) {
    let text = format!(
        "scene 1\nfilm rgb {{ resolution = (20, 9), file = \"a\" }}\nlight constant {{ scale = 1 }}\n\
         shape sphere {{ radius = 1 m, material = material diffuse {{ reflectance = 0.5 }} }}\n\
         camera perspective {{ look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, \
         up = (0, 1, 0)), fov = 40 deg }}\nsampler sobol {{ samples = {samples} }}\n"
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
    let read = Read { files, sources: read.sources, origin: Origin::default() };
    (Arc::new(stage.unwrap().stage), Arc::new(read))
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
    let (stage, read) = subject(&folder, 2);
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

#[test]
fn more_samples_go_on_from_what_is_there_to_the_same_bits() {
    let folder = Folder::new("more-samples");
    let args = line(&folder.path("a"));
    let (guard, beat) = (Guard::default(), Beat::silent());
    // Renders, from another sitting if there is one, and ends the render at so many samples.
    let render = |samples: u32, from: Option<&Sitting>, end: Option<u32>| {
        let (stage, read) = subject(&folder, samples);
        let sitting = Sitting::new(stage, read, None);
        from.inspect(|from| sitting.go_on_from(from));
        let control = Arc::new(Control::default());
        let course = Course { control: &control, guard: &guard, beat: &beat };
        let mut look = |_: &Film, now: Reached| {
            if end.is_some_and(|end| now.samples >= end) {
                control.supersede();
            }
        };
        sitting.render(&args, &course, &mut look).unwrap_or_else(|it| panic!("{}", it.message));
        (sitting, control.samples_done())
    };
    let film = |sitting: &Sitting| sitting.lock().done.as_ref().map(|done| done.0.film.clone());
    let pixels = 20 * 9;
    let (cold, all) = render(40, None, None);
    assert_eq!(all, 40 * pixels);
    let (few, _) = render(8, None, None);
    let (more, n) = render(40, Some(&few), None);
    assert_eq!(n, 32 * pixels, "the first samples were taken again");
    assert!(film(&more).is_some() && film(&more) == film(&cold));

    // Also from one that was left in the middle, and from one that went on itself.
    let (left, n) = render(8, None, Some(2));
    assert!(film(&left).is_none() && n < 8 * pixels);
    let (again, m) = render(16, Some(&left), Some(8));
    let (more, rest) = render(40, Some(&again), None);
    assert_eq!(n + m + rest, 40 * pixels);
    assert!(film(&more) == film(&cold));
}
