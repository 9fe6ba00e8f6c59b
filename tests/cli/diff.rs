//! What differs between two scenes, as a person asks for it.

use super::program::{Folder, SCENE};

/// The same scene, written otherwise.
const REWRITTEN: &str = r"//! A ball.
scene 1
let grey = material diffuse { reflectance = 0.25 * 2 }
shape sphere { radius = 100 cm, center = (0, 0, 0) m, priority = 0, material = grey }
light constant { scale = 1 }
film rgb { resolution = (32, 32) }
sampler sobol { samples = 4 }
camera perspective {
  look = look_at(from = (0, 0, 5) m, to = (0, 0, 0) m, up = (0, 1, 0)), fov = 40 deg
}
";

#[test]
fn scenes_that_come_to_the_same_are_the_same_however_they_are_written() {
    let folder = Folder::new("diff-same").with("a.scene", SCENE).with("b.scene", REWRITTEN);
    let done = folder.luxel(&["diff", "a.scene", "b.scene"]);
    assert_eq!((done.code, &*done.out, &*done.err), (0, "same\n", ""));
    let done = folder.luxel(&["diff", "a.scene", "b.scene", "--json"]);
    assert_eq!((done.code, &*done.out), (0, "{\"differences\":[],\"same\":true}\n"));
}

#[test]
fn objects_and_parameters_are_told_with_places_and_values() {
    let other = SCENE
        .replace("fov = 40 deg", "fov = 41 deg")
        .replace("{ reflectance = 0.5 }", "{}")
        .replace("(32, 32)", "(32, 32), exposure = 1 EV")
        .replace("light constant", "shape disk \"floor\" { radius = 9 m }\nlight constant")
        .replace("sampler sobol { samples = 4 }\n", "");
    let folder = Folder::new("diff").with("a.scene", SCENE).with("b.scene", &other);
    let done = folder.luxel(&["diff", "a.scene", "b.scene"]);
    let told = "\
camera perspective  a.scene:2 b.scene:2
  fov: 40 deg → 41 deg
film rgb  a.scene:6 b.scene:6
  exposure: default → 1 EV
sampler sobol removed  a.scene:7
material diffuse  a.scene:9 b.scene:9
  reflectance: 0.5 → default
disk \"floor\" added  b.scene:7
";
    assert_eq!((done.code, &*done.out, &*done.err), (1, told, ""));
    let done = folder.luxel(&["diff", "a.scene", "b.scene", "--json"]);
    let part = concat!(
        r#"{"a":"a.scene:2","b":"b.scene:2","how":"changed","n":1,"#,
        r#""parameters":[{"a":"40 deg","b":"41 deg","name":"fov"}],"what":"camera perspective"}"#,
    );
    assert!(done.code == 1 && done.out.contains(part), "{done:?}");
    assert!(done.out.contains(r#""same":false"#), "{done:?}");
}

#[test]
fn what_a_loop_makes_is_told_once() {
    let scene = |radius: &str| {
        let each = "center = (2 * i, 0, 0) * 1 m, radius = ";
        let both = format!("shape sphere {{ {each}{radius} }} shape box {{ size = (1, 1, 1) m }}");
        format!("{SCENE}for i in 0..3 {{ {both} }}\n")
    };
    let folder =
        Folder::new("diff-loop").with("a.scene", &scene("1 m")).with("b.scene", &scene("2 m"));
    let done = folder.luxel(&["diff", "a.scene", "b.scene"]);
    let line = SCENE.lines().count() + 1;
    let told = format!("3 × shape sphere  a.scene:{line} b.scene:{line}\n  radius: 1 m → 2 m\n");
    assert_eq!((done.code, &*done.out), (1, &*told), "{done:?}");
}

#[test]
fn what_is_written_alike_is_told_as_what_it_comes_to() {
    let scene = |r: &str| {
        let shapes = "shape box { size = (1, 1, 1) * r } shape sphere \"ball\" { radius = r / 2 }";
        let many = "for i in 1..3 { shape disk { radius = i * r } shape disk { radius = r } }";
        format!("{SCENE}let r = {r}\n{}\n{many}\n", shapes.replace(" shape", "\nshape"))
    };
    let folder = Folder::new("diff-alike").with("a.scene", &scene("1 m"));
    let folder = folder.with("b.scene", &scene("25 cm"));
    let done = folder.luxel(&["diff", "a.scene", "b.scene"]);
    let line = SCENE.lines().count();
    let at = |n: usize| format!("a.scene:{0} b.scene:{0}", line + n);
    let told = format!(
        "sphere \"ball\"  {}\n  radius: 0.5 m → 0.125 m\nshape box  {}\n  size: (1, 1, 1) → (0.25, 0.25, 0.25)\n\
         2 × shape disk  {}\n  radius\n2 × shape disk  {}\n  radius: 1 m → 0.25 m\n",
        at(3),
        at(2),
        at(4),
        at(4),
    );
    // The one in the loop comes to another value each time.
    assert_eq!((done.code, &*done.out), (1, &*told), "{done:?}");
}

#[test]
fn params_are_set_in_both_and_mistakes_are_told() {
    let scene = |n: &str| SCENE.replace("camera", &format!("param n: int = {n}\ncamera"));
    let scene = |n: &str| scene(n).replace("samples = 4", "samples = n");
    let folder = Folder::new("diff-set").with("a.scene", &scene("1")).with("b.scene", &scene("2"));
    let done = folder.luxel(&["diff", "a.scene", "b.scene"]);
    // Both say `n`: what it stands for differs.
    let told = "sampler sobol  a.scene:8 b.scene:8\n  samples: 1 → 2\n";
    assert_eq!((done.code, &*done.out), (1, told));
    assert_eq!(folder.luxel(&["diff", "a.scene", "b.scene", "--set", "n=3"]).code, 0);
    folder.write("wrong.scene", "scene 1\nlet a = 5 +\n");
    let done = folder.luxel(&["diff", "a.scene", "wrong.scene"]);
    assert!(done.code == 1 && done.out.is_empty() && done.err.contains("E0015"), "{done:?}");
}

#[test]
fn files_count_by_their_place_beside_the_scene() {
    let scene = |file: &str| {
        let texture = format!("texture image {{ file = \"{file}\" }}");
        SCENE.replace("reflectance = 0.5", &format!("reflectance = {texture}"))
    };
    let folder = Folder::new("diff-folders")
        .with("a/a.scene", &scene("one.png"))
        .with("b/a.scene", &scene("one.png"))
        .with("c/a.scene", &scene("two.png"));
    let done = folder.luxel(&["diff", "a/a.scene", "b/a.scene"]);
    assert_eq!((done.code, &*done.out, &*done.err), (0, "same\n", ""));
    let done = folder.luxel(&["diff", "a/a.scene", "c/a.scene"]);
    let told = "  file: \"one.png\" → \"two.png\"\n";
    assert!(done.code == 1 && done.out.ends_with(told), "{done:?}");
}
