//! What is varied, one thing at a time.

use luxel_core::accel::Precision;
use luxel_core::registry::Registry;
use luxel_core::scene::{Feature, Scene, Setting, Value};
use luxel_core::stage::Stage;
use luxel_sdk::params::Dimension as Unit;

use crate::args::droppable;
use crate::exit::{Exit, Failure};

/// Something that may be varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Dimension {
    Spp,
    Depth,
    Roulette,
    Sampler,
    Integrator,
    Precision,
    Color,
    Filter,
    Drop,
}

impl Dimension {
    const ALL: [Self; 9] = [
        Self::Spp,
        Self::Depth,
        Self::Roulette,
        Self::Sampler,
        Self::Integrator,
        Self::Precision,
        Self::Color,
        Self::Filter,
        Self::Drop,
    ];

    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Spp => "spp",
            Self::Depth => "depth",
            Self::Roulette => "rr",
            Self::Sampler => "sampler",
            Self::Integrator => "integrator",
            Self::Precision => "precision",
            Self::Color => "color",
            Self::Filter => "filter",
            Self::Drop => "drop",
        }
    }

    /// What it takes unless the command line says it.
    fn usual(self) -> &'static [&'static str] {
        match self {
            Self::Spp => &["4", "16", "64"],
            Self::Depth => &["2", "4", "8"],
            Self::Roulette => &["0", "8", "32"],
            Self::Sampler => &["independent", "sobol"],
            Self::Integrator => &["path", "direct"],
            Self::Precision => &["fast", "standard", "exact"],
            Self::Color => &["rgb", "spectral"],
            Self::Filter => &["box", "gaussian", "blackman_harris"],
            Self::Drop => &["spectral", "media", "nested", "motion"],
        }
    }

    /// The setting that it belongs to, if it is one that a scene writes.
    pub(super) fn setting(self) -> Option<Setting> {
        match self {
            Self::Spp | Self::Sampler => Some(Setting::Sampler),
            Self::Depth | Self::Roulette | Self::Integrator => Some(Setting::Integrator),
            Self::Precision | Self::Color => Some(Setting::Film),
            Self::Filter => Some(Setting::Filter),
            Self::Drop => None,
        }
    }

    /// The parameter that it is, if it is a number.
    fn param(self) -> Option<&'static str> {
        match self {
            Self::Depth => Some("max_depth"),
            Self::Roulette => Some("russian_roulette_from"),
            _ => None,
        }
    }

    fn check(self, value: &str) -> Result<(), String> {
        let name = self.word();
        let least = u32::from(self == Self::Spp);
        let fits = match self {
            Self::Spp | Self::Depth | Self::Roulette => {
                value.parse::<u32>().is_ok_and(|n| n >= least)
            }
            Self::Precision => Precision::of_word(value).is_some(),
            Self::Color => ["rgb", "spectral"].contains(&value),
            Self::Drop => return droppable(value).map(|_| ()),
            // The registry knows these.
            Self::Sampler | Self::Integrator | Self::Filter => true,
        };
        if fits { Ok(()) } else { Err(format!("`{name}` cannot be `{value}`")) }
    }
}

/// A setting of the scene with another value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Change {
    pub(super) dimension: Dimension,
    pub(super) value: String,
}

impl Change {
    /// A feature left out.
    pub(super) fn dropping(feature: Feature) -> Self {
        Self { dimension: Dimension::Drop, value: feature.name().to_owned() }
    }

    /// `depth=4`
    pub(super) fn name(&self) -> String {
        format!("{}={}", self.dimension.word(), self.value)
    }

    /// Changes a scene that was made of classes of this registry.
    ///
    /// # Errors
    /// A class that there is not; a parameter that the class at hand has not.
    pub(super) fn apply(&self, scene: &mut Scene, registry: &Registry) -> Result<(), String> {
        let value = &self.value;
        let Some(setting) = self.dimension.setting() else {
            return scene.leave_out(droppable(value)?).map_err(str::to_owned);
        };
        let class = scene.setting(setting).map_or(setting.default_class(), |node| node.class);
        if let Some(name) = self.dimension.param() {
            let class = registry.class(setting.kind(), class);
            if !class.is_some_and(|class| class.params.iter().any(|param| param.name == name)) {
                return Err(format!("the scene's {} has no `{name}`", setting.kind()));
            }
            let number = value.parse().map_err(|_| format!("`{value}` is no number"))?;
            scene.set_param(setting, name, Value::Number(number, Unit::NONE));
        } else if self.dimension == Dimension::Precision {
            scene.set_param(setting, "precision", Value::Text(value.as_str().into()));
        } else if let Some(class) = registry.class(setting.kind(), value) {
            scene.set_class(setting, class.name);
        } else {
            return Err(format!("there is no {} `{value}`", setting.kind()));
        }
        Ok(())
    }

