//! Plugins that fail, and what `--isolate` makes of it.
#![cfg(unix)]

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use super::faulty::{self, OPEN};
use super::program::{Done, Folder, Running, SCENE};
use super::until;

fn folder(name: &str, fault: &str) -> Folder {
    let folder = Folder::new(name).with("a.scene", &faulty::scene());
    faulty::build(&folder, fault);
    folder
}

fn render(folder: &Folder, more: &[&str]) -> Done {
    folder.luxel(&[&["render", "a.scene"][..], &OPEN, more].concat())
}

fn watch(folder: &Folder, more: &[&str]) -> Running {
    folder.start(&[&["watch", "a.scene", "--spp", "8"][..], &OPEN, more].concat())
}

/// Nothing beside the scene and the library.
fn left_nothing(folder: &Folder) {
    assert_eq!(folder.names(), ["a.scene", "plugins"]);
}

#[test]
fn a_plugin_that_fails_is_told_with_the_line_that_made_it_and_leaves_no_picture() {
    let folder = folder("failed", faulty::PANIC_AT_THE_THIRD);
    let done = render(&folder, &[]);
    assert_eq!(done.code, 1, "{done:?}");
    for part in ["error[E0421]", "faulty", "a.scene:9:", "shape sphere", "this object"] {
        assert!(done.err.contains(part), "{part}: {done:?}");
    }
    let json = render(&folder, &["--json"]);
    assert!(json.code == 1 && json.out.is_empty(), "{json:?}");
    assert!(json.err.contains(r#""code":"E0421""#) && json.err.contains(r#""line":9"#), "{json:?}");
    let apart = render(&folder, &["--isolate"]);
    assert_eq!((apart.code, apart.err), (1, done.err));
    left_nothing(&folder);
}

#[test]
fn a_watch_tells_a_failed_plugin_and_the_next_save_makes_it_anew() {
    for more in [&[][..], &["--isolate"], &["--json"]] {
        let folder = folder("failed-watch", faulty::PANIC_AT_THE_THIRD);
        let mut watching = watch(&folder, more);
        // A library counts for as long as it is open: the object that is made anew works.
        std::thread::sleep(Duration::from_millis(700));
        left_nothing(&folder);
        if more.contains(&"--isolate") {
            faulty::build(&folder, faulty::NOTHING);
        } else {
            folder.write("a.scene", &format!("{}// saved\n", faulty::scene()));
        }
        until("the picture", || !folder.read("a.exr").is_empty());
        watching.interrupt();
        let done = watching.end();
        // Once, beside the line that says how to read more of it.
        let told = done.err.replace("luxel explain E0421", "");
        assert!(done.code == 0 && told.matches("E0421").count() == 1, "{done:?}");
        let place = if more.contains(&"--json") { r#""line":9"# } else { "shape sphere" };
        assert!(done.err.contains(place), "{done:?}");
        assert!(!more.contains(&"--json") || done.out.starts_with('{'), "{done:?}");
    }
}

#[test]
fn what_does_not_look_whether_it_is_wanted_is_left_for_the_next_save() {
    let folder = Folder::new("left").with("a.scene", &faulty::scene());
    faulty::build_with(&folder, faulty::NOTHING, faulty::WAIT, "");
    let mut watching = watch(&folder, &[]);
    until("an object that takes its time", || folder.names().contains(&"begun".to_owned()));
    folder.write("a.scene", SCENE);
    until("the picture of another scene", || !folder.read("a.exr").is_empty());
    folder.write("go", "");
    watching.interrupt();
    let done = watching.end();
    assert!(done.code == 0 && !done.err.contains("error"), "{done:?}");
}

#[test]
fn the_same_bytes_come_from_a_process_apart() {
    let folder = Folder::new("apart").with("a.scene", SCENE);
    for (name, more) in [("here", None), ("apart", Some("--isolate"))] {
        let args = ["render", "a.scene", "-o", name].into_iter().chain(more).collect::<Vec<_>>();
        let done = folder.luxel(&args);
        assert!(done.code == 0 && done.err.is_empty() && done.out.contains("wrote"), "{done:?}");
    }
    assert_eq!(folder.read("here.exr"), folder.read("apart.exr"));
    assert_eq!(folder.read("here.png"), folder.read("apart.png"));
    folder.write("a.scene", &SCENE.replace("radius", "radus"));
    let wrong = folder.luxel(&["render", "a.scene", "--isolate"]);
    assert!(wrong.code == 1 && wrong.err.contains("E0402"), "{wrong:?}");
}

#[test]
fn a_plugin_that_crashes_or_leaves_costs_a_message() {
    for (fault, told) in [
        (faulty::WRITE_TO_NOWHERE, "killed by signal 11 (SIGSEGV)"),
        (faulty::ABORT, "killed by signal 6 (SIGABRT)"),
        (faulty::LEAVE, "ended the process, with code 0"),
    ] {
        let folder = folder("crash", fault);
        let done = render(&folder, &["--isolate"]);
        assert_eq!(done.code, 1, "{done:?}");
        for part in [told, "`a.scene`", "while rendering", "faulty 0.1.0"] {
            assert!(done.err.contains(part), "{part}: {done:?}");
        }
        left_nothing(&folder);
    }
}

#[test]
fn a_library_that_crashes_while_it_is_opened_is_named() {
    let folder = Folder::new("crash-open").with("a.scene", &faulty::scene());
    let opened = "__attribute__((constructor)) static void now(void) { abort(); }";
    faulty::build_with(&folder, faulty::NOTHING, "", opened);
    let done = render(&folder, &["--isolate"]);
    let told = ["SIGABRT", "while opening plugin libraries", "libfaulty"];
    assert!(done.code == 1 && told.iter().all(|part| done.err.contains(part)), "{done:?}");
}

#[test]
fn a_plugin_that_never_ends_is_ended_and_says_in_what() {
    let folder = folder("endless", faulty::NEVER_END);
    let since = Instant::now();
    let done = render(&folder, &["--isolate", "--patience", "1", "--json"]);
    assert!(since.elapsed() < Duration::from_secs(8));
    assert_eq!(done.code, 1, "{done:?}");
    for part in ["never ends: nothing moved for 1 s while rendering", r#""code":"E0421""#] {
        assert!(done.err.contains(part), "{part}: {done:?}");
    }
    left_nothing(&folder);
    let usage = folder.luxel(&["render", "a.scene", "--patience", "1"]);
    assert_eq!(usage.code, 2, "{usage:?}");
}

#[test]
fn an_interrupt_reaches_the_process_apart() {
    let folder = Folder::new("apart-interrupt").with("a.scene", SCENE);
    let mut running = folder.start(&["render", "a.scene", "--spp", "4000000000", "--isolate"]);
    std::thread::sleep(Duration::from_millis(900));
    running.interrupt();
    let done = running.end();
    assert!(done.code == 3 && done.out.contains("interrupted after"), "{done:?}");
    assert_eq!(folder.names(), ["a.checkpoint", "a.exr", "a.png", "a.scene"]);
}

#[test]
fn a_process_that_does_not_hear_an_interrupt_is_ended() {
    let folder = folder("deaf", faulty::NEVER_END);
    let mut running = folder.start(&[&["render", "a.scene", "--isolate"][..], &OPEN].concat());
    std::thread::sleep(Duration::from_millis(900));
    let since = Instant::now();
    running.interrupt();
    let done = running.end();
    assert!(since.elapsed() < Duration::from_secs(6));
    assert!(done.code == 3 && done.err.contains("did not stop"), "{done:?}");
    left_nothing(&folder);
}

#[cfg(target_os = "linux")]
#[test]
fn no_process_outlives_its_parent() {
    let folder = folder("orphan", faulty::NEVER_END);
    let running = folder.start(&[&["render", "a.scene", "--isolate"][..], &OPEN].concat());
    let own = folder.path("").canonicalize().unwrap();
    // Processes are told apart by the folder in which they run.
    let here = || {
        let all = std::fs::read_dir("/proc").unwrap().flatten();
        let cwd = |entry: std::fs::DirEntry| std::fs::read_link(entry.path().join("cwd")).ok();
        all.filter_map(cwd).filter(|cwd| *cwd == own).count()
    };
    until("both processes", || here() == 2);
    std::thread::sleep(Duration::from_millis(300));
    // Dropping kills it, and it cannot know.
    drop(running);
    until("the child's end", || here() == 0);
}

#[test]
fn a_watch_outlives_a_crash_and_renders_what_is_built_next() {
    let folder = folder("watch-crash", faulty::NOTHING);
    let mut watching = watch(&folder, &["--isolate"]);
    until("the first picture", || !folder.read("a.exr").is_empty());
    let first = folder.read("a.exr");

    faulty::build(&folder, faulty::WRITE_TO_NOWHERE);
    std::thread::sleep(Duration::from_millis(900));
    assert_eq!(folder.read("a.exr"), first, "the last picture stays");
    let brighter = faulty::scene().replace("scale = 1", "scale = 2");
    faulty::build(&folder, faulty::NOTHING);
    folder.write("a.scene", &brighter);
    until("a new picture", || folder.read("a.exr") != first);
    watching.interrupt();
    let done = watching.end();
    assert_eq!(done.code, 0, "{done:?}");
    assert!(done.err.contains("killed by signal 11 (SIGSEGV)"), "{done:?}");
}

/// What the page at an address says to whoever opens it, as far as it is text.
fn said(port: u16, token: &str) -> String {
    let Ok(mut socket) = TcpStream::connect(("127.0.0.1", port)) else { return String::new() };
    let wait = Duration::from_millis(300);
    socket.set_read_timeout(Some(wait)).unwrap();
    let key = "dGhlIHNhbXBsZSBub25jZQ==";
    let ask = format!(
        "GET /ws?token={token} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: Upgrade\r\n\
         Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n"
    );
    let mut heard = vec![];
    // It goes on telling: what came until it pauses is what there was to say.
    let _ = socket.write_all(ask.as_bytes()).and_then(|()| socket.read_to_end(&mut heard));
    String::from_utf8_lossy(&heard).into_owned()
}

#[test]
fn a_page_outlives_a_crash_at_its_address_and_tells_it() {
    const TOLD: &str = "killed by signal 11 (SIGSEGV)";
    let folder = folder("page-crash", faulty::NOTHING);
    let mut watching = watch(&folder, &["--isolate", "--preview", "--no-open"]);
    let (port, token) = watching.page();
    until("the first picture", || !folder.read("a.exr").is_empty());
    let first = folder.read("a.exr");
    let before = said(port, &token);
    assert!(before.contains("101 Switching") && !before.contains(TOLD), "{before}");

    faulty::build(&folder, faulty::WRITE_TO_NOWHERE);
    until("the crash on the page", || said(port, &token).contains(TOLD));
    assert!(!said(port, "0").contains("101 Switching"), "the token is asked for as before");
    assert_eq!(folder.read("a.exr"), first, "the last picture stays");

    let brighter = faulty::scene().replace("scale = 1", "scale = 2");
    faulty::build(&folder, faulty::NOTHING);
    folder.write("a.scene", &brighter);
    until("a new picture", || folder.read("a.exr") != first);
    until("the page without the crash", || !said(port, &token).contains(TOLD));
    watching.interrupt();
    assert_eq!(watching.end().code, 0);
}

#[test]
fn a_command_after_a_picture_runs_as_outside() {
    let folder = Folder::new("apart-exec").with("a.scene", SCENE);
    let told = "printenv LUXEL_ISOLATED TMPDIR > told; test -s \"$LUXEL_EXR\" && echo > done";
    let done = folder.luxel_in(
        &[("TMPDIR", &folder.path("").to_string_lossy())],
        &["watch", "a.scene", "--isolate", "--once-stable", "--exec", told],
    );
    assert_eq!(done.code, 0, "{done:?}");
    let own = folder.path("").to_string_lossy().into_owned();
    assert_eq!(String::from_utf8(folder.read("told")).unwrap().trim_end(), own);
    assert_eq!(folder.names(), ["a.exr", "a.png", "a.scene", "done", "told"]);
}

#[test]
fn a_save_during_an_endless_loop_is_rendered() {
    let folder = folder("watch-endless", faulty::NEVER_END);
    let mut watching = watch(&folder, &["--isolate"]);
    std::thread::sleep(Duration::from_millis(700));
    faulty::build(&folder, faulty::NOTHING);
    until("the picture", || !folder.read("a.exr").is_empty());
    watching.interrupt();
    let done = watching.end();
    assert_eq!(done.code, 0, "{done:?}");
}
