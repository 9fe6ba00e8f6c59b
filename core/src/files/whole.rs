//! Whole files in memory, and their hashes, for as long as they are wanted.

use std::hash::BuildHasher;
use std::io::{self, Read};
use std::iter;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use blake3::Hasher;
use foldhash::quality::FixedState;
use luxel_sdk::params::{Unfinished, apart};

use super::FileError;
use crate::scene::Hash;

/// Bytes that are read and hashed between two looks at whether they are still wanted: they stay in the
/// processor's cache, and are enough for all lanes of the hash.
const PIECE: usize = 256 << 10;
/// Bytes from which on a thread reads that nobody waits for once they are not wanted any more: while the
/// system gives room for them, nobody can look.
const LARGE: usize = 16 << 20;

/// A file's bytes and their BLAKE3 hash.
pub type Whole = (Arc<[u8]>, Hash);

/// Reads all of a source that should have `length` bytes, and at most `most`.
///
/// Once `stop` is set it returns within some milliseconds, however large and slow the source is: a large
/// one is left to itself (`apart`), until there is room for its bytes and a call of its `read` has ended.
///
/// # Errors
/// What the source says; that it has more bytes; that it is not wanted any more.
pub fn read_whole(
    from: impl Read + Send + 'static,
    length: usize,
    most: u64,
    stop: &AtomicBool,
) -> Result<Whole, FileError> {
    if length < LARGE {
        return gather(Pieces::new(from, most, stop), length);
    }
    let read = move |is_over: &AtomicBool| gather(Pieces::new(from, most, is_over), length);
    match apart(&|| !stop.load(Ordering::Relaxed), read) {
        Ok(whole) => whole,
        Err(Unfinished::Unwanted) => Err(FileError::Unwanted),
        Err(Unfinished::Failed) => Err(FileError::Unreadable(Unfinished::Failed.to_string())),
    }
}

/// What a source's pieces are told by, sooner than by hashes that nobody can make alike; of large sources
/// alone, and within a process.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Marks(Vec<u64>);

impl Marks {
    fn of(piece: &[u8]) -> u64 {
        FixedState::default().hash_one(piece)
    }

    /// Whether a source has other bytes than the one of these marks for sure: known at the first piece that
    /// is another, whatever comes after it.
    ///
    /// # Errors
    /// As `read_whole`.
    pub fn differ(&self, from: impl Read, most: u64, stop: &AtomicBool) -> Result<bool, FileError> {
        if self.0.is_empty() {
            return Ok(false);
        }
        let (mut pieces, mut piece) = (Pieces::new(from, most, stop), vec![0; PIECE]);
        for mark in &self.0 {
            let n = pieces.fill(&mut piece, |_| {})?;
            if Self::of(&piece[..n]) != *mark {
                return Ok(true);
            }
        }
        Ok(pieces.fill(&mut piece, |_| {})? > 0)
    }
}

/// The hash of all of a source that has at most so many bytes, and its marks.
///
/// # Errors
/// As `read_whole`.
pub fn hash_whole(
    from: impl Read,
    length: usize,
    most: u64,
    stop: &AtomicBool,
) -> Result<(Hash, Marks), FileError> {
    // Room for all of a mesh takes the system longer to give than its bytes take to read.
    let mut piece = vec![0; length.clamp(1, PIECE)];
    let (mut pieces, mut hasher) = (Pieces::new(from, most, stop), Hasher::new());
    let mut marks = vec![];
    while let n @ 1.. = pieces.fill(&mut piece, |some| _ = hasher.update(some))? {
        if length >= PIECE {
            marks.push(Marks::of(&piece[..n]));
        }
    }
    Ok((pieces.hash(&hasher)?, Marks(marks)))
}

/// All bytes of a source, most likely so many.
fn gather(mut pieces: Pieces<'_, impl Read>, length: usize) -> Result<Whole, FileError> {
    #[expect(clippy::manual_repeat_n, reason = "that takes twice as long for 19 MB")]
    let mut bytes: Arc<[u8]> = iter::repeat(0).take(length).collect();
    let (room, mut hasher) = (Arc::get_mut(&mut bytes).unwrap_or_default(), Hasher::new());
    let n = pieces.fill(room, |some| _ = hasher.update(some))?;
    if n < length {
        bytes = Arc::from(&bytes[..n]);
    } else {
        // It may have grown since its length was asked for.
        let (mut more, mut piece) = (vec![], vec![0; PIECE.min(length.max(1))]);
        while let n @ 1.. = pieces.fill(&mut piece, |some| _ = hasher.update(some))? {
            more.extend_from_slice(&piece[..n]);
        }
        if !more.is_empty() {
            bytes = [&bytes[..], &more].concat().into();
        }
    }
    Ok((bytes, pieces.hash(&hasher)?))
}

/// A source that is read in pieces.
struct Pieces<'a, R> {
    from: io::Take<R>,
    most: u64,
    stop: &'a AtomicBool,
}

impl<'a, R: Read> Pieces<'a, R> {
    fn new(from: R, most: u64, stop: &'a AtomicBool) -> Self {
        Self { from: from.take(most.saturating_add(1)), most, stop }
    }

    /// Fills some room as far as there are bytes, which `each` gets as they come: with how many.
    fn fill(&mut self, room: &mut [u8], mut each: impl FnMut(&[u8])) -> Result<usize, FileError> {
        let mut n = 0;
        while n < room.len() {
            if self.stop.load(Ordering::Relaxed) {
                return Err(FileError::Unwanted);
            }
            let end = room.len().min(n + PIECE);
            match self.from.read(&mut room[n..end]) {
                Ok(0) => break,
                Ok(some) => {
                    each(&room[n..n + some]);
                    n += some;
                }
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(FileError::from(&error)),
            }
        }
        Ok(n)
    }

