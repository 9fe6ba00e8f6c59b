//! A scene that is being worked on: small numbers that choose what its text and files say.
//!
//! Few values each, so that edits lead back to what was there before.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::sync::Arc;

use luxel_core::files::{Files, MemoryFiles};
use luxel_sdk::sampling::Rng;

use crate::disk::{OnDisk, root};

/// The scene's own file.
pub(super) const SCENE: &str = "a.scene";
/// The film that finds out whether the scene needs wavelengths.
const AUTO: u64 = VALUES - 1;
/// Kinds of things that a scene may hold.
const THINGS: u64 = 12;
/// Values that most of a draft's numbers take.
const VALUES: u64 = 5;
/// Contents that a file takes; the last two are broken and missing.
const CONTENTS: u64 = 6;
const BROKEN: u64 = CONTENTS - 2;
const MISSING: u64 = CONTENTS - 1;
/// Ways to make a mistake in the text.
const MISTAKES: u64 = 7;

/// What an edit is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Edit {
    /// Comments, names and blanks.
    Words,
    Camera,
    Material,
    /// Where a thing stands, or the order in which they are written.
    Place,
    /// Where a part of a solid stands in it.
    Part,
    /// Film, integrator, sampler, filter.
    Settings,
    /// Lights and fog.
    Light,
    /// A thing more or less.
    Things,
    /// What stands in a mesh, a picture, an asset.
    Contents,
    /// As it was some edits ago.
    Back,
    /// A mistake in the text, or its mending.
    Mistake,
}

impl Edit {
    /// Whether no shape has to be made ready for it.
    pub(super) fn keeps_shapes(self) -> bool {
        matches!(self, Self::Words | Self::Camera | Self::Material | Self::Place | Self::Settings)
    }

    /// Whether all that stands in the world stays as it is.
    pub(super) fn keeps_world(self) -> bool {
        matches!(self, Self::Words | Self::Camera)
    }

    /// Whether no tree of a mesh has to be built for it.
    pub(super) fn keeps_trees(self) -> bool {
        self.keeps_shapes() || self == Self::Part
    }

    fn any(rng: &mut Rng) -> Self {
        use Edit::{
            Back, Camera, Contents, Light, Material, Mistake, Part, Place, Settings, Things, Words,
        };
        let all = [
            Words, Camera, Camera, Material, Material, Place, Place, Part, Settings, Light, Things,
            Things, Contents, Contents, Back, Back, Mistake,
        ];
        all[index(rng, all.len())]
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Thing {
    what: u64,
    paint: u64,
    at: u64,
    label: u64,
    /// Where a part of it stands, if it is a solid.
    part: u64,
}

/// The scene as it is in the author's mind, and the mistake that is in its text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Draft {
    camera: [u64; 3],
    settings: [u64; 5],
    lights: [u64; 4],
    paints: [u64; 3],
    words: u64,
    things: Vec<Thing>,
    contents: BTreeMap<&'static str, u64>,
    mistake: Option<u64>,
}

impl Draft {
    pub(super) fn new(rng: &mut Rng) -> Self {
        let files = ["a.obj", "b.obj", "picture.hdr", "sky.hdr", "bumps.hdr", "a.glb"];
        Self {
            camera: [0; 3],
            settings: [0, below(rng, 2) * AUTO, 0, 0, 0],
            lights: [0; 4],
            paints: [0, 1, below(rng, 2)],
            words: 0,
            things: (0..4).map(|_| Thing::any(rng)).collect(),
            contents: files.map(|file| (file, below(rng, BROKEN))).into(),
            mistake: None,
        }
    }

