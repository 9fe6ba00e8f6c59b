//! The ways in which programs save.
#![expect(clippy::disallowed_methods, reason = "saves as other programs make them")]

use std::fs;
use std::io::Write;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use super::Rng;
use crate::testing::Folder;

/// Where a course takes place.
pub(super) struct Site {
    /// The folder of it all, another one than the file's.
    root: PathBuf,
    /// The file as it is watched.
    pub(super) path: PathBuf,
}

/// One way to save.
pub(super) struct Pattern {
    pub(super) name: &'static str,
    /// Puts these bytes in place; how many saves that took.
    pub(super) save: fn(&Site, &[u8], &mut Rng) -> usize,
    /// Makes what is there before the first save.
    begin: fn(&Site),
    /// Whether all contents are of one length.
    same_len: bool,
    /// A load takes less than so many milliseconds.
    pub(super) load_ms: u64,
    /// Whether events tell of it.
    pub(super) is_heard: bool,
}

const fn of(name: &'static str, save: fn(&Site, &[u8], &mut Rng) -> usize) -> Pattern {
    Pattern { name, save, begin: plain, same_len: false, load_ms: 3, is_heard: true }
}

/// All of them.
pub(super) const PATTERNS: [Pattern; 17] = [
    of("in place", |site, bytes, _| in_place(&site.path, bytes)),
    of("in place, in slow chunks", slow_chunks),
    of("overwritten, then cut, after a copy", overwrite),
    of("renamed over", |site, bytes, _| rename_over(&site.path, bytes)),
    of("vim: old one renamed, new one written", vim),
    of("deleted, then created", |site, bytes, rng| {
        fs::remove_file(&site.path).unwrap();
        rng.sleep(80);
        in_place(&site.path, bytes)
    }),
    of("emptied, then written", |site, bytes, rng| {
        fs::write(&site.path, b"").unwrap();
        rng.sleep(80);
        in_place(&site.path, bytes)
    }),
    of("1000 saves a second", thousand),
    Pattern {
        begin: |site| swap_link(site, b"begin"),
        ..of("link swapped", |site, bytes, _| {
            swap_link(site, bytes);
            1
        })
    },
    Pattern {
        begin: link_away,
        ..of("target of a link to elsewhere", |site, bytes, _| {
            rename_over(&site.root.join("elsewhere/deep/real"), bytes)
        })
    },
    Pattern { begin: link_between, ..of("link amid a chain swapped", swap_between) },
    of("folder replaced", replace_folder),
    Pattern { same_len: true, ..of("same size and time", same_size_and_time) },
    of("amid a storm of other files", storm),
    Pattern {
        load_ms: 60,
        ..of("again while it is loaded", |site, bytes, rng| {
            let other = [b"other", bytes].concat();
            let first = if is_there(&site.path, bytes) { bytes } else { &other };
            in_place(&site.path, first);
            rng.sleep(80);
            1 + in_place(&site.path, bytes)
        })
    },
    Pattern { begin: build_mapped, same_len: true, ..of("memory-mapped", mapped) },
    Pattern {
        begin: link_hard,
        is_heard: false,
        ..of("through a hard link elsewhere", |site, bytes, _| {
            in_place(&site.root.join("elsewhere/deep/same"), bytes)
        })
    },
];

impl Pattern {
    /// What the `n`th save writes.
    pub(super) fn body(&self, rng: &mut Rng, n: usize) -> Vec<u8> {
        let len = if self.same_len { 6000 } else { 1 + rng.below(12_000) };
        let mut bytes = format!("{n} {:016x} ", rng.below(u64::MAX)).into_bytes();
        bytes.resize(usize::try_from(len).unwrap().max(bytes.len()), b'x');
        bytes
    }
}

impl Site {
    pub(super) fn new(folder: &Folder, pattern: &Pattern) -> Self {
        let root = fs::canonicalize(folder.path("")).unwrap();
        let site = Self { path: root.join("scenes/a.scene"), root };
        fs::create_dir_all(site.root.join("scenes")).unwrap();
        fs::create_dir_all(site.root.join("elsewhere/deep")).unwrap();
        (pattern.begin)(&site);
        site
    }
}

fn plain(site: &Site) {
    fs::write(&site.path, [b'x'; 6000]).unwrap();
}

fn is_there(path: &Path, bytes: &[u8]) -> bool {
    fs::read(path).is_ok_and(|there| there == bytes)
}

fn in_place(path: &Path, bytes: &[u8]) -> usize {
    fs::write(path, bytes).unwrap();
    1
}

fn rename_over(path: &Path, bytes: &[u8]) -> usize {
    let temporary = path.with_extension("tmp");
    fs::write(&temporary, bytes).unwrap();
    fs::rename(&temporary, path).unwrap();
    1
}

fn slow_chunks(site: &Site, bytes: &[u8], rng: &mut Rng) -> usize {
    let mut file = fs::File::create(&site.path).unwrap();
    for chunk in bytes.chunks(bytes.len().div_ceil(4)) {
        file.write_all(chunk).unwrap();
        rng.sleep(25);
    }
    1
}

fn overwrite(site: &Site, bytes: &[u8], _: &mut Rng) -> usize {
    fs::copy(&site.path, site.path.with_extension("scene~")).unwrap();
    let mut file = fs::OpenOptions::new().write(true).open(&site.path).unwrap();
    file.write_all(bytes).unwrap();
    file.set_len(bytes.len() as u64).unwrap();
    1
}

fn vim(site: &Site, bytes: &[u8], rng: &mut Rng) -> usize {
    let backup = site.path.with_extension("scene~");
    fs::rename(&site.path, &backup).unwrap();
    rng.sleep(5);
    in_place(&site.path, bytes);
    fs::remove_file(backup).unwrap();
    1
}

