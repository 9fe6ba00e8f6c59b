//! `luxel plugin test` of plugins that crash or never end.
#![cfg(unix)]

use super::faulty;
use super::program::{Done, Folder};

fn judge(fault: &str, more: &[&str]) -> Done {
    let folder = Folder::new("judge-faulty");
    let library = faulty::build(&folder, fault);
    folder.luxel(&[&["plugin", "test", &library, "--json"][..], more].concat())
}

/// The check that a judge in a process of its own adds.
fn fails_to_end(done: &Done, why: &str) {
    let row = r#""check":"ends by itself","class":"faulty""#;
    for part in [row, why, r#""failed":1"#, r#""kind":"material""#] {
        assert!(done.code == 1 && done.out.contains(part), "{part}: {done:?}");
    }
}

#[test]
fn a_crash_and_an_endless_loop_are_failed_checks() {
    let crashed = judge(faulty::WRITE_TO_NOWHERE, &["--isolate"]);
    fails_to_end(&crashed, "was killed by signal 11 (SIGSEGV)");
    let left = judge(faulty::LEAVE, &["--isolate"]);
    fails_to_end(&left, "ended the process, with code 0");
    let endless = judge(faulty::NEVER_END, &["--isolate", "--patience", "1"]);
    fails_to_end(&endless, "never ends: nothing moved for 1 s");
}

#[test]
fn the_command_that_is_printed_judges_the_library_again() {
    let folder = Folder::new("judge-again");
    let library = faulty::build(&folder, faulty::PANIC_AT_THE_THIRD);
    let told = format!("failed: luxel plugin test {library} material faulty --isolate");
    let done = folder.luxel(&["plugin", "test", &library, "--isolate"]);
    let last = done.out.lines().last().unwrap_or_default();
    assert_eq!(last, told, "{done:?}");
    let words: Vec<_> = last["failed: luxel ".len()..].split(' ').collect();
    assert_eq!(folder.luxel(&words).out.lines().last(), Some(last));
}

#[test]
fn a_name_of_no_built_in_tells_how_libraries_are_judged() {
    let folder = Folder::new("judge-unknown");
    let library = faulty::build(&folder, faulty::NOTHING);
    let place = std::path::Path::new(&library).parent().unwrap().to_str().unwrap();
    let done = folder.luxel(&["plugin", "test", "material", "faulty", "--plugin-dir", place]);
    for part in ["no material `faulty`", "not trusted: luxel plugin trust", "luxel plugin test t"] {
        assert!(done.code == 2 && done.err.contains(part), "{part}: {done:?}");
    }
}

#[test]
fn a_panic_is_a_failed_check_with_or_without_a_process_apart() {
    for more in [&[][..], &["--isolate"]] {
        let done = judge(faulty::PANIC_AT_THE_THIRD, more);
        let failed = done.code == 1 && done.out.contains(r#""verdict":"fail""#);
        let row = r#""check":"never panics","class":"faulty","detail":"as by default"#;
        assert!(failed && done.out.contains("panicked") && done.out.contains(row), "{done:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn an_object_that_leaves_memory_behind_is_a_failed_check() {
    let folder = Folder::new("judge-leak");
    let library = faulty::build_with(&folder, faulty::NOTHING, faulty::LEAK, "");
    let done = folder.luxel(&["plugin", "test", &library]);
    let check =
        |text: &str| text.contains("created and dropped 10^4 times") && text.contains("FAIL");
    assert!(done.code == 1 && done.out.lines().any(check), "{done:?}");
    assert!(done.out.contains("bytes stay of each object"), "{done:?}");
    faulty::build(&folder, faulty::NOTHING);
    let fine = folder.luxel(&["plugin", "test", &library]);
    assert!(!fine.out.lines().any(check) && fine.out.contains("10^4 times"), "{fine:?}");
}

#[test]
fn a_library_that_crashes_when_it_is_opened_is_told() {
    let folder = Folder::new("judge-open");
    let opened = "__attribute__((constructor)) static void now(void) { abort(); }";
    let library = faulty::build_with(&folder, faulty::NOTHING, "", opened);
    let done = folder.luxel(&["plugin", "test", &library, "--isolate"]);
    let told = ["SIGABRT", "while opening plugin libraries", library.as_str()];
    assert!(done.code == 1 && told.iter().all(|part| done.err.contains(part)), "{done:?}");
}

#[test]
fn a_process_apart_finds_what_is_found_here_and_that_it_ends() {
    let folder = Folder::new("judge-apart");
    let here = folder.luxel(&["plugin", "test", "filter", "box"]);
    let apart = folder.luxel(&["plugin", "test", "filter", "box", "--isolate"]);
    assert_eq!((here.code, apart.code), (0, 0), "{here:?} {apart:?}");
    // Without the limits of statistics, which depend on how many are compared.
    let rows = |done: &Done| -> Vec<String> {
        let rows = done.out.lines().filter(|line| line.starts_with("filter"));
        rows.map(|line| line[..83].to_owned()).collect()
    };
    let (rows, more) = (rows(&here), rows(&apart));
    assert!(rows.len() > 5 && more[..rows.len()] == rows[..], "{rows:#?} {more:#?}");
    assert!(more.len() == rows.len() + 1 && more[rows.len()].contains("ends by itself"));
    let usage = folder.luxel(&["plugin", "test", "--mutants", "--isolate"]);
    assert_eq!(usage.code, 2, "{usage:?}");
    let unknown = folder.luxel(&["plugin", "test", "filter", "bx", "--isolate"]);
    assert!(unknown.code == 2 && unknown.err.contains("did you mean"), "{unknown:?}");
}
