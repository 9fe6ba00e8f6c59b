//! Which libraries are opened, without one that opens.

use std::cell::RefCell;
use std::fs;
use std::rc::Rc;

use super::*;
use crate::libraries::Entry;
use crate::testing::Folder;

/// What was opened: stem and generation.
type Log = Rc<RefCell<Vec<(String, u32)>>>;

/// A folder with plugins and a configuration, and a session that opens nothing but writes it down.
/// The bytes of a "library" say what it offers: `bad`, or the name of a filter.
struct Place {
    folder: Folder,
    args: PluginArgs,
    surroundings: Surroundings,
    session: Session,
    log: Log,
}

impl Place {
    fn new(name: &str) -> Self {
        let folder = Folder::new(name);
        let args = PluginArgs { dirs: vec![folder.path("plugins")], ..PluginArgs::default() };
        let surroundings =
            Surroundings { folder: Some(folder.path("config")), ..Surroundings::default() };
        let log = Log::default();
        let writes = log.clone();
        let session = Session::opening_with(Box::new(move |copy, stem, generation| {
            writes.borrow_mut().push((stem.to_owned(), generation));
            let bytes = crate::files::read_regular(copy).map_err(|error| error.to_string())?;
            let text = String::from_utf8(bytes).map_err(|error| error.to_string())?;
            let source = luxel_builtin::CLASSES.iter().flat_map(|classes| classes.iter());
            let mut class = *source.into_iter().find(|class| class.name == "gaussian").unwrap();
            class.name = match text.as_str() {
                "tent" => "tent",
                "box" => "box",
                text if text.starts_with("cone") => "cone",
                _ => return Err("it has no table".into()),
            };
            let [name, version, abi] = [stem, "1.0.0", "1.0"].map(str::to_owned);
            Ok(Opened { name, version, abi, generation, classes: vec![class] })
        }));
        let place = Self { folder, args, surroundings, session, log };
        place.folder.write("plugins/none.txt", b"");
        place
    }

    fn write(&self, stem: &str, text: &str) {
        self.folder.write(&format!("plugins/{}", search::file_name(stem)), text.as_bytes());
    }

    fn trust(&self, stem: &str) {
        let path = self.folder.path(&format!("plugins/{}", search::file_name(stem)));
        let sha256 = PrivateCopy::take(&path, stem, 0).unwrap().sha256;
        let path = fs::canonicalize(path).unwrap();
        let [stem, name, version, abi] = [stem, stem, "1.0.0", "1.0"].map(str::to_owned);
        let home = self.folder.path("config");
        let mut lock = Lock::read(Some(&home)).unwrap();
        lock.put(Entry { stem, name, version, abi, sha256, path });
        lock.write(&home).unwrap();
    }

    fn refresh(&mut self) -> Plugins {
        self.session.refresh(&self.args, &self.surroundings).unwrap()
    }

    fn opened(&self) -> Vec<(String, u32)> {
        self.log.borrow().clone()
    }
}

fn has(plugins: &Plugins, name: &str) -> bool {
    plugins.registry.class(luxel_sdk::kind::Kind::Filter, name).is_some()
}

#[test]
fn only_what_the_lock_lists_is_opened() {
    let mut place = Place::new("session-lock");
    place.write("mine", "tent");
    place.write("other", "cone");
    let plugins = place.refresh();
    assert!(place.opened().is_empty() && !has(&plugins, "tent"));
    assert!(plugins.notes.messages().is_empty(), "nobody asked for them");
    let advice: Vec<_> = plugins.unloaded().into_iter().map(|one| one.advice).collect();
    assert!(advice.len() == 2 && advice[0].contains("luxel plugin trust "), "{advice:?}");
    place.trust("mine");
    let plugins = place.refresh();
    assert_eq!(place.opened(), [("mine".to_owned(), 0)]);
    assert!(has(&plugins, "tent") && !has(&plugins, "cone"));
    assert_eq!(plugins.unloaded().len(), 1);
    // The hash decides: under another stem the same bytes are not trusted.
    place.write("other", "tent");
    place.refresh();
    assert_eq!(place.opened().len(), 1);
}

#[test]
fn for_development_everything_is_opened() {
    let mut place = Place::new("session-all");
    place.args.allow_unlocked_plugins = true;
    place.write("b", "cone");
    place.write("a", "tent");
    let plugins = place.refresh();
    assert_eq!(place.opened(), [("a".to_owned(), 0), ("b".to_owned(), 0)]);
    assert!(has(&plugins, "cone") && has(&plugins, "tent"));
}

