//! Inputs that are meant to hurt: each gets its mistake, in bounded time, memory and stack.

use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

use luxel_core::files::MemoryFiles;
use luxel_lang::{Budgets, Loaded, Settings, load};

use crate::damage::damaged;
use crate::plant::Dice;
use crate::registry::registry;
use crate::told;

/// Loads a text on a thread with the stack that `load` promises to do with; fails after 20 s.
fn load_bytes(bytes: Vec<u8>, budgets: Budgets) -> Loaded {
    let files = MemoryFiles::default().with("a.scene", bytes);
    load_files(files, budgets)
}

fn load_files(files: MemoryFiles, budgets: Budgets) -> Loaded {
    let (send, receive) = std::sync::mpsc::channel();
    let loading = move || {
        let settings = Settings { budgets, ..Settings::default() };
        let loaded = load(Path::new("a.scene"), &files, &registry(), &settings);
        send.send(loaded).expect("the test waits");
    };
    std::thread::Builder::new().stack_size(2 << 20).spawn(loading).expect("a thread can be made");
    receive.recv_timeout(Duration::from_secs(20)).expect("it ends, and soon")
}

fn codes(text: &str) -> Vec<&'static str> {
    codes_within(text, Budgets::default())
}

fn codes_within(text: &str, budgets: Budgets) -> Vec<&'static str> {
    let loaded = load_bytes(format!("scene 1\n{text}").into_bytes(), budgets);
    loaded.diagnostics.iter().map(|d| d.code).collect()
}

#[test]
fn brackets_nest_up_to_the_limit_and_no_further() {
    let nested = |open: &str, close: &str, n: usize| {
        format!("let deep = {}1{}", open.repeat(n), close.repeat(n))
    };
    for (open, close) in [("(", ")"), ("[", "]"), ("(1 + 2 * -", ")"), ("{ x = ", " }")] {
        assert_eq!(codes(&nested(open, close, 128)), ["E0409"], "{open}");
        assert_eq!(codes(&nested(open, close, 129)), ["E0011"], "{open}");
    }
    let worst = nested("(1 == 1..2 + 3 * -2 ^ -", ")", 128);
    assert!(!codes(&worst).is_empty());
    let objects = nested("material coated { base = ", " }", 128);
    assert_eq!(codes(&objects), ["E0214", "E0409"]);
    let groups = format!("{} {}", "group { ".repeat(128), "}".repeat(128));
    assert_eq!(codes(&groups), ["E0409"]);
    let ifs = nested("if true { ", " } else { 2 }", 128);
    assert_eq!(codes(&ifs), ["E0409"]);
}

#[test]
fn a_line_of_ten_megabytes_is_read_or_told_of() {
    let list = format!("let long = [{}1]", "0.25, ".repeat(1_700_000));
    assert_eq!(codes(&list), ["E0409"]);
    let chain = format!("let long = 1{}", " + 1".repeat(10_000));
    assert_eq!(codes(&chain), ["E0506"]);
    let calls = format!("let long = sin{}", "(1)".repeat(10_000));
    assert_eq!(codes(&calls), ["E0506"]);
    let signs = format!("let long = {}1", "-!".repeat(10_000));
    assert_eq!(codes(&signs), ["E0506"]);
    let string = format!("let long = \"{}\"", "x".repeat(1_100_000));
    assert_eq!(codes(&string), ["E0509"]);
    let unclosed = format!("let long = ({}", "a ".repeat(1_000_000));
    assert!(!codes(&unclosed).is_empty());
}

#[test]
fn what_makes_much_of_a_short_text_is_told_soon() {
    let check = |text: &str, code: &str| assert_eq!(codes(text)[0], code, "{}", &text[..40]);
    // Each took gigabytes or minutes before it was bounded.
    check(&"}".repeat(2_000_000), "E0010");
    check(&"[)".repeat(1_000_000), "E0009");
    check(&format!("let a = {}", "b".repeat(5_000_000)), "E0509");
    let names = format!("let {0} = 1\nlet b = {0}c", "a".repeat(1_000_000));
    check(&names, "E0101");
    check(&format!("let a = b{}", ".a".repeat(1_000_000)), "E0510");
    check(&format!("let a = [{}]", "x, ".repeat(1_000_000)), "E0510");
    check(&"x ".repeat(1_000_000), "E0510");
    check(&format!("let a = \"{}\"", "x".repeat(5_000_000)), "E0509");
    check("let a = [for i in 0..10000000 => \"a\"]", "E0503");
    let unknown: Vec<_> = (0..100_000).map(|i| format!("let a{i} = nope{i}")).collect();
    check(&unknown.join("\n"), "E0101");
    let records = (1..3000).map(|i| format!("let r{i} = r{} with {{ a{i} = 1 }}\n", i - 1));
    let text = format!("let r0 = {{ a = 1 }}\n{}", records.collect::<String>());
    check(&text, "E0503");
}

