//! What is tried from outside, byte by byte as it comes over the wire.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use glam::UVec2;
use luxel_core::film::{Film, Rect};
use luxel_core::render::Reached;

use super::*;

fn preview() -> Preview {
    Preview::start(&PageArgs::default(), "a.exr", None).unwrap()
}

/// Port and token.
fn place(preview: &Preview) -> (u16, String) {
    let url = preview.url();
    let rest = url.strip_prefix("http://127.0.0.1:").unwrap();
    let (port, token) = rest.split_once("/?token=").unwrap();
    (port.parse().unwrap(), token.to_owned())
}

fn connect(port: u16) -> TcpStream {
    let stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port)).unwrap();
    // Far above what an answer takes on a busy machine.
    stream.set_read_timeout(Some(Duration::from_secs(20))).unwrap();
    stream
}

/// What comes back until the other end closes.
fn say(port: u16, request: &str) -> String {
    let mut stream = connect(port);
    // The server may answer and close before it has read everything.
    let _ = stream.write_all(request.as_bytes());
    let mut answer = vec![];
    let _ = stream.read_to_end(&mut answer);
    String::from_utf8_lossy(&answer).into_owned()
}

fn code(answer: &str) -> u16 {
    answer.split(' ').nth(1).and_then(|code| code.parse().ok()).unwrap_or(0)
}

/// A request with the right host and these further lines.
fn ask(port: u16, target: &str, lines: &str) -> String {
    say(port, &format!("GET {target} HTTP/1.1\r\nhost: 127.0.0.1:{port}\r\n{lines}\r\n"))
}

const UPGRADE: &str = "connection: Upgrade\r\nupgrade: websocket\r\nsec-websocket-version: 13\r\n\
                       sec-websocket-key: dGhlIHNhbXBsZSBub25jZQ==\r\n";

/// Opens a socket as a page does; the head of the answer is read.
fn socket(port: u16, token: &str) -> TcpStream {
    let mut stream = connect(port);
    let lines = format!("host: 127.0.0.1:{port}\r\norigin: http://127.0.0.1:{port}\r\n{UPGRADE}");
    write!(stream, "GET /ws?token={token} HTTP/1.1\r\n{lines}\r\n").unwrap();
    let mut head = vec![];
    while !head.ends_with(b"\r\n\r\n") {
        let mut byte = [0];
        stream.read_exact(&mut byte).unwrap();
        head.push(byte[0]);
    }
    assert!(head.starts_with(b"HTTP/1.1 101"), "{}", String::from_utf8_lossy(&head));
    stream
}

/// The kind (1 text, 2 binary, 8 end) and content of the next message, which is not masked.
fn message(stream: &mut TcpStream) -> (u8, Vec<u8>) {
    let mut take = |n: usize| {
        let mut bytes = vec![0; n];
        stream.read_exact(&mut bytes).unwrap();
        bytes
    };
    let head = take(2);
    let length = match head[1] {
        126 => usize::from(u16::from_be_bytes(take(2).try_into().unwrap())),
        127 => u64::from_be_bytes(take(8).try_into().unwrap()).try_into().unwrap(),
        short => short.into(),
    };
    (head[0] & 15, take(length))
}

/// A masked text message, as browsers send; the mask is zero.
fn tell(stream: &mut TcpStream, text: &str) {
    let mut bytes = vec![0x81, 0x80 | u8::try_from(text.len()).unwrap(), 0, 0, 0, 0];
    bytes.extend(text.bytes());
    stream.write_all(&bytes).unwrap();
}

/// A picture of that edit, all of it white.
fn frame(generation: u64, size: UVec2) -> Frame {
    let film = Film::new(UVec2::ONE, Rect::new(UVec2::ZERO, UVec2::ONE));
    let seen = Reached { step: 1, samples: 1, left: 0, is_whole: true };
    let exact = Exact::of_film(&film, 1);
    let frame = Frame::of_exact(&exact, &stage::Film::default(), (seen, 1));
    let n = size.x as usize * size.y as usize;
    Frame { generation, pixels: Pixels::new(size, &vec![1.0; 3 * n], &[], vec![]), ..frame }
}

/// Of which edit a message shows a picture.
fn generation(bytes: &[u8]) -> u64 {
    let head = serde_json::Deserializer::from_slice(&bytes[8..]).into_iter().next();
    let head: serde_json::Value = head.unwrap().unwrap();
    head["generation"].as_u64().unwrap()
}