fn thousand(site: &Site, bytes: &[u8], rng: &mut Rng) -> usize {
    let is_there = is_there(&site.path, bytes);
    let save = if rng.below(2) == 0 { in_place } else { rename_over };
    let n = if is_there { 60 } else { 300 };
    for n in 0..n {
        let other = format!("{n} of many");
        save(&site.path, if is_there { bytes } else { other.as_bytes() });
        std::thread::sleep(Duration::from_micros(900));
    }
    n + save(&site.path, bytes)
}

fn swap_link(site: &Site, bytes: &[u8]) {
    // Two targets in turn: what is written is not what the link leads to.
    let one = site.root.join("elsewhere/one");
    let target = if fs::read_link(&site.path).is_ok_and(|to| to == one) { "two" } else { "one" };
    let target = site.root.join("elsewhere").join(target);
    fs::write(&target, bytes).unwrap();
    let link = site.path.with_extension("link");
    symlink(&target, &link).unwrap();
    fs::rename(link, &site.path).unwrap();
}

fn link_away(site: &Site) {
    fs::write(site.root.join("elsewhere/deep/real"), b"begin").unwrap();
    symlink("../elsewhere/deep/real", &site.path).unwrap();
}

fn link_hard(site: &Site) {
    plain(site);
    fs::hard_link(&site.path, site.root.join("elsewhere/deep/same")).unwrap();
}

/// The file leads to `elsewhere/current/a`, and `current` to a folder: so are releases kept.
fn link_between(site: &Site) {
    let release = site.root.join("elsewhere/deep/one");
    fs::create_dir_all(&release).unwrap();
    fs::write(release.join("a"), b"begin").unwrap();
    symlink("deep/one", site.root.join("elsewhere/current")).unwrap();
    symlink("../elsewhere/current/a", &site.path).unwrap();
}

fn swap_between(site: &Site, bytes: &[u8], _: &mut Rng) -> usize {
    let current = site.root.join("elsewhere/current");
    let is_one = fs::read_link(&current).unwrap().ends_with("one");
    let release = if is_one { "deep/two" } else { "deep/one" };
    let folder = site.root.join("elsewhere").join(release);
    fs::create_dir_all(&folder).unwrap();
    fs::write(folder.join("a"), bytes).unwrap();
    let link = site.root.join("elsewhere/next");
    symlink(release, &link).unwrap();
    fs::rename(link, current).unwrap();
    1
}

/// The folder is exchanged for another; its file is then saved in place as well.
fn replace_folder(site: &Site, bytes: &[u8], rng: &mut Rng) -> usize {
    let (old, new) = (site.root.join("old"), site.root.join("new"));
    let folder = site.path.parent().unwrap();
    let first = if is_there(&site.path, bytes) { bytes } else { b"from the new folder" };
    fs::create_dir_all(&new).unwrap();
    fs::write(new.join("a.scene"), first).unwrap();
    fs::rename(folder, &old).unwrap();
    fs::rename(new, folder).unwrap();
    rng.sleep(40);
    fs::remove_dir_all(old).unwrap();
    1 + in_place(&site.path, bytes)
}

fn same_size_and_time(site: &Site, bytes: &[u8], rng: &mut Rng) -> usize {
    let modified = fs::metadata(&site.path).unwrap().modified().unwrap();
    if rng.below(2) == 0 {
        in_place(&site.path, bytes)
    } else {
        rename_over(&site.path, bytes)
    };
    let file = fs::OpenOptions::new().write(true).open(&site.path).unwrap();
    file.set_modified(modified).unwrap();
    1
}

fn storm(site: &Site, bytes: &[u8], rng: &mut Rng) -> usize {
    let others = |n: u64| {
        for n in 0..n {
            fs::write(site.path.with_file_name(format!("other{}", n % 50)), b"z").unwrap();
        }
    };
    others(1000 + rng.below(500));
    let saves = in_place(&site.path, bytes);
    others(200);
    saves
}

/// Nothing in Rust maps a file without `unsafe`.
const MAPPED: &str = r"#include <fcntl.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>
int main(int n, char **args) {
    if (n != 4) return 2;
    static char bytes[6000];
    int from = open(args[2], O_RDONLY), to = open(args[1], O_RDWR);
    if (from < 0 || to < 0 || read(from, bytes, sizeof bytes) != sizeof bytes) return 3;
    char *at = mmap(NULL, sizeof bytes, PROT_READ | PROT_WRITE, MAP_SHARED, to, 0);
    if (at == MAP_FAILED) return 4;
    for (size_t i = 0; i < sizeof bytes; i++) at[i] = bytes[i];
    usleep(1000u * (unsigned)atoi(args[3]));
    return munmap(at, sizeof bytes) || close(to);
}
";

fn build_mapped(site: &Site) {
    plain(site);
    let (source, program) = (site.root.join("mapped.c"), site.root.join("mapped"));
    fs::write(&source, MAPPED).unwrap();
    let built = Command::new("cc").arg("-o").arg(program).arg(source).status();
    assert!(built.expect("a C compiler").success());
}

fn mapped(site: &Site, bytes: &[u8], rng: &mut Rng) -> usize {
    let wanted = site.root.join("wanted");
    fs::write(&wanted, bytes).unwrap();
    let mut program = Command::new(site.root.join("mapped"));
    let held = rng.below(60).to_string();
    let status = program.arg(&site.path).arg(wanted).arg(held).status().unwrap();
    assert!(status.success(), "{status}");
    1
}
