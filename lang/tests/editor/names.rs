//! Definitions, references and new names.

use crate::{marked, shown};
use luxel_lang::editor::{definition, references, renamable, rename};

fn defined(files: &[(&str, &str)], expected: &str) {
    let (files, path, at) = marked(files);
    let found = definition(&files, &path, at).map(|place| shown(&files, &place));
    assert_eq!(found.as_deref().unwrap_or("nowhere"), expected);
}

#[test]
fn a_name_is_defined_in_the_innermost_block_around_it() {
    let one = |text: &str, expected| defined(&[("a", text)], expected);
    one("scene 1\nlet r = 1 m\nshape sphere { radius = |r }", "a:2:r");
    one("scene 1\nlet i = 1\nfor i in 0..3 { shape sphere { radius = i| * 1 m } }", "a:3:i");
    one("scene 1\nlet i = 1\nlet l = [for i in 0..3 => |i]", "a:3:i");
    one("scene 1\nlet i = 1\nlet l = [for j in 0..|i => j]", "a:2:i");
    one("scene 1\nfn f(x: float) = x\nlet y = f(|x = 2)", "a:2:x");
    one("scene 1\nlet y = |f(2)\nfn f(x: float) = x", "a:3:f");
    one("scene 1\nlet y = |sin(2)", "nowhere");
    one("scene 1\nshape sphere \"ball\" { radius = 1 m }\nset |ball.radius = 2 m", "a:2:\"ball\"");
    one("scene 1\nparam k: float = 1\nexpect mean = 1 where { |k = 2 }", "a:2:k");
}

#[test]
fn behind_a_name_is_directly_behind_it() {
    let one =
        |rest: &str, expected| defined(&[("a", &format!("scene 1\nlet a = 1{rest}"))], expected);
    one("\nlet b = a|\nfn f(x: int) = x", "a:2:a");
    one("\nlet b = a\n|fn f(x: int) = x", "nowhere");
    one("\nlet b = a\nf|n f(x: int) = x", "nowhere");
    one("\nlet b = a |+ 1", "nowhere");
    one("\nshape sphere \"one\" { radius = a m }\nset one|.radius = a", "a:3:\"one\"");
    one("\nshape sphere \"one\" { radius = a m }\nset one.|radius = a", "nowhere");
}

#[test]
fn what_is_off_defines_nothing_and_has_no_label() {
    let text =
        "scene 1\nlet x = 1 m\ngroup \"g\" {\n @off let x = 2 m\n shape sphere { radius = |x }\n}";
    defined(&[("a", text)], "a:2:x");
    let text = "scene 1\n@off shape sphere \"b\" {}\nshape sphere \"b\" {}\nset |b.radius = 1 m";
    defined(&[("a", text)], "a:3:\"b\"");
    defined(&[("a", "scene 1\n@off shape sphere \"b\" {}\nset |b.radius = 1 m")], "nowhere");
}

#[test]
fn as_many_dots_as_a_file_holds_lead_nowhere_without_harm() {
    let text = format!("scene 1\nimport \"a\" as a\nlet x = a{}|.a", ".a".repeat(150_000));
    defined(&[("a", &text)], "nowhere");
    defined(&[("a", "scene 1\nimport \"a\" as a\nlet x = a.a.a.|x")], "a:3:x");
}

#[test]
fn names_are_found_in_files_that_do_not_parse() {
    let text = "scene 1\nlet r = 1 m\nshape sphere { radius = , }\nlet q = |r\nlet z = (";
    defined(&[("a", text)], "a:2:r");
}

#[test]
fn imports_and_includes_lead_to_other_files() {
    let lib =
        "scene 1\nparam size: length = 1 m\nlet gold = 3\nfn f(x: float) = x\nshape box \"b\" {}";
    let both = |text: &str, expected| defined(&[("sub/lib", lib), ("a", text)], expected);
    both("scene 1\nimport \"sub/lib\" as n\nlet x = n.|gold", "sub/lib:3:gold");
    both("scene 1\nimport \"sub/lib\" as n\nlet x = |n.gold", "a:2:n");
    both("scene 1\nimport \"sub/lib\" as n\nlet x = n.f(|x = 1)", "sub/lib:4:x");
    both("scene 1\ninclude \"sub/lib\" with { |size = 2 m }", "sub/lib:2:size");
    both("scene 1\ninclude \"sub/l|ib\"", "sub/lib:1:");
    both("scene 1\ninclude \"sub/lib\"\nset |b.size = 1", "sub/lib:5:\"b\"");
}

