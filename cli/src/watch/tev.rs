//! Pictures for tev, the viewer of Thomas Müller: over TCP, in its packets.
//!
//! A packet is its own length in bytes (u32), a kind (u8), and what that kind says; numbers are
//! little-endian, texts end with a zero. An image is created with its channels, then updated with the
//! planes of all of them.

use std::ffi::OsString;
use std::io::{self, Write};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::Duration;

use glam::UVec2;
use luxel_core::film::Film;

use super::mailbox::Mailbox;
use crate::report;

/// Where tev listens.
pub(super) const ADDRESS: &str = "127.0.0.1:14158";

const UPDATE_IMAGE: u8 = 5;
const CREATE_IMAGE: u8 = 4;
const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// So long tev may take to answer, and to take a picture.
const PATIENCE: Duration = Duration::from_secs(2);

/// The words of a command line, with the address behind a `--tev` joined to it: a word that has the shape of
/// `HOST:PORT` is one, any other may be the scene.
pub(crate) fn with_address(words: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut joined: Vec<OsString> = vec![];
    for word in words {
        let is_watch = joined.get(1).is_some_and(|command| command == "watch");
        let is_over = joined.iter().any(|word| word == "--");
        match joined.last_mut().filter(|last| is_watch && !is_over && *last == "--tev") {
            Some(last) if word.to_str().is_some_and(is_address) => {
                last.push("=");
                last.push(word);
            }
            _ => joined.push(word),
        }
    }
    joined
}

fn is_address(word: &str) -> bool {
    word.rsplit_once(':').is_some_and(|(host, port)| {
        !host.is_empty() && !host.contains(['/', '\\']) && port.parse::<u16>().is_ok()
    })
}

/// A tev that is shown every picture.
pub(super) struct Tev(Mailbox<Picture>);

impl Tev {
    /// Shows pictures under this name. One that cannot be shown is told of once, and tried again with
    /// the next.
    pub(super) fn new(address: String, name: String) -> Self {
        let mut tev = Connection { address, name, stream: None, size: UVec2::ZERO };
        let mut was_refused = false;
        Self(Mailbox::new(move |picture: Picture| {
            let shown = tev.show(&picture);
            if let Err(error) = &shown {
                tev.stream = None;
                if !was_refused {
                    report::warning(&format!("tev at {} shows no picture: {error}", tev.address));
                }
            }
            was_refused = shown.is_err();
        }))
    }

    /// Shows what a film holds by now.
    pub(super) fn show(&self, film: &Film) {
        self.0.put(Picture::of_film(film));
    }
}

/// Radiance, linear sRGB, plane by plane.
struct Picture {
    size: UVec2,
    min: UVec2,
    window: UVec2,
    planes: [Vec<f32>; 3],
}

impl Picture {
    #[expect(clippy::cast_possible_truncation, reason = "a screen shows less than 32 bits")]
    fn of_film(film: &Film) -> Self {
        let plane = |i: usize| film.pixels().map(|(_, pixel)| pixel.mean[i] as f32).collect();
        let planes = [0, 1, 2].map(plane);
        Self { size: film.size, min: film.window.min, window: film.window.size, planes }
    }
}

struct Connection {
    address: String,
    name: String,
    stream: Option<TcpStream>,
    /// Of the image that was created there.
    size: UVec2,
}

impl Connection {
    fn show(&mut self, picture: &Picture) -> io::Result<()> {
        let is_new = self.stream.is_none() || self.size != picture.size;
        let mut stream = match self.stream.take() {
            Some(stream) => stream,
            None => connect(&self.address)?,
        };
        if is_new {
            stream.write_all(&create(&self.name, picture.size))?;
        }
        stream.write_all(&update(&self.name, picture))?;
        (self.stream, self.size) = (Some(stream), picture.size);
        Ok(())
    }
}

fn connect(address: &str) -> io::Result<TcpStream> {
    let mut told = io::Error::new(io::ErrorKind::NotFound, "there is no such address");
    for place in address.to_socket_addrs()? {
        match TcpStream::connect_timeout(&place, PATIENCE) {
            Ok(stream) => {
                stream.set_write_timeout(Some(PATIENCE))?;
                return Ok(stream);
            }
            Err(error) => told = error,
        }
    }
    Err(told)
}

