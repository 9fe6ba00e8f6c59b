//! What an edit does not concern is not evaluated again.

use luxel_lang::Settings;

use super::edited::{CAMERA, Edited};

/// Some lines, and many that one edit need not concern.
fn with_disks(first: &[&str]) -> Vec<String> {
    let disk = |i| format!("shape disk {{ radius = 2 m, center = (0, {i}, 0) }}");
    first.iter().map(|line| (*line).to_owned()).chain((0..60).map(disk)).collect()
}

#[test]
fn beside_warnings_and_what_is_set_an_edit_concerns_its_statement() {
    let mut now = with_disks(&[
        "let r = 5 cm",
        "let q = 1 cm",
        "material dielectric { }",
        "fn half(x: length) = x / 2",
        "half(q)",
        "shape sphere \"one\" { radius = 1 m }",
        "set one.radius = 2 * q",
        CAMERA,
    ]);
    let mut edited = Edited::new(Settings { noting: true, ..Settings::default() });
    let mut n = |lines: &[String]| edited.counted(lines);
    assert_eq!(n(&now).1, 2);
    // One of many and what it uses.
    now[20] = now[20].replace("2 m", "r");
    assert_eq!(n(&now), (2, 2));
    // A length, the call that it is given to, the function, the sphere of which it is set, the `set`.
    now[1] = "let q = 2 cm".to_owned();
    assert_eq!(n(&now), (5, 2));
    // The sphere, the `set`, the length.
    now[5] = now[5].replace("1 m", "3 m");
    assert_eq!(n(&now), (3, 2));
    now[21] = now[21].replace("2 m", "2 s");
    assert_eq!(n(&now), (1, 3));
}

#[test]
fn beside_mistakes_that_stood_there_before_an_edit_concerns_its_statement() {
    let first = ["let r = 5 cm", "shape sphere { radus = 1 m }", "let wrong = r + 2 s", CAMERA];
    let mut now = with_disks(&first);
    let mut edited = Edited::new(Settings { noting: true, ..Settings::default() });
    let mut n = |lines: &[String]| edited.counted(lines);
    assert_eq!(n(&now).1, 2);
    now[20] = now[20].replace("2 m", "3 m");
    assert_eq!(n(&now), (1, 2));
    // One more, further down: the statements between are read again, and evaluated.
    now[23] = now[23].replace("2 m", "2 s");
    assert_eq!(n(&now), (4, 3));
}

#[test]
fn beside_what_does_not_close_yet_an_edit_concerns_its_statement() {
    let mut now = with_disks(&["let r = 5 cm", CAMERA]);
    let good = now[20].clone();
    let mut edited = Edited::new(Settings { noting: true, ..Settings::default() });
    let mut n = |lines: &[String]| edited.counted(lines);
    assert_eq!(n(&now).1, 0);
    let half = [
        "let z = (1 m",
        "let z = [r,",
        "shape disk {",
        "shape disk { radius = (r }",
        "shape disk { radius = r, {",
        "shape sphere \"one { radius = r }",
        "let z = \"\\q\"",
    ];
    for line in half {
        line.clone_into(&mut now[20]);
        let (n_evaluated, n_told) = n(&now);
        assert!((1..4).contains(&n_evaluated) && n_told > 0, "{line} {n_evaluated} {n_told}");
        now[20].clone_from(&good);
        assert_eq!(n(&now).1, 0);
    }
    // A file that was so from the beginning is gone on from too; what closes nothing may belong to another one.
    let cases = [(half[3], true), (half[6], true), (half[0], true), ("}", false)];
    for (i, (line, is_known)) in cases.into_iter().enumerate() {
        let mut edited = Edited::new(Settings { noting: true, ..Settings::default() });
        line.clone_into(&mut now[20]);
        assert!(edited.counted(&now).1 > 0, "{line}");
        now[40] = format!("shape disk {{ radius = {} m }}", 3 + i);
        let n_evaluated = edited.counted(&now).0;
        assert_eq!((1..6).contains(&n_evaluated), is_known, "{line} {n_evaluated}");
        now[20].clone_from(&good);
        assert_eq!(edited.counted(&now).1, 0, "{line}");
    }
}

