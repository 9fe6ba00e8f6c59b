//! Libraries whose tables lie: each lie is told by name, and nothing is run.

use std::ptr::null;

use luxel_sdk::abi::{ABI_MAJOR, LAYOUT_HASH, LibraryTable, MAGIC, PANIC_ABORT, Slice};
use luxel_sdk::params::Text;

use super::forge::{AMOUNT, FAR, Forge, WORD, bytes, opened, slice, text};

/// After this change the library is refused with this message.
fn check(told: &str, change: impl FnOnce(&mut Forge)) {
    let refused = opened(change).expect_err(told);
    assert_eq!(refused.message, told);
}

#[test]
fn without_a_lie_the_library_opens() {
    let library = opened(|_| {}).unwrap();
    assert_eq!((library.classes.len(), library.classes[0].params.len()), (1, 3));
}

#[test]
fn tables_of_other_hosts_are_refused() {
    check(
        &format!(
            "no Luxel plugin: its table begins with 0x0000000000000001, not with {MAGIC:#018x}"
        ),
        |f| f.library.magic = 1,
    );
    check(
        &format!(
            "built for version 7 of the plugin boundary, this program has {ABI_MAJOR}: build it again \
             with this version of luxel-sdk"
        ),
        |f| f.library.abi_major = 7,
    );
    check(
        &format!(
            "its types are laid out differently (0x0000000000000002, here {LAYOUT_HASH:#018x}): build \
             it again with this version of luxel-sdk, for this processor"
        ),
        |f| f.library.layout_hash = 2,
    );
    check("its table is only 119 bytes long", |f| f.library.size = size_of::<LibraryTable>() - 1);
    check("its table is only 0 bytes long", |f| f.library.size = 0);
    check(
        "built with panic = \"abort\", so that a panic would end this program: build it with panic = \
         \"unwind\"",
        |f| f.library.panic = PANIC_ABORT,
    );
    assert!(opened(|f| f.library.abi_minor = 99).is_ok(), "minor versions only add");
}

#[test]
fn names_that_are_none_are_refused() {
    let odd = "not of a-z, 0-9 and _";
    check(&format!("its name is \"\", {odd}"), |f| f.library.name = text(null(), 0));
    check("its name stands nowhere", |f| f.library.name = text(null(), 4));
    check("its name is not UTF-8", |f| f.library.name = bytes(b"a\xff"));
    check(&format!("its name is \"Honest\", {odd}"), |f| f.library.name = Text::new("Honest"));
    check("its version is not UTF-8", |f| f.library.version = bytes(b"1.\xc3"));
    check("its compiler stands nowhere", |f| f.library.compiler = text(null(), 1));

    check(&format!("class 1: its name is \"\", {odd}"), |f| f.class.name = text(null(), 0));
    check("class 1: its name stands nowhere", |f| f.class.name = text(null(), 6));
    check("class 1: its name is not UTF-8", |f| f.class.name = bytes(b"\xf0\x28\x8c\x28"));
    check(&format!("class 1: its name is \"a/b\", {odd}"), |f| f.class.name = Text::new("a/b"));
    check(&format!("class 1: its name is \"..\", {odd}"), |f| f.class.name = Text::new(".."));
    check(&format!("class 1: its name is \"a\\u{{1b}}[2J\", {odd}"), |f| {
        f.class.name = Text::new("a\x1b[2J");
    });
    let of = "class 1: material `honest`: the name of parameter 2";
    check(&format!("{of} is \"\", {odd}"), |f| f.params[1].name = text(null(), 0));
    check(&format!("{of} stands nowhere"), |f| f.params[1].name = text(null(), 3));
    check(&format!("{of} is not UTF-8"), |f| f.params[1].name = bytes(b"\x80"));
    check("class 1: material `honest`: parameter `amount` is there twice", |f| {
        f.params[FAR].name = Text::new("amount");
    });
}