/// Makes an image; one of the same name is replaced, without being brought to the front.
fn create(name: &str, size: UVec2) -> Vec<u8> {
    let mut packet = Packet::new(CREATE_IMAGE);
    packet.text(name);
    packet.numbers([size.x, size.y]);
    packet.channels();
    packet.finish()
}

fn update(name: &str, picture: &Picture) -> Vec<u8> {
    let Picture { min, window, planes, .. } = picture;
    let mut packet = Packet::new(UPDATE_IMAGE);
    packet.text(name);
    packet.channels();
    packet.numbers([min.x, min.y, window.x, window.y]);
    packet.0.extend(planes.iter().flatten().flat_map(|value| value.to_le_bytes()));
    packet.finish()
}

struct Packet(Vec<u8>);

impl Packet {
    fn new(kind: u8) -> Self {
        let to_front = 0;
        Self(vec![0, 0, 0, 0, kind, to_front])
    }

    fn text(&mut self, text: &str) {
        self.0.extend(text.bytes().filter(|byte| *byte != 0));
        self.0.push(0);
    }

    fn numbers<const N: usize>(&mut self, numbers: [u32; N]) {
        self.0.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
    }

    fn channels(&mut self) {
        self.numbers([3]);
        for name in CHANNELS {
            self.text(name);
        }
    }

    fn finish(mut self) -> Vec<u8> {
        // A picture has at most 2^27 pixels, 12 bytes each.
        let length = u32::try_from(self.0.len()).expect("a picture's planes fit");
        self.0[..4].copy_from_slice(&length.to_le_bytes());
        self.0
    }
}

#[cfg(test)]
mod tests {
    use std::io::Read;
    use std::net::TcpListener;

    use luxel_core::film::Rect;

    use super::*;

    #[test]
    fn a_word_behind_tev_is_an_address_if_it_looks_like_one() {
        let joined = |line: &str| {
            let words = with_address(line.split(' ').map(OsString::from));
            words.join(OsString::from(" ").as_os_str()).into_string().unwrap()
        };
        for (line, wanted) in [
            ("luxel watch --tev box:1 a.scene", "luxel watch --tev=box:1 a.scene"),
            ("luxel watch a.scene --tev [::1]:14158", "luxel watch a.scene --tev=[::1]:14158"),
            ("luxel watch --tev=box:1 b:2", "luxel watch --tev=box:1 b:2"),
            ("luxel watch --tev a.scene", "luxel watch --tev a.scene"),
            ("luxel watch --tev ./a:1", "luxel watch --tev ./a:1"),
            ("luxel watch --tev C:\\1", "luxel watch --tev C:\\1"),
            ("luxel watch --tev :1", "luxel watch --tev :1"),
            ("luxel watch --tev a:99999", "luxel watch --tev a:99999"),
            ("luxel watch -- --tev a:1", "luxel watch -- --tev a:1"),
            ("luxel render --tev a:1", "luxel render --tev a:1"),
        ] {
            assert_eq!(joined(line), wanted);
        }
    }

    #[test]
    fn tev_is_told_to_make_an_image_and_then_what_it_shows() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let tev = Tev::new(address, "a.scene".to_owned());
        let film = Film::new(UVec2::new(8, 6), Rect::new(UVec2::new(2, 1), UVec2::new(3, 2)));
        tev.show(&film);
        let (mut viewer, _) = listener.accept().unwrap();
        drop(tev);
        let mut got = vec![];
        viewer.read_to_end(&mut got).unwrap();
        let create = b"\x20\0\0\0\x04\0a.scene\0\x08\0\0\0\x06\0\0\0\x03\0\0\0R\0G\0B\0";
        let (first, second) = got.split_at(create.len());
        assert_eq!(first, create);
        let head =
            b"\0\0\0\0\x05\0a.scene\0\x03\0\0\0R\0G\0B\0\x02\0\0\0\x01\0\0\0\x03\0\0\0\x02\0\0\0";
        assert_eq!(second[4..head.len()], head[4..]);
        assert_eq!(second.len(), head.len() + 3 * 2 * 3 * 4);
        assert_eq!(second[..4], u32::try_from(second.len()).unwrap().to_le_bytes());
    }
}