#[test]
fn beside_a_mistake_a_name_is_handed_on() {
    let mut now: Vec<String> = [
        "let r = 5 cm",
        "let grey = material diffuse { reflectance = 0.5 }",
        "let q = 1 m",
        CAMERA,
    ]
    .map(str::to_owned)
    .to_vec();
    now.extend((0..60).map(|i| match i % 3 {
        0 => format!("shape sphere {{ radius = r * {i} + r, material = grey }}"),
        1 => format!("shape sphere {{ radius = r, center = ({i}, q, 2 * r) }}"),
        _ => "shape disk { radius = r, material = grey }".to_owned(),
    }));
    let good = now.clone();
    let mut edited = Edited::new(Settings { noting: true, ..Settings::default() });
    let mut n = |lines: &[String]| edited.counted(lines);
    assert_eq!(n(&now), (66, 0));
    // A name whose value a mistake hides hides it of all that uses it, and nothing more is told.
    for (i, wrong) in
        [(0, "let r = "), (0, "let r = 5 cm + 2 s"), (1, "let grey = material dif { }")]
    {
        wrong.clone_into(&mut now[i]);
        let (n_evaluated, n_told) = n(&now);
        assert!((1..4).contains(&n_evaluated) && n_told == 1, "{wrong} {n_evaluated} {n_told}");
        now.clone_from(&good);
        assert_eq!(n(&now).1, 0);
    }
    // One that is right, while something else is wrong.
    now[2] = "let q = 1 m + 2 s".to_owned();
    assert_eq!(n(&now), (2, 1));
    now[0] = "let r = 7 cm".to_owned();
    assert_eq!(n(&now), (3, 1));
    // A second definition changes nothing but that it is told; one before the first takes its place.
    now.clone_from(&good);
    now.insert(4, "let r = 9 cm".to_owned());
    assert_eq!(n(&now), (2, 1));
    now.remove(4);
    now.insert(0, "let grey = material diffuse { reflectance = 0.4 }".to_owned());
    assert_eq!(n(&now), (3, 1));
}

#[test]
fn of_vectors_that_each_shape_has_for_itself_the_numbers_are_handed_on() {
    let ball = |i: usize| {
        let center = match i % 5 {
            0 => format!("({} mm, r, -2 * r)", i + 1),
            1 => format!("(r, -(r / 2), {i}.5 m)"),
            2 => format!("({i}, 3, -1)"),
            3 => format!("(0, r, -{i} cm)"),
            _ => format!("(bare, r, {i} cm)"),
        };
        format!("shape sphere {{ radius = 1 m, center = {center} }}")
    };
    let mut lines = ["let r = 5 cm", "let bare = 0", CAMERA].map(str::to_owned).to_vec();
    lines.extend((0..60).map(ball));
    let mut edited = Edited::new(Settings { noting: true, ..Settings::default() });
    let mut n = |first: &str| {
        first.clone_into(&mut lines[0]);
        edited.counted(&lines)
    };
    assert_eq!(n("let r = 5 cm"), (65, 0));
    // The length, and the zero beside it.
    assert_eq!(n("let r = 7 cm"), (2, 0));
    assert_eq!(n("let r = 0 m"), (2, 0));
    assert_eq!(n("let r = -2 m"), (2, 0));
    // A bare zero is shown otherwise, and what measures something else fits nowhere: a load from nothing.
    assert_eq!(n("let r = 0").1, 0);
    assert_eq!(n("let r = 3 m").1, 0);
    assert!(n("let r = 1 s").1 > 0);
}

#[test]
fn what_only_hands_a_value_on_is_not_evaluated() {
    let mut now: Vec<String> =
        ["let r = 5 cm", "let grey = material diffuse { reflectance = 0.5 }", CAMERA]
            .map(str::to_owned)
            .to_vec();
    let ball = |i: usize| match i % 3 {
        0 => "shape sphere { radius = r, center = (1, 2, 3) m, material = grey }",
        1 => "light area { shape = shape disk { radius = r }, radiance = 1 W/m^2/sr }",
        _ => {
            "shape disk { radius = 2 m, material = material mix { a = grey, b = grey, weight = 0.1 } }"
        }
    };
    now.extend((0..60).map(|i| ball(i).to_owned()));
    for noting in [false, true] {
        let settings = Settings { noting, ..Settings::default() };
        let mut edited = Edited::new(settings);
        let mut lines = now.clone();
        let mut n = |lines: &[String]| edited.counted(lines);
        assert_eq!(n(&lines), (65, 0));
        lines[0] = "let r = 7 cm".to_owned();
        assert_eq!(n(&lines), (1, 0));
        lines[1] = "let grey = material conductor { eta = metal(\"Au\") }".to_owned();
        assert_eq!(n(&lines), (1, 0));
        // Also what was written since, of which a part of a part and the whole hand the same on.
        let both = "material mix { a = grey, b = grey, weight = 0.2 }";
        let ball = format!(
            "shape sphere {{ radius = r, material = material mix {{ a = grey, b = {both}, weight = 0.1 }} }}"
        );
        lines.insert(20, ball);
        // With what it uses, and the next one, which begins alike.
        assert_eq!(n(&lines), (4, 0));
        lines[1] = "let grey = material diffuse { reflectance = 0.3 }".to_owned();
        assert_eq!(n(&lines), (1, 0));
        lines[0] = "let r = 7.5 cm".to_owned();
        assert_eq!(n(&lines), (1, 0));
        // A vector of what is reckoned too, of which an item may become a bare zero.
        lines[9] = lines[9].replace("(1, 2, 3) m", "(r, 2 * r, 0)");
        assert_eq!(n(&lines), (3, 0));
        lines[0] = "let r = 8 cm".to_owned();
        assert_eq!(n(&lines), (1, 0));
        // One that does more than that is evaluated, with what it uses.
        lines[9] = lines[9].replace("(r, 2 * r, 0)", "(r, 2 * r, r) * 2");
        assert_eq!(n(&lines), (3, 0));
        lines[0] = "let r = 9 cm".to_owned();
        assert_eq!(n(&lines), (3, 0));
        // What is wrong for all of them is told of each.
        lines[0] = "let r = 8 s".to_owned();
        assert!(n(&lines).1 > 0);
    }
}