    /// Changes something; `past` is where it may go back to.
    pub(super) fn edit(&mut self, rng: &mut Rng, past: &[Self]) -> Edit {
        // Mistakes are mended soon.
        let is_mended = self.mistake.is_some() && below(rng, 2) == 0;
        let edit = if is_mended { Edit::Mistake } else { Edit::any(rng) };
        match edit {
            Edit::Words => self.words += 1,
            Edit::Camera => self.camera[index(rng, 3)] = below(rng, VALUES),
            Edit::Material => self.paints[index(rng, 3)] = below(rng, VALUES),
            Edit::Settings => self.settings[index(rng, 5)] = below(rng, VALUES),
            Edit::Light => self.lights[index(rng, 4)] = below(rng, VALUES),
            Edit::Contents => {
                let file = index(rng, self.contents.len());
                let contents = self.contents.values_mut().nth(file).expect("below their number");
                // Files of another kind of contents are rare, and mended by the next edit of them.
                let n = if below(rng, 3) == 0 { CONTENTS } else { BROKEN };
                *contents = below(rng, n);
            }
            Edit::Back => self.clone_from(&past[index(rng, past.len())]),
            Edit::Mistake => {
                self.mistake =
                    if self.mistake.is_some() { None } else { Some(below(rng, MISTAKES)) };
            }
            Edit::Part => {
                let thing = index(rng, self.things.len());
                self.things[thing].part = below(rng, VALUES);
            }
            Edit::Things if self.things.len() < 2 || below(rng, 2) == 0 => {
                self.things.push(Thing::any(rng));
            }
            Edit::Things => _ = self.things.remove(index(rng, self.things.len())),
            Edit::Place if below(rng, 3) == 0 => {
                let (a, b) = (index(rng, self.things.len()), index(rng, self.things.len()));
                self.things.swap(a, b);
            }
            Edit::Place => {
                let thing = index(rng, self.things.len());
                self.things[thing].at = below(rng, VALUES);
            }
        }
        edit
    }

    /// The files whose contents are not those of another draft.
    pub(super) fn other_files<'a>(
        &'a self,
        than: &'a Self,
    ) -> impl Iterator<Item = &'static str> + 'a {
        let differs = |(file, n): &(&&str, &u64)| than.contents[**file] != **n;
        self.contents.iter().filter(differs).map(|(file, _)| *file)
    }

    /// The scene's files as they are saved.
    pub(super) fn files(&self) -> MemoryFiles {
        let mut files = MemoryFiles::default()
            .with(SCENE, self.text().as_bytes())
            .with("paints.scene", self.paints().as_bytes());
        for (&file, &contents) in self.contents.iter().filter(|(_, n)| **n != MISSING) {
            files = files.with(file, bytes(file, contents));
        }
        files
    }

    fn paints(&self) -> String {
        let mut text = "scene 1\n".to_owned();
        for (i, n) in self.paints.iter().enumerate() {
            let rho = 0.2 + 0.15 * *n as f64;
            let paint = match n {
                0 => format!("diffuse {{ reflectance = {rho} }}"),
                1 => {
                    "diffuse { reflectance = texture image { file = \"picture.hdr\" } }".to_owned()
                }
                2 => "dielectric { ior = glass(\"N-BK7\") }".to_owned(),
                3 => "conductor { eta = metal(\"Cu\"), roughness = 0.2 }".to_owned(),
                _ => format!(
                    "metallic_roughness {{ base_color = {rho}, metallic = 0, roughness = {rho} }}"
                ),
            };
            let _ = writeln!(text, "let paint{i} = material {paint}");
        }
        text
    }

    fn text(&self) -> String {
        let mut text = format!(
            "scene 1\n// {}\nimport \"paints.scene\" as p\n{}{}{}",
            self.words,
            self.camera_text(),
            self.settings_text(),
            self.lights_text()
        );
        for (i, thing) in self.things.iter().enumerate() {
            text.push_str(&thing.text(i));
        }
        match self.mistake {
            None => text,
            Some(0) => text.replacen("fov", "fow", 1),
            Some(1) => text.replacen('}', "", 1),
            Some(2) => text + "shape sphere { radius = -1 m }\n",
            Some(3) => text + "shape sphere { radius = 1 m, transform = scale((1, 0, 1)) }\n",
            Some(4) => text.replacen("camera", "@off camera", 1),
            Some(5) => text + "shape mesh { file = \"never.obj\", unit = 1 m }\n",
            Some(_) => {
                text + "shape mesh { points = #[ 0 0 0  1 0 0  0 1 0 ] m, indices = #[ 0 1 9 ] }\n"
            }
        }
    }

