//! `luxel plugin test` as a person runs it.

use super::program::Folder;

#[test]
fn a_plugin_is_judged_and_the_checks_are_told() {
    let done = Folder::new("judge").luxel(&["plugin", "test", "filter", "box"]);
    assert_eq!((done.code, done.err.as_str()), (0, ""), "{done:?}");
    let first = done.out.lines().next().unwrap_or_default();
    let heads: Vec<_> = first.split_whitespace().collect();
    assert_eq!(heads, ["kind", "class", "check", "verdict", "figure", "limit"]);
    assert!(done.out.contains("integrates to 1 "), "{done:?}");
    let rows = done.out.lines().filter(|line| line.starts_with("filter     box ")).count();
    let last = done.out.lines().last().unwrap_or_default();
    assert!(last.starts_with("1 class in "), "{last}");
    assert!(rows > 5 && last.ends_with(&format!(": {rows} checks passed, 0 failed")), "{done:?}");
}

#[test]
fn a_report_as_json_depends_on_the_seed_alone() {
    let folder = Folder::new("judge-json");
    let report = |seed| {
        let done = folder.luxel(&["plugin", "test", "filter", "box", "--json", "--seed", seed]);
        assert_eq!((done.code, done.out.lines().count()), (0, 1), "{done:?}");
        done.out
    };
    let found = report("7");
    for part in
        [r#""complete":true"#, r#""classes":1,"#, r#""failed":0"#, r#""seed":7"#, r#""rows":[{"#]
    {
        assert!(found.contains(part), "{part} in {found}");
    }
    assert_eq!(found, report("7"));
    assert_ne!(found.replace(r#""seed":7"#, r#""seed":8"#), report("8"));
}

#[test]
fn an_injected_fault_is_caught_and_told_with_the_check() {
    let folder = Folder::new("mutants");
    let done = folder.luxel(&["plugin", "test", "filter", "narrow", "--mutants"]);
    assert_eq!(done.code, 0, "{done:?}");
    let narrow = done.out.lines().find(|line| line.starts_with("filter narrow "));
    assert!(narrow.is_some_and(|line| line.contains("samples follow their pdf")), "{done:?}");
    assert_eq!(done.out.lines().last(), Some("1 of 1 fault caught"), "{done:?}");
    let json = folder.luxel(&["plugin", "test", "filter", "narrow", "--mutants", "--json"]);
    assert_eq!((json.code, json.out.lines().count()), (0, 1), "{json:?}");
    for part in [r#""caught":1,"#, r#""total":1}"#, r#""class":"filter narrow""#, r#""by":["#] {
        assert!(json.out.contains(part), "{part} in {json:?}");
    }
}

#[test]
fn what_cannot_be_judged_is_wrong_use_and_names_the_nearest() {
    let folder = Folder::new("judge-usage");
    for (args, told) in [
        (&["filtr"][..], "did you mean `filter`"),
        (&["filter", "bx"], "did you mean `box`"),
        (&["film"], "nothing to judge"),
        (&["group"], "a word of the language"),
        (&["asset", "--mutants"], "nothing to judge"),
        (&["filter", "--seed", "x"], "--seed"),
    ] {
        let done = folder.luxel(&[&["plugin", "test"], args].concat());
        assert!(done.code == 2 && done.err.contains(told), "{args:?}: {done:?}");
    }
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_between_classes_with_what_was_judged() {
    let mut running = Folder::new("judge-interrupt").start(&["plugin", "test"]);
    // Judging every class takes many times as long.
    std::thread::sleep(std::time::Duration::from_millis(700));
    running.interrupt();
    let done = running.end();
    assert_eq!(done.code, 3, "{done:?}");
    assert!(done.out.contains("\nshape "), "{done:?}");
    assert!(done.out.contains("\ninterrupted: "), "{done:?}");
}
