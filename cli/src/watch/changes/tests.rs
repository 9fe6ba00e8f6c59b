//! What is noticed and what is not, by one file; `saves` has the many ways to save one.

use std::fs;

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

#[test]
fn what_the_system_could_not_tell_is_looked_for() {
    use notify::event::{Event, EventKind, Flag};
    let lost = || Ok(Event::new(EventKind::Other).set_flag(Flag::Rescan));
    let failed = || Err(notify::Error::generic("the queue is full"));
    for what in [lost, failed] {
        let folder = Folder::new("watch-overflow");
        folder.write("a.scene", b"one");
        let mut hearing: Option<Box<dyn Fn(notify::Result<Event>)>> = None;
        let (mut changes, sender) = Changes::hearing(|wake| {
            let ears = Ears::deaf();
            hearing = Some(Box::new(ears.hearing(wake)));
            ears
        });
        let path = folder.path("a.scene");
        changes.expect(BTreeMap::from([(path.clone(), look(&path))]));
        // Nothing is compared without a reason.
        changes.anyway = LONG * 10;
        assert_eq!(changes.within(Duration::ZERO), Noticed::Nothing);
        folder.write("a.scene", b"two");
        assert_eq!(changes.within(CLOSE * 2), Noticed::Nothing);
        hearing.expect("it was made")(what());
        assert_eq!(changes.within(LONG), Noticed::Save);
        drop(sender);
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
