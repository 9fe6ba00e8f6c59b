//! What is noticed and what is not, by one file; `saves` has the many ways to save one.

use std::fs;

use notify::event::{AccessKind, AccessMode, DataChange, Event, EventKind, Flag, ModifyKind};

use super::*;
use crate::testing::Folder;

/// Far above the longest wait of `Changes`, on a busy machine.
const LONG: Duration = Duration::from_secs(10);

fn watching(folder: &Folder, names: &[&str]) -> (Changes, Sender<Wake>) {
    let (mut changes, sender) = Changes::new();
    let seen = |name: &&str| (folder.path(name), look(&folder.path(name)));
    changes.expect(names.iter().map(seen).collect());
    (changes, sender)
}

/// What a wait ends with after `act`; a guard ends it when nothing is noticed.
fn noticed(folder: &Folder, act: impl FnOnce(&Folder) + Send, within: Duration) -> bool {
    let (mut changes, sender) = watching(folder, &["a.scene"]);
    std::thread::scope(|scope| {
        let waiting = scope.spawn(move || changes.wait());
        act(folder);
        let since = Instant::now();
        while !waiting.is_finished() && since.elapsed() < within {
            std::thread::sleep(Duration::from_millis(5));
        }
        let _ = sender.send(Wake::Stop);
        waiting.join().unwrap()
    })
}

#[test]
fn a_file_that_appears_or_goes_is_noticed() {
    let folder = Folder::new("watch-new");
    assert!(noticed(&folder, |folder| folder.write("a.scene", b"one"), LONG));
    let remove = |folder: &Folder| fs::remove_file(folder.path("a.scene")).unwrap();
    assert!(noticed(&folder, remove, LONG));
}

#[test]
fn a_file_whose_folders_appear_later_is_noticed() {
    let folder = Folder::new("watch-deep");
    let (mut changes, _sender) = watching(&folder, &["meshes/far/a.obj"]);
    folder.write("meshes/far/a.obj", b"v 0 0 0");
    assert!(changes.wait());
}

#[test]
fn saves_that_change_no_byte_and_other_files_are_not_noticed() {
    let folder = Folder::new("watch-same");
    folder.write("a.scene", b"one");
    let act = |folder: &Folder| {
        folder.write("a.scene", b"one");
        folder.write("a.png", b"picture");
    };
    assert!(!noticed(&folder, act, CLOSE * 4 + ANYWAY));
}

#[test]
fn saves_are_noticed_by_stamps_where_the_system_tells_nothing() {
    let folder = Folder::new("watch-deaf");
    folder.write("a.scene", b"one");
    let (mut changes, _sender) = Changes::hearing(|_| Ears::deaf());
    let path = folder.path("a.scene");
    changes.expect(BTreeMap::from([(path.clone(), look(&path))]));
    assert_eq!(changes.anyway, FAR);
    assert_eq!(changes.within(Duration::ZERO), Noticed::Nothing);
    let modified = fs::metadata(&path).unwrap().modified().unwrap();
    std::thread::sleep(Duration::from_millis(20));
    folder.write("a.scene", b"two");
    let file = fs::OpenOptions::new().write(true).open(&path).unwrap();
    file.set_modified(modified).unwrap();
    assert!(changes.wait());
}

/// Tells what the system would tell.
type Tells = Box<dyn Fn(notify::Result<Event>)>;

/// Watches one file and hears what it is told alone: nothing is compared without a reason.
fn told(path: &Path) -> (Changes, Tells) {
    let mut tells: Option<Tells> = None;
    let (mut changes, _sender) = Changes::hearing(|wake| {
        let ears = Ears::deaf();
        tells = Some(Box::new(ears.hearing(wake)));
        ears
    });
    changes.expect(BTreeMap::from([(path.to_path_buf(), look(path))]));
    changes.anyway = LONG * 10;
    assert_eq!(changes.within(Duration::ZERO), Noticed::Nothing);
    (changes, tells.expect("it was made"))
}

/// Some events were: anything may have happened.
fn lost() -> Event {
    Event::new(EventKind::Other).set_flag(Flag::Rescan)
}

#[test]
fn what_the_system_could_not_tell_is_looked_for() {
    for what in [Ok(lost()), Err(notify::Error::generic("the queue is full"))] {
        let folder = Folder::new("watch-overflow");
        folder.write("a.scene", b"one");
        let (mut changes, tell) = told(&folder.path("a.scene"));
        folder.write("a.scene", b"two");
        assert_eq!(changes.within(CLOSE * 2), Noticed::Nothing);
        tell(what);
        assert_eq!(changes.within(LONG), Noticed::Save);
    }
}

#[test]
fn a_large_file_is_not_hashed_as_a_whole_to_notice_that_it_is_another() {
    let folder = Folder::new("watch-large");
    let (path, large) = (folder.path("a.ply"), vec![7; (1 << 20) + 1]);
    for at in [0, 1 << 19, 1 << 20] {
        folder.write("a.ply", &large);
        let (mut changes, tell) = told(&path);
        folder.write("a.ply", &large);
        tell(Ok(lost()));
        assert_eq!(changes.within(LONG), Noticed::Nothing);
        assert!(changes.found.contains_key(&path), "what is the same is hashed to be sure");
        let mut other = large.clone();
        other[at] = 8;
        folder.write("a.ply", &other);
        tell(Ok(lost()));
        assert_eq!(changes.within(LONG), Noticed::Save);
        assert!(!changes.found.contains_key(&path), "a difference at {at}");
        // A load that does not tell what it saw has seen this.
        changes.expect_more_than(Watched::new(), []);
        assert_eq!(changes.within(Duration::ZERO), Noticed::Nothing);
    }
}