#[test]
fn the_own_page_is_served_with_headers_that_shut_it_in() {
    let preview = preview();
    let (port, token) = place(&preview);
    let answer = ask(port, &format!("/?token={token}"), "");
    assert_eq!(code(&answer), 200, "{answer}");
    for line in [
        "content-security-policy: default-src 'none'; script-src 'self'",
        "frame-ancestors 'none'",
        "cross-origin-resource-policy: same-origin",
        "x-content-type-options: nosniff",
        "cache-control: no-store",
        "referrer-policy: no-referrer",
    ] {
        assert!(answer.contains(line), "{line} in {answer}");
    }
    assert!(!answer.contains("access-control"), "{answer}");
}

#[test]
fn a_foreign_page_gets_no_socket_and_no_file_though_it_knows_the_token() {
    let preview = preview();
    let (port, token) = place(&preview);
    for origin in ["http://evil.example", "null", "http://127.0.0.1:1", "http://localhost"] {
        let lines = format!("origin: {origin}\r\n{UPGRADE}");
        assert_eq!(code(&ask(port, &format!("/ws?token={token}"), &lines)), 403, "{origin}");
        let lines = format!("origin: {origin}\r\n");
        let answer = ask(port, &format!("/?token={token}"), &lines);
        assert_eq!(code(&answer), 403, "{origin}");
        assert!(!answer.contains(&token), "{answer}");
    }
}

#[test]
fn a_name_that_was_made_to_point_here_gets_no_answer() {
    let preview = preview();
    let (port, token) = place(&preview);
    for host in ["evil.example", &format!("evil.example:{port}"), "127.0.0.1"] {
        let request = format!("GET /?token={token} HTTP/1.1\r\nhost: {host}\r\n\r\n");
        assert_eq!(code(&say(port, &request)), 421, "{host}");
    }
    let without = format!("GET /?token={token} HTTP/1.0\r\n\r\n");
    assert_eq!(code(&say(port, &without)), 421);
}

#[test]
fn without_the_token_nothing_is_told_not_even_what_exists() {
    let preview = preview();
    let (port, token) = place(&preview);
    let wrong = "0".repeat(32);
    for path in ["/", "/main.js", "/page.css", "/ws", "/nothing"] {
        for query in ["", "?token=", &format!("?token={wrong}"), &format!("?token={token}0")] {
            assert_eq!(code(&ask(port, &format!("{path}{query}"), "")), 403, "{path}{query}");
        }
    }
}

#[test]
fn nothing_but_get_and_no_path_leads_out() {
    let preview = preview();
    let (port, token) = place(&preview);
    for method in ["POST", "PUT", "DELETE", "OPTIONS", "HEAD", "TRACE", "BREW"] {
        let lines = format!("host: 127.0.0.1:{port}\r\ncontent-length: 0\r\n");
        let answer = say(port, &format!("{method} /?token={token} HTTP/1.1\r\n{lines}\r\n"));
        assert_eq!(code(&answer), 405, "{method}");
        assert!(answer.contains("allow: GET"), "{answer}");
    }
    for path in ["/../../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/page/main.js"]
    {
        let answer = ask(port, &format!("{path}?token={token}"), "");
        assert_eq!(code(&answer), 404, "{path}");
        assert!(!answer.contains("root:"), "{answer}");
    }
}

#[test]
fn a_giant_head_and_a_half_open_connection_keep_nobody_waiting() {
    let preview = preview();
    let (port, token) = place(&preview);
    let mut half_open: Vec<_> = (0..8).map(|_| connect(port)).collect();
    for stream in &mut half_open {
        stream.write_all(b"GET / HTTP/1.1\r\nhost:").unwrap();
    }
    let giant = format!("x: {}\r\n", "a".repeat(1 << 20));
    let answer = ask(port, &format!("/?token={token}"), &giant);
    assert!([0, 431].contains(&code(&answer)), "{answer}");
    assert_eq!(code(&ask(port, &format!("/?token={token}"), "")), 200);
    let since = Instant::now();
    let mut rest = vec![];
    // The server closes it: with an answer, an end or a reset, but not by our own patience.
    let _ = half_open[0].read_to_end(&mut rest);
    assert!(since.elapsed() < Duration::from_secs(15), "{:?}", since.elapsed());
}