#[test]
fn loops_lists_and_nodes_end_at_their_budgets() {
    let small =
        Budgets { steps: 100_000, nodes: 1000, list: 1000, names: 1000, ..Budgets::default() };
    let check = |text: &str, code: &str| assert_eq!(codes_within(text, small), [code], "{text}");
    check("for i in 0..1000000000 { let a = i }", "E0502");
    check("for i in 0..1000000 { for j in 0..1000000 { } }", "E0502");
    check("let list = [for i in 0..100000 => i]", "E0503");
    let names: Vec<_> = (0..1001).map(|i| format!("let a{i} = 1")).collect();
    check(&names.join("\n"), "E0511");
    check("let list = [for i in 0..100000 if true => i]", "E0503");
    check("for i in 0..100000 { shape sphere { radius = 1 m } }", "E0501");
    // Lists that share their items: 2^40 comparisons of 40 short statements.
    let doubled: Vec<_> = (0..40).map(|i| format!("let x{} = [x{i}, x{i}]", i + 1)).collect();
    let doubled = doubled.join("\n");
    check(&format!("let x0 = [true]\n{doubled}\nlet same = x40 == x40"), "E0502");
    let list = format!("let list = [{}]", "1, ".repeat(1001));
    check(&list, "E0503");
}

#[test]
fn a_large_file_gives_the_scene_of_a_small_one() {
    let text = include_str!("../scenes/parametric.scene");
    let small = load_bytes(text.as_bytes().to_vec(), Budgets::default());
    let spheres = "@off shape sphere { radius = 1 m }\n".repeat(40_000);
    let large = load_bytes(format!("{text}\n{spheres}").into_bytes(), Budgets::default());
    assert_eq!(large.diagnostics, small.diagnostics);
    assert_eq!(large.scene.expect("it has no mistake"), small.scene.expect("it has no mistake"));
}

/// The same, so long that its lines are read in different turns.
fn padded(text: &str) -> String {
    let padding = format!("//{}\n", "x".repeat((3 << 20) / text.lines().count()));
    text.lines().flat_map(|line| [line, "\n", &padding]).collect()
}

#[test]
fn the_lines_of_a_large_file_mean_what_they_mean_in_a_small_one() {
    let mixed = "scene 1\nfn double(x: length) = x * 2\nlet size = double(3)\n\
        set ball.radius = size * 2\nlet other = shape sphere { radius = size }\n\
        units { length = mm }\nshape sphere \"ball\" { radius = size }\n\
        @off shape sphere \"ball\" { radius = 1 }\n\
        for i in 0..3 { group \"g\" { shape sphere { radius = size * (i + 1) } } }\nplace other\n\
        camera perspective {\nlook = look_at(from = (0, 0, 5), to = (0, 0, 0), up = (0, 1, 0))\n\
        fov = 40 deg\n}\n";
    let texts = [
        mixed,
        &mixed.replace("size * 2", "nope").replace("3 {", "3\n"),
        "scene 1\nfor i in 0..3\nunits { length = mm }\n}\nlet a: length = 5\n",
        include_str!("../scenes/parametric.scene"),
        include_str!("../scenes/glass_fog.scene"),
        include_str!("../scenes/cornell.scene"),
    ];
    let mut n_scenes = 0;
    for text in texts {
        let [small, large] = [text.to_owned(), padded(text)]
            .map(|text| load_bytes(text.into_bytes(), Budgets::default()));
        let said = |loaded: &Loaded| -> Vec<_> {
            loaded.diagnostics.iter().map(|d| (d.code, d.message.clone())).collect()
        };
        assert_eq!(said(&large), said(&small), "{text}");
        let hash = |loaded: &Loaded| loaded.scene.as_ref().map(luxel_core::scene::Scene::hash);
        assert_eq!(hash(&large), hash(&small), "{text}");
        n_scenes += usize::from(small.scene.is_some());
    }
    assert_eq!(n_scenes, 2);
}

#[test]
fn any_number_of_warnings_ends_nothing() {
    let warned = format!("scene 1\n{}", "group {\n/// d\n}\n".repeat(150));
    for (rest, n_errors) in [("", 0), ("let a = 1 m + 1 deg\n", 1)] {
        let text = format!(
            "{warned}{rest}camera perspective {{ look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg }}\n"
        );
        for text in [padded(&text), text] {
            let loaded = load_bytes(text.into_bytes(), Budgets::default());
            let errors = loaded.diagnostics.iter().filter(|found| found.is_error());
            assert_eq!(errors.count(), n_errors);
            let n_items = loaded.scene.map(|scene| scene.root.items.len());
            assert_eq!(n_items, (n_errors == 0).then_some(150));
        }
    }
}