    /// The hash of all that was read, which is all there is.
    fn hash(self, hasher: &Hasher) -> Result<Hash, FileError> {
        if self.from.limit() == 0 {
            return Err(FileError::TooLarge(self.most));
        }
        Ok(*hasher.finalize().as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use std::sync::{Mutex, mpsc};

    use super::*;

    fn never() -> Arc<AtomicBool> {
        Arc::default()
    }

    fn hash(
        from: impl Read,
        length: usize,
        most: u64,
        stop: &AtomicBool,
    ) -> Result<Hash, FileError> {
        hash_whole(from, length, most, stop).map(|(hash, _)| hash)
    }

    fn bytes(n: usize) -> Vec<u8> {
        (0..n).map(|i| u8::try_from(i * 7 % 251).unwrap()).collect()
    }

    #[test]
    fn all_bytes_come_with_their_hash_whatever_length_was_told() {
        for n in [0, 1, 1000, PIECE - 1, PIECE, PIECE + 1, 3 * PIECE + 7, LARGE, LARGE + 5] {
            let all: &'static [u8] = bytes(n).leak();
            let all_hash = *blake3::hash(all).as_bytes();
            for length in [n, 0, n / 2, n.saturating_sub(1), n + 1, 2 * n] {
                let (read, own) = read_whole(all, length, u64::MAX, &never()).unwrap();
                assert!(*read == *all && own == all_hash, "{n} told as {length}");
                assert_eq!(hash(all, length, u64::MAX, &never()), Ok(all_hash));
            }
        }
    }

    #[test]
    fn another_source_is_told_at_the_first_piece_that_differs() {
        let all = bytes(5 * PIECE + 7);
        let (_, marks) = hash_whole(&all[..], all.len(), u64::MAX, &never()).unwrap();
        let differ = |from: &[u8]| {
            let mut left = from;
            let is_other = marks.differ(&mut left, u64::MAX, &never()).unwrap();
            (is_other, (from.len() - left.len()).div_ceil(PIECE))
        };
        assert_eq!(differ(&all), (false, 6));
        for i in 0..6 {
            let mut other = all.clone();
            other[i * PIECE + 3] ^= 1;
            assert_eq!(differ(&other), (true, i + 1));
        }
        for other in [&all[..5 * PIECE], &all[..PIECE], &all[..9], &[], &[&all[..], b"x"].concat()]
        {
            assert!(differ(other).0, "{} bytes", other.len());
        }
        // Small ones are hashed as soon.
        let (_, none) = hash_whole(&all[..9], 9, u64::MAX, &never()).unwrap();
        assert_eq!(none.differ(&all[1..], u64::MAX, &never()), Ok(false));
    }

    #[test]
    fn more_than_the_limit_is_refused() {
        let all: &'static [u8] = bytes(100).leak();
        for length in [0, 99, 100, LARGE] {
            assert!(read_whole(all, length, 100, &never()).is_ok());
            let refused = FileError::TooLarge(99);
            assert_eq!(read_whole(all, length, 99, &never()), Err(refused.clone()));
            assert_eq!(hash(all, length, 99, &never()), Err(refused));
        }
    }

    /// Gives a byte at a time and wants an end after some.
    struct Unwanted {
        left: usize,
        stop: Arc<AtomicBool>,
    }

    impl Read for Unwanted {
        fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
            assert!(!self.stop.load(Ordering::SeqCst), "read though it is not wanted any more");
            self.left -= 1;
            self.stop.store(self.left == 0, Ordering::SeqCst);
            to[0] = 7;
            Ok(1)
        }
    }

    #[test]
    fn nothing_more_is_read_once_it_is_not_wanted() {
        for left in [1, 2, 100] {
            for length in [0, 50, 1000] {
                let unwanted = || Unwanted { left, stop: never() };
                let from = unwanted();
                let stop = from.stop.clone();
                assert_eq!(read_whole(from, length, 1000, &stop), Err(FileError::Unwanted));
                let from = unwanted();
                let stop = from.stop.clone();
                assert_eq!(hash(from, length, 1000, &stop), Err(FileError::Unwanted));
            }
        }
    }

    /// Tells that it is read, and gives nothing until its sender is dropped, and then an end.
    struct Stuck(mpsc::Sender<()>, Mutex<mpsc::Receiver<()>>);

    impl Read for Stuck {
        fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
            self.0.send(()).unwrap();
            let _ = self.1.lock().unwrap().recv();
            Ok(0)
        }
    }

    #[test]
    fn a_large_source_that_gives_nothing_is_not_waited_for() {
        let ((read, is_read), (release, released)) = (mpsc::channel(), mpsc::channel());
        let (stuck, stop) = (Stuck(read, Mutex::new(released)), never());
        std::thread::scope(|scope| {
            let load = scope.spawn(|| read_whole(stuck, LARGE, u64::MAX, &stop));
            is_read.recv().unwrap();
            stop.store(true, Ordering::SeqCst);
            // It would wait for ever for what is released below.
            assert_eq!(load.join().unwrap(), Err(FileError::Unwanted));
        });
        drop(release);
    }

    #[test]
    fn what_the_source_says_is_told() {
        struct Broken;
        impl Read for Broken {
            fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
                Err(io::Error::other("broken"))
            }
        }
        for length in [0, LARGE] {
            let told = read_whole(Broken, length, 9, &never());
            assert_eq!(told, Err(FileError::Unreadable("broken".into())));
        }
    }
}