#[test]
fn a_class_that_exists_leaves_the_whole_library_out_and_names_both() {
    let mut place = Place::new("session-conflict");
    place.args.allow_unlocked_plugins = true;
    place.write("a", "tent");
    place.write("b", "tent");
    place.write("c", "box");
    let plugins = place.refresh();
    let told = plugins.notes.messages();
    assert_eq!(told.len(), 2, "{told:?}");
    assert!(told[0].contains("`filter tent` comes from both `a` and `b`"), "{told:?}");
    assert!(told[1].contains("`filter box` comes from both `builtin` and `c`"), "{told:?}");
}

#[test]
fn a_new_generation_serves_and_a_failed_one_leaves_the_old_in_use() {
    let mut place = Place::new("session-generations");
    place.args.allow_unlocked_plugins = true;
    place.write("mine", "tent");
    let first = place.refresh();
    assert!(has(&first, "tent"));
    // The same bytes again: nothing is opened.
    place.refresh();
    assert_eq!(place.opened().len(), 1);
    place.write("mine", "bad");
    let broken = place.refresh();
    assert!(has(&broken, "tent"));
    let told = broken.notes.messages();
    assert!(told[0].contains("no table") && told[0].contains("stays in use"), "{told:?}");
    // What did not open is not tried again.
    place.refresh();
    assert_eq!(place.opened().len(), 2);
    place.write("mine", "cone");
    let second = place.refresh();
    assert!(has(&second, "cone") && !has(&second, "tent"));
    assert_eq!(place.opened().last(), Some(&("mine".to_owned(), 2)));
    fs::remove_file(place.folder.path(&format!("plugins/{}", search::file_name("mine")))).unwrap();
    let gone = place.refresh();
    assert!(has(&gone, "cone") && gone.notes.messages()[0].contains("is gone"));
}

#[test]
fn a_change_without_trust_opens_nothing_and_trust_or_distrust_takes_effect() {
    let mut place = Place::new("session-changed");
    place.write("mine", "tent");
    place.trust("mine");
    place.refresh();
    place.write("mine", "cone");
    let changed = place.refresh();
    assert!(has(&changed, "tent") && place.opened().len() == 1);
    assert!(changed.notes.messages()[0].contains("has changed since it was trusted"));
    let mut afresh = Session::opening_with(Box::new(|_, _, _| panic!("nothing is opened")));
    let seen = afresh.refresh(&place.args, &place.surroundings).unwrap();
    assert!(matches!(seen.libraries[0].state, State::Changed));
    place.trust("mine");
    assert!(has(&place.refresh(), "cone"));
    Lock::default().write(&place.folder.path("config")).unwrap();
    assert!(!has(&place.refresh(), "cone"));
}

#[test]
fn many_generations_are_told() {
    let mut place = Place::new("session-many");
    place.args.allow_unlocked_plugins = true;
    for n in 1..MANY {
        place.write("mine", &format!("cone{n}"));
        assert!(place.refresh().notes.messages().is_empty(), "{n}");
    }
    place.write("mine", "cone");
    let told = place.refresh();
    assert!(told.notes.messages()[0].starts_with("200 generations of `mine`"));
}

#[test]
fn what_the_lock_lists_beside_the_search_path_is_told() {
    let mut place = Place::new("session-elsewhere");
    place.write("mine", "tent");
    place.trust("mine");
    place.args.dirs.clear();
    let plugins = place.refresh();
    assert!(matches!(plugins.libraries[0].state, State::Elsewhere));
    assert!(plugins.unloaded()[0].advice.contains("--plugin-dir"));
    assert!(place.opened().is_empty());
    fs::remove_file(place.folder.path(&format!("plugins/{}", search::file_name("mine")))).unwrap();
    assert!(matches!(place.refresh().libraries[0].state, State::Missing));
}

#[test]
fn everything_that_could_change_the_outcome_is_watched() {
    let mut place = Place::new("session-watched");
    place.write("mine", "tent");
    place.trust("mine");
    place.write("other", "cone");
    let stays = |plugins: &Plugins| plugins.watched.iter().all(|(path, seen)| look(path) == *seen);
    let plugins = place.refresh();
    assert!(stays(&plugins));
    // Bytes that nobody trusts do not matter, nor do files that are no libraries.
    place.write("other", "tent");
    place.folder.write("plugins/notes.txt", b"");
    assert!(stays(&plugins));
    for change in [
        &|place: &Place| place.write("mine", "cone"),
        &|place: &Place| place.write("new", "cone"),
        &|place: &Place| place.trust("new"),
        &|place: &Place| place.folder.write("config/config.toml", b"# mine"),
    ] as [&dyn Fn(&Place); 4]
    {
        let plugins = place.refresh();
        assert!(stays(&plugins));
        change(&place);
        assert!(!stays(&plugins));
    }
}
