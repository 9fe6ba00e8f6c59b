//! `luxel watch --tev`, as the viewer sees it.
#![cfg(unix)]

use std::io::Read;
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::time::Duration;

use glam::UVec2;
use luxel_core::files::MemoryFiles;
use luxel_core::render::{Control, Options, render};

use super::program::{Folder, SCENE};
use crate::load::stage_of;

/// What is in a packet that has not been read yet.
struct Packet(Vec<u8>);

impl Packet {
    /// The next one that arrives.
    fn next(from: &mut TcpStream) -> Self {
        let mut length = [0; 4];
        from.read_exact(&mut length).unwrap();
        let mut rest = vec![0; u32::from_le_bytes(length) as usize - 4];
        from.read_exact(&mut rest).unwrap();
        Self(rest)
    }

    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let bytes: Vec<u8> = self.0.drain(..N).collect();
        bytes.try_into().unwrap()
    }

    fn number(&mut self) -> u32 {
        u32::from_le_bytes(self.bytes())
    }

    fn text(&mut self) -> String {
        let end = self.0.iter().position(|byte| *byte == 0).unwrap();
        let text: Vec<u8> = self.0.drain(..=end).collect();
        String::from_utf8(text[..end].to_vec()).unwrap()
    }

    fn channels(&mut self) {
        let n = self.number();
        let names: Vec<_> = (0..n).map(|_| self.text()).collect();
        assert_eq!(names, ["R", "G", "B"]);
    }
}

/// The radiance of every pixel, plane by plane, of an image that is created or updated; whether it was
/// created, which must come first.
fn shown(viewer: &mut TcpStream) -> Option<Vec<f32>> {
    let mut packet = Packet::next(viewer);
    let [kind, to_front] = packet.bytes();
    assert_eq!((packet.text().as_str(), to_front), ("a.scene", 0));
    if kind == 4 {
        assert_eq!([packet.number(), packet.number()], [32, 32]);
        packet.channels();
        assert!(packet.0.is_empty());
        return None;
    }
    assert_eq!(kind, 5);
    packet.channels();
    assert_eq!([(); 4].map(|()| packet.number()), [0, 0, 32, 32]);
    let (values, rest) = packet.0.as_chunks();
    assert_eq!((values.len(), rest), (3 * 32 * 32, &[][..]));
    Some(values.iter().map(|value| f32::from_le_bytes(*value)).collect())
}

/// What a scene's picture comes to in the end.
#[expect(clippy::cast_possible_truncation, reason = "tev is shown 32 bits")]
fn rendered(text: &str) -> Vec<f32> {
    let files = MemoryFiles::default().with("a.scene", text.as_bytes());
    let stage = stage_of(Path::new("a.scene"), &files, &[], None).unwrap();
    let (film, _) = render(&stage, &Options::default(), &Control::default());
    assert_eq!(film.size, UVec2::splat(32));
    let plane = |i: usize| film.pixels().map(move |(_, pixel)| pixel.mean[i] as f32);
    (0..3).flat_map(plane).collect()
}

#[test]
fn tev_is_shown_the_values_of_every_picture() {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap().to_string();
    let folder = Folder::new("tev").with("a.scene", SCENE);
    let joined = format!("--tev={address}");
    for words in [&["watch", "--tev", &address, "a.scene"][..], &["watch", "a.scene", &joined]] {
        folder.write("a.scene", SCENE);
        let mut watching = folder.start(words);
        let (mut viewer, _) = listener.accept().unwrap();
        viewer.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
        assert_eq!(shown(&mut viewer), None, "an image is made first");
        let darker = SCENE.replace("reflectance = 0.5", "reflectance = 0.25");
        for text in [SCENE, &darker] {
            folder.write("a.scene", text);
            let wanted = rendered(text);
            // Pictures of fewer samples, and of the scene before, come first.
            while shown(&mut viewer).expect("it is made once") != wanted {}
        }
        watching.interrupt();
        assert_eq!(watching.end().code, 0);
    }
}

#[test]
fn a_scene_behind_tev_is_no_address_and_one_that_is_silent_is_told_of_once() {
    let folder = Folder::new("tev-silent").with("a.scene", SCENE);
    let told = |words: &[&str]| folder.luxel(&[&["watch", "--once-stable"], words].concat());
    let done = told(&["--tev", "127.0.0.1:1", "a.scene"]);
    assert_eq!(done.code, 0, "{done:?}");
    assert_eq!(done.err.matches("tev at 127.0.0.1:1 shows no picture").count(), 1, "{done:?}");
    // Whether a tev listens where it does by itself is not known here.
    let done = told(&["--tev", "a.scene"]);
    assert!(done.code == 0 && !done.err.contains("tev at a.scene"), "{done:?}");
}
