//! Scenes that are meant to hurt.

/// A scene, and files beside it.
pub(crate) struct Attack {
    pub(crate) name: &'static str,
    pub(crate) scene: String,
    /// Their names and texts.
    pub(crate) files: Vec<(String, String)>,
}

fn attack(name: &'static str, body: impl AsRef<str>) -> Attack {
    Attack { name, scene: format!("scene 1\n{}", body.as_ref()), files: vec![] }
}

/// Bytes of the largest texts.
const MUCH: usize = 60 << 20;

/// All of them.
pub(crate) fn all() -> impl Iterator<Item = Attack> {
    let sorts: [fn() -> Vec<Attack>; 4] = [evaluated, repeated, copied, files];
    sorts.into_iter().flat_map(|sort| sort()).chain(READ.into_iter().map(|make| make()))
}

fn lines(n: usize, line: impl Fn(usize) -> String) -> String {
    (0..n).map(line).collect()
}

/// What is spent in evaluation.
fn evaluated() -> Vec<Attack> {
    let deep =
        |of: fn(usize) -> String| lines(200_000, |i| format!("let a{} = {}\n", i + 1, of(i)));
    let doubled = lines(60, |i| format!("let x{} = [x{i}, x{i}]\n", i + 1));
    vec![
        attack("nested loops", "for i in 0..1000000 { for j in 0..1000000 { let x = i * j } }"),
        attack("empty loops", "for i in 0..1000000 { for j in 0..1000000 { } }"),
        attack("list of lists", "let a = [for i in 0..10000000 => [for j in 0..10000000 => i]]"),
        attack("list of spectra", "let a = [for i in 0..3000000 => blackbody(3000 K)]"),
        attack("list of metals", "let a = [for i in 0..3000000 => metal(\"Au\")]"),
        attack("list of texts", "let a = [for i in 0..10000000 => \"a\"]"),
        attack(
            "many lists",
            lines(10, |i| format!("let a{i} = [for i in 0..9000000 => (i, i)]\n")),
        ),
        attack("doubling lists", format!("let x0 = [true]\n{doubled}assert x60 == x60, \"a\"")),
        attack(
            "growing records",
            lines(5000, |i| match i {
                0 => "let r0 = { a = 1 }\n".to_owned(),
                i => format!("let r{i} = r{} with {{ a{i} = 1 }}\n", i - 1),
            }),
        ),
        attack(
            "doubling functions",
            lines(60, |i| match i {
                0 => "fn f0(x: int) = [x]\n".to_owned(),
                i => format!("fn f{i}(x: int) = [f{0}(x), f{0}(x)]\n", i - 1),
            }) + "let a = f59(1)",
        ),
        attack(
            "records in records",
            "let a0 = {}\n".to_owned() + &deep(|i| format!("{{ a = a{i} }}")),
        ),
        attack("lists in lists", "let a0 = [true]\n".to_owned() + &deep(|i| format!("[a{i}]"))),
        attack("nodes", "for i in 0..2000000 { shape sphere { radius = 1 m } }"),
        attack(
            "sets",
            "shape sphere \"b\" { radius = 1 m }\n".to_owned()
                + &"set b.radius = 2 m\n".repeat(1_000_000),
        ),
        attack("definitions", lines(1_000_000, |i| format!("let a{i} = 1\n"))),
        attack("unknown names", lines(500_000, |i| format!("let a{i} = nope{i}\n"))),
    ]
}

/// What costs much each time that it is done, and what is wrong each time.
fn repeated() -> Vec<Attack> {
    let turns = |name, before: &str, each: &str| {
        attack(name, format!("{before}\nfor i in 0..1000000000 {{ {each} }}"))
    };
    let text = format!("let a = \"{}\"", "x".repeat(512 << 10));
    let moves = "let l = [for i in 0..100000 => move((0, 0, 1) m)]";
    let pairs = "let l = [for i in 0..100000 => (i * 1 nm, 1)]";
    let names = "let l = [for i in 0..100000 => \"a\"] fn f(names: string[]) = 1";
    let metal = format!("let a = metal(\"{}\")", "A".repeat(1024));
    let file = turns("spectra of a file", "", "let b = spectrum.file(\"a.csv\")");
    vec![
        turns("compared texts", &text, "let b = a == a"),
        turns("long transforms", moves, "shape sphere { radius = 1 m, transform = l }"),
        turns("long arguments", names, "let a = f(l)"),
        attack("long spectra", format!("{pairs}\nlet m = [for i in 0..1000 => spectrum(l)]")),
        Attack { files: vec![("a.csv".to_owned(), "400 0.1\n700 0.5\n".to_owned())], ..file },
        turns("a wrong metal", "", &metal),
        turns("a lacking argument", "", "let a = metal()"),
        turns("a wrong sum", "", "let a = 5 m + 3 deg"),
        turns("a wrong parameter", "", "shape sphere { radus = 5 m }"),
    ]
}