fn all(files: &[(&str, &str)]) -> Vec<String> {
    let (files, path, at) = marked(files);
    references(&files, &path, at).iter().map(|place| shown(&files, place)).collect()
}

#[test]
fn references_are_told_apart_by_what_they_mean() {
    let text = "scene 1\nlet r = 1\nfor r in 0..r { f(r) }\nlet s = |r";
    assert_eq!(all(&[("a", text)]), ["a:2:r", "a:3:r", "a:4:r"]);
    let lib = "scene 1\nlet |gold = 3\nlet x = gold";
    let user = "scene 1\nimport \"lib\" as n\nlet gold = n.gold";
    assert_eq!(all(&[("lib", lib), ("user", user)]), ["lib:2:gold", "lib:3:gold", "user:3:gold"]);
    let text = "scene 1\nfn f(|x: float) = x * x\nlet y = f(x = 1)\nlet x = 2";
    assert_eq!(all(&[("a", text)]), ["a:2:x", "a:2:x", "a:2:x", "a:3:x"]);
}

#[test]
fn a_name_is_not_in_sight_in_its_own_value() {
    let text = "scene 1\nlet |glass = glass(\"N-BK7\")\nlet b = glass\nlet sin = sin(1)";
    assert_eq!(all(&[("a", text)]), ["a:2:glass", "a:3:glass"]);
    defined(&[("a", "scene 1\nlet glass = |glass(\"N-BK7\")")], "nowhere");
}

/// The text with a name changed, or why not.
fn renamed(text: &str, new: &str) -> Result<String, String> {
    let (files, path, at) = marked(&[("a", text)]);
    let mut places = rename(&files, &path, at, new)?;
    places.reverse();
    let mut text = text.replacen('|', "", 1);
    for place in &places {
        text.replace_range(place.range.0..place.range.1, new);
    }
    Ok(text)
}

#[test]
fn a_new_name_reaches_every_use_and_nothing_else() {
    let text = "scene 1\nlet |r = 1 m\nshape sphere \"r\" { radius = r }\nfor q in 0..3 { g(r) }";
    let expected = text.replace('|', "").replace("let r", "let ray").replace("= r }", "= ray }");
    assert_eq!(renamed(text, "ray").unwrap(), expected.replace("g(r)", "g(ray)"));
    let label = "scene 1\nshape sphere \"ball\" {}\nset |ball.radius = 1 m";
    assert_eq!(renamed(label, "orb").unwrap(), label.replace('|', "").replace("ball", "orb"));
}

#[test]
fn names_that_cannot_be_are_refused_with_the_reason() {
    let text = "scene 1\nlet |r = 1\nlet q = sin(r)";
    let refused = |new: &str| renamed(text, new).unwrap_err();
    assert_eq!(refused("q"), "`q` has a meaning already in a");
    assert_eq!(refused("sin"), "`sin` has a meaning already in a");
    assert_eq!(refused("m"), "`m` is a unit and cannot be a name");
    assert_eq!(refused("let"), "`let` is a word of the language and cannot be a name");
    assert_eq!(refused("1a"), "`1a` is not a name: letters, digits and `_`, no digit first");
    let at = |text: &str| {
        let (files, path, at) = marked(&[("a", text)]);
        renamable(&files, &path, at).unwrap_err()
    };
    assert_eq!(at("scene 1\nlet q = |sin(1)"), "`sin` is not defined in any scene file");
    assert_eq!(at("scene 1\nlet q = 12| + 3"), "nothing here has a name of its own");
    assert_eq!(at("scene 1\ninclude \"|b\""), "a file is not renamed from here");
    let (files, path, _) = marked(&[("a", "|scene 1")]);
    assert!(rename(&files, &path.with_file_name("none"), 0, "x").is_err());
}