#[test]
fn lists_that_cannot_be_are_refused() {
    let most = usize::MAX;
    let of = "class 1: material `honest`";
    check("its name claims 18446744073709551615 values where at most 1048576 can be", |f| {
        f.library.name = text(b"x".as_ptr(), most);
    });
    check(&format!("{of}: its list of parameters stands nowhere"), |f| {
        f.class.params = slice(null(), 3);
    });
    check(&format!("{of}: parameter `word` has a list of choices that stands nowhere"), |f| {
        f.params[WORD].choices = slice(null(), 2);
    });
    check(
        &format!(
            "{of}: parameter `word` has a list of choices that claims 18446744073709551615 values \
             where at most 1024 can be"
        ),
        |f| f.params[WORD].choices = slice(std::ptr::dangling(), most),
    );
    let library = opened(|f| f.times = 0).unwrap();
    assert!(library.classes.is_empty());
    check("it offers material `honest` twice", |f| f.times = 2);
}

#[test]
fn classes_that_cannot_be_are_refused() {
    let of = "class 1: material `honest`";
    check("class 1: 99 is no kind of plugin", |f| f.class.kind = 99);
    check("class 1: 11 is no kind of plugin", |f| f.class.kind = 11);
    check(&format!("{of}: it has no doc: it is the manual page"), |f| {
        f.class.doc = text(null(), 0);
    });
    check(&format!("{of}: its doc is not UTF-8"), |f| f.class.doc = bytes(b"\xff"));
    check(&format!("{of}: its parameters take 257 bytes, at most 256 are allowed"), |f| {
        f.class.size = 257;
    });
    check(&format!("{of}: its parameters take 4294967295 bytes, at most 256 are allowed"), |f| {
        f.class.size = u32::MAX;
    });
}

/// After this change of parameter `i` the library is refused, with this about the parameter.
fn check_param(i: usize, told: &str, change: impl FnOnce(&mut luxel_sdk::abi::ParamTable)) {
    let name = ["amount", "word", "far"][i];
    check(&format!("class 1: material `honest`: parameter `{name}` {told}"), |f| {
        change(&mut f.params[i]);
    });
}

#[test]
fn parameters_that_cannot_be_are_refused() {
    check_param(AMOUNT, "has no doc: it becomes the manual", |p| p.doc = text(null(), 0));
    check_param(AMOUNT, "has a doc that is not UTF-8", |p| p.doc = bytes(b"\xfe"));
    check_param(AMOUNT, "has a doc that stands nowhere", |p| p.doc = text(null(), 9));
    check_param(AMOUNT, "has the unknown type 17", |p| p.ty = 17);
    check_param(AMOUNT, "has the unknown type 4294967295", |p| p.ty = u32::MAX);
    check_param(AMOUNT, "has the unknown type 35", |p| p.ty = 35);
    check_param(AMOUNT, "has the unknown role 8", |p| p.role = 8);
    let waves = "has the role waves, for spectra in m without default and texture";
    check_param(AMOUNT, waves, |p| p.role = 6);
    check_param(AMOUNT, "has the unknown unit `parsec`", |p| p.unit = Text::new("parsec"));
    check_param(AMOUNT, "has the unknown kind of default 4", |p| p.preset = 4);
    let range = "has a default outside its range [0, 1]";
    check_param(AMOUNT, range, |p| p.numbers[0] = 1.5);
    check_param(AMOUNT, range, |p| p.numbers[0] = f64::NAN);
    check_param(AMOUNT, range, |p| p.numbers[0] = f64::NEG_INFINITY);
    check_param(AMOUNT, "has the empty range [1, 0]", |p| (p.min, p.max) = (1.0, 0.0));
    check_param(AMOUNT, "has the empty range [NaN, 1]", |p| p.min = f64::NAN);
    let typed = "has a default that is of another type";
    check_param(AMOUNT, typed, |p| p.preset = 3);
    check_param(WORD, typed, |p| p.preset = 1);
    check_param(FAR, "is of a type that a texture cannot drive", |p| p.flags = 2);
    check_param(FAR, "has a unit that is not UTF-8", |p| p.unit = bytes(b"\xff"));
    check_param(FAR, "has a group that stands nowhere", |p| p.group = text(null(), 1));
    check_param(FAR, "has a new name that stands nowhere", |p| p.deprecated = text(null(), 1));
    check_param(FAR, "has a default that stands nowhere", |p| p.text = text(null(), 1));
}