/// What is kept as often as it is said.
fn copied() -> Vec<Attack> {
    let place = |i: usize| {
        let each = format!("place g{} {{ transform = move((i, 0, 0) m) }}", i.wrapping_sub(1));
        match i {
            0 => "let g0 = shape sphere { radius = 1 m }\n".to_owned(),
            i => format!("let g{i} = group {{ for i in 0..10 {{ {each} }} }}\n"),
        }
    };
    let amended = |i: usize| match i {
        0 => "let m0 = material diffuse { reflectance = 0.5 }\n".to_owned(),
        i => format!("let m{i} = m{} with {{ reflectance = 0.4 }}\n", i - 1),
    };
    let moved = |i: usize| match i {
        0 => "let b0 = shape sphere { radius = 1 m }\n".to_owned(),
        i => format!("let b{i} = b{} with {{ transform = move(({i}, 0, 0) m) }}\n", i - 1),
    };
    let labelled = "shape sphere \"a\" { radius = 1 m }";
    vec![
        attack("groups of groups", lines(8, place) + "place g7"),
        attack("chained copies", lines(400_000, amended)),
        attack("chained transforms", lines(400_000, moved)),
        attack("parameters", lines(900_000, |i| format!("param p{i}: int = 1\n"))),
        attack("one label", format!("{labelled}\n").repeat(1_200_000)),
        attack(
            "sets of many",
            format!("for i in 0..900000 {{ {labelled} }}\n") + &"set a.radius = 2 m\n".repeat(400),
        ),
    ]
}

/// What is spent in reading one text: each text is made when it is its turn, as it is large.
const READ: [fn() -> Attack; 27] = [
    || attack("open braces", "{".repeat(MUCH)),
    || attack("closing braces", "}".repeat(MUCH)),
    || attack("lines of braces", "{\n".repeat(MUCH / 2)),
    || attack("lines in braces", " {\n".repeat(255) + &"    x\n".repeat(MUCH / 6 - 255)),
    || attack("calls in a brace", format!("group {{{}", "()".repeat(MUCH / 2 - 8))),
    || attack("braces behind braces", "{ \n }".repeat(MUCH / 5 - 20) + &"{".repeat(100)),
    || attack("wrong brackets", "[)".repeat(MUCH / 2)),
    || {
        let (opens, closes) = ("a[".repeat(120), ")".repeat(120));
        attack("brackets in brackets", format!("let a = {opens}{}{closes}", "x ".repeat(MUCH / 16)))
    },
    || attack("short statements", "a\n".repeat(MUCH / 2)),
    || attack("short definitions", "let = 3\n".repeat(MUCH / 8)),
    || attack("open comment", format!("/*{}", "x ".repeat(MUCH / 2))),
    || attack("open text", format!("let a = \"{}", "x".repeat(MUCH))),
    || attack("open texts", "let a = \"\n".repeat(5_000_000)),
    || attack("open table", format!("let a = #[{}", "1 ".repeat(MUCH / 2))),
    || attack("long table", format!("let a = #[{}]", "1 ".repeat(MUCH / 2))),
    || attack("long text", format!("let a = \"{}\"", "x".repeat(MUCH))),
    || attack("long texts", format!("let a = \"{}\"\n", "x".repeat(1 << 20)).repeat(58)),
    || attack("long path", format!("let a = b{}", ".a".repeat(MUCH / 2))),
    || attack("long name", format!("let a = {}", "b".repeat(MUCH))),
    || attack("long number", format!("let a = {}", "9".repeat(MUCH))),
    || attack("long list", format!("let a = [{}]", "x, ".repeat(MUCH / 3))),
    || attack("operators", format!("let a = 1{}", " + 1".repeat(MUCH / 4))),
    || attack("else if", format!("if true {{ }} {}", "else if true { } ".repeat(3_000_000))),
    || attack("words", "x ".repeat(MUCH / 2)),
    || attack("doc comments", format!("{}let a = 1", "/// a\n".repeat(MUCH / 6))),
    || attack("doc comments of nothing", "/// a\n".repeat(MUCH / 6)),
    || attack("mistakes", "let a = = 1\n".repeat(1_000_000)),
];

/// What is spent in files.
fn files() -> Vec<Attack> {
    let beside = |name, body: String, files| Attack { files, ..attack(name, body) };
    let fan = (0..31).map(|i| {
        let next = format!("include \"{}.scene\"\n", i + 1).repeat(if i < 30 { 2 } else { 0 });
        (format!("{i}.scene"), format!("scene 1\n{next}"))
    });
    let big = |i| (format!("{i}.scene"), format!("scene 1\n//{}", "x".repeat(MUCH)));
    let includes = |n| lines(n, |i| format!("include \"{i}.scene\"\n"));
    vec![
        beside("include fan", "include \"0.scene\"".to_owned(), fan.collect()),
        beside("large includes", includes(5), (0..5).map(big).collect()),
    ]
}