    fn camera_text(&self) -> String {
        let [from, fov, lens] = self.camera;
        let (z, fov) = (4.0 + 0.3 * from as f64, 40 + 3 * fov);
        let look = format!(
            "look = look_at(from = (0.3, 1.5, {z}) m, to = (0, 0.4, 0) m, up = (0, 1, 0)), fov = {fov} deg"
        );
        match lens {
            0 => format!("camera thin_lens {{ {look}, f_number = 2.8, focus = 4 m }}\n"),
            _ => {
                format!("camera perspective {{ {look}, transform = move((0, 0.0{lens}, 0) m) }}\n")
            }
        }
    }

    fn settings_text(&self) -> String {
        let [size, film, integrator, seed, filter] = self.settings;
        let film = match film {
            0 => "spectral { shutter = 10 ms,",
            1 => "rgb { time = 1 s,",
            2 => "spectral { exposure = 3 EV,",
            AUTO => "auto {",
            _ => "rgb { precision = \"exact\",",
        };
        let integrator = match integrator {
            0 => "direct {}",
            1 => "ambient_occlusion {}",
            n => &format!("path {{ max_depth = {} }}", 2 * n),
        };
        let filter = ["box {}", "gaussian {}", "blackman_harris {}"][(filter % 3) as usize];
        format!(
            "film {film} resolution = ({}, 8) }}\nintegrator {integrator}\n\
             sampler sobol {{ samples = 2, seed = {seed} }}\nfilter {filter}\n",
            10 + size,
        )
    }

    fn lights_text(&self) -> String {
        let [sky, lamp, shape, fog] = self.lights;
        let sky = match sky {
            0 => "light environment { file = \"sky.hdr\" }\n".to_owned(),
            1 => "light constant { radiance = 0.3 W/m^2/sr }\n".to_owned(),
            n => format!(
                "light constant {{ spectrum = blackbody({n}000 K), radiance = 0.{n} W/m^2/sr }}\n"
            ),
        };
        let lamp = match lamp {
            0 => String::new(),
            n => format!("light point {{ position = ({n}, 3, 1) m, intensity = 8 W/sr }}\n"),
        };
        let shape = match shape {
            0 => String::new(),
            1 => "light area { shape = shape mesh { file = \"a.obj\", unit = 20 cm }, transform = move((-1, 3, 0) m), radiance = 9 W/m^2/sr }\n".to_owned(),
            n => format!("light area {{ shape = shape sphere {{ center = (-1, 3, 0) m, radius = {n} cm }}, radiance = 90 W/m^2/sr }}\n"),
        };
        let fog = match fog {
            0 => "medium homogeneous { sigma_t = 0.05 / (1 m), albedo = 0.9 }\n",
            _ => "",
        };
        format!("{sky}{lamp}{shape}{fog}")
    }
}

impl Thing {
    fn any(rng: &mut Rng) -> Self {
        let all = [THINGS, 3, VALUES, VALUES, VALUES];
        let [what, paint, at, label, part] = all.map(|n| below(rng, n));
        Self { what, paint, at, label, part }
    }

