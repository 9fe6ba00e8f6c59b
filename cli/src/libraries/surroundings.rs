//! What the environment says about plugins: a value, so that nothing else looks there.

use std::ffi::OsString;
use std::path::PathBuf;

/// The user's configuration folder and the search path of the environment.
#[derive(Clone, Debug, Default)]
pub(crate) struct Surroundings {
    /// Where `config.toml` and `plugins.lock` are.
    pub(crate) folder: Option<PathBuf>,
    /// `LUXEL_PLUGIN_PATH`.
    pub(crate) plugin_path: Option<OsString>,
}

impl Surroundings {
    /// Those of this process.
    pub(crate) fn of_process() -> Self {
        Self::told_by(|name| std::env::var_os(name))
    }

    /// Those that `get` tells. Places that are not absolute do not count: they would depend on the
    /// folder in which the program is started.
    fn told_by(get: impl Fn(&str) -> Option<OsString>) -> Self {
        let place = |name| get(name).map(PathBuf::from).filter(|path| path.is_absolute());
        let system = if cfg!(windows) {
            place("APPDATA")
        } else if cfg!(target_os = "macos") {
            place("HOME").map(|home| home.join("Library/Application Support"))
        } else {
            place("HOME").map(|home| home.join(".config"))
        };
        let folder = place("XDG_CONFIG_HOME").or(system).map(|folder| folder.join("luxel"));
        Self { folder, plugin_path: get("LUXEL_PLUGIN_PATH") }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn told(pairs: &[(&str, &str)]) -> Option<PathBuf> {
        let get = |name: &str| pairs.iter().find(|(key, _)| *key == name).map(|(_, v)| v.into());
        Surroundings::told_by(get).folder
    }

    #[test]
    fn the_configuration_is_the_users_and_never_relative() {
        assert_eq!(told(&[("XDG_CONFIG_HOME", "/x"), ("HOME", "/h")]), Some("/x/luxel".into()));
        let home = told(&[("XDG_CONFIG_HOME", "x"), ("HOME", "/h")]).unwrap();
        assert!(home.starts_with("/h") && home.ends_with("luxel"), "{home:?}");
        assert_eq!(told(&[("XDG_CONFIG_HOME", "."), ("HOME", "")]), None);
        assert_eq!(told(&[]), None);
    }
}
