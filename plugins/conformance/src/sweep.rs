//! Parameter sets: from a class's schema to objects.
//!
//! Each class is tried at its defaults, with each parameter at the ends of its range and at every
//! choice, with textures, and at random places of all ranges at once.

use std::sync::Arc;

use glam::{DVec3, Vec2};
use luxel_core::diag::{Diagnostic, SourceId, Span};
use luxel_core::files::{Files, MemoryFiles};
use luxel_core::object::{Builder, ColorMode, Object, Objects, Resolved, Scratch, Site};
use luxel_core::registry::Registry;
use luxel_core::scene::{Argument, Color, Node, NodeId, Scene, Value};
use luxel_sdk::abi::Class;
use luxel_sdk::color::{Palette, Wavelengths};
use luxel_sdk::kind::Kind;
use luxel_sdk::params::{Dimension, Param, Type};
use luxel_sdk::sampling::Rng;

use crate::values::Level;
use crate::{files, reference, values};

/// Parameters that are given, by name.
pub(crate) type Given = Vec<(&'static str, Value)>;

/// Where objects are made: the registry under test with the suite's own plugins beside it.
pub(crate) struct Bench {
    pub(crate) registry: Registry,
    files: MemoryFiles,
    /// Holds what parameters may refer to, and nothing else.
    props: Scene,
}

/// An object and how it was made.
pub(crate) struct Set {
    pub(crate) label: String,
    pub(crate) given: Given,
    pub(crate) object: Arc<Object>,
    pub(crate) level: Level,
    pub(crate) mode: ColorMode,
}

/// What was tried of a class, and the objects that could be made.
pub(crate) struct Tried {
    pub(crate) sets: Vec<Set>,
    /// Those at which its code failed, and how: what it refuses with a word is no failure.
    pub(crate) failed: Vec<String>,
    /// Parameters that were refused at every value that was tried, and why at the last.
    pub(crate) untried: Vec<String>,
}

/// Why no object of a class could be made.
pub(crate) struct Unmade {
    pub(crate) why: String,
    /// Whether its code failed, rather than refused.
    pub(crate) failed: bool,
}

/// The code of a plugin that panicked, or answered what none may.
const FAILED: &str = "E0421";

fn has_failed(found: &[Diagnostic]) -> bool {
    found.iter().any(|d| d.code == FAILED)
}

impl Set {
    /// Asks the object at one place, for as long as the closure runs.
    pub(crate) fn ask<R>(&self, f: impl FnOnce(Resolved<'_>) -> R) -> R {
        let palette = match self.mode {
            ColorMode::Rgb => Palette::rgb(),
            ColorMode::Spectral => Palette::new(Wavelengths::sample(0.37)),
        };
        let scratch = Scratch::default();
        let site = Site {
            p: DVec3::new(0.3, -0.2, 0.7),
            uv: Vec2::new(0.3, 0.7),
            palette: &palette,
            color: None,
        };
        f(self.object.resolve(&site, &scratch))
    }

    /// A number that was given, or the default.
    pub(crate) fn number(&self, name: &str) -> Option<f64> {
        let given = self.given.iter().find(|(given, _)| *given == name);
        match given.map(|(_, value)| value) {
            Some(Value::Number(x, _) | Value::Color(Color::Constant(x), _)) => Some(*x),
            Some(_) => None,
            None => {
                let params = self.object.class().params;
                let param = params.iter().find(|param| param.name == name)?;
                values::preset(param)
            }
        }
    }
}

impl Bench {
    /// A bench around a registry. Where a name is taken, the registry's own plugin stays.
    pub(crate) fn new(registry: &Registry) -> Self {
        let mut registry = registry.clone();
        for class in reference::CLASSES {
            // A conflict leaves the plugin that was there.
            registry.add("conformance", &[*class]).ok();
        }
        let mut props = Scene::default();
        for (kind, class) in PROPS {
            node(&mut props, kind, class, &[]);
        }
        for (scale, place) in PLACES {
            for (center, radius) in ORBS {
                let center = (center * scale + place).to_array().to_vec();
                let given = [
                    ("center", Value::vector(center)),
                    ("radius", Value::Number(radius * scale, Dimension::LENGTH)),
                ];
                node(&mut props, Kind::Shape, "reference_orb", &given);
            }
        }
        Self { registry, files: files::memory(), props }
    }

    /// A scene that holds the props and nothing else.
    pub(crate) fn scene(&self) -> Scene {
        self.props.clone()
    }

    /// Files that scenes may read.
    pub(crate) fn files(&self) -> &MemoryFiles {
        &self.files
    }

    /// An object of a class.
    pub(crate) fn build(
        &self,
        class: &Class,
        given: &Given,
        mode: ColorMode,
    ) -> Result<Arc<Object>, Vec<Diagnostic>> {
        self.build_of(&self.files, class, given, mode)
    }

    /// An object of a class that reads these files.
    pub(crate) fn build_of(
        &self,
        files: &dyn Files,
        class: &Class,
        given: &Given,
        mode: ColorMode,
    ) -> Result<Arc<Object>, Vec<Diagnostic>> {
        let mut scene = self.props.clone();
        let id = node(&mut scene, class.kind, class.name, given);
        let before = Objects::default();
        let mut builder = Builder::new(&self.registry, &scene, files, mode, &before);
        let object = builder.build(id);
        object.ok_or(builder.diagnostics)
    }

    /// The sets of a class, the first of which is nominal; or why none can be made.
    pub(crate) fn sets(&self, class: &Class, seed: u64, n: usize) -> Result<Tried, Unmade> {
        let nominal = self.nominal(class)?;
        let made = Tried { sets: vec![], failed: vec![], untried: vec![] };
        let mut sweep = Sweep { bench: self, class, nominal, made };
        // It could be made before.
        sweep.push("as by default", Level::Usual, sweep.nominal.clone()).ok();
        for param in own(class) {
            sweep.extremes(param);
        }
        sweep.textures();
        sweep.spectra();
        sweep.switches();
        let mut rng = Rng::new(seed);
        for i in 0..n {
            sweep.random(&mut rng, &format!("random {i}"), i % 3 == 2);
        }
        Ok(sweep.made)
    }

    /// The least that an object of the class needs.
    fn nominal(&self, class: &Class) -> Result<Given, Unmade> {
        let (mut why, mut failed) = (String::new(), false);
        for member in 0..4 {
            for optional in [Optional::None, Optional::All, Optional::Numbers] {
                for file in files::NAMES.into_iter().chain([""]) {
                    let given = least(class, member, optional, file);
                    match self.build(class, &given, ColorMode::Rgb) {
                        Ok(_) => return Ok(given),
                        Err(found) => {
                            // A failure counts for more than what was refused before it.
                            let fails = has_failed(&found);
                            if why.is_empty() || (fails && !failed) {
                                (why, failed) = (said(&found), fails);
                            }
                        }
                    }
                }
            }
        }
        let why = format!("no parameters are known with which it can be made: {why}");
        Err(Unmade { why, failed })
    }
}

/// Kinds and classes of the props, in the order of their nodes.
const PROPS: [(Kind, &str); 5] = [
    (Kind::Texture, "reference_gradient"),
    (Kind::Material, "reference_matt"),
    (Kind::Material, "reference_veil"),
    (Kind::Phase, "isotropic"),
    (Kind::Shape, "reference_ball"),
];

/// Added to a place to have it far away, metres.
pub(crate) const FAR: DVec3 = DVec3::new(1e6, -1e6, 1e6);
/// How large, and where, parts of shapes are: as usual, and as `shape::placed` wants the whole.
const PLACES: [(f64, DVec3); 4] =
    [(1.0, DVec3::ZERO), (1e-6, DVec3::ZERO), (1e6, DVec3::ZERO), (1.0, FAR)];
/// Middles and radii of the parts: neither holds the other, and they meet.
const ORBS: [(DVec3, f64); 2] = [(DVec3::ZERO, 1.0), (DVec3::new(0.7, 0.3, -0.2), 0.8)];

/// A part of a shape, for the parameter of that number: `place` as in `PLACES`.
pub(crate) fn part(index: usize, place: usize) -> Value {
    let at = PROPS.len() + place * ORBS.len() + index % ORBS.len();
    Value::Node(NodeId(u32::try_from(at).expect("there are few props")))
}

/// The prop of a type: the node that such a handle may be; where there are several, `index` tells which, so that two children differ.
fn prop(ty: Type, index: usize) -> Option<Value> {
    let kind = match ty {
        Type::Part => return Some(part(index, 0)),
        Type::Object(kind) => kind,
        _ => return None,
    };
    let props: Vec<u32> = (0..).zip(PROPS).filter(|(_, p)| p.0 == kind).map(|(i, _)| i).collect();
    let id = props.get(index % props.len().max(1))?;
    Some(Value::Node(NodeId(*id)))
}

/// What was found wrong, in one line.
pub(crate) fn said(found: &[Diagnostic]) -> String {
    let messages: Vec<&str> = found.iter().map(|d| d.message.as_str()).collect();
    messages.join("; ")
}

/// Adds a node whose arguments each have a place of their own.
pub(crate) fn node(
    scene: &mut Scene,
    kind: Kind,
    class: &'static str,
    given: &[(&'static str, Value)],
) -> NodeId {
    let span = |i: usize| Span::new(SourceId(0), i, i + 1);
    let arguments = given.iter().enumerate();
    let params = arguments
        .map(|(i, (name, value))| Argument { name, value: value.clone(), span: span(i + 1) })
        .collect();
    let (label, overrides) = (None, vec![]);
    let (span, hash) = (span(0), [0; 32]);
    scene.add(Node { kind, class, label, params, overrides, span, hash })
}

/// The parameters that the class itself reads.
pub(crate) fn own(class: &Class) -> impl Iterator<Item = &'static Param> + use<> {
    class.params.iter().filter(|param| param.offset != usize::MAX && param.deprecated.is_empty())
}

/// Which optional parameters without a default are given: some classes need a few, others refuse all of
/// them together.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Optional {
    None,
    All,
    Numbers,
}

/// What is required; of each group the given member; and optional ones, if wanted.
fn least(class: &Class, member: usize, optional: Optional, file: &str) -> Given {
    let mut given = vec![];
    for (i, param) in own(class).enumerate() {
        let wanted = if param.group.is_empty() {
            let absent = values::preset(param).is_none();
            let more = match optional {
                Optional::None => values::is_needed(param),
                Optional::All => true,
                Optional::Numbers => values::is_needed(param) || values::is_number(param),
            };
            param.required || (absent && more)
        } else {
            let members: Vec<&str> =
                own(class).filter(|p| p.group == param.group).map(|p| p.name).collect();
            members[member.min(members.len() - 1)] == param.name
        };
        if wanted && let Some(value) = values::sensible(param, i, file, prop) {
            given.push((param.name, value));
        }
    }
    given
}

struct Sweep<'a> {
    bench: &'a Bench,
    class: &'a Class,
    nominal: Given,
    made: Tried,
}

impl Sweep<'_> {
    /// Adds a set if it can be made; else why not. Combinations that the plugin refuses are no sets;
    /// those at which it fails are told.
    fn push(&mut self, label: impl Into<String>, level: Level, given: Given) -> Result<(), String> {
        self.push_in(label, level, given, ColorMode::Rgb)
    }

    fn push_in(
        &mut self,
        label: impl Into<String>,
        level: Level,
        given: Given,
        mode: ColorMode,
    ) -> Result<(), String> {
        let label = label.into();
        match self.bench.build(self.class, &given, mode) {
            Ok(object) => self.made.sets.push(Set { label, given, object, level, mode }),
            Err(found) => {
                let told = format!("{label}: {}", said(&found));
                if has_failed(&found) {
                    self.made.failed.push(told.clone());
                }
                return Err(told);
            }
        }
        Ok(())
    }

    /// The nominal set with one parameter changed; the others of its group go.
    fn with(&self, param: &Param, value: Value) -> Given {
        let rival = |name: &str| {
            let same = |p: &&Param| p.name == name && p.group == param.group;
            !param.group.is_empty() && own(self.class).any(|p| same(&p))
        };
        let mut given = self.nominal.clone();
        given.retain(|(name, _)| *name != param.name && !rival(name));
        given.push((param.name, value));
        given
    }

    fn extremes(&mut self, param: &'static Param) {
        let (mut tried, mut refused) = (false, None);
        for (value, level) in values::extremes(param) {
            let label = format!("{} = {}", param.name, values::show(&value));
            let given = self.with(param, value);
            match self.push(label, level, given) {
                Ok(()) => tried = true,
                Err(why) => refused = Some(why),
            }
        }
        self.made.untried.extend(refused.filter(|_| !tried));
    }

    /// Every parameter that may be textured, so.
    fn textures(&mut self) {
        let mut given = self.nominal.clone();
        let mut any = false;
        for param in own(self.class).filter(|param| param.textured && param.group.is_empty()) {
            given.retain(|(name, _)| *name != param.name);
            given.extend(prop(Type::Object(Kind::Texture), 0).map(|value| (param.name, value)));
            any = true;
        }
        if any && let Err(why) = self.push("textured", Level::Usual, given) {
            self.made.untried.push(why);
        }
    }

    /// Measured indices of refraction, at wavelengths.
    fn spectra(&mut self) {
        for param in own(self.class) {
            if let Some(value) = values::measured(param) {
                let mut given = self.with(param, value);
                given.retain(|(name, _)| *name != "k");
                self.push_in("measured", Level::Usual, given, ColorMode::Spectral).ok();
            }
        }
    }

    /// Each amount of light with each switch turned: what shares an amount shows only so.
    fn switches(&mut self) {
        let amount = |p: &&Param| p.ty == Type::Emission && !p.group.is_empty();
        for switch in own(self.class).filter(|param| param.ty == Type::Bool) {
            let turned = !values::preset(switch).is_some_and(|x| x > 0.5);
            for param in own(self.class).filter(amount) {
                let Some(value) = values::sensible(param, 0, "", prop) else { continue };
                let mut given = self.with(param, value);
                given.retain(|(name, _)| *name != switch.name);
                given.push((switch.name, Value::Bool(turned)));
                let label = format!("{}, {} = {turned}", param.name, switch.name);
                self.push(label, Level::Usual, given).ok();
            }
        }
    }

    /// Everything anywhere in its range; with `bright`, colours at the end of theirs. Some
    /// combinations are refused, so that several are tried.
    fn random(&mut self, rng: &mut Rng, label: &str, bright: bool) {
        for _ in 0..8 {
            let mut given = self.nominal.clone();
            for param in own(self.class) {
                let at = given.iter().position(|(name, _)| *name == param.name);
                let stays = at.is_none() && !param.group.is_empty();
                if stays || (rng.f32() < 0.3 && !bright) {
                    continue;
                }
                let Some(value) = values::draw(param, rng, bright) else { continue };
                match at {
                    Some(at) => given[at].1 = value,
                    None => given.push((param.name, value)),
                }
            }
            let shown: Vec<String> = given
                .iter()
                .map(|(name, value)| format!("{name} = {}", values::show(value)))
                .collect();
            let label = format!("{label}: {}", shown.join(", "));
            if self.push(label, Level::Usual, given).is_ok() {
                return;
            }
        }
    }
}