#[test]
fn shared_groups_count_as_often_as_they_stand() {
    let mut text = "let g0 = group { shape sphere { radius = 1 m } }\n".to_owned();
    for i in 1..40 {
        let _ = writeln!(text, "let g{i} = group {{ for j in 0..10 {{ place g{} }} }}", i - 1);
    }
    assert_eq!(codes(&format!("{text}place g39")), ["E0501"]);
}

#[test]
fn chains_of_functions_objects_and_groups_are_bounded() {
    let chain = |first: &str, next: &dyn Fn(usize) -> String| {
        let mut text = first.to_owned();
        (1..2000).for_each(|i| text += &next(i));
        codes(&text)
    };
    let calls = chain("fn f0(x: int) = x\n", &|i| {
        format!("fn f{i}(x: int) = f{}(x)\nlet x{i} = f{i}(1)\n", i - 1)
    });
    assert_eq!(calls, ["E0507"]);
    let objects = chain("let o0 = material diffuse {}\n", &|i| {
        format!("let o{i} = material coated {{ base = o{} }}\n", i - 1)
    });
    assert_eq!(objects, ["E0507"]);
    let groups =
        chain("let g0 = group {}\n", &|i| format!("let g{i} = group {{ place g{} }}\n", i - 1));
    assert_eq!(groups, ["E0507"]);
}

#[test]
fn files_are_bounded_in_size_and_depth() {
    let small = Budgets { file_bytes: 1000, ..Budgets::default() };
    assert_eq!(codes_within(&" ".repeat(2000), small), ["E0504"]);
    let mut files = MemoryFiles::default().with("a.scene", &b"scene 1\ninclude \"0\""[..]);
    for i in 0..60 {
        files = files.with(format!("{i}"), format!("scene 1\ninclude \"{}\"", i + 1).into_bytes());
    }
    let loaded = load_files(files, Budgets::default());
    assert_eq!(loaded.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["E0505"]);
}

#[test]
fn files_that_each_include_the_next_twice_end_at_the_budget() {
    let mut files = MemoryFiles::default();
    for level in 0..30 {
        let next = format!("include \"{}.scene\"\n", level + 1).repeat(2);
        files = files.with(format!("{level}.scene"), format!("scene 1\n{next}").into_bytes());
    }
    let files = files.with("30.scene", &b"scene 1"[..]);
    let loaded = load(Path::new("0.scene"), &files, &registry(), &Settings::default());
    assert_eq!(loaded.diagnostics.iter().map(|d| d.code).collect::<Vec<_>>(), ["E0505"]);
}

#[test]
fn bytes_that_are_no_text_are_told_of() {
    let loaded = load_bytes(b"scene 1\nlet a = \xff".to_vec(), Budgets::default());
    assert_eq!(loaded.diagnostics[0].code, "E0003");
    assert_eq!(loaded.diagnostics[0].span().unwrap().range(), 16..16);
    let marked = b"\xEF\xBB\xBFscene 1\nlet abc = def".to_vec();
    let found: Vec<_> =
        load_bytes(marked, Budgets::default()).diagnostics.iter().map(|d| d.code).collect();
    assert_eq!(found, ["E0004", "E0101", "E0409"]);
}

#[test]
fn a_hundred_mistakes_are_shown_and_the_rest_counted() {
    let text: Vec<String> = (0..1000).map(|i| format!("let a{i} = nope_{i}")).collect();
    let found = codes(&text.join("\n"));
    assert_eq!((found.len(), found[99], found[100]), (101, "E0101", "E0508"));
}

#[test]
fn damaged_scenes_never_crash_and_point_into_their_text() {
    let seeds = [
        include_str!("../scenes/parametric.scene"),
        include_str!("../scenes/glass_fog.scene"),
        include_str!("../scenes/bad_multi.scene"),
    ];
    let words = ["{", "}", "(", "\"", "é", "/*", "#[", "1e999"];
    let budgets = Budgets { steps: 20_000, ..Budgets::default() };
    let registry = registry();
    let mut dice = Dice(7);
    for round in 0..150 {
        let text = damaged(seeds[round % seeds.len()], &words, &mut |n| dice.below(n));
        let files = MemoryFiles::default().with("a.scene", text.into_bytes());
        let settings = Settings { budgets, ..Settings::default() };
        told::holds(&load(Path::new("a.scene"), &files, &registry, &settings));
    }
}