    /// Whether the stage is so already.
    pub(super) fn is_of(&self, stage: &Stage) -> bool {
        let value = self.value.as_str();
        let class = match self.dimension {
            Dimension::Precision => return stage.film.precision.word() == value,
            Dimension::Color => return format!("{:?}", stage.mode).to_lowercase() == value,
            Dimension::Sampler => stage.sampler.class().name,
            Dimension::Integrator => stage.integrator.class().name,
            Dimension::Filter => stage.filter.class().name,
            Dimension::Drop => return droppable(value).is_ok_and(|feature| !stage.needs(feature)),
            Dimension::Spp | Dimension::Depth | Dimension::Roulette => {
                let node =
                    self.dimension.setting().and_then(|setting| stage.scene.setting(setting));
                let given = self.dimension.param().and_then(|name| node?.get(name));
                let number = value.parse().map(|number| Value::Number(number, Unit::NONE));
                return given.is_some_and(|given| number.as_ref() == Ok(&given.value));
            }
        };
        class == value
    }
}

/// All that is varied.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Sweep {
    /// Numbers of samples, rising; at least two.
    pub(super) spp: Vec<u32>,
    pub(super) changes: Vec<Change>,
}

/// Reads `spp,depth=2,4,sampler`: words, each with its values or with the usual ones.
pub(super) fn sweep(text: &str) -> Result<Sweep, String> {
    let mut found: Vec<(Dimension, Vec<&str>)> = vec![];
    for part in text.split(',').map(str::trim) {
        let (word, value) = part.split_once('=').map_or((part, None), |(w, v)| (w, Some(v)));
        let dimension = Dimension::ALL.into_iter().find(|dimension| dimension.word() == word);
        match (dimension, value, found.last_mut()) {
            (Some(dimension), value, _) => found.push((dimension, value.into_iter().collect())),
            // One more value of the word before.
            (None, None, Some((_, values))) if !values.is_empty() => values.push(word),
            _ => {
                let known = Dimension::ALL.map(Dimension::word).join(", ");
                return Err(format!(
                    "nothing can be swept that is called `{word}`: known: {known}"
                ));
            }
        }
    }
    let mut changes = vec![];
    let mut spp: Vec<u32> = vec![];
    for (dimension, mut values) in found {
        if values.is_empty() {
            values = dimension.usual().to_vec();
        }
        for value in values {
            dimension.check(value)?;
            match dimension {
                Dimension::Spp => spp.extend(value.parse::<u32>()),
                _ => changes.push(Change { dimension, value: value.to_owned() }),
            }
        }
    }
    if spp.is_empty() {
        spp.extend(Dimension::Spp.usual().iter().flat_map(|n| n.parse::<u32>()));
    }
    spp.sort_unstable();
    spp.dedup();
    if spp.len() < 2 {
        return Err("two numbers of samples at least tell how the error falls".to_owned());
    }
    Ok(Sweep { spp, changes })
}

/// The failure of a change that cannot be made.
pub(super) fn unfit(message: String) -> Failure {
    Failure::new(Exit::Usage, message).help("`luxel list` shows what there is")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sweep_names_what_is_varied_and_perhaps_its_values() {
        let read = sweep("depth=2,4,spp=64,16,precision").unwrap();
        let names: Vec<_> = read.changes.iter().map(Change::name).collect();
        let precision = ["precision=fast", "precision=standard", "precision=exact"];
        assert_eq!(names, [&["depth=2", "depth=4"][..], &precision].concat());
        assert_eq!((read.spp, sweep("rr=0").unwrap().spp), (vec![16, 64], vec![4, 16, 64]));
    }

    #[test]
    fn what_cannot_be_swept_is_refused_in_words() {
        let refused = |text: &str, words: &str| {
            let message = sweep(text).unwrap_err();
            assert!(message.contains(words), "{text}: {message}");
        };
        refused("colour", "called `colour`: known: spp, depth, rr, sampler,");
        refused("depth,4", "called `4`");
        refused("depth=deep", "`depth` cannot be `deep`");
        refused("spp=0,4", "`spp` cannot be `0`");
        refused("precision=best", "`precision` cannot be `best`");
        refused("drop=open_surfaces", "drop `media`");
        refused("spp=4", "two numbers of samples at least");
    }

    #[test]
    fn a_change_asks_the_registry() {
        let registry = Registry::new();
        let apply = |text: &str| {
            let change = sweep(text).unwrap().changes.remove(0);
            change.apply(&mut Scene::default(), &registry).map_err(|message| message.clone())
        };
        assert_eq!(apply("sampler=dice"), Err("there is no sampler `dice`".to_owned()));
        let message = "the scene's integrator has no `max_depth`".to_owned();
        assert_eq!(apply("depth=2"), Err(message));
        assert_eq!(apply("color=rgb"), Ok(()));
    }
}