#[test]
fn a_name_that_is_allowed_is_answered_with_its_own_origin_alone() {
    let allow_host = vec!["Box.example:8080".to_owned()];
    let args = PageArgs { allow_host, ..PageArgs::default() };
    let preview = Preview::start(&args, "a.exr", None).unwrap();
    let (port, token) = place(&preview);
    let ask = |path: &str, host: &str, lines: &str| {
        let head = format!("GET {path}?token={token} HTTP/1.1\r\nhost: {host}\r\n");
        say(port, &format!("{head}connection: close\r\n{lines}\r\n"))
    };
    let page = ask("/", "box.example:8080", "");
    let sockets = "connect-src ws://box.example:8080 wss://box.example:8080";
    assert!(code(&page) == 200 && page.contains(sockets), "{page}");
    // At the near end of a tunnel it may be https.
    for origin in ["http://box.example:8080", "https://box.example:8080"] {
        let lines = format!("origin: {origin}\r\n");
        assert_eq!(code(&ask("/main.js", "box.example:8080", &lines)), 200, "{origin}");
    }
    let mut socket = connect(port);
    let lines = format!("origin: http://box.example:8080\r\n{UPGRADE}");
    write!(socket, "GET /ws?token={token} HTTP/1.1\r\nhost: box.example:8080\r\n{lines}\r\n")
        .unwrap();
    let mut head = [0; 12];
    socket.read_exact(&mut head).unwrap();
    assert_eq!(&head, b"HTTP/1.1 101");
    let own = format!("http://127.0.0.1:{port}");
    for origin in [own.as_str(), "http://box.example", "http://evil.example:8080", "null"] {
        let lines = format!("origin: {origin}\r\n{UPGRADE}");
        assert_eq!(code(&ask("/ws", "box.example:8080", &lines)), 403, "{origin}");
    }
    for host in ["box.example", "box.example:8081", "evil.box.example:8080"] {
        assert_eq!(code(&ask("/", host, "")), 421, "{host}");
    }
}

#[test]
fn no_other_address_of_the_machine_is_listened_at() {
    let preview = preview();
    let (port, _) = place(&preview);
    // That of the network; asking for the way to somewhere sends nothing.
    let there = std::net::UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).and_then(|socket| {
        socket.connect((Ipv4Addr::new(192, 0, 2, 1), 9))?;
        Ok(socket.local_addr()?.ip())
    });
    let other = std::net::IpAddr::from(Ipv4Addr::new(127, 0, 0, 2));
    for address in there.ok().into_iter().chain([other]) {
        let address = SocketAddr::new(address, port);
        let answer = TcpStream::connect_timeout(&address, Duration::from_secs(2));
        assert!(address.ip() == Ipv4Addr::LOCALHOST || answer.is_err(), "{address}");
    }
}

#[test]
fn who_holds_every_connection_does_not_keep_the_page_out() {
    let preview = preview();
    let (port, token) = place(&preview);
    let mut page = socket(port, &token);
    let mut held: Vec<_> = (0..200).map(|_| connect(port)).collect();
    for (i, stream) in held.iter_mut().enumerate() {
        // Some say nothing, some do not come to an end.
        let begun = if i % 2 == 0 { "" } else { "GET / HTTP/1.1\r\nhost:" };
        let _ = stream.write_all(begun.as_bytes());
    }
    let since = Instant::now();
    assert_eq!(code(&ask(port, &format!("/?token={token}"), "")), 200);
    let mut second = socket(port, &token);
    // No head had to run out of time first.
    assert!(since.elapsed() < Duration::from_secs(4), "{:?}", since.elapsed());
    // Who had shown the token before stays.
    preview.screen().status("here");
    for page in [&mut page, &mut second] {
        assert!(message(page).1.starts_with(b"{\"title\""));
        assert_eq!(message(page), (1, b"{\"status\":\"here\"}".to_vec()));
    }
}