#[test]
fn vectors_of_what_is_reckoned_are_not_evaluated() {
    let mut now: Vec<String> =
        ["let x = 5 cm", "let at = (1, 2, 3) m", CAMERA].map(str::to_owned).to_vec();
    now.extend((0..60).map(|i| match i % 3 {
        0 => format!("shape sphere {{ radius = 1 m, center = (x, {i} m, 2 * x) }}"),
        1 => "shape sphere { radius = 1 m, center = (0, x, 0) }".to_owned(),
        _ => "shape sphere { radius = 1 m, center = at }".to_owned(),
    }));
    let mut edited = Edited::new(Settings { noting: true, ..Settings::default() });
    let mut n = |lines: &[String]| edited.counted(lines);
    assert_eq!(n(&now), (65, 0));
    for (i, line) in [(0, "let x = 7 cm"), (1, "let at = (0, 0, 3) m"), (0, "let x = 0 mm")] {
        line.clone_into(&mut now[i]);
        assert_eq!(n(&now), (1, 0), "{line}");
    }
    for (i, line) in [(0, "let x = 1 s"), (1, "let at = (1, 2) m"), (0, "let x = (1, 2) m")] {
        let before = std::mem::replace(&mut now[i], line.to_owned());
        assert!(n(&now).1 > 0, "{line}");
        now[i] = before;
        assert_eq!(n(&now).1, 0, "{line}");
    }
}

#[test]
fn what_only_reckons_with_a_value_is_not_evaluated() {
    let mut now: Vec<String> = ["let r = 5 cm", "let k = 2", CAMERA, "fn half(x: length) = x / 2"]
        .map(str::to_owned)
        .to_vec();
    now.extend((0..60).map(|i| match i % 3 {
        0 => "shape sphere { radius = (r + 1 cm) / k }".to_owned(),
        1 => format!("shape disk {{ radius = r * {i}, inner_radius = r * {i} / 2 }}"),
        _ => "shape disk { radius = 2 m }".to_owned(),
    }));
    let settings = Settings { noting: true, ..Settings::default() };
    let mut edited = Edited::new(settings);
    let mut n = |lines: &[String]| edited.counted(lines);
    now[5] = now[5].replace("r * 1,", "r * 7,");
    assert_eq!(n(&now), (66, 0));
    // The length, and what else is reckoned with.
    now[0] = "let r = 7 cm".to_owned();
    assert_eq!(n(&now), (2, 0));
    now[1] = "let k = 3".to_owned();
    assert_eq!(n(&now), (2, 0));
    // Where a number is no longer one, or is divided by nothing, it is a mistake of each.
    for wrong in ["0", "\"two\"", "(1, 2)", "1 s"] {
        now[1] = format!("let k = {wrong}");
        assert!(n(&now).1 > 0, "{wrong}");
    }
    now[1] = "let k = 4".to_owned();
    assert_eq!(n(&now).1, 0);
    // A call of a function of numbers takes as many steps whatever they are.
    for call in ["half(r) / k", "max(half(half(r)), 1 cm)", "sqrt(r * half(1 m)) + abs(-half(r))"] {
        now[4] = format!("shape sphere {{ radius = {call} }}");
        assert!((3..6).contains(&n(&now).0), "{call}");
        now[0] = format!("let r = 9 cm + {} mm", call.len());
        // The length, the function, and the other number that the other shapes reckon with.
        assert_eq!(n(&now), (3, 0), "{call}");
    }
    // Another function is another reckoning; one that chooses is evaluated, with what it uses.
    now[3] = "fn half(x: length) = x / 3 + 2 mm".to_owned();
    assert_eq!(n(&now), (3, 0));
    now[0] = "let r = 3 cm".to_owned();
    assert_eq!(n(&now), (3, 0));
    now[3] = "fn half(x: length) = if x > 2 cm { x } else { 2 * x }".to_owned();
    assert_eq!(n(&now), (3, 0));
    now[0] = "let r = 1 cm".to_owned();
    assert_eq!(n(&now), (4, 0));
}