#[test]
fn choices_that_cannot_be_are_refused() {
    let none = "is a choice without words, or has words and is none";
    check_param(FAR, none, |p| p.choices = Slice::new(const { &[Text::new("a")] }));
    check_param(WORD, "has the default 0, which is none of its 0 choices", |p| {
        p.choices = Slice::new(&[]);
    });
    check_param(WORD, none, |p| (p.choices, p.preset) = (Slice::new(&[]), 0));
    let beyond = |n: &str| format!("has the default {n}, which is none of its 2 choices");
    for (n, shown) in [(2.0, "2"), (0.5, "0.5"), (-1.0, "-1"), (f64::NAN, "NaN"), (1e300, "")] {
        let shown = if shown.is_empty() { format!("{n}") } else { shown.to_owned() };
        check_param(WORD, &beyond(&shown), |p| p.numbers[0] = n);
    }
    check_param(WORD, "has a choice that is \"no word\", not of a-z, 0-9 and _", |p| {
        p.choices = Slice::new(const { &[Text::new("no word")] });
    });
}

#[test]
fn fields_outside_the_struct_are_refused() {
    let stands = |at: &str| {
        format!("takes 4 bytes at {at}, which is not inside the struct of 16 bytes or not aligned")
    };
    check_param(AMOUNT, &stands("16"), |p| p.offset = 16);
    check_param(AMOUNT, &stands("13"), |p| p.offset = 13);
    check_param(AMOUNT, &stands("2"), |p| p.offset = 2);
    check_param(AMOUNT, &stands("18446744073709551615"), |p| p.offset = u64::MAX);
    check_param(AMOUNT, &stands("18446744073709551612"), |p| p.offset = u64::MAX - 3);
    check_param(FAR, "stands on `amount`", |p| p.offset = 0);
    check(
        "class 1: material `honest`: parameter `amount` takes 4 bytes at 0, which is not inside the \
           struct of 0 bytes or not aligned",
        |f| f.class.size = 0,
    );
}

#[test]
fn names_that_the_host_looks_for_are_refused() {
    let told = "class 1: material `honest`: parameter `interior` is called like one that the host adds \
        or reads";
    check(told, |f| f.params[FAR].name = Text::new("interior"));
    // A light's `shape` is the shape that shines.
    let told = "class 1: light `honest`: parameter `shape` is called like one that the host adds or \
        reads";
    check(told, |f| {
        f.params[FAR].name = Text::new("shape");
        f.class.kind = luxel_sdk::kind::Kind::Light as u32;
    });
}

#[test]
fn handles_that_may_be_absent_are_refused() {
    for (flags, group) in [(0, ""), (1, "either")] {
        check_param(FAR, "is a handle that a scene may leave out: handles are required", |p| {
            (p.ty, p.preset, p.unit, p.offset) = (33, 0, Text::new(""), 0);
            (p.flags, p.group) = (flags, Text::new(group));
        });
    }
}

#[test]
fn a_shared_table_that_stands_nowhere_is_refused() {
    let of = "class 1: material `honest`: its shared table at";
    for at in [16, 12, 9, u64::MAX, u64::MAX - 7] {
        check(&format!("{of} {at} is not inside its struct of 16 bytes or not aligned"), |f| {
            f.share(at);
        });
    }
    check(&format!("{of} 0 stands on `amount`"), |f| f.share(0));
    let beside = opened(|f| {
        f.share(16);
        f.class.size = 24;
    });
    assert!(beside.is_ok(), "{beside:?}");
}

#[test]
fn tables_without_functions_are_refused() {
    let of = "class 1: material `honest`";
    check(&format!("{of}: it has no table of functions"), |f| f.class.behaviour = null());
    for size in [0, 7, 1 << 20, usize::MAX] {
        check(&format!("{of}: its table of functions claims to be {size} bytes long"), |f| {
            f.table[0] = size;
        });
    }
    check(&format!("{of}: its table of functions lacks `eval`"), |f| f.table[0] = 16);
    check(&format!("{of}: its table of functions lacks `sample`"), |f| f.table[0] = 31);
    check(&format!("{of}: its table of functions lacks `eval`"), |f| f.table[2] = 0);
    check(&format!("{of}: its table of functions lacks `sample`"), |f| f.table[3] = 0);
}

#[test]
fn tables_of_another_age_are_taken() {
    let library = opened(|f| f.table[1] = 0).unwrap();
    assert_eq!(library.classes.len(), 1, "`needs` has a default");
    let newer = opened(|f| {
        f.table[0] += 16;
        f.table.extend([1, 2]);
    });
    assert!(newer.is_ok(), "what this host does not know is not asked for");
}