#[test]
fn a_page_that_takes_nothing_is_given_up() {
    let preview = preview();
    let (port, token) = place(&preview);
    let deaf = socket(port, &token);
    let since = Instant::now();
    // More than what waits for it on the way.
    preview.screen().show(&frame(1, UVec2::new(4096, 2048)));
    let is_over = || since.elapsed() > Duration::from_secs(20);
    while preview.screen().is_watched() && !is_over() {
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(!preview.screen().is_watched());
    assert!(since.elapsed() > Duration::from_millis(450), "{:?}", since.elapsed());
    drop(deaf);
}

#[test]
fn an_edit_is_shown_ten_times_a_second_at_most_however_fast_a_page_draws() {
    let preview = preview();
    let (port, token) = place(&preview);
    let mut page = socket(port, &token);
    assert_eq!(message(&mut page).0, 1);
    let (since, screen) = (Instant::now(), preview.screen());
    let mut at = vec![];
    std::thread::scope(|scope| {
        let all = scope.spawn(|| {
            while since.elapsed() < Duration::from_millis(600) {
                screen.show(&frame(1, UVec2::ONE));
                std::thread::sleep(Duration::from_millis(2));
            }
            // The first of another edit waits for nothing.
            screen.show(&frame(2, UVec2::ONE));
        });
        loop {
            let (kind, picture) = message(&mut page);
            assert_eq!(kind, 2);
            tell(&mut page, "\"drawn\"");
            at.push(since.elapsed());
            if generation(&picture) == 2 {
                break;
            }
        }
        all.join().unwrap();
    });
    // Of the last pace there may be one more; a busy machine shows fewer.
    assert!((3..=8).contains(&at.len()), "{at:?}");
    let soonest =
        at[..at.len() - 1].windows(2).map(|two| two[1].saturating_sub(two[0])).min().unwrap();
    // They leave a tenth of a second apart, and may be under way for longer and shorter.
    assert!(soonest > PACE / 2, "{at:?}");
}

#[test]
fn while_an_edit_is_expected_its_first_picture_comes_before_better_ones_of_the_last() {
    let preview = preview();
    let (port, token) = place(&preview);
    let mut page = socket(port, &token);
    assert_eq!(message(&mut page).0, 1);
    let screen = preview.screen();
    screen.show(&frame(1, UVec2::ONE));
    assert_eq!(message(&mut page).0, 2);
    tell(&mut page, "\"drawn\"");
    std::thread::sleep(PACE);
    let since = Instant::now();
    screen.expect();
    screen.show(&frame(1, UVec2::ONE));
    // Nothing comes of the edit: the better picture does, a little later.
    assert_eq!(generation(&message(&mut page).1), 1);
    assert!(since.elapsed() > PACE / 2, "{:?}", since.elapsed());
    tell(&mut page, "\"drawn\"");
    std::thread::sleep(PACE);
    screen.expect();
    screen.show(&frame(1, UVec2::ONE));
    screen.show(&frame(2, UVec2::ONE));
    assert_eq!(generation(&message(&mut page).1), 2);
}

#[test]
fn a_page_is_told_everything_and_gets_the_latest_picture_when_it_has_drawn() {
    let preview = preview();
    let (port, token) = place(&preview);
    preview.screen().status("busy");
    preview.screen().show(&frame(1, UVec2::ONE));
    let mut page = socket(port, &token);
    let (kind, title) = message(&mut page);
    assert!(kind == 1 && title.starts_with(b"{\"title\""));
    assert_eq!(message(&mut page), (1, b"{\"status\":\"busy\"}".to_vec()));
    let (kind, picture) = message(&mut page);
    assert_eq!((kind, generation(&picture)), (2, 1));
    // While a picture is being drawn words come, and pictures do not.
    (2..=9).for_each(|i| preview.screen().show(&frame(i, UVec2::ONE)));
    preview.screen().status("done");
    assert_eq!(message(&mut page), (1, b"{\"status\":\"done\"}".to_vec()));
    tell(&mut page, r#"{"ask":{"pixel":{"at":[0,0],"side":"a"}}}"#);
    let command = preview.commands().recv_timeout(Duration::from_secs(20)).unwrap();
    assert_eq!(command, Command::Pixel { at: [0, 0], side: Side::A });
    tell(&mut page, "\"drawn\"");
    let (kind, picture) = message(&mut page);
    assert_eq!((kind, generation(&picture)), (2, 9));
    // Who talks nonsense is left.
    tell(&mut page, "nonsense");
    assert!(matches!(page.read(&mut [0; 64]), Ok(0) | Err(_)));
}

#[test]
fn a_page_that_says_too_much_at_once_is_left() {
    let preview = preview();
    let (port, token) = place(&preview);
    let set = |value: usize| {
        format!(r#"{{"ask":{{"set":{{"name":"r","value":"{}"}}}}}}"#, "9".repeat(value))
    };
    let say = |stream: &mut TcpStream, text: &str| {
        let length = u16::try_from(text.len()).unwrap().to_be_bytes();
        let mut bytes = vec![0x81, 0x80 | 0x7e, length[0], length[1], 0, 0, 0, 0];
        bytes.extend(text.bytes());
        stream.write_all(&bytes).unwrap();
    };
    let mut page = socket(port, &token);
    say(&mut page, &set(4000));
    let command = preview.commands().recv_timeout(Duration::from_secs(20)).unwrap();
    assert!(matches!(command, Command::Set { value: Some(value), .. } if value.len() == 4000));
    say(&mut page, &set(5000));
    let mut rest = vec![];
    // It ends, whatever was told before.
    let _ = page.read_to_end(&mut rest);
    assert!(preview.commands().try_recv().is_err());
}

#[test]
fn a_port_that_is_taken_is_told_and_a_dropped_preview_frees_it() {
    let first = preview();
    let (port, _) = place(&first);
    let again = PageArgs { port, ..PageArgs::default() };
    let wrong = Preview::start(&again, "", None).err().unwrap();
    assert!(wrong.message.contains(&port.to_string()), "{}", wrong.message);
    drop(first);
    assert!(Preview::start(&again, "", None).is_ok());
}
