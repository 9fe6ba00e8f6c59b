//! Scenes laid out, as a person does it.

use super::program::Folder;

const CROOKED: &str = "scene 1\n\nshape  sphere{radius=5cm ; center = (0,1,0)m} // a ball\n";
const STRAIGHT: &str =
    "scene 1\n\nshape sphere { radius = 5 cm, center = (0, 1, 0) m }  // a ball\n";
const WRONG: &str = "scene 1\nlet a  = 5 +\n";

#[test]
fn files_are_laid_out_in_their_place_and_once_is_enough() {
    let folder = Folder::new("fmt").with("a.scene", CROOKED).with("b.scene", STRAIGHT);
    let time = |name: &str| std::fs::metadata(folder.path(name)).unwrap().modified().unwrap();
    let before = time("b.scene");
    let done = folder.luxel(&["fmt", "a.scene", "b.scene"]);
    assert_eq!((done.code, &*done.out, &*done.err), (0, "", ""));
    assert_eq!(folder.read("a.scene"), STRAIGHT.as_bytes());
    assert_eq!(
        (time("b.scene"), folder.names()),
        (before, vec!["a.scene".into(), "b.scene".into()])
    );
    assert_eq!(folder.luxel(&["fmt", "--check", "a.scene", "b.scene"]).code, 0);
}

#[test]
fn check_names_what_would_change_and_changes_nothing() {
    let folder = Folder::new("fmt-check").with("a.scene", CROOKED).with("b.scene", STRAIGHT);
    let done = folder.luxel(&["fmt", "--check", "a.scene", "b.scene"]);
    assert_eq!((done.code, &*done.out), (1, "a.scene: not laid out\n"), "{done:?}");
    assert_eq!(folder.read("a.scene"), CROOKED.as_bytes());
    let done = folder.luxel(&["fmt", "--check", "--json", "b.scene", "a.scene"]);
    let lines = [r#"{"changes":false,"file":"b.scene"}"#, r#"{"changes":true,"file":"a.scene"}"#];
    assert_eq!((done.code, done.out.lines().collect::<Vec<_>>()), (1, lines.to_vec()));
}

#[test]
fn files_with_mistakes_stay_and_the_others_are_laid_out() {
    let folder = Folder::new("fmt-wrong").with("wrong.scene", WRONG).with("a.scene", CROOKED);
    folder.write_bytes("latin.scene", b"scene 1\n// \xe9\n");
    let done = folder.luxel(&["fmt", "wrong.scene", "latin.scene", "none.scene", "a.scene"]);
    assert_eq!(done.code, 1, "{done:?}");
    for part in ["E0015", "wrong.scene:2", "E0003", "byte 11 of the file is not UTF-8"] {
        assert!(done.err.contains(part), "{part} in {}", done.err);
    }
    assert!(done.err.contains("error[E0107]: none.scene: "), "{done:?}");
    assert_eq!(folder.read("wrong.scene"), WRONG.as_bytes());
    assert_eq!(folder.read("a.scene"), STRAIGHT.as_bytes());
    let done = folder.luxel(&["fmt", "--json", "wrong.scene"]);
    assert!(done.code == 1 && done.out.contains(r#""code":"E0015""#), "{done:?}");
    let done = folder.luxel(&["fmt", "--json", "none.scene"]);
    let parts = [r#""code":"E0107""#, r#""file":"none.scene""#];
    assert!(done.code == 1 && parts.iter().all(|part| done.out.contains(part)), "{done:?}");
}

#[cfg(unix)]
#[test]
fn links_and_permissions_stay() {
    use std::os::unix::fs::{PermissionsExt, symlink};

    let folder = Folder::new("fmt-link").with("real/a.scene", CROOKED);
    symlink("real/a.scene", folder.path("link.scene")).unwrap();
    let real = folder.path("real/a.scene");
    std::fs::set_permissions(&real, PermissionsExt::from_mode(0o640)).unwrap();
    assert_eq!(folder.luxel(&["fmt", "link.scene"]).code, 0);
    assert!(folder.path("link.scene").is_symlink());
    assert_eq!(folder.read("real/a.scene"), STRAIGHT.as_bytes());
    assert_eq!(std::fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o640);
    std::fs::set_permissions(&real, PermissionsExt::from_mode(0o440)).unwrap();
    folder.write("b.scene", CROOKED);
    std::fs::set_permissions(folder.path("b.scene"), PermissionsExt::from_mode(0o440)).unwrap();
    let done = folder.luxel(&["fmt", "b.scene"]);
    assert!(done.code == 1 && done.err.contains("cannot write `b.scene`: "), "{done:?}");
}

#[cfg(unix)]
#[test]
fn standard_input_comes_out_laid_out() {
    let folder = Folder::new("fmt-stream").with("a.scene", CROOKED).with("wrong.scene", WRONG);
    let done = folder.luxel_under("exec < a.scene", &["fmt", "-"]);
    assert_eq!((done.code, &*done.out, &*done.err), (0, STRAIGHT, ""));
    let done = folder.luxel_under("exec < wrong.scene", &["fmt", "-"]);
    assert!(done.code == 1 && done.out.is_empty(), "{done:?}");
    assert!(done.err.contains("standard input:2"), "{done:?}");
    let done = folder.luxel_under("exec < a.scene", &["fmt", "--check", "-"]);
    assert_eq!((done.code, &*done.out), (1, "standard input: not laid out\n"));
    let done = folder.luxel_under("exec < a.scene", &["fmt", "-", "-"]);
    assert!(done.code == 2 && done.err.contains("laid out once"), "{done:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_between_two_files_leaves_the_second_as_it_was() {
    let folder = Folder::new("fmt-left").with("a.scene", CROOKED).with("b.scene", CROOKED);
    let mut child = folder.talk(&["fmt", "a.scene", "-", "b.scene"]);
    let input = child.stdin.take();
    let moment = || std::thread::sleep(std::time::Duration::from_millis(10));
    // Once the first is written it waits for its input.
    while folder.read("a.scene") != STRAIGHT.as_bytes() {
        moment();
    }
    let id = child.id().to_string();
    let kill = std::process::Command::new("kill").args(["-INT", &id]).status();
    assert!(kill.unwrap().success());
    // Ten seconds, where it takes a fifth of one.
    let left = (0..1000).any(|_| {
        moment();
        child.try_wait().unwrap().is_some()
    });
    drop(input);
    assert_eq!((left, child.wait().unwrap().code()), (true, Some(3)));
    assert_eq!(folder.read("b.scene"), CROOKED.as_bytes());
}

#[cfg(unix)]
#[test]
fn pipes_and_folders_are_no_scenes() {
    let folder = Folder::new("fmt-pipe").with("sub/a.scene", STRAIGHT);
    let done = folder.luxel_under("mkfifo pipe.scene", &["fmt", "pipe.scene", "sub"]);
    for part in
        ["pipe.scene: it cannot be read: it is not a regular", "sub: it cannot be read: it is a"]
    {
        assert!(done.code == 1 && done.err.contains(part), "{done:?}");
    }
}