    fn text(self, i: usize) -> String {
        let Self { what, paint, at, label, part } = self;
        let (x, turn) = (at as f64 * 0.5 - 1.0, 20 * at);
        let place = format!("transform = [rotate((0, 1, 0), {turn} deg), move(({x}, 0.3, 0) m)]");
        let shape = |class: &str, body: &str| {
            format!(
                "shape {class} \"n{i}{label}\" {{ {body}, {place}, material = p.paint{paint} }}\n"
            )
        };
        let mesh = |body: &str| shape("mesh", &format!("unit = 1 m, {body}"));
        match what {
            0 => shape("sphere", "radius = 40 cm"),
            1 => format!(
                "shape box {{ size = (0.4, 0.4, 0.4) m, material = p.paint{paint}, \
                 transform = [spin((0, 1, 0), 9 deg / (1 ms)), move(({x}, 1, 0) m)] }}\n"
            ),
            2 => mesh("file = \"a.obj\""),
            3 => mesh("file = \"b.obj\", creases = #[ 0 1 2 ]"),
            4 => mesh("file = \"b.obj\", subdivide = 1, smooth = \"smooth\""),
            5 => mesh(
                "file = \"a.obj\", displace = texture image { file = \"bumps.hdr\" }, displace_by = 5 cm, edge = 30 cm",
            ),
            6 => shape(
                "difference",
                &format!(
                    "a = shape sphere {{ radius = 45 cm }}, b = shape mesh {{ file = \"a.obj\", unit = 60 cm, transform = move((0.2, 0.{part}, 0.2) m) }}"
                ),
            ),
            11 => shape(
                "difference",
                &format!(
                    "a = shape mesh {{ file = \"a.obj\", unit = 60 cm }}, b = shape sphere {{ radius = 1{part} cm, transform = move((0.1, 0.{part}, 0) m) }}"
                ),
            ),
            7 => format!(
                "let g{i} = group {{ shape disk {{ radius = 20 cm }}  shape mesh {{ file = \"b.obj\", unit = 20 cm }} }}\n\
                 place g{i} {{ {place}, material = p.paint{paint} }}\nplace g{i} {{ transform = move((0, {x}, -1) m) }}\n"
            ),
            8 => format!(
                "let o{i} = asset obj {{ file = \"a.obj\", unit = 50 cm }}\nplace o{i} {{ {place}, material = p.paint{paint} }}\n"
            ),
            9 => format!(
                "let o{i} = asset gltf {{ file = \"a.glb\", unit = 50 cm }}\nplace o{i} {{ {place} }}\n"
            ),
            _ => format!(
                "shape sphere {{ {place}, radius = 30 cm, interior = medium homogeneous {{ sigma_t = 2 / (1 m) }} }}\n"
            ),
        }
    }
}

fn bytes(file: &str, contents: u64) -> Arc<[u8]> {
    match file {
        _ if contents == BROKEN => b"no such format\nf 1 2 99\n"[..].into(),
        "a.glb" => {
            let name = ["box_sparse", "CornellBox"][(contents % 2) as usize];
            OnDisk.read(&root().join(format!("tests/data/gltf/{name}.glb"))).unwrap()
        }
        "a.obj" | "b.obj" => octahedron(contents).into_bytes().into(),
        _ => picture(contents).into(),
    }
}

/// Closed, with texture coordinates; one contents has a face without area, of which a warning tells.
pub(super) fn octahedron(contents: u64) -> String {
    let r = 0.3 + 0.07 * contents as f64;
    let mut text = String::new();
    for (x, y, z) in [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)] {
        let [x, y, z] = [x, y, z].map(|n| f64::from(n) * r);
        let _ = writeln!(text, "v {x} {y} {z}\nvt {} {}", x + 0.5, z + 0.5);
    }
    for [a, b, c] in
        [[1, 3, 5], [3, 2, 5], [2, 4, 5], [4, 1, 5], [3, 1, 6], [2, 3, 6], [4, 2, 6], [1, 4, 6]]
    {
        let _ = writeln!(text, "f {a}/{a} {b}/{b} {c}/{c}");
    }
    if contents == 3 {
        text.push_str("f 1/1 1/1 2/2\n");
    }
    text
}

/// Four by four pixels, uncompressed.
fn picture(contents: u64) -> Vec<u8> {
    let mut bytes = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 4\n".to_vec();
    let mut rng = Rng::new(contents);
    bytes.extend((0..16).flat_map(|_| {
        let [r, g, b, _] = rng.u32().to_le_bytes();
        [r | 16, g | 16, b | 16, 128]
    }));
    bytes
}

fn below(rng: &mut Rng, n: u64) -> u64 {
    rng.u64() % n
}

fn index(rng: &mut Rng, n: usize) -> usize {
    usize::try_from(below(rng, n as u64)).expect("below a length")
}