#[test]
fn what_was_saved_between_a_load_and_the_wait_is_noticed() {
    let folder = Folder::new("watch-between");
    folder.write("a.scene", b"one");
    let (mut changes, _sender) = Changes::new();
    let path = folder.path("a.scene");
    changes.arm([path.as_path()]);
    let seen = look(&path);
    folder.write("a.scene", b"two");
    changes.expect(BTreeMap::from([(path.clone(), seen)]));
    assert_eq!(changes.within(Duration::ZERO), Noticed::Save);
    // The same, with a load that ends without a word of what it saw.
    changes.expect(BTreeMap::from([(path.clone(), look(&path))]));
    assert_eq!(changes.within(Duration::ZERO), Noticed::Nothing);
    folder.write("a.scene", b"three");
    changes.expect_more_than(Watched::new(), [path.as_path()]);
    assert_eq!(changes.within(Duration::ZERO), Noticed::Save);
}

#[test]
fn a_large_file_is_not_read_while_somebody_writes_it() {
    let folder = Folder::new("watch-open");
    let (path, mut large) = (folder.path("a.ply"), vec![7; 1 << 20]);
    folder.write("a.ply", &large);
    let (mut changes, tell) = told(&path);
    let before = changes.found.clone();
    let event = |kind| Ok(Event::new(kind).add_path(path.clone()));
    let written = || event(EventKind::Modify(ModifyKind::Data(DataChange::Any)));
    large[9] = 8;
    folder.write("a.ply", &large);
    tell(written());
    let heard = changes.ears.take();
    assert_eq!(changes.check(&heard, true), Standing::Half);
    assert_eq!(changes.found, before, "it was read");
    assert_eq!(changes.check(&heard, false), Standing::Whole);
    tell(event(EventKind::Access(AccessKind::Close(AccessMode::Write))));
    let heard = changes.ears.take();
    assert_eq!(changes.check(&heard, true), Standing::Whole);
    // Who never closes it is not waited for for ever, and who has written nothing new has saved nothing.
    changes.expect(BTreeMap::from([(path.clone(), look(&path))]));
    assert_eq!(changes.within(Duration::ZERO), Noticed::Nothing);
    tell(written());
    assert_eq!(changes.within(LONG), Noticed::Nothing);
    large[9] = 9;
    folder.write("a.ply", &large);
    tell(written());
    assert_eq!(changes.within(LONG), Noticed::Save);
}

#[test]
fn a_mistake_waits_for_the_other_half_of_its_save() {
    let folder = Folder::new("watch-half");
    folder.write("a.scene", b"one");
    let (mut changes, _sender) = watching(&folder, &["a.scene"]);
    // At the start there was no save, and nothing to wait for.
    assert!(!changes.more_to_come());
    folder.write("a.scene", b"half of");
    assert!(changes.wait());
    changes.expect(BTreeMap::from([(folder.path("a.scene"), look(&folder.path("a.scene")))]));
    std::thread::scope(|scope| {
        scope.spawn(|| folder.write("a.scene", b"half of what was meant"));
        changes.noticed = Some(Instant::now() + LONG);
        assert!(changes.more_to_come());
    });
    assert!(changes.wait());
}

#[test]
fn the_end_is_heard_while_a_mistake_waits() {
    let folder = Folder::new("watch-end");
    folder.write("a.scene", b"one");
    let (mut changes, sender) = watching(&folder, &["a.scene"]);
    changes.noticed = Some(Instant::now() + LONG);
    sender.send(Wake::Stop).unwrap();
    assert!(changes.more_to_come());
    assert!(!changes.wait());
}

#[test]
fn several_files_that_are_saved_at_once_are_noticed_together() {
    let folder = Folder::new("watch-all");
    let names = ["a.scene", "b.scene", "c.scene"];
    let write = |bytes: &[u8]| names.iter().for_each(|name| folder.write(name, bytes));
    write(b"one");
    let (mut changes, _sender) = watching(&folder, &names);
    assert_eq!(changes.within(Duration::ZERO), Noticed::Nothing);
    write(b"two");
    assert!(changes.wait());
    assert!(names.iter().all(|name| changes.found[&folder.path(name)] == look(&folder.path(name))));
}

#[test]
fn a_wish_ends_a_wait_and_hides_no_save() {
    let folder = Folder::new("watch-wish");
    folder.write("a.scene", b"one");
    let (mut changes, sender) = watching(&folder, &["a.scene"]);
    let wished = changes.wished();
    let waiting = std::thread::spawn(move || (changes.wait(), changes));
    wished.store(true, Ordering::Release);
    sender.send(Wake::Look).unwrap();
    let (noticed, mut changes) = waiting.join().unwrap();
    assert!(noticed);
    // It stands until whoever loads clears it, however often it is waited.
    folder.write("a.scene", b"two");
    assert_eq!(changes.within(LONG), Noticed::Save);
    wished.store(false, Ordering::Release);
    assert_eq!(changes.within(LONG), Noticed::Save, "the file");
    let seen = BTreeMap::from([(folder.path("a.scene"), look(&folder.path("a.scene")))]);
    changes.expect(seen);
    assert_eq!(changes.within(Duration::ZERO), Noticed::Nothing);
}
